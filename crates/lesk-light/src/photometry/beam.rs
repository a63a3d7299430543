//! Beam and field angles.

use super::Photometry;
use std::f64::consts::{PI, TAU};

/// Full opening angles, radians: between the two directions in a plane through the vertical axis at which the intensity
/// has fallen to a share of the plane's maximum, counted from that maximum outward.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BeamAngles {
    /// In the plane C0-C180.
    pub c0: f64,
    /// In the plane C90-C270.
    pub c90: f64,
}

/// Directions of a cut: a twentieth of a degree.
const STEPS: usize = 7200;

impl Photometry {
    /// Opening angles at a share of the maximum: 0.5 gives the beam angle, 0.1 the field angle.
    pub fn opening_angles(&self, share: f64) -> BeamAngles {
        BeamAngles { c0: self.opening_angle(0.0, share), c90: self.opening_angle(PI / 2.0, share) }
    }

    /// The opening angle in the plane of azimuth `phi` and its continuation on the other side, radians.
    fn opening_angle(&self, phi: f64, share: f64) -> f64 {
        // around the whole circle, from nadir up on the side of phi
        let values: Vec<f64> = (0..STEPS)
            .map(|i| {
                let angle = TAU * i as f64 / STEPS as f64;
                if angle <= PI { self.intensity(angle, phi) } else { self.intensity(TAU - angle, phi + PI) }
            })
            .collect();
        let peak = (0..STEPS).fold(0, |best, i| if values[i] > values[best] { i } else { best });
        let threshold = share * values[peak];
        if values[peak] <= 0.0 || values.iter().all(|x| *x >= threshold) {
            return if values[peak] <= 0.0 { 0.0 } else { TAU };
        }
        let reach = |step: usize| {
            let at = |k: usize| values[(peak + k * step) % STEPS];
            let last = (1..STEPS).find(|k| at(*k) < threshold).unwrap_or(STEPS);
            // linear between the last one above and the first one below
            let (above, below) = (at(last - 1), at(last));
            last as f64 - 1.0 + (above - threshold) / (above - below)
        };
        (reach(1) + reach(STEPS - 1)) * TAU / STEPS as f64
    }
}
