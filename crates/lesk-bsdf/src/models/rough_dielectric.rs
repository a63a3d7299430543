//! Rough glass: Walter, Marschner, Li & Torrance, *Microfacet Models for Refraction through Rough Surfaces*,
//! EGSR 2007. Equation numbers refer to it.

use crate::prelude::*;

/// Reflection and transmission of a rough boundary between two clear media, GGX facets, separable masking.
///
/// $$ f_r = \frac{F D G}{4\,|\cos\theta_i|\,|\cos\theta_o|} \qquad
///    f_t = \frac{|\omega_i\cdot h|\,|\omega_o\cdot h|}{|\cos\theta_i|\,|\cos\theta_o|}
///          \frac{\eta_o^2\,(1-F)\,D\,G}{(\eta_i\,\omega_i\cdot h + \eta_o\,\omega_o\cdot h)^2} $$
///
/// Single scattering only: a rough surface loses energy (see the albedo plot).
#[derive(Params)]
pub struct RoughDielectric<R> {
    /// Refractive index below the surface divided by the one above. Equal media have no density: every facet would let
    /// light pass straight on. For a thinner medium below, turn the surface over.
    #[param(default = 1.5, range = 1.001..=4.0, slider = 1.05..=2.5)]
    pub ior: R,
    /// Width of the facet slopes along the tangent.
    #[param(default = 0.2, range = 1e-3..=1.0, slider = 0.02..=1.0, scale = "log")]
    pub alpha_x: R,
    /// Width of the facet slopes across the tangent.
    #[param(default = 0.2, range = 1e-3..=1.0, slider = 0.02..=1.0, scale = "log")]
    pub alpha_y: R,
}

pub const MODEL: Model = Model {
    title: "Rough glass: GGX reflection and transmission, separable masking",
    paper: "walter2007",
    year: 2007,
    domain: Domain::BothSides,
    claims: &[
        Reciprocal.always(),
        Passive.always(),
        SamplesItself.always(),
        Isotropic.when("alpha_x = alpha_y"),
        NonNegative.always(),
    ],
    counterexamples: &[Counterexample {
        property: Smooth,
        params: &[("ior", 1.5)],
        wi_deg: [138.1896851042214, 0.0],
        wo_deg: [138.1896851042214, 180.0],
        because: "seen from below, total reflection sets in with an infinite slope",
    }],
    ..Model::DEFAULT
};

/// Of a direction that facets scatter, what the formulas need.
struct Facet<R: Real> {
    /// D of the facet that joins `wi` and `wo`.
    d: R,
    /// F where it reflects, 1 - F where it refracts.
    share: R,
    /// |wi.h| |wo.h| / (wo.h + eta wi.h)^2; 1/4 where it reflects.
    jacobian: R,
    /// eta_i / eta_o: 1 where it reflects.
    eta: R,
    /// Whether both directions see its right side (Eq. 34's chi).
    facing: R::Mask,
}

/// Of a direction below the surface its mirror image above; facets hide from both alike.
#[inline(always)]
fn above<R: Real>(w: Vec3<R>) -> Vec3<R> {
    vec3(w.x, w.y, w.z.abs())
}

impl<R: Real> RoughDielectric<R> {
    /// Index of refraction on the far side of `wo` divided by that on its own, and the inverse.
    #[inline(always)]
    fn indices(&self, wo: Vec3<R>) -> (R, R) {
        let (above, recip) = (wo.z.gt(R::ZERO), self.ior.recip());
        (R::select(above, self.ior, recip).named("far"), R::select(above, recip, self.ior).named("near"))
    }

    /// The facet that joins `wi` and `wo`, by reflection (Eq. 13) or by refraction (Eq. 16).
    #[inline(always)]
    fn facet(&self, wi: Vec3<R>, wo: Vec3<R>) -> Facet<R> {
        let reflects = (wi.z * wo.z).gt(R::ZERO);
        let (far, near) = self.indices(wo);
        let eta = R::select(reflects, R::ONE, far).named("eta");
        let h = (wo + wi * eta).named("h");
        // (wo + eta wi).h is the length of wo + eta wi, and at least |eta - 1|. The cosines follow from it; their dot
        // products would cancel for eta near 1
        let s2 = h.length_squared().max((eta - R::ONE).sqr()).named("s2");
        let k = (eta - R::ONE) * (eta + R::ONE);
        let recip = s2.sqrt().recip();
        let i_h = ((s2 + k) * R::HALF * recip * R::select(reflects, R::ONE, near)).named("i_h");
        let o_h = ((s2 - k) * R::HALF * recip).named("o_h");
        // near total reflection i_h has more digits than o_h
        let g2 = R::select(reflects, fresnel::refracted_normal2(far, o_h), (eta * i_h).sqr());
        let fresnel = fresnel::dielectric_between(far, o_h.abs(), g2).named("fresnel"); // Eq. 22
        Facet {
            d: ndf::ggx(h, self.alpha_x, self.alpha_y).named("d"), // Eq. 33
            share: R::select(reflects, fresnel, fresnel.one_minus()),
            jacobian: (i_h * o_h).abs() * recip * recip,
            eta,
            facing: (o_h * h.z * wo.z).gt(R::ZERO) & (i_h * h.z * wi.z).gt(R::ZERO),
        }
    }
}

impl<R: Real> Bsdf<R> for RoughDielectric<R> {
    #[inline(always)]
    fn eval(&self, wi: Vec3<R>, wo: Vec3<R>) -> Color<R> {
        let facet = self.facet(wi, wo);
        let v = masking::smith_ggx_visibility_separable(above(wi), above(wo), self.alpha_x, self.alpha_y); // Eq. 23, 34
        // Eq. 21 over eta_o^2, and Eq. 20, for which the Jacobian is 1/4
        let f = R::lit(4.0) * facet.jacobian * facet.share * facet.d * v.named("v");
        Color::splat(R::select(facet.facing, f, R::ZERO))
    }

    #[inline(always)]
    fn sample(&self, wo: Vec3<R>, u: [R; 3]) -> Vec3<R> {
        let below = wo.z.lt(R::ZERO);
        let up = Vec3::select(below, -wo, wo);
        let h = ndf::sample_ggx_visible(up, self.alpha_x, self.alpha_y, [u[0], u[1]]);
        let (eta, near) = self.indices(wo);
        let c = up.dot(h);
        // Eq. 40: the refracted direction about h, with g - c = (eta^2 - 1)/(g + c)
        let g = fresnel::refracted_normal2(eta, c).safe_sqrt();
        let refracted = -(up + h * ((eta - R::ONE) * (eta + R::ONE) / (g + c))) * near;
        let reflects = u[2].lt(fresnel::dielectric(eta, c));
        let wi = Vec3::select(reflects, up.reflect(h), refracted);
        // a tilted facet may reflect into the surface or refract out of it: such a draw fails, on the horizon
        let side = R::select(reflects, R::ONE, -R::ONE);
        let wi = Vec3::select((wi.z * side).gt(R::ZERO), wi, vec3(R::ONE, R::ZERO, R::ZERO));
        Vec3::select(below, -wi, wi)
    }

    #[inline(always)]
    fn pdf(&self, wi: Vec3<R>, wo: Vec3<R>) -> R {
        let facet = self.facet(wi, wo);
        // G1(wo) |wo.h| D / |cos_o| (heitz2018 Eq. 3) times dh/dwi (Eq. 14, 17): the Jacobian holds |wo.h|
        let visible = R::TWO * masking::smith_ggx_half(above(wo), self.alpha_x, self.alpha_y) * facet.d;
        let pdf = visible * facet.share * facet.jacobian * facet.eta * facet.eta;
        R::select(facet.facing, pdf, R::ZERO)
    }
}
