//! Smooth metal with exact Fresnel reflectance: Born & Wolf, *Principles of Optics*, 7th edition, 1999, section 14.2.

use crate::prelude::*;

/// A polished metal in air.
///
/// $$ L_o(\omega_o) = F(\cos\theta_o;\, \eta + i k)\, L_i(\omega_r) $$
///
/// The default is gold (johnson1972, at 650, 550 and 450 nm).
#[derive(Params)]
pub struct Conductor<R> {
    /// Real part of the refractive index.
    #[param(default = [0.16, 0.42, 1.38], range = 0.01..=10.0, slider = 0.05..=4.0)]
    pub eta: Color<R>,
    /// Imaginary part of the refractive index: absorption.
    #[param(default = [3.6, 2.47, 1.92], range = 0.0..=20.0, slider = 0.0..=8.0)]
    pub k: Color<R>,
}

pub const MODEL: Model = Model {
    title: "Smooth metal",
    paper: "born1999",
    year: 1999,
    claims: &[
        Reciprocal.always(),
        Passive.always(),
        SamplesItself.always(),
        Isotropic.always(),
        NonNegative.always(),
    ],
    counterexamples: &[Counterexample {
        property: Smooth,
        params: &[],
        wi_deg: [30.0, 180.0],
        wo_deg: [30.0, 0.0],
        because: "all light goes into one direction",
    }],
    ..Model::DEFAULT
};

impl<R: Real> Bsdf<R> for Conductor<R> {
    #[inline(always)]
    fn eval(&self, _wi: Vec3<R>, _wo: Vec3<R>) -> Color<R> {
        Color::BLACK
    }

    #[inline(always)]
    fn sample(&self, _wo: Vec3<R>, _u: [R; 3]) -> Vec3<R> {
        Vec3::Z
    }

    #[inline(always)]
    fn pdf(&self, _wi: Vec3<R>, _wo: Vec3<R>) -> R {
        R::ZERO
    }

    #[inline(always)]
    fn delta(&self, wo: Vec3<R>) -> Option<[Delta<R>; 2]> {
        let wi = vec3(-wo.x, -wo.y, wo.z);
        let fresnel = fresnel::conductors(self.eta, self.k, wo.z).named("fresnel");
        Some([Delta { wi, weight: fresnel, probability: R::ONE }, Delta::NONE])
    }
}
