//! What can go wrong with an export.

use core::fmt;

/// Why no source was written.
#[derive(Clone, Debug, PartialEq)]
pub enum Error {
    /// The model has no formula: a measured table.
    NoFormula {
        /// The model's id.
        model: &'static str,
    },
    /// No part was asked for, or one was asked for twice.
    Parts {
        /// Names of the parts, as given.
        asked: Vec<&'static str>,
    },
    /// No language has this name.
    UnknownLanguage {
        /// The name that was given.
        given: String,
    },
    /// No part has this name.
    UnknownPart {
        /// The name that was given.
        given: String,
    },
    /// The formula has more operations than the exporter accepts.
    TooLarge {
        /// Operations of the formula.
        nodes: usize,
        /// The most that is accepted.
        limit: usize,
    },
    /// The formula has a longer chain of operations than the exporter accepts.
    TooDeep {
        /// The longest chain that is accepted.
        limit: u32,
    },
    /// The formula contains a number that no shading language can write.
    NotFinite {
        /// The number.
        value: f64,
    },
    /// The shader library refused what Lesk made; a bug of Lesk.
    Writer {
        /// The language's name.
        language: &'static str,
        /// What the library said.
        message: String,
    },
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let list = |names: &[&str]| names.iter().map(|n| format!("`{n}`")).collect::<Vec<_>>().join(", ");
        match self {
            Error::NoFormula { model } => {
                write!(f, "`{model}` is a table, not a formula, and has no shader source")
            }
            Error::Parts { asked } => {
                let parts = list(&crate::Part::ALL.map(crate::Part::name));
                write!(f, "the parts asked for are [{}]\nhint: ask for one or more of {parts}, each once", list(asked))
            }
            Error::UnknownLanguage { given } => {
                let known = list(&crate::Language::ALL.map(crate::Language::name));
                write!(f, "`{given}` is not a shading language that Lesk writes\nhint: use one of {known}")
            }
            Error::UnknownPart { given } => {
                let known = list(&crate::Part::ALL.map(crate::Part::name));
                write!(f, "`{given}` is not a part of a model\nhint: use one of {known}")
            }
            Error::TooLarge { nodes, limit } => {
                write!(f, "the formula has {nodes} operations, but at most {limit} can be exported")
            }
            Error::TooDeep { limit } => {
                write!(f, "the formula has a chain of more than {limit} operations, the most that can be exported")
            }
            Error::NotFinite { value } => {
                write!(f, "the formula contains the number {value}, which shading languages cannot write in 32 bits")
            }
            Error::Writer { language, message } => write!(f, "writing {language} failed: {message}"),
        }
    }
}

impl core::error::Error for Error {}
