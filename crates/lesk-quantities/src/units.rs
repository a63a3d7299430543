//! Quantities as people write them: a number, an SI prefix, a unit.

use crate::QuantityError;
use std::f64::consts::PI;
use std::fmt;
use std::str::FromStr;

/// What a quantity measures; each has one SI unit, see [`Dimension::si_symbol`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Dimension {
    /// m
    Length,
    /// rad
    Angle,
    /// s
    Time,
    /// K
    Temperature,
    /// W
    RadiantFlux,
    /// lm
    LuminousFlux,
    /// W/sr
    RadiantIntensity,
    /// cd
    LuminousIntensity,
    /// W/m²
    Irradiance,
    /// lx
    Illuminance,
    /// W/m²/sr
    Radiance,
    /// cd/m²
    Luminance,
    /// EV at ISO 100, a logarithm to base 2
    ExposureValue,
}

impl Dimension {
    /// The symbol of the unit in which [`Quantity::si`] gives this dimension.
    pub fn si_symbol(self) -> &'static str {
        self.examples()[0]
    }

    /// Units that people use for this dimension, the SI unit first.
    pub fn examples(self) -> &'static [&'static str] {
        match self {
            Self::Length => &["m", "cm", "mm", "km", "in", "ft"],
            Self::Angle => &["rad", "deg"],
            Self::Time => &["s", "ms"],
            Self::Temperature => &["K"],
            Self::RadiantFlux => &["W", "mW"],
            Self::LuminousFlux => &["lm", "klm"],
            Self::RadiantIntensity => &["W/sr"],
            Self::LuminousIntensity => &["cd", "kcd"],
            Self::Irradiance => &["W/m2"],
            Self::Illuminance => &["lx", "klx"],
            Self::Radiance => &["W/m2/sr"],
            Self::Luminance => &["cd/m2", "kcd/m2", "nit"],
            Self::ExposureValue => &["EV"],
        }
    }

    /// True for units that count light by the watt.
    pub fn is_radiometric(self) -> bool {
        matches!(self, Self::RadiantFlux | Self::RadiantIntensity | Self::Irradiance | Self::Radiance)
    }

    /// True for units that count light by the lumen.
    pub fn is_photometric(self) -> bool {
        matches!(self, Self::LuminousFlux | Self::LuminousIntensity | Self::Illuminance | Self::Luminance)
    }

    /// The photometric sibling of a radiometric dimension; any other dimension is returned as it is.
    pub fn photometric(self) -> Dimension {
        match self {
            Self::RadiantFlux => Self::LuminousFlux,
            Self::RadiantIntensity => Self::LuminousIntensity,
            Self::Irradiance => Self::Illuminance,
            Self::Radiance => Self::Luminance,
            other => other,
        }
    }
}

impl fmt::Display for Dimension {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Length => "a length",
            Self::Angle => "an angle",
            Self::Time => "a time",
            Self::Temperature => "a temperature",
            Self::RadiantFlux => "a radiant flux",
            Self::LuminousFlux => "a luminous flux",
            Self::RadiantIntensity => "a radiant intensity",
            Self::LuminousIntensity => "a luminous intensity",
            Self::Irradiance => "an irradiance",
            Self::Illuminance => "an illuminance",
            Self::Radiance => "a radiance",
            Self::Luminance => "a luminance",
            Self::ExposureValue => "an exposure value",
        })
    }
}

/// One row of the unit table.
#[derive(Debug, PartialEq)]
struct Base {
    symbol: &'static str,
    dimension: Dimension,
    /// SI units in one of this unit.
    factor: f64,
    /// May it carry k, m, ...?
    prefixed: bool,
}

const fn base(symbol: &'static str, dimension: Dimension, factor: f64, prefixed: bool) -> Base {
    Base { symbol, dimension, factor, prefixed }
}

/// All units, spelled as [`normalise`] leaves them.
static UNITS: &[Base] = &[
    base("m", Dimension::Length, 1.0, true),
    base("in", Dimension::Length, 0.0254, false),
    base("ft", Dimension::Length, 0.3048, false),
    base("rad", Dimension::Angle, 1.0, true),
    base("deg", Dimension::Angle, PI / 180.0, false),
    base("°", Dimension::Angle, PI / 180.0, false),
    base("s", Dimension::Time, 1.0, true),
    base("min", Dimension::Time, 60.0, false),
    base("h", Dimension::Time, 3600.0, false),
    base("K", Dimension::Temperature, 1.0, true),
    base("W", Dimension::RadiantFlux, 1.0, true),
    base("lm", Dimension::LuminousFlux, 1.0, true),
    base("W/sr", Dimension::RadiantIntensity, 1.0, true),
    base("cd", Dimension::LuminousIntensity, 1.0, true),
    base("lm/sr", Dimension::LuminousIntensity, 1.0, true),
    base("W/m2", Dimension::Irradiance, 1.0, true),
    base("lx", Dimension::Illuminance, 1.0, true),
    base("lm/m2", Dimension::Illuminance, 1.0, true),
    base("fc", Dimension::Illuminance, 1.0 / (0.3048 * 0.3048), false), // footcandle: lm/ft2
    base("W/m2/sr", Dimension::Radiance, 1.0, true),
    base("W/sr/m2", Dimension::Radiance, 1.0, true),
    base("cd/m2", Dimension::Luminance, 1.0, true),
    base("nit", Dimension::Luminance, 1.0, true),
    base("nt", Dimension::Luminance, 1.0, false),
    base("sb", Dimension::Luminance, 1e4, false),       // stilb: cd/cm2
    base("asb", Dimension::Luminance, 1.0 / PI, false), // apostilb
    base("La", Dimension::Luminance, 1e4 / PI, false),  // lambert
    base("fL", Dimension::Luminance, 1.0 / (PI * 0.3048 * 0.3048), false), // footlambert: cd/ft2/pi
    base("EV", Dimension::ExposureValue, 1.0, false),
];

/// An SI prefix, as a quotient of two exact numbers: 7 mm is 7 / 1000, correctly rounded.
#[derive(Debug, PartialEq)]
struct Prefix {
    symbol: &'static str,
    times: f64,
    over: f64,
}

const fn prefix(symbol: &'static str, times: f64, over: f64) -> Prefix {
    Prefix { symbol, times, over }
}

/// SI prefixes, none first; `c` for the metre only; `u` and the two micro signs of Unicode are the same.
static PREFIXES: &[Prefix] = &[
    prefix("", 1.0, 1.0),
    prefix("n", 1.0, 1e9),
    prefix("u", 1.0, 1e6),
    prefix("µ", 1.0, 1e6),
    prefix("μ", 1.0, 1e6),
    prefix("m", 1.0, 1e3),
    prefix("c", 1.0, 1e2),
    prefix("k", 1e3, 1.0),
    prefix("M", 1e6, 1.0),
    prefix("G", 1e9, 1.0),
];

/// A unit of the table with its prefix.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unit {
    prefix: &'static Prefix,
    base: &'static Base,
}

impl Unit {
    /// Reads a unit: `lm`, `kcd/m²`, `W/m^2/sr`, `W/(m2 sr)`.
    ///
    /// # Errors
    /// `UnknownUnit`, with the known spelling where only the case differs.
    pub fn parse(text: &str) -> Result<Unit, QuantityError> {
        let name = normalise(text);
        for prefix in PREFIXES {
            let Some(rest) = name.strip_prefix(prefix.symbol) else { continue };
            let found = UNITS.iter().find(|base| base.symbol == rest && allowed(prefix, base));
            if let Some(base) = found {
                return Ok(Unit { prefix, base });
            }
        }
        let meant = UNITS.iter().map(|base| base.symbol).find(|symbol| symbol.eq_ignore_ascii_case(&name));
        Err(QuantityError::UnknownUnit { given: text.trim().to_string(), meant })
    }

    /// What the unit measures.
    pub fn dimension(self) -> Dimension {
        self.base.dimension
    }

    /// SI units in one of this unit: 0.01 for `cm`.
    pub fn factor(self) -> f64 {
        self.to_si(1.0)
    }

    fn to_si(self, value: f64) -> f64 {
        value * self.prefix.times / self.prefix.over * self.base.factor
    }

    fn value_of(self, si: f64) -> f64 {
        si * self.prefix.over / self.prefix.times / self.base.factor
    }
}

impl fmt::Display for Unit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}{}", self.prefix.symbol, self.base.symbol)
    }
}

fn allowed(prefix: &Prefix, base: &Base) -> bool {
    prefix.symbol.is_empty() || base.prefixed && (prefix.symbol != "c" || base.symbol == "m")
}

/// One spelling for all: no blanks, `2` for `²` and `^2`, `W/m2/sr` for `W/(m2 sr)`.
fn normalise(text: &str) -> String {
    let text: String = text.trim().replace("(m2 sr)", "m2/sr").replace("(m² sr)", "m2/sr").replace("(m^2 sr)", "m2/sr");
    text.chars().filter(|c| !c.is_whitespace() && *c != '^').map(|c| if c == '²' { '2' } else { c }).collect()
}

/// A finite number with a unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quantity {
    value: f64,
    unit: Unit,
}

impl Quantity {
    /// A quantity of `value` times `unit`.
    ///
    /// # Errors
    /// `NotANumber` if the value, or the value in SI units, is NaN or infinite.
    pub fn new(value: f64, unit: Unit) -> Result<Quantity, QuantityError> {
        if value.is_finite() && unit.to_si(value).is_finite() {
            Ok(Quantity { value, unit })
        } else {
            Err(QuantityError::NotANumber { given: format!("{value} {unit}") })
        }
    }

    /// Reads a quantity of any dimension: `1100 lm`, `5cm`, `-2.5e-3 rad`.
    ///
    /// # Errors
    /// `NotANumber`, `MissingUnit`, `UnknownUnit`.
    pub fn parse(text: &str) -> Result<Quantity, QuantityError> {
        Self::parse_as(text, &[])
    }

    /// Reads a quantity of one of the accepted dimensions; an empty list accepts all.
    ///
    /// # Errors
    /// `NotANumber`, `MissingUnit`, `UnknownUnit`, and `WrongDimension` with the reason why it does not convert.
    pub fn parse_as(text: &str, accepted: &[Dimension]) -> Result<Quantity, QuantityError> {
        let given = || text.trim().to_string();
        let (number, unit) = text.trim().split_at(number_length(text.trim()));
        let value: f64 = number.parse().map_err(|_| QuantityError::NotANumber { given: given() })?;
        if !value.is_finite() {
            return Err(QuantityError::NotANumber { given: given() });
        }
        if unit.trim().is_empty() {
            return Err(QuantityError::MissingUnit { given: given(), accepted: accepted.to_vec() });
        }
        if unit.starts_with([',', '.', '_']) {
            return Err(QuantityError::NotANumber { given: given() });
        }
        let quantity = Self::new(value, Unit::parse(unit)?)?;
        quantity.expect(accepted)
    }

    /// The quantity itself if its dimension is one of the accepted ones; an empty list accepts all.
    ///
    /// # Errors
    /// `WrongDimension` with the reason why it does not convert.
    pub fn expect(self, accepted: &[Dimension]) -> Result<Quantity, QuantityError> {
        if accepted.is_empty() || accepted.contains(&self.dimension()) {
            return Ok(self);
        }
        Err(QuantityError::WrongDimension { given: self.to_string(), unit: self.unit, accepted: accepted.to_vec() })
    }

    /// The number before the unit.
    pub fn value(self) -> f64 {
        self.value
    }

    /// The unit as written.
    pub fn unit(self) -> Unit {
        self.unit
    }

    /// What it measures.
    pub fn dimension(self) -> Dimension {
        self.unit.dimension()
    }

    /// The number in the SI unit of its dimension: `5 cm` is 0.05, `90 deg` is π/2.
    pub fn si(self) -> f64 {
        self.unit.to_si(self.value)
    }

    /// The number in another unit of the same dimension.
    ///
    /// # Errors
    /// `WrongDimension` with the reason, for example that lx to cd needs a distance.
    pub fn to(self, unit: Unit) -> Result<f64, QuantityError> {
        self.expect(&[unit.dimension()])?;
        Ok(if unit == self.unit { self.value } else { unit.value_of(self.si()) })
    }
}

impl fmt::Display for Quantity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}", self.value, self.unit)
    }
}

impl FromStr for Quantity {
    type Err = QuantityError;
    fn from_str(text: &str) -> Result<Quantity, QuantityError> {
        Self::parse(text)
    }
}

/// Bytes of the decimal number at the start: sign, digits, point, exponent.
fn number_length(text: &str) -> usize {
    let bytes = text.as_bytes();
    let digits = |from: usize| bytes[from.min(bytes.len())..].iter().take_while(|b| b.is_ascii_digit()).count();
    let sign = |at: usize| usize::from(matches!(bytes.get(at), Some(b'+' | b'-')));
    let mut at = sign(0);
    at += digits(at);
    if bytes.get(at) == Some(&b'.') {
        at += 1 + digits(at + 1);
    }
    // an `e` is an exponent only if a number follows
    if matches!(bytes.get(at), Some(b'e' | b'E')) {
        let start = at + 1 + sign(at + 1);
        if digits(start) > 0 {
            at = start + digits(start);
        }
    }
    at
}

#[cfg(test)]
#[path = "units_tests.rs"]
mod tests;
