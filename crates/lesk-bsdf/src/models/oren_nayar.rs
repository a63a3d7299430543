//! Oren & Nayar, *Generalization of Lambert's Reflectance Model*, SIGGRAPH 1994: the qualitative model.

use crate::prelude::*;

/// Rough matte surfaces, such as clay, plaster and the moon: V-grooves with Lambert's facets.
///
/// $$ f_r = \frac{\rho}{\pi}\left(A + B\,\max(0, \cos(\phi_i - \phi_o))\,\sin\alpha\,\tan\beta\right),\quad
///    A = 1 - \frac{\sigma^2}{2(\sigma^2 + 0.33)},\quad B = \frac{0.45\,\sigma^2}{\sigma^2 + 0.09} $$
///
/// α and β are the larger and the smaller of the two polar angles. Light reflected among the facets is left out, but
/// for the constant 0.33. A white surface reflects up to 1.52 % too much (sigma = 0.2, at the horizon).
#[derive(Params)]
pub struct OrenNayar<R> {
    /// Reflectance of the facets.
    #[param(default = 0.5, range = 0.0..=1.0)]
    pub reflectance: Color<R>,
    /// Root mean square of the angle of the facets.
    #[param(default = 0.35, range = 0.0..=core::f64::consts::FRAC_PI_2, slider = 0.0..=0.8, unit = "rad")]
    pub sigma: R,
}

pub const MODEL: Model = Model {
    title: "Oren-Nayar model, qualitative form",
    paper: "oren1994",
    year: 1994,
    claims: &[
        Reciprocal.always(),
        Passive.when("reflectance <= 0.985"),
        SamplesItself.always(),
        Isotropic.always(),
        NonNegative.always(),
        Smooth.always(),
    ],
    counterexamples: &[Counterexample {
        property: Passive,
        params: &[("reflectance", 1.0), ("sigma", 0.2)],
        wi_deg: [85.0, 0.0],
        wo_deg: [60.0, 0.0],
        because: "the fit of 1994 reflects up to 1.52 % too much at grazing angles",
    }],
    limits: &[Limit {
        at: &[("sigma", 0.0)],
        equals: "lambert",
        link: &[("reflectance", "reflectance")],
        with: &[],
        tolerance: 0.0,
    }],
    seams: &[
        Seam { doc: "directions at right angles in azimuth", zero: |wi, wo| wi.x * wo.x + wi.y * wo.y },
        Seam { doc: "equal polar angles", zero: |wi, wo| wi.z - wo.z },
    ],
    ..Model::DEFAULT
};

impl<R: Real> Bsdf<R> for OrenNayar<R> {
    #[inline(always)]
    fn eval(&self, wi: Vec3<R>, wo: Vec3<R>) -> Color<R> {
        let sigma2 = self.sigma * self.sigma;
        let a = (R::HALF * sigma2 / (sigma2 + R::lit(0.33))).one_minus().named("a");
        let b = (R::lit(0.45) * sigma2 / (sigma2 + R::lit(0.09))).named("b");
        // cos(phi_i - phi_o) sin alpha tan beta = s / max(cos_i, cos_o), without any trigonometry
        let s = wi.x.fma(wo.x, wi.y * wo.y).max(R::ZERO).named("s");
        self.reflectance * (R::FRAC_1_PI * b.fma(s / wi.z.max(wo.z), a))
    }

    #[inline(always)]
    fn sample(&self, _wo: Vec3<R>, u: [R; 3]) -> Vec3<R> {
        lobe::sample_cosine([u[0], u[1]])
    }

    #[inline(always)]
    fn pdf(&self, wi: Vec3<R>, _wo: Vec3<R>) -> R {
        wi.z * R::FRAC_1_PI
    }
}
