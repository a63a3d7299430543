//! What one camera path carries and finds: light from the lights, from surfaces and from the sky, weighted so that each way
//! of finding it counts once.

use crate::split::{PathKind, SPLITS};
use lesk_geometry::Surface;
use lesk_image::Aov;
use lesk_light::Receiver;
use lesk_math::sobol::Sampler;
use lesk_math::{CHANNELS, Color, Vec3};
use lesk_scene::{RenderSettings, Scene, ShadowTerminator};

/// How long paths may become, and where they go on from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Limits {
    /// Scattering events at most; 0 shows lights only, 1 adds direct light.
    pub max_depth: u32,
    /// Scattering events after which dim paths end by chance (Russian roulette).
    pub roulette_depth: u32,
    /// Whether rays leave opaque faces with interpolated normals from raised points.
    pub raises: bool,
}

impl Limits {
    /// What the settings say.
    pub fn of(render: &RenderSettings) -> Limits {
        let raises = render.shadow_terminator == ShadowTerminator::Hanika;
        Limits { max_depth: render.max_depth, roulette_depth: render.roulette_depth, raises }
    }
}

/// What one path found.
#[derive(Clone)]
pub(crate) struct Found {
    /// Luminance along the camera ray, linear Rec.709, cd/m2.
    pub radiance: Color<f32>,
    /// The same, sorted by kind of path.
    pub splits: [Color<f32>; SPLITS],
    /// The first surface.
    pub aov: Option<Aov>,
}

/// Where a path stands.
#[derive(Clone, Copy)]
pub(crate) struct Path {
    pub throughput: Color<f32>,
    /// What refraction has done to the throughput, undone for the roulette: (eta_i/eta_o)^2 so far.
    eta_scale: f32,
    pub kind: PathKind,
    pub last: Last,
    pub sampler: Sampler,
}

/// The last scattering event: what a hit on a light needs to know to weigh itself.
#[derive(Clone, Copy)]
pub(crate) struct Last {
    pub receiver: Receiver,
    /// Density of the direction in 1/sr.
    pub pdf: f32,
    /// Nothing but this ray can find the light: the camera, or a delta lobe.
    pub only: bool,
}

/// Veach's power heuristic with exponent 2 (veach1997, section 9.2.4).
#[inline]
pub(crate) fn power_heuristic(a: f32, b: f32) -> f32 {
    // divide first: densities of narrow lobes overflow when squared
    let r = b / a;
    1.0 / (1.0 + r * r)
}

impl Found {
    pub const NOTHING: Found = Found { radiance: Color::BLACK, splits: [Color::BLACK; SPLITS], aov: None };

    /// The mean weight of a draw is the directional albedo of the first surface.
    pub fn set_albedo(&mut self, weight: Color<f32>) {
        if let Some(aov) = &mut self.aov {
            aov.albedo = std::array::from_fn(|c| weight.0[c.min(CHANNELS - 1)]);
        }
    }
}

impl Path {
    /// A path from the camera.
    pub fn camera(last: Last, sampler: Sampler) -> Path {
        Path::new(last, PathKind::camera(), sampler)
    }

    /// A path from a receiver of light.
    pub fn receiver(last: Last, sampler: Sampler) -> Path {
        Path::new(last, PathKind::camera().then(false), sampler)
    }

    fn new(last: Last, kind: PathKind, sampler: Sampler) -> Path {
        let (throughput, eta_scale) = (Color::WHITE, 1.0);
        Path { throughput, eta_scale, kind, last, sampler }
    }

    /// Adds light that arrives by a path of this kind.
    pub fn add(&self, light: Color<f32>, kind: PathKind, found: &mut Found) {
        let light = self.throughput * light;
        found.radiance = found.radiance + light;
        let slot = &mut found.splits[kind.split()];
        *slot = *slot + light;
    }

    /// Adds what shines beyond the scene.
    pub fn add_background(&self, scene: &Scene, wi: Vec3<f32>, found: &mut Found) {
        let last = &self.last;
        if last.only {
            self.add(scene.lights.background(wi), self.kind, found);
            return;
        }
        let mut sum = Color::BLACK;
        for (value, pdf) in scene.lights.escaped(&last.receiver, wi) {
            sum = sum + value * power_heuristic(last.pdf, pdf);
        }
        self.add(sum, self.kind, found);
    }

    /// Adds what the surface of a light sends into `wo`.
    pub fn add_emission(&self, scene: &Scene, light: u32, surface: &Surface, wo: Vec3<f32>, found: &mut Found) {
        let emitted = scene.lights.emitted(light, surface, wo);
        if emitted == Color::BLACK {
            return;
        }
        let weight = if self.last.only {
            1.0
        } else {
            power_heuristic(self.last.pdf, scene.lights.pdf_surface(&self.last.receiver, light, surface))
        };
        self.add(emitted * weight, self.kind, found);
    }

    /// One more scattering event.
    pub fn scatter(&mut self, weight: Color<f32>, eta_scale: f32, delta: bool) {
        self.throughput = self.throughput * weight;
        self.eta_scale *= eta_scale;
        self.kind = self.kind.then(delta);
    }

    /// Whether the path goes on; dim ones end by the chance `u` in [0, 1).
    pub fn survives(&mut self, bounce: u32, u: f32, limits: &Limits) -> bool {
        let strongest = self.throughput.max_component();
        if strongest <= 0.0 {
            return false;
        }
        if bounce + 1 < limits.roulette_depth {
            return true;
        }
        // twice the throughput: good for diffuse and for glossy scenes (docs/decisions/0007)
        let q = (2.0 * strongest * self.eta_scale).min(0.95);
        if u >= q {
            return false;
        }
        self.throughput = self.throughput / q;
        true
    }
}
