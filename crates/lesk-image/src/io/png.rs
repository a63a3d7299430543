//! PNG: what a screen shows, 8 or 16 bit.
//!
//! Read numbers are the file's code values over the largest, with [`Transfer::Srgb`]; gamma, chromaticity and profile chunks
//! are not applied. Of an animation the first picture is read.

use super::check_declared;
use crate::ImageError;
use crate::image::{Image, Transfer};
use crate::tonemap::srgb_encode;
use ::image::codecs::png::PngDecoder;
use ::image::{DynamicImage, ImageDecoder, Limits};
use std::io::Cursor;

/// Deflate packs at most 1032 bytes into one (two bits for 258).
const DEFLATE_RATIO: u128 = 1032;

/// Bits per number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Depth {
    /// 0 to 255.
    Eight,
    /// 0 to 65535.
    Sixteen,
}

/// Reads a PNG from memory.
///
/// # Errors
/// Damaged bytes, sizes beyond the limits.
pub fn decode(bytes: &[u8]) -> Result<Image, ImageError> {
    let malformed = |error: ::image::ImageError| ImageError::malformed("PNG", error.to_string());
    let decoder = PngDecoder::with_limits(Cursor::new(bytes), limits()).map_err(malformed)?;
    let (width, height) = decoder.dimensions();
    // an interlaced or palette image of one bit holds eight pixels per byte
    let declared =
        u128::from(width) * u128::from(height) * u128::from(decoder.original_color_type().bits_per_pixel()) / 8;
    check_declared("PNG", (width.into(), height.into()), declared, bytes.len(), DEFLATE_RATIO)?;
    from_dynamic("PNG", DynamicImage::from_decoder(decoder).map_err(malformed)?)
}

/// Limits for the decoders of the crate image: what they allocate beyond is an error.
pub(super) fn limits() -> Limits {
    let mut limits = Limits::default();
    limits.max_image_width = Some(crate::MAX_SIDE);
    limits.max_image_height = Some(crate::MAX_SIDE);
    limits.max_alloc = Some(crate::MAX_PIXELS * 8);
    limits
}

/// Code values over the largest one.
pub(super) fn from_dynamic(format: &'static str, decoded: DynamicImage) -> Result<Image, ImageError> {
    let (width, height) = (decoded.width(), decoded.height());
    let channels = usize::from(decoded.color().channel_count());
    let eight = |codes: Vec<u8>| codes.into_iter().map(|v| f32::from(v) / 255.0).collect();
    let sixteen = |codes: Vec<u16>| codes.into_iter().map(|v| f32::from(v) / 65_535.0).collect();
    let data = match decoded {
        DynamicImage::ImageLuma8(i) => eight(i.into_raw()),
        DynamicImage::ImageLumaA8(i) => eight(i.into_raw()),
        DynamicImage::ImageRgb8(i) => eight(i.into_raw()),
        DynamicImage::ImageRgba8(i) => eight(i.into_raw()),
        DynamicImage::ImageLuma16(i) => sixteen(i.into_raw()),
        DynamicImage::ImageLumaA16(i) => sixteen(i.into_raw()),
        DynamicImage::ImageRgb16(i) => sixteen(i.into_raw()),
        DynamicImage::ImageRgba16(i) => sixteen(i.into_raw()),
        other => return Err(ImageError::unsupported(format, format!("pixels of type {:?}", other.color()))),
    };
    Image::new(width, height, channels, Transfer::Srgb, data)
}

/// Writes a PNG to memory: the same image and texts give the same bytes.
///
/// Linear images are clipped to 0..1 and sRGB-encoded, encoded ones are written as they are; NaN becomes 0. `texts` are
/// pairs of keyword (1 to 79 Latin-1 characters) and text, for settings.
///
/// # Errors
/// Keywords that PNG does not allow.
pub fn encode(image: &Image, depth: Depth, texts: &[(&str, &str)]) -> Result<Vec<u8>, ImageError> {
    let failed = |error: ::png::EncodingError| ImageError::invalid(format!("cannot make a PNG: {error}"));
    let mut bytes = Vec::new();
    let mut encoder = ::png::Encoder::new(&mut bytes, image.width(), image.height());
    encoder.set_color(match image.channels() {
        1 => ::png::ColorType::Grayscale,
        2 => ::png::ColorType::GrayscaleAlpha,
        3 => ::png::ColorType::Rgb,
        _ => ::png::ColorType::Rgba,
    });
    encoder.set_depth(if depth == Depth::Eight { ::png::BitDepth::Eight } else { ::png::BitDepth::Sixteen });
    encoder.set_source_srgb(::png::SrgbRenderingIntent::RelativeColorimetric);
    for (keyword, text) in texts {
        encoder.add_itxt_chunk((*keyword).to_string(), (*text).to_string()).map_err(failed)?;
    }
    let mut writer = encoder.write_header().map_err(failed)?;
    writer.write_image_data(&codes(image, depth)).map_err(failed)?;
    writer.finish().map_err(failed)?;
    Ok(bytes)
}

/// Code values, the larger byte first.
fn codes(image: &Image, depth: Depth) -> Vec<u8> {
    let colors = if image.channels() < 3 { 1 } else { 3 };
    let max = if depth == Depth::Eight { 255.0 } else { 65_535.0 };
    let mut bytes = Vec::with_capacity(image.data().len() * if depth == Depth::Eight { 1 } else { 2 });
    for pixel in image.data().chunks_exact(image.channels()) {
        for (c, value) in pixel.iter().enumerate() {
            let value = if value.is_nan() { 0.0 } else { value.clamp(0.0, 1.0) };
            let shown = if image.transfer() == Transfer::Linear && c < colors { srgb_encode(value) } else { value };
            let code = (shown * max + 0.5) as u16;
            match depth {
                Depth::Eight => bytes.push(code as u8),
                Depth::Sixteen => bytes.extend(code.to_be_bytes()),
            }
        }
    }
    bytes
}

#[cfg(test)]
#[path = "png_tests.rs"]
mod tests;
