//! Radiance HDR: RGB with a common exponent, four bytes per pixel.
//!
//! Reading gives linear light with EXPOSURE and COLORCORR divided out, so that numbers are those of the scene, and turns all
//! eight orientations upright. XYZE files are converted to Rec.709.

use super::check_declared;
use crate::ImageError;
use crate::image::{Image, Transfer, rgb_of};

/// Longest header that is read.
const MAX_HEADER: usize = 1 << 16;
/// Scanlines of these lengths may be run-length encoded by channel.
const RUN_LENGTHS: std::ops::Range<usize> = 8..0x8000;

/// Reads a Radiance picture from memory.
///
/// # Errors
/// A header that is not Radiance's, scanlines that end early or run over, sizes beyond the limits.
pub fn decode(bytes: &[u8]) -> Result<Image, ImageError> {
    let (header, size_line, body) = split_header(bytes)?;
    let header = Header::read(header)?;
    let orientation = Orientation::read(size_line)?;
    let (width, height) = orientation.size();
    // every scanline takes four bytes at least
    let lines = orientation.lines as u128;
    check_declared("HDR", (width as u64, height as u64), lines * 4, body.len(), 1)?;
    let pixels = read_scanlines(body, orientation.lines, orientation.length)?;

    let mut data = crate::image::zeros("HDR", width * height * 3)?;
    for (i, rgbe) in pixels.iter().enumerate() {
        let (x, y) = orientation.place(i / orientation.length, i % orientation.length);
        let at = (y * width + x) * 3;
        data[at..at + 3].copy_from_slice(&header.light(*rgbe));
    }
    Image::new(width as u32, height as u32, 3, Transfer::Linear, data)
}

/// Header lines, the line of the size, and the scanlines.
fn split_header(bytes: &[u8]) -> Result<(&str, &str, &[u8]), ImageError> {
    let head = &bytes[..bytes.len().min(MAX_HEADER)];
    let end = head.windows(2).position(|pair| pair == b"\n\n").ok_or_else(|| malformed("the header has no end"))?;
    let size = &head[end + 2..];
    let size_end = size.iter().position(|b| *b == b'\n').ok_or_else(|| malformed("the size has no end"))?;
    let text = |part| std::str::from_utf8(part).map_err(|_| malformed("the header is not text"));
    Ok((text(&head[..end])?, text(&size[..size_end])?, &bytes[end + 2 + size_end + 1..]))
}

/// What the header says about the numbers.
struct Header {
    /// The factor from file to scene for each channel.
    scale: [f32; 3],
    xyz: bool,
}

impl Header {
    fn read(text: &str) -> Result<Header, ImageError> {
        let mut scale = [1.0f64; 3];
        let mut xyz = false;
        if !text.starts_with("#?") {
            return Err(malformed("it does not begin with `#?`"));
        }
        for line in text.lines().skip(1) {
            let Some((key, value)) = line.split_once('=') else { continue };
            match key.trim() {
                "FORMAT" => {
                    xyz = match value.trim() {
                        "32-bit_rle_rgbe" => false,
                        "32-bit_rle_xyze" => true,
                        other => return Err(malformed(format!("FORMAT is `{}`", shown(other)))),
                    }
                }
                "EXPOSURE" => divide(&mut scale, &[factors(value, 1)?[0]; 3]),
                "COLORCORR" => divide(&mut scale, &factors(value, 3)?),
                _ => {}
            }
        }
        if scale.iter().any(|s| !(1e-30..1e30).contains(s)) {
            return Err(malformed("EXPOSURE and COLORCORR together are out of range"));
        }
        Ok(Header { scale: scale.map(|s| s as f32), xyz })
    }

    /// Linear Rec.709 of the scene.
    fn light(&self, rgbe: [u8; 4]) -> [f32; 3] {
        let v = unpack(rgbe);
        let v = [0, 1, 2].map(|c| (v[c] * self.scale[c]).min(f32::MAX));
        if self.xyz { lesk_quantities::colorspace::rec709_from_xyz(v.map(f64::from)).map(|v| v as f32) } else { v }
    }
}

/// Several EXPOSURE lines multiply, and so do COLORCORR lines.
fn divide(scale: &mut [f64; 3], by: &[f64]) {
    for (s, b) in scale.iter_mut().zip(by) {
        *s /= b;
    }
}

fn factors(text: &str, count: usize) -> Result<Vec<f64>, ImageError> {
    let numbers: Vec<f64> = text.split_whitespace().map_while(|n| n.parse().ok()).collect();
    if numbers.len() != count || !numbers.iter().all(|n| *n > 0.0 && n.is_finite()) {
        return Err(malformed(format!("`{}` where {count} positive numbers are needed", shown(text))));
    }
    Ok(numbers)
}

/// How scanlines lie in the picture.
struct Orientation {
    lines: usize,
    length: usize,
    /// Scanlines are columns.
    columns: bool,
    /// The first scanline is the last row or column.
    flip_lines: bool,
    /// The first pixel of a scanline is the last one.
    flip_pixels: bool,
}

impl Orientation {
    /// `-Y 512 +X 768`: from the top down, from left to right.
    fn read(line: &str) -> Result<Orientation, ImageError> {
        let wrong = || malformed(format!("the size is `{}`, but like `-Y 512 +X 768` is needed", shown(line)));
        let words: Vec<&str> = line.split_whitespace().collect();
        let [first, lines, second, length] = words[..] else { return Err(wrong()) };
        let number = |text: &str| text.parse::<u32>().map(|n| n as usize).map_err(|_| wrong());
        let (lines, length) = (number(lines)?, number(length)?);
        let columns = match (first, second) {
            ("-Y" | "+Y", "-X" | "+X") => false,
            ("-X" | "+X", "-Y" | "+Y") => true,
            _ => return Err(wrong()),
        };
        // rows are written downwards with -Y, columns to the right with +X
        let flip = |axis: &str| axis == "+Y" || axis == "-X";
        Ok(Orientation { lines, length, columns, flip_lines: flip(first), flip_pixels: flip(second) })
    }

    fn size(&self) -> (usize, usize) {
        if self.columns { (self.lines, self.length) } else { (self.length, self.lines) }
    }

    fn place(&self, line: usize, pixel: usize) -> (usize, usize) {
        let line = if self.flip_lines { self.lines - 1 - line } else { line };
        let pixel = if self.flip_pixels { self.length - 1 - pixel } else { pixel };
        if self.columns { (line, pixel) } else { (pixel, line) }
    }
}

/// All pixels in the order of the file. Memory grows with what has been read.
fn read_scanlines(mut body: &[u8], lines: usize, length: usize) -> Result<Vec<[u8; 4]>, ImageError> {
    let mut pixels = Vec::new();
    for line in 0..lines {
        let start = pixels.len();
        body = if is_run_length_encoded(body, length) {
            read_runs(&body[4..], length, &mut pixels)
        } else {
            read_pixels(body, length, &mut pixels)
        }
        .map_err(|what| malformed(format!("scanline {line} of {lines} {what}")))?;
        debug_assert_eq!(pixels.len(), start + length);
    }
    Ok(pixels)
}

fn is_run_length_encoded(body: &[u8], length: usize) -> bool {
    RUN_LENGTHS.contains(&length)
        && matches!(*body, [2, 2, high, low, ..] if high < 128 && usize::from(high) << 8 | usize::from(low) == length)
}

/// One scanline of four channels in runs; returns what follows.
fn read_runs<'a>(mut body: &'a [u8], length: usize, pixels: &mut Vec<[u8; 4]>) -> Result<&'a [u8], &'static str> {
    let start = pixels.len();
    pixels.resize(start + length, [0; 4]);
    let line = &mut pixels[start..];
    for channel in 0..4 {
        let mut at = 0;
        while at < length {
            let (&code, rest) = body.split_first().ok_or("ends early")?;
            let (count, run) = if code > 128 { (usize::from(code) - 128, true) } else { (usize::from(code), false) };
            let bytes = if run { 1 } else { count };
            if count == 0 || at + count > length {
                return Err("has a run that is empty or too long");
            }
            let values = rest.get(..bytes).ok_or("ends early")?;
            for (i, pixel) in line[at..at + count].iter_mut().enumerate() {
                pixel[channel] = values[if run { 0 } else { i }];
            }
            body = &rest[bytes..];
            at += count;
        }
    }
    Ok(body)
}

/// One scanline of plain pixels, in which (1, 1, 1, n) repeats the last pixel; returns what follows.
fn read_pixels<'a>(mut body: &'a [u8], length: usize, pixels: &mut Vec<[u8; 4]>) -> Result<&'a [u8], &'static str> {
    let start = pixels.len();
    let end = start + length;
    let mut shift = 0;
    while pixels.len() < end {
        let (pixel, rest) = body.split_first_chunk::<4>().ok_or("ends early")?;
        body = rest;
        if let [1, 1, 1, count] = *pixel {
            // repeats in a row are the bytes of one number, the smallest first
            let count = usize::from(count).checked_shl(shift).filter(|n| *n <= end - pixels.len());
            let last = *pixels[start..].last().ok_or("begins with a repeat")?;
            let count = count.ok_or("has a run that is too long")?;
            pixels.resize(pixels.len() + count, last);
            shift = (shift + 8).min(32);
        } else {
            pixels.push(*pixel);
            shift = 0;
        }
    }
    Ok(body)
}

/// Mantissas over 256 times the power of the exponent less 128; (m + 0.5) as in Radiance's own reader is not added, so that
/// written numbers come back.
fn unpack([r, g, b, e]: [u8; 4]) -> [f32; 3] {
    if e == 0 {
        return [0.0; 3];
    }
    let scale = (f64::from(e) - 136.0).exp2();
    [r, g, b].map(|m| (f64::from(m) * scale) as f32)
}

/// The nearest RGBE; negative numbers and NaN are 0, too large ones the largest.
fn pack(rgb: [f32; 3]) -> [u8; 4] {
    let largest = 255.0 * 119f64.exp2();
    let rgb = rgb.map(|v| if v > 0.0 { f64::from(v).min(largest) } else { 0.0 });
    let max = rgb[0].max(rgb[1]).max(rgb[2]);
    if max < 1e-38 {
        return [0; 4];
    }
    // max = m 2^e with m in 0.5..1; one more where rounding would reach 256
    let mut e = max.log2().floor() as i32 + 1;
    if (max * f64::from(8 - e).exp2()).round() > 255.0 {
        e += 1;
    }
    let scale = f64::from(8 - e).exp2();
    let [r, g, b] = rgb.map(|v| (v * scale).round().min(255.0) as u8);
    [r, g, b, (e + 128).clamp(0, 255) as u8]
}

/// Writes a Radiance picture to memory: new run-length encoding, the same image gives the same bytes. Encoded images are
/// written as linear light; alpha is left out.
///
/// # Errors
/// None today.
pub fn encode(image: &Image) -> Result<Vec<u8>, ImageError> {
    let linear = image.to_linear();
    let (width, height) = (image.width() as usize, image.height() as usize);
    let mut bytes = format!("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n").into_bytes();
    for row in linear.data().chunks_exact(width * image.channels()) {
        let pixels: Vec<[u8; 4]> = row.chunks_exact(image.channels()).map(|p| pack(rgb_of(p))).collect();
        if RUN_LENGTHS.contains(&width) {
            bytes.extend([2, 2, (width >> 8) as u8, width as u8]);
            for channel in 0..4 {
                let values: Vec<u8> = pixels.iter().map(|p| p[channel]).collect();
                write_runs(&values, &mut bytes);
            }
        } else {
            // none of them reads as a repeat (1, 1, 1, n): the largest mantissa is 128 or more
            bytes.extend(pixels.as_flattened());
        }
    }
    Ok(bytes)
}

/// Runs of at least four equal bytes as runs, the rest as they are.
fn write_runs(values: &[u8], bytes: &mut Vec<u8>) {
    let run_at = |at: usize| values[at..].iter().take(127).take_while(|v| **v == values[at]).count();
    let mut at = 0;
    while at < values.len() {
        let run = run_at(at);
        if run >= 4 {
            bytes.extend([128 + run as u8, values[at]]);
            at += run;
            continue;
        }
        let start = at;
        while at < values.len() && at - start < 128 && run_at(at) < 4 {
            at += 1;
        }
        bytes.push((at - start) as u8);
        bytes.extend(&values[start..at]);
    }
}

fn malformed(what: impl Into<String>) -> ImageError {
    ImageError::malformed("HDR", what)
}

fn shown(text: &str) -> String {
    text.chars().take(40).map(|c| if c.is_control() { ' ' } else { c }).collect()
}

#[cfg(test)]
#[path = "hdr_tests.rs"]
mod tests;
