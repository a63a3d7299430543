//! The one error of this crate.

use std::fmt;

/// What is wrong with a shape, a transform or a file: plain facts, formatted in one place.
///
/// Prints as `PLACE: MESSAGE`, and `hint: HINT` on a line of its own.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Error {
    /// Where: a line, a byte, an element, a path; empty where the caller knows.
    pub place: String,
    /// What was given and what is accepted.
    pub message: String,
    /// What to do about it; empty where nothing helps.
    pub hint: String,
}

/// The result of this crate's fallible functions.
pub type Result<T> = std::result::Result<T, Error>;

impl Error {
    /// An error without a place; see [`at`](Error::at).
    pub fn new(message: impl Into<String>) -> Self {
        Error { place: String::new(), message: message.into(), hint: String::new() }
    }

    /// A file that the system does not give, with its reason in lower case and without its number.
    pub fn unreadable(error: &std::io::Error) -> Self {
        let text = error.to_string();
        let reason = text.split(" (os error").next().unwrap_or_default();
        let mut chars = reason.chars();
        let reason: String = chars.next().into_iter().flat_map(char::to_lowercase).chain(chars).collect();
        Error::new(format!("cannot be read: {reason}"))
    }

    /// The same error, placed: an outer place is put before an inner one.
    #[must_use]
    pub fn at(mut self, place: impl fmt::Display) -> Self {
        self.place = if self.place.is_empty() { place.to_string() } else { format!("{place}: {}", self.place) };
        self
    }

    /// The same error with a hint.
    #[must_use]
    pub fn hint(mut self, hint: impl Into<String>) -> Self {
        self.hint = hint.into();
        self
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if !self.place.is_empty() {
            write!(f, "{}: ", self.place)?;
        }
        f.write_str(&self.message)?;
        if !self.hint.is_empty() {
            write!(f, "\nhint: {}", self.hint)?;
        }
        Ok(())
    }
}

impl std::error::Error for Error {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_nest_and_the_hint_has_its_own_line() {
        let e = Error::new("`vt` has 1 number, 2 are needed").at("line 3").at("a.obj").hint("add one");
        assert_eq!(e.to_string(), "a.obj: line 3: `vt` has 1 number, 2 are needed\nhint: add one");
    }
}
