//! The bytes of an EXR file: OpenEXR File Layout, openexr.com.

use crate::{ImageError, Plane, Planes, Samples};
use ::exr::prelude::f16;
use rayon::prelude::*;

const MAGIC: [u8; 4] = [0x76, 0x2f, 0x31, 0x01];
/// Version 2 of the file format.
const VERSION: u32 = 2;
/// Flag of the version: names are longer than 31 bytes.
const LONG_NAMES: u32 = 1 << 10;
/// Scan lines in one ZIP block.
const BLOCK_LINES: usize = 16;
const ZIP: u8 = 3;
/// A third of the time of level 4 for files 4 % larger: rendered noise hardly compresses, ids and depth do at any level.
const DEFLATE_LEVEL: u8 = 1;
/// Primaries and white of Rec.709, x and y each.
const CHROMATICITIES: [f32; 8] = [0.64, 0.33, 0.30, 0.60, 0.15, 0.06, 0.3127, 0.3290];
/// Attributes that the writer sets itself.
const RESERVED: [&str; 10] = [
    "channels",
    "chromaticities",
    "compression",
    "dataWindow",
    "displayWindow",
    "lineOrder",
    "pixelAspectRatio",
    "screenWindowCenter",
    "screenWindowWidth",
    "whiteLuminance",
];

/// Writes planes as an EXR file to memory: equal planes give equal bytes.
///
/// Half channels clamp finite numbers to ±65504. Chromaticities are those of Rec.709.
///
/// # Errors
/// No channel, or attributes whose names are empty, taken, longer than 255 bytes or those of the format.
pub fn encode(planes: &Planes) -> Result<Vec<u8>, ImageError> {
    check(planes)?;
    let mut channels: Vec<&Plane> = planes.planes().iter().collect();
    channels.sort_by(|a, b| a.name.as_bytes().cmp(b.name.as_bytes()));

    let mut bytes = header(planes, &channels);
    let (width, height) = (planes.width() as usize, planes.height() as usize);
    let blocks: Vec<Vec<u8>> = (0..height.div_ceil(BLOCK_LINES))
        .into_par_iter()
        .map(|i| block(&channels, width, i * BLOCK_LINES..height.min((i + 1) * BLOCK_LINES)))
        .collect();

    let mut offset = (bytes.len() + 8 * blocks.len()) as u64;
    for block in &blocks {
        bytes.extend(offset.to_le_bytes());
        offset += block.len() as u64;
    }
    bytes.reserve_exact(blocks.iter().map(Vec::len).sum());
    blocks.iter().for_each(|block| bytes.extend(block));
    Ok(bytes)
}

fn check(planes: &Planes) -> Result<(), ImageError> {
    if planes.planes().is_empty() {
        return Err(ImageError::invalid("an EXR file without channels"));
    }
    for (i, (name, text)) in planes.attributes.iter().enumerate() {
        let taken = planes.attributes[..i].iter().any(|(n, _)| n == name) || RESERVED.contains(&name.as_str());
        if name.is_empty() || name.len() > 255 || name.contains('\0') || taken {
            return Err(ImageError::invalid(format!("EXR attribute name `{name}` is empty, too long or taken")));
        }
        if i32::try_from(text.len()).is_err() {
            return Err(ImageError::invalid(format!("the text of EXR attribute `{name}` is longer than 2 GiB")));
        }
    }
    Ok(())
}

fn header(planes: &Planes, channels: &[&Plane]) -> Vec<u8> {
    let names = channels.iter().map(|c| &c.name).chain(planes.attributes.iter().map(|(name, _)| name));
    let long = names.into_iter().any(|name| name.len() > 31);
    let mut bytes = MAGIC.to_vec();
    bytes.extend((VERSION | if long { LONG_NAMES } else { 0 }).to_le_bytes());

    let (right, bottom) = (planes.width() as i32 - 1, planes.height() as i32 - 1);
    let window: Vec<u8> = [0, 0, right, bottom].iter().flat_map(|v: &i32| v.to_le_bytes()).collect();
    let floats = |values: &[f32]| values.iter().flat_map(|v| v.to_le_bytes()).collect::<Vec<u8>>();
    let mut attributes: Vec<(&str, &str, Vec<u8>)> = vec![
        ("channels", "chlist", channel_list(channels)),
        ("chromaticities", "chromaticities", floats(&CHROMATICITIES)),
        ("compression", "compression", vec![ZIP]),
        ("dataWindow", "box2i", window.clone()),
        ("displayWindow", "box2i", window),
        ("lineOrder", "lineOrder", vec![0]),
        ("pixelAspectRatio", "float", floats(&[1.0])),
        ("screenWindowCenter", "v2f", floats(&[0.0, 0.0])),
        ("screenWindowWidth", "float", floats(&[1.0])),
    ];
    attributes.extend(planes.white_luminance.map(|l| ("whiteLuminance", "float", floats(&[l]))));
    attributes.extend(planes.attributes.iter().map(|(name, text)| (name.as_str(), "string", text.as_bytes().to_vec())));
    attributes.sort_by(|a, b| a.0.as_bytes().cmp(b.0.as_bytes()));
    for (name, kind, value) in attributes {
        for part in [name, kind] {
            bytes.extend(part.as_bytes());
            bytes.push(0);
        }
        bytes.extend((value.len() as i32).to_le_bytes());
        bytes.extend(value);
    }
    bytes.push(0);
    bytes
}

fn channel_list(channels: &[&Plane]) -> Vec<u8> {
    let mut bytes = Vec::new();
    for channel in channels {
        let kind: i32 = match channel.samples {
            Samples::Uint(_) => 0,
            Samples::Half(_) => 1,
            Samples::Float(_) => 2,
        };
        bytes.extend(channel.name.as_bytes());
        bytes.push(0);
        // type, not perceptually linear with three bytes of padding, no subsampling in x and y
        [kind, 0, 1, 1].iter().for_each(|v| bytes.extend(v.to_le_bytes()));
    }
    bytes.push(0);
    bytes
}

/// One block: first line, size, and its lines, each channel after channel.
fn block(channels: &[&Plane], width: usize, lines: std::ops::Range<usize>) -> Vec<u8> {
    let mut raw = Vec::new();
    for y in lines.clone() {
        let row = y * width..(y + 1) * width;
        for channel in channels {
            match &channel.samples {
                Samples::Float(v) => v[row.clone()].iter().for_each(|v| raw.extend(v.to_le_bytes())),
                Samples::Uint(v) => v[row.clone()].iter().for_each(|v| raw.extend(v.to_le_bytes())),
                Samples::Half(v) => v[row.clone()].iter().for_each(|v| raw.extend(half(*v).to_le_bytes())),
            }
        }
    }
    let packed = miniz_oxide::deflate::compress_to_vec_zlib(&predicted(&raw), DEFLATE_LEVEL);
    // a reader knows uncompressed blocks by their size
    let data = if packed.len() < raw.len() { packed } else { raw };
    let mut bytes = Vec::with_capacity(data.len() + 8);
    bytes.extend((lines.start as i32).to_le_bytes());
    bytes.extend((data.len() as i32).to_le_bytes());
    bytes.extend(data);
    bytes
}

/// Even bytes, then odd bytes, each less the byte before, plus 128: the predictor of ZIP blocks.
fn predicted(raw: &[u8]) -> Vec<u8> {
    let (even, odd) = (raw.iter().step_by(2), raw.iter().skip(1).step_by(2));
    let mut bytes: Vec<u8> = even.chain(odd).copied().collect();
    for i in (1..bytes.len()).rev() {
        bytes[i] = bytes[i].wrapping_sub(bytes[i - 1]).wrapping_add(128);
    }
    bytes
}

fn half(value: f32) -> f16 {
    if value.is_finite() { f16::from_f32(value.clamp(-65_504.0, 65_504.0)) } else { f16::from_f32(value) }
}
