//! Smooth glass: Fresnel, *Mémoire sur la loi des modifications que la réflexion imprime à la lumière polarisée*, 1823;
//! unpolarised light.

use crate::prelude::*;

/// A polished boundary between two clear media.
///
/// $$ L_o(\omega_o) = F\, L_i(\omega_r) + (1 - F)\,\frac{\eta_o^2}{\eta_i^2}\, L_i(\omega_t) $$
///
/// Radiance is compressed where light enters the denser medium, hence the squared indices; power is conserved.
#[derive(Params)]
pub struct Dielectric<R> {
    /// Refractive index below the surface divided by the one above.
    #[param(default = 1.5, range = 0.25..=4.0, slider = 1.0..=2.5)]
    pub ior: R,
}

pub const MODEL: Model = Model {
    title: "Smooth glass",
    paper: "fresnel1823",
    year: 1823,
    domain: Domain::BothSides,
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
        because: "all light goes into two directions",
    }],
    ..Model::DEFAULT
};

impl<R: Real> Bsdf<R> for Dielectric<R> {
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
        // eta_i / eta_o of the transmitted lobe
        let eta = R::select(wo.z.gt(R::ZERO), self.ior, self.ior.recip()).named("eta");
        let cos_o = wo.z.abs();
        let fresnel = fresnel::dielectric(eta, cos_o).named("fresnel");
        let mirrored = vec3(-wo.x, -wo.y, wo.z);
        // Snell: eta sin_t = sin_o
        let z2 = fresnel::refracted_normal2(eta, cos_o);
        let z = R::select(wo.z.gt(R::ZERO), -z2.safe_sqrt(), z2.safe_sqrt());
        let refracted = vec3(-wo.x, -wo.y, z) / eta;
        // total reflection: the refracted lobe has weight 0, and some direction
        let refracted = Vec3::select(z2.gt(R::ZERO), refracted, -wo);
        let transmitted = fresnel.one_minus();
        Some([
            Delta { wi: mirrored, weight: Color::splat(fresnel), probability: fresnel },
            Delta { wi: refracted, weight: Color::splat(transmitted / (eta * eta)), probability: transmitted },
        ])
    }
}
