//! Lafortune & Willems, *Using the Modified Phong Reflectance Model for Physically Based Rendering*, report CW 197,
//! K.U. Leuven, 1994.

use crate::prelude::*;

/// Phong's highlight made plausible: reciprocal, and never brighter than its light.
///
/// $$ f_r = \frac{k_d}{\pi} + k_s\,\frac{n + 2}{2\pi}\cos^n\alpha $$
///
/// α is the angle from the mirror direction. At grazing angles half of the lobe sinks below the surface, and the
/// highlight darkens.
#[derive(Params)]
pub struct ModifiedPhong<R> {
    /// Diffuse reflectance.
    #[param(default = 0.4, range = 0.0..=1.0)]
    pub diffuse: Color<R>,
    /// Reflectance of the highlight at normal incidence.
    #[param(default = 0.4, range = 0.0..=1.0)]
    pub specular: Color<R>,
    /// Exponent n; 10 is dull, 1000 is polished. Beyond 10000 the cosine of `f32` directions does not resolve the lobe.
    #[param(default = 20.0, range = 0.0..=1e4, slider = 1.0..=1000.0, scale = "log")]
    pub shininess: R,
}

pub const MODEL: Model = Model {
    title: "Modified Phong model",
    paper: "lafortune1994",
    year: 1994,
    claims: &[
        Reciprocal.always(),
        Passive.when("diffuse + specular <= 1"),
        SamplesItself.always(),
        Isotropic.always(),
        NonNegative.always(),
        Smooth.always(),
    ],
    counterexamples: &[Counterexample {
        property: Passive,
        params: &[("diffuse", 0.6), ("specular", 0.6)],
        wi_deg: [0.0, 0.0],
        wo_deg: [0.0, 0.0],
        because: "both parts together reflect more than arrives",
    }],
    limits: &[Limit {
        at: &[("specular", 0.0)],
        equals: "lambert",
        link: &[("reflectance", "diffuse")],
        with: &[],
        tolerance: 0.0,
    }],
    seams: &[Seam { doc: "the edge of the lobe, 90 degrees from the mirror direction", zero: lobe::cos_mirror }],
    ..Model::DEFAULT
};

impl<R: Real> ModifiedPhong<R> {
    /// The probability of drawing from the diffuse part.
    #[inline(always)]
    fn diffuse_share(&self) -> R {
        lobe::share(self.diffuse.luminance(), self.specular.luminance())
    }
}

impl<R: Real> Bsdf<R> for ModifiedPhong<R> {
    #[inline(always)]
    fn eval(&self, wi: Vec3<R>, wo: Vec3<R>) -> Color<R> {
        let cos_alpha = lobe::cos_mirror(wi, wo).named("cos_alpha");
        let norm = (self.shininess + R::TWO) * R::lit(0.5 * core::f64::consts::FRAC_1_PI);
        let highlight = norm * lobe::cos_power(cos_alpha, self.shininess);
        self.diffuse * R::FRAC_1_PI + self.specular * highlight
    }

    #[inline(always)]
    fn sample(&self, wo: Vec3<R>, u: [R; 3]) -> Vec3<R> {
        let diffuse = lobe::sample_cosine([u[0], u[1]]);
        let highlight = lobe::sample_phong(wo, self.shininess, [u[0], u[1]]);
        Vec3::select(u[2].lt(self.diffuse_share()), diffuse, highlight)
    }

    #[inline(always)]
    fn pdf(&self, wi: Vec3<R>, wo: Vec3<R>) -> R {
        let highlight = lobe::phong_pdf(wi, wo, self.shininess);
        lobe::mixture(self.diffuse_share(), wi.z * R::FRAC_1_PI, highlight)
    }
}
