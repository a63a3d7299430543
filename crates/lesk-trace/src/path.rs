//! One camera path: light from the lights, from surfaces and from the sky, weighted so that each way of finding it counts once.

use crate::split::{PathKind, SPLITS};
use lesk_bsdf::Scatter;
use lesk_bsdf::model::Domain;
use lesk_geometry::{Hit, Ray, Surface};
use lesk_image::Aov;
use lesk_light::Receiver;
use lesk_math::sobol::Sampler;
use lesk_math::{Color, Frame, Vec3};
use lesk_scene::{MAX_PARAMS, Material, RenderSettings, Scene, ShadowTerminator};

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
pub(crate) struct Found {
    /// Luminance along the camera ray, linear Rec.709, cd/m2.
    pub radiance: Color<f32>,
    /// The same, sorted by kind of path.
    pub splits: [Color<f32>; SPLITS],
    /// The first surface.
    pub aov: Option<Aov>,
}

/// Where a path stands.
struct Path<'a> {
    scene: &'a Scene,
    limits: Limits,
    throughput: Color<f32>,
    /// What refraction has done to the throughput, undone for the roulette: (eta_i/eta_o)^2 so far.
    eta_scale: f32,
    found: Found,
    kind: PathKind,
}

/// The last scattering event: what a hit on a light needs to know to weigh itself.
#[derive(Clone, Copy)]
struct Last {
    receiver: Receiver,
    /// Density of the direction in 1/sr.
    pdf: f32,
    /// Nothing but this ray can find the light: the camera, or a delta lobe.
    only: bool,
}

/// A surface with its material, as seen from `wo`.
struct Vertex<'a> {
    /// Where rays leave from.
    surface: Surface,
    /// Where light arrives: a point of the face, metres.
    at: Vec3<f32>,
    /// Tells the sides of the surface: its geometric normal, or the interpolated one where rays leave from raised points.
    side: Vec3<f32>,
    number: u32,
    material: &'a Material,
    model: &'static dyn Scatter,
    params: &'a [f32],
    frame: Frame<f32>,
    wo: Vec3<f32>,
}

/// Veach's power heuristic with exponent 2 (veach1997, section 9.2.4).
#[inline]
pub(crate) fn power_heuristic(a: f32, b: f32) -> f32 {
    // divide first: densities of narrow lobes overflow when squared
    let r = b / a;
    1.0 / (1.0 + r * r)
}

/// Follows a path from the camera.
pub(crate) fn trace(scene: &Scene, limits: Limits, ray: Ray, sampler: &mut Sampler) -> Found {
    let found = Found { radiance: Color::BLACK, splits: [Color::BLACK; SPLITS], aov: None };
    let mut path = Path { scene, limits, throughput: Color::WHITE, eta_scale: 1.0, found, kind: PathKind::camera() };
    path.run(ray, Last { receiver: Receiver::anywhere(ray.o), pdf: 0.0, only: true }, sampler);
    path.found
}

/// Follows a path that left a receiver of light along `ray`, drawn with the density `pdf` in 1/sr. The receiver asks the
/// lights itself; what the ray finds of them is weighed against that.
pub(crate) fn trace_from(
    scene: &Scene,
    limits: Limits,
    receiver: Receiver,
    ray: Ray,
    pdf: f32,
    sampler: &mut Sampler,
) -> Found {
    let found = Found { radiance: Color::BLACK, splits: [Color::BLACK; SPLITS], aov: None };
    let kind = PathKind::camera().then(false);
    let mut path = Path { scene, limits, throughput: Color::WHITE, eta_scale: 1.0, found, kind };
    path.run(ray, Last { receiver, pdf, only: false }, sampler);
    path.found
}

impl<'a> Path<'a> {
    fn run(&mut self, mut ray: Ray, mut last: Last, sampler: &mut Sampler) {
        let mut table = [0.0; MAX_PARAMS];
        for bounce in 0.. {
            let Some(hit) = self.scene.world.intersect(&ray) else {
                self.add_background(ray.d, &last);
                return;
            };
            let is_last = bounce >= self.limits.max_depth;
            let ends = is_last && bounce > 0;
            if ends && self.scene.objects[hit.instance as usize].light.is_none() {
                return;
            }
            let surface = self.scene.world.surface(&ray, &hit);
            self.add_emission(&surface, -ray.d, &last);
            if ends {
                return;
            }
            let Some(mut vertex) = Vertex::new(self.scene, surface, -ray.d, &mut table) else { return };
            if self.limits.raises && vertex.is_curved() {
                vertex.raise(self.scene, &hit);
            } else {
                vertex.side = vertex.surface.ng;
            }
            if is_last {
                self.record_first(&vertex, Color::BLACK, ray.d, hit.t);
                return;
            }
            // the first two are the best spread: they choose the point
            let [u_x, u_y, u_light, u_roulette] = sampler.next4d();
            self.add_light(&vertex, u_light, [u_x, u_y]);
            let drawn = vertex.draw(sampler.next3d());
            if bounce == 0 {
                let weight = drawn.map_or(Color::BLACK, |(_, weight, ..)| weight);
                self.record_first(&vertex, weight, ray.d, hit.t);
            }
            let Some((wi, weight, pdf, delta)) = drawn else { return };
            self.throughput = self.throughput * weight;
            self.eta_scale *= vertex.eta_scale(wi);
            self.kind = self.kind.then(delta);
            if !self.survives(bounce, u_roulette) {
                return;
            }
            last = Last { receiver: vertex.receiver(), pdf, only: delta };
            ray = Ray::leaving(&vertex.surface, wi);
        }
    }

    fn add(&mut self, light: Color<f32>, kind: PathKind) {
        let light = self.throughput * light;
        self.found.radiance = self.found.radiance + light;
        let slot = &mut self.found.splits[kind.split()];
        *slot = *slot + light;
    }

    fn add_background(&mut self, wi: Vec3<f32>, last: &Last) {
        let lights = &self.scene.lights;
        if last.only {
            self.add(lights.background(wi), self.kind);
            return;
        }
        let mut sum = Color::BLACK;
        for (value, pdf) in lights.escaped(&last.receiver, wi) {
            sum = sum + value * power_heuristic(last.pdf, pdf);
        }
        self.add(sum, self.kind);
    }

    fn add_emission(&mut self, surface: &Surface, wo: Vec3<f32>, last: &Last) {
        let Some(light) = self.scene.object(surface).light else { return };
        let emitted = self.scene.lights.emitted(light, surface, wo);
        if emitted == Color::BLACK {
            return;
        }
        let weight = if last.only {
            1.0
        } else {
            power_heuristic(last.pdf, self.scene.lights.pdf_surface(&last.receiver, light, surface))
        };
        self.add(emitted * weight, self.kind);
    }

    /// Light that is asked for directly (next-event estimation).
    fn add_light(&mut self, vertex: &Vertex, u_light: f32, u: [f32; 2]) {
        if !vertex.has_continuous_part() {
            return;
        }
        let Some(sample) = self.scene.lights.sample(&vertex.receiver(), u_light, u) else { return };
        let Some((f_cos, pdf)) = vertex.eval(sample.wi) else { return };
        if f_cos == Color::BLACK || self.scene.world.occluded(&sample.shadow_ray(&vertex.surface)) {
            return;
        }
        let weight = if sample.delta { 1.0 } else { power_heuristic(sample.pdf, pdf) };
        self.add(f_cos * sample.value * (weight / sample.pdf), self.kind.then(false));
    }

    fn survives(&mut self, bounce: u32, u: f32) -> bool {
        let strongest = self.throughput.max_component();
        if strongest <= 0.0 {
            return false;
        }
        if bounce + 1 < self.limits.roulette_depth {
            return true;
        }
        let q = (strongest * self.eta_scale).min(0.95);
        if u >= q {
            return false;
        }
        self.throughput = self.throughput / q;
        true
    }

    fn record_first(&mut self, vertex: &Vertex, weight: Color<f32>, d: Vec3<f32>, t: f32) {
        // the mean weight of a draw is the directional albedo
        let albedo = std::array::from_fn(|c| weight.0[c.min(lesk_math::CHANNELS - 1)]);
        self.found.aov = Some(Aov {
            albedo,
            normal: vertex.frame.n.to_array(),
            depth: t * d.length(),
            object: vertex.surface.instance + 1,
            material: vertex.number + 1,
        });
    }
}

/// Bends the shading normal by the normal map and gives both sets of texture coordinates.
#[inline(never)]
fn detailed(scene: &Scene, material: &Material, surface: &mut Surface, wo: Vec3<f32>) -> [[f32; 2]; 2] {
    let detail = scene.world.detail(surface);
    if let Some(map) = material.normal_map() {
        let bent = map.normal(surface, &detail);
        // bent away from the viewer it would show black
        if (bent.dot(wo) < 0.0) == (surface.ng.dot(wo) < 0.0) {
            surface.ns = bent;
        }
    }
    detail.uvs
}

impl<'a> Vertex<'a> {
    /// `None` where the surface scatters nothing towards `wo`: without a material, or the back of a one-sided one.
    #[inline]
    fn new(
        scene: &'a Scene,
        mut surface: Surface,
        wo: Vec3<f32>,
        table: &'a mut [f32; MAX_PARAMS],
    ) -> Option<Vertex<'a>> {
        let number = scene.object(&surface).material?;
        let material: &Material = &scene.materials[number as usize];
        let behind = surface.ng.dot(wo) < 0.0;
        let mut side = surface.ns;
        let uvs = if material.needs_detail() { detailed(scene, material, &mut surface, wo) } else { [surface.uv; 2] };
        if behind && material.domain() == Domain::Upper {
            if !material.two_sided() {
                return None;
            }
            surface.ng = -surface.ng;
            surface.ns = -surface.ns;
            side = -side;
        }
        // an interpolated normal that faces away from the viewer would leave a black edge: use the true one there
        if (surface.ns.dot(wo) > 0.0) != (surface.ng.dot(wo) > 0.0) {
            surface.ns = surface.ng;
            side = surface.ng;
        }
        let frame = surface.frame();
        let params = material.params_at(uvs, table);
        let wo = frame.local_from_world(wo);
        Some(Vertex { surface, at: surface.p, side, number, material, model: material.model(), params, frame, wo })
    }

    /// Whether the surface is opaque and its interpolated normal is not that of its face.
    #[inline]
    fn is_curved(&self) -> bool {
        self.side != self.surface.ng && self.material.domain() == Domain::Upper
    }

    /// Has rays leave from above the face, on the side of the viewer whatever their direction: what the face itself hides
    /// stays hidden.
    #[inline(never)]
    fn raise(&mut self, scene: &Scene, hit: &Hit) {
        let surface = &mut self.surface;
        surface.p = scene.world.raised(surface, hit) + surface.ng * surface.lift;
        surface.lift = 0.0;
    }

    #[inline]
    fn receiver(&self) -> Receiver {
        match self.material.domain() {
            Domain::Upper => Receiver::opaque(self.at, self.side),
            Domain::BothSides | Domain::Sphere => Receiver::anywhere(self.at),
        }
    }

    /// Models that scatter by delta lobes alone ask no light.
    #[inline]
    fn has_continuous_part(&self) -> bool {
        if !self.material.may_be_delta() {
            return true;
        }
        match self.model.delta(self.params, self.wo) {
            Some([a, b]) => a.probability + b.probability < 1.0,
            None => true,
        }
    }

    /// Whether the normals that shade and that tell sides agree on the side of `wi`; where they do not, light would leak.
    fn agrees(&self, wi: Vec3<f32>, wi_local: Vec3<f32>) -> bool {
        (self.side.dot(wi) > 0.0) == (wi_local.z > 0.0)
    }

    /// f |cos| and the density of drawing `wi`, if any light goes that way.
    fn eval(&self, wi: Vec3<f32>) -> Option<(Color<f32>, f32)> {
        let local = self.frame.local_from_world(wi);
        if !self.agrees(wi, local) {
            return None;
        }
        let (f, pdf) = self.model.eval_pdf(self.params, local, self.wo);
        Some((f * local.z.abs(), pdf))
    }

    /// Direction, weight, density, and whether a delta lobe was taken.
    fn draw(&self, u: [f32; 3]) -> Option<(Vec3<f32>, Color<f32>, f32, bool)> {
        let sample = self.model.draw(self.params, self.wo, u);
        let wi = self.frame.world_from_local(sample.wi);
        (sample.pdf > 0.0 && self.agrees(wi, sample.wi)).then_some((wi, sample.weight, sample.pdf, sample.delta > 0.5))
    }

    /// What a transmission into `wi` did to radiance, to be undone for the roulette: 1 for reflection.
    fn eta_scale(&self, wi: Vec3<f32>) -> f32 {
        if self.material.domain() != Domain::BothSides || self.frame.n.dot(wi) * self.wo.z > 0.0 {
            return 1.0;
        }
        let Some(ior) = self.material.ior_entry() else { return 1.0 };
        let eta = if self.wo.z > 0.0 { self.params[ior] } else { 1.0 / self.params[ior] };
        eta * eta
    }
}
