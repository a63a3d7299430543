//! The one error of this crate.

use crate::Dimension;
use std::fmt;

/// Why a text is not the quantity that was asked for, or a number is outside the range of a formula.
#[derive(Clone, Debug, PartialEq)]
pub enum QuantityError {
    /// The text does not begin with a finite decimal number.
    NotANumber {
        /// What was given.
        given: String,
    },
    /// A number without a unit.
    MissingUnit {
        /// What was given.
        given: String,
        /// What would be accepted; empty where anything is.
        accepted: Vec<Dimension>,
    },
    /// A unit that is not in the table.
    UnknownUnit {
        /// The unit that was given.
        given: String,
        /// The known unit that was probably meant: another case, or a symbol for a word.
        meant: Option<&'static str>,
    },
    /// A quantity of another dimension than the accepted ones.
    WrongDimension {
        /// What was given.
        given: String,
        /// The dimension of what was given.
        dimension: Dimension,
        /// What is accepted.
        accepted: Vec<Dimension>,
    },
    /// Text that is no range of wavelengths.
    BadRange {
        /// What was given.
        given: String,
    },
    /// The name of a spectrum that is not known.
    UnknownSpectrum {
        /// What was given.
        given: String,
    },
    /// A table of a spectrum that cannot be read.
    BadTable {
        /// The line, from 1; 0 where the whole table is meant.
        line: usize,
        /// What is wrong, and what is accepted.
        what: String,
    },
    /// A conversion that needs more than was given, or that does not exist.
    NoConversion {
        /// What is wrong.
        what: String,
        /// What would help; may be empty.
        hint: String,
    },
    /// A number outside the range that a formula accepts.
    OutOfRange {
        /// The name of the parameter.
        name: &'static str,
        /// The value that was given.
        given: f64,
        /// The accepted range in words.
        accepted: &'static str,
    },
}

impl fmt::Display for QuantityError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotANumber { given } => write!(
                f,
                "`{}` does not begin with a finite number\nhint: write a decimal number with a point and a unit, like `1100 lm` or `2.5e-3 m`",
                shown(given)
            ),
            Self::MissingUnit { given, accepted } => {
                write!(f, "`{}` has no unit", shown(given))?;
                if let Some(first) = accepted.first() {
                    write!(f, ", {} is accepted", list(accepted))?;
                    write!(f, "\nhint: add the unit, for example `{} {}`", shown(given), first.examples()[0])?;
                } else {
                    write!(f, "\nhint: add the unit, for example `{} m`", shown(given))?;
                }
                Ok(())
            }
            Self::UnknownUnit { given, meant } => {
                write!(f, "unknown unit `{}`", shown(given))?;
                match meant {
                    Some(symbol) if symbol.eq_ignore_ascii_case(given) => {
                        write!(f, "\nhint: `{symbol}` is known; case matters")
                    }
                    Some(symbol) => write!(f, "\nhint: write `{symbol}`"),
                    None => write!(
                        f,
                        "\nhint: known are m, deg, s, K, W, lm, W/sr, cd, W/m2, lx, W/m2/sr, cd/m2, nit, EV, with prefixes like k and m; `lesk quantity --units` lists all"
                    ),
                }
            }
            Self::WrongDimension { given, dimension, accepted } => {
                write!(f, "`{}` is {}, but {} is accepted", shown(given), dimension, list(accepted))?;
                match accepted.iter().find_map(|to| reason(*dimension, *to)) {
                    Some(reason) => write!(f, "\nhint: {reason}"),
                    None => Ok(()),
                }
            }
            Self::BadRange { given } => write!(
                f,
                "`{}` is no range of wavelengths, first and last nm from 1 to 100000 are accepted, like `380:780`",
                shown(given)
            ),
            Self::UnknownSpectrum { given } => {
                write!(f, "unknown spectrum `{}`, {} are accepted", shown(given), crate::spectrum::ACCEPTED)
            }
            Self::BadTable { line: 0, what } => f.write_str(what),
            Self::BadTable { line, what } => write!(f, "line {line}: {what}"),
            Self::NoConversion { what, hint } if hint.is_empty() => f.write_str(what),
            Self::NoConversion { what, hint } => write!(f, "{what}\nhint: {hint}"),
            Self::OutOfRange { name, given, accepted } => write!(f, "`{name}` is {given}, but {accepted} is accepted"),
        }
    }
}

impl std::error::Error for QuantityError {}

/// At most 40 characters of what was given, without line breaks.
pub(crate) fn shown(text: &str) -> String {
    let mut out: String = text.chars().take(40).map(|c| if c.is_control() { ' ' } else { c }).collect();
    if text.chars().nth(40).is_some() {
        out.push('…');
    }
    out
}

/// `a length (m, cm, ...) or an angle (deg, rad)`.
fn list(accepted: &[Dimension]) -> String {
    let one = |d: &Dimension| format!("{d} ({})", d.examples().join(", "));
    accepted.iter().map(one).collect::<Vec<_>>().join(" or ")
}

/// Why one dimension does not become another, where people expect that it does.
pub(crate) fn reason(from: Dimension, to: Dimension) -> Option<&'static str> {
    use Dimension::*;
    if from.is_photometric() && to.is_radiometric() || from.is_radiometric() && to.is_photometric() {
        return Some(
            "W and lm are linked by a spectrum only: 683.002 lm/W holds at 555 nm, other light has its own efficacy",
        );
    }
    Some(match (from.photometric(), to.photometric()) {
        (Illuminance, LuminousIntensity) | (LuminousIntensity, Illuminance) => {
            "lx is per area, cd per solid angle: a distance is needed"
        }
        (LuminousFlux, LuminousIntensity) | (LuminousIntensity, LuminousFlux) => {
            "lm is in all directions together, cd per solid angle: the distribution over directions is needed"
        }
        (LuminousFlux, Illuminance) | (Illuminance, LuminousFlux) => {
            "lm is the whole flux, lx is per area: the lit area is needed"
        }
        (Luminance, LuminousIntensity) | (LuminousIntensity, Luminance) => {
            "cd/m2 is cd per projected area of the source: its area is needed"
        }
        (Luminance, Illuminance) | (Illuminance, Luminance) => {
            "lx arrives at a surface, cd/m2 is seen in a direction: the solid angle of the source or the reflectance is needed"
        }
        (Luminance, LuminousFlux) | (LuminousFlux, Luminance) => {
            "lm is the whole flux, cd/m2 is per area and solid angle: the area of the source is needed (lm = pi * cd/m2 * m2 for a diffuse one)"
        }
        _ => return None,
    })
}
