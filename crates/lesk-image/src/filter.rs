//! Pixel filters by importance: a camera sample is moved by an offset that is distributed as the filter, and then counts
//! for its own pixel with weight one. Each sample thus belongs to one pixel (Ernst, Stamminger & Greiner, *Filter
//! Importance Sampling*, IRT 2006); filters with negative lobes cannot be sampled and are left out.

use crate::ImageError;
use std::f64::consts::PI;

/// Cells of the tabulated inverse over one half of a filter.
const CELLS: usize = 512;

/// A pixel filter, separable, over `-radius..radius` pixels from the pixel's centre in x and y.
#[derive(Clone, Debug, PartialEq)]
pub struct PixelFilter {
    shape: Shape,
    radius: f64,
    /// Entry i is where the filter has the share v of its half, 1 - v = (1 - i / CELLS)²: finer towards the thin tail.
    inverse: Vec<f32>,
}

/// The curve of a filter.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Shape {
    Box,
    Tent,
    Gaussian { sigma: f64 },
    BlackmanHarris,
}

impl Default for PixelFilter {
    /// Blackman-Harris of radius 1.5: nearly no ringing, little blur; the usual choice.
    fn default() -> Self {
        PixelFilter::blackman_harris(1.5).expect("1.5 is a legal radius")
    }
}

impl PixelFilter {
    /// The same weight everywhere; radius 0.5 is the pixel itself.
    ///
    /// # Errors
    /// A radius outside 0.1 to 10 pixels.
    pub fn box_filter(radius: f64) -> Result<PixelFilter, ImageError> {
        Self::new(Shape::Box, radius)
    }

    /// A triangle that falls to zero at the radius.
    ///
    /// # Errors
    /// A radius outside 0.1 to 10 pixels.
    pub fn tent(radius: f64) -> Result<PixelFilter, ImageError> {
        Self::new(Shape::Tent, radius)
    }

    /// A Gaussian of standard deviation `sigma` pixels, cut off at three of them.
    ///
    /// # Errors
    /// A sigma outside 0.1 to 3 pixels.
    pub fn gaussian(sigma: f64) -> Result<PixelFilter, ImageError> {
        if !(0.1..=3.0).contains(&sigma) {
            return Err(ImageError::invalid(format!("filter sigma {sigma}, but 0.1 to 3 pixels is accepted")));
        }
        Self::new(Shape::Gaussian { sigma }, 3.0 * sigma)
    }

    /// The four-term window of Harris 1978, stretched over the radius.
    ///
    /// # Errors
    /// A radius outside 0.1 to 10 pixels.
    pub fn blackman_harris(radius: f64) -> Result<PixelFilter, ImageError> {
        Self::new(Shape::BlackmanHarris, radius)
    }

    /// A filter by name, `box`, `tent`, `gaussian` or `blackman_harris`, with its usual width: 0.5, 1, sigma 0.5, 1.5.
    ///
    /// # Errors
    /// Another name.
    pub fn named(name: &str) -> Result<PixelFilter, ImageError> {
        match name {
            "box" => Self::box_filter(0.5),
            "tent" => Self::tent(1.0),
            "gaussian" => Self::gaussian(0.5),
            "blackman_harris" => Self::blackman_harris(1.5),
            _ => {
                let names = "box, tent, gaussian, blackman_harris";
                Err(ImageError::invalid(format!("filter `{name}`, but one of {names} is accepted")))
            }
        }
    }

    fn new(shape: Shape, radius: f64) -> Result<PixelFilter, ImageError> {
        if !(0.1..=10.0).contains(&radius) {
            return Err(ImageError::invalid(format!("filter radius {radius}, but 0.1 to 10 pixels is accepted")));
        }
        let inverse = if matches!(shape, Shape::Gaussian { .. } | Shape::BlackmanHarris) {
            inverse_table(|x| shape.weight(x, radius), radius)
        } else {
            Vec::new()
        };
        Ok(PixelFilter { shape, radius, inverse })
    }

    /// Half the width of the filter, pixels.
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// The offset from the pixel's centre, in pixels, for two uniform numbers in 0..1; distributed as the filter.
    #[inline]
    pub fn sample(&self, u: [f32; 2]) -> [f32; 2] {
        u.map(|u| self.sample_axis(u))
    }

    #[inline]
    fn sample_axis(&self, u: f32) -> f32 {
        let radius = self.radius as f32;
        // the filter is even: one half by the sign, the same number stretched for the place within it
        let v = 2.0 * u - 1.0;
        let (side, v) = (1.0f32.copysign(v), v.abs().min(1.0));
        side * match self.shape {
            Shape::Box => v * radius,
            Shape::Tent => (1.0 - (1.0 - v).max(0.0).sqrt()) * radius,
            _ => {
                let at = (1.0 - (1.0 - v).max(0.0).sqrt()) * CELLS as f32;
                let i = (at as usize).min(CELLS - 1);
                let t = at - i as f32;
                self.inverse[i] * (1.0 - t) + self.inverse[i + 1] * t
            }
        }
    }

    /// The filter at an offset in pixels from the centre, as a density that integrates to one.
    pub fn pdf(&self, offset: [f64; 2]) -> f64 {
        offset.map(|x| self.pdf_axis(x)).iter().product()
    }

    fn pdf_axis(&self, x: f64) -> f64 {
        if x.abs() > self.radius {
            0.0
        } else {
            self.shape.weight(x.abs(), self.radius) / self.shape.integral(self.radius)
        }
    }
}

impl Shape {
    /// The curve at 0..radius, not normalised.
    fn weight(self, x: f64, radius: f64) -> f64 {
        match self {
            Self::Box => 1.0,
            Self::Tent => 1.0 - x / radius,
            Self::Gaussian { sigma } => (-0.5 * x * x / (sigma * sigma)).exp(),
            Self::BlackmanHarris => {
                let t = PI * (x / radius + 1.0);
                0.358_75 - 0.488_29 * t.cos() + 0.141_28 * (2.0 * t).cos() - 0.011_68 * (3.0 * t).cos()
            }
        }
    }

    /// The integral of the curve over -radius..radius.
    fn integral(self, radius: f64) -> f64 {
        match self {
            Self::Box => 2.0 * radius,
            Self::Tent => radius,
            // the cosines have whole periods: only the constant is left
            Self::BlackmanHarris => 2.0 * radius * 0.358_75,
            Self::Gaussian { .. } => 2.0 * simpson(|x| self.weight(x, radius), 0.0, radius),
        }
    }
}

/// Where the integral of `weight` over 0..x reaches each share of its whole, by Simpson's rule on fine steps.
fn inverse_table(weight: impl Fn(f64) -> f64, radius: f64) -> Vec<f32> {
    let steps = 16 * CELLS;
    let h = radius / steps as f64;
    let mut sums = vec![0.0];
    for i in 0..steps {
        let x = i as f64 * h;
        sums.push(sums[i] + h / 6.0 * (weight(x) + 4.0 * weight(x + 0.5 * h) + weight(x + h)));
    }
    let mut step = 0;
    let place = |i: usize| {
        let tail = 1.0 - i as f64 / CELLS as f64;
        let target = sums[steps] * (1.0 - tail * tail);
        while step < steps - 1 && sums[step + 1] < target {
            step += 1;
        }
        let t = (target - sums[step]) / (sums[step + 1] - sums[step]).max(f64::MIN_POSITIVE);
        ((step as f64 + t.clamp(0.0, 1.0)) * h) as f32
    };
    let mut inverse: Vec<f32> = (0..=CELLS).map(place).collect();
    inverse[CELLS] = radius as f32;
    inverse
}

fn simpson(f: impl Fn(f64) -> f64, a: f64, b: f64) -> f64 {
    let n = 2048;
    let h = (b - a) / f64::from(n);
    let inner: f64 = (1..n).map(|i| f(a + f64::from(i) * h) * if i % 2 == 1 { 4.0 } else { 2.0 }).sum();
    (f(a) + inner + f(b)) * h / 3.0
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all() -> Vec<(&'static str, PixelFilter)> {
        ["box", "tent", "gaussian", "blackman_harris"].map(|n| (n, PixelFilter::named(n).unwrap())).to_vec()
    }

    #[test]
    fn every_filter_integrates_to_one() {
        for (name, filter) in all() {
            let one = 2.0 * simpson(|x| filter.pdf_axis(x), 0.0, filter.radius);
            assert!((one - 1.0).abs() < 1e-9, "{name}: {one}"); // Simpson on 2048 steps
        }
    }

    #[test]
    fn every_filter_is_never_negative_and_even() {
        for (name, filter) in all() {
            for i in 0..=1000 {
                let x = filter.radius * f64::from(i) / 1000.0;
                assert!(filter.pdf_axis(x) >= 0.0 && filter.pdf_axis(x) == filter.pdf_axis(-x), "{name} {x}");
            }
            assert_eq!(filter.pdf([filter.radius * 1.001, 0.0]), 0.0);
        }
    }

    #[test]
    fn samples_are_distributed_as_the_filter() {
        // stratified numbers: the distribution below any x is u itself, up to one stratum and the table's linear pieces
        let n = 100_000u32;
        for (name, filter) in all() {
            let mut below = [0u32; 33];
            for i in 0..n {
                let x = f64::from(filter.sample_axis((i as f32 + 0.5) / n as f32));
                assert!(x.abs() <= filter.radius * 1.000_001, "{name}: {x}");
                for (k, count) in below.iter_mut().enumerate() {
                    *count += u32::from(x < (k as f64 / 16.0 - 1.0) * filter.radius);
                }
            }
            for (k, count) in below.iter().enumerate() {
                let x = (k as f64 / 16.0 - 1.0) * filter.radius;
                let expected = 0.5 + x.signum() * simpson(|x| filter.pdf_axis(x), 0.0, x.abs());
                let got = f64::from(*count) / f64::from(n);
                // two strata of 1e-5, the table's straight pieces and the steps of u in f32
                assert!((got - expected).abs() < 4e-5, "{name} at {x}: {got} not {expected}");
            }
        }
    }

    #[test]
    fn the_ends_of_the_unit_interval_stay_inside() {
        for (name, filter) in all() {
            for u in [0.0, f32::MIN_POSITIVE, 0.5, 1.0 - f32::EPSILON / 2.0, 1.0] {
                let [x, y] = filter.sample([u, u]);
                assert!(x.is_finite() && x == y && f64::from(x.abs()) <= filter.radius * 1.000_001, "{name} {u}: {x}");
            }
        }
    }

    #[test]
    fn illegal_widths_and_names_are_refused() {
        for radius in [0.0, -1.0, 11.0, f64::NAN, f64::INFINITY] {
            assert!(PixelFilter::box_filter(radius).is_err() && PixelFilter::gaussian(radius).is_err());
        }
        assert!(PixelFilter::named("mitchell").is_err());
    }
}
