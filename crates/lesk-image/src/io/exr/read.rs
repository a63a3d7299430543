//! Reading EXR through the crate exr, behind checks of everything that the header declares.

use crate::image::check_size;
use crate::io::check_declared;
use crate::{ImageError, Planes, Samples};
use ::exr::block::chunk::CompressedBlock;
use ::exr::image::{AnyChannels, FlatSamples, Layer};
use ::exr::meta::attribute::{AttributeValue, LevelMode};
use ::exr::meta::header::Header;
use ::exr::meta::{BlockDescription, MetaData};
use ::exr::prelude::{Compression, ReadChannels, ReadLayers};
use std::io::Cursor;

/// Channels of a file.
const MAX_CHANNELS: usize = 1024;
/// Parts of a file.
const MAX_PARTS: usize = 256;
/// Largest block, tile or lines, in bytes.
const MAX_BLOCK_BYTES: u128 = 1 << 30;
/// The most that one byte of a file stands for: deflate's 1032, and 64 coefficients of DWA from one of them.
const RATIO: u128 = 1032;
const DWA_RATIO: u128 = 64 * RATIO;

/// Reads an EXR file from memory: all channels of all parts, text attributes and `whiteLuminance`.
///
/// Parts of another size than the first are left out; the channels of a named part beyond the first are named
/// `part.channel`. NaN and infinity are kept.
///
/// # Errors
/// Damaged bytes, sizes beyond the limits, deep data, subsampled channels, HTJ2K.
pub fn decode(bytes: &[u8]) -> Result<Planes, ImageError> {
    let meta = MetaData::read_from_buffered(Cursor::new(bytes), false).map_err(|e| malformed(e.to_string()))?;
    check(&meta.headers, bytes.len())?;
    if meta.headers.iter().any(is_dwa) {
        check_dwa(bytes)?;
    }
    let image = ::exr::prelude::read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .all_layers()
        .all_attributes()
        .non_parallel()
        .from_buffered(Cursor::new(bytes))
        .map_err(|e| malformed(e.to_string()))?;
    let size = image.layer_data.first().ok_or_else(|| malformed("it has no part"))?.size;
    let mut planes = Planes::new(size.width() as u32, size.height() as u32)?;
    for (i, layer) in image.layer_data.into_iter().enumerate() {
        if layer.size == size {
            push_layer(&mut planes, i, layer)?;
        }
    }
    planes.attributes.sort();
    Ok(planes)
}

fn push_layer(planes: &mut Planes, index: usize, layer: Layer<AnyChannels<FlatSamples>>) -> Result<(), ImageError> {
    if index == 0 {
        planes.white_luminance = layer.attributes.white_luminance;
        planes.attributes = texts(&layer.attributes);
    }
    let part = layer.attributes.layer_name.filter(|_| index > 0).map(|name| text(&name)).unwrap_or_default();
    for channel in layer.channel_data.list {
        let name = text(&channel.name);
        let name = if part.is_empty() { name } else { format!("{part}.{name}") };
        let samples = match channel.sample_data {
            FlatSamples::F32(v) => Samples::Float(v),
            FlatSamples::F16(v) => Samples::Half(v.into_iter().map(|h| h.to_f32()).collect()),
            FlatSamples::U32(v) => Samples::Uint(v),
        };
        planes.push(&name, samples)?;
    }
    Ok(())
}

/// The text attributes of a part.
fn texts(attributes: &::exr::meta::header::LayerAttributes) -> Vec<(String, String)> {
    let known = [
        ("comments", &attributes.comments),
        ("owner", &attributes.owner),
        ("software", &attributes.software_name),
        ("capDate", &attributes.capture_date),
    ];
    let known = known.into_iter().filter_map(|(name, value)| Some((name.to_string(), self::text(value.as_ref()?))));
    let other = attributes.other.iter().filter_map(|(name, value)| match value {
        AttributeValue::Text(value) => Some((text(name), text(value))),
        _ => None,
    });
    known.chain(other).collect()
}

/// Text of a file: UTF-8, which the crate exr would show as Latin-1.
fn text(bytes: &::exr::meta::attribute::Text) -> String {
    String::from_utf8_lossy(bytes.as_slice()).into_owned()
}

fn check(headers: &[Header], bytes: usize) -> Result<(), ImageError> {
    if headers.is_empty() || headers.len() > MAX_PARTS {
        return Err(malformed(format!("it has {} parts, but 1 to {MAX_PARTS} are accepted", headers.len())));
    }
    let channels: usize = headers.iter().map(|h| h.channels.list.len()).sum();
    if channels == 0 || channels > MAX_CHANNELS {
        return Err(malformed(format!("it has {channels} channels, but 1 to {MAX_CHANNELS} are accepted")));
    }
    let mut declared = 0;
    for header in headers {
        declared += check_part(header)?;
    }
    let dwa = headers.iter().any(is_dwa);
    let size = headers[0].layer_size;
    let size = (size.width() as u64, size.height() as u64);
    check_declared("EXR", size, declared, bytes, if dwa { DWA_RATIO } else { RATIO })?;
    Ok(())
}

/// The bytes that a part declares, all levels together.
fn check_part(header: &Header) -> Result<u128, ImageError> {
    if header.deep {
        return Err(ImageError::unsupported("EXR", "deep data, but only flat images are accepted"));
    }
    if matches!(header.compression, Compression::HTJ2K32 | Compression::HTJ2K256) {
        return Err(ImageError::unsupported("EXR", format!("{} compression is not known", header.compression)));
    }
    if let Some(channel) = header.channels.list.iter().find(|c| c.sampling != ::exr::math::Vec2(1, 1)) {
        let what = format!("channel `{}` is subsampled, but only full channels are accepted", channel.name);
        return Err(ImageError::unsupported("EXR", what));
    }
    let (width, height) = (header.layer_size.width() as u64, header.layer_size.height() as u64);
    check_size("EXR", width, height)?;
    check_window(header)?;
    let per_pixel = header.channels.list.iter().map(|c| c.sample_type.bytes_per_sample() as u128).sum::<u128>();
    let (lines, copies) = match header.blocks {
        BlockDescription::ScanLines => (u128::from(width) * header.compression.scan_lines_per_block() as u128, 1),
        BlockDescription::Tiles(tiles) => {
            let size = (tiles.tile_size.width() as u64, tiles.tile_size.height() as u64);
            check_size("EXR tile", size.0, size.1)?;
            // all smaller copies together have a third of the pixels of a mip map, three times those of a rip map
            let copies = if tiles.level_mode == LevelMode::Singular { 1 } else { 4 };
            (u128::from(size.0) * u128::from(size.1), copies)
        }
    };
    if lines * per_pixel > MAX_BLOCK_BYTES {
        let what = format!("blocks of {} bytes, but at most {MAX_BLOCK_BYTES} are accepted", lines * per_pixel);
        return Err(malformed(what));
    }
    debug_assert!(copies >= 1);
    Ok(u128::from(width) * u128::from(height) * per_pixel)
}

fn is_dwa(header: &Header) -> bool {
    matches!(header.compression, Compression::DWAA(_) | Compression::DWAB(_))
}

/// The sizes that DWA blocks declare of their sections; the crate exr takes them at their word.
fn check_dwa(bytes: &[u8]) -> Result<(), ImageError> {
    let failed = |error: ::exr::error::Error| malformed(error.to_string());
    let reader = ::exr::block::read(Cursor::new(bytes), false).map_err(failed)?;
    let headers = reader.meta_data().headers.clone();
    for chunk in reader.filter_chunks(false, |_, _, _| true).map_err(failed)? {
        let chunk = chunk.map_err(failed)?;
        let Some(header) = headers.get(chunk.layer_index).filter(|h| is_dwa(h)) else { continue };
        let data = match &chunk.compressed_block {
            CompressedBlock::ScanLine(block) => &block.compressed_pixels_le,
            CompressedBlock::Tile(block) => &block.compressed_pixels_le,
            _ => continue,
        };
        let place = header.get_block_data_indices(&chunk.compressed_block).map_err(failed)?;
        let size = header.get_absolute_block_pixel_coordinates(place).map_err(failed)?.size;
        if data.len() == size.area() * header.channels.bytes_per_pixel {
            continue; // not compressed
        }
        // coefficients come in squares of 8 x 8; runs at their worst double the bytes
        let padded = size.width().next_multiple_of(8) * size.height().next_multiple_of(8);
        let limit = 2 * (padded * header.channels.bytes_per_pixel) as u64 + 1024;
        // a version, then nine sizes and counts of sections
        if data.as_chunks::<8>().0.iter().take(10).any(|n| u64::from_le_bytes(*n) > limit) {
            return Err(malformed("a DWA block declares sections that are larger than its pixels"));
        }
    }
    Ok(())
}

/// Places far off the origin overflow in readers.
fn check_window(header: &Header) -> Result<(), ImageError> {
    let limit = 1 << 24;
    let far = |v: i32| !(-limit..=limit).contains(&v);
    let data = header.own_attributes.layer_position;
    let display = header.shared_attributes.display_window;
    let sizes = [display.size.width(), display.size.height()];
    if far(data.x()) || far(data.y()) || far(display.position.x()) || far(display.position.y()) {
        return Err(malformed(format!("its window lies at ({}, {}), too far off", data.x(), data.y())));
    }
    if sizes.iter().any(|s| *s > limit as usize) {
        return Err(malformed(format!("its display window is {} x {} pixels", sizes[0], sizes[1])));
    }
    Ok(())
}

fn malformed(what: impl Into<String>) -> ImageError {
    ImageError::malformed("EXR", what)
}
