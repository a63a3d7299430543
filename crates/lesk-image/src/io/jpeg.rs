//! JPEG, for textures of scenes: read only.

use super::check_declared;
use super::png::{from_dynamic, limits};
use crate::ImageError;
use crate::image::Image;
use ::image::codecs::jpeg::JpegDecoder;
use ::image::{DynamicImage, ImageDecoder};
use std::io::Cursor;

/// Every block of 8 x 8 samples takes at least one bit, and a quarter of all samples may be left out in colour.
const PIXELS_PER_BYTE: u128 = 2048;

/// Reads a JPEG from memory: code values over 255, [`Transfer::Srgb`](crate::Transfer::Srgb); profiles and orientation tags
/// are not applied.
///
/// # Errors
/// Damaged bytes, sizes beyond the limits, CMYK.
pub fn decode(bytes: &[u8]) -> Result<Image, ImageError> {
    let malformed = |error: ::image::ImageError| ImageError::malformed("JPEG", error.to_string());
    let mut decoder = JpegDecoder::new(Cursor::new(bytes)).map_err(malformed)?;
    let (width, height) = decoder.dimensions();
    let declared = u128::from(width) * u128::from(height);
    check_declared("JPEG", (width.into(), height.into()), declared, bytes.len(), PIXELS_PER_BYTE)?;
    decoder.set_limits(limits()).map_err(malformed)?;
    from_dynamic("JPEG", DynamicImage::from_decoder(decoder).map_err(malformed)?)
}
