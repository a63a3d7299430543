//! The lights of a scene as a fixed list of directions to ask.

use crate::lanes::{Lanes, Points, Work};
use lesk_light::{Light, LightSample, Receiver};
use lesk_math::{CHANNELS, Vec3, vec3};
use lesk_scene::Scene;

/// One thing to ask for light.
#[derive(Clone, Debug)]
pub(crate) enum Source {
    /// A point, with its intensity in cd.
    Point([f32; 3], [f32; CHANNELS]),
    /// A direction towards parallel light, with its illuminance in lx.
    Parallel([f32; 3], [f32; CHANNELS]),
    /// A light of the scene at fixed numbers: a spot, or a point of a quadrature with its share.
    Asked { light: u32, part: u32, u: [f32; 2], share: f32 },
}

/// The sources of a scene. A light that has an area or fills the sky becomes `quadrature` points, the same for every
/// point of a surface: Hammersley's set, by parts for a light of several.
pub(crate) fn sources(scene: &Scene, quadrature: u32) -> Vec<Source> {
    let mut out = Vec::new();
    for (number, light) in scene.lights.list().iter().enumerate() {
        let light_number = number as u32;
        match light {
            Light::Point(point) => out.push(Source::Point(point.position().to_array(), point.intensity().0)),
            Light::Directional(sun) => out.push(Source::Parallel((-sun.direction()).to_array(), sun.illuminance().0)),
            light if light.is_delta() => {
                out.push(Source::Asked { light: light_number, part: 0, u: [0.5; 2], share: 1.0 });
            }
            _ => {
                let parts = scene.lights.part_count(light_number).max(1);
                // every part is asked at least once, where that is affordable
                let count = quadrature.max(parts.min(4096));
                out.extend((0..count).map(|k| {
                    let scaled = (f64::from(k) + 0.5) / f64::from(count) * f64::from(parts);
                    let part = (scaled as u32).min(parts - 1);
                    let x = (scaled - f64::from(part)).clamp(0.0, 0.999_999) as f32;
                    let asked = f64::from(parts) / f64::from(count);
                    Source::Asked { light: light_number, part, u: [x, radical_inverse(k)], share: asked as f32 }
                }));
            }
        }
    }
    out
}

/// Van der Corput's sequence in base 2, moved by half a step of 2^-32.
fn radical_inverse(k: u32) -> f32 {
    ((f64::from(k.reverse_bits()) + 0.5) / 4_294_967_296.0).min(0.999_999_9) as f32
}

impl Source {
    /// Fills the directions to the light and what arrives, without regard to obstacles.
    pub fn ask(&self, scene: &Scene, lanes: &Lanes, points: &Points, work: &mut Work, transmits: bool) {
        match self {
            Source::Point(at, intensity) => lanes.point(points, work, *at, *intensity),
            Source::Parallel(direction, illuminance) => {
                for c in 0..3 {
                    work.wi[c][..points.n].fill(direction[c]);
                }
                for c in 0..CHANNELS {
                    work.value[c][..points.n].fill(illuminance[c]);
                }
            }
            Source::Asked { .. } => {
                for i in 0..points.n {
                    let sample = self.sample(scene, at(&points.p, i), at(&points.side, i), transmits);
                    let wi = sample.map_or(Vec3::Z, |s| s.wi).to_array();
                    for c in 0..3 {
                        work.wi[c][i] = wi[c];
                    }
                    for c in 0..CHANNELS {
                        work.value[c][i] = sample.map_or(0.0, |s| s.value.0[c]);
                    }
                }
            }
        }
    }

    /// The light at one point; `value` is the illuminance of a plane perpendicular to `wi`.
    pub fn sample(&self, scene: &Scene, p: Vec3<f32>, n: Vec3<f32>, transmits: bool) -> Option<LightSample> {
        let receiver = if transmits { Receiver::anywhere(p) } else { Receiver::opaque(p, n) };
        let Source::Asked { light, part, u, share } = self else { return None };
        let mut sample = scene.lights.list().get(*light as usize)?.sample(*part, &receiver, *u)?;
        if !sample.delta {
            sample.value = sample.value * (share / sample.pdf);
        }
        sample.value.0.iter().all(|v| v.is_finite()).then_some(sample)
    }
}

/// Vector `i` of three rows.
#[inline]
pub(crate) fn at(rows: &crate::lanes::Rows3, i: usize) -> Vec3<f32> {
    vec3(rows[0][i], rows[1][i], rows[2][i])
}
