//! How far a ray must start from a surface not to meet it again.

use lesk_math::Vec3;

/// Distance along the unit normal `n` by which a point must be lifted off its surface, where `magnitude` bounds the
/// coordinates that the point and the intersection test are computed from.
///
/// Interpolating a point (four roundings), the watertight test of the next ray (two subtractions, a shear and a sum of
/// three products: at most ten roundings along the normal) and the final rounding of the lifted point each cost at most
/// 2^-24 of the coordinates involved; their sum is taken as 32 * 2^-24. The idea of an error bound per hit instead of a
/// constant: Pharr, Jakob & Humphreys, *Physically Based Rendering*, 4th ed., section 6.8.
#[inline]
pub(crate) fn lift(n: Vec3<f32>, magnitude: Vec3<f32>) -> f32 {
    const ROUNDINGS: f32 = 32.0 * 5.960_464_5e-8;
    let along = n.x.abs() * magnitude.x + n.y.abs() * magnitude.y + n.z.abs() * magnitude.z;
    // an axis-aligned plane through the origin has no magnitude along its normal: a share of the rest keeps t above the
    // rounding of the other two coordinates
    let all = magnitude.x + magnitude.y + magnitude.z;
    ROUNDINGS * (along + 0.03125 * all)
}

/// Component-wise absolute value.
#[inline]
pub(crate) fn abs(v: Vec3<f32>) -> Vec3<f32> {
    v.map(f32::abs)
}
