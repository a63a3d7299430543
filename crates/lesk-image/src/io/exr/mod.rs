//! OpenEXR: named channels of half, float or integer numbers with attributes.
//!
//! Reading goes through the crate exr and takes flat files of every compression, in scan lines or tiles, of one part or
//! several of one size. Writing is our own: one part of scan lines in ZIP blocks, with channels and attributes in the order
//! of their names and nothing of clock or host, so that equal planes give equal bytes.

mod read;
mod write;

pub use read::decode;
pub use write::encode;

use crate::{ImageError, Planes};
use std::path::Path;

/// Writes planes as an EXR file; a previous file is replaced only when the new one is complete.
///
/// # Errors
/// No channel, names that EXR cannot hold, a failed write.
pub fn write(path: impl AsRef<Path>, planes: &Planes) -> Result<(), ImageError> {
    super::write_bytes(path.as_ref(), &encode(planes).map_err(|error| error.at(path.as_ref()))?)
}

#[cfg(test)]
mod tests;
