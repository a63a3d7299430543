//! The seam between models and everything that uses them: concrete numbers, no generics.

use crate::bsdf::{Delta, Sample};
use crate::kernels::Kernels;
use crate::model::Model;
use crate::params::{ParamSpec, flat_len};
use lesk_math::{Color, Expr, Vec3};

/// A scattering model as engines see it. `params` is the flat table of [`specs`](Scatter::specs), all values legal.
///
/// Directions outside the domain give 0; no output is ever NaN or infinite.
pub trait Scatter: Sync + Send {
    /// The name used everywhere: file, command line, Python, scene files.
    fn id(&self) -> &'static str;
    /// Source, domain, claims.
    fn model(&self) -> &'static Model;
    /// What it is, in Markdown with LaTeX between `$$`.
    fn doc(&self) -> &'static str;
    /// The parameter table.
    fn specs(&self) -> &'static [ParamSpec];
    /// f(wi, wo) in 1/sr.
    fn eval(&self, params: &[f32], wi: Vec3<f32>, wo: Vec3<f32>) -> Color<f32>;
    /// f(wi, wo) and the density of drawing `wi`, both in 1/sr.
    fn eval_pdf(&self, params: &[f32], wi: Vec3<f32>, wo: Vec3<f32>) -> (Color<f32>, f32);
    /// Draws `wi` of the whole model, delta lobes included.
    fn draw(&self, params: &[f32], wo: Vec3<f32>, u: [f32; 3]) -> Sample<f32>;
    /// The delta lobes, where there are any.
    fn delta(&self, params: &[f32], wo: Vec3<f32>) -> Option<[Delta<f32>; 2]>;
    /// Loops over arrays, per instruction set.
    fn kernels(&self) -> &Kernels;
    /// The other number types in which the model exists.
    fn forms(&self) -> Forms;

    /// The length of the flat parameter table.
    fn param_count(&self) -> usize {
        flat_len(self.specs())
    }
}

/// What a model offers besides `f32`. A measured table has none of it.
#[derive(Clone, Copy, Default)]
pub struct Forms {
    /// The reference in `f64`.
    pub reference: Option<&'static Methods<f64>>,
    /// Exact derivatives by the parameters.
    pub gradient: Option<Gradient>,
    /// The recorded formulas, for shaders.
    pub recorded: Option<&'static Methods<Expr>>,
}

/// Writes df_c/dp_j to `out[c * P + j]`; returns f. Directions outside the domain give 0.
pub type Gradient = fn(params: &[f64], wi: Vec3<f64>, wo: Vec3<f64>, out: &mut [f64]) -> Color<f64>;

/// A model's functions in one number type, with the guards of [`crate::bsdf`] around them.
pub struct Methods<R> {
    pub eval: fn(&[R], Vec3<R>, Vec3<R>) -> Color<R>,
    pub pdf: fn(&[R], Vec3<R>, Vec3<R>) -> R,
    pub sample: fn(&[R], Vec3<R>, [R; 3]) -> Vec3<R>,
    pub draw: fn(&[R], Vec3<R>, [R; 3]) -> Sample<R>,
    pub delta: fn(&[R], Vec3<R>) -> Option<[Delta<R>; 2]>,
}

/// A model of the registry.
pub struct Compiled {
    pub(crate) id: &'static str,
    pub(crate) model: &'static Model,
    pub(crate) doc: &'static str,
    pub(crate) specs: &'static [ParamSpec],
    pub(crate) scalar: Methods<f32>,
    pub(crate) eval_pdf: fn(&[f32], Vec3<f32>, Vec3<f32>) -> (Color<f32>, f32),
    pub(crate) reference: Methods<f64>,
    pub(crate) gradient: Gradient,
    pub(crate) recorded: Methods<Expr>,
    pub(crate) kernels: Kernels,
}

impl Scatter for &'static Compiled {
    fn id(&self) -> &'static str {
        self.id
    }
    fn model(&self) -> &'static Model {
        self.model
    }
    fn doc(&self) -> &'static str {
        self.doc
    }
    fn specs(&self) -> &'static [ParamSpec] {
        self.specs
    }
    fn eval(&self, params: &[f32], wi: Vec3<f32>, wo: Vec3<f32>) -> Color<f32> {
        (self.scalar.eval)(params, wi, wo)
    }
    fn eval_pdf(&self, params: &[f32], wi: Vec3<f32>, wo: Vec3<f32>) -> (Color<f32>, f32) {
        (self.eval_pdf)(params, wi, wo)
    }
    fn draw(&self, params: &[f32], wo: Vec3<f32>, u: [f32; 3]) -> Sample<f32> {
        (self.scalar.draw)(params, wo, u)
    }
    fn delta(&self, params: &[f32], wo: Vec3<f32>) -> Option<[Delta<f32>; 2]> {
        (self.scalar.delta)(params, wo)
    }
    fn kernels(&self) -> &Kernels {
        &self.kernels
    }
    fn forms(&self) -> Forms {
        Forms { reference: Some(&self.reference), gradient: Some(self.gradient), recorded: Some(&self.recorded) }
    }
}
