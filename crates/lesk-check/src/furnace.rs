//! Directional albedos as curves and tables: what a white sky shows of a model.

use crate::directions::from_degrees;
use crate::energy::{Accuracy, albedo};
use crate::subject::Case;
use lesk_bsdf::model::Domain;
use lesk_math::CHANNELS;
use serde::{Deserialize, Serialize};

/// Directional albedo against the polar angle of the viewer.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Curve {
    /// What it shows: `default`, `default, from below`.
    pub label: String,
    /// Polar angles in degrees; above 90 the viewer is below the surface.
    pub theta_deg: Vec<f64>,
    /// Reflected share, mean of the channels.
    pub reflected: Vec<f64>,
    /// Transmitted share (in radiance, so with the square of the refractive index), mean of the channels.
    pub transmitted: Vec<f64>,
    /// The largest error estimate.
    pub error: f64,
}

/// Polar angles of the curves in degrees: even steps and the steep end.
const ANGLES: [f64; 16] =
    [0.0, 10.0, 20.0, 30.0, 40.0, 45.0, 50.0, 55.0, 60.0, 65.0, 70.0, 75.0, 80.0, 84.0, 87.0, 89.0];

/// The albedo curves of a model at these parameters, azimuth 0; one per side.
pub fn curves(case: &Case, label: &str) -> Vec<Curve> {
    let accuracy = Accuracy { tolerance: 2e-4, evaluations: 100_000, hints: 256 };
    let curve = |below: bool| {
        let label = if below { format!("{label}, from below") } else { label.to_owned() };
        let mut curve = Curve { label, theta_deg: vec![], reflected: vec![], transmitted: vec![], error: 0.0 };
        for theta in ANGLES.map(|theta| if below { 180.0 - theta } else { theta }) {
            let power = albedo(case, from_degrees([theta, 0.0]), accuracy);
            let mean = |v: [f64; CHANNELS]| v.iter().sum::<f64>() / CHANNELS as f64;
            curve.theta_deg.push(theta);
            curve.reflected.push(mean(power.reflected));
            curve.transmitted.push(mean(power.transmitted));
            curve.error = curve.error.max(power.error);
        }
        curve
    };
    let sides: &[bool] = if case.domain() == Domain::BothSides { &[false, true] } else { &[false] };
    sides.iter().map(|&below| curve(below)).collect()
}
