//! Models with one fault each: a check that passes one of them checks nothing.

use crate::subject::Subject;
use lesk_bsdf::Scatter;
use lesk_bsdf::bsdf::{Delta, Sample};
use lesk_bsdf::kernels::Kernels;
use lesk_bsdf::model::{Claim, Counterexample, Limit, Model};
use lesk_bsdf::params::ParamSpec;
use lesk_bsdf::scatter::Forms;
use lesk_math::{Color, Vec3};

/// What is wrong with a mutant.
#[derive(Clone, Copy, Debug)]
pub enum Fault {
    /// f grows by up to 1 % with the cosine of `wi` alone.
    OneSided,
    /// The weights of delta lobes lack the square of the refractive index that radiance gains.
    NoRadianceScaling,
    /// f and delta weights are 1 % too large.
    TooBright,
    /// The density is multiplied by this factor.
    Density(f64),
    /// Draws are 10 % denser towards one azimuth than the density says.
    BiasedDraw,
    /// The lobes of a mixture are chosen with other probabilities than the density says.
    BiasedLobe,
    /// The weight of draws is 1 % off.
    Weight,
    /// Delta lobes state 0.9 times the probability with which they are drawn.
    DeltaProbability,
    /// Delta lobes and their draws point 1e-3 aside.
    DeltaDirection,
    /// f changes by 1 % with the azimuth.
    Anisotropic,
    /// f is -1e-9 where both directions are close to the horizon.
    Negative,
    /// f has a kink of 5 % per radian at wi.x = 0.2.
    Kink,
    /// f jumps by 0.1 % at wi.x = 0.2.
    Step,
    /// f has a kink where the first parameter passes 0.3.
    ParameterKink,
    /// f is 1e-9 too large, relatively.
    Rounded,
    /// The model states other claims.
    Claims(&'static [Claim]),
    /// The model states other counterexamples.
    Counterexamples(&'static [Counterexample]),
    /// The model states other limits.
    Limits(&'static [Limit]),
}

/// A model with a fault.
pub struct Mutant<'a> {
    inner: &'a dyn Subject,
    fault: Fault,
    model: Model,
}

impl<'a> Mutant<'a> {
    /// `inner` with this fault.
    pub fn new(inner: &'a dyn Subject, fault: Fault) -> Mutant<'a> {
        let mut model = *inner.model();
        match fault {
            Fault::Claims(claims) => model.claims = claims,
            Fault::Counterexamples(counterexamples) => model.counterexamples = counterexamples,
            Fault::Limits(limits) => model.limits = limits,
            _ => {}
        }
        Mutant { inner, fault, model }
    }
}

/// A vector turned by `angle` radians about y and made unit again.
fn tilt(w: Vec3<f64>, angle: f64) -> Vec3<f64> {
    let mut w = w;
    w.x += angle;
    w.normalize()
}

impl Subject for Mutant<'_> {
    fn id(&self) -> &str {
        self.inner.id()
    }
    fn model(&self) -> &Model {
        &self.model
    }
    fn specs(&self) -> &'static [ParamSpec] {
        self.inner.specs()
    }
    fn eval(&self, params: &[f64], wi: Vec3<f64>, wo: Vec3<f64>) -> Color<f64> {
        let f = self.inner.eval(params, wi, wo);
        match self.fault {
            Fault::OneSided => f * (1.0 + 0.01 * wi.z),
            Fault::TooBright => f * 1.01,
            Fault::Anisotropic => f * (1.0 + 0.01 * wi.x * wo.x),
            Fault::Negative if wi.z.abs().max(wo.z.abs()) < 0.02 => Color::splat(-1e-9),
            Fault::Kink => f * (1.0 + 0.05 * (wi.x - 0.2).abs()),
            Fault::Step => f * if wi.x > 0.2 { 1.001 } else { 1.0 },
            Fault::ParameterKink => f * (1.0 + 0.1 * (params[0] - 0.3).abs()),
            Fault::Rounded => f * (1.0 + 1e-9),
            _ => f,
        }
    }
    fn pdf(&self, params: &[f64], wi: Vec3<f64>, wo: Vec3<f64>) -> f64 {
        let pdf = self.inner.pdf(params, wi, wo);
        if let Fault::Density(factor) = self.fault { pdf * factor } else { pdf }
    }
    fn draw(&self, params: &[f64], wo: Vec3<f64>, mut u: [f64; 3]) -> Sample<f64> {
        match self.fault {
            Fault::BiasedDraw => u[0] = u[0].powf(1.1),
            Fault::BiasedLobe => u[2] = u[2].powf(1.2),
            _ => {}
        }
        let mut s = self.inner.draw(params, wo, u);
        match self.fault {
            Fault::Density(factor) if s.delta == 0.0 => {
                s.pdf *= factor;
                s.weight = s.weight * (1.0 / factor);
            }
            Fault::Weight => s.weight = s.weight * 1.01,
            Fault::DeltaDirection if s.delta != 0.0 => s.wi = tilt(s.wi, 1e-3),
            _ => {}
        }
        s
    }
    fn delta(&self, params: &[f64], wo: Vec3<f64>) -> Option<[Delta<f64>; 2]> {
        let lobes = self.inner.delta(params, wo)?;
        Some(lobes.map(|mut lobe| {
            match self.fault {
                Fault::TooBright => lobe.weight = lobe.weight * 1.01,
                Fault::DeltaProbability => lobe.probability *= 0.9,
                Fault::DeltaDirection => lobe.wi = tilt(lobe.wi, 1e-3),
                Fault::NoRadianceScaling if lobe.wi.z * wo.z < 0.0 => {
                    let case = crate::subject::Case::new(self.inner, params);
                    lobe.weight = lobe.weight * (case.index(lobe.wi) / case.index(wo)).powi(2);
                }
                _ => {}
            }
            lobe
        }))
    }
    fn epsilon(&self) -> f64 {
        self.inner.epsilon()
    }
}

/// A model of `f32` functions only, with NaN at one place: what `fault` says, where both directions are within 1e-3
/// of the horizon.
pub struct Poisoned {
    /// The sound model.
    pub inner: &'static dyn Scatter,
    /// Which function gives NaN; none leaves the model as it is.
    pub place: Option<Poison>,
}

/// The function that gives NaN.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Poison {
    /// `eval` and `eval_pdf`.
    Eval,
    /// The density of `eval_pdf`.
    Pdf,
    /// The weight of `draw`.
    Draw,
}

impl Poisoned {
    fn strikes(&self, place: Poison, a: f32, b: f32) -> bool {
        self.place == Some(place) && a.abs().max(b.abs()) < 1e-3
    }
}

impl Scatter for Poisoned {
    fn id(&self) -> &'static str {
        self.inner.id()
    }
    fn model(&self) -> &'static Model {
        self.inner.model()
    }
    fn doc(&self) -> &'static str {
        self.inner.doc()
    }
    fn specs(&self) -> &'static [ParamSpec] {
        self.inner.specs()
    }
    fn eval(&self, params: &[f32], wi: Vec3<f32>, wo: Vec3<f32>) -> Color<f32> {
        self.eval_pdf(params, wi, wo).0
    }
    fn eval_pdf(&self, params: &[f32], wi: Vec3<f32>, wo: Vec3<f32>) -> (Color<f32>, f32) {
        let (mut f, mut pdf) = self.inner.eval_pdf(params, wi, wo);
        if self.strikes(Poison::Eval, wi.z, wo.z) {
            f = Color::splat(f32::NAN);
        }
        if self.strikes(Poison::Pdf, wi.z, wo.z) {
            pdf = f32::NAN;
        }
        (f, pdf)
    }
    fn draw(&self, params: &[f32], wo: Vec3<f32>, u: [f32; 3]) -> Sample<f32> {
        let mut s = self.inner.draw(params, wo, u);
        if self.strikes(Poison::Draw, wo.z, 0.0) {
            s.weight = Color::splat(f32::NAN);
        }
        s
    }
    fn delta(&self, params: &[f32], wo: Vec3<f32>) -> Option<[Delta<f32>; 2]> {
        self.inner.delta(params, wo)
    }
    fn kernels(&self) -> &Kernels {
        self.inner.kernels()
    }
    fn forms(&self) -> Forms {
        Forms::default()
    }
}
