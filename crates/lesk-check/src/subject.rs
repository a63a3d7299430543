//! What the checks look at: a model in `f64`, whatever it was written in.

use lesk_bsdf::Scatter;
use lesk_bsdf::bsdf::{Delta, Sample};
use lesk_bsdf::model::{Domain, Model};
use lesk_bsdf::params::{ParamSpec, flat_len, offset_of};
use lesk_math::{Color, Real, Vec3, vec3};

/// A model as the checks see it. [`Reference`] makes one of any [`Scatter`]; a mutant is one that wraps another.
pub trait Subject: Sync {
    /// The name of the model.
    fn id(&self) -> &str;
    /// Domain, claims, counterexamples, limits, seams.
    fn model(&self) -> &Model;
    /// The parameter table.
    fn specs(&self) -> &'static [ParamSpec];
    /// f(wi, wo) in 1/sr; 0 outside the domain.
    fn eval(&self, params: &[f64], wi: Vec3<f64>, wo: Vec3<f64>) -> Color<f64>;
    /// The density of drawing `wi` from the continuous part, in 1/sr.
    fn pdf(&self, params: &[f64], wi: Vec3<f64>, wo: Vec3<f64>) -> f64;
    /// Draws `wi` of the whole model.
    fn draw(&self, params: &[f64], wo: Vec3<f64>, u: [f64; 3]) -> Sample<f64>;
    /// The delta lobes.
    fn delta(&self, params: &[f64], wo: Vec3<f64>) -> Option<[Delta<f64>; 2]>;
    /// The distance from 1 to the next number that the model computes with.
    fn epsilon(&self) -> f64;
}

/// A registry model or any other [`Scatter`]: its `f64` form, or its `f32` functions where it has no other.
pub struct Reference<'a>(pub &'a dyn Scatter);

fn single(params: &[f64]) -> Vec<f32> {
    params.iter().map(|&p| p as f32).collect()
}

fn narrow(w: Vec3<f64>) -> Vec3<f32> {
    w.map(|x| x as f32)
}

fn wide<const N: usize>(c: lesk_math::Channels<f32, N>) -> lesk_math::Channels<f64, N> {
    lesk_math::Channels(c.0.map(f64::from))
}

impl Subject for Reference<'_> {
    fn id(&self) -> &str {
        self.0.id()
    }
    fn model(&self) -> &Model {
        self.0.model()
    }
    fn specs(&self) -> &'static [ParamSpec] {
        self.0.specs()
    }
    fn eval(&self, params: &[f64], wi: Vec3<f64>, wo: Vec3<f64>) -> Color<f64> {
        match self.0.forms().reference {
            Some(form) => (form.eval)(params, wi, wo),
            None => wide(self.0.eval(&single(params), narrow(wi), narrow(wo))),
        }
    }
    fn pdf(&self, params: &[f64], wi: Vec3<f64>, wo: Vec3<f64>) -> f64 {
        match self.0.forms().reference {
            Some(form) => (form.pdf)(params, wi, wo),
            None => f64::from(self.0.eval_pdf(&single(params), narrow(wi), narrow(wo)).1),
        }
    }
    fn draw(&self, params: &[f64], wo: Vec3<f64>, u: [f64; 3]) -> Sample<f64> {
        if let Some(form) = self.0.forms().reference {
            return (form.draw)(params, wo, u);
        }
        // the largest f32 below 1: rounding must not carry a number of [0, 1) to 1
        let u = u.map(|u| (u as f32).min(1.0 - f32::EPSILON / 2.0));
        let s = self.0.draw(&single(params), narrow(wo), u);
        Sample { wi: s.wi.map(f64::from), weight: wide(s.weight), pdf: s.pdf.into(), delta: s.delta.into() }
    }
    fn delta(&self, params: &[f64], wo: Vec3<f64>) -> Option<[Delta<f64>; 2]> {
        if let Some(form) = self.0.forms().reference {
            return (form.delta)(params, wo);
        }
        let lobes = self.0.delta(&single(params), narrow(wo))?;
        Some(lobes.map(|d| Delta {
            wi: d.wi.map(f64::from),
            weight: wide(d.weight),
            probability: d.probability.into(),
        }))
    }
    fn epsilon(&self) -> f64 {
        if self.0.forms().reference.is_some() { f64::EPSILON } else { f32::EPSILON.into() }
    }
}

/// A model at fixed parameters.
#[derive(Clone, Copy)]
pub struct Case<'a> {
    /// The model.
    pub subject: &'a dyn Subject,
    /// Its flat parameter table.
    pub params: &'a [f64],
}

impl<'a> Case<'a> {
    /// The model at these parameters.
    ///
    /// # Panics
    /// If the table has another length than the model's.
    pub fn new(subject: &'a dyn Subject, params: &'a [f64]) -> Case<'a> {
        assert_eq!(params.len(), flat_len(subject.specs()), "parameter table of `{}`", subject.id());
        Case { subject, params }
    }

    /// f(wi, wo) in 1/sr.
    pub fn eval(&self, wi: Vec3<f64>, wo: Vec3<f64>) -> Color<f64> {
        self.subject.eval(self.params, wi, wo)
    }

    /// The density of drawing `wi` from the continuous part, in 1/sr.
    pub fn pdf(&self, wi: Vec3<f64>, wo: Vec3<f64>) -> f64 {
        self.subject.pdf(self.params, wi, wo)
    }

    /// Draws `wi` of the whole model.
    pub fn draw(&self, wo: Vec3<f64>, u: [f64; 3]) -> Sample<f64> {
        self.subject.draw(self.params, wo, u)
    }

    /// The delta lobes that carry or draw anything.
    pub fn delta(&self, wo: Vec3<f64>) -> Vec<Delta<f64>> {
        let lobes = self.subject.delta(self.params, wo).map(Vec::from).unwrap_or_default();
        let used = |d: &Delta<f64>| d.probability != 0.0 || d.weight.0.iter().any(|&w| w != 0.0);
        lobes.into_iter().filter(used).collect()
    }

    /// The directions that the model accepts.
    pub fn domain(&self) -> Domain {
        self.subject.model().domain
    }

    /// The refractive index on the side of `w`: 1 above the surface; below it, the parameter `ior` of a model that
    /// accepts both sides (1 for a model without it).
    pub fn index(&self, w: Vec3<f64>) -> f64 {
        if self.domain() != Domain::BothSides || w.z > 0.0 {
            return 1.0;
        }
        offset_of(self.subject.specs(), "ior").map_or(1.0, |at| self.params[at])
    }

    /// How far f(wi, wo) may be off by rounding: by what it changes when the directions, length included, move by
    /// [`ULPS`] ulp, measured at that step and from differences over the root of epsilon.
    pub fn rounding(&self, wi: Vec3<f64>, wo: Vec3<f64>) -> f64 {
        let eps = self.subject.epsilon();
        let f = self.eval(wi, wo);
        let mut change = ULPS * eps * largest(f);
        // the differences at the small step are a sample of the rounding itself, of which the largest is wanted
        for (step, factor) in [(ULPS * eps, 4.0), (eps.sqrt(), ULPS * eps.sqrt())] {
            for (vi, vo) in
                neighbours(wi, step).map(|v| (v, wo)).into_iter().chain(neighbours(wo, step).map(|v| (wi, v)))
            {
                change = change.max(factor * largest(self.eval(vi, vo) - f));
            }
        }
        change
    }
}

/// Roundings of the inputs that a formula may amplify before its result counts as wrong.
pub const ULPS: f64 = 128.0;

/// Directions around `w` at distance `step`: along the axes, and longer and shorter.
pub fn neighbours(w: Vec3<f64>, step: f64) -> [Vec3<f64>; 8] {
    let [x, y, z] = [vec3(1.0, 0.0, 0.0), vec3(0.0, 1.0, 0.0), Vec3::Z].map(|axis| (axis - w * w.dot(axis)) * step);
    [w + x, w - x, w + y, w - y, w + z, w - z, w * (1.0 + step), w * (1.0 - step)]
}

/// The largest magnitude of the channels; NaN if one is.
pub fn largest(c: Color<f64>) -> f64 {
    c.0.iter().fold(0.0, |m: f64, x| if x.is_nan() { *x } else { m.max(Real::abs(*x)) })
}
