//! The spot light.

use crate::bounds::LightBounds;
use crate::error::{LightError, check_color, check_direction};
use crate::sample::{LightSample, Receiver, Target, toward};
use lesk_math::{Color, Vec3};
use std::f64::consts::{PI, TAU};

/// A point that shines into a cone: full intensity up to the inner half angle, nothing beyond the outer one, and
/// between them a smooth step of the cosine, I(θ) = I s²(3 - 2s) with s = (cos θ - cos e)/(cos i - cos e).
///
/// The cone concentrates the flux, as a reflector does: half the angle makes the beam brighter, not the lamp weaker.
#[derive(Clone, Debug)]
pub struct Spot {
    position: Vec3<f32>,
    axis: Vec3<f32>,
    intensity: Color<f32>,
    cos_inner: f64,
    cos_outer: f64,
}

impl Spot {
    /// A spot at `position` (metres) that shines along `axis`, with the luminous intensity in cd on the axis and the
    /// two half angles in radians.
    ///
    /// # Errors
    /// A direction without length, an intensity that is negative, zero or not finite, and angles other than
    /// 0 ≤ inner ≤ outer ≤ π with outer > 0.
    pub fn new(
        position: Vec3<f32>,
        axis: Vec3<f32>,
        intensity: Color<f32>,
        [inner, outer]: [f64; 2],
    ) -> Result<Self, LightError> {
        check_color("intensity", "cd", intensity)?;
        let axis = check_direction("direction", axis)?;
        if !(inner >= 0.0 && inner <= outer && outer > 1e-4 && outer <= PI) {
            return Err(LightError::new(format!(
                "spot has the half angles {} deg (inner) and {} deg (outer), 0 <= inner <= outer <= 180 deg and outer > 0 \
                 are accepted",
                inner.to_degrees(),
                outer.to_degrees()
            ))
            .hint("both angles are measured from the axis to the edge"));
        }
        Ok(Spot { position, axis, intensity, cos_inner: inner.cos(), cos_outer: outer.cos() })
    }

    /// A spot that emits the luminous flux in lm into its cone: I = Φ / 2π / [(1 - cos i) + (cos i - cos e)/2].
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn from_flux(
        position: Vec3<f32>,
        axis: Vec3<f32>,
        flux: Color<f32>,
        half_angles: [f64; 2],
    ) -> Result<Self, LightError> {
        check_color("flux", "lm", flux)?;
        let mut spot = Self::new(position, axis, flux, half_angles)?;
        spot.intensity = flux * (1.0 / spot.solid_angle()) as f32;
        Ok(spot)
    }

    /// Flux over axial intensity, sr. The smooth step has the mean 1/2 over the cosine.
    fn solid_angle(&self) -> f64 {
        TAU * ((1.0 - self.cos_inner) + 0.5 * (self.cos_inner - self.cos_outer))
    }

    /// Luminous intensity on the axis, cd.
    pub fn intensity(&self) -> Color<f32> {
        self.intensity
    }

    /// Luminous flux, lm.
    pub fn flux(&self) -> f32 {
        self.intensity.luminance() * self.solid_angle() as f32
    }

    /// Share of the axial intensity in the direction `w` away from the light.
    fn falloff(&self, w: Vec3<f32>) -> f32 {
        let cos = w.dot(self.axis) as f64;
        if cos >= self.cos_inner {
            return 1.0;
        }
        let s = ((cos - self.cos_outer) / (self.cos_inner - self.cos_outer)).max(0.0);
        (s * s * (3.0 - 2.0 * s)) as f32
    }

    pub(crate) fn sample(&self, at: &Receiver) -> Option<LightSample> {
        let (wi, distance) = toward(at.p, self.position)?;
        let falloff = self.falloff(-wi);
        (falloff > 0.0).then(|| LightSample {
            wi,
            distance,
            value: self.intensity * (falloff / (distance * distance)),
            pdf: 1.0,
            delta: true,
            light: 0,
            target: Target::Point(self.position),
        })
    }

    pub(crate) fn bounds(&self) -> LightBounds {
        let (inner, outer) = (self.cos_inner.acos(), self.cos_outer.acos());
        LightBounds::cone(self.position, self.axis, inner, outer - inner, self.intensity.luminance())
    }
}
