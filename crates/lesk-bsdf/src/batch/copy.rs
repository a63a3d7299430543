//! Between the caller's arrays and the rows of a block.

use super::{Column, Out, UNIT_TOLERANCE};
use crate::kernels::{BLOCK, Row};
use lesk_math::Isa;

/// The transposing loops of one instruction set.
pub(super) struct Copies {
    split3: unsafe fn(&[f32], &mut [Row]),
    join3: unsafe fn(&[Row], &mut [f32]),
    count_odd: unsafe fn([&[f32]; 3], usize) -> u32,
}

#[inline(always)]
fn split3(from: &[f32], to: &mut [Row]) {
    let [x, y, z] = to else { return };
    for (i, v) in from.as_chunks::<3>().0.iter().take(BLOCK).enumerate() {
        x[i] = v[0];
        y[i] = v[1];
        z[i] = v[2];
    }
}

#[inline(always)]
fn join3(from: &[Row], to: &mut [f32]) {
    let [x, y, z] = from else { return };
    for (i, v) in to.as_chunks_mut::<3>().0.iter_mut().take(BLOCK).enumerate() {
        *v = [x[i], y[i], z[i]];
    }
}

/// How many of `n` vectors are not of unit length; NaN counts.
#[inline(always)]
fn count_odd([x, y, z]: [&[f32]; 3], n: usize) -> u32 {
    let (x, y, z) = (&x[..n], &y[..n], &z[..n]);
    let mut count = 0;
    for i in 0..n {
        let l2 = x[i] * x[i] + y[i] * y[i] + z[i] * z[i];
        let is_unit = (l2 - 1.0).abs() <= UNIT_TOLERANCE;
        count += u32::from(!is_unit);
    }
    count
}

macro_rules! copies {
    ($($feature:literal)?) => {{
        $(#[target_feature(enable = $feature)])?
        unsafe fn split(from: &[f32], to: &mut [Row]) {
            split3(from, to)
        }
        $(#[target_feature(enable = $feature)])?
        unsafe fn join(from: &[Row], to: &mut [f32]) {
            join3(from, to)
        }
        $(#[target_feature(enable = $feature)])?
        unsafe fn count(v: [&[f32]; 3], n: usize) -> u32 {
            count_odd(v, n)
        }
        Copies { split3: split, join3: join, count_odd: count }
    }};
}

impl Copies {
    pub(super) fn count_odd(&self, v: [&[f32]; 3], n: usize) -> usize {
        // SAFETY: `for_isa` is called with an available instruction set only
        unsafe { (self.count_odd)(v, n) as usize }
    }

    pub(super) fn for_isa(isa: Isa) -> Copies {
        match isa {
            #[cfg(target_arch = "x86_64")]
            Isa::Avx2 => copies!("avx2,fma"),
            #[cfg(target_arch = "x86_64")]
            Isa::Avx512 => copies!("avx512f,avx512vl,avx512bw,avx512dq,avx2,fma"),
            _ => copies!(),
        }
    }
}

/// Elements `start..start + n` of six columns: in place where contiguous, else through `rows`.
pub(super) fn gather<'a>(
    copies: &Copies,
    columns: &[Column<'a>; 6],
    rows: &'a mut [Row; 6],
    start: usize,
    n: usize,
) -> [&'a [f32]; 6] {
    let mut views = [&[] as &[f32]; 6];
    for (half, rows) in rows.as_chunks_mut::<3>().0.iter_mut().enumerate() {
        let [x, y, z] = [columns[3 * half], columns[3 * half + 1], columns[3 * half + 2]];
        let together = x.stride == 3
            && y.stride == 3
            && z.stride == 3
            && std::ptr::eq(y.data.as_ptr(), x.data.as_ptr().wrapping_add(1))
            && std::ptr::eq(z.data.as_ptr(), x.data.as_ptr().wrapping_add(2));
        if together && x.data.len() >= 3 * (start + n) {
            // SAFETY: `Copies::for_isa` is called with an available instruction set only
            unsafe { (copies.split3)(&x.data[3 * start..3 * (start + n)], rows) };
        }
        for (c, (column, row)) in [x, y, z].into_iter().zip(rows).enumerate() {
            views[3 * half + c] = if column.stride == 1 {
                &column.data[start..start + n]
            } else {
                if !together {
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

/// Copies; with `streaming` past the caches, which saves reading the target's lines first.
fn copy(from: &[f32], to: &mut [f32], streaming: bool) {
    #[cfg(target_arch = "x86_64")]
    if streaming {
        use std::arch::x86_64::{_mm_loadu_ps, _mm_stream_ps};
        /// Four values on a 16-byte border.
        #[repr(C, align(16))]
        struct Quad([f32; 4]);
        // SAFETY: four f32 make a quad, whatever they are
        let (head, body, tail) = unsafe { to.align_to_mut::<Quad>() };
        let (from_head, rest) = from.split_at(head.len());
        head.copy_from_slice(from_head);
        let (chunks, from_tail) = rest.as_chunks::<4>();
        for (source, target) in chunks.iter().zip(body) {
            // SAFETY: SSE is part of x86-64; the target is 16-byte aligned
            unsafe { _mm_stream_ps(target.0.as_mut_ptr(), _mm_loadu_ps(source.as_ptr())) };
        }
        tail.copy_from_slice(from_tail);
        return;
    }
    let _ = streaming;
    to.copy_from_slice(from);
}

/// Writes the first `n` values of each row to elements `start..start + n` of the output.
pub(super) fn scatter(copies: &Copies, rows: &[Row], out: &mut Out, start: usize, n: usize, streaming: bool) {
    match out {
        Out::Rows(targets) => {
            for (row, target) in rows.iter().zip(targets.iter_mut()) {
                copy(&row[..n], &mut target[start..start + n], streaming);
            }
        }
        Out::Interleaved(target) if rows.len() == 3 => {
            let target = &mut target[3 * start..3 * (start + n)];
            if streaming {
                let mut joined = [0.0; 3 * BLOCK];
                // SAFETY: as in `gather`
                unsafe { (copies.join3)(rows, &mut joined[..3 * n]) };
                copy(&joined[..3 * n], target, true);
            } else {
                // SAFETY: as in `gather`
                unsafe { (copies.join3)(rows, target) };
            }
        }
        Out::Interleaved(target) => {
            let width = rows.len();
            for (c, row) in rows.iter().enumerate() {
                for i in 0..n {
                    target[(start + i) * width + c] = row[i];
                }
            }
        }
    }
}
