//! Light from a picture of all directions.

use crate::error::{LightError, check_color};
use crate::sample::{LightSample, Target};
use lesk_image::distribution::Distribution2D;
use lesk_image::texture::{Interpolation, Role, Wrap};
use lesk_image::{Image, Texture};
use lesk_math::{CHANNELS, Channels, Color, Real, Vec3, vec3};
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

/// The axis of the world that points to the zenith of an environment.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Up {
    /// +z; the middle of the picture lies along +y.
    #[default]
    Z,
    /// +y; the middle of the picture lies along -z.
    Y,
}

/// A latitude-longitude map: the top row is the zenith, columns turn clockwise seen from above, as a viewer in the middle
/// sees them. With z up, the middle of the picture lies along +y and the middle of its right half along +x.
///
/// Directions are drawn in proportion to luminance times solid angle, and texels are interpolated.
#[derive(Clone, Debug)]
pub struct Environment {
    texture: Arc<Texture>,
    distribution: Arc<Distribution2D>,
    /// cd/m² per unit of the picture.
    scale: Color<f32>,
    /// The directions of the right edge of the view, its middle and the zenith, for the middle of the picture.
    axes: [Vec3<f32>; 3],
    /// Mean luminance and horizontal illuminance of the picture, in its own unit.
    mean: f64,
    horizontal: f64,
    repaired: u64,
}

impl Environment {
    /// A picture whose numbers are multiplied by `scale` to give cd/m², turned by `rotation` radians about the zenith,
    /// counter-clockwise seen from above. Numbers that are negative or not finite count as 0, see
    /// [`repaired`](Self::repaired).
    ///
    /// # Errors
    /// A picture that is black, a scale that is negative, zero or not finite, a rotation that is not finite.
    pub fn new(image: Image, scale: Color<f32>, up: Up, rotation: f64) -> Result<Self, LightError> {
        check_color("scale", "cd/m2 per unit", scale)?;
        if !rotation.is_finite() {
            return Err(LightError::new(format!("rotation is {rotation}, a finite angle is accepted")));
        }
        let mut texture = Texture::new(image, Role::Color, [Wrap::Repeat, Wrap::Clamp], Interpolation::Bilinear);
        let repaired = texture.repaired() + texture.clamp(0.0, f32::MAX);
        let (columns, rows) = texture.size();
        let luminance = texel_luminance(&texture);
        let (mean, horizontal) = averages(&luminance, columns as usize, rows as usize);
        if !(mean > 0.0 && mean.is_finite()) {
            return Err(LightError::new(format!(
                "environment map has a mean luminance of {mean}, it must be positive"
            ))
            .hint("remove the environment to have it dark"));
        }
        let weights = weights(&luminance, columns as usize, rows as usize);
        let distribution = Distribution2D::new(columns as usize, rows as usize, &weights)
            .map_err(|e| LightError::new(e.to_string()))?;
        Ok(Environment {
            texture: Arc::new(texture),
            distribution: Arc::new(distribution),
            scale,
            axes: axes(up, rotation),
            mean,
            horizontal,
            repaired,
        })
    }

    /// The same environment, scaled so that its upper half gives this illuminance in lx on a horizontal plane.
    ///
    /// # Errors
    /// An illuminance that is not positive and finite; a map whose upper half is black.
    pub fn with_illuminance(mut self, lux: f64) -> Result<Self, LightError> {
        if self.horizontal <= 0.0 {
            return Err(LightError::new("environment map is black above the horizon, so it gives no illuminance")
                .hint("give `luminance` or `scale` instead"));
        }
        self.set_scale(lux / self.horizontal, "illuminance", lux)?;
        Ok(self)
    }

    /// The same environment, scaled to this mean luminance in cd/m² over all directions.
    ///
    /// # Errors
    /// A luminance that is not positive and finite.
    pub fn with_luminance(mut self, luminance: f64) -> Result<Self, LightError> {
        self.set_scale(luminance / self.mean, "luminance", luminance)?;
        Ok(self)
    }

    fn set_scale(&mut self, scale: f64, what: &str, given: f64) -> Result<(), LightError> {
        if !(scale > 0.0 && (scale as f32).is_normal()) {
            return Err(LightError::new(format!("{what} is {given}, a positive, finite value is accepted")));
        }
        self.scale = Color::splat(scale as f32);
        Ok(())
    }

    /// Texels that were negative or not finite and count as 0.
    pub fn repaired(&self) -> u64 {
        self.repaired
    }

    /// Illuminance of a horizontal plane by the upper half, lx.
    pub fn illuminance(&self) -> f64 {
        self.horizontal * f64::from(self.scale.luminance())
    }

    /// Mean luminance over all directions, cd/m².
    pub fn mean_luminance(&self) -> f64 {
        self.mean * f64::from(self.scale.luminance())
    }

    /// Luminous flux into a sphere of the given radius in metres, lm.
    pub fn flux(&self, scene_radius: f32) -> f32 {
        (2.0 * TAU * PI * self.mean_luminance()) as f32 * scene_radius * scene_radius
    }

    /// Luminance in cd/m² seen in the unit direction `wi`.
    pub fn radiance(&self, wi: Vec3<f32>) -> Color<f32> {
        self.look_up(self.place(wi).0)
    }

    #[inline]
    fn look_up(&self, [x, y]: [f32; 2]) -> Color<f32> {
        rec709(self.texture.rgb([x, 1.0 - y])) * self.scale
    }

    /// The place in the picture, from its upper left corner, of a direction, and the sine of its angle to the zenith.
    #[inline]
    fn place(&self, wi: Vec3<f32>) -> ([f32; 2], f32) {
        let [right, forward, up] = self.axes.map(|axis| wi.dot(axis));
        let sin_theta = (right * right + forward * forward).sqrt();
        let x = 0.5 + Real::atan2(right, forward) * (1.0 / TAU as f32);
        let y = Real::atan2(sin_theta, up) * (1.0 / PI as f32);
        let below_one = |v: f32| v.clamp(0.0, 1.0 - f32::EPSILON / 2.0);
        // the left border is the right one
        ([if x >= 1.0 { 0.0 } else { below_one(x) }, below_one(y)], sin_theta)
    }

    pub(crate) fn sample(&self, u: [f32; 2]) -> Option<LightSample> {
        let (at, density) = self.distribution.sample(u.map(f64::from));
        let [x, y] = at.map(|v| v as f32);
        let (theta, turn) = (PI as f32 * y, TAU as f32 * (x - 0.5));
        let sin_theta = Real::sin(theta);
        let [right, forward, up] = self.axes;
        let (across, along) = (sin_theta * Real::sin(turn), sin_theta * Real::cos(turn));
        let wi = right * across + forward * along + up * Real::cos(theta);
        let pdf = (density / (TAU * PI * f64::from(sin_theta))) as f32;
        let value = self.look_up([x, y]);
        (pdf > 0.0 && pdf.is_finite() && value.max_component() > 0.0).then_some(LightSample {
            wi: wi.normalize(),
            distance: f32::INFINITY,
            value,
            pdf,
            delta: false,
            light: 0,
            target: Target::Infinity,
        })
    }

    /// Density of [`sample`](Self::sample), 1/sr.
    pub(crate) fn pdf(&self, wi: Vec3<f32>) -> f32 {
        self.seen(wi).1
    }

    /// Luminance seen in the unit direction `wi`, and the density of [`sample`](Self::sample) there.
    pub(crate) fn seen(&self, wi: Vec3<f32>) -> (Color<f32>, f32) {
        let (at, sin_theta) = self.place(wi);
        let pdf = (self.distribution.pdf(at.map(f64::from)) / (TAU * PI * f64::from(sin_theta))) as f32;
        (self.look_up(at), if pdf.is_finite() { pdf } else { 0.0 })
    }
}

/// The colour of this build from linear Rec.709: itself, or its luminance where there is one channel.
pub fn rec709(rgb: [f32; 3]) -> Color<f32> {
    let luminance = Channels(rgb).luminance();
    let channel = |c: usize| if CHANNELS == rgb.len() { rgb[c] } else { luminance };
    Channels(std::array::from_fn(channel))
}

/// Right, forward and up in the world.
fn axes(up: Up, rotation: f64) -> [Vec3<f32>; 3] {
    let (s, c) = f64::sin_cos(rotation);
    let (right, forward, zenith) = match up {
        Up::Z => (vec3(1.0, 0.0, 0.0), vec3(0.0, 1.0, 0.0), vec3(0.0, 0.0, 1.0)),
        Up::Y => (vec3(1.0, 0.0, 0.0), vec3(0.0, 0.0, -1.0), vec3(0.0, 1.0, 0.0)),
    };
    [right * c + forward * s, forward * c - right * s, zenith].map(|axis: Vec3<f64>| axis.map(|v| v as f32))
}

fn texel_luminance(texture: &Texture) -> Vec<f32> {
    let (columns, rows) = texture.size();
    let texel = |i: u64| {
        let (x, y) = (i % u64::from(columns), i / u64::from(columns));
        // texel centres: nothing is interpolated
        let u = (x as f32 + 0.5) / columns as f32;
        let v = 1.0 - (y as f32 + 0.5) / rows as f32;
        Channels(texture.rgb([u, v])).luminance()
    };
    (0..u64::from(columns) * u64::from(rows)).map(texel).collect()
}

/// The solid angle of a texel of row `y`, over that of the whole width: cos of its upper edge minus cos of its lower one.
fn band(y: usize, rows: usize) -> f64 {
    let middle = PI * (y as f64 + 0.5) / rows as f64;
    // cos a - cos b = 2 sin((a + b)/2) sin((b - a)/2)
    2.0 * middle.sin() * (0.5 * PI / rows as f64).sin()
}

/// The mean over all directions, and the illuminance of a horizontal plane by the upper half.
fn averages(luminance: &[f32], columns: usize, rows: usize) -> (f64, f64) {
    let (mut mean, mut horizontal) = (0.0, 0.0);
    for (y, row) in luminance.chunks_exact(columns).enumerate() {
        let sum: f64 = row.iter().map(|&l| f64::from(l)).sum::<f64>() / columns as f64;
        mean += sum * band(y, rows) / 2.0;
        let sin2 = |y: usize| (PI * (y as f64 / rows as f64).min(0.5)).sin().powi(2);
        horizontal += sum * PI * (sin2(y + 1) - sin2(y));
    }
    (mean, horizontal)
}

/// Luminance times solid angle of each texel. The luminance is the mean of what interpolation makes of it within the
/// texel, 1/8, 3/4, 1/8 in either direction, so that it is zero only where all of the texel is black.
fn weights(luminance: &[f32], columns: usize, rows: usize) -> Vec<f32> {
    let across = |y: usize, x: usize| {
        let row = &luminance[y * columns..(y + 1) * columns];
        let (before, after) = (row[(x + columns - 1) % columns], row[(x + 1) % columns]);
        0.125 * (f64::from(before) + f64::from(after)) + 0.75 * f64::from(row[x])
    };
    let mut out = Vec::with_capacity(luminance.len());
    // scaled to the mean, so that f32 holds the product for any unit of the picture
    let largest = luminance.iter().fold(0.0f32, |m, &l| m.max(l)).max(f32::MIN_POSITIVE);
    for y in 0..rows {
        let (above, below) = (y.saturating_sub(1), (y + 1).min(rows - 1));
        let solid_angle = band(y, rows) / f64::from(largest);
        for x in 0..columns {
            let mean = 0.125 * (across(above, x) + across(below, x)) + 0.75 * across(y, x);
            out.push((mean * solid_angle) as f32);
        }
    }
    out
}
