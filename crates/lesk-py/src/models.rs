//! Models over NumPy arrays.

use crate::arrays::{Input, Number, Part, Rows, Source, cut, in_parts, put, share};
use crate::value_error;
use lesk_bsdf::batch::{self, Column, UNIT_TOLERANCE};
use lesk_bsdf::bsdf::in_domain;
use lesk_bsdf::model::Domain;
use lesk_bsdf::scatter::{Methods, Scatter};
use lesk_bsdf::{params, registry};
use lesk_math::{CHANNELS, Isa, Vec3, vec3};
use numpy::PyReadwriteArray1;
use pyo3::prelude::*;
use serde_json::json;

/// Below this number of directions per thread, splitting costs more than it gains.
const GRAIN: usize = 1 << 15;
/// The same for the reference formulas, which do one direction at a time.
const REFERENCE_GRAIN: usize = 1 << 10;

pub fn find(id: &str) -> PyResult<&'static dyn Scatter> {
    registry::find(id).ok_or_else(|| value_error(format!("there is no model `{id}`")))
}

/// Every model with its parameters and claims, as JSON.
#[pyfunction]
pub fn registry_json() -> String {
    let models: Vec<_> = registry::all().map(describe).collect();
    json!({ "version": 1, "models": models }).to_string()
}

fn describe(model: &dyn Scatter) -> serde_json::Value {
    let facts = model.model();
    let domain = match facts.domain {
        Domain::Upper => "upper",
        Domain::BothSides => "both_sides",
        Domain::Sphere => "sphere",
    };
    let kind = |k| if k == params::Kind::Color { "color" } else { "scalar" };
    let parameters = model.specs().iter().map(|p| {
        let default = if p.default.len() == 1 { json!(p.default[0]) } else { json!(p.default) };
        json!({
            "name": p.name, "doc": p.doc, "kind": kind(p.kind), "default": default, "range": p.range,
            "slider": p.slider, "scale": if p.log { "log" } else { "linear" }, "unit": p.unit, "length": p.len(),
        })
    });
    let claims = facts.claims.iter().map(|c| json!({ "property": c.property.name(), "when": c.when }));
    let counterexamples = facts.counterexamples.iter().map(
        |c| json!({ "property": c.property.name(), "because": c.because, "wi_deg": c.wi_deg, "wo_deg": c.wo_deg }),
    );
    let limits = facts.limits.iter().map(|limit| {
        let at: Vec<_> = limit.at.iter().map(|(name, value)| json!({ "name": name, "value": value })).collect();
        json!({ "at": at, "equals": limit.equals })
    });
    json!({
        "id": model.id(), "title": facts.title, "year": facts.year, "paper": facts.paper, "doc": model.doc(),
        "domain": domain, "parameters": parameters.collect::<Vec<_>>(),
        "entries": params::flat_names(model.specs()), "claims": claims.collect::<Vec<_>>(),
        "counterexamples": counterexamples.collect::<Vec<_>>(), "limits": limits.collect::<Vec<_>>(),
    })
}

/// The inputs of a model's method: the flat parameters, then vectors.
pub fn inputs<'a>(
    model: &dyn Scatter,
    params: &'a [Source],
    vectors: &[&'a Source],
    n: usize,
) -> PyResult<Vec<Input<'a>>> {
    if params.len() != model.param_count() {
        let what = format!("{} parameter entries are needed, not {}", model.param_count(), params.len());
        return Err(value_error(what));
    }
    let flat = params.iter().map(|p| Input::new(p, 1, n));
    flat.chain(vectors.iter().map(|v| Input::new(v, 3, n))).collect()
}

/// The parameters of direction `i`, copied to `out`.
pub fn flat<T: Number>(rows: &Rows<T>, i: usize, out: &mut [T]) {
    for (j, p) in out.iter_mut().enumerate() {
        *p = rows.row(j, i)[0];
    }
}

pub fn vector<T: Number>(rows: &Rows<T>, input: usize, i: usize) -> Vec3<T> {
    let v = rows.row(input, i);
    vec3(v[0], v[1], v[2])
}

/// Whether a direction is not of unit length, or not finite.
pub fn is_odd(v: Vec3<f64>) -> bool {
    let is_unit = (v.length_squared() - 1.0).abs() <= UNIT_TOLERANCE.into();
    !is_unit
}

pub fn reference(model: &dyn Scatter) -> PyResult<&'static Methods<f64>> {
    model.forms().reference.ok_or_else(|| value_error(format!("model `{}` exists in float32 only", model.id())))
}

/// The flat output of a batch, in the type in which it is computed.
#[derive(FromPyObject)]
pub enum Target<'py> {
    Single(PyReadwriteArray1<'py, f32>),
    Double(PyReadwriteArray1<'py, f64>),
}

pub fn rows_of<T>(out: &[T], width: usize) -> PyResult<usize> {
    if out.len().is_multiple_of(width) {
        Ok(out.len() / width)
    } else {
        Err(value_error(format!("rows of {width} are needed")))
    }
}

/// A flat output of rows: one after the other, or (`planar`) one component after the other.
pub fn targets<T>(out: &mut [T], width: usize, planar: bool) -> Vec<batch::Target<'_, T>> {
    match (width, planar) {
        (1, _) => vec![batch::Target::Row(out)],
        (_, true) => out.chunks_mut((out.len() / width).max(1)).map(batch::Target::Row).collect(),
        (_, false) => vec![batch::Target::Interleaved(out, width)],
    }
}

/// The columns of parameters and of two vectors.
pub fn columns<'a>(rows: &Rows<'a, f32>) -> (Vec<Column<'a>>, [Column<'a>; 3], [Column<'a>; 3]) {
    let count = rows.len() - 2;
    let param = |j: usize| match rows.input(j) {
        (Part::Rows(values), true) => Column::uniform(&values[0]),
        (Part::Rows(values), false) => Column::contiguous(values),
        (Part::Planes([values, ..]), _) => Column::contiguous(values),
    };
    let vectors = |j: usize| match rows.input(j) {
        (Part::Rows(values), true) => [0, 1, 2].map(|c| Column::uniform(&values[c])),
        (Part::Rows(values), false) => Column::interleaved(values, rows.n),
        (Part::Planes(planes), _) => planes.map(Column::contiguous),
    };
    ((0..count).map(param).collect(), vectors(count), vectors(count + 1))
}

/// `eval` (out: n rows of channels) or `pdf` (n numbers). Returns how many directions were not of unit length.
///
/// The type of the output decides: float32 goes through the kernels, float64 through the reference formulas.
#[pyfunction]
pub fn evaluate(
    py: Python<'_>,
    id: &str,
    what: &str,
    params: Vec<Source<'_>>,
    wi: Source<'_>,
    wo: Source<'_>,
    out: Target<'_>,
    planar: bool,
) -> PyResult<usize> {
    let model = find(id)?;
    let is_eval = match what {
        "eval" => true,
        "pdf" => false,
        other => return Err(value_error(format!("`{other}` is not one of eval, pdf"))),
    };
    let width = if is_eval { CHANNELS } else { 1 };
    match out {
        Target::Single(mut out) => {
            let out = out.as_slice_mut().map_err(value_error)?;
            let n = rows_of(out, width)?;
            let inputs = planes(inputs(model, &params, &[&wi, &wo], n)?);
            let (isa, run) = (Isa::current(), if is_eval { batch::eval } else { batch::pdf });
            Ok(py.detach(|| {
                in_parts(
                    &inputs,
                    n,
                    share(n, GRAIN),
                    |size| cut(targets(out, width, planar), size),
                    |rows: &Rows<f32>, mut out| {
                        let (params, wi, wo) = columns(rows);
                        run(model, isa, &params, wi, wo, rows.n, &mut out)
                    },
                )
            }))
        }
        out => {
            let methods = reference(model)?;
            reference_rows(py, model, &params, [&wi, &wo], width, planar, out, |p, wi, wo, row| {
                if is_eval {
                    row.copy_from_slice(&(methods.eval)(p, wi, wo).0);
                } else {
                    row[0] = (methods.pdf)(p, wi, wo);
                }
            })
        }
    }
}

/// Inputs that are read as they lie, rows or planes.
pub fn planes(inputs: Vec<Input>) -> Vec<Input> {
    inputs.into_iter().map(Input::allow_planes).collect()
}

/// Runs a reference formula for each direction, in float64, and rounds its row to the type of the output. Returns how
/// many of the first vectors are odd and of the second not of unit length.
pub fn each<T: Number>(
    inputs: &[Input],
    width: usize,
    targets: Vec<batch::Target<T>>,
    is_first_odd: fn(Vec3<f64>) -> bool,
    run: impl Fn(usize, &[f64], Vec3<f64>, Vec3<f64>, &mut [f64]) + Sync,
) -> usize {
    let (n, count) = (targets.first().map_or(0, batch::Target::rows), inputs.len() - 2);
    in_parts(
        inputs,
        n,
        share(n, REFERENCE_GRAIN),
        |size| cut(targets, size),
        |rows: &Rows<f64>, mut out: Vec<batch::Target<T>>| {
            let (mut params, mut row) = (vec![0.0; count], vec![0.0; width]);
            let mut odd = 0;
            for i in 0..rows.n {
                flat(rows, i, &mut params);
                let (first, second) = (vector(rows, count, i), vector(rows, count + 1, i));
                odd += usize::from(is_first_odd(first)) + usize::from(is_odd(second));
                run(rows.start + i, &params, first, second, &mut row);
                put(&mut out, i, &row);
            }
            odd
        },
    )
}

/// df_c/dp_j, out: n rows of channels * P. Returns how many directions were not of unit length.
#[pyfunction]
pub fn gradient(
    py: Python<'_>,
    id: &str,
    params: Vec<Source<'_>>,
    wi: Source<'_>,
    wo: Source<'_>,
    out: Target<'_>,
) -> PyResult<usize> {
    let model = find(id)?;
    let derive = model.forms().gradient.ok_or_else(|| value_error(format!("model `{id}` has no exact derivatives")))?;
    let width = CHANNELS * model.param_count();
    reference_rows(py, model, &params, [&wi, &wo], width, false, out, |p, wi, wo, row| {
        derive(p, wi, wo, row);
    })
}

/// The two delta lobes, out: n rows of twice wi, weight, probability; all 0 where there is none. Returns a positive
/// number if directions were not of unit length.
#[pyfunction]
pub fn delta(py: Python<'_>, id: &str, params: Vec<Source<'_>>, wo: Source<'_>, out: Target<'_>) -> PyResult<usize> {
    let model = find(id)?;
    let (methods, domain) = (reference(model)?, model.model().domain);
    let lobe_width = 3 + CHANNELS + 1;
    reference_rows(py, model, &params, [&wo, &wo], 2 * lobe_width, false, out, |p, _, wo, row| {
        row.fill(0.0);
        let lobes = if in_domain(domain, wo) { (methods.delta)(p, wo) } else { None };
        for (lobe, out) in lobes.iter().flatten().zip(row.chunks_exact_mut(lobe_width)) {
            if lobe.probability > 0.0 {
                out[..3].copy_from_slice(&lobe.wi.to_array());
                out[3..3 + CHANNELS].copy_from_slice(&lobe.weight.0);
                out[3 + CHANNELS] = lobe.probability;
            }
        }
    })
}

/// [`each`] into an output of either type.
fn reference_rows(
    py: Python<'_>,
    model: &dyn Scatter,
    params: &[Source<'_>],
    vectors: [&Source<'_>; 2],
    width: usize,
    planar: bool,
    out: Target<'_>,
    run: impl Fn(&[f64], Vec3<f64>, Vec3<f64>, &mut [f64]) + Sync,
) -> PyResult<usize> {
    let run = |_, p: &[f64], first: Vec3<f64>, second: Vec3<f64>, row: &mut [f64]| run(p, first, second, row);
    match out {
        Target::Single(mut out) => {
            let out = out.as_slice_mut().map_err(value_error)?;
            let n = rows_of(out, width)?;
            let inputs = inputs(model, params, &vectors, n)?;
            Ok(py.detach(|| each(&inputs, width, targets(out, width, planar), is_odd, run)))
        }
        Target::Double(mut out) => {
            let out = out.as_slice_mut().map_err(value_error)?;
            let n = rows_of(out, width)?;
            let inputs = inputs(model, params, &vectors, n)?;
            Ok(py.detach(|| each(&inputs, width, targets(out, width, planar), is_odd, run)))
        }
    }
}
