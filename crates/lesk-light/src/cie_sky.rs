//! The standard skies of CIE S 011:2003 / ISO 15469:2004, as pictures for an [`Environment`](crate::Environment).

use crate::dome;
use crate::error::LightError;
use lesk_image::Image;
use std::f64::consts::FRAC_PI_2;

/// Gradation (a, b) and indicatrix (c, d, e) of the fifteen types; CIE S 011:2003, table 1.
const TYPES: [[f64; 5]; 15] = [
    [4.0, -0.7, 0.0, -1.0, 0.0],
    [4.0, -0.7, 2.0, -1.5, 0.15],
    [1.1, -0.8, 0.0, -1.0, 0.0],
    [1.1, -0.8, 2.0, -1.5, 0.15],
    [0.0, -1.0, 0.0, -1.0, 0.0],
    [0.0, -1.0, 2.0, -1.5, 0.15],
    [0.0, -1.0, 5.0, -2.5, 0.3],
    [0.0, -1.0, 10.0, -3.0, 0.45],
    [-1.0, -0.55, 2.0, -1.5, 0.15],
    [-1.0, -0.55, 5.0, -2.5, 0.3],
    [-1.0, -0.55, 10.0, -3.0, 0.45],
    [-1.0, -0.32, 10.0, -3.0, 0.45],
    [-1.0, -0.32, 16.0, -3.0, 0.3],
    [-1.0, -0.15, 16.0, -3.0, 0.3],
    [-1.0, -0.15, 24.0, -2.8, 0.15],
];

/// A CIE general sky: luminance relative to the zenith,
/// L/L_z = f(χ) φ(Z) / (f(Z_s) φ(0)), φ(Z) = 1 + a exp(b / cos Z), f(χ) = 1 + c (exp(d χ) - exp(d π/2)) + e cos² χ.
///
/// Type 16 is the traditional overcast sky, (1 + 2 cos Z) / 3.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CieSky {
    kind: u32,
    zenith_distance: f64,
    azimuth: f64,
}

impl CieSky {
    /// Type 1 to 16 with the sun at an elevation and azimuth in radians; the azimuth counts clockwise from the middle of
    /// the picture (north) as seen from above, like the columns of an environment map.
    ///
    /// # Errors
    /// Another type, a sun that is not above the horizon.
    pub fn new(kind: u32, elevation: f64, azimuth: f64) -> Result<Self, LightError> {
        if !(1..=16).contains(&kind) {
            return Err(LightError::new(format!("CIE sky of type {kind} does not exist, 1 to 16 is accepted")));
        }
        dome::check_sun(elevation, azimuth, "CIE skies are skies of the day")?;
        Ok(CieSky { kind, zenith_distance: FRAC_PI_2 - elevation, azimuth })
    }

    /// Luminance over that of the zenith, at a zenith distance below π/2 and an azimuth, radians.
    pub fn relative(&self, zenith_distance: f64, azimuth: f64) -> f64 {
        let cos_z = zenith_distance.cos().max(1e-6);
        if self.kind == 16 {
            return (1.0 + 2.0 * cos_z) / 3.0;
        }
        let [a, b, c, d, e] = TYPES[self.kind as usize - 1];
        let gradation = |cos: f64| 1.0 + a * (b / cos).exp();
        let indicatrix = |chi: f64| 1.0 + c * ((d * chi).exp() - (d * FRAC_PI_2).exp()) + e * chi.cos().powi(2);
        let chi = dome::cos_between([zenith_distance, azimuth], [self.zenith_distance, self.azimuth]).acos();
        indicatrix(chi) * gradation(cos_z) / (indicatrix(self.zenith_distance) * gradation(1.0))
    }

    /// The sky as a latitude-longitude picture whose zenith is 1; the lower half reflects the share `ground` of what a
    /// horizontal plane receives.
    ///
    /// # Errors
    /// A share that is not between 0 and 1.
    pub fn picture(&self, ground: f64) -> Result<Image, LightError> {
        dome::check_ground(ground)?;
        dome::picture(|z, azimuth| [self.relative(z, azimuth); 3], [ground; 3])
    }
}
