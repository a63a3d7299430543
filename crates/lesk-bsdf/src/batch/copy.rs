//! Between the caller's arrays and the rows of a block.

use super::{Column, Target};
use crate::kernels::{BLOCK, Row};
use lesk_math::Isa;

/// The copying loops of one instruction set.
pub(super) struct Copies {
    /// Vectors to their three rows.
    split3: unsafe fn(&[f32], &mut [Row; 3]),
    /// Three rows to vectors.
    join3: unsafe fn(&[Row; 3], &mut [f32]),
    /// The same past the caches, to whole cache lines.
    stream_join3: unsafe fn(&[Row; 3], &mut [f32]),
    /// Copies past the caches, to whole cache lines: that saves reading the target's lines first.
    stream: unsafe fn(&[f32], &mut [f32]),
}

/// For processors without shuffles of our own.
mod plain {
    use super::{BLOCK, Row};

    pub fn split3(from: &[f32], [x, y, z]: &mut [Row; 3]) {
        for (i, v) in from.as_chunks::<3>().0.iter().take(BLOCK).enumerate() {
            x[i] = v[0];
            y[i] = v[1];
            z[i] = v[2];
        }
    }

    pub fn join3([x, y, z]: &[Row; 3], to: &mut [f32]) {
        for (i, v) in to.as_chunks_mut::<3>().0.iter_mut().take(BLOCK).enumerate() {
            *v = [x[i], y[i], z[i]];
        }
    }

    pub fn copy(from: &[f32], to: &mut [f32]) {
        to.copy_from_slice(from);
    }
}

impl Copies {
    /// The loops for an instruction set that this processor has.
    pub(super) fn for_isa(isa: Isa) -> Copies {
        match isa {
            #[cfg(target_arch = "x86_64")]
            Isa::Avx2 | Isa::Avx512 => {
                use super::shuffle::{join3, split3, stream, stream_join3};
                Copies { split3, join3, stream_join3, stream }
            }
            _ => Copies { split3: plain::split3, join3: plain::join3, stream_join3: plain::join3, stream: plain::copy },
        }
    }

    /// Elements `start..start + n` of six columns: in place where contiguous, else through `rows`.
    pub(super) fn gather<'a>(
        &self,
        columns: &[Column<'a>; 6],
        rows: &'a mut [Row; 6],
        start: usize,
        n: usize,
    ) -> [&'a [f32]; 6] {
        let mut views = [&[] as &[f32]; 6];
        for (half, rows) in rows.as_chunks_mut::<3>().0.iter_mut().enumerate() {
            let columns = [columns[3 * half], columns[3 * half + 1], columns[3 * half + 2]];
            let vectors = together(&columns).and_then(|all| all.get(3 * start..3 * (start + n)));
            if let Some(vectors) = vectors {
                // SAFETY: `for_isa` is called with an available instruction set only
                unsafe { (self.split3)(vectors, rows) };
            }
            for (c, (column, row)) in columns.into_iter().zip(rows).enumerate() {
                views[3 * half + c] = if column.stride == 1 {
                    &column.data[start..start + n]
                } else {
                    if vectors.is_none() {
                        for i in 0..n {
                            row[i] = column.data[(start + i) * column.stride];
                        }
                    }
                    &row[..n]
                };
            }
        }
        views
    }

    /// Writes the first `n` values of each row to elements `start..start + n` of the targets, past the caches if
    /// `streaming`.
    pub(super) fn scatter(&self, mut rows: &[Row], out: &mut [Target], start: usize, n: usize, streaming: bool) {
        for target in out {
            let (these, rest) = rows.split_at(target.width());
            rows = rest;
            match target {
                Target::Row(row) => self.copy(&these[0][..n], &mut row[start..start + n], streaming),
                Target::Interleaved(all, width) => {
                    let to = &mut all[start * *width..(start + n) * *width];
                    match these.as_array::<3>() {
                        Some(three) => self.join(three, to, streaming),
                        None => join(these, to),
                    }
                }
                Target::Flags(flags) => {
                    for (flag, value) in flags[start..start + n].iter_mut().zip(&these[0]) {
                        *flag = *value != 0.0;
                    }
                }
            }
        }
    }

    fn join(&self, rows: &[Row; 3], to: &mut [f32], streaming: bool) {
        // SAFETY: `for_isa` is called with an available instruction set only
        unsafe { if streaming && is_lines(to) { (self.stream_join3)(rows, to) } else { (self.join3)(rows, to) } };
    }

    fn copy(&self, from: &[f32], to: &mut [f32], streaming: bool) {
        if streaming && is_lines(to) {
            // SAFETY: `for_isa` is called with an available instruction set only
            unsafe { (self.stream)(from, to) };
        } else {
            to.copy_from_slice(from);
        }
    }
}

/// Bytes of a cache line.
const LINE: usize = 64;

/// Whether these are whole cache lines: a line that is written past the caches in two pieces costs more than it saves.
fn is_lines(to: &[f32]) -> bool {
    to.as_ptr().addr().is_multiple_of(LINE) && size_of_val(to).is_multiple_of(LINE)
}

/// How many directions (at most 16) to write first, so that the next ones start on a border of a cache line; a block
/// where they do already.
pub(super) fn rows_to_line(target: &Target) -> usize {
    let (address, step) = match target {
        Target::Row(row) => (row.as_ptr().addr(), size_of::<f32>()),
        Target::Interleaved(rows, width) => (rows.as_ptr().addr(), width * size_of::<f32>()),
        Target::Flags(flags) => (flags.as_ptr().addr(), 1),
    };
    if address.is_multiple_of(LINE) {
        return BLOCK;
    }
    (1..=16).find(|k| (address + k * step).is_multiple_of(LINE)).unwrap_or(BLOCK)
}

/// The vectors, one after the other, of which these are the components.
fn together<'a>([x, y, z]: &[Column<'a>; 3]) -> Option<&'a [f32]> {
    let is_next = |a: &Column, b: &Column| std::ptr::eq(b.data.as_ptr(), a.data.as_ptr().wrapping_add(1));
    let strides = [x.stride, y.stride, z.stride];
    (strides == [3; 3] && is_next(x, y) && is_next(y, z)).then_some(x.data)
}

fn join(rows: &[Row], to: &mut [f32]) {
    for (i, values) in to.chunks_exact_mut(rows.len()).enumerate() {
        for (value, row) in values.iter_mut().zip(rows) {
            *value = row[i];
        }
    }
}

/// After stores past the caches: other threads see them from here on.
pub(super) fn finish(streaming: bool) {
    #[cfg(target_arch = "x86_64")]
    if streaming {
        // SAFETY: SSE is part of x86-64
        unsafe { std::arch::x86_64::_mm_sfence() };
    }
    let _ = streaming;
}
