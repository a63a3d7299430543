//! Ideal diffuse reflection: Lambert, *Photometria*, 1760.

use crate::prelude::*;

/// A surface that looks equally bright from everywhere.
///
/// $$ f_r = \frac{\rho}{\pi} $$
#[derive(Params)]
pub struct Lambert<R> {
    /// Share of the light that is reflected.
    #[param(default = 0.5, range = 0.0..=1.0)]
    pub reflectance: Color<R>,
}

pub const MODEL: Model = Model {
    title: "Lambert's ideal diffuse reflection",
    paper: "lambert1760",
    year: 1760,
    claims: &[
        Reciprocal.always(),
        Passive.always(),
        SamplesItself.always(),
        Isotropic.always(),
        NonNegative.always(),
        Smooth.always(),
    ],
    ..Model::DEFAULT
};

impl<R: Real> Bsdf<R> for Lambert<R> {
    #[inline(always)]
    fn eval(&self, _wi: Vec3<R>, _wo: Vec3<R>) -> Color<R> {
        self.reflectance * R::FRAC_1_PI
    }

    #[inline(always)]
    fn sample(&self, _wo: Vec3<R>, u: [R; 3]) -> Vec3<R> {
        lobe::sample_cosine([u[0], u[1]])
    }

    #[inline(always)]
    fn pdf(&self, wi: Vec3<R>, _wo: Vec3<R>) -> R {
        wi.z * R::FRAC_1_PI
    }
}
