//! Lobes that several models have.

use lesk_math::{Frame, Real, Vec3, vec3};

/// A direction with density cos/pi around +z.
#[inline(always)]
pub fn sample_cosine<R: Real>(u: [R; 2]) -> Vec3<R> {
    let phi = R::TWO * R::PI * u[0];
    let r = u[1].safe_sqrt();
    vec3(r * phi.cos(), r * phi.sin(), u[1].one_minus().safe_sqrt())
}

/// The cosine of the angle between `wi` and the mirror image of `wo` about the normal.
#[inline(always)]
pub fn cos_mirror<R: Real>(wi: Vec3<R>, wo: Vec3<R>) -> R {
    wi.z * wo.z - wi.x.fma(wo.x, wi.y * wo.y)
}

/// cos^n, or 0 on the far side (cos <= 0), also for n = 0.
#[inline(always)]
pub fn cos_power<R: Real>(cos: R, n: R) -> R {
    R::select(cos.gt(R::ZERO), cos.pow(n), R::ZERO)
}

/// cos^n of the polar angle of `h` (z > 0, any length): (1 + tan^2)^(-n/2), as the cosine itself has no digits left for
/// narrow lobes.
#[inline(always)]
pub(crate) fn polar_cos_power<R: Real>(h: Vec3<R>, n: R) -> R {
    let tan2 = (h.x.fma(h.x, h.y * h.y) / (h.z * h.z)).named("tan2");
    (-R::HALF * n * tan2.log2_1p()).exp2()
}

/// A direction with density (n + 1)/(2 pi) cos^n around the mirror image of `wo` (lafortune1994).
#[inline(always)]
pub fn sample_phong<R: Real>(wo: Vec3<R>, n: R, u: [R; 2]) -> Vec3<R> {
    let around_z = super::ndf::sample_cos_power(n, u);
    Frame::from_normal(vec3(-wo.x, -wo.y, wo.z)).world_from_local(around_z)
}

/// The density of [`sample_phong`].
#[inline(always)]
pub fn phong_pdf<R: Real>(wi: Vec3<R>, wo: Vec3<R>, n: R) -> R {
    (n + R::ONE) * R::lit(0.5 * core::f64::consts::FRAC_1_PI) * cos_power(cos_mirror(wi, wo), n)
}

/// The density of drawing from a lobe of density `first` with probability `share`, else from one of density `second`.
#[inline(always)]
pub(crate) fn mixture<R: Real>(share: R, first: R, second: R) -> R {
    share.fma(first, share.one_minus() * second)
}

/// The share of `a` in `a + b`, both >= 0; 0 if both are 0.
#[inline(always)]
pub fn share<R: Real>(a: R, b: R) -> R {
    a / (a + b).max(R::lit(1e-30))
}
