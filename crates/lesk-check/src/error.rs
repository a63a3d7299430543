//! The error of this crate.

use std::fmt;

/// Why a condition cannot be read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Error {
    /// The condition as given.
    pub condition: String,
    /// The place in it, counted in characters from 1.
    pub column: usize,
    /// What stands there and what is accepted.
    pub message: String,
    /// A name that may have been meant.
    pub hint: Option<String>,
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "condition `{}`, column {}: {}", self.condition, self.column, self.message)?;
        match &self.hint {
            Some(hint) => write!(f, "\nhint: {hint}"),
            None => Ok(()),
        }
    }
}

impl std::error::Error for Error {}
