//! Batches: whole arrays of directions through a model, in any layout.
//!
//! Arrays are cut into blocks of [`BLOCK`] directions. Inputs that are contiguous are read in place; others are
//! gathered into scratch rows first. Results go through scratch rows as well: that costs little, since the rows stay
//! in the first-level cache, and it keeps loads and stores of a loop from meeting at the same 4 KB offset, which halves its speed.

mod copy;
#[cfg(target_arch = "x86_64")]
mod shuffle;

pub use crate::kernels::UNIT_TOLERANCE;
use crate::kernels::{BLOCK, Block, DRAW_OUTPUTS, Kernel, Row};
use crate::scatter::Scatter;
use lesk_math::{CHANNELS, Isa};

/// Values of one input: element `i` stands at `data[i * stride]`; stride 0 repeats one value.
#[derive(Clone, Copy, Debug)]
pub struct Column<'a> {
    data: &'a [f32],
    stride: usize,
}

impl<'a> Column<'a> {
    /// Element `i` at `data[i * stride]`.
    ///
    /// # Panics
    /// If `data` is too short for `n` elements.
    pub fn strided(data: &'a [f32], stride: usize, n: usize) -> Column<'a> {
        assert!(n == 0 || data.len() > (n - 1) * stride, "a column of {n} with stride {stride} needs more data");
        Column { data, stride }
    }
    /// One value per direction.
    pub fn contiguous(data: &'a [f32]) -> Column<'a> {
        Column { data, stride: 1 }
    }
    /// The same value for all directions.
    pub fn uniform(value: &'a f32) -> Column<'a> {
        Column { data: std::slice::from_ref(value), stride: 0 }
    }
    /// The x, y and z columns of `n` vectors that stand one after the other.
    ///
    /// # Panics
    /// If `data` holds fewer than `3 n` values.
    pub fn interleaved(data: &'a [f32], n: usize) -> [Column<'a>; 3] {
        assert!(data.len() >= 3 * n, "{n} vectors need {} values, not {}", 3 * n, data.len());
        [0, 1, 2].map(|c| Column { data: &data[c.min(data.len())..], stride: 3 })
    }
}

/// Where the next outputs of `n` directions go.
#[derive(Debug)]
pub enum Target<'a, T = f32> {
    /// One output.
    Row(&'a mut [T]),
    /// Several outputs, as many as the number says, those of a direction one after the other.
    Interleaved(&'a mut [T], usize),
    /// One output, as whether it is not 0.
    Flags(&'a mut [bool]),
}

impl<'a, T> Target<'a, T> {
    /// How many outputs it takes.
    pub fn width(&self) -> usize {
        if let Target::Interleaved(_, width) = self { *width } else { 1 }
    }
    /// The number of directions that it has room for.
    pub fn rows(&self) -> usize {
        match self {
            Target::Row(row) => row.len(),
            Target::Interleaved(rows, width) => rows.len() / width,
            Target::Flags(flags) => flags.len(),
        }
    }
    /// The part for the first `rows` directions, and the rest.
    ///
    /// # Panics
    /// If there are fewer.
    pub fn split_at(self, rows: usize) -> (Target<'a, T>, Target<'a, T>) {
        match self {
            Target::Row(all) => {
                let (first, rest) = all.split_at_mut(rows);
                (Target::Row(first), Target::Row(rest))
            }
            Target::Interleaved(all, width) => {
                let (first, rest) = all.split_at_mut(rows * width);
                (Target::Interleaved(first, width), Target::Interleaved(rest, width))
            }
            Target::Flags(all) => {
                let (first, rest) = all.split_at_mut(rows);
                (Target::Flags(first), Target::Flags(rest))
            }
        }
    }
}

/// From this number of directions on, results go past the caches: they would not stay there anyway.
const STREAMING: usize = 1 << 18;

/// f(wi, wo) in 1/sr: one output per channel. Returns how many directions were not of unit length.
///
/// # Panics
/// If the targets do not take exactly these outputs of `n` directions.
pub fn eval(
    model: &dyn Scatter,
    isa: Isa,
    params: &[Column],
    wi: [Column; 3],
    wo: [Column; 3],
    n: usize,
    out: &mut [Target],
) -> usize {
    run(model.kernels().for_isa(isa).eval, isa, CHANNELS, params, wi, wo, n, out)
}

/// The density of drawing `wi` given `wo`, in 1/sr: one output. Returns how many directions were not of unit length.
///
/// # Panics
/// As [`eval`].
pub fn pdf(
    model: &dyn Scatter,
    isa: Isa,
    params: &[Column],
    wi: [Column; 3],
    wo: [Column; 3],
    n: usize,
    out: &mut [Target],
) -> usize {
    run(model.kernels().for_isa(isa).pdf, isa, 1, params, wi, wo, n, out)
}

/// Draws `wi` given `wo` and `u`: outputs wi.x, wi.y, wi.z, the weight's channels, pdf, delta. Returns how many `wo` were
/// not of unit length and `u` not in [0, 1).
///
/// # Panics
/// As [`eval`].
pub fn draw(
    model: &dyn Scatter,
    isa: Isa,
    params: &[Column],
    u: [Column; 3],
    wo: [Column; 3],
    n: usize,
    out: &mut [Target],
) -> usize {
    run(model.kernels().for_isa(isa).draw, isa, DRAW_OUTPUTS, params, u, wo, n, out)
}

fn run(
    kernel: Kernel,
    isa: Isa,
    outputs: usize,
    params: &[Column],
    first: [Column; 3],
    second: [Column; 3],
    n: usize,
    out: &mut [Target],
) -> usize {
    assert!(out.iter().all(|target| target.rows() == n), "the targets need room for {n} directions");
    assert_eq!(out.iter().map(Target::width).sum::<usize>(), outputs, "outputs that the targets take");
    let uniform = params.iter().all(|p| p.stride == 0);
    // not in a box: that would be built here and copied there
    let (mut directions, mut rows) = ([[0.0; BLOCK]; 6], [[0.0; BLOCK]; DRAW_OUTPUTS]);
    let mut param_rows = vec![[0.0; BLOCK]; if uniform { 0 } else { params.len() }];
    let single: Vec<&[f32]> = params.iter().map(|column| &column.data[..1]).collect();
    let columns = [first[0], first[1], first[2], second[0], second[1], second[2]];
    let copies = copy::Copies::for_isa(isa);
    let streaming = n >= STREAMING;
    let (mut odd, mut start) = (0, 0);
    while start < n {
        let whole = if start == 0 && streaming { copy::rows_to_line(&out[0]) } else { BLOCK };
        let len = whole.min(n - start);
        let varying = gather_params(params, &mut param_rows, start, len);
        let block = Block {
            n: len,
            params: if uniform { &single } else { &varying },
            uniform,
            directions: copies.gather(&columns, &mut directions, start, len),
        };
        // SAFETY: `for_isa` checked that this processor has the instruction set
        odd += unsafe { kernel(&block, &mut rows[..outputs]) } as usize;
        copies.scatter(&rows[..outputs], out, start, len, streaming);
        start += len;
    }
    copy::finish(streaming);
    odd
}

/// Elements `start..start + n` of each parameter that has a row, copied to it.
fn gather_params<'a>(params: &[Column], rows: &'a mut [Row], start: usize, n: usize) -> Vec<&'a [f32]> {
    for (column, row) in params.iter().zip(rows.iter_mut()) {
        let from = &column.data[start * column.stride..];
        for i in 0..n {
            row[i] = from[i * column.stride];
        }
    }
    rows.iter().map(|row| &row[..n]).collect()
}
