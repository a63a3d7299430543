//! Diffuse reflection, f in 1/sr for a reflectance of 1.

use super::fresnel::schlick_complement;
use lesk_math::Real;

/// Burley's retro-reflective diffuse lobe (burley2012 section 5.3), with F_D90 = 1/2 + 2 roughness cos^2 theta_d.
/// It gains energy: up to 1.4 at grazing angles for roughness 1.
#[inline(always)]
pub fn burley<R: Real>(cos_i: R, cos_o: R, cos_d: R, roughness: R) -> R {
    let fd90 = R::HALF + R::TWO * cos_d * cos_d * roughness;
    grazing(cos_i, fd90) * grazing(cos_o, fd90) * R::FRAC_1_PI
}

/// The flatter lobe that stands for subsurface scattering (burley2012 section 5.3, after hanrahan1993).
/// It gains energy: up to 1.5 at grazing angles for roughness 1.
#[inline(always)]
pub fn burley_subsurface<R: Real>(cos_i: R, cos_o: R, cos_d: R, roughness: R) -> R {
    let fss90 = cos_d * cos_d * roughness;
    let fss = grazing(cos_i, fss90) * grazing(cos_o, fss90);
    R::lit(1.25) * fss.fma((cos_i + cos_o).recip() - R::HALF, R::HALF) * R::FRAC_1_PI
}

/// From 1 at normal incidence to `f90` at grazing.
#[inline(always)]
fn grazing<R: Real>(cos: R, f90: R) -> R {
    // mix(1, f90, (1 - cos)^5) the other way round: no difference of nearly equal numbers for f90 near 0
    schlick_complement(cos).lerp(f90, R::ONE)
}
