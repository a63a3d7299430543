//! What a conversion may assume, given by name.

use crate::photometry::{Range, Vision};
use crate::{Dimension, Quantity, QuantityError, Spectrum};

/// A number that a rule may need.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Need {
    /// From a source to a lit point, m.
    Distance,
    /// Half-angle of a uniform cone, rad.
    Cone,
    /// sr.
    SolidAngle,
    /// Of a lit or shining surface, m².
    Area,
    /// Of a Lambertian surface, 0 to 1.
    Reflectance,
    /// Between the light and the normal of the lit surface, rad.
    Incidence,
    /// s.
    Time,
    /// Of a band of wavelengths, m.
    Width,
    /// Lumens of a watt.
    Efficacy,
    /// A Lambertian emitter: a flag.
    Lambertian,
    /// A hemisphere of even radiance above a surface: a flag.
    Dome,
}

/// One option of a conversion.
pub struct OptionInfo {
    /// As in Python: `solid_angle`.
    pub name: &'static str,
    /// As on the command line, with an example.
    pub flag: &'static str,
    /// With an article: `a distance`.
    pub title: &'static str,
    /// Its dimension; `None` for plain numbers and flags.
    dimension: Option<Dimension>,
}

const fn option(
    name: &'static str,
    flag: &'static str,
    title: &'static str,
    dimension: Option<Dimension>,
) -> OptionInfo {
    OptionInfo { name, flag, title, dimension }
}

/// In the order of [`Need`].
pub static OPTIONS: [OptionInfo; 11] = [
    option("distance", "--at 1.5m", "a distance", Some(Dimension::Length)),
    option("cone", "--cone 30deg", "the half-angle of a cone", Some(Dimension::Angle)),
    option("solid_angle", "--solid-angle 0.1sr", "a solid angle", Some(Dimension::SolidAngle)),
    option("area", "--area 2m2", "an area", Some(Dimension::Area)),
    option("reflectance", "--reflectance 0.5", "the reflectance of a Lambertian surface", None),
    option("incidence", "--incidence 60deg", "an angle of incidence", Some(Dimension::Angle)),
    option("time", "--time 1h", "a time", Some(Dimension::Time)),
    option("width", "--width 10nm", "the width of a band", Some(Dimension::Length)),
    option("efficacy", "--efficacy 100lm/W", "a luminous efficacy", Some(Dimension::Efficacy)),
    option("lambertian", "--lambertian", "that the surface shines like a Lambertian one", None),
    option("dome", "--dome", "that the light comes from an even hemisphere", None),
];

impl Need {
    /// All of them, in the order of [`OPTIONS`].
    pub(super) const ALL: [Need; 11] = [
        Need::Distance,
        Need::Cone,
        Need::SolidAngle,
        Need::Area,
        Need::Reflectance,
        Need::Incidence,
        Need::Time,
        Need::Width,
        Need::Efficacy,
        Need::Lambertian,
        Need::Dome,
    ];

    pub(super) fn info(self) -> &'static OptionInfo {
        &OPTIONS[self as usize]
    }

    /// The legal values in SI units, and in words.
    fn range(self) -> ([f64; 2], &'static str) {
        use std::f64::consts::PI;
        match self {
            Self::Distance => ([1e-9, 1e30], "1 nm to 1e30 m"),
            Self::Cone => ([1e-6, PI], "1e-6 rad to 180 deg"),
            Self::SolidAngle => ([1e-12, 4.0 * PI], "1e-12 sr to 4π sr"),
            Self::Area => ([1e-18, 1e30], "1e-18 m2 to 1e30 m2"),
            Self::Reflectance => ([1e-6, 1.0], "1e-6 to 1"),
            Self::Incidence => ([0.0, 89.99f64.to_radians()], "0 to 89.99 deg"),
            Self::Time => ([1e-15, 1e18], "1e-15 s to 1e18 s"),
            Self::Width => ([1e-15, 1e-3], "1e-6 nm to 1 mm"),
            Self::Efficacy => ([1e-6, 2000.0], "1e-6 lm/W to 2000 lm/W"),
            Self::Lambertian | Self::Dome => ([1.0, 1.0], "a flag"),
        }
    }
}

/// What a conversion may assume. Everything is optional; what is missing for a conversion is named in its error.
#[derive(Clone, Debug, Default)]
pub struct Assumptions {
    values: [Option<f64>; 11],
    /// The spectrum of the light, for steps between watts, lumens and photons.
    pub spectrum: Option<Spectrum>,
    /// The wavelengths that count as the light's energy; without it, those of the spectrum.
    pub range: Option<Range>,
    /// Another maximum luminous efficacy than the eye's, lm/W.
    pub k_m: Option<f64>,
    /// Which eye counts lumens.
    pub vision: Vision,
}

impl Assumptions {
    /// Nothing is assumed.
    pub fn none() -> Self {
        Self::default()
    }

    /// Sets one by its name and text: `distance` and `1.5 m`; also `spectrum`, `range`, `km`, `scotopic`.
    ///
    /// # Errors
    /// Unknown names; texts that are not of the option's dimension; values outside its range.
    pub fn set(&mut self, name: &str, text: &str) -> Result<(), QuantityError> {
        match name {
            "spectrum" => self.spectrum = Some(Spectrum::parse(text)?),
            "range" => self.range = Some(Range::parse(text)?),
            "scotopic" => self.vision = Vision::Scotopic,
            "km" => self.k_m = Some(efficacy(text)?),
            _ => {
                let Some(need) = Need::ALL.into_iter().find(|need| need.info().name == name) else {
                    let what = format!("there is no option `{}`", crate::error::shown(name));
                    return Err(QuantityError::NoConversion { what, hint: String::new() });
                };
                self.set_value(need, number(need, text)?)?;
            }
        }
        Ok(())
    }

    /// Sets a number in SI units; 1 for a flag.
    ///
    /// # Errors
    /// `OutOfRange`.
    pub fn set_value(&mut self, need: Need, value: f64) -> Result<(), QuantityError> {
        let ([low, high], accepted) = need.range();
        if !(low..=high).contains(&value) {
            return Err(QuantityError::OutOfRange { name: need.info().name, given: value, accepted });
        }
        self.values[need as usize] = Some(value);
        Ok(())
    }

    /// Whether a number was given.
    pub fn has(&self, need: Need) -> bool {
        self.values[need as usize].is_some()
    }

    /// The number in SI units; NaN where it was not given, which no rule does that asks for its needs first.
    pub(super) fn get(&self, need: Need) -> f64 {
        self.values[need as usize].unwrap_or(f64::NAN)
    }

    pub(super) fn or(&self, need: Need, otherwise: f64) -> f64 {
        self.values[need as usize].unwrap_or(otherwise)
    }
}

fn number(need: Need, text: &str) -> Result<f64, QuantityError> {
    match need.info().dimension {
        Some(dimension) => Ok(Quantity::parse_as(text, &[dimension])?.si()),
        None if matches!(need, Need::Lambertian | Need::Dome) => Ok(1.0),
        None => {
            let bad = || QuantityError::NotANumber { given: text.trim().to_string() };
            let (digits, scale) =
                text.trim().strip_suffix('%').map_or((text.trim(), 1.0), |rest| (rest.trim_end(), 100.0));
            let value: f64 = digits.parse().map_err(|_| bad())?;
            Ok(value / scale)
        }
    }
}

/// `680` or `680 lm/W`.
fn efficacy(text: &str) -> Result<f64, QuantityError> {
    let value = match text.trim().parse() {
        Ok(value) => value,
        Err(_) => Quantity::parse_as(text, &[Dimension::Efficacy])?.si(),
    };
    let accepted = "1 lm/W to 2000 lm/W";
    let legal = (1.0..=2000.0).contains(&value);
    if legal { Ok(value) } else { Err(QuantityError::OutOfRange { name: "km", given: value, accepted }) }
}
