//! Spectra by name: `D65`, `FL2`, `blackbody:2856K`, `600 nm`.

use super::{Shape, Spectrum, sunlight};
use crate::{Dimension, Quantity, QuantityError, table};

/// What [`Spectrum::parse`] accepts, for messages.
pub const ACCEPTED: &str = "`A`, `E`, `D50`, `D65` (any D40 to D250), `FL1` to `FL12`, `FL3.1` to `FL3.15`, \
    `HP1` to `HP5`, `LED-B1` (LED-B1 to B5, BH1, RGB1, V1, V2), `AM0`, `AM1.5G`, `AM1.5D`, `blackbody 2856 K`, `555 nm`, `gaussian 450 nm, 20 nm`";

/// D65 of 1964 has 6500 K by the c2 of then, 1.4380e-2 m K: 6504 K (CIE 15).
const NAME_TO_KELVIN: f64 = 100.0 * 1.4388 / 1.4380;

impl Spectrum {
    /// Reads the name of a spectrum: see [`ACCEPTED`].
    ///
    /// # Errors
    /// `UnknownSpectrum`; `OutOfRange` for a temperature or wavelength that is not accepted; errors of quantities.
    pub fn parse(text: &str) -> Result<Spectrum, QuantityError> {
        let name = text.trim();
        let unknown = || QuantityError::UnknownSpectrum { given: name.to_string() };
        if name.len() > 100 {
            return Err(unknown());
        }
        let lower = name.to_ascii_lowercase();
        if let Some(rest) = after(name, &lower, "blackbody") {
            return Self::blackbody(Quantity::parse_as(rest, &[Dimension::Temperature])?.si());
        }
        if let Some(rest) = after(name, &lower, "gaussian") {
            let (peak, width) = rest.split_once(',').ok_or_else(unknown)?;
            return Self::gaussian(nanometres(peak)?, nanometres(width)?);
        }
        match lower.as_str() {
            "e" => return Ok(Self::equal_energy()),
            "a" => return Ok(Spectrum { name: "A".into(), shape: Shape::A }),
            _ => {}
        }
        if let Some(sunlight) = sunlight::named(name) {
            return Ok(sunlight);
        }
        if let Some(rest) = name.strip_prefix(['D', 'd']) {
            if let Ok(number) = rest.parse::<u32>() {
                return Self::named_daylight(number);
            }
            if let Ok(kelvin) = Quantity::parse_as(rest, &[Dimension::Temperature]) {
                return Self::daylight(kelvin.si());
            }
        }
        if let Some(column) = column(&lower) {
            return Ok(Spectrum { name: table::ILLUMINANTS.names[column].into(), shape: Shape::Column(column) });
        }
        if name.starts_with(|c: char| c.is_ascii_digit() || c == '.') {
            return Self::line(nanometres(name)?);
        }
        Err(unknown())
    }

    /// D65 and its siblings by the hundreds of their temperature, or by the whole temperature, as in D6504.
    fn named_daylight(number: u32) -> Result<Spectrum, QuantityError> {
        let kelvin = f64::from(number) * if number < 1000 { NAME_TO_KELVIN } else { 1.0 };
        // D40 and D250 are the ends of the series by their names
        let kelvin = if matches!(number, 40 | 250) { f64::from(number) * 100.0 } else { kelvin };
        Ok(Spectrum { name: format!("D{number}"), ..Self::daylight(kelvin)? })
    }

    /// The names of all tabulated illuminants and sunlights, and of the usual computed ones.
    pub fn names() -> impl Iterator<Item = &'static str> {
        let tables = table::ILLUMINANTS.names.iter().copied().chain(sunlight::NAMES);
        ["A", "E", "D50", "D55", "D65", "D75"].into_iter().chain(tables)
    }
}

/// The column of the CIE's illuminants with this name; `f2` is `fl2`.
fn column(lower: &str) -> Option<usize> {
    let long = lower.strip_prefix('f').map(|rest| format!("fl{rest}"));
    let same = |known: &str| known == lower || Some(known) == long.as_deref();
    table::ILLUMINANTS.names.iter().position(|known| same(&known.to_ascii_lowercase()))
}

/// What follows a word and a blank or colon.
fn after<'a>(name: &'a str, lower: &str, word: &str) -> Option<&'a str> {
    let rest = lower.strip_prefix(word)?;
    // the word is ASCII, and lower case keeps the length of ASCII only where nothing else changed: same place in `name`
    let rest = name.get(name.len() - rest.len()..)?;
    Some(rest.trim_start_matches(|c: char| c == ':' || c.is_whitespace()))
}

fn nanometres(text: &str) -> Result<f64, QuantityError> {
    let quantity = Quantity::parse_as(text, &[Dimension::Length])?;
    quantity.to(crate::Unit::parse("nm")?)
}
