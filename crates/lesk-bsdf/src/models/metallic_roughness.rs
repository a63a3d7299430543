//! The material of glTF 2.0: Khronos Group, *glTF 2.0 Specification*, appendix B, 2021, with the height-correlated
//! masking of the Sample Viewer (heitz2014) where the text prints the separable one.

use crate::prelude::*;

/// Metal or plastic, and anything between, with two dials.
///
/// $$ f_r = (1 - F)(1 - m)\frac{c}{\pi} + F\,D\,V,\quad F_0 = (1 - m)\,0.04 + m\,c,\quad \alpha = r^2 $$
///
/// The diffuse part is darkened by one Fresnel term only: bright rough plastics gain energy at grazing angles.
#[derive(Params)]
pub struct MetallicRoughness<R> {
    /// Diffuse reflectance of a plastic, reflectance at normal incidence of a metal; linear.
    #[param(default = 0.5, range = 0.0..=1.0)]
    pub base_color: Color<R>,
    /// 0 for plastic, 1 for metal.
    #[param(default = 0.0, range = 0.0..=1.0)]
    pub metallic: R,
    /// The dial: the width of the facet slopes is its square, and at least 0.001.
    #[param(default = 0.5, range = 0.0..=1.0)]
    pub roughness: R,
}

pub const MODEL: Model = Model {
    title: "glTF 2.0 metallic-roughness",
    paper: "khronos2021",
    year: 2017,
    claims: &[
        Reciprocal.always(),
        Passive.when("metallic = 1"),
        SamplesItself.always(),
        Isotropic.always(),
        NonNegative.always(),
        Smooth.when("roughness > 0.0317"),
    ],
    counterexamples: &[
        Counterexample {
            property: Passive,
            params: &[("base_color", 1.0), ("metallic", 0.0), ("roughness", 0.4)],
            wi_deg: [85.0, 0.0],
            wo_deg: [70.0, 180.0],
            because: "light that the boundary reflects on its way out is not taken from the diffuse part",
        },
        Counterexample {
            property: Smooth,
            params: &[("roughness", 0.03162277660168379)],
            wi_deg: [30.0, 0.0],
            wo_deg: [30.0, 180.0],
            because: "the width of the slopes stops at 0.001",
        },
    ],
    limits: &[Limit {
        at: &[("metallic", 1.0), ("roughness", 0.5)],
        equals: "ggx",
        link: &[("f0", "base_color")],
        with: &[("alpha_x", 0.25), ("alpha_y", 0.25)],
        tolerance: 0.0,
    }],
    ..Model::DEFAULT
};

impl<R: Real> MetallicRoughness<R> {
    #[inline(always)]
    fn alpha(&self) -> R {
        // the Sample Viewer's floor: a perfect mirror has no density
        (self.roughness * self.roughness).max(R::lit(1e-3)).named("alpha")
    }

    #[inline(always)]
    fn f0(&self) -> Color<R> {
        self.base_color.map(|c| self.metallic.lerp(R::lit(0.04), c)).named("f0")
    }

    /// The probability of drawing from the diffuse part: estimates of what both reflect towards `wo`.
    #[inline(always)]
    fn diffuse_share(&self, wo: Vec3<R>) -> R {
        let f0 = self.f0();
        let transmitted = f0.luminance().one_minus() * fresnel::schlick_complement(wo.z);
        let diffuse = transmitted * self.metallic.one_minus() * self.base_color.luminance();
        lobe::share(diffuse, fresnel::schlick(f0, wo.z).luminance())
    }
}

impl<R: Real> Bsdf<R> for MetallicRoughness<R> {
    #[inline(always)]
    fn eval(&self, wi: Vec3<R>, wo: Vec3<R>) -> Color<R> {
        let alpha = self.alpha();
        let (h, cos_d) = facet::half(wi, wo);
        let d = ndf::ggx_ratio(h, alpha, alpha);
        let v = masking::smith_ggx_visibility_ratio(wi, wo, alpha, alpha);
        let f = fresnel::schlick(self.f0(), cos_d).named("f");
        let diffuse = self.base_color * (self.metallic.one_minus() * R::FRAC_1_PI);
        f.one_minus() * diffuse + f * (d * v).value().named("dv")
    }

    #[inline(always)]
    fn sample(&self, wo: Vec3<R>, u: [R; 3]) -> Vec3<R> {
        let alpha = self.alpha();
        let diffuse = lobe::sample_cosine([u[0], u[1]]);
        let specular = wo.reflect(ndf::sample_ggx_visible(wo, alpha, alpha, [u[0], u[1]]));
        Vec3::select(u[2].lt(self.diffuse_share(wo)), diffuse, specular)
    }

    #[inline(always)]
    fn pdf(&self, wi: Vec3<R>, wo: Vec3<R>) -> R {
        let alpha = self.alpha();
        let specular = masking::smith_ggx_half_ratio(wo, alpha, alpha) * ndf::ggx_ratio(wi + wo, alpha, alpha);
        lobe::mixture(self.diffuse_share(wo), wi.z * R::FRAC_1_PI, R::HALF * specular.value())
    }
}
