//! Rough metal, GGX: Walter, Marschner, Li & Torrance, *Microfacet Models for Refraction through Rough Surfaces*, EGSR
//! 2007; height-correlated masking after Heitz, JCGT 2014; Fresnel term of born1999. Equation numbers refer to Walter
//! unless named.

use crate::prelude::*;

/// Reflection from a rough metal with the complex refractive index η + ik.
///
/// $$ f_r = \frac{D(h)\,F(\omega_i\cdot h;\, \eta + ik)\,G_2(\omega_i,\omega_o)}{4\cos\theta_i\cos\theta_o} $$
///
/// Single scattering only: a rough surface loses energy (see the albedo plot). The default is gold (johnson1972, at
/// 650, 550 and 450 nm).
#[derive(Params)]
pub struct GgxConductor<R> {
    /// Real part of the refractive index.
    #[param(default = [0.16, 0.42, 1.38], range = 0.01..=10.0, slider = 0.05..=4.0)]
    pub eta: Color<R>,
    /// Imaginary part of the refractive index: absorption.
    #[param(default = [3.6, 2.47, 1.92], range = 0.0..=20.0, slider = 0.0..=8.0)]
    pub k: Color<R>,
    /// Width of the facet slopes along the tangent; 0.1 is satin, 0.5 is matte.
    #[param(default = 0.2, range = 1e-3..=1.0, slider = 0.02..=1.0, scale = "log")]
    pub alpha_x: R,
    /// Width of the facet slopes across the tangent.
    #[param(default = 0.2, range = 1e-3..=1.0, slider = 0.02..=1.0, scale = "log")]
    pub alpha_y: R,
}

pub const MODEL: Model = Model {
    title: "Rough metal: GGX, height-correlated masking, exact Fresnel reflectance",
    paper: "walter2007",
    year: 2007,
    claims: &[
        Reciprocal.always(),
        Passive.always(),
        SamplesItself.always(),
        Isotropic.when("alpha_x = alpha_y"),
        NonNegative.always(),
        Smooth.when("k >= 0.01"),
    ],
    counterexamples: &[
        Counterexample {
            property: Isotropic,
            params: &[("alpha_x", 0.1), ("alpha_y", 0.3)],
            wi_deg: [30.0, 0.0],
            wo_deg: [50.0, 140.0],
            because: "the highlight is wider across than along",
        },
        Counterexample {
            property: Smooth,
            params: &[("eta", 0.5), ("k", 0.0)],
            wi_deg: [30.0, 0.0],
            wo_deg: [30.0, 180.0],
            because: "without absorption the boundary of a thinner medium reflects totally, with a kink at the onset",
        },
    ],
    ..Model::DEFAULT
};

impl<R: Real> Bsdf<R> for GgxConductor<R> {
    #[inline(always)]
    fn eval(&self, wi: Vec3<R>, wo: Vec3<R>) -> Color<R> {
        let (h, cos_d) = facet::half(wi, wo);
        let d = ndf::ggx_ratio(h, self.alpha_x, self.alpha_y); // Eq. 33
        let v = masking::smith_ggx_visibility_ratio(wi, wo, self.alpha_x, self.alpha_y); // heitz2014 Eq. 99
        let f = fresnel::conductors(self.eta, self.k, cos_d).named("f");
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
