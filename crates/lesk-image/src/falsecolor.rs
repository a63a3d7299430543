//! One number as a colour: a map in perceptual order, so that more always looks like more.

use crate::image::{Image, Transfer};
use crate::{ImageError, tonemap};
use std::sync::LazyLock;

/// `data/colormaps/PROVENANCE.md` says where the colours come from.
const TABLE: &str = include_str!("../../../data/colormaps/viridis.csv");

static VIRIDIS: LazyLock<Vec<[f32; 3]>> = LazyLock::new(|| {
    let row = |line: &str| {
        let mut numbers = line.split(',').map(|n| n.parse().expect("data/colormaps holds numbers"));
        [(); 3].map(|()| numbers.next().expect("data/colormaps has three columns"))
    };
    TABLE.lines().skip(1).map(row).collect()
});

/// The map viridis, sRGB-encoded: dark violet at 0, yellow at 1; numbers outside are clamped, NaN is grey.
pub fn viridis(t: f32) -> [f32; 3] {
    if t.is_nan() {
        return [0.5; 3];
    }
    let at = t.clamp(0.0, 1.0) * (VIRIDIS.len() - 1) as f32;
    let i = (at as usize).min(VIRIDIS.len() - 2);
    let f = at - i as f32;
    [0, 1, 2].map(|c| VIRIDIS[i][c] * (1.0 - f) + VIRIDIS[i + 1][c] * f)
}

/// Which numbers become the two ends of the map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scale {
    min: f64,
    max: f64,
    log: bool,
}

impl Scale {
    /// Steps of equal difference from `min` to `max`.
    ///
    /// # Errors
    /// Unless min < max and both are finite.
    pub fn linear(min: f64, max: f64) -> Result<Scale, ImageError> {
        Self::checked(min, max, false)
    }

    /// Steps of equal ratio from `min` to `max`.
    ///
    /// # Errors
    /// Unless 0 < min < max and both are finite.
    pub fn log(min: f64, max: f64) -> Result<Scale, ImageError> {
        Self::checked(min, max, true)
    }

    fn checked(min: f64, max: f64, log: bool) -> Result<Scale, ImageError> {
        if min < max && min.is_finite() && max.is_finite() && (!log || min > 0.0) {
            return Ok(Scale { min, max, log });
        }
        let range = if log { "0 < min < max" } else { "min < max" };
        Err(ImageError::invalid(format!("a false-colour scale from {min} to {max}, but {range} is needed")))
    }

    /// Where a number lies: 0 at min, 1 at max; NaN stays NaN.
    pub fn position(self, value: f64) -> f64 {
        if self.log {
            // what is not positive is below every scale
            let value = if value <= 0.0 { f64::MIN_POSITIVE } else { value };
            (value / self.min).ln() / (self.max / self.min).ln()
        } else {
            (value - self.min) / (self.max - self.min)
        }
    }
}

/// The luminance of every pixel of a linear picture in false colours, sRGB-encoded.
pub fn luminance(linear: &Image, scale: Scale) -> Image {
    let color = |[r, g, b]: [f32; 3]| {
        let y = lesk_quantities::colorspace::luminance([r.into(), g.into(), b.into()]);
        viridis(scale.position(y) as f32)
    };
    let data = linear.rgb_pixels().flat_map(color).collect();
    Image::new(linear.width(), linear.height(), 3, Transfer::Srgb, data).expect("the size of another image")
}

/// A linear scale from the smallest to the largest luminance of a picture, or a logarithmic one from the smallest positive;
/// `None` where all are equal or none counts.
pub fn range(linear: &Image, log: bool) -> Option<Scale> {
    let (mut min, mut max) = (f64::INFINITY, f64::NEG_INFINITY);
    for [r, g, b] in linear.rgb_pixels() {
        let y = lesk_quantities::colorspace::luminance([r.into(), g.into(), b.into()]);
        if y.is_finite() && (!log || y > 0.0) {
            (min, max) = (min.min(y), max.max(y));
        }
    }
    Scale::checked(min, max, log).ok()
}

/// CIE lightness L* of an sRGB-encoded colour, 0 to 100: the order in which people see the map.
pub fn lightness(srgb: [f32; 3]) -> f64 {
    let linear = srgb.map(|v| f64::from(tonemap::srgb_decode(v)));
    let y = lesk_quantities::colorspace::luminance(linear);
    // CIE 15: 116 f(Y) - 16
    if y > 216.0 / 24_389.0 { 116.0 * y.cbrt() - 16.0 } else { y * 24_389.0 / 27.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ends_are_the_published_colours() {
        // matplotlib 3.11: viridis(0) and viridis(255)
        assert_eq!(viridis(0.0), [0.267004, 0.004874, 0.329415]);
        assert_eq!(viridis(1.0), [0.993248, 0.906157, 0.143936]);
        assert_eq!((viridis(-3.0), viridis(f32::INFINITY)), (viridis(0.0), viridis(1.0)));
        assert_eq!(viridis(f32::NAN), [0.5; 3]);
    }

    #[test]
    fn more_is_always_lighter_and_by_equal_steps() {
        let steps: Vec<f64> = (0..=100).map(|i| lightness(viridis(i as f32 / 100.0))).collect();
        let mean = (steps[100] - steps[0]) / 100.0;
        for pair in steps.windows(2) {
            let step = pair[1] - pair[0];
            // designed in CAM02-UCS, where steps are equal; in CIE L* they are so within a third
            assert!(step > 0.0 && (step / mean - 1.0).abs() < 0.35, "{step} of {mean}");
        }
    }

    #[test]
    fn a_log_scale_gives_equal_steps_for_equal_ratios() {
        let scale = Scale::log(1.0, 10_000.0).unwrap();
        for (value, at) in [(1.0, 0.0), (10.0, 0.25), (100.0, 0.5), (10_000.0, 1.0)] {
            assert!((scale.position(value) - at).abs() < 1e-12);
        }
        assert!(scale.position(0.0) < 0.0 && scale.position(-5.0) < 0.0 && scale.position(f64::NAN).is_nan());
        assert_eq!(Scale::linear(10.0, 20.0).unwrap().position(15.0), 0.5);
    }

    #[test]
    fn scales_without_a_range_are_refused() {
        assert!(Scale::linear(1.0, 1.0).is_err() && Scale::log(0.0, 1.0).is_err());
        assert!(Scale::linear(f64::NAN, 1.0).is_err() && Scale::linear(0.0, f64::INFINITY).is_err());
    }

    #[test]
    fn range_finds_the_smallest_and_largest_luminance() {
        let image = Image::from_fn(4, 1, Transfer::Linear, |x, _| [[0.0, 2.0, 8.0, f32::NAN][x as usize]; 3]).unwrap();
        let at = |log| range(&image, log).unwrap().position(8.0);
        assert!((at(false) - 1.0).abs() < 1e-12 && (at(true) - 1.0).abs() < 1e-12);
        assert!(range(&image, true).unwrap().position(2.0).abs() < 1e-7);
        let colours = luminance(&image, range(&image, false).unwrap());
        assert_eq!(colours.rgb(0, 0), viridis(0.0));
        assert_eq!(colours.rgb(3, 0), [0.5; 3]);
    }
}
