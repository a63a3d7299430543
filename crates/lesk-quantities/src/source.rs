//! Flux, intensity, luminance and illuminance of simple sources.
//!
//! Each formula holds for watts as for lumens: W, W/sr, W/m², W/m²/sr or lm, cd, lx, cd/m².

use std::f64::consts::PI;

/// Intensity of a point that shines alike in all directions: Φ / 4π.
pub fn point_intensity(flux: f64) -> f64 {
    flux / (4.0 * PI)
}

/// Intensity inside a hard cone that holds the whole flux: Φ / (2π (1 - cos a)); `half_angle` in radians.
pub fn cone_intensity(flux: f64, half_angle: f64) -> f64 {
    // 1 - cos a = 2 sin²(a/2) keeps its digits for narrow cones
    let s = (0.5 * half_angle).sin();
    flux / (4.0 * PI * s * s)
}

/// Luminance of a diffuse (Lambert) surface of `area` m² that emits the flux from one side: Φ / (π A).
pub fn lambert_luminance(flux: f64, area: f64) -> f64 {
    flux / (PI * area)
}

/// Flux of a diffuse (Lambert) surface of `area` m², one side: π L A.
pub fn lambert_flux(luminance: f64, area: f64) -> f64 {
    PI * luminance * area
}

/// Illuminance of a horizontal plane under a uniform hemisphere of the given luminance: π L.
pub fn dome_illuminance(luminance: f64) -> f64 {
    PI * luminance
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn led_bulb_of_1100_lm_gives_38_9045_lx_at_1_5_m() {
        let intensity = point_intensity(1100.0);
        assert!((intensity - 87.5352).abs() < 5e-5);
        assert!((intensity / 2.25 - 38.9045).abs() < 5e-5);
    }

    #[test]
    fn bulb_of_1600_lm_gives_31_831_lx_at_2_m() {
        assert!((point_intensity(1600.0) / 4.0 - 31.831).abs() < 5e-4);
    }

    #[test]
    fn sun_gives_1365_2_watts_per_square_metre() {
        assert!((point_intensity(3.86e26) / 1.5e11f64.powi(2) - 1365.196).abs() < 5e-4);
    }

    #[test]
    fn hard_cones_of_1000_lm_have_the_computed_intensities() {
        for (deg, cd) in [(15.0f64, 4670.84), (30.0, 1187.95), (45.0, 543.39), (60.0, 318.31)] {
            assert!((cone_intensity(1000.0, deg.to_radians()) - cd).abs() < 6e-3, "{deg}");
        }
    }

    #[test]
    fn cone_of_180_degrees_is_a_point_source() {
        assert!((cone_intensity(1.0, PI) - point_intensity(1.0)).abs() < 1e-16);
    }

    #[test]
    fn diffuse_sphere_has_luminance_flux_over_4_pi2_r2() {
        let r: f64 = 0.25;
        let luminance = lambert_luminance(100.0, 4.0 * PI * r * r);
        assert!((luminance - 100.0 / (4.0 * PI * PI * r * r)).abs() < 1e-12);
        assert!((lambert_flux(luminance, 4.0 * PI * r * r) - 100.0).abs() < 1e-12);
        assert_eq!(dome_illuminance(1.0), PI);
    }
}
