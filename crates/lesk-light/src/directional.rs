//! Light from infinitely far away.

use crate::error::{LightError, check_color, check_direction};
use crate::sample::{LightSample, Target};
use lesk_math::{Color, Frame, Vec3, vec3};
use std::f32::consts::PI;
use std::f64::consts::{FRAC_PI_2, TAU};

/// Parallel light, or that of a disk in the sky (the sun), stated by the illuminance of a plane perpendicular to it.
///
/// A disk has the same luminance all over, L = E / (π sin² a) with the angular radius a.
#[derive(Clone, Debug)]
pub struct Directional {
    direction: Vec3<f32>,
    illuminance: Color<f32>,
    /// 0 for parallel light. 1 - cos a, which f32 keeps for small angles.
    versine: f32,
    /// sin² a.
    sine_square: f32,
}

impl Directional {
    /// Light that travels along `direction`, with the illuminance in lx of a plane perpendicular to it.
    ///
    /// # Errors
    /// A direction without length, an illuminance that is negative, zero or not finite.
    pub fn new(direction: Vec3<f32>, illuminance: Color<f32>) -> Result<Self, LightError> {
        check_color("illuminance", "lx", illuminance)?;
        let direction = check_direction("direction", direction)?;
        Ok(Directional { direction, illuminance, versine: 0.0, sine_square: 0.0 })
    }

    /// The same from a disk of this angular diameter in radians: shadows get penumbras, and the disk is seen.
    ///
    /// # Errors
    /// A diameter that is not between 1e-4 rad and π.
    pub fn with_diameter(self, diameter: f64) -> Result<Self, LightError> {
        if !(1e-4..2.0 * FRAC_PI_2).contains(&diameter) {
            return Err(LightError::new(format!(
                "angular diameter is {} deg, 0.006 to below 180 deg is accepted",
                diameter.to_degrees()
            )));
        }
        let half = 0.25 * diameter;
        let versine = (2.0 * half.sin() * half.sin()) as f32;
        Ok(Directional { versine, sine_square: (2.0 * half).sin().powi(2) as f32, ..self })
    }

    /// The direction in which the light travels, unit.
    pub fn direction(&self) -> Vec3<f32> {
        self.direction
    }

    /// Illuminance of a plane perpendicular to the light, lx.
    pub fn illuminance(&self) -> Color<f32> {
        self.illuminance
    }

    /// Whether it comes from one direction alone.
    pub fn is_delta(&self) -> bool {
        self.versine == 0.0
    }

    /// Luminous flux through a disk of the given radius in metres, lm.
    pub fn flux(&self, scene_radius: f32) -> f32 {
        PI * scene_radius * scene_radius * self.illuminance.luminance()
    }

    /// Luminance in cd/m² seen in the unit direction `wi`; black for parallel light, which has no picture.
    pub fn radiance(&self, wi: Vec3<f32>) -> Color<f32> {
        if self.holds(wi) { self.illuminance * (1.0 / (PI * self.sine_square)) } else { Color::BLACK }
    }

    /// Whether a direction points into the disk. The sine keeps digits that the cosine of a small angle has not.
    fn holds(&self, wi: Vec3<f32>) -> bool {
        wi.dot(self.direction) < 0.0 && wi.cross(self.direction).length_squared() < self.sine_square
    }

    /// Density over the disk, 1/sr.
    fn density(&self) -> f32 {
        (1.0 / (TAU * f64::from(self.versine))) as f32
    }

    pub(crate) fn pdf(&self, wi: Vec3<f32>) -> f32 {
        if self.holds(wi) { self.density() } else { 0.0 }
    }

    pub(crate) fn sample(&self, u: [f32; 2]) -> Option<LightSample> {
        let toward = -self.direction;
        let (wi, value, pdf) = if self.is_delta() {
            (toward, self.illuminance, 1.0)
        } else {
            // uniform over the disk, kept off its rim, where rounding decides
            let versine = self.versine * u[0].min(1.0 - 1e-5);
            let sine = (versine * (2.0 - versine)).sqrt();
            let (s, c) = (2.0 * PI * u[1]).sin_cos();
            let wi = Frame::from_normal(toward).world_from_local(vec3(sine * c, sine * s, 1.0 - versine));
            (wi, self.illuminance * (1.0 / (PI * self.sine_square)), self.density())
        };
        let delta = self.is_delta();
        let target = Target::Infinity;
        Some(LightSample { wi, distance: f32::INFINITY, value, pdf, delta, light: 0, target })
    }
}
