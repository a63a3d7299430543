//! Lobes that several models draw from.

use lesk_math::{Real, Vec3, vec3};

/// A direction with density cos/pi around +z.
#[inline(always)]
pub fn sample_cosine<R: Real>(u: [R; 3]) -> Vec3<R> {
    let phi = R::TWO * R::PI * u[0];
    let r = u[1].safe_sqrt();
    vec3(r * phi.cos(), r * phi.sin(), u[1].one_minus().safe_sqrt())
}
