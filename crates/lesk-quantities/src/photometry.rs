//! From watts to lumens: K_m, V(λ) and efficacies.

use crate::{QuantityError, observer, table};
use std::fmt;

/// Maximum luminous efficacy for photopic vision, lm/W.
///
/// The SI fixes 683 lm/W at 540 THz, which is 555.016 nm in air; V is largest at 555 nm, so that
/// K_m = 683 / V(555.016 nm) = 683.002. Every result that used an efficacy names this number.
pub const K_M: f64 = 683.002;

/// Maximum luminous efficacy for scotopic vision, lm/W: 683 / V'(555.016 nm) (CIE 018).
pub const K_M_SCOTOPIC: f64 = 1700.06;

/// The photopic luminous efficiency V of 1924, which is y of the CIE 1931 observer; `lambda_nm` in nm,
/// zero outside 360 to 830 nm.
pub fn v(lambda_nm: f64) -> f64 {
    observer::xyz_bar(lambda_nm)[1]
}

/// The scotopic luminous efficiency V' of 1951, for eyes adapted to the dark; zero outside 380 to 780 nm.
pub fn v_scotopic(lambda_nm: f64) -> f64 {
    table::SCOTOPIC.at(0, lambda_nm)
}

/// Which eye counts lumens.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Vision {
    /// Adapted to daylight: V(λ), K_m.
    #[default]
    Photopic,
    /// Adapted to the dark: V'(λ), K'_m.
    Scotopic,
}

impl Vision {
    /// Luminous efficiency at a wavelength in nm.
    pub fn efficiency(self, lambda_nm: f64) -> f64 {
        match self {
            Self::Photopic => v(lambda_nm),
            Self::Scotopic => v_scotopic(lambda_nm),
        }
    }

    /// Maximum luminous efficacy, lm/W.
    pub fn k_m(self) -> f64 {
        match self {
            Self::Photopic => K_M,
            Self::Scotopic => K_M_SCOTOPIC,
        }
    }
}

/// Lumens of `power_w` watts at one wavelength in nm.
pub fn luminous_flux(power_w: f64, lambda_nm: f64) -> f64 {
    K_M * v(lambda_nm) * power_w
}

/// A range of wavelengths in whole nm. Every efficacy states its range: illuminant A moves by 21 % between these two.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Range {
    /// First wavelength, nm.
    pub first_nm: u32,
    /// Last wavelength, nm.
    pub last_nm: u32,
}

impl Range {
    /// 380 to 780 nm, the range of most tables of spectra.
    pub const VISIBLE: Range = Range { first_nm: 380, last_nm: 780 };
    /// 360 to 830 nm, the range of the CIE observer.
    pub const OBSERVER: Range = Range { first_nm: 360, last_nm: 830 };

    /// Reads `380:780`: first and last wavelength in whole nm.
    ///
    /// # Errors
    /// `BadRange` for anything but two whole numbers from 1 to 100000, the second larger.
    pub fn parse(text: &str) -> Result<Range, QuantityError> {
        let bad = || QuantityError::BadRange { given: text.trim().to_string() };
        let (first, last) = text.trim().split_once(':').ok_or_else(bad)?;
        let number = |part: &str| part.trim().trim_end_matches("nm").trim_end().parse::<u32>().map_err(|_| bad());
        let range = Range { first_nm: number(first)?, last_nm: number(last)? };
        let legal = 1 <= range.first_nm && range.first_nm < range.last_nm && range.last_nm <= 100_000;
        if legal { Ok(range) } else { Err(bad()) }
    }

    /// The integral of a spectrum per nm over this range: the trapezoid rule at 1 nm.
    pub fn integrate(self, spectrum: impl Fn(f64) -> f64) -> f64 {
        let value = |nm: u32| spectrum(f64::from(nm));
        let inner: f64 = (self.first_nm..=self.last_nm).map(value).sum();
        inner - 0.5 * (value(self.first_nm) + value(self.last_nm))
    }
}

impl fmt::Display for Range {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} to {} nm", self.first_nm, self.last_nm)
    }
}

/// Luminous efficacy of radiation of a spectrum per nm, lm/W: lumens per watt of radiation within `range`.
pub fn efficacy(range: Range, spectrum: impl Fn(f64) -> f64) -> f64 {
    K_M * range.integrate(|nm| spectrum(nm) * v(nm)) / range.integrate(&spectrum)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::radiometry::blackbody;

    /// The value that the reference prints with its digits.
    fn printed(got: f64, expected: f64, digit: f64) {
        assert!((got - expected).abs() <= 0.5 * digit, "{got} is not {expected}");
    }

    #[test]
    fn v_integrates_to_106_856_nm_over_380_to_780() {
        printed(Range::VISIBLE.integrate(v), 106.856399, 1e-6); // colour-science 0.4.7, trapezoid at 1 nm
    }

    #[test]
    fn equal_energy_light_has_182_46_lm_per_watt_over_380_to_780() {
        printed(efficacy(Range::VISIBLE, |_| 1.0), 182.46, 0.01); // colour-science 0.4.7
        printed(efficacy(Range::OBSERVER, |_| 1.0), 155.28, 0.01);
    }

    #[test]
    fn illuminant_a_has_the_published_efficacies() {
        // CIE 15: A is 100 (560/λ)^5 (exp(c2/(2848*560e-9)) - 1) / (exp(c2/(2848 λ)) - 1), c2 = 1.435e-2
        let a = |nm: f64| nm.powi(-5) / (1.435e7 / (2848.0 * nm)).exp_m1();
        printed(efficacy(Range::VISIBLE, a), 156.20, 0.01); // colour-science 0.4.7
        printed(efficacy(Range::OBSERVER, a), 122.94, 0.01);
    }

    #[test]
    fn one_watt_at_600_nm_is_430_974_lm() {
        printed(luminous_flux(1.0, 600.0), 430.974, 1e-3); // 683.002 * 0.631
        printed(luminous_flux(1.0, 555.0), 683.002, 1e-3);
    }

    #[test]
    fn scotopic_vision_is_tied_to_683_lm_per_watt_at_555_016_nm() {
        // the definition: both curves give 683 lm/W at 540 THz; V' between 555 and 556 nm is tabled with four digits
        printed(K_M * v(555.016), 683.0, 4e-3);
        printed(K_M_SCOTOPIC * v_scotopic(555.016), 683.0, 1.0);
        assert_eq!([v_scotopic(507.0), v_scotopic(600.0)], [1.0, 0.03315]); // CIE 018
    }

    #[test]
    fn ranges_are_two_whole_numbers_in_order() {
        assert_eq!(Range::parse("380:770"), Ok(Range { first_nm: 380, last_nm: 770 }));
        assert_eq!(Range::parse(" 400 nm : 700 nm "), Ok(Range { first_nm: 400, last_nm: 700 }));
        for text in ["", ":", "380", "780:380", "380:380", "0:5", "380:1e9", "a:b", "380:780:900", "-1:5"] {
            assert!(Range::parse(text).is_err(), "{text}");
        }
    }

    #[test]
    fn freezing_platinum_has_the_luminance_of_the_old_candela() {
        // 2042 K: 60 cd/cm2 by the definition of 1948, 5.986e5 cd/m2 with today's constants
        let luminance = K_M * observer::xyz(|nm| blackbody(nm, 2042.0))[1];
        printed(luminance, 5.986e5, 100.0);
    }
}
