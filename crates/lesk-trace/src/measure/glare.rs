//! Discomfort glare: CIE 117, *Discomfort Glare in Interior Lighting*, 1995.
//!
//! UGR = 8 log10[(0.25/Lb) Σ L² ω / p²], with the background luminance Lb = E_i/π from the illuminance E_i at the eye that
//! does not come from the sources, and per source its mean luminance L, solid angle ω and Guth's position index p.

use super::Reading;
use super::receiver::{free_surface, narrow};
use lesk_geometry::Surface;
use lesk_light::photometry::position_index;
use lesk_light::{Light, Receiver};
use lesk_math::Vec3;
use lesk_math::sobol::Sampler;
use lesk_scene::Scene;
use lesk_scene::sensor::Response;
use std::f64::consts::PI;

/// Points on each light, at least; a mesh shares them among its triangles.
const SAMPLES: u32 = 4096;
/// Fewest points on a triangle.
const SAMPLES_PER_PART: u32 = 16;

/// The glare at an eye.
#[derive(Clone, Debug, PartialEq)]
pub struct Glare {
    /// The unified glare rating; `None` where no source is in sight or nothing lights the background.
    pub ugr: Option<f64>,
    /// Its standard error, from that of the background.
    pub standard_error: f64,
    /// Background luminance Lb, cd/m².
    pub background: f64,
    /// The sources in sight, in the order of the lights.
    pub sources: Vec<GlareSource>,
    /// Lights without a luminous area, which UGR does not know.
    pub left_out: u32,
}

/// A luminous surface as an eye sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GlareSource {
    /// Number of the light.
    pub light: u32,
    /// Mean luminance, cd/m².
    pub luminance: f64,
    /// Solid angle that is not hidden, sr.
    pub solid_angle: f64,
    /// Guth's position index.
    pub position_index: f64,
}

impl GlareSource {
    /// L² ω / p², cd²/m⁴ sr.
    pub fn term(&self) -> f64 {
        self.luminance * self.luminance * self.solid_angle / (self.position_index * self.position_index)
    }
}

/// The glare at `position` for the line of sight `direction`; `eye` is the reading of the illuminance there.
pub(super) fn glare(scene: &Scene, position: [f64; 3], direction: [f64; 3], up: [f64; 3], eye: &Reading) -> Glare {
    let sight = Vec3::from(direction).normalize();
    let surface = free_surface(narrow(Vec3::from(position)), &Response::Planar { normal: sight.to_array() });
    let (mut sources, mut left_out, mut sky) = (Vec::new(), 0, 0.0);
    for (number, light) in scene.lights.list().iter().enumerate() {
        let seen = Seen::of(scene, number as u32, light, &surface, sight);
        if light.is_infinite() {
            // sky and surroundings are background
            sky += seen.illuminance;
        } else if light.is_delta() {
            left_out += u32::from(seen.illuminance > 0.0);
        } else if seen.solid_angle > 0.0 && seen.toward.dot(sight) > 0.0 {
            sources.push(GlareSource {
                light: number as u32,
                luminance: seen.flux / seen.solid_angle,
                solid_angle: seen.solid_angle,
                position_index: guth_position_index(seen.toward, sight, Vec3::from(up)),
            });
        }
    }
    let background = (eye.indirect + sky) / PI;
    let sum: f64 = sources.iter().map(GlareSource::term).sum();
    let ugr = (sum > 0.0 && background > 0.0).then(|| 8.0 * (0.25 / background * sum).log10());
    // d UGR / d Lb = -8 / (Lb ln 10)
    let standard_error = ugr.map_or(0.0, |_| 8.0 / 10f64.ln() * eye.indirect_error / PI / background);
    Glare { ugr, standard_error, background, sources, left_out }
}

/// A light as it is seen from a point.
#[derive(Default)]
struct Seen {
    /// Solid angle that is not hidden, sr.
    solid_angle: f64,
    /// Integral of the luminance over it, cd/m² sr.
    flux: f64,
    /// Illuminance of the plane across the line of sight, lx.
    illuminance: f64,
    /// Sum of directions.
    toward: Vec3<f64>,
}

impl Seen {
    fn of(scene: &Scene, number: u32, light: &Light, surface: &Surface, sight: Vec3<f64>) -> Seen {
        let parts = scene.lights.part_count(number);
        let count = if light.is_delta() { 1 } else { (SAMPLES / parts.max(1)).max(SAMPLES_PER_PART) };
        let mut sampler = Sampler::new(number);
        let mut seen = Seen { toward: Vec3::ZERO, ..Seen::default() };
        for part in 0..parts {
            for index in 0..count {
                sampler.start(part, index);
                seen.add(scene, light, part, surface, sight, sampler.next2d(), 1.0 / f64::from(count));
            }
        }
        seen
    }

    #[allow(clippy::too_many_arguments)] // one point on a light: what it is, from where, how much it counts
    fn add(
        &mut self,
        scene: &Scene,
        light: &Light,
        part: u32,
        surface: &Surface,
        sight: Vec3<f64>,
        u: [f32; 2],
        share: f64,
    ) {
        let at = Receiver::opaque(surface.p, surface.ng);
        let Some(sample) = light.sample(part, &at, u) else { return };
        let toward = sample.wi.map(f64::from);
        let cosine = toward.dot(sight);
        if cosine <= 0.0 || sample.pdf <= 0.0 || scene.world.occluded(&sample.shadow_ray(surface)) {
            return;
        }
        let solid_angle = share / f64::from(sample.pdf);
        let luminance = f64::from(sample.value.luminance());
        self.solid_angle += solid_angle;
        self.flux += luminance * solid_angle;
        self.illuminance += luminance * cosine * solid_angle;
        self.toward = self.toward + toward * solid_angle;
    }
}

/// The position index of a source in direction `toward` for the line of sight `sight`, both of any length.
///
/// Above the line of sight Levin's formula, [`position_index`]; below it the one of Iwata & Tokura (*Position Index for a
/// Glare Source Located below the Line of Vision*, 1997). 16 at most, the greatest value of the table of CIE 117.
pub fn guth_position_index(toward: Vec3<f64>, sight: Vec3<f64>, up: Vec3<f64>) -> f64 {
    let sight = sight.normalize();
    let right = sight.cross(up).normalize();
    let above = right.cross(sight);
    let (ahead, side, height) = (toward.dot(sight), toward.dot(right), toward.dot(above));
    if ahead <= 0.0 {
        return 16.0;
    }
    let index = if height >= 0.0 {
        position_index(side, ahead, height)
    } else {
        let ratio = side.hypot(height) / ahead;
        1.0 + if ratio < 0.6 { 0.8 } else { 1.2 } * ratio
    };
    index.min(16.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use lesk_math::vec3;

    fn index(t: f64, h: f64) -> f64 {
        guth_position_index(vec3(t, 1.0, h), vec3(0.0, 1.0, 0.0), vec3(0.0, 0.0, 1.0))
    }

    #[test]
    fn position_index_is_that_of_the_table_of_cie_117() {
        // CIE 117, table of position indices by T/R and H/R; Levin's fit keeps within 5 % of it
        for (t, h, p) in [(0.0, 0.0, 1.0), (0.0, 0.5, 2.86), (0.0, 1.0, 7.0), (0.0, 1.5, 13.15), (0.0, 0.2, 1.53)] {
            assert!((index(t, h) / p - 1.0).abs() < 0.05, "T/R {t}, H/R {h}: {}", index(t, h));
        }
    }

    #[test]
    fn position_index_does_not_know_left_from_right_and_grows_with_the_angle() {
        for i in 0..20 {
            let (t, h) = (0.1 * f64::from(i), 0.3);
            assert_eq!(index(t, h), index(-t, h));
            assert!(index(0.1, 0.1 * f64::from(i + 1)) >= index(0.1, 0.1 * f64::from(i)));
        }
        // below the line of sight: Iwata & Tokura
        assert!((index(0.3, -0.4) - 1.4).abs() < 1e-12);
        assert!((index(0.6, -0.8) - 2.2).abs() < 1e-12);
    }
}
