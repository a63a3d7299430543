//! Cook & Torrance, *A Reflectance Model for Computer Graphics*, ACM TOG 1(1), 1982, in the form of today's lectures:
//! normalised D, 1/4 instead of 1/pi, Schlick's Fresnel term. Sampling of V-grooves after Heitz & d'Eon, *Importance
//! Sampling Microfacet-Based BSDFs using the Distribution of Visible Normals*, EGSR 2014 (heitz2014b).

use crate::prelude::*;

/// Reflection from a rough boundary: Gaussian slopes, facets in V-grooves.
///
/// $$ f_r = \frac{F\,D\,G}{4\cos\theta_i\cos\theta_o},\quad
///    D = \frac{e^{-\tan^2\theta_h/\alpha^2}}{\pi\alpha^2\cos^4\theta_h},\quad
///    G = \min\left(1, \frac{2\cos\theta_h\cos\theta_i}{\cos\theta_d}, \frac{2\cos\theta_h\cos\theta_o}{\cos\theta_d}\right) $$
///
/// Single scattering only. The formula is often met with 1/π beside a normalised D: that is 4/π times too bright.
#[derive(Params)]
pub struct CookTorrance<R> {
    /// Reflectance at normal incidence.
    #[param(default = 0.9, range = 0.0..=1.0)]
    pub f0: Color<R>,
    /// Width of the facet slopes, the paper's m; 0.1 is satin, 0.5 is matte.
    #[param(default = 0.25, range = 1e-3..=1.0, slider = 0.02..=0.6, scale = "log")]
    pub alpha: R,
}

pub const MODEL: Model = Model {
    title: "Cook-Torrance model: Beckmann's distribution, V-grooves, Schlick's Fresnel term",
    paper: "cook1982",
    year: 1982,
    claims: &[
        Reciprocal.always(),
        Passive.always(),
        SamplesItself.always(),
        Isotropic.always(),
        NonNegative.always(),
        Smooth.always(),
    ],
    seams: &[
        Seam { doc: "the light begins to be shadowed", zero: |wi, wo| masked(wi, wi + wo) },
        Seam { doc: "the viewer begins to be masked", zero: |wi, wo| masked(wo, wi + wo) },
        Seam { doc: "equal polar angles", zero: |wi, wo| wi.z - wo.z },
    ],
    ..Model::DEFAULT
};

/// Zero where 2 cos theta_h cos theta = cos theta_d, for `h` = wi + wo.
fn masked(w: Vec3<f64>, h: Vec3<f64>) -> f64 {
    4.0 * h.z * w.z - h.length_squared()
}

impl<R: Real> Bsdf<R> for CookTorrance<R> {
    #[inline(always)]
    fn eval(&self, wi: Vec3<R>, wo: Vec3<R>) -> Color<R> {
        let (h, cos_d) = facet::half(wi, wo);
        let d = ndf::beckmann(h, self.alpha, self.alpha).named("d");
        let v = masking::v_groove_visibility_ratio(wi, wo, h).value().named("v"); // G / (4 cos_i cos_o)
        let f = fresnel::schlick(self.f0, cos_d);
        f * (d * v)
    }

    #[inline(always)]
    fn sample(&self, wo: Vec3<R>, u: [R; 3]) -> Vec3<R> {
        let h = ndf::sample_beckmann(self.alpha, self.alpha, [u[0], u[1]]);
        wo.reflect(ndf::sample_v_groove(h, wo, u[2]))
    }

    #[inline(always)]
    fn pdf(&self, wi: Vec3<R>, wo: Vec3<R>) -> R {
        let h = wi + wo;
        // heitz2014b: G1(wo) (wo.h) D / wo.z, times 1/(4 wo.h)
        masking::v_groove_half_ratio(wo, h).value() * ndf::beckmann(h, self.alpha, self.alpha)
    }
}
