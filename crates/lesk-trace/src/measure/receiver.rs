//! One sample of one reading: the lights asked directly, and a path for everything else.

use crate::path::{Found, power_heuristic};
use crate::wave::Wave;
use lesk_geometry::{Ray, Surface};
use lesk_light::Receiver;
use lesk_math::sobol::Sampler;
use lesk_math::{Color, Frame, Vec3, warp};
use lesk_scene::Scene;
use lesk_scene::sensor::{Probe, Reading, Response};
use std::f32::consts::FRAC_1_PI;

/// How far a plane starts its rays above its points, per metre of their coordinates: a plane that lies on a surface shall
/// not be hidden by it. 80 roundings of f32.
const LIFT: f32 = 1e-5;

/// A probe, ready for samples.
pub(super) enum Meter {
    /// Light from many directions, lx.
    Illuminance { surface: Surface, receiver: Receiver, weights: Weights },
    /// Light along the rays of a cone, cd/m².
    Luminance { origin: Vec3<f32>, frame: Frame<f32>, versine: f32 },
    /// The ray of a camera met nothing.
    Nothing,
}

/// A response in a frame of its own: +z is its normal or axis, +x its facing.
pub(super) struct Weights {
    frame: Frame<f32>,
    kind: Kind,
}

#[derive(Clone, Copy)]
enum Kind {
    Planar,
    Cylindrical,
    Semicylindrical,
    Spherical,
    Hemispherical,
}

impl Weights {
    fn new(response: &Response) -> Weights {
        let (kind, axis, facing) = match *response {
            Response::Planar { normal } => (Kind::Planar, normal, None),
            Response::Cylindrical { axis } => (Kind::Cylindrical, axis, None),
            Response::Semicylindrical { axis, facing } => (Kind::Semicylindrical, axis, Some(facing)),
            Response::Spherical => (Kind::Spherical, [0.0, 0.0, 1.0], None),
            Response::Hemispherical { normal } => (Kind::Hemispherical, normal, None),
        };
        let axis = narrow(Vec3::from(axis));
        let frame = match facing {
            Some(facing) => Frame::from_normal_tangent(axis, narrow(Vec3::from(facing))),
            None => Frame::from_normal(axis),
        };
        Weights { frame, kind }
    }

    /// How much a direction counts; the formulas are those of `lesk_scene::sensor::Response`.
    fn weight(&self, w: Vec3<f32>) -> f32 {
        let local = self.frame.local_from_world(w);
        // sin of the angle to the axis
        let across = (local.x * local.x + local.y * local.y).sqrt();
        match self.kind {
            Kind::Planar => local.z.max(0.0),
            Kind::Cylindrical => across * FRAC_1_PI,
            // sin(angle to the axis) (1 + cos(azimuth)) / pi
            Kind::Semicylindrical => (across + local.x).max(0.0) * FRAC_1_PI,
            Kind::Spherical => 0.25,
            Kind::Hemispherical => 0.25 * (1.0 + local.z),
        }
    }

    /// A direction and its density in 1/sr: by the cosine for a plane, else uniform.
    fn draw(&self, u: [f32; 2]) -> (Vec3<f32>, f32) {
        let local = match self.kind {
            Kind::Planar => warp::cosine_hemisphere::sample(u),
            _ => warp::uniform_sphere::sample(u),
        };
        (self.frame.world_from_local(local), self.pdf(local))
    }

    fn pdf(&self, local: Vec3<f32>) -> f32 {
        match self.kind {
            Kind::Planar => local.z.max(0.0) * FRAC_1_PI,
            _ => 0.25 * FRAC_1_PI,
        }
    }
}

impl Meter {
    pub fn new(scene: &Scene, probe: &Probe) -> Meter {
        let p = narrow(probe.position);
        match &probe.reading {
            Reading::Illuminance(response) => Meter::illuminance(free_surface(p, response), response),
            Reading::Luminance { direction, half_angle } => {
                // 1 - cos a = 2 sin²(a/2) keeps its digits for narrow cones
                let versine = 2.0 * (0.5 * half_angle).sin().powi(2);
                let frame = Frame::from_normal(narrow(*direction));
                Meter::Luminance { origin: p, frame, versine: versine as f32 }
            }
            Reading::SurfaceIlluminance { direction } => {
                let ray = Ray::new(p, narrow(*direction));
                let Some(hit) = scene.world.intersect(&ray) else { return Meter::Nothing };
                let mut surface = scene.world.surface(&ray, &hit);
                if surface.ng.dot(ray.d) > 0.0 {
                    surface.ng = -surface.ng;
                }
                let normal = surface.ng.map(f64::from).to_array();
                Meter::illuminance(surface, &Response::Planar { normal })
            }
        }
    }

    fn illuminance(surface: Surface, response: &Response) -> Meter {
        let receiver = match response {
            Response::Planar { .. } => Receiver::opaque(surface.p, surface.ng),
            _ => Receiver::anywhere(surface.p),
        };
        Meter::Illuminance { surface, receiver, weights: Weights::new(response) }
    }

    /// Begins a sample: asks the lights, and adds to the wave the path that looks for everything else.
    pub fn start(&self, wave: &mut Wave, mut sampler: Sampler) -> Start {
        let number = wave.len();
        match self {
            Meter::Nothing => Start { asked: 0.0, path: None },
            Meter::Luminance { origin, frame, versine } => {
                let local = match *versine > 0.0 {
                    true => warp::uniform_cone::sample(*versine, sampler.next2d()),
                    false => Vec3::Z,
                };
                wave.add(Ray::new(*origin, frame.world_from_local(local)), sampler);
                Start { asked: 0.0, path: Some((number, 1.0)) }
            }
            Meter::Illuminance { surface, receiver, weights } => {
                let asked = ask_lights(wave.scene(), surface, receiver, weights, &mut sampler);
                let (wi, pdf) = weights.draw(sampler.next2d());
                let weight = f64::from(weights.weight(wi) / pdf);
                if weight.is_nan() || pdf <= 0.0 {
                    return Start { asked, path: None };
                }
                wave.add_from(*receiver, Ray::leaving(surface, wi), pdf, sampler);
                Start { asked, path: Some((number, weight)) }
            }
        }
    }
}

/// A sample whose path waits to be followed.
pub(super) struct Start {
    /// Light of the lights that were asked, lx.
    asked: f64,
    /// The number of the path in the wave, and how much of its light counts.
    path: Option<(usize, f64)>,
}

impl Start {
    /// Direct and all other light of the sample, by what the paths of its wave found.
    pub fn light(&self, found: &[Found]) -> [f64; 2] {
        let Some((number, weight)) = self.path else { return [self.asked, 0.0] };
        let found = &found[number];
        let of = |light: Color<f32>| f64::from(light.luminance()) * weight;
        let (direct, all) = (self.asked + of(found.splits[0]), self.asked + of(found.radiance));
        [direct, (all - direct).max(0.0)]
    }
}

/// Light of one light that was chosen for this sample.
fn ask_lights(scene: &Scene, surface: &Surface, receiver: &Receiver, weights: &Weights, sampler: &mut Sampler) -> f64 {
    let [u_x, u_y, u_light, _] = sampler.next4d();
    let Some(sample) = scene.lights.sample(receiver, u_light, [u_x, u_y]) else { return 0.0 };
    let weight = weights.weight(sample.wi);
    if weight <= 0.0 || scene.world.occluded(&sample.shadow_ray(surface)) {
        return 0.0;
    }
    let share = match sample.delta {
        true => 1.0,
        false => power_heuristic(sample.pdf, weights.pdf(weights.frame.local_from_world(sample.wi))),
    };
    f64::from(sample.value.luminance()) * f64::from(weight * share) / f64::from(sample.pdf)
}

/// A point in the air that receives light.
pub(super) fn free_surface(p: Vec3<f32>, response: &Response) -> Surface {
    let reach = 1.0 + p.x.abs().max(p.y.abs()).max(p.z.abs());
    let (n, lift) = match response {
        Response::Planar { normal } => (narrow(Vec3::from(*normal)), LIFT * reach),
        _ => (Vec3::Z, 0.0),
    };
    let dpdu = Frame::from_normal(n).t;
    Surface { p, ng: n, ns: n, uv: [0.0; 2], dpdu, lift, instance: u32::MAX, prim: 0 }
}

pub(super) fn narrow(v: Vec3<f64>) -> Vec3<f32> {
    v.map(|x| x as f32)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn every_response_reads_pi_under_a_uniform_unit_sky() {
        let up = [0.0, 0.6, 0.8];
        for response in [
            Response::Planar { normal: up },
            Response::Cylindrical { axis: up },
            Response::Semicylindrical { axis: up, facing: [0.0, 0.8, -0.6] },
            Response::Spherical,
            Response::Hemispherical { normal: up },
        ] {
            let weights = Weights::new(&response);
            let n = 256;
            let mut sum = 0.0;
            for i in 0..n * n {
                let u = [(i % n) as f32 + 0.5, (i / n) as f32 + 0.5].map(|x| x / n as f32);
                let (w, pdf) = weights.draw(u);
                sum += f64::from(weights.weight(w) / pdf);
            }
            let mean = sum / f64::from(n * n);
            // the midpoint rule at 256 x 256 points: about 1e-4 at the poles of sin
            assert!((mean / PI - 1.0).abs() < 2e-4, "{response:?}: {mean}");
        }
    }
}
