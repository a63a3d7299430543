//! Masking and shadowing of facets by their neighbours, for directions above the surface (z > 0).

use super::ratio::Ratio;
use lesk_math::{Real, Vec3};

/// sqrt(z^2 + alpha_x^2 x^2 + alpha_y^2 y^2): GGX's (1 + 2 Lambda) cos.
#[inline(always)]
fn ggx_stretch<R: Real>(w: Vec3<R>, alpha_x: R, alpha_y: R) -> R {
    let (x, y) = (alpha_x * w.x, alpha_y * w.y);
    x.fma(x, y.fma(y, w.z * w.z)).sqrt()
}

/// Smith's G1 for GGX (walter2007 Eq. 34, heitz2014 Eq. 43, 72).
#[inline(always)]
pub fn smith_ggx_g1<R: Real>(w: Vec3<R>, alpha_x: R, alpha_y: R) -> R {
    R::TWO * w.z * smith_ggx_half(w, alpha_x, alpha_y)
}

/// Smith's G1 for GGX divided by 2 cos.
#[inline(always)]
pub fn smith_ggx_half<R: Real>(w: Vec3<R>, alpha_x: R, alpha_y: R) -> R {
    smith_ggx_half_ratio(w, alpha_x, alpha_y).value()
}

/// [`smith_ggx_half`], not divided yet.
#[inline(always)]
pub(crate) fn smith_ggx_half_ratio<R: Real>(w: Vec3<R>, alpha_x: R, alpha_y: R) -> Ratio<R> {
    Ratio { over: R::ONE, under: w.z + ggx_stretch(w, alpha_x, alpha_y) }
}

/// Height-correlated Smith masking and shadowing divided by 4 cos_i cos_o (heitz2014 Eq. 99): V = G2 / (4 cos_i cos_o).
#[inline(always)]
pub fn smith_ggx_visibility<R: Real>(wi: Vec3<R>, wo: Vec3<R>, alpha_x: R, alpha_y: R) -> R {
    smith_ggx_visibility_ratio(wi, wo, alpha_x, alpha_y).value()
}

/// [`smith_ggx_visibility`], not divided yet.
#[inline(always)]
pub(crate) fn smith_ggx_visibility_ratio<R: Real>(wi: Vec3<R>, wo: Vec3<R>, alpha_x: R, alpha_y: R) -> Ratio<R> {
    let (si, so) = (ggx_stretch(wi, alpha_x, alpha_y), ggx_stretch(wo, alpha_x, alpha_y));
    Ratio { over: R::HALF, under: wo.z.fma(si, wi.z * so) }
}

/// Separable Smith masking and shadowing divided by 4 cos_i cos_o (walter2007 Eq. 23):
/// V = G1(wi) G1(wo) / (4 cos_i cos_o).
#[inline(always)]
pub fn smith_ggx_visibility_separable<R: Real>(wi: Vec3<R>, wo: Vec3<R>, alpha_x: R, alpha_y: R) -> R {
    smith_ggx_visibility_separable_ratio(wi, wo, alpha_x, alpha_y).value()
}

/// [`smith_ggx_visibility_separable`], not divided yet.
#[inline(always)]
pub(crate) fn smith_ggx_visibility_separable_ratio<R: Real>(
    wi: Vec3<R>,
    wo: Vec3<R>,
    alpha_x: R,
    alpha_y: R,
) -> Ratio<R> {
    smith_ggx_half_ratio(wi, alpha_x, alpha_y) * smith_ggx_half_ratio(wo, alpha_x, alpha_y)
}

/// Masking of `w` in the V-groove of the facet `h` = wi + wo, `w` one of the two (torrance1967, cook1982):
/// min(1, 2 cos theta_h cos theta / cos theta_d).
#[inline(always)]
pub fn v_groove_g1<R: Real>(w: Vec3<R>, h: Vec3<R>) -> R {
    v_groove_at(w.z, h).value()
}

#[inline(always)]
fn v_groove_at<R: Real>(cos_theta: R, h: Vec3<R>) -> Ratio<R> {
    // cos theta_h / cos theta_d = 2 h.z / (h.h) for h = wi + wo
    let h2 = h.length_squared();
    Ratio { over: (R::lit(4.0) * h.z * cos_theta).min(h2), under: h2 }
}

/// [`v_groove_g1`] divided by 4 cos theta, not divided yet.
#[inline(always)]
pub(crate) fn v_groove_half_ratio<R: Real>(w: Vec3<R>, h: Vec3<R>) -> Ratio<R> {
    v_groove_at(w.z, h) * Ratio { over: R::ONE, under: R::lit(4.0) * w.z }
}

/// Masking and shadowing in the V-groove of the facet `h` = wi + wo: that of the direction nearer to the horizon.
#[inline(always)]
pub fn v_groove<R: Real>(wi: Vec3<R>, wo: Vec3<R>, h: Vec3<R>) -> R {
    v_groove_at(wi.z.min(wo.z), h).value()
}

/// [`v_groove`] divided by 4 cos_i cos_o, not divided yet.
#[inline(always)]
pub(crate) fn v_groove_visibility_ratio<R: Real>(wi: Vec3<R>, wo: Vec3<R>, h: Vec3<R>) -> Ratio<R> {
    v_groove_at(wi.z.min(wo.z), h) * Ratio { over: R::ONE, under: R::lit(4.0) * (wi.z * wo.z) }
}
