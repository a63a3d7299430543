//! Drawing directions, each output in an array of its own.

use crate::arrays::{Number, Rows, Source, cut, in_parts};
use crate::models::{Target, columns, each, find, inputs, planes, reference, rows_of, targets};
use crate::{arrays::share, value_error};
use lesk_bsdf::batch::{self, Column};
use lesk_bsdf::kernels::DRAW_OUTPUTS;
use lesk_math::rng::Stream;
use lesk_math::sobol::Sampler;
use lesk_math::{CHANNELS, Isa, Vec3};
use numpy::{PyArray1, PyReadwriteArray1};
use pyo3::prelude::*;

/// Below this number of draws per thread, splitting costs more than it gains.
const GRAIN: usize = 1 << 14;

/// Draws at a time where their numbers have to be made first: those stay in the caches.
const SEEDED: usize = 2048;

/// Draws a direction for each `wo`, with the numbers `u` or with those that belong to `seed` and its index. The flat
/// outputs hold n times a direction, a weight, a density and whether a delta lobe was taken; with `planar`, directions
/// and weights hold one component after the other. Returns a positive number if directions were not of unit length, or
/// numbers outside [0, 1).
#[pyfunction]
pub fn draw(
    py: Python<'_>,
    id: &str,
    params: Vec<Source<'_>>,
    u: Option<Source<'_>>,
    wo: Source<'_>,
    seed: u64,
    out: (Target<'_>, Target<'_>, Target<'_>, PyReadwriteArray1<'_, bool>),
    planar: bool,
) -> PyResult<usize> {
    let model = find(id)?;
    let (wi, weight, pdf, mut delta) = out;
    let delta = delta.as_slice_mut().map_err(value_error)?;
    let n = delta.len();
    // without `u`, `wo` stands in its place and is not read there
    let inputs = inputs(model, &params, &[u.as_ref().unwrap_or(&wo), &wo], n)?;
    let seed = if u.is_some() { None } else { Some(seed) };
    match (wi, weight, pdf) {
        (Target::Single(mut wi), Target::Single(mut weight), Target::Single(mut pdf)) => {
            let out = outputs(&mut wi, &mut weight, &mut pdf, delta, planar)?;
            let inputs = planes(inputs);
            let size = if seed.is_some() { SEEDED } else { share(n, GRAIN) };
            let draw_rows = |rows: &Rows<f32>, mut out: Vec<batch::Target>| {
                let (params, given, wo) = columns(rows);
                let random = seed.map(|seed| random(seed, rows.start, rows.n));
                let u = random.as_ref().map_or(given, |u| Column::interleaved(u, rows.n));
                batch::draw(model, Isa::current(), &params, u, wo, rows.n, &mut out)
            };
            Ok(py.detach(|| in_parts(&inputs, n, size, |size| cut(out, size), draw_rows)))
        }
        (Target::Double(mut wi), Target::Double(mut weight), Target::Double(mut pdf)) => {
            let out = outputs(&mut wi, &mut weight, &mut pdf, delta, planar)?;
            let methods = reference(model)?;
            let draw_one = |i: usize, params: &[f64], given: Vec3<f64>, wo: Vec3<f64>, row: &mut [f64]| {
                let u = seed.map_or(given.to_array(), |seed| numbers(seed, i));
                let s = (methods.draw)(params, wo, u);
                row[..3].copy_from_slice(&s.wi.to_array());
                row[3..3 + CHANNELS].copy_from_slice(&s.weight.0);
                row[3 + CHANNELS..].copy_from_slice(&[s.pdf, s.delta]);
            };
            // without `u`, another input stands in its place
            let is_u_odd = if seed.is_some() { |_| false } else { is_outside };
            Ok(py.detach(|| each(&inputs, DRAW_OUTPUTS, out, is_u_odd, draw_one)))
        }
        _ => Err(value_error("the outputs must be of one type")),
    }
}

/// Whether one of three numbers lies outside [0, 1), or is NaN.
fn is_outside(u: Vec3<f64>) -> bool {
    !u.to_array().iter().all(|x| (0.0..1.0).contains(x))
}

/// The outputs in the order of the kernels.
fn outputs<'a, T: Number>(
    wi: &'a mut PyReadwriteArray1<'_, T>,
    weight: &'a mut PyReadwriteArray1<'_, T>,
    pdf: &'a mut PyReadwriteArray1<'_, T>,
    delta: &'a mut [bool],
    planar: bool,
) -> PyResult<Vec<batch::Target<'a, T>>> {
    let (wi, weight) = (wi.as_slice_mut().map_err(value_error)?, weight.as_slice_mut().map_err(value_error)?);
    let (pdf, n) = (pdf.as_slice_mut().map_err(value_error)?, delta.len());
    if rows_of(wi, 3)? != n || rows_of(weight, CHANNELS)? != n || pdf.len() != n {
        return Err(value_error(format!("the outputs need {n} rows")));
    }
    let mut all = targets(wi, 3, planar);
    all.extend(targets(weight, CHANNELS, planar));
    all.extend([batch::Target::Row(pdf), batch::Target::Flags(delta)]);
    Ok(all)
}

/// Three numbers in [0, 1) that depend on the seed and the index of the draw only.
fn numbers<T: Number>(seed: u64, i: usize) -> [T; 3] {
    let i = i as u64;
    let mut stream = Stream::new(seed, (i >> 32) as u32, i as u32);
    std::array::from_fn(|_| T::random(&mut stream))
}

/// The numbers of some draws, one draw after the other.
fn random(seed: u64, start: usize, n: usize) -> Vec<f32> {
    (start..start + n).flat_map(|i| numbers(seed, i)).collect()
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
