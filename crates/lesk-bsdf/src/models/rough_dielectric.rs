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
    /// Refractive index below the surface divided by the one above.
    #[param(default = 1.5, range = 0.25..=4.0, slider = 1.0..=2.5)]
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
        Smooth.always(),
    ],
    seams: &[Seam { doc: "grazing: reflection meets transmission", zero: |wi, wo| wi.z * wo.z }],
    ..Model::DEFAULT
};

impl<R: Real> RoughDielectric<R> {
    /// Index of refraction on the far side of `wo` divided by that on its own.
    #[inline(always)]
    fn eta(&self, wo: Vec3<R>) -> R {
        R::select(wo.z.gt(R::ZERO), self.ior, self.ior.recip())
    }

    /// The facet normal (z > 0) that joins `wi` and `wo`, by reflection (Eq. 13) or by refraction (Eq. 16).
    #[inline(always)]
    fn facet(&self, wi: Vec3<R>, wo: Vec3<R>) -> Vec3<R> {
        let reflects = (wi.z * wo.z).gt(R::ZERO);
        let h = wo + wi * R::select(reflects, R::ONE, self.eta(wo));
        let h = h.normalize();
        Vec3::select(h.z.lt(R::ZERO), -h, h)
    }

    #[inline(always)]
    fn d(&self, h: Vec3<R>) -> R {
        ndf::ggx(h, self.alpha_x, self.alpha_y)
    }
}

impl<R: Real> Bsdf<R> for RoughDielectric<R> {
    #[inline(always)]
    fn eval(&self, wi: Vec3<R>, wo: Vec3<R>) -> Color<R> {
        let reflects = (wi.z * wo.z).gt(R::ZERO);
        let eta = self.eta(wo).named("eta");
        let h = self.facet(wi, wo).named("h");
        let (i_h, o_h) = (wi.dot(h), wo.dot(h));
        let g1i = masking::smith_ggx_g1(wi, self.alpha_x, self.alpha_y);
        let g1o = masking::smith_ggx_g1(wo, self.alpha_x, self.alpha_y);
        let dg = (self.d(h) * g1i * g1o).named("dg"); // Eq. 23, 33, 34
        let fresnel = fresnel::dielectric(eta, o_h.abs()).named("fresnel"); // Eq. 22
        let cosines = (wi.z * wo.z).abs();
        let reflected = fresnel * dg / (R::lit(4.0) * cosines); // Eq. 20
        // Eq. 21 with both sides divided by eta_o^2: eta = eta_i / eta_o
        let s = o_h + eta * i_h;
        let transmitted = (i_h * o_h).abs() * fresnel.one_minus() * dg / (cosines * s * s);
        // a facet seen from behind is masked (Eq. 34's chi)
        let facing = (o_h * wo.z).gt(R::ZERO) & (i_h * wi.z).gt(R::ZERO);
        let f = R::select(reflects, reflected, transmitted);
        Color::splat(R::select(facing, f, R::ZERO))
    }

    #[inline(always)]
    fn sample(&self, wo: Vec3<R>, u: [R; 3]) -> Vec3<R> {
        let below = wo.z.lt(R::ZERO);
        let up = Vec3::select(below, -wo, wo);
        let h = ndf::sample_ggx_visible(up, self.alpha_x, self.alpha_y, [u[0], u[1]]);
        let eta = self.eta(wo);
        let c = up.dot(h);
        let fresnel = fresnel::dielectric(eta, c);
        // Eq. 40: the refracted direction about h
        let cos_t = (R::ONE - (R::ONE - c * c) / (eta * eta)).safe_sqrt();
        let refracted = h * (c / eta - cos_t) - up / eta;
        let wi = Vec3::select(u[2].lt(fresnel), up.reflect(h), refracted);
        Vec3::select(below, -wi, wi)
    }

    #[inline(always)]
    fn pdf(&self, wi: Vec3<R>, wo: Vec3<R>) -> R {
        let reflects = (wi.z * wo.z).gt(R::ZERO);
        let eta = self.eta(wo);
        let h = self.facet(wi, wo);
        let (i_h, o_h) = (wi.dot(h), wo.dot(h));
        let fresnel = fresnel::dielectric(eta, o_h.abs());
        // heitz2018 Eq. 3: the density of the facet
        let visible = masking::smith_ggx_g1(wo, self.alpha_x, self.alpha_y) * o_h.abs() * self.d(h) / wo.z.abs();
        let s = o_h + eta * i_h;
        let reflected = fresnel / (R::lit(4.0) * o_h.abs()); // Eq. 14
        let transmitted = fresnel.one_minus() * eta * eta * i_h.abs() / (s * s); // Eq. 17
        let facing = (o_h * wo.z).gt(R::ZERO) & (i_h * wi.z).gt(R::ZERO);
        R::select(facing, visible * R::select(reflects, reflected, transmitted), R::ZERO)
    }
}
