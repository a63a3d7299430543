//! Burley, *Physically-Based Shading at Disney*, SIGGRAPH course 2012, as in the author's BRDF Explorer
//! (`disney.brdf`), which differs from the course notes in the masking and the sheen.

use crate::prelude::*;

/// The principled model: every dial between 0 and 1, every combination plausible to the eye.
///
/// $$ f_r = (1 - m)\left(\frac{c}{\pi}\,\mathrm{mix}(f_d, f_{ss}) + f_{sheen}\right) + D_s F_s G_s
///        + \tfrac{1}{4}\,k_{cc}\,D_r F_r G_r $$
///
/// It gains energy: the diffuse and subsurface lobes up to 1.4 and 1.5 at grazing angles.
#[derive(Params)]
pub struct Disney2012<R> {
    /// Colour of the surface; linear.
    #[param(default = 0.5, range = 0.0..=1.0)]
    pub base_color: Color<R>,
    /// 0 for a dielectric, 1 for a metal.
    #[param(default = 0.0, range = 0.0..=1.0)]
    pub metallic: R,
    /// From the diffuse shape to that of subsurface scattering.
    #[param(default = 0.0, range = 0.0..=1.0)]
    pub subsurface: R,
    /// Strength of the dielectric highlight; 0.5 is a reflectance of 0.04 at normal incidence.
    #[param(default = 0.5, range = 0.0..=1.0)]
    pub specular: R,
    /// The dial of diffuse and specular response: the width of the facet slopes is its square.
    #[param(default = 0.5, range = 0.0..=1.0)]
    pub roughness: R,
    /// Tints the dielectric highlight with the hue of the base colour.
    #[param(default = 0.0, range = 0.0..=1.0)]
    pub specular_tint: R,
    /// Aspect of the highlight: 0 is round, 1 is ten times as wide along the tangent as across.
    #[param(default = 0.0, range = 0.0..=1.0)]
    pub anisotropic: R,
    /// Grazing glow of cloth.
    #[param(default = 0.0, range = 0.0..=1.0)]
    pub sheen: R,
    /// Tints the sheen with the hue of the base colour.
    #[param(default = 0.5, range = 0.0..=1.0)]
    pub sheen_tint: R,
    /// Strength of a second highlight, that of a lacquer.
    #[param(default = 0.0, range = 0.0..=1.0)]
    pub clearcoat: R,
    /// Gloss of the lacquer: 0 is satin, 1 is glossy.
    #[param(default = 1.0, range = 0.0..=1.0)]
    pub clearcoat_gloss: R,
}

pub const MODEL: Model = Model {
    title: "Disney's principled model of 2012",
    paper: "burley2012",
    year: 2012,
    claims: &[
        Reciprocal.always(),
        SamplesItself.always(),
        Isotropic.when("anisotropic = 0"),
        NonNegative.always(),
        Smooth.when("roughness > 0.0563 and base_color >= 0.01"),
    ],
    counterexamples: &[
        Counterexample {
            property: Passive,
            params: &[("base_color", 1.0), ("roughness", 1.0)],
            wi_deg: [85.0, 0.0],
            wo_deg: [70.0, 180.0],
            because: "the diffuse lobe was fitted to the eye, not to a sum of 1",
        },
        Counterexample {
            property: Isotropic,
            params: &[("anisotropic", 1.0), ("metallic", 1.0)],
            wi_deg: [30.0, 0.0],
            wo_deg: [50.0, 140.0],
            because: "the highlight is wider along than across",
        },
        Counterexample {
            property: Smooth,
            params: &[("roughness", 0.03162277660168379), ("metallic", 1.0)],
            wi_deg: [30.0, 0.0],
            wo_deg: [30.0, 180.0],
            because: "the width of the slopes stops at 0.001",
        },
        Counterexample {
            property: Smooth,
            params: &[("base_color", 0.0), ("specular_tint", 1.0)],
            wi_deg: [30.0, 0.0],
            wo_deg: [30.0, 180.0],
            because: "black has no hue",
        },
    ],
    ..Model::DEFAULT
};

impl<R: Real> Disney2012<R> {
    /// Widths of the facet slopes along and across the tangent.
    #[inline(always)]
    fn alphas(&self) -> (R, R) {
        let aspect = (R::lit(0.9) * self.anisotropic).one_minus().sqrt().named("aspect");
        let alpha = self.roughness * self.roughness;
        let floor = R::lit(1e-3);
        ((alpha / aspect).max(floor).named("alpha_x"), (alpha * aspect).max(floor).named("alpha_y"))
    }

    #[inline(always)]
    fn clearcoat_alpha(&self) -> R {
        self.clearcoat_gloss.lerp(R::lit(0.1), R::lit(0.001)).named("clearcoat_alpha")
    }

    /// The hue: the base colour at luminance 1.
    #[inline(always)]
    fn tint(&self) -> Color<R> {
        // DEPARTS: the author weighs the channels 0.3, 0.6, 0.1
        let luminance = self.base_color.luminance();
        let tint = self.base_color / luminance.max(R::lit(1e-30));
        Color::select(luminance.gt(R::ZERO), tint, Color::WHITE).named("tint")
    }

    #[inline(always)]
    fn f0(&self) -> Color<R> {
        let dielectric = Color::lerp(self.specular_tint, Color::WHITE, self.tint()) * (R::lit(0.08) * self.specular);
        Color::lerp(self.metallic, dielectric, self.base_color).named("f0")
    }

    /// The probabilities of drawing from the diffuse part, the specular part and the clearcoat: estimates of what they
    /// reflect towards `wo`.
    #[inline(always)]
    fn shares(&self, wo: Vec3<R>) -> [R; 3] {
        let m = fresnel::schlick_weight(wo.z);
        let diffuse = self.metallic.one_minus() * self.sheen.fma(R::lit(0.1), self.base_color.luminance());
        let specular = fresnel::schlick(self.f0(), wo.z).luminance().max(R::lit(0.02));
        let clearcoat = R::lit(0.25) * self.clearcoat * m.lerp(R::lit(0.04), R::ONE);
        let scale = (diffuse + specular + clearcoat).recip();
        [diffuse * scale, specular * scale, clearcoat * scale]
    }
}

impl<R: Real> Bsdf<R> for Disney2012<R> {
    #[inline(always)]
    fn eval(&self, wi: Vec3<R>, wo: Vec3<R>) -> Color<R> {
        let (h, cos_d) = facet::half(wi, wo);
        let weight = fresnel::schlick_weight(cos_d).named("schlick_weight");
        let fd = diffuse::burley(wi.z, wo.z, cos_d, self.roughness).named("fd");
        let ss = diffuse::burley_subsurface(wi.z, wo.z, cos_d, self.roughness).named("ss");
        let sheen = Color::lerp(self.sheen_tint, Color::WHITE, self.tint()) * (self.sheen * weight);
        let matte = (self.base_color * self.subsurface.lerp(fd, ss) + sheen) * self.metallic.one_minus();

        let (alpha_x, alpha_y) = self.alphas();
        let ds = ndf::ggx_ratio(h, alpha_x, alpha_y);
        let vs = masking::smith_ggx_visibility_separable_ratio(wi, wo, alpha_x, alpha_y);
        let specular = fresnel::schlick(self.f0(), cos_d) * (ds * vs).value().named("dv");

        let dr = ndf::gtr1(h, self.clearcoat_alpha()).named("dr");
        let fr = weight.lerp(R::lit(0.04), R::ONE).named("fr");
        let quarter = R::lit(0.25);
        let vr = masking::smith_ggx_visibility_separable(wi, wo, quarter, quarter).named("vr");
        matte + specular + Color::splat(quarter * self.clearcoat * dr * fr * vr)
    }

    #[inline(always)]
    fn sample(&self, wo: Vec3<R>, u: [R; 3]) -> Vec3<R> {
        let (alpha_x, alpha_y) = self.alphas();
        let matte = lobe::sample_cosine([u[0], u[1]]);
        let specular = wo.reflect(ndf::sample_ggx_visible(wo, alpha_x, alpha_y, [u[0], u[1]]));
        let clearcoat = wo.reflect(ndf::sample_gtr1(self.clearcoat_alpha(), [u[0], u[1]]));
        let [to_matte, to_specular, _] = self.shares(wo);
        let glossy = Vec3::select(u[2].lt(to_matte + to_specular), specular, clearcoat);
        Vec3::select(u[2].lt(to_matte), matte, glossy)
    }

    #[inline(always)]
    fn pdf(&self, wi: Vec3<R>, wo: Vec3<R>) -> R {
        let (alpha_x, alpha_y) = self.alphas();
        let h = wi + wo;
        let specular = masking::smith_ggx_half_ratio(wo, alpha_x, alpha_y) * ndf::ggx_ratio(h, alpha_x, alpha_y);
        let clearcoat = facet::reflected_pdf(ndf::gtr1(h, self.clearcoat_alpha()), h);
        let [to_matte, to_specular, to_clearcoat] = self.shares(wo);
        to_matte * wi.z * R::FRAC_1_PI + to_specular * (R::HALF * specular.value()) + to_clearcoat * clearcoat
    }
}
