//! The one error of this crate.

use std::fmt;
use std::io;
use std::path::{Path, PathBuf};

/// Why an image could not be made, read or written.
#[derive(Debug)]
pub enum ImageError {
    /// A file or its folder cannot be opened or read.
    Read {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// Writing failed. A previous regular file of that name is still there, unchanged.
    Write {
        /// The file.
        path: PathBuf,
        /// Bytes that had been written.
        written: u64,
        /// Bytes that were to be written, where known.
        size: Option<u64>,
        /// What the system said.
        source: io::Error,
    },
    /// The bytes are not a valid file of their format.
    Malformed {
        /// `EXR`, `PNG`, ...
        format: &'static str,
        /// What is wrong and where.
        what: String,
    },
    /// A valid file or request that Lesk does not take.
    Unsupported {
        /// `EXR`, `PNG`, ...
        format: &'static str,
        /// What was given and what is accepted.
        what: String,
    },
    /// A size outside the limits.
    TooLarge {
        /// What has the size: `EXR`, `film`, ...
        what: &'static str,
        /// Width in pixels.
        width: u64,
        /// Height in pixels.
        height: u64,
        /// The limit that was met.
        limit: String,
    },
    /// A parameter that is not accepted.
    Invalid {
        /// What was given and what is accepted.
        what: String,
    },
    /// An error within a file.
    At {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        error: Box<ImageError>,
    },
}

impl ImageError {
    /// The same error with the file that it is about.
    pub fn at(self, path: &Path) -> ImageError {
        match self {
            Self::At { .. } | Self::Read { .. } | Self::Write { .. } => self,
            error => Self::At { path: path.to_path_buf(), error: Box::new(error) },
        }
    }

    pub(crate) fn malformed(format: &'static str, what: impl Into<String>) -> ImageError {
        Self::Malformed { format, what: what.into() }
    }

    pub(crate) fn unsupported(format: &'static str, what: impl Into<String>) -> ImageError {
        Self::Unsupported { format, what: what.into() }
    }

    pub(crate) fn invalid(what: impl Into<String>) -> ImageError {
        Self::Invalid { what: what.into() }
    }
}

impl fmt::Display for ImageError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Read { path, source } => write!(f, "cannot read `{}`: {}", path.display(), plain(source)),
            Self::Write { path, written, size, source } => {
                write!(f, "cannot write `{}`: {} after {written}", path.display(), plain(source))?;
                match size {
                    Some(size) => write!(f, " of {size} bytes")?,
                    None => write!(f, " bytes")?,
                }
                f.write_str(match source.kind() {
                    io::ErrorKind::NotFound => "\nhint: the folder does not exist, make it first",
                    io::ErrorKind::PermissionDenied => "\nhint: choose a place where you may write",
                    _ => "\nhint: a previous file of this name is unchanged; free some space or choose another place",
                })
            }
            Self::Malformed { format, what } => write!(f, "not a valid {format} file: {what}"),
            Self::Unsupported { format, what } => write!(f, "{format}: {what}"),
            Self::TooLarge { what, width, height, limit } => {
                write!(f, "{what} of {width} x {height} pixels, but {limit} is accepted")
            }
            Self::Invalid { what } => f.write_str(what),
            Self::At { path, error } => {
                let text = error.to_string();
                let (first, rest) = text.split_once('\n').unwrap_or((&text, ""));
                write!(f, "{first}, in `{}`", path.display())?;
                if rest.is_empty() { Ok(()) } else { write!(f, "\n{rest}") }
            }
        }
    }
}

impl std::error::Error for ImageError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::Read { source, .. } | Self::Write { source, .. } => Some(source),
            Self::At { error, .. } => Some(error),
            _ => None,
        }
    }
}

/// The system's message in lower case and without the number.
fn plain(error: &io::Error) -> String {
    let text = error.to_string();
    let text = text.split(" (os error").next().unwrap_or_default();
    let mut chars = text.chars();
    chars.next().map(|c| c.to_lowercase().chain(chars).collect()).unwrap_or_default()
}
