//! Phong, *Illumination for Computer Generated Pictures*, CACM 18(6), 1975.

use crate::prelude::*;

/// The first model with highlights, exactly as it was: a formula for reflected light.
///
/// $$ f_r = \frac{k_d}{\pi} + k_s\,\frac{\cos^n\alpha}{\cos\theta_i} $$
///
/// α is the angle from the mirror direction. Read as a BRDF it divides by cos θ_i, so that light and viewer cannot be
/// swapped and grazing light is reflected without bound; `modified_phong` repairs both.
#[derive(Params)]
pub struct Phong<R> {
    /// Diffuse reflectance.
    #[param(default = 0.4, range = 0.0..=1.0)]
    pub diffuse: Color<R>,
    /// Radiance of the highlight for light of irradiance 1 at normal incidence.
    #[param(default = 0.3, range = 0.0..=1.0)]
    pub specular: Color<R>,
    /// Exponent n; 10 is dull, 1000 is polished. Beyond 10000 the cosine of `f32` directions does not resolve the lobe.
    #[param(default = 20.0, range = 0.0..=1e4, slider = 1.0..=1000.0, scale = "log")]
    pub shininess: R,
}

pub const MODEL: Model = Model {
    title: "Phong's model of 1975",
    paper: "phong1975",
    year: 1975,
    claims: &[SamplesItself.always(), Isotropic.always(), NonNegative.always(), Smooth.always()],
    counterexamples: &[
        Counterexample {
            property: Reciprocal,
            params: &[],
            wi_deg: [30.0, 0.0],
            wo_deg: [50.0, 140.0],
            because: "the highlight is divided by the cosine of the light alone",
        },
        Counterexample {
            property: Passive,
            params: &[("specular", 1.0)],
            wi_deg: [89.9, 0.0],
            wo_deg: [89.0, 180.0],
            because: "the highlight grows without bound as the light grazes the surface",
        },
    ],
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

impl<R: Real> Phong<R> {
    /// The probability of drawing from the diffuse part.
    #[inline(always)]
    fn diffuse_share(&self) -> R {
        let highlight = R::TWO * R::PI / (self.shininess + R::ONE);
        lobe::share(self.diffuse.luminance(), self.specular.luminance() * highlight)
    }
}

impl<R: Real> Bsdf<R> for Phong<R> {
    #[inline(always)]
    fn eval(&self, wi: Vec3<R>, wo: Vec3<R>) -> Color<R> {
        let cos_alpha = lobe::cos_mirror(wi, wo).named("cos_alpha");
        // not a division, which would have to wait for the power
        let highlight = lobe::cos_power(cos_alpha, self.shininess) * wi.z.recip();
        // DEPARTS: the paper's k_d is not divided by pi; here it is a reflectance
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
