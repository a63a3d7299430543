//! The one error of this crate.

use std::fmt;

/// A light that cannot shine: what was given, what is accepted, and what to do about it.
#[derive(Clone, Debug, PartialEq)]
pub struct LightError {
    message: String,
    hint: String,
}

impl LightError {
    pub(crate) fn new(message: impl Into<String>) -> Self {
        LightError { message: message.into(), hint: String::new() }
    }

    pub(crate) fn hint(mut self, hint: impl Into<String>) -> Self {
        self.hint = hint.into();
        self
    }

    /// What was given and what is accepted.
    pub fn message(&self) -> &str {
        &self.message
    }

    /// What to do about it; empty where nothing helps.
    pub fn hint_text(&self) -> &str {
        &self.hint
    }
}

impl From<lesk_geometry::Error> for LightError {
    fn from(error: lesk_geometry::Error) -> Self {
        LightError { message: error.message, hint: error.hint }
    }
}

impl fmt::Display for LightError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)?;
        if !self.hint.is_empty() {
            write!(f, "\nhint: {}", self.hint)?;
        }
        Ok(())
    }
}

impl std::error::Error for LightError {}

/// Checks a photometric colour: finite, not negative, not black.
pub(crate) fn check_color(what: &str, unit: &str, color: lesk_math::Color<f32>) -> Result<(), LightError> {
    // the comparison fails for NaN too
    if !color.0.iter().all(|&c| (0.0..=1e30).contains(&c)) {
        return Err(LightError::new(format!("{what} is {:?} {unit}, channels from 0 to 1e30 are accepted", color.0)));
    }
    if color.max_component() == 0.0 {
        return Err(LightError::new(format!("{what} is 0 {unit}, it must be positive"))
            .hint("remove the light to have it dark"));
    }
    Ok(())
}

/// Checks a direction: finite and of some length; returns it with unit length.
pub(crate) fn check_direction(what: &str, v: lesk_math::Vec3<f32>) -> Result<lesk_math::Vec3<f32>, LightError> {
    let wide = v.map(f64::from);
    let length = wide.length();
    if !(length.is_finite() && length > 1e-30) {
        return Err(LightError::new(format!(
            "{what} is {:?}, a direction of positive, finite length is accepted",
            v.to_array()
        )));
    }
    Ok((wide / length).map(|x| x as f32))
}
