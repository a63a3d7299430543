//! GGX reflection: Walter, Marschner, Li & Torrance, *Microfacet Models for Refraction through Rough Surfaces*,
//! EGSR 2007; height-correlated masking after Heitz, JCGT 2014. Equation numbers refer to Walter unless named.

use crate::prelude::*;

/// Reflection from a rough boundary.
///
/// $$ f_r = \frac{D(h)\,F(\omega_i\cdot h)\,G_2(\omega_i,\omega_o)}{4\cos\theta_i\cos\theta_o} $$
///
/// Single scattering only: a rough surface loses energy (see the albedo plot).
#[derive(Params)]
pub struct Ggx<R> {
    /// Reflectance at normal incidence.
    #[param(default = 1.0, range = 0.0..=1.0)]
    pub f0: Color<R>,
    /// Width of the facet slopes along the tangent; 0.1 is satin, 0.5 is matte.
    #[param(default = 0.2, range = 1e-3..=1.0, slider = 0.02..=1.0, scale = "log")]
    pub alpha_x: R,
    /// Width of the facet slopes across the tangent.
    #[param(default = 0.2, range = 1e-3..=1.0, slider = 0.02..=1.0, scale = "log")]
    pub alpha_y: R,
}

pub const MODEL: Model = Model {
    title: "GGX reflection, height-correlated masking, Schlick's Fresnel term",
    paper: "walter2007",
    year: 2007,
    claims: &[
        Reciprocal.always(),
        Passive.always(),
        SamplesItself.always(),
        Isotropic.when("alpha_x = alpha_y"),
        NonNegative.always(),
        Smooth.always(),
    ],
    ..Model::DEFAULT
};

impl<R: Real> Bsdf<R> for Ggx<R> {
    #[inline(always)]
    fn eval(&self, wi: Vec3<R>, wo: Vec3<R>) -> Color<R> {
        let (h, cos_d) = facet::half(wi, wo);
        let d = ndf::ggx_ratio(h, self.alpha_x, self.alpha_y); // Eq. 33
        let v = masking::smith_ggx_visibility_ratio(wi, wo, self.alpha_x, self.alpha_y); // heitz2014 Eq. 99
        let f = fresnel::schlick(self.f0, cos_d); // schlick1994; the paper has the exact term
        f * (d * v).value().named("dv") // Eq. 20
    }

    #[inline(always)]
    fn sample(&self, wo: Vec3<R>, u: [R; 3]) -> Vec3<R> {
        wo.reflect(ndf::sample_ggx_visible(wo, self.alpha_x, self.alpha_y, [u[0], u[1]]))
    }

    #[inline(always)]
    fn pdf(&self, wi: Vec3<R>, wo: Vec3<R>) -> R {
        let d = ndf::ggx_ratio(wi + wo, self.alpha_x, self.alpha_y);
        // G1(wo) (wo.h) D / wo.z (heitz2018 Eq. 3) times 1/(4 wo.h) (Eq. 14)
        R::HALF * (masking::smith_ggx_half_ratio(wo, self.alpha_x, self.alpha_y) * d).value()
    }
}
