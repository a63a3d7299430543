//! Named spectra: what a watt is worth in lumens, and in which colour.

use crate::error::LightError;
use lesk_quantities::{Dimension, K_M, Quantity, colorspace, photometry, radiometry};
use std::fmt;

/// A spectrum by name.
///
/// The efficacy of an illuminant counts watts between 380 and 780 nm, that of a black body its whole spectrum, as an
/// incandescent lamp draws it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Spectrum {
    /// Equal energy per nm.
    E,
    /// CIE illuminant A, tungsten.
    A,
    /// CIE illuminant D50, warm daylight.
    D50,
    /// CIE illuminant D65, daylight; its colour is the white of the film.
    D65,
    /// Planck's law at this temperature in K.
    Blackbody(f64),
}

/// Luminous efficacy of D50 and D65 over 380 to 780 nm, lm/W: colour-science 0.4.7 tables, trapezoid at 1 nm.
const EFFICACY_D50: f64 = 207.70;
const EFFICACY_D65: f64 = 205.15;

impl Spectrum {
    /// What [`parse`](Self::parse) accepts.
    pub const ACCEPTED: &str = "`E`, `A`, `D50`, `D65` or `blackbody 2700 K`";

    /// Reads `E`, `A`, `D50`, `D65` or `blackbody T` with T from 500 K to 100000 K.
    ///
    /// # Errors
    /// Any other text.
    pub fn parse(text: &str) -> Result<Self, LightError> {
        let name = text.trim();
        if let Some(rest) = name.strip_prefix("blackbody") {
            return Self::blackbody(Quantity::parse_as(rest, &[Dimension::Temperature]).map_err(from_quantity)?.si());
        }
        match name {
            "E" => Ok(Self::E),
            "A" => Ok(Self::A),
            "D50" => Ok(Self::D50),
            "D65" => Ok(Self::D65),
            _ => Err(LightError::new(format!(
                "unknown spectrum `{}`, {} is accepted",
                name.chars().take(40).collect::<String>(),
                Self::ACCEPTED
            ))),
        }
    }

    /// The black body at `temperature` in K.
    ///
    /// # Errors
    /// A temperature outside 500 K to 100000 K.
    pub fn blackbody(temperature: f64) -> Result<Self, LightError> {
        radiometry::blackbody_rgb(temperature).map_err(from_quantity)?;
        Ok(Self::Blackbody(temperature))
    }

    /// Luminous efficacy of radiation, lm/W.
    pub fn efficacy(self) -> f64 {
        let range = photometry::Range::VISIBLE;
        match self {
            Self::E => photometry::efficacy(range, |_| 1.0),
            Self::A => photometry::efficacy(range, illuminant_a),
            Self::D50 => EFFICACY_D50,
            Self::D65 => EFFICACY_D65,
            Self::Blackbody(t) => radiometry::blackbody_efficacy(t),
        }
    }

    /// The colour in linear Rec.709, scaled to luminance Y = 1.
    pub fn rgb(self) -> [f64; 3] {
        match self {
            Self::E => from_xy(1.0 / 3.0, 1.0 / 3.0),
            Self::D50 => from_xy(0.34567, 0.35850), // CIE 15
            Self::D65 => [1.0; 3],
            Self::A => from_xy(0.44757, 0.40745), // CIE 15
            Self::Blackbody(t) => radiometry::blackbody_rgb(t).unwrap_or([1.0; 3]),
        }
    }

    /// How watts became lumens, for reports: `16.45 lm/W (blackbody 2856 K, whole spectrum, K_m = 683.002 lm/W)`.
    pub fn conversion(self) -> String {
        let range = if matches!(self, Self::Blackbody(_)) { "whole spectrum" } else { "380 to 780 nm" };
        format!("{:.2} lm/W ({self}, {range}, K_m = {K_M} lm/W)", self.efficacy())
    }
}

impl fmt::Display for Spectrum {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::E => f.write_str("E"),
            Self::A => f.write_str("A"),
            Self::D50 => f.write_str("D50"),
            Self::D65 => f.write_str("D65"),
            Self::Blackbody(t) => write!(f, "blackbody {t} K"),
        }
    }
}

/// CIE 15, illuminant A per nm, without its factor.
fn illuminant_a(nm: f64) -> f64 {
    nm.powi(-5) / (1.435e7 / (2848.0 * nm)).exp_m1()
}

/// The colour of a chromaticity with Y = 1; a negative channel is set to zero, and the rest scaled back to Y = 1.
fn from_xy(x: f64, y: f64) -> [f64; 3] {
    let rgb = colorspace::rec709_from_xyz([x / y, 1.0, (1.0 - x - y) / y]).map(|v| v.max(0.0));
    let luminance = colorspace::luminance(rgb);
    rgb.map(|v| v / luminance)
}

fn from_quantity(error: lesk_quantities::QuantityError) -> LightError {
    let text = error.to_string();
    match text.split_once("\nhint: ") {
        Some((message, hint)) => LightError::new(message).hint(hint),
        None => LightError::new(text),
    }
}
