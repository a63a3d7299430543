//! Blinn, *Models of Light Reflection for Computer Synthesized Pictures*, SIGGRAPH 1977, used as a BRDF; the
//! normalisation is that of Akenine-Möller, Haines & Hoffman, *Real-Time Rendering*, 3rd edition, 2008, section 7.6.

use crate::prelude::*;

/// The highlight of the half vector, as games and viewers have it.
///
/// $$ f_r = \frac{k_d}{\pi} + k_s\,\frac{n + 8}{8\pi}\cos^n\theta_h $$
///
/// The factor is a rounded one: around n = 8.8 the highlight is up to 7.52 % brighter than its light.
#[derive(Params)]
pub struct BlinnPhong<R> {
    /// Diffuse reflectance.
    #[param(default = 0.4, range = 0.0..=1.0)]
    pub diffuse: Color<R>,
    /// Reflectance of the highlight at normal incidence, about.
    #[param(default = 0.4, range = 0.0..=1.0)]
    pub specular: Color<R>,
    /// Exponent n; about four times that of Phong's model for the same look.
    #[param(default = 80.0, range = 0.0..=1e4, slider = 1.0..=1000.0, scale = "log")]
    pub shininess: R,
}

pub const MODEL: Model = Model {
    title: "Blinn-Phong model",
    paper: "blinn1977",
    year: 1977,
    claims: &[
        Reciprocal.always(),
        Passive.when("diffuse + 1.0753 * specular <= 1"),
        SamplesItself.always(),
        Isotropic.always(),
        NonNegative.always(),
        Smooth.always(),
    ],
    counterexamples: &[Counterexample {
        property: Passive,
        params: &[("diffuse", 0.0), ("specular", 1.0), ("shininess", 8.76)],
        wi_deg: [0.0, 0.0],
        wo_deg: [0.0, 0.0],
        because: "(n + 8)/(8 pi) is a rounded normalisation",
    }],
    limits: &[
        Limit {
            at: &[("specular", 0.0)],
            equals: "lambert",
            link: &[("reflectance", "diffuse")],
            with: &[],
            tolerance: 0.0,
        },
        Limit {
            at: &[("diffuse", 0.0), ("shininess", 0.0)],
            equals: "lambert",
            link: &[("reflectance", "specular")],
            with: &[],
            tolerance: 0.0,
        },
    ],
    ..Model::DEFAULT
};

impl<R: Real> BlinnPhong<R> {
    /// The probability of drawing like from a diffuse surface: the diffuse part, and most of a broad highlight, whose
    /// half vectors would lead below the horizon.
    #[inline(always)]
    fn diffuse_share(&self) -> R {
        let broad = R::lit(4.0) / (self.shininess + R::lit(4.0));
        let highlight = self.specular.luminance();
        lobe::share(self.diffuse.luminance() + highlight * broad, highlight * broad.one_minus())
    }
}

impl<R: Real> Bsdf<R> for BlinnPhong<R> {
    #[inline(always)]
    fn eval(&self, wi: Vec3<R>, wo: Vec3<R>) -> Color<R> {
        let h = (wi + wo).named("h");
        let norm = (self.shininess + R::lit(8.0)) * R::lit(0.125 * core::f64::consts::FRAC_1_PI);
        let highlight = norm * lobe::polar_cos_power(h, self.shininess);
        self.diffuse * R::FRAC_1_PI + self.specular * highlight
    }

    #[inline(always)]
    fn sample(&self, wo: Vec3<R>, u: [R; 3]) -> Vec3<R> {
        let diffuse = lobe::sample_cosine([u[0], u[1]]);
        let highlight = wo.reflect(ndf::sample_cos_power(self.shininess, [u[0], u[1]]));
        Vec3::select(u[2].lt(self.diffuse_share()), diffuse, highlight)
    }

    #[inline(always)]
    fn pdf(&self, wi: Vec3<R>, wo: Vec3<R>) -> R {
        let (h, cos_d) = facet::half(wi, wo);
        let facets = (self.shininess + R::ONE) * R::lit(0.5 * core::f64::consts::FRAC_1_PI);
        let highlight = facets * lobe::polar_cos_power(h, self.shininess) / (R::lit(4.0) * cos_d);
        lobe::mixture(self.diffuse_share(), wi.z * R::FRAC_1_PI, highlight)
    }
}
