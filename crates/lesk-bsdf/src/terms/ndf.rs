//! Distributions of facet normals: D(h) in 1/sr, with the integral of D(h) cos(theta_h) equal to 1.
//!
//! D depends on the direction of `h` alone: `h` may have any length, and wi + wo needs no normalisation. The angle
//! enters through the components across the normal, never as 1 - cos^2, which cancels at the peak of a narrow lobe.

use super::ratio::Ratio;
use lesk_math::{Real, Vec3, vec3};

/// Anisotropic GGX (walter2007 Eq. 33; anisotropic form burley2012, heitz2014 Eq. 85):
/// 1 / (pi alpha_x alpha_y (hx^2/alpha_x^2 + hy^2/alpha_y^2 + hz^2)^2).
#[inline(always)]
pub fn ggx<R: Real>(h: Vec3<R>, alpha_x: R, alpha_y: R) -> R {
    ggx_ratio(h, alpha_x, alpha_y).value()
}

/// [`ggx`], not divided yet.
#[inline(always)]
pub(crate) fn ggx_ratio<R: Real>(h: Vec3<R>, alpha_x: R, alpha_y: R) -> Ratio<R> {
    // reciprocals of parameters: divisions that leave a loop over directions
    let (x, y) = (h.x * alpha_x.recip(), h.y * alpha_y.recip());
    let norm = (R::PI * alpha_x * alpha_y).recip();
    Ratio { over: h.length_squared().sqr() * norm, under: x.fma(x, y.fma(y, h.z * h.z)).sqr() }
}

/// A facet normal visible from `wo` (z > 0), with density G1(wo) max(0, wo.h) D(h) / wo.z
/// (heitz2018; construction by spherical caps, dupuy2023).
#[inline(always)]
pub fn sample_ggx_visible<R: Real>(wo: Vec3<R>, alpha_x: R, alpha_y: R, u: [R; 2]) -> Vec3<R> {
    let ws = vec3(alpha_x * wo.x, alpha_y * wo.y, wo.z).normalize();
    let phi = R::TWO * R::PI * u[0];
    let h_z = u[1].one_minus() * (R::ONE + ws.z);
    let cap_z = h_z - ws.z;
    let r = (cap_z.one_minus() * (R::ONE + cap_z)).safe_sqrt();
    let (x, y) = (r.fma(phi.cos(), ws.x), r.fma(phi.sin(), ws.y));
    vec3(alpha_x * x, alpha_y * y, h_z.max(R::lit(1e-7))).normalize()
}

/// Anisotropic Beckmann (beckmann1963, walter2007 Eq. 25; cook1982 without the factor 1/pi):
/// exp(-tan^2) / (pi alpha_x alpha_y hz^4), tan^2 = (hx^2/alpha_x^2 + hy^2/alpha_y^2) / hz^2.
#[inline(always)]
pub fn beckmann<R: Real>(h: Vec3<R>, alpha_x: R, alpha_y: R) -> R {
    let recip = (h.z * h.z).recip();
    let sec2 = (h.length_squared() * recip).named("sec2");
    (-beckmann_tan2(h, alpha_x, alpha_y)).exp() * (sec2 * sec2) * (R::PI * alpha_x * alpha_y).recip()
}

/// The exponent of Beckmann's distribution: the squared slope of the facet in units of alpha.
#[inline(always)]
pub fn beckmann_tan2<R: Real>(h: Vec3<R>, alpha_x: R, alpha_y: R) -> R {
    let (x, y) = (h.x * alpha_x.recip(), h.y * alpha_y.recip());
    (x.fma(x, y * y) * (h.z * h.z).recip()).named("tan2")
}

/// A facet normal with density D(h) cos theta_h of Beckmann's distribution (walter2007 Eq. 28; anisotropic: ward1992).
#[inline(always)]
pub fn sample_beckmann<R: Real>(alpha_x: R, alpha_y: R, u: [R; 2]) -> Vec3<R> {
    let phi = R::TWO * R::PI * u[0];
    let slope = (-u[1].one_minus().ln()).safe_sqrt();
    vec3(alpha_x * slope * phi.cos(), alpha_y * slope * phi.sin(), R::ONE).normalize()
}

/// Generalised Trowbridge-Reitz with exponent 1 (burley2012 appendix B.1), alpha in (0, 1):
/// (alpha^2 - 1) / (pi ln(alpha^2) (1 + (alpha^2 - 1) hz^2)). Within 1e-3 of alpha = 1 the quotient cancels.
#[inline(always)]
pub fn gtr1<R: Real>(h: Vec3<R>, alpha: R) -> R {
    let a2 = alpha * alpha;
    // 1 + (a2 - 1) hz^2 of a unit vector
    let t = h.x.fma(h.x, h.y.fma(h.y, a2 * h.z * h.z)) / h.length_squared();
    (a2 - R::ONE) / (R::PI * a2.ln() * t)
}

/// A facet normal with density D(h) cos theta_h of [`gtr1`] (burley2012 appendix B.2).
#[inline(always)]
pub fn sample_gtr1<R: Real>(alpha: R, u: [R; 2]) -> Vec3<R> {
    let a2 = alpha * alpha;
    let phi = R::TWO * R::PI * u[0];
    // the squared sine, since 1 - cos^2 cancels: cos^2 = (1 - a2^(1-u)) / (1 - a2)
    let sin2 = (a2.pow(u[1].one_minus()) - a2).max(R::ZERO) / a2.one_minus();
    let sin = sin2.safe_sqrt();
    vec3(sin * phi.cos(), sin * phi.sin(), sin2.one_minus().safe_sqrt())
}

/// A facet normal with density (n + 1)/(2 pi) cos^n theta_h in 1/sr (blinn1977).
#[inline(always)]
pub fn sample_cos_power<R: Real>(n: R, u: [R; 2]) -> Vec3<R> {
    let phi = R::TWO * R::PI * u[0];
    // cos^2 = (1 - u)^(2/(n + 1)); 1 - cos^2 would cancel for narrow lobes
    let sin2 = one_minus_exp(u[1].one_minus().ln() * R::lit(-2.0) / (n + R::ONE));
    let sin = sin2.safe_sqrt();
    vec3(sin * phi.cos(), sin * phi.sin(), sin2.one_minus().safe_sqrt())
}

/// 1 - e^-y for y >= 0, to 2e-6 in `f32`.
#[inline(always)]
fn one_minus_exp<R: Real>(y: R) -> R {
    // five terms of the series: off by y^5/720 = 3e-11 at the border, where the difference loses five bits
    let series = (y * R::lit(0.2)).one_minus();
    let series = (y * R::lit(0.25) * series).one_minus();
    let series = (y * R::lit(1.0 / 3.0) * series).one_minus();
    let series = y * (y * R::HALF * series).one_minus();
    R::select(y.lt(R::lit(0.03)), series, (-y).exp().one_minus())
}

/// Of a facet `h` and its partner across the groove, one that `wo` sees: turns facets of density D(h) cos theta_h
/// into visible ones of density G1(wo) max(0, wo.h) D(h) / wo.z, G1 that of V-grooves (heitz2014b).
#[inline(always)]
pub fn sample_v_groove<R: Real>(h: Vec3<R>, wo: Vec3<R>, u: R) -> Vec3<R> {
    let partner = vec3(-h.x, -h.y, h.z);
    let (seen, partner_seen) = (wo.dot(h).max(R::ZERO), wo.dot(partner).max(R::ZERO));
    Vec3::select((u * (seen + partner_seen)).lt(seen), h, partner)
}
