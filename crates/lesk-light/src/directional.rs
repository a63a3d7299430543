//! Light from infinitely far away.

use crate::error::{LightError, check_color, check_direction};
use crate::sample::{LightSample, Receiver, Target};
use lesk_math::{Color, Vec3};
use std::f32::consts::PI;

/// Parallel light, stated by the illuminance of a plane perpendicular to it.
#[derive(Clone, Debug)]
pub struct Directional {
    direction: Vec3<f32>,
    illuminance: Color<f32>,
}

impl Directional {
    /// Light that travels along `direction`, with the illuminance in lx of a plane perpendicular to it.
    ///
    /// # Errors
    /// A direction without length, an illuminance that is negative, zero or not finite.
    pub fn new(direction: Vec3<f32>, illuminance: Color<f32>) -> Result<Self, LightError> {
        check_color("illuminance", "lx", illuminance)?;
        Ok(Directional { direction: check_direction("direction", direction)?, illuminance })
    }

    /// The direction in which the light travels, unit.
    pub fn direction(&self) -> Vec3<f32> {
        self.direction
    }

    /// Illuminance of a plane perpendicular to the light, lx.
    pub fn illuminance(&self) -> Color<f32> {
        self.illuminance
    }

    /// Luminous flux through a disk of the given radius in metres, lm.
    pub fn flux(&self, scene_radius: f32) -> f32 {
        PI * scene_radius * scene_radius * self.illuminance.luminance()
    }

    pub(crate) fn sample(&self, _at: &Receiver) -> Option<LightSample> {
        Some(LightSample {
            wi: -self.direction,
            distance: f32::INFINITY,
            value: self.illuminance,
            pdf: 1.0,
            delta: true,
            light: 0,
            target: Target::Infinity,
        })
    }
}
