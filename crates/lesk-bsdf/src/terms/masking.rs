//! Masking and shadowing of facets by their neighbours.

use lesk_math::{Real, Vec3};

/// sqrt(z^2 + alpha_x^2 x^2 + alpha_y^2 y^2): GGX's (1 + 2 Lambda) |cos|, of either side.
#[inline(always)]
fn ggx_stretch<R: Real>(w: Vec3<R>, alpha_x: R, alpha_y: R) -> R {
    let (x, y) = (alpha_x * w.x, alpha_y * w.y);
    x.fma(x, y.fma(y, w.z * w.z)).sqrt()
}

/// Smith's G1 for GGX (walter2007 Eq. 34, heitz2014 Eq. 43, 72).
#[inline(always)]
pub fn smith_ggx_g1<R: Real>(w: Vec3<R>, alpha_x: R, alpha_y: R) -> R {
    let z = w.z.abs();
    R::TWO * z / (z + ggx_stretch(w, alpha_x, alpha_y))
}

/// Height-correlated Smith masking and shadowing divided by 4 cos_i cos_o (heitz2014 Eq. 99): V = G2 / (4 cos_i cos_o).
#[inline(always)]
pub fn smith_ggx_visibility<R: Real>(wi: Vec3<R>, wo: Vec3<R>, alpha_x: R, alpha_y: R) -> R {
    let (si, so) = (ggx_stretch(wi, alpha_x, alpha_y), ggx_stretch(wo, alpha_x, alpha_y));
    R::HALF / wo.z.fma(si, wi.z * so)
}
