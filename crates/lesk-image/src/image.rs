//! A picture in memory: rows of pixels, one to four f32 channels.

use crate::tonemap::srgb_decode;
use crate::{ImageError, MAX_PIXELS, MAX_SIDE};

/// What the numbers of an [`Image`] mean.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Transfer {
    /// Proportional to light.
    Linear,
    /// Encoded with the curve of sRGB, 0 to 1: what a screen shows and PNG and JPEG files hold.
    Srgb,
}

/// Rows of pixels from the top, channels interleaved.
///
/// One channel is grey, two are grey and alpha, three RGB, four RGB and alpha. Alpha is never encoded.
#[derive(Clone, Debug, PartialEq)]
pub struct Image {
    width: u32,
    height: u32,
    channels: usize,
    transfer: Transfer,
    data: Vec<f32>,
}

impl Image {
    /// An image of `width * height * channels` numbers, rows from the top.
    ///
    /// # Errors
    /// A size of zero or beyond [`MAX_SIDE`] and [`MAX_PIXELS`], channels outside 1 to 4, or another count of numbers.
    pub fn new(
        width: u32,
        height: u32,
        channels: usize,
        transfer: Transfer,
        data: Vec<f32>,
    ) -> Result<Image, ImageError> {
        let pixels = check_size("image", width.into(), height.into())?;
        if !(1..=4).contains(&channels) {
            return Err(ImageError::invalid(format!("{channels} channels, but 1 to 4 are accepted")));
        }
        if data.len() != pixels * channels {
            let needed = pixels * channels;
            let what = format!("{} numbers for {width} x {height} x {channels}, which needs {needed}", data.len());
            return Err(ImageError::invalid(what));
        }
        Ok(Image { width, height, channels, transfer, data })
    }

    /// An image whose pixels are `pixel(x, y)`.
    ///
    /// # Errors
    /// A size of zero or beyond [`MAX_SIDE`] and [`MAX_PIXELS`], or more than 4 channels.
    pub fn from_fn<const N: usize>(
        width: u32,
        height: u32,
        transfer: Transfer,
        mut pixel: impl FnMut(u32, u32) -> [f32; N],
    ) -> Result<Image, ImageError> {
        let mut data = zeros("image", check_size("image", width.into(), height.into())? * N)?;
        for (i, out) in data.chunks_exact_mut(N).enumerate() {
            out.copy_from_slice(&pixel(i as u32 % width, i as u32 / width));
        }
        Image::new(width, height, N, transfer, data)
    }

    /// Width in pixels.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Height in pixels.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// Numbers per pixel, 1 to 4.
    pub fn channels(&self) -> usize {
        self.channels
    }

    /// What the numbers mean.
    pub fn transfer(&self) -> Transfer {
        self.transfer
    }

    /// All numbers, rows from the top, channels interleaved.
    pub fn data(&self) -> &[f32] {
        &self.data
    }

    /// All numbers, to change.
    pub fn data_mut(&mut self) -> &mut [f32] {
        &mut self.data
    }

    /// All numbers, without a copy.
    pub fn into_data(self) -> Vec<f32> {
        self.data
    }

    /// The channels of one pixel.
    ///
    /// # Panics
    /// Outside the image.
    pub fn pixel(&self, x: u32, y: u32) -> &[f32] {
        assert!(x < self.width && y < self.height, "pixel ({x}, {y}) is outside {} x {}", self.width, self.height);
        let at = (y as usize * self.width as usize + x as usize) * self.channels;
        &self.data[at..at + self.channels]
    }

    /// Red, green and blue of one pixel; grey stands for all three.
    ///
    /// # Panics
    /// Outside the image.
    pub fn rgb(&self, x: u32, y: u32) -> [f32; 3] {
        rgb_of(self.pixel(x, y))
    }

    /// Red, green and blue of all pixels, rows from the top.
    pub fn rgb_pixels(&self) -> impl Iterator<Item = [f32; 3]> + '_ {
        self.data.chunks_exact(self.channels).map(rgb_of)
    }

    /// The same picture in linear light: colours that are sRGB-encoded are decoded, alpha stays.
    pub fn to_linear(&self) -> Image {
        let mut image = self.clone();
        if self.transfer == Transfer::Srgb {
            image.transfer = Transfer::Linear;
            let colors = if self.channels < 3 { 1 } else { 3 };
            for pixel in image.data.chunks_exact_mut(self.channels) {
                pixel[..colors].iter_mut().for_each(|v| *v = srgb_decode(*v));
            }
        }
        image
    }

    /// Numbers that are NaN or infinite.
    pub fn count_non_finite(&self) -> usize {
        self.data.iter().filter(|v| !v.is_finite()).count()
    }
}

/// Red, green and blue of a pixel of 1 to 4 channels.
pub(crate) fn rgb_of(pixel: &[f32]) -> [f32; 3] {
    match *pixel {
        [r, g, b] | [r, g, b, _] => [r, g, b],
        _ => [pixel[0]; 3],
    }
}

/// The number of pixels, if the size is not zero and within the limits.
pub(crate) fn check_size(what: &'static str, width: u64, height: u64) -> Result<usize, ImageError> {
    let side = u64::from(MAX_SIDE);
    if width == 0 || height == 0 {
        return Err(ImageError::TooLarge { what, width, height, limit: "at least 1 x 1".to_string() });
    }
    if width > side || height > side {
        return Err(ImageError::TooLarge { what, width, height, limit: format!("at most {side} on a side") });
    }
    if width * height > MAX_PIXELS {
        return Err(ImageError::TooLarge { what, width, height, limit: format!("at most {MAX_PIXELS} in all") });
    }
    Ok((width * height) as usize)
}

/// `count` zeros, or an error where the memory is not there.
pub(crate) fn zeros<T: Clone + Default>(what: &'static str, count: usize) -> Result<Vec<T>, ImageError> {
    let mut data = Vec::new();
    data.try_reserve_exact(count).map_err(|_| {
        let bytes = count * size_of::<T>();
        ImageError::invalid(format!("{what} needs {bytes} bytes of memory, which the system does not give"))
    })?;
    data.resize(count, T::default());
    Ok(data)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_outside_the_limits_are_refused() {
        for (w, h) in [(0, 5), (5, 0), (65_537, 1), (1, 65_537), (65_536, 65_536), (u64::from(u32::MAX), 1)] {
            assert!(matches!(check_size("image", w, h), Err(ImageError::TooLarge { .. })), "{w} x {h}");
        }
        assert_eq!(check_size("image", 16_384, 8192).unwrap(), 1 << 27);
    }

    #[test]
    fn grey_stands_for_all_three_colours() {
        let grey = Image::new(1, 1, 2, Transfer::Linear, vec![0.5, 0.1]).unwrap();
        assert_eq!(grey.rgb(0, 0), [0.5; 3]);
    }

    #[test]
    fn a_wrong_count_of_numbers_is_refused() {
        assert!(Image::new(2, 2, 3, Transfer::Linear, vec![0.0; 11]).is_err());
        assert!(Image::new(2, 2, 5, Transfer::Linear, vec![0.0; 20]).is_err());
    }

    #[test]
    fn from_fn_fills_rows_from_the_top() {
        let image = Image::from_fn(3, 2, Transfer::Linear, |x, y| [x as f32, y as f32, 0.0]).unwrap();
        assert_eq!(image.pixel(2, 1), [2.0, 1.0, 0.0]);
        assert_eq!(image.data()[6..9], [2.0, 0.0, 0.0]);
    }
}
