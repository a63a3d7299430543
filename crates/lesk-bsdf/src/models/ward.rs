//! Ward, *Measuring and Modeling Anisotropic Reflection*, SIGGRAPH 1992; density of the samples after Walter, *Notes on
//! the Ward BRDF*, PCG-05-06, Cornell 2005. Equation numbers refer to Ward unless named.

use crate::prelude::*;

/// A Gaussian highlight, fitted to measurements of brushed metal and varnished wood.
///
/// $$ f_r = \frac{\rho_d}{\pi} + \rho_s\,\frac{e^{-\tan^2\theta_h\,(\cos^2\phi_h/\alpha_x^2 +
///    \sin^2\phi_h/\alpha_y^2)}}{4\pi\,\alpha_x\alpha_y\sqrt{\cos\theta_i\cos\theta_o}} $$
///
/// It loses energy at middle angles and gains it within half a degree of the horizon.
#[derive(Params)]
pub struct Ward<R> {
    /// Diffuse reflectance.
    #[param(default = 0.3, range = 0.0..=1.0)]
    pub diffuse: Color<R>,
    /// Reflectance of the highlight at normal incidence, about.
    #[param(default = 0.5, range = 0.0..=1.0)]
    pub specular: Color<R>,
    /// Root mean square of the surface slope along the tangent; 0.1 is satin.
    #[param(default = 0.15, range = 1e-3..=1.0, slider = 0.02..=0.5, scale = "log")]
    pub alpha_x: R,
    /// Root mean square of the surface slope across the tangent.
    #[param(default = 0.15, range = 1e-3..=1.0, slider = 0.02..=0.5, scale = "log")]
    pub alpha_y: R,
}

pub const MODEL: Model = Model {
    title: "Ward's anisotropic model",
    paper: "ward1992",
    year: 1992,
    claims: &[
        Reciprocal.always(),
        SamplesItself.always(),
        Isotropic.when("alpha_x = alpha_y"),
        NonNegative.always(),
        Smooth.always(),
    ],
    counterexamples: &[
        Counterexample {
            property: Passive,
            params: &[("diffuse", 0.0), ("specular", 1.0), ("alpha_x", 0.2), ("alpha_y", 0.2)],
            wi_deg: [89.995, 0.0],
            wo_deg: [80.0, 180.0],
            because: "the root of the cosines leaves a reflectance that grows as 1/sqrt(cos theta_i)",
        },
        Counterexample {
            property: Isotropic,
            params: &[("alpha_x", 0.1), ("alpha_y", 0.3)],
            wi_deg: [30.0, 0.0],
            wo_deg: [50.0, 140.0],
            because: "the highlight is wider across than along",
        },
    ],
    limits: &[Limit {
        at: &[("specular", 0.0)],
        equals: "lambert",
        link: &[("reflectance", "diffuse")],
        with: &[],
        tolerance: 0.0,
    }],
    ..Model::DEFAULT
};

impl<R: Real> Ward<R> {
    /// The probability of drawing from the diffuse part.
    #[inline(always)]
    fn diffuse_share(&self) -> R {
        lobe::share(self.diffuse.luminance(), self.specular.luminance())
    }
}

impl<R: Real> Bsdf<R> for Ward<R> {
    #[inline(always)]
    fn eval(&self, wi: Vec3<R>, wo: Vec3<R>) -> Color<R> {
        let h = (wi + wo).named("h");
        let gauss = (-ndf::beckmann_tan2(h, self.alpha_x, self.alpha_y)).exp().named("gauss");
        let norm = (R::lit(4.0) * R::PI * self.alpha_x * self.alpha_y).recip();
        let highlight = norm * gauss / (wi.z * wo.z).sqrt(); // Eq. 5a
        self.diffuse * R::FRAC_1_PI + self.specular * highlight
    }

    #[inline(always)]
    fn sample(&self, wo: Vec3<R>, u: [R; 3]) -> Vec3<R> {
        let diffuse = lobe::sample_cosine([u[0], u[1]]);
        let highlight = wo.reflect(ndf::sample_beckmann(self.alpha_x, self.alpha_y, [u[0], u[1]]));
        Vec3::select(u[2].lt(self.diffuse_share()), diffuse, highlight)
    }

    #[inline(always)]
    fn pdf(&self, wi: Vec3<R>, wo: Vec3<R>) -> R {
        let h = wi + wo;
        // walter2005; the paper's own density lacks the Jacobian of the half vector
        let highlight = facet::reflected_pdf(ndf::beckmann(h, self.alpha_x, self.alpha_y), h);
        lobe::mixture(self.diffuse_share(), wi.z * R::FRAC_1_PI, highlight)
    }
}
