//! Reflectance of a smooth boundary.

use super::ratio::{self, Ratio};
use lesk_math::{Color, Real};

/// Schlick's approximation (schlick1994): F0 + (1 - F0)(1 - cos)^5.
#[inline(always)]
pub fn schlick<R: Real>(f0: Color<R>, cos_theta: R) -> Color<R> {
    let m = schlick_weight(cos_theta);
    f0.map(|f0| m.fma(f0.one_minus(), f0))
}

/// The (1 - cos)^5 of Schlick's approximation.
#[inline(always)]
pub fn schlick_weight<R: Real>(cos_theta: R) -> R {
    // a rounded cosine may be larger than 1, and the fifth power negative
    cos_theta.min(R::ONE).one_minus().powi(5)
}

/// 1 - (1 - cos)^5, with all digits at grazing angles, where the difference would have none.
#[inline(always)]
pub fn schlick_complement<R: Real>(cos_theta: R) -> R {
    let c = cos_theta;
    c * (R::lit(5.0) - c * (R::lit(10.0) - c * (R::lit(10.0) - c * (R::lit(5.0) - c))))
}

/// The squared length eta cos_t of the refracted direction's part along the normal: eta^2 - sin^2; at most 0 where
/// reflection is total. Near eta = 1 and at grazing angles the product keeps the digits that a square would lose.
#[inline(always)]
pub fn refracted_normal2<R: Real>(eta: R, cos_theta: R) -> R {
    cos_theta.fma(cos_theta, (eta - R::ONE) * (eta + R::ONE))
}

/// Exact unpolarised reflectance of a dielectric boundary (fresnel1823); `cos_theta` >= 0 on the side where light
/// comes from, `eta` = n(other side) / n(this side). Total internal reflection gives 1.
#[inline(always)]
pub fn dielectric<R: Real>(eta: R, cos_theta: R) -> R {
    dielectric_between(eta, cos_theta, refracted_normal2(eta, cos_theta))
}

/// [`dielectric`] where g2 = eta^2 cos^2 theta_t is known better than it follows from `cos_theta`.
#[inline(always)]
pub fn dielectric_between<R: Real>(eta: R, cos_theta: R, g2: R) -> R {
    let g = g2.safe_sqrt();
    let c = cos_theta;
    // (g - c)/(g + c) with g^2 - c^2 = eta^2 - 1
    let sum = g + c;
    let a = (eta - R::ONE) * (eta + R::ONE) / (sum * sum);
    let b = (c * (g + c) - R::ONE) / (c * (g - c) + R::ONE);
    let f = R::HALF * a * a * (R::ONE + b * b);
    R::select(g2.gt(R::ZERO), f, R::ONE)
}

/// Exact unpolarised reflectance of a metal with the complex index eta + i k, seen from vacuum (born1999).
///
/// In `f32` it is good to 1e-7 absolutely, not relatively: where there is hardly a boundary (eta near 1, k near 0).
#[inline(always)]
pub fn conductor<R: Real>(eta: R, k: R, cos_theta: R) -> R {
    conductor_ratio(eta, k, cos_theta).value()
}

/// [`conductor`] of each channel.
#[inline(always)]
pub(crate) fn conductors<R: Real>(eta: Color<R>, k: Color<R>, cos_theta: R) -> Color<R> {
    // a denominator is at least cos^2 theta where it is smallest (eta = 1, k = 0), and below 1e6
    ratio::values(|c| conductor_ratio(eta.0[c], k.0[c], cos_theta))
}

#[inline(always)]
fn conductor_ratio<R: Real>(eta: R, k: R, cos_theta: R) -> Ratio<R> {
    let c2 = cos_theta * cos_theta;
    let s2 = c2.one_minus();
    let (eta2, k2) = (eta * eta, k * k);
    let t0 = eta2 - k2 - s2;
    let a2b2 = t0.fma(t0, R::lit(4.0) * eta2 * k2).safe_sqrt();
    let a = (R::HALF * (a2b2 + t0)).safe_sqrt();
    let t1 = a2b2 + c2;
    let t2 = R::TWO * a * cos_theta;
    let t3 = c2.fma(a2b2, s2 * s2);
    let t4 = t2 * s2;
    // (Rs + Rp)/2 with Rp = Rs (t3 - t4)/(t3 + t4): (t1-t2)/(t1+t2) * t3/(t3+t4)
    Ratio { over: (t1 - t2) * t3, under: (t1 + t2) * (t3 + t4) }
}
