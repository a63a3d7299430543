//! Directions to test at: everywhere, and often where models are difficult.

use crate::random::Random;
use crate::subject::Case;
use lesk_bsdf::bsdf::MIN_COS;
use lesk_bsdf::model::Domain;
use lesk_math::{Vec3, vec3};
use std::f64::consts::TAU;

/// The direction with cosine `z` and azimuth `phi` in radians.
pub fn from_cosine(z: f64, phi: f64) -> Vec3<f64> {
    let r = ((1.0 - z) * (1.0 + z)).max(0.0).sqrt();
    vec3(r * phi.cos(), r * phi.sin(), z)
}

/// Polar angle and azimuth of a direction, in degrees; the azimuth in [0, 360).
pub fn degrees(w: Vec3<f64>) -> [f64; 2] {
    let theta = w.x.hypot(w.y).atan2(w.z).to_degrees();
    [theta, w.y.atan2(w.x).to_degrees().rem_euclid(360.0)]
}

/// The direction of a polar angle and azimuth in degrees.
pub fn from_degrees([theta, phi]: [f64; 2]) -> Vec3<f64> {
    let (theta, phi) = (theta.to_radians(), phi.to_radians());
    vec3(theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos())
}

/// A direction of the domain at least `floor` (a cosine) from the horizon: mostly uniform in solid angle, often near
/// the normal or, down to `floor`, near the horizon at every scale.
pub fn any(rng: &mut Random, domain: Domain, floor: f64) -> Vec3<f64> {
    let floor = floor.max(MIN_COS);
    let z = match rng.unit() {
        t if t < 0.60 => rng.within(floor, 1.0),
        t if t < 0.80 => floor.powf(rng.unit()),
        t if t < 0.97 => 1.0 - 10f64.powf(rng.within(-10.0, -1.0)),
        _ => 1.0,
    };
    let below = domain != Domain::Upper && rng.chance(0.5);
    from_cosine(if below { -z } else { z }, rng.within(0.0, TAU))
}

/// A pair of directions: independent, drawn by the model (so that narrow lobes are met), or nearly mirrored or
/// nearly equal.
pub fn pair(rng: &mut Random, case: &Case, floor: f64) -> (Vec3<f64>, Vec3<f64>) {
    let wo = any(rng, case.domain(), floor);
    let wi = match rng.unit() {
        t if t < 0.45 => any(rng, case.domain(), floor),
        t if t < 0.9 => {
            let s = case.draw(wo, rng.unit3());
            if s.pdf > 0.0 && s.delta == 0.0 { s.wi } else { any(rng, case.domain(), floor) }
        }
        t => {
            let near = if t < 0.95 { vec3(-wo.x, -wo.y, wo.z) } else { wo };
            jitter(rng, near)
        }
    };
    if wi.z.abs() < floor { (any(rng, case.domain(), floor), wo) } else { (wi, wo) }
}

/// A direction close to `w`, at a random scale between 1e-8 and 0.1.
fn jitter(rng: &mut Random, w: Vec3<f64>) -> Vec3<f64> {
    let scale = 10f64.powf(rng.within(-8.0, -1.0));
    let offset = vec3(rng.within(-1.0, 1.0), rng.within(-1.0, 1.0), rng.within(-1.0, 1.0));
    (w + offset * scale).normalize()
}

/// Both directions turned about the normal by `angle` radians.
pub fn turn(w: Vec3<f64>, angle: f64) -> Vec3<f64> {
    let (s, c) = angle.sin_cos();
    vec3(c * w.x - s * w.y, s * w.x + c * w.y, w.z)
}
