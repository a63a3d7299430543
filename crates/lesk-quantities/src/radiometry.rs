//! The black body and photons. CODATA 2018: the constants are exact by the SI of 2019.

use crate::photometry::K_M;
use crate::{QuantityError, colorspace, observer};
use std::f64::consts::PI;

/// Planck constant, J s.
pub const PLANCK: f64 = 6.626_070_15e-34;
/// Speed of light in vacuum, m/s.
pub const LIGHT_SPEED: f64 = 299_792_458.0;
/// Boltzmann constant, J/K.
pub const BOLTZMANN: f64 = 1.380_649e-23;
/// Wien displacement constant, m K (CODATA 2018).
pub const WIEN: f64 = 2.897_771_955e-3;
/// Stefan-Boltzmann constant 2 π⁵ k⁴ / (15 h³ c²), W/m²/K⁴.
pub const STEFAN_BOLTZMANN: f64 = 5.670_374_419_184_43e-8;

/// Spectral radiance of a black body by Planck's law, W/m²/sr per nm of wavelength in vacuum; `lambda_nm` in nm,
/// `temperature` in K. Zero for a wavelength or temperature that is not positive.
pub fn blackbody(lambda_nm: f64, temperature: f64) -> f64 {
    if !(lambda_nm > 0.0 && temperature > 0.0) {
        return 0.0;
    }
    let lambda = lambda_nm * 1e-9;
    let x = PLANCK * LIGHT_SPEED / (lambda * BOLTZMANN * temperature);
    2.0 * PLANCK * LIGHT_SPEED * LIGHT_SPEED / (lambda.powi(5) * x.exp_m1()) * 1e-9
}

/// Radiance of a black body over the whole spectrum, σT⁴/π in W/m²/sr; `temperature` in K.
pub fn blackbody_radiance(temperature: f64) -> f64 {
    STEFAN_BOLTZMANN * temperature.powi(4) / PI
}

/// Photon radiance of a black body over the whole spectrum, photons/s/m²/sr: 4 ζ(3) (kT)³ / (h³ c²); `temperature` in K.
pub fn blackbody_photon_radiance(temperature: f64) -> f64 {
    const ZETA_3: f64 = 1.202_056_903_159_594_3;
    4.0 * ZETA_3 * (BOLTZMANN * temperature / PLANCK).powi(3) / (LIGHT_SPEED * LIGHT_SPEED)
}

/// The share of a black body's radiation at wavelengths below `lambda_nm`, in vacuum; `temperature` in K.
///
/// 15/π⁴ Σ e^(-nx) (x³/n + 3x²/n² + 6x/n³ + 6/n⁴) with x = hc/(λkT) (Chang & Rhee 1984).
pub fn blackbody_share_below(lambda_nm: f64, temperature: f64) -> f64 {
    if !(lambda_nm > 0.0 && temperature > 0.0) {
        return 0.0;
    }
    let x = PLANCK * LIGHT_SPEED / (lambda_nm * 1e-9 * BOLTZMANN * temperature);
    let term =
        |n: f64| (-n * x).exp() * (x.powi(3) / n + 3.0 * x * x / n.powi(2) + 6.0 * x / n.powi(3) + 6.0 / n.powi(4));
    // after 1000 terms the rest is below 15/π⁴ 2/1000³ = 3e-10 even for x = 0
    let sum: f64 = (1..=1000).map(|n| term(f64::from(n))).take_while(|t| *t > 1e-18).sum();
    (15.0 / PI.powi(4) * sum).min(1.0)
}

/// Luminance of a black body, cd/m²; `temperature` in K.
pub fn blackbody_luminance(temperature: f64) -> f64 {
    K_M * observer::xyz(|nm| blackbody(nm, temperature))[1]
}

/// Luminous efficacy of a black body, lm per watt of its whole spectrum; `temperature` in K.
/// [`efficacy`](crate::photometry::efficacy) gives it within a range of wavelengths.
pub fn blackbody_efficacy(temperature: f64) -> f64 {
    blackbody_luminance(temperature) / blackbody_radiance(temperature)
}

/// The colour of a black body in linear Rec.709, scaled to luminance Y = 1; `temperature` in K.
///
/// Below about 1900 K the colour lies outside Rec.709: blue would be negative. It is set to zero and the rest is
/// scaled back to Y = 1, so that no light takes light away.
///
/// # Errors
/// `OutOfRange` outside 500 to 100 000 K.
pub fn blackbody_rgb(temperature: f64) -> Result<[f64; 3], QuantityError> {
    if !(500.0..=1e5).contains(&temperature) {
        let accepted = "500 K to 100000 K";
        return Err(QuantityError::OutOfRange { name: "temperature", given: temperature, accepted });
    }
    let rgb = colorspace::rec709_from_xyz(observer::xyz(|nm| blackbody(nm, temperature))).map(|v| v.max(0.0));
    let y = colorspace::luminance(rgb);
    Ok(rgb.map(|v| v / y))
}

/// Energy of one photon, J; `lambda_nm` in nm of vacuum.
pub fn photon_energy(lambda_nm: f64) -> f64 {
    PLANCK * LIGHT_SPEED / (lambda_nm * 1e-9)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::photometry::{Range, efficacy};

    fn printed(got: f64, expected: f64, digit: f64) {
        assert!((got - expected).abs() <= 0.5 * digit, "{got} is not {expected}");
    }

    #[test]
    fn stefan_boltzmann_follows_from_the_other_constants() {
        let (h, c, k) = (PLANCK, LIGHT_SPEED, BOLTZMANN);
        let sigma = 2.0 * PI.powi(5) * k.powi(4) / (15.0 * h.powi(3) * c * c);
        assert!((STEFAN_BOLTZMANN / sigma - 1.0).abs() < 1e-12); // 15 printed digits
    }

    #[test]
    fn planck_law_integrates_to_stefan_boltzmann() {
        // 10 nm to 200 µm at 1 nm: what is left out beyond 200 µm is below 1e-7 (Rayleigh-Jeans tail) at 3000 K
        let sum: f64 = (10..200_000).map(|nm| blackbody(f64::from(nm), 3000.0)).sum();
        assert!((sum / blackbody_radiance(3000.0) - 1.0).abs() < 1e-6);
    }

    #[test]
    fn blackbody_efficacies_over_the_whole_spectrum_are_those_printed() {
        // computed with colour-science 0.4.7 tables
        printed(blackbody_efficacy(2856.0), 16.446, 1e-3);
        printed(blackbody_efficacy(5778.0), 92.08, 1e-2);
        printed(blackbody_efficacy(6500.0), 95.36, 1e-2);
    }

    #[test]
    fn efficacy_within_380_to_780_nm_is_larger_than_over_the_whole_spectrum() {
        assert!(efficacy(Range::VISIBLE, |nm| blackbody(nm, 2856.0)) > 9.0 * blackbody_efficacy(2856.0));
    }

    #[test]
    fn shares_of_the_sun_are_those_of_planck_integrals() {
        // 5778 K: 46.5 % in 380 to 780 nm, 36.7 % in 400 to 700 nm (lecture.md, by quadrature)
        let share = |a, b| blackbody_share_below(b, 5778.0) - blackbody_share_below(a, 5778.0);
        printed(share(380.0, 780.0), 0.465, 1e-3);
        printed(share(400.0, 700.0), 0.367, 1e-3);
        // half of the radiation is below 4107 µm K (tables of the black-body fraction)
        printed(blackbody_share_below(4107.0, 1000.0), 0.5, 1e-4);
        printed(blackbody_share_below(1e12, 1000.0), 1.0, 1e-8);
        let by_trapezoid = Range::VISIBLE.integrate(|nm| blackbody(nm, 5778.0)) / blackbody_radiance(5778.0);
        assert!((share(380.0, 780.0) - by_trapezoid).abs() < 1e-6);
    }

    #[test]
    fn photon_radiance_is_the_integral_of_planck_over_the_photon_energy() {
        let sum: f64 = (10..200_000).map(|nm| blackbody(f64::from(nm), 3000.0) / photon_energy(f64::from(nm))).sum();
        // the tail beyond 200 µm holds 1/(2 ζ(3)) x²/2 = 1.2e-4 of the photons, x = 0.024
        assert!((sum / blackbody_photon_radiance(3000.0) - 1.0).abs() < 2e-4);
    }

    #[test]
    fn wien_peak_of_5778_k_is_at_501_5_nm() {
        let peak =
            (300..800).max_by(|a, b| blackbody(f64::from(*a), 5778.0).total_cmp(&blackbody(f64::from(*b), 5778.0)));
        assert_eq!(peak, Some(502)); // b = 2897771.955 nm K: 501.5 nm
    }

    #[test]
    fn photon_of_600_nm_has_the_published_energy() {
        printed(photon_energy(600.0) * 1e19, 3.310743, 1e-6);
        printed(1e-18 / photon_energy(600.0), 3.020470, 1e-6); // photons/s of 1 W in 1e18: 1 / 3.3107431e-19 J
        printed(1e-18 / photon_energy(555.0), 2.79393, 1e-5);
        printed(1e-18 / photon_energy(450.0), 2.26535, 1e-5);
        printed(1e-18 / photon_energy(650.0), 3.27218, 1e-5);
        printed(1e6 / (photon_energy(600.0) * 6.022_140_76e23), 5.0156, 1e-4); // µmol/s of 1 W
    }

    #[test]
    fn blackbody_at_2856_k_has_the_chromaticity_of_illuminant_a() {
        // CIE 15: x = 0.44758, y = 0.40745; 2856 K with today's c2 is 2855.54 K of the definition: 5e-5
        let [x, y, z] = observer::xyz(|nm| blackbody(nm, 2856.0));
        printed(x / (x + y + z), 0.44758, 1e-4);
        printed(y / (x + y + z), 0.40745, 1e-4);
    }

    #[test]
    fn blackbody_rgb_agrees_with_numpy_and_colour_science() {
        // numpy: Planck's law times the tables of colour-science 0.4.7, its sRGB matrix inverted (white 0.3127, 0.3290);
        // that matrix is printed with four digits, ours is exact: 5e-4
        for (t, expected) in [(2700.0, [1.93488, 0.80368, 0.19185]), (6500.0, [1.04320, 0.98362, 1.03503])] {
            let rgb = blackbody_rgb(t).unwrap();
            for c in 0..3 {
                assert!((rgb[c] - expected[c]).abs() < 5e-4, "{t} K: {rgb:?}");
            }
        }
    }

    #[test]
    fn blackbody_rgb_has_luminance_one_and_no_negative_channel() {
        for t in [500.0, 1000.0, 1500.0, 1900.0, 2700.0, 4000.0, 6500.0, 20_000.0, 100_000.0] {
            let rgb = blackbody_rgb(t).unwrap();
            assert!((colorspace::luminance(rgb) - 1.0).abs() < 4.0 * f64::EPSILON && rgb.iter().all(|v| *v >= 0.0));
        }
    }

    #[test]
    fn temperatures_that_are_no_lamp_are_refused() {
        for t in [0.0, -1.0, 499.0, 2e5, f64::NAN, f64::INFINITY] {
            assert!(matches!(blackbody_rgb(t), Err(QuantityError::OutOfRange { .. })));
        }
        assert_eq!(blackbody(0.0, 3000.0), 0.0);
        assert_eq!(blackbody(500.0, f64::NAN), 0.0);
    }
}
