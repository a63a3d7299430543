//! Skies as latitude-longitude pictures.

use crate::error::LightError;
use lesk_image::{Image, Transfer};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Rows and columns of the picture: a third of a degree.
const ROWS: usize = 540;
const COLUMNS: usize = 2 * ROWS;

/// The picture of a sky whose linear Rec.709 luminance is a function of zenith distance and azimuth in radians; the lower
/// half is a diffuse ground that reflects the shares `ground` of what the sky gives to a horizontal plane.
pub(crate) fn picture(sky: impl Fn(f64, f64) -> [f64; 3], ground: [f64; 3]) -> Result<Image, LightError> {
    let mut data = Vec::with_capacity(3 * ROWS * COLUMNS);
    let mut horizontal = [0.0; 3];
    for y in 0..ROWS / 2 {
        let z = PI * (y as f64 + 0.5) / ROWS as f64;
        for x in 0..COLUMNS {
            let value = sky(z, TAU * ((x as f64 + 0.5) / COLUMNS as f64 - 0.5));
            for c in 0..3 {
                horizontal[c] += value[c] * z.cos() * z.sin();
                data.push(value[c] as f32);
            }
        }
    }
    let texel = PI / ROWS as f64 * TAU / COLUMNS as f64;
    // a diffuse ground: L = ρ E / π
    let below = [0, 1, 2].map(|c| (ground[c] * horizontal[c] * texel / PI) as f32);
    data.extend((0..COLUMNS * ROWS / 2).flat_map(|_| below));
    Image::new(COLUMNS as u32, ROWS as u32, 3, Transfer::Linear, data).map_err(|e| LightError::new(e.to_string()))
}

/// Cosine of the angle between two directions given by zenith distance and azimuth, radians.
pub(crate) fn cos_between(a: [f64; 2], b: [f64; 2]) -> f64 {
    let ((sin_a, cos_a), (sin_b, cos_b)) = (a[0].sin_cos(), b[0].sin_cos());
    (cos_a * cos_b + sin_a * sin_b * (a[1] - b[1]).cos()).clamp(-1.0, 1.0)
}

/// Checks the place of the sun of a sky of the day.
pub(crate) fn check_sun(elevation: f64, azimuth: f64, hint: &str) -> Result<(), LightError> {
    if (0.0..=FRAC_PI_2 + 1e-12).contains(&elevation) && azimuth.is_finite() {
        return Ok(());
    }
    let degrees = elevation.to_degrees();
    Err(LightError::new(format!("sun has the elevation {degrees} deg, 0 to 90 deg is accepted")).hint(hint))
}

/// Checks the reflectance of the ground.
pub(crate) fn check_ground(ground: f64) -> Result<(), LightError> {
    if (0.0..=1.0).contains(&ground) {
        return Ok(());
    }
    Err(LightError::new(format!("reflectance of the ground is {ground}, 0 to 1 is accepted")))
}
