//! Image files: EXR, PNG, Radiance HDR, and reading JPEG.
//!
//! Readers take whatever bytes there are: every size is checked against [`MAX_SIDE`](crate::MAX_SIDE),
//! [`MAX_PIXELS`](crate::MAX_PIXELS) and against what the file's length can hold before memory is taken. NaN and infinity in
//! EXR files are kept as they are; [`Texture`](crate::Texture) and
//! [`Image::count_non_finite`](crate::Image::count_non_finite) deal with them.

mod atomic;
pub mod exr;
pub mod hdr;
mod jpeg;
pub mod png;

pub use atomic::{atomic_write, write_bytes};

use crate::image::{Image, check_size};
use crate::{ImageError, Planes};
use std::fs::File;
use std::io::Read;
use std::path::Path;

/// Longest file that is read: 4 GiB.
pub const MAX_FILE_BYTES: u64 = 1 << 32;

/// The image formats.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// OpenEXR: layers of half, float and integer channels.
    Exr,
    /// PNG of 8 or 16 bit.
    Png,
    /// Radiance RGBE.
    Hdr,
    /// JPEG, read only.
    Jpeg,
}

impl Format {
    /// The format of some bytes, from how they begin.
    pub fn of_bytes(bytes: &[u8]) -> Option<Format> {
        match bytes {
            [0x76, 0x2f, 0x31, 0x01, ..] => Some(Self::Exr),
            [0x89, b'P', b'N', b'G', ..] => Some(Self::Png),
            [b'#', b'?', ..] => Some(Self::Hdr),
            [0xff, 0xd8, 0xff, ..] => Some(Self::Jpeg),
            _ => None,
        }
    }

    /// The format of a file name, from its ending in any case.
    pub fn of_name(path: &Path) -> Option<Format> {
        match path.extension()?.to_str()?.to_ascii_lowercase().as_str() {
            "exr" => Some(Self::Exr),
            "png" => Some(Self::Png),
            "hdr" | "pic" | "rgbe" => Some(Self::Hdr),
            "jpg" | "jpeg" => Some(Self::Jpeg),
            _ => None,
        }
    }
}

/// Reads the picture of an image file of any known format; the bytes decide, not the name.
///
/// # Errors
/// Files that cannot be read, are none of the formats, are damaged or too large; the error names the file.
pub fn read(path: impl AsRef<Path>) -> Result<Image, ImageError> {
    let path = path.as_ref();
    decode(&read_bytes(path)?).map_err(|error| error.at(path))
}

/// Reads the picture of an image of any known format from memory.
///
/// # Errors
/// Bytes that are none of the formats, damaged or too large.
pub fn decode(bytes: &[u8]) -> Result<Image, ImageError> {
    match known(bytes)? {
        Format::Exr => exr::decode(bytes)?.picture(),
        Format::Png => png::decode(bytes),
        Format::Hdr => hdr::decode(bytes),
        Format::Jpeg => jpeg::decode(bytes),
    }
}

/// Reads all channels and attributes of an EXR file, or the channels of any other image.
///
/// # Errors
/// As [`read`].
pub fn read_planes(path: impl AsRef<Path>) -> Result<Planes, ImageError> {
    let path = path.as_ref();
    let bytes = read_bytes(path)?;
    let planes = match known(&bytes) {
        Ok(Format::Exr) => exr::decode(&bytes),
        Ok(_) => decode(&bytes).and_then(|image| {
            let mut planes = Planes::new(image.width(), image.height())?;
            planes.push_image("", &image)?;
            Ok(planes)
        }),
        Err(error) => Err(error),
    };
    planes.map_err(|error| error.at(path))
}

/// Writes an image; the ending of the name decides: `.exr` (linear, 32 bit), `.png` (8 bit, see [`png::encode`] for 16) or
/// `.hdr`. A previous file is replaced only when the new one is complete.
///
/// # Errors
/// Another ending, or a failed write.
pub fn write(path: impl AsRef<Path>, image: &Image) -> Result<(), ImageError> {
    let path = path.as_ref();
    let bytes = match Format::of_name(path) {
        Some(Format::Exr) => {
            let mut planes = Planes::new(image.width(), image.height())?;
            planes.push_image("", &image.to_linear())?;
            exr::encode(&planes)
        }
        Some(Format::Png) => png::encode(image, png::Depth::Eight, &[]),
        Some(Format::Hdr) => hdr::encode(image),
        Some(Format::Jpeg) | None => {
            Err(ImageError::invalid("the name's ending is not one that Lesk writes: .exr, .png, .hdr"))
        }
    };
    write_bytes(path, &bytes.map_err(|error| error.at(path))?)
}

/// The whole file, if its first bytes are those of a known format.
fn read_bytes(path: &Path) -> Result<Vec<u8>, ImageError> {
    let failed = |source| ImageError::Read { path: path.to_path_buf(), source };
    let mut file = File::open(path).map_err(failed)?;
    let mut bytes = Vec::new();
    // look first: a device would never end
    (&mut file).take(8).read_to_end(&mut bytes).map_err(failed)?;
    known(&bytes).map_err(|error| error.at(path))?;
    file.take(MAX_FILE_BYTES).read_to_end(&mut bytes).map_err(failed)?;
    if bytes.len() as u64 > MAX_FILE_BYTES {
        let what = format!("more than {MAX_FILE_BYTES} bytes, which is the limit");
        return Err(ImageError::unsupported("image", what).at(path));
    }
    Ok(bytes)
}

fn known(bytes: &[u8]) -> Result<Format, ImageError> {
    Format::of_bytes(bytes).ok_or_else(|| {
        let head: Vec<String> = bytes.iter().take(4).map(|b| format!("{b:02x}")).collect();
        let what =
            if head.is_empty() { "it is empty".to_string() } else { format!("it begins with {}", head.join(" ")) };
        ImageError::malformed("image", format!("{what}, but EXR, PNG, HDR and JPEG are known"))
    })
}

/// Checks a declared size against the limits and against the most that `bytes` bytes can hold, before memory is taken.
fn check_declared(
    format: &'static str,
    size: (u64, u64),
    declared: u128,
    bytes: usize,
    ratio: u128,
) -> Result<usize, ImageError> {
    let pixels = check_size(format, size.0, size.1)?;
    if declared > bytes as u128 * ratio {
        let (width, height) = size;
        let what = format!(
            "{width} x {height} pixels do not fit into {bytes} bytes; the file is cut short or its size is wrong"
        );
        return Err(ImageError::malformed(format, what));
    }
    Ok(pixels)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formats_are_known_by_bytes_and_by_name() {
        assert_eq!(Format::of_bytes(b"#?RGBE\n"), Some(Format::Hdr));
        assert_eq!(Format::of_bytes(b"GIF89a"), None);
        assert_eq!(Format::of_name(Path::new("a/b.EXR")), Some(Format::Exr));
        assert_eq!(Format::of_name(Path::new("exr")), None);
    }

    #[test]
    fn a_file_of_no_known_format_is_named_with_its_first_bytes() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        std::fs::write(&path, b"GIF89a").unwrap();
        let text = read(&path).unwrap_err().to_string();
        let expected = "not a valid image file: it begins with 47 49 46 38, but EXR, PNG, HDR and JPEG are known, in `";
        assert!(text.starts_with(expected), "{text}");
        std::fs::write(&path, b"").unwrap();
        assert!(read(&path).unwrap_err().to_string().contains("it is empty"));
    }

    #[test]
    fn a_missing_file_and_a_folder_are_errors_with_the_path() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("missing.exr");
        assert!(read(&path).unwrap_err().to_string().starts_with("cannot read `"));
        assert!(read(folder.path()).is_err());
    }

    #[cfg(unix)]
    #[test]
    fn a_device_without_end_is_refused_at_once() {
        assert!(read("/dev/zero").unwrap_err().to_string().contains("begins with 00 00 00 00"));
    }

    #[test]
    fn planes_of_a_png_are_its_channels() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        let image = Image::from_fn(3, 2, crate::Transfer::Srgb, |x, _| [x as f32 / 2.0, 1.0]).unwrap();
        write(&path, &image).unwrap();
        let planes = read_planes(&path).unwrap();
        assert_eq!((planes.width(), planes.plane("A").unwrap().samples.get(0)), (3, 1.0));
    }
}
