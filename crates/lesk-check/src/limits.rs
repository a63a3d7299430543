//! Limits: at the stated parameters a model equals another one.

use crate::directions;
use crate::finding::{Finding, worst as worst_of};
use crate::random::Random;
use crate::region::Region;
use crate::subject::{Case, Reference, Subject, largest};
use lesk_bsdf::model::Limit;
use lesk_bsdf::params::{Kind, ParamSpec, defaults, offset_of};
use lesk_bsdf::registry;
use lesk_math::{CHANNELS, Vec3};

/// What the value means.
pub const MEASURE: &str = "relative difference of the two models";

/// Writes `value` to the entries of parameter `name`; a colour becomes grey.
pub fn set(specs: &[ParamSpec], params: &mut [f64], name: &str, value: f64) -> Result<(), String> {
    let Some(at) = offset_of(specs, name) else { return Err(format!("`{name}` is not a parameter")) };
    let Some(spec) = specs.iter().find(|spec| spec.name == name) else { return Err(name.to_owned()) };
    let [lo, hi] = spec.range;
    if !(value >= lo && value <= hi) {
        return Err(format!("`{name}` = {value} is not legal ({lo} to {hi})"));
    }
    params[at..at + spec.len()].fill(value);
    Ok(())
}

/// Copies our parameter to theirs: entry by entry, or one number to all channels.
fn link(theirs: (&[ParamSpec], &mut [f64], &str), ours: (&[ParamSpec], &[f64], &str)) -> Result<(), String> {
    let find = |specs: &[ParamSpec], name: &str| {
        let spec = specs.iter().find(|spec| spec.name == name).copied();
        spec.zip(offset_of(specs, name)).ok_or_else(|| format!("`{name}` is not a parameter"))
    };
    let ((spec, at), (our_spec, our_at)) = (find(theirs.0, theirs.2)?, find(ours.0, ours.2)?);
    match (spec.kind, our_spec.kind) {
        (Kind::Scalar, Kind::Scalar) => theirs.1[at] = ours.1[our_at],
        (Kind::Color, Kind::Scalar) => theirs.1[at..at + CHANNELS].fill(ours.1[our_at]),
        (Kind::Color, Kind::Color) => {
            theirs.1[at..at + CHANNELS].copy_from_slice(&ours.1[our_at..our_at + CHANNELS]);
        }
        (Kind::Scalar, Kind::Color) => return Err(format!("a colour does not fit into `{}`", theirs.2)),
    }
    Ok(())
}

/// The other model's parameters that belong to ours.
fn counterpart(limit: &Limit, specs: &[ParamSpec], ours: (&[ParamSpec], &[f64])) -> Result<Vec<f64>, String> {
    let mut params = defaults(specs);
    for &(name, value) in limit.with {
        set(specs, &mut params, name, value)?;
    }
    for &(theirs, our) in limit.link {
        link((specs, &mut params, theirs), (ours.0, ours.1, our))?;
    }
    Ok(params)
}

/// The largest relative difference at random parameters and directions; an error if the limit itself is malformed.
pub fn worst(subject: &dyn Subject, limit: &Limit, rng: &mut Random, pairs: usize) -> Result<Finding, String> {
    let other = registry::find(limit.equals).ok_or_else(|| format!("there is no model `{}`", limit.equals))?;
    let other = Reference(other);
    let region = Region::all(subject.specs());
    let mut findings = Vec::new();
    for _ in 0..pairs {
        let mut params = region.draw(rng).ok_or("no legal parameters")?;
        for &(name, value) in limit.at {
            set(subject.specs(), &mut params, name, value)?;
        }
        let theirs = counterpart(limit, other.specs(), (subject.specs(), &params))?;
        let (ours, theirs) = (Case::new(subject, &params), Case::new(&other, &theirs));
        let (wi, wo) = directions::pair(rng, &ours, 0.0);
        findings.push(compare(&ours, &theirs, wi, wo, limit.tolerance));
    }
    worst_of(findings.into_iter(), false).ok_or_else(|| "no pairs were tested".to_owned())
}

/// Both models at one pair of directions, and their delta lobes.
fn compare(ours: &Case, theirs: &Case, wi: Vec3<f64>, wo: Vec3<f64>, tolerance: f64) -> Finding {
    let (a, b) = (ours.eval(wi, wo), theirs.eval(wi, wo));
    let scale = largest(a).max(largest(b));
    let difference = largest(a - b);
    let mut finding = Finding::new(ours, wi, wo, 0.0, tolerance);
    if difference.is_nan() || scale > crate::reciprocity::underflow(ours) {
        finding.value = difference / scale;
        if finding.violates() {
            // two formulas of one function: both are rounded
            finding.allowed += (ours.rounding(wi, wo) + theirs.rounding(wi, wo)) / scale;
        }
    }
    let (lobes, others) = (ours.delta(wo), theirs.delta(wo));
    let mut off = if lobes.len() == others.len() { 0.0 } else { 1.0f64 };
    for (a, b) in lobes.iter().zip(&others) {
        let weight = largest(a.weight - b.weight) / largest(b.weight).max(1e-300);
        off = off.max(weight).max((a.wi - b.wi).length());
    }
    let allowed = tolerance + ours.subject.epsilon().sqrt();
    finding.worse(Finding::new(ours, wo, wo, off, allowed).with_note("delta lobes"))
}
