//! Ideal specular reflection: Newton, *Opticks*, 1704, axiom II.

use crate::prelude::*;

/// A perfectly smooth surface: light leaves at the angle at which it arrives, on the other side of the normal.
///
/// $$ L_o(\omega_o) = \rho\, L_i(\omega_r) $$
///
/// The reflectance is the same at all angles; `conductor` and `dielectric` have Fresnel's.
#[derive(Params)]
pub struct Mirror<R> {
    /// Share of the light that is reflected.
    #[param(default = 0.9, range = 0.0..=1.0)]
    pub reflectance: Color<R>,
}

pub const MODEL: Model = Model {
    title: "Ideal mirror",
    paper: "newton1704",
    year: 1704,
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

impl<R: Real> Bsdf<R> for Mirror<R> {
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
        Some([Delta { wi, weight: self.reflectance, probability: R::ONE }, Delta::NONE])
    }
}
