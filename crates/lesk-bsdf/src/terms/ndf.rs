//! Distributions of facet normals: D(h) in 1/sr, with the integral of D(h) cos(theta_h) equal to 1.

use lesk_math::{Real, Vec3, vec3};

/// Anisotropic GGX (walter2007 Eq. 33; anisotropic form burley2012, heitz2014 Eq. 85).
#[inline(always)]
pub fn ggx<R: Real>(h: Vec3<R>, alpha_x: R, alpha_y: R) -> R {
    let (x, y) = (h.x / alpha_x, h.y / alpha_y);
    let e = x.fma(x, y.fma(y, h.z * h.z));
    (R::PI * alpha_x * alpha_y * e * e).recip()
}

/// A facet normal visible from `wo` (z > 0), with density G1(wo) max(0, wo.h) D(h) / wo.z
/// (heitz2018; construction by spherical caps, dupuy2023).
#[inline(always)]
pub fn sample_ggx_visible<R: Real>(wo: Vec3<R>, alpha_x: R, alpha_y: R, u: [R; 2]) -> Vec3<R> {
    let ws = vec3(alpha_x * wo.x, alpha_y * wo.y, wo.z).normalize();
    let phi = R::TWO * R::PI * u[0];
    let z = u[1].one_minus() * (R::ONE + ws.z) - ws.z;
    let r = (R::ONE - z * z).safe_sqrt();
    let h = vec3(r * phi.cos(), r * phi.sin(), z) + ws;
    vec3(alpha_x * h.x, alpha_y * h.y, h.z.max(R::lit(1e-7))).normalize()
}
