//! Batches: whole arrays of directions through a model, in any layout.
//!
//! Arrays are cut into blocks of [`BLOCK`] directions. Inputs that are contiguous are read in place; others are
//! gathered into scratch rows first. Results go through scratch rows as well: that costs little, since the rows stay
//! in the first-level cache, and it keeps loads and stores of a loop from meeting at the same 4 KB offset, which halves its speed.

mod copy;

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

/// Where results go: row `c`, element `i`.
pub enum Out<'a, 'b> {
    /// One slice per output.
    Rows(&'a mut [&'b mut [f32]]),
    /// All outputs of a direction one after the other.
    Interleaved(&'a mut [f32]),
}

/// Directions whose squared length differs from 1 by more than this are counted, and give 0 only if they are not finite.
pub const UNIT_TOLERANCE: f32 = 1e-4;

/// From this number of directions on, results go past the caches: they would not stay there anyway.
const STREAMING: usize = 1 << 18;

/// f(wi, wo) in 1/sr: one output per channel. Returns how many directions were not of unit length.
pub fn eval(
    model: &dyn Scatter,
    isa: Isa,
    params: &[Column],
    wi: [Column; 3],
    wo: [Column; 3],
    n: usize,
    out: Out,
) -> usize {
    run(model.kernels().for_isa(isa).eval, isa, CHANNELS, true, params, wi, wo, n, out)
}

/// The density of drawing `wi` given `wo`, in 1/sr: one output. Returns how many directions were not of unit length.
pub fn pdf(
    model: &dyn Scatter,
    isa: Isa,
    params: &[Column],
    wi: [Column; 3],
    wo: [Column; 3],
    n: usize,
    out: Out,
) -> usize {
    run(model.kernels().for_isa(isa).pdf, isa, 1, true, params, wi, wo, n, out)
}

/// Draws `wi` given `wo` and `u`: outputs wi.x, wi.y, wi.z, the weight's channels, pdf, delta. Returns how many `wo` were
/// not of unit length.
pub fn draw(
    model: &dyn Scatter,
    isa: Isa,
    params: &[Column],
    u: [Column; 3],
    wo: [Column; 3],
    n: usize,
    out: Out,
) -> usize {
    run(model.kernels().for_isa(isa).draw, isa, DRAW_OUTPUTS, false, params, u, wo, n, out)
}

/// Scratch of one batch.
struct Scratch {
    directions: [Row; 6],
    params: Vec<Row>,
    out: Vec<Row>,
}

fn run(
    kernel: Kernel,
    isa: Isa,
    outputs: usize,
    first_is_direction: bool,
    params: &[Column],
    first: [Column; 3],
    second: [Column; 3],
    n: usize,
    mut out: Out,
) -> usize {
    let uniform = params.iter().all(|p| p.stride == 0);
    let varying = if uniform { 0 } else { params.len() };
    let mut scratch = Box::new(Scratch {
        directions: [[0.0; BLOCK]; 6],
        params: vec![[0.0; BLOCK]; varying],
        out: vec![[0.0; BLOCK]; outputs],
    });
    let Scratch { directions, params: param_rows, out: rows } = &mut *scratch;
    let columns = [first[0], first[1], first[2], second[0], second[1], second[2]];
    let copies = copy::Copies::for_isa(isa);
    let mut odd = 0;
    for start in (0..n).step_by(BLOCK) {
        let len = BLOCK.min(n - start);
        let views = copy::gather(&copies, &columns, directions, start, len);
        let mut param_views: Vec<&[f32]> = Vec::with_capacity(params.len());
        if uniform {
            param_views.extend(params.iter().map(|p| &p.data[..1]));
        } else {
            for (column, row) in params.iter().zip(param_rows.iter_mut()) {
                for i in 0..len {
                    row[i] = column.data[(start + i) * column.stride];
                }
            }
            param_views.extend(param_rows.iter().map(|row| &row[..len]));
        }
        let block = Block {
            n: len,
            params: &param_views,
            uniform,
            first: [views[0], views[1], views[2]],
            second: [views[3], views[4], views[5]],
        };
        // SAFETY: `for_isa` checked that this processor has the instruction set
        unsafe { kernel(&block, rows) };
        copy::scatter(&copies, rows, &mut out, start, len, n >= STREAMING);
        odd += copies.count_odd(block.second, len);
        if first_is_direction {
            odd += copies.count_odd(block.first, len);
        }
    }
    odd
}
