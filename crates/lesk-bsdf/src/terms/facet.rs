//! The facet that mirrors one direction to another.

use lesk_math::{Real, Vec3};

/// The facet normal h = wi + wo, not of unit length, and cos theta_d = wi.h/|h| = wo.h/|h|.
///
/// Half the length of wi + wo is the mean of the two products. Unlike either it is the same to the last bit when
/// `wi` and `wo` are swapped, and it does not cancel where both graze the surface from opposite sides.
#[inline(always)]
pub fn half<R: Real>(wi: Vec3<R>, wo: Vec3<R>) -> (Vec3<R>, R) {
    let h = (wi + wo).named("h");
    (h, (R::HALF * h.length_squared().safe_sqrt()).named("cos_d"))
}

/// The density in 1/sr of the mirrored direction where facets have the density `d` cos theta_h (walter2007 Eq. 14):
/// d cos theta_h / (4 cos theta_d), with `h` = wi + wo.
#[inline(always)]
pub fn reflected_pdf<R: Real>(d: R, h: Vec3<R>) -> R {
    d * h.z / (R::TWO * h.length_squared())
}
