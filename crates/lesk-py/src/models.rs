//! Models over NumPy arrays.

use crate::value_error;
use lesk_bsdf::batch::{self, Column, Out};
use lesk_bsdf::kernels::DRAW_OUTPUTS;
use lesk_bsdf::scatter::{Methods, Scatter};
use lesk_bsdf::{params, registry};
use lesk_math::{CHANNELS, Isa, Vec3, vec3};
use numpy::{Element, PyArray2, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::prelude::*;
use rayon::prelude::*;
use serde_json::json;

/// Below this number of directions per thread, splitting costs more than it gains.
const GRAIN: usize = 1 << 15;

fn find(id: &str) -> PyResult<&'static dyn Scatter> {
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
    let kind = |k| if k == params::Kind::Color { "color" } else { "scalar" };
    let parameters: Vec<_> = model
        .specs()
        .iter()
        .map(|p| {
            let default = if p.default.len() == 1 { json!(p.default[0]) } else { json!(p.default) };
            json!({
                "name": p.name, "doc": p.doc, "kind": kind(p.kind), "default": default, "range": p.range,
                "slider": p.slider, "scale": if p.log { "log" } else { "linear" }, "unit": p.unit, "length": p.len(),
            })
        })
        .collect();
    let claims: Vec<_> =
        facts.claims.iter().map(|c| json!({ "property": c.property.name(), "when": c.when })).collect();
    let counterexamples: Vec<_> = facts
        .counterexamples
        .iter()
        .map(|c| json!({ "property": c.property.name(), "because": c.because, "wi_deg": c.wi_deg, "wo_deg": c.wo_deg }))
        .collect();
    json!({
        "id": model.id(), "title": facts.title, "year": facts.year, "paper": facts.paper, "doc": model.doc(),
        "domain": format!("{:?}", facts.domain), "parameters": parameters, "claims": claims,
        "counterexamples": counterexamples,
    })
}

/// The inputs of a batch: each entry has one row (used for all) or `n` rows.
struct Inputs<'a, T> {
    params: Vec<&'a [T]>,
    first: &'a [T],
    second: &'a [T],
    n: usize,
}

impl<'a, T: Copy> Inputs<'a, T> {
    fn new(params: &'a [&'a [T]], first: &'a [T], second: &'a [T], n: usize, count: usize) -> PyResult<Self> {
        if params.len() != count {
            return Err(value_error(format!("{count} parameter entries are needed, not {}", params.len())));
        }
        let fits = |len: usize, width: usize| len == width || len == n * width;
        if !params.iter().all(|p| fits(p.len(), 1)) || !fits(first.len(), 3) || !fits(second.len(), 3) {
            return Err(value_error(format!("every input must have 1 or {n} rows")));
        }
        Ok(Inputs { params: params.to_vec(), first, second, n })
    }

    /// Rows `start..start + n`.
    fn part(&self, start: usize, n: usize) -> Inputs<'a, T> {
        let cut = |v: &'a [T], width: usize| if v.len() == width { v } else { &v[start * width..(start + n) * width] };
        let params = self.params.iter().map(|p| cut(p, 1)).collect();
        Inputs { params, first: cut(self.first, 3), second: cut(self.second, 3), n }
    }

    fn vector(v: &[T], i: usize) -> Vec3<T> {
        let at = if v.len() == 3 { 0 } else { 3 * i };
        vec3(v[at], v[at + 1], v[at + 2])
    }

    fn param(&self, i: usize, out: &mut Vec<T>) {
        out.clear();
        out.extend(self.params.iter().map(|p| p[if p.len() == 1 { 0 } else { i }]));
    }
}

fn width_of(what: &str) -> PyResult<usize> {
    match what {
        "eval" => Ok(CHANNELS),
        "pdf" => Ok(1),
        "draw" => Ok(DRAW_OUTPUTS),
        other => Err(value_error(format!("`{other}` is not one of eval, pdf, draw"))),
    }
}

fn views<'a, T: Element>(arrays: &'a [PyReadonlyArray1<'_, T>]) -> PyResult<Vec<&'a [T]>> {
    arrays.iter().map(|a| a.as_slice().map_err(value_error)).collect()
}

/// The columns of one or `n` vectors.
fn vectors(v: &[f32], n: usize) -> [Column<'_>; 3] {
    if v.len() == 3 { [0, 1, 2].map(|c| Column::strided(&v[c..], 0, 1)) } else { Column::interleaved(v, n) }
}

/// Runs `eval`, `pdf` or `draw` over float32 arrays into `out` of shape (n, outputs).
///
/// `first` is wi (eval, pdf) or u (draw), `second` is wo; inputs have 1 or n rows and are contiguous. Returns how many
/// directions were not of unit length.
#[pyfunction]
pub fn batch_f32(
    py: Python<'_>,
    id: &str,
    what: &str,
    params: Vec<PyReadonlyArray1<'_, f32>>,
    first: PyReadonlyArray2<'_, f32>,
    second: PyReadonlyArray2<'_, f32>,
    out: &Bound<'_, PyArray2<f32>>,
) -> PyResult<usize> {
    let model = find(id)?;
    let width = width_of(what)?;
    let mut target = out.readwrite();
    let n = out.shape()[0];
    let params = views(&params)?;
    let inputs = Inputs::new(
        &params,
        first.as_slice().map_err(value_error)?,
        second.as_slice().map_err(value_error)?,
        n,
        model.param_count(),
    )?;
    let target = target.as_slice_mut().map_err(value_error)?;
    if target.len() != n * width {
        return Err(value_error(format!("the output needs {width} columns")));
    }
    let isa = Isa::current();
    let what = what.to_owned();
    Ok(py.detach(|| {
        let grain = n.div_ceil(rayon::current_num_threads()).max(GRAIN);
        target.par_chunks_mut(grain * width).enumerate().map(|(k, chunk)| {
            let rows = chunk.len() / width;
            let part = inputs.part(k * grain, rows);
            let columns: Vec<Column> = part
                .params
                .iter()
                .map(|p| if p.len() == 1 { Column::uniform(&p[0]) } else { Column::contiguous(p) })
                .collect();
            let run = match what.as_str() {
                "eval" => batch::eval,
                "pdf" => batch::pdf,
                _ => batch::draw,
            };
            run(
                model,
                isa,
                &columns,
                vectors(part.first, rows),
                vectors(part.second, rows),
                rows,
                Out::Interleaved(chunk),
            );
        });
    }))
}

fn reference(model: &dyn Scatter) -> PyResult<&'static Methods<f64>> {
    model.forms().reference.ok_or_else(|| value_error(format!("model `{}` exists in float32 only", model.id())))
}

/// The same as [`batch_f32`] in float64, by the reference formulas.
#[pyfunction]
pub fn batch_f64(
    py: Python<'_>,
    id: &str,
    what: &str,
    params: Vec<PyReadonlyArray1<'_, f64>>,
    first: PyReadonlyArray2<'_, f64>,
    second: PyReadonlyArray2<'_, f64>,
    out: &Bound<'_, PyArray2<f64>>,
) -> PyResult<()> {
    let model = find(id)?;
    let methods = reference(model)?;
    let width = width_of(what)?;
    let mut target = out.readwrite();
    let n = out.shape()[0];
    let params = views(&params)?;
    let inputs = Inputs::new(
        &params,
        first.as_slice().map_err(value_error)?,
        second.as_slice().map_err(value_error)?,
        n,
        model.param_count(),
    )?;
    let target = target.as_slice_mut().map_err(value_error)?;
    if target.len() != n * width {
        return Err(value_error(format!("the output needs {width} columns")));
    }
    let what = what.to_owned();
    py.detach(|| {
        let grain = n.div_ceil(rayon::current_num_threads()).max(1024);
        target.par_chunks_mut(grain * width).enumerate().for_each(|(k, chunk)| {
            let part = inputs.part(k * grain, chunk.len() / width);
            let mut p = Vec::with_capacity(part.params.len());
            for (i, row) in chunk.chunks_exact_mut(width).enumerate() {
                part.param(i, &mut p);
                let (a, b) = (Inputs::vector(part.first, i), Inputs::vector(part.second, i));
                match what.as_str() {
                    "eval" => row.copy_from_slice(&(methods.eval)(&p, a, b).0),
                    "pdf" => row[0] = (methods.pdf)(&p, a, b),
                    _ => {
                        let s = (methods.draw)(&p, b, a.to_array());
                        row[..3].copy_from_slice(&s.wi.to_array());
                        row[3..3 + CHANNELS].copy_from_slice(&s.weight.0);
                        row[3 + CHANNELS..].copy_from_slice(&[s.pdf, s.delta]);
                    }
                }
            }
        });
    });
    Ok(())
}

/// df_c/dp_j for n pairs of directions into `out` of shape (n, channels * P).
#[pyfunction]
pub fn gradient(
    py: Python<'_>,
    id: &str,
    params: Vec<PyReadonlyArray1<'_, f64>>,
    wi: PyReadonlyArray2<'_, f64>,
    wo: PyReadonlyArray2<'_, f64>,
    out: &Bound<'_, PyArray2<f64>>,
) -> PyResult<()> {
    let model = find(id)?;
    let derive = model.forms().gradient.ok_or_else(|| value_error(format!("model `{id}` has no exact gradient")))?;
    let mut target = out.readwrite();
    let n = out.shape()[0];
    let width = CHANNELS * model.param_count();
    let params = views(&params)?;
    let inputs = Inputs::new(
        &params,
        wi.as_slice().map_err(value_error)?,
        wo.as_slice().map_err(value_error)?,
        n,
        model.param_count(),
    )?;
    let target = target.as_slice_mut().map_err(value_error)?;
    if target.len() != n * width {
        return Err(value_error(format!("the output needs {width} columns")));
    }
    py.detach(|| {
        let grain = n.div_ceil(rayon::current_num_threads()).max(1024);
        target.par_chunks_mut(grain * width).enumerate().for_each(|(k, chunk)| {
            let part = inputs.part(k * grain, chunk.len() / width);
            let mut p = Vec::with_capacity(part.params.len());
            for (i, row) in chunk.chunks_exact_mut(width).enumerate() {
                part.param(i, &mut p);
                derive(&p, Inputs::vector(part.first, i), Inputs::vector(part.second, i), row);
            }
        });
    });
    Ok(())
}
