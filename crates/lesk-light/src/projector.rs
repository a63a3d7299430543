//! A picture thrown by a lens.

use crate::bounds::LightBounds;
use crate::environment::rec709;
use crate::error::{LightError, check_color, check_direction};
use crate::sample::{LightSample, Receiver, Target, toward};
use lesk_image::Image;
use lesk_image::Texture;
use lesk_image::texture::{Interpolation, Role, Wrap};
use lesk_math::{Color, Vec3};
use std::f64::consts::PI;
use std::sync::Arc;

/// A projector: a point from which a picture goes out through a rectangular pyramid.
///
/// Its numbers are proportional to the illuminance of a plane screen perpendicular to the axis, so a white picture lights
/// that screen evenly, and I(w) = E₁(x, y) / cos³ θ with the illuminance E₁ at 1 m.
#[derive(Clone, Debug)]
pub struct Projector {
    texture: Arc<Texture>,
    position: Vec3<f32>,
    /// To the right of the picture as the audience behind the projector sees it, upward, along the axis.
    axes: [Vec3<f64>; 3],
    /// Half width and half height of the picture at 1 m.
    half: [f64; 2],
    /// lx at 1 m per unit of the picture.
    scale: Color<f32>,
    /// Mean and largest luminance of the picture, in its own unit.
    mean: f64,
    largest: f64,
}

impl Projector {
    /// A picture thrown from `position` (metres) along `direction`, with `up` upward, through the full horizontal opening
    /// `width` in radians; the height follows from the picture. `flux` is the light of the whole picture in lm, of this
    /// colour.
    ///
    /// # Errors
    /// A picture that is black, a flux that is not positive and finite, directions without length or parallel to each
    /// other, an opening that is not between 0 and 170 degrees.
    pub fn from_flux(
        image: Image,
        position: Vec3<f32>,
        direction: Vec3<f32>,
        up: Vec3<f32>,
        width: f64,
        flux: Color<f32>,
    ) -> Result<Self, LightError> {
        check_color("flux", "lm", flux)?;
        if !(width > 1e-3 && width <= 170.0 * PI / 180.0) {
            return Err(LightError::new(format!(
                "opening of the projector is {} deg, 0.06 to 170 deg is accepted",
                width.to_degrees()
            )));
        }
        let forward = check_direction("direction", direction)?.map(f64::from).normalize();
        let right = forward.cross(check_direction("up", up)?.map(f64::from));
        if right.length() < 1e-6 {
            return Err(LightError::new("projector looks along its `up`").hint("give another `up`"));
        }
        let right = right.normalize();
        let mut texture = Texture::new(image, Role::Color, [Wrap::Clamp; 2], Interpolation::Bilinear);
        texture.clamp(0.0, f32::MAX);
        let (columns, rows) = texture.size();
        let half_width = (0.5 * width).tan();
        let half = [half_width, half_width * f64::from(rows) / f64::from(columns)];
        let luminances = texels(&texture);
        let mean = luminances.iter().sum::<f64>() / luminances.len() as f64;
        if !(mean > 0.0 && mean.is_finite()) {
            return Err(LightError::new(format!("picture of the projector has a mean of {mean}, it must be positive")));
        }
        let largest = luminances.into_iter().fold(0.0, f64::max);
        // flux = E₁ area
        let scale = flux * (1.0 / (mean * 4.0 * half[0] * half[1])) as f32;
        let axes = [right, right.cross(forward), forward];
        Ok(Projector { texture: Arc::new(texture), position, axes, half, scale, mean, largest })
    }

    /// Luminous flux, lm.
    pub fn flux(&self) -> f32 {
        self.scale.luminance() * (self.mean * 4.0 * self.half[0] * self.half[1]) as f32
    }

    /// Luminous intensity in cd in the unit direction `w` away from the projector.
    pub fn intensity(&self, w: Vec3<f32>) -> Color<f32> {
        let w = w.map(f64::from);
        let [x, y, z] = self.axes.map(|axis| w.dot(axis));
        if z <= 0.0 {
            return Color::BLACK;
        }
        let place = [0.5 + 0.5 * x / (z * self.half[0]), 0.5 + 0.5 * y / (z * self.half[1])];
        if !place.iter().all(|t| (0.0..=1.0).contains(t)) {
            return Color::BLACK;
        }
        rec709(self.texture.rgb(place.map(|t| t as f32))) * self.scale * (1.0 / (z * z * z)) as f32
    }

    pub(crate) fn sample(&self, at: &Receiver) -> Option<LightSample> {
        let (wi, distance) = toward(at.p, self.position)?;
        let value = self.intensity(-wi) * (1.0 / (distance * distance));
        (value.max_component() > 0.0).then_some(LightSample {
            wi,
            distance,
            value,
            pdf: 1.0,
            delta: true,
            light: 0,
            target: Target::Point(self.position),
        })
    }

    pub(crate) fn bounds(&self) -> LightBounds {
        let corner = self.half[0].hypot(self.half[1]);
        let intensity = self.scale.luminance() as f64 * self.largest * (1.0 + corner * corner).powf(1.5);
        LightBounds::cone(self.position, self.axes[2].map(|x| x as f32), corner.atan(), 1e-3, intensity as f32)
    }
}

/// The luminance of every texel.
fn texels(texture: &Texture) -> Vec<f64> {
    let (columns, rows) = texture.size();
    let middle = |i: u32, n: u32| (i as f32 + 0.5) / n as f32;
    (0..rows)
        .flat_map(|y| (0..columns).map(move |x| [middle(x, columns), middle(y, rows)]))
        .map(|uv| f64::from(rec709(texture.rgb(uv)).luminance()))
        .collect()
}
