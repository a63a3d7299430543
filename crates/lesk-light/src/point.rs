//! The point light.

use crate::bounds::LightBounds;
use crate::error::{LightError, check_color};
use crate::sample::{LightSample, Receiver, Target, toward};
use lesk_math::{Color, Vec3};
use std::f32::consts::PI;

/// A point that shines alike in all directions: E = I cos θ / d².
#[derive(Clone, Debug)]
pub struct Point {
    position: Vec3<f32>,
    intensity: Color<f32>,
}

impl Point {
    /// A point at `position` (metres) of the given luminous intensity in cd.
    ///
    /// # Errors
    /// An intensity that is negative, zero or not finite.
    pub fn new(position: Vec3<f32>, intensity: Color<f32>) -> Result<Self, LightError> {
        check_color("intensity", "cd", intensity)?;
        Ok(Point { position, intensity })
    }

    /// A point that emits the luminous flux in lm: I = Φ / 4π.
    ///
    /// # Errors
    /// A flux that is negative, zero or not finite.
    pub fn from_flux(position: Vec3<f32>, flux: Color<f32>) -> Result<Self, LightError> {
        check_color("flux", "lm", flux)?;
        Self::new(position, flux * (1.0 / (4.0 * PI)))
    }

    /// Position, metres.
    pub fn position(&self) -> Vec3<f32> {
        self.position
    }

    /// Luminous intensity, cd.
    pub fn intensity(&self) -> Color<f32> {
        self.intensity
    }

    /// Luminous flux, lm.
    pub fn flux(&self) -> f32 {
        4.0 * PI * self.intensity.luminance()
    }

    pub(crate) fn sample(&self, at: &Receiver) -> Option<LightSample> {
        let (wi, distance) = toward(at.p, self.position)?;
        Some(LightSample {
            wi,
            distance,
            value: self.intensity * (1.0 / (distance * distance)),
            pdf: 1.0,
            delta: true,
            light: 0,
            target: Target::Point(self.position),
        })
    }

    pub(crate) fn bounds(&self) -> LightBounds {
        LightBounds::everywhere(self.position, self.intensity.luminance())
    }
}
