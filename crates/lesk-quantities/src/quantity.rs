//! A number with a unit: `1100 lm`.

use crate::dimension::Dimension;
use crate::{QuantityError, Unit};
use std::fmt;
use std::str::FromStr;

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
        Err(QuantityError::WrongDimension {
            given: self.to_string(),
            dimension: self.dimension(),
            accepted: accepted.to_vec(),
        })
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
#[path = "quantity_tests.rs"]
mod tests;
