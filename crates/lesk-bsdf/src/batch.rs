//! Batches: whole arrays of directions through a model, in any layout.
//!
//! Directions that lie one after the other, as vectors or in an array per component, are read in place; others are
//! gathered into rows first, a block at a time.

pub use crate::kernels::UNIT_TOLERANCE;
use crate::kernels::group::LINE;
use crate::kernels::{BLOCK, Block, DRAW_OUTPUTS, EVAL_PDF_OUTPUTS, GROUP, Kernel, Row, Vectors};
use crate::scatter::Scatter;
pub use crate::target::Target;
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
    run(model.kernels().for_isa(isa).eval, CHANNELS, params, wi, wo, n, out)
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
    run(model.kernels().for_isa(isa).pdf, 1, params, wi, wo, n, out)
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
    run(model.kernels().for_isa(isa).draw, DRAW_OUTPUTS, params, u, wo, n, out)
}

/// Rows of numbers for many directions at once, each with its own parameters, all of the same length.
#[derive(Clone, Copy)]
pub struct Rows<'a> {
    /// One row per entry of the flat parameter table.
    pub params: &'a [&'a [f32]],
    /// x, y and z of `wi`, or the numbers `u` of a draw.
    pub first: [&'a [f32]; 3],
    /// x, y and z of `wo`.
    pub wo: [&'a [f32]; 3],
}

/// What [`Scatter::eval_pdf`] gives for each direction: f per channel and the density, in 1/sr.
///
/// # Panics
/// If a row is shorter than the first of `out`.
pub fn eval_pdf_rows(model: &dyn Scatter, isa: Isa, rows: Rows, out: [&mut [f32]; EVAL_PDF_OUTPUTS]) {
    run_rows(model.kernels().for_isa(isa).eval_pdf, rows, out);
}

/// What [`Scatter::draw`] gives for each direction: the outputs of [`draw`].
///
/// # Panics
/// If a row is shorter than the first of `out`.
pub fn draw_rows(model: &dyn Scatter, isa: Isa, rows: Rows, out: [&mut [f32]; DRAW_OUTPUTS]) {
    run_rows(model.kernels().for_isa(isa).draw, rows, out);
}

fn run_rows<const N: usize>(kernel: Kernel, rows: Rows, out: [&mut [f32]; N]) {
    let n = out[0].len();
    let block = Block {
        start: 0,
        n,
        params: rows.params,
        uniform: false,
        first: Vectors::Planes(rows.first.map(|row| &row[..n])),
        wo: Vectors::Planes(rows.wo.map(|row| &row[..n])),
    };
    // SAFETY: `for_isa` checked that this processor has the instruction set
    unsafe { kernel(&block, &mut out.map(|row| Target::Row(&mut row[..n])), false) };
}

fn run(
    kernel: Kernel,
    outputs: usize,
    params: &[Column],
    first: [Column; 3],
    wo: [Column; 3],
    n: usize,
    out: &mut [Target],
) -> usize {
    assert!(out.iter().all(|target| target.rows() == n), "the targets need room for {n} directions");
    assert_eq!(out.iter().map(Target::width).sum::<usize>(), outputs, "outputs that the targets take");
    let uniform = params.iter().all(|p| p.stride == 0);
    let whole = uniform && in_place(&first, 0, n).is_some() && in_place(&wo, 0, n).is_some();
    let (mut first_rows, mut wo_rows) = ([[0.0; BLOCK]; 3], [[0.0; BLOCK]; 3]);
    let mut param_rows = vec![[0.0; BLOCK]; if uniform { 0 } else { params.len() }];
    let single: Vec<&[f32]> = params.iter().map(|column| &column.data[..1]).collect();
    let streaming = n >= STREAMING;
    let (mut odd, mut start) = (0, 0);
    while start < n {
        let len = match n - start {
            _ if start == 0 && streaming => rows_to_line(&out[0]),
            rest => {
                if whole {
                    rest
                } else {
                    rest.min(BLOCK)
                }
            }
        };
        let varying = gather_params(params, &mut param_rows, start, len);
        let block = Block {
            start,
            n: len,
            params: if uniform { &single } else { &varying },
            uniform,
            first: gather(&first, &mut first_rows, start, len),
            wo: gather(&wo, &mut wo_rows, start, len),
        };
        // SAFETY: `for_isa` checked that this processor has the instruction set
        odd += unsafe { kernel(&block, out, streaming) } as usize;
        start += len;
    }
    finish(streaming);
    odd
}

/// How many directions to write first, so that the next ones start on a border of a cache line.
fn rows_to_line(target: &Target) -> usize {
    let (address, step) = match target {
        Target::Row(row) => (row.as_ptr().addr(), size_of::<f32>()),
        Target::Interleaved(rows, width) => (rows.as_ptr().addr(), width * size_of::<f32>()),
        Target::Flags(flags) => (flags.as_ptr().addr(), 1),
    };
    (1..=GROUP).find(|k| (address + k * step).is_multiple_of(LINE)).unwrap_or(GROUP)
}

/// Vectors `start..start + n` as a loop reads them without copying.
fn in_place<'a>(columns: &[Column<'a>; 3], start: usize, n: usize) -> Option<Vectors<'a>> {
    let [x, y, z] = columns;
    let is_next = |a: &Column, b: &Column| std::ptr::eq(b.data.as_ptr(), a.data.as_ptr().wrapping_add(1));
    match [x.stride, y.stride, z.stride] {
        [1, 1, 1] => Some(Vectors::Planes(columns.map(|column| &column.data[start..start + n]))),
        [3, 3, 3] if is_next(x, y) && is_next(y, z) => x.data.get(3 * start..3 * (start + n)).map(Vectors::Interleaved),
        _ => None,
    }
}

/// Vectors `start..start + n`, in place or copied to `rows`.
fn gather<'a>(columns: &[Column<'a>; 3], rows: &'a mut [Row; 3], start: usize, n: usize) -> Vectors<'a> {
    if let Some(vectors) = in_place(columns, start, n) {
        return vectors;
    }
    for (column, row) in columns.iter().zip(rows.iter_mut()) {
        copy(column, row, start, n);
    }
    Vectors::Planes([&rows[0], &rows[1], &rows[2]])
}

/// Elements `start..start + n` of each parameter that has a row, copied to it.
fn gather_params<'a>(params: &[Column], rows: &'a mut [Row], start: usize, n: usize) -> Vec<&'a [f32]> {
    for (column, row) in params.iter().zip(rows.iter_mut()) {
        copy(column, row, start, n);
    }
    rows.iter().map(|row| row.as_slice()).collect()
}

fn copy(column: &Column, row: &mut Row, start: usize, n: usize) {
    let from = &column.data[start * column.stride..];
    match column.stride {
        0 => row[..n].fill(from[0]),
        1 => row[..n].copy_from_slice(&from[..n]),
        stride => {
            for i in 0..n {
                row[i] = from[i * stride];
            }
        }
    }
}

/// After stores past the caches: other threads see them from here on.
fn finish(streaming: bool) {
    #[cfg(target_arch = "x86_64")]
    if streaming {
        // SAFETY: SSE is part of x86-64
        unsafe { std::arch::x86_64::_mm_sfence() };
    }
    let _ = streaming;
}
