//! The constant sky.

use crate::error::{LightError, check_color, check_direction};
use crate::sample::{LightSample, Receiver, Target};
use lesk_math::{Color, Frame, Vec3, vec3};
use std::f32::consts::{PI, TAU};

/// The same luminance from every direction, or from every direction of the upper half space.
#[derive(Clone, Debug)]
pub struct Sky {
    luminance: Color<f32>,
    /// The zenith of a sky that ends at the horizon.
    up: Option<Vec3<f32>>,
}

impl Sky {
    /// The luminance in cd/m² from all directions.
    ///
    /// # Errors
    /// A luminance that is negative, zero or not finite.
    pub fn new(luminance: Color<f32>) -> Result<Self, LightError> {
        check_color("luminance", "cd/m2", luminance)?;
        Ok(Sky { luminance, up: None })
    }

    /// The luminance in cd/m² from the half space around `up`: E = π L on a horizontal plane.
    ///
    /// # Errors
    /// A luminance that is negative, zero or not finite, a direction without length.
    pub fn dome(luminance: Color<f32>, up: Vec3<f32>) -> Result<Self, LightError> {
        let up = check_direction("up", up)?;
        Ok(Sky { up: Some(up), ..Self::new(luminance)? })
    }

    /// Luminance in cd/m² seen in the unit direction `wi`.
    pub fn radiance(&self, wi: Vec3<f32>) -> Color<f32> {
        match self.up {
            Some(up) if wi.dot(up) <= 0.0 => Color::BLACK,
            _ => self.luminance,
        }
    }

    /// Luminous flux into a sphere of the given radius in metres, lm.
    pub fn flux(&self, scene_radius: f32) -> f32 {
        let solid_angle = if self.up.is_some() { TAU } else { 2.0 * TAU };
        solid_angle * PI * scene_radius * scene_radius * self.luminance.luminance()
    }

    /// The axis of the hemisphere from which light is drawn; with a normal by the cosine, else uniformly.
    fn axis(&self, at: &Receiver) -> Option<Vec3<f32>> {
        at.n.or(self.up)
    }

    pub(crate) fn sample(&self, at: &Receiver, u: [f32; 2]) -> Option<LightSample> {
        let wi = match (at.n, self.axis(at)) {
            (Some(n), _) => Frame::from_normal(n).world_from_local(cosine_hemisphere(u)),
            (None, Some(up)) => Frame::from_normal(up).world_from_local(on_sphere(1.0 - u[0], u[1])),
            (None, None) => on_sphere(1.0 - 2.0 * u[0], u[1]),
        };
        let (value, pdf) = (self.radiance(wi), self.pdf(at, wi));
        (pdf > 0.0 && value.max_component() > 0.0).then_some(LightSample {
            wi,
            distance: f32::INFINITY,
            value,
            pdf,
            delta: false,
            light: 0,
            target: Target::Infinity,
        })
    }

    pub(crate) fn pdf(&self, at: &Receiver, wi: Vec3<f32>) -> f32 {
        match (at.n, self.up) {
            (Some(n), _) => wi.dot(n).max(0.0) / PI,
            (None, Some(up)) if wi.dot(up) <= 0.0 => 0.0,
            (None, Some(_)) => 1.0 / TAU,
            (None, None) => 1.0 / (2.0 * TAU),
        }
    }
}

/// The unit direction with the given z, at `turn` of a full turn.
fn on_sphere(z: f32, turn: f32) -> Vec3<f32> {
    let r = (1.0 - z * z).max(0.0).sqrt();
    let (s, c) = (TAU * turn).sin_cos();
    vec3(r * c, r * s, z)
}

/// Malley's method: a point of the unit disk lifted to the hemisphere.
fn cosine_hemisphere(u: [f32; 2]) -> Vec3<f32> {
    let (s, c) = (TAU * u[1]).sin_cos();
    let r = u[0].sqrt();
    vec3(r * c, r * s, (1.0 - u[0]).max(0.0).sqrt())
}
