//! Named spectra: what a watt is worth in lumens, and in which colour.

use crate::error::LightError;
use lesk_quantities::observer::Observer;
use lesk_quantities::photometry::Vision;
use lesk_quantities::{Dimension, K_M, Quantity, colorimetry, colorspace, radiometry};
use std::fmt;

/// A spectrum by name.
///
/// The efficacy of an illuminant counts watts between 380 and 780 nm, that of a black body its whole spectrum, as an
/// incandescent lamp draws it, and that of sunlight (`AM0`, `AM1.5G`, `AM1.5D`) its whole table, 280 to 4000 nm.
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
    /// Another illuminant of the CIE, or sunlight, by one of [`lesk_quantities::Spectrum::names`].
    Named(&'static str),
}

impl Spectrum {
    /// What [`parse`](Self::parse) accepts.
    pub const ACCEPTED: &str =
        "`E`, `A`, `D50`, `D65`, `FL2`, `LED-B3` or another illuminant of the CIE, `AM1.5G`, or `blackbody 2700 K`";

    /// Reads `E`, `A`, `D50`, `D65`, another illuminant (`FL2`, `LED-B3`; `lesk spectrum --names` lists them), or
    /// `blackbody T` with T from 500 K to 100000 K.
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
            _ => lesk_quantities::Spectrum::names().find(|known| *known == name).map(Self::Named).ok_or_else(|| {
                let given: String = name.chars().take(40).collect();
                LightError::new(format!("unknown spectrum `{given}`, {} is accepted", Self::ACCEPTED))
            }),
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
        match self {
            Self::Blackbody(t) => radiometry::blackbody_efficacy(t),
            _ => {
                let illuminant = self.illuminant();
                illuminant.efficacy(illuminant.range(), Vision::Photopic)
            }
        }
    }

    /// The colour in linear Rec.709, scaled to luminance Y = 1.
    pub fn rgb(self) -> [f64; 3] {
        match self {
            Self::E => from_xy([1.0 / 3.0; 2]),
            Self::D50 => from_xy([0.34567, 0.35850]), // CIE 15
            Self::D65 => [1.0; 3],
            Self::A => from_xy([0.44757, 0.40745]), // CIE 15
            Self::Blackbody(t) => radiometry::blackbody_rgb(t).unwrap_or([1.0; 3]),
            Self::Named(_) => from_xy(colorimetry::xy(self.illuminant().xyz(Observer::Cie1931))),
        }
    }

    /// The spectrum itself.
    fn illuminant(self) -> lesk_quantities::Spectrum {
        lesk_quantities::Spectrum::parse(&self.to_string())
            .unwrap_or_else(|_| lesk_quantities::Spectrum::equal_energy())
    }

    /// How watts became lumens, for reports: `16.45 lm/W (blackbody 2856 K, whole spectrum, K_m = 683.002 lm/W)`.
    pub fn conversion(self) -> String {
        let range = self.illuminant().range();
        let range = range.map_or("whole spectrum".into(), |r| format!("{} to {} nm", r.first_nm, r.last_nm));
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
            Self::Named(name) => f.write_str(name),
        }
    }
}

/// The colour of a chromaticity with Y = 1; a negative channel is set to zero, and the rest scaled back to Y = 1.
fn from_xy([x, y]: [f64; 2]) -> [f64; 3] {
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
