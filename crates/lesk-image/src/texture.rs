//! Image textures: bilinear lookups in f32, linear colour or plain data.

use crate::ImageError;
use crate::image::{Image, Transfer, rgb_of};
use crate::tonemap::srgb_decode;
use std::str::FromStr;

/// What the numbers of a texture are for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// A colour: sRGB-encoded files are decoded to linear light.
    Color,
    /// Data like roughness or a normal: the numbers of the file, never decoded.
    Data,
}

/// What lies outside 0..1.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Wrap {
    /// The image again.
    #[default]
    Repeat,
    /// The image mirrored, then again.
    Mirror,
    /// The texels of the border.
    Clamp,
}

/// How a place between texel centres is read.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Interpolation {
    /// From the four nearest texels, in linear light.
    #[default]
    Bilinear,
    /// From the nearest texel.
    Nearest,
}

/// Which number of a texel a scalar parameter reads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Channel {
    /// The first channel, also of grey images.
    Red,
    /// The second colour; grey for grey images.
    Green,
    /// The third colour; grey for grey images.
    Blue,
    /// Alpha; 1 for images without.
    Alpha,
    /// Rec.709 luminance of the colour.
    Luminance,
}

impl FromStr for Channel {
    type Err = ImageError;
    fn from_str(name: &str) -> Result<Channel, ImageError> {
        Ok(match name {
            "r" | "red" => Self::Red,
            "g" | "green" => Self::Green,
            "b" | "blue" => Self::Blue,
            "a" | "alpha" => Self::Alpha,
            "luminance" => Self::Luminance,
            _ => {
                let what = format!("channel `{name}`, but one of r, g, b, a, luminance is accepted");
                return Err(ImageError::invalid(what));
            }
        })
    }
}

/// An image ready for lookups. u runs to the right, v **upwards**: (0, 0) is the lower left corner, as in OBJ files; readers
/// of formats whose v runs downwards (glTF) pass 1 - v.
#[derive(Clone, Debug)]
pub struct Texture {
    width: i32,
    height: i32,
    channels: usize,
    data: Vec<f32>,
    wrap: [Wrap; 2],
    interpolation: Interpolation,
    repaired: u64,
}

impl Texture {
    /// A texture of an image. Colours that are sRGB-encoded are decoded; numbers that are not finite become 0 and are
    /// counted, see [`repaired`](Self::repaired).
    pub fn new(image: Image, role: Role, wrap: [Wrap; 2], interpolation: Interpolation) -> Texture {
        let (width, height, channels) = (image.width() as i32, image.height() as i32, image.channels());
        let decode = role == Role::Color && image.transfer() == Transfer::Srgb;
        let colors = if channels < 3 { 1 } else { 3 };
        let mut data = image.into_data();
        let mut repaired = 0;
        for texel in data.chunks_exact_mut(channels) {
            for (c, value) in texel.iter_mut().enumerate() {
                if !value.is_finite() {
                    *value = 0.0;
                    repaired += 1;
                } else if decode && c < colors {
                    *value = srgb_decode(*value);
                }
            }
        }
        Texture { width, height, channels, data, wrap, interpolation, repaired }
    }

    /// Width and height in texels.
    pub fn size(&self) -> (u32, u32) {
        (self.width as u32, self.height as u32)
    }

    /// Channels per texel, 1 to 4.
    pub fn channels(&self) -> usize {
        self.channels
    }

    /// Numbers that were not finite and are now 0.
    pub fn repaired(&self) -> u64 {
        self.repaired
    }

    /// Moves all numbers but alpha into `min..=max` and returns how many were outside: a parameter with a legal range
    /// clamps its texture once.
    ///
    /// # Panics
    /// If min > max or one is NaN.
    pub fn clamp(&mut self, min: f32, max: f32) -> u64 {
        let colors = if self.channels < 3 { 1 } else { 3 };
        let mut outside = 0;
        for texel in self.data.chunks_exact_mut(self.channels) {
            for value in &mut texel[..colors] {
                let clamped = value.clamp(min, max);
                outside += u64::from(clamped != *value);
                *value = clamped;
            }
        }
        outside
    }

    /// Red, green and blue at (u, v); grey stands for all three. A place that is not finite is read as (0, 0).
    #[inline]
    pub fn rgb(&self, uv: [f32; 2]) -> [f32; 3] {
        rgb_of(&self.texel(uv)[..self.channels])
    }

    /// One number at (u, v). A place that is not finite is read as (0, 0).
    #[inline]
    pub fn scalar(&self, uv: [f32; 2], channel: Channel) -> f32 {
        let texel = self.texel(uv);
        let [r, g, b] = rgb_of(&texel[..self.channels]);
        match channel {
            Channel::Red => r,
            Channel::Green => g,
            Channel::Blue => b,
            Channel::Alpha if self.channels.is_multiple_of(2) => texel[self.channels - 1],
            Channel::Alpha => 1.0,
            Channel::Luminance => lesk_math::Channels([r, g, b]).luminance(),
        }
    }

    /// The mean of all texels, for tables of power.
    pub fn mean_rgb(&self) -> [f32; 3] {
        let mut sum = [0.0f64; 3];
        for texel in self.data.chunks_exact(self.channels) {
            let rgb = rgb_of(texel);
            for c in 0..3 {
                sum[c] += f64::from(rgb[c]);
            }
        }
        sum.map(|v| (v * self.channels as f64 / self.data.len() as f64) as f32)
    }

    /// The interpolated texel; channels that the image does not have are 0.
    #[inline]
    fn texel(&self, uv: [f32; 2]) -> [f32; 4] {
        match self.channels {
            1 => self.interpolated::<1>(uv),
            2 => self.interpolated::<2>(uv),
            3 => self.interpolated::<3>(uv),
            _ => self.interpolated::<4>(uv),
        }
    }

    #[inline]
    fn interpolated<const N: usize>(&self, [u, v]: [f32; 2]) -> [f32; 4] {
        // beyond 1e9 texels an f32 has no place within a texel left; NaN and infinity end here too
        let place = |t: f32, size: i32| Some(t * size as f32).filter(|p| p.abs() < 1e9).unwrap_or(0.0);
        // rows run downwards, v upwards
        let (x, y) = (place(u, self.width), place(1.0 - v, self.height));
        let mut out = [0.0; 4];
        if self.interpolation == Interpolation::Nearest {
            let at = self.row(floor(y)) + self.column(floor(x));
            out[..N].copy_from_slice(&self.data[at * N..][..N]);
            return out;
        }
        let (x, y) = (x - 0.5, y - 0.5);
        let (left, top) = (floor(x), floor(y));
        let (tx, ty) = (x - left as f32, y - top as f32);
        let (x, y) = (left, top);
        let columns = [self.column(x), self.column(x + 1)];
        let rows = [self.row(y), self.row(y + 1)];
        let texel = |row: usize, column: usize| &self.data[(row + column) * N..][..N];
        let [[a, b], [c, d]] = rows.map(|row| columns.map(|column| texel(row, column)));
        for i in 0..N {
            let (top, bottom) = (a[i] * (1.0 - tx) + b[i] * tx, c[i] * (1.0 - tx) + d[i] * tx);
            out[i] = top * (1.0 - ty) + bottom * ty;
        }
        out
    }

    #[inline]
    fn column(&self, x: i32) -> usize {
        wrapped(self.wrap[0], x, self.width) as usize
    }

    /// The first texel of a row.
    #[inline]
    fn row(&self, y: i32) -> usize {
        wrapped(self.wrap[1], y, self.height) as usize * self.width as usize
    }
}

/// The largest integer that is not above `x`, |x| < 2^31. Without SSE4.1, `f32::floor` is a call of the C library.
#[inline]
fn floor(x: f32) -> i32 {
    let toward_zero = x as i32;
    toward_zero - i32::from(toward_zero as f32 > x)
}

/// The texel that stands for place `i` of a row of `size`.
#[inline]
fn wrapped(wrap: Wrap, i: i32, size: i32) -> i32 {
    if (0..size).contains(&i) {
        return i;
    }
    match wrap {
        Wrap::Repeat => i.rem_euclid(size),
        Wrap::Clamp => i.clamp(0, size - 1),
        Wrap::Mirror => {
            let i = i.rem_euclid(2 * size);
            if i < size { i } else { 2 * size - 1 - i }
        }
    }
}

#[cfg(test)]
#[path = "texture_tests.rs"]
mod tests;
