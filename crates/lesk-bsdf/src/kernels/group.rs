//! A group of directions: loaded from, and written to, either layout.

use super::{GROUP, Vectors};
use crate::target::Target;

/// One value for each direction of a group.
pub type Group = [f32; GROUP];

/// Copies of whole groups, by instruction set.
pub trait Lines {
    /// Vectors to their components.
    fn split(from: &[f32; 3 * GROUP], rows: &mut [Group; 3]);
    /// Components to vectors; `past` the caches only to whole cache lines.
    fn join(rows: &[Group; 3], to: &mut [f32; 3 * GROUP], past: bool);
    /// Values to values; `past` as above.
    fn copy(from: &Group, to: &mut Group, past: bool);
}

/// As the compiler makes them, through the caches.
pub struct Plain;

impl Lines for Plain {
    #[inline(always)]
    fn split(from: &[f32; 3 * GROUP], rows: &mut [Group; 3]) {
        split(from, rows);
    }
    #[inline(always)]
    fn join(rows: &[Group; 3], to: &mut [f32; 3 * GROUP], _past: bool) {
        join(rows, to);
    }
    #[inline(always)]
    fn copy(from: &Group, to: &mut Group, _past: bool) {
        *to = *from;
    }
}

/// The components of `n` vectors from `start` on: in place, or in `rows`.
#[inline(always)]
pub fn load<'a, L: Lines>(from: &Vectors<'a>, start: usize, n: usize, rows: &'a mut [Group; 3]) -> [&'a [f32]; 3] {
    let vectors = match from {
        Vectors::Planes(planes) => return planes.map(|plane| &plane[start..start + n]),
        Vectors::Interleaved(all) => &all[3 * start..3 * (start + n)],
    };
    match vectors.try_into() {
        Ok(whole) => L::split(whole, rows),
        Err(_) => split(vectors, rows),
    }
    let [x, y, z] = rows;
    [&x[..n], &y[..n], &z[..n]]
}

/// Writes the first `n` values of each row to elements `start..start + n` of the targets, past the caches if `streaming`
/// and if they are whole cache lines.
#[inline(always)]
pub fn store<L: Lines>(mut rows: &[Group], targets: &mut [Target], start: usize, n: usize, streaming: bool) {
    for target in targets {
        let (these, rest) = rows.split_at(target.width());
        rows = rest;
        match target {
            Target::Row(row) => {
                let to = &mut row[start..start + n];
                let past = streaming && is_line(to);
                match <&mut Group>::try_from(&mut *to) {
                    Ok(whole) => L::copy(&these[0], whole, past),
                    Err(_) => to.copy_from_slice(&these[0][..n]),
                }
            }
            Target::Interleaved(all, width) => {
                let to = &mut all[start * *width..(start + n) * *width];
                let past = streaming && is_line(to);
                match (these.as_array::<3>(), <&mut [f32; 3 * GROUP]>::try_from(&mut *to)) {
                    (Some(three), Ok(whole)) => L::join(three, whole, past),
                    _ => join(these, to),
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

/// Bytes of a cache line.
pub const LINE: usize = 64;

/// Whether a cache line starts here: one that is written past the caches in two pieces costs more than it saves.
#[inline(always)]
fn is_line(to: &[f32]) -> bool {
    to.as_ptr().addr().is_multiple_of(LINE)
}

#[inline(always)]
fn split(from: &[f32], [x, y, z]: &mut [Group; 3]) {
    for (i, v) in from.as_chunks::<3>().0.iter().take(GROUP).enumerate() {
        x[i] = v[0];
        y[i] = v[1];
        z[i] = v[2];
    }
}

#[inline(always)]
fn join(rows: &[Group], to: &mut [f32]) {
    for (i, values) in to.chunks_exact_mut(rows.len()).take(GROUP).enumerate() {
        for (value, row) in values.iter_mut().zip(rows) {
            *value = row[i];
        }
    }
}
