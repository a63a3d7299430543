//! Drawing directions, each output in an array of its own.

use crate::arrays::{Number, Rows, Source, in_parts};
use crate::models::{Target, columns, find, flat, inputs, is_odd, reference, vector};
use crate::value_error;
use lesk_bsdf::batch::{self, Column, Out};
use lesk_bsdf::kernels::DRAW_OUTPUTS;
use lesk_bsdf::scatter::{Methods, Scatter};
use lesk_math::rng::Stream;
use lesk_math::sobol::Sampler;
use lesk_math::{CHANNELS, Isa};
use numpy::{PyArray1, PyReadwriteArray1};
use pyo3::prelude::*;

/// Draws at a time: their outputs stay in the caches until they lie in the arrays.
const BLOCK: usize = 2048;

/// Draws a direction for each `wo`, with the numbers `u` or with those that belong to `seed` and its index. The flat
/// outputs hold n times a direction, a weight, a density and whether a delta lobe was taken. Returns a positive number
/// if directions were not of unit length.
#[pyfunction]
pub fn draw(
    py: Python<'_>,
    id: &str,
    params: Vec<Source<'_>>,
    u: Option<Source<'_>>,
    wo: Source<'_>,
    seed: u64,
    out: (Target<'_>, Target<'_>, Target<'_>, PyReadwriteArray1<'_, bool>),
) -> PyResult<usize> {
    let model = find(id)?;
    let (wi, weight, pdf, mut delta) = out;
    let delta = delta.as_slice_mut().map_err(value_error)?;
    // without `u`, `wo` stands in its place and is not read there
    let inputs = inputs(model, &params, &[u.as_ref().unwrap_or(&wo), &wo], delta.len())?;
    let seed = if u.is_some() { None } else { Some(seed) };
    match (wi, weight, pdf) {
        (Target::Single(mut wi), Target::Single(mut weight), Target::Single(mut pdf)) => {
            let chunk = Chunk::new(&mut wi, &mut weight, &mut pdf, delta)?;
            Ok(py.detach(|| run(&inputs, seed, chunk, &Kernels(model))))
        }
        (Target::Double(mut wi), Target::Double(mut weight), Target::Double(mut pdf)) => {
            let chunk = Chunk::new(&mut wi, &mut weight, &mut pdf, delta)?;
            let methods = reference(model)?;
            Ok(py.detach(|| run(&inputs, seed, chunk, &Reference(methods))))
        }
        _ => Err(value_error("the outputs must be of one type")),
    }
}

/// The outputs of some draws.
struct Chunk<'a, T> {
    wi: &'a mut [T],
    weight: &'a mut [T],
    pdf: &'a mut [T],
    delta: &'a mut [bool],
}

impl<'a, T: Number> Chunk<'a, T> {
    fn new(
        wi: &'a mut PyReadwriteArray1<'_, T>,
        weight: &'a mut PyReadwriteArray1<'_, T>,
        pdf: &'a mut PyReadwriteArray1<'_, T>,
        delta: &'a mut [bool],
    ) -> PyResult<Chunk<'a, T>> {
        let (wi, weight) = (wi.as_slice_mut().map_err(value_error)?, weight.as_slice_mut().map_err(value_error)?);
        let (pdf, n) = (pdf.as_slice_mut().map_err(value_error)?, delta.len());
        if wi.len() != 3 * n || weight.len() != CHANNELS * n || pdf.len() != n {
            return Err(value_error(format!("the outputs need {n} rows")));
        }
        Ok(Chunk { wi, weight, pdf, delta })
    }

    fn cut(self, size: usize) -> Vec<Chunk<'a, T>> {
        let vectors = self.wi.chunks_mut(3 * size).zip(self.weight.chunks_mut(CHANNELS * size));
        let numbers = self.pdf.chunks_mut(size).zip(self.delta.chunks_mut(size));
        vectors.zip(numbers).map(|((wi, weight), (pdf, delta))| Chunk { wi, weight, pdf, delta }).collect()
    }

    /// Takes outputs that stand one after the other, each with a value per draw.
    fn fill(self, outputs: &[T]) {
        let n = self.delta.len();
        let output = |c: usize| &outputs[c * n..(c + 1) * n];
        for (target, first, width) in [(self.wi, 0, 3), (self.weight, 3, CHANNELS)] {
            for c in 0..width {
                for (row, value) in target.chunks_exact_mut(width).zip(output(first + c)) {
                    row[c] = *value;
                }
            }
        }
        self.pdf.copy_from_slice(output(3 + CHANNELS));
        for (taken, value) in self.delta.iter_mut().zip(output(4 + CHANNELS)) {
            *taken = !value.is_zero();
        }
    }
}

/// Draws in one number type; outputs stand one after the other. Returns how many directions were not of unit length.
trait Draw<T>: Sync {
    fn draw(&self, rows: &Rows<T>, u: Option<&[T]>, out: &mut [T]) -> usize;
}

fn run<T: Number>(inputs: &[crate::arrays::Input], seed: Option<u64>, all: Chunk<T>, draws: &impl Draw<T>) -> usize {
    let n = all.delta.len();
    in_parts(
        inputs,
        n,
        BLOCK,
        |size| all.cut(size),
        |rows: &Rows<T>, chunk: Chunk<T>| {
            let random = seed.map(|seed| random::<T>(seed, rows.start, rows.n));
            let mut outputs = vec![T::default(); DRAW_OUTPUTS * rows.n];
            let odd = draws.draw(rows, random.as_deref(), &mut outputs);
            chunk.fill(&outputs);
            odd
        },
    )
}

/// Three numbers in [0, 1) for each of some draws, which depend on the seed and the index of the draw only.
fn random<T: Number>(seed: u64, start: usize, n: usize) -> Vec<T> {
    let mut out = Vec::with_capacity(3 * n);
    for i in start as u64..(start + n) as u64 {
        let mut stream = Stream::new(seed, (i >> 32) as u32, i as u32);
        out.extend((0..3).map(|_| T::random(&mut stream)));
    }
    out
}

/// float32, by the kernels.
struct Kernels(&'static dyn Scatter);

impl Draw<f32> for Kernels {
    fn draw(&self, rows: &Rows<f32>, u: Option<&[f32]>, out: &mut [f32]) -> usize {
        let (params, given, wo) = columns(rows);
        let u = u.map_or(given, |u| Column::interleaved(u, rows.n));
        let mut outputs: Vec<&mut [f32]> = out.chunks_mut(rows.n).collect();
        batch::draw(self.0, Isa::current(), &params, u, wo, rows.n, Out::Rows(&mut outputs))
    }
}

/// float64, by the reference formulas.
struct Reference(&'static Methods<f64>);

impl Draw<f64> for Reference {
    fn draw(&self, rows: &Rows<f64>, u: Option<&[f64]>, out: &mut [f64]) -> usize {
        let (n, count) = (rows.n, rows.len() - 2);
        let mut params = vec![0.0; count];
        let mut odd = 0;
        for i in 0..n {
            flat(rows, i, &mut params);
            let wo = vector(rows, count + 1, i);
            let u = u.map_or(vector(rows, count, i).to_array(), |u| [u[3 * i], u[3 * i + 1], u[3 * i + 2]]);
            let s = (self.0.draw)(&params, wo, u);
            let values = s.wi.to_array().into_iter().chain(s.weight.0).chain([s.pdf, s.delta]);
            for (c, value) in values.enumerate() {
                out[c * n + i] = value;
            }
            odd += usize::from(is_odd(wo));
        }
        odd
    }
}

/// Points `start..start + n` of an Owen-scrambled Sobol sequence in three dimensions, in [0, 1), one after the other.
#[pyfunction]
pub fn sobol<'py>(py: Python<'py>, start: u32, n: u32, seed: u32) -> Bound<'py, PyArray1<f32>> {
    let mut sampler = Sampler::new(seed);
    let mut points = Vec::with_capacity(3 * n as usize);
    for i in start..start.saturating_add(n) {
        sampler.start(0, i);
        points.extend(sampler.next3d());
    }
    PyArray1::from_vec(py, points)
}
