//! Many paths side by side: all of them look for their next surface, then all ask the lights, then all go on.
//!
//! What one path finds does not depend on the others. Together they let surfaces, lights, random numbers and models be
//! computed by loops over arrays; rays are cast one by one.

use crate::group::{Group, places};
use crate::lobes::Lobes;
use crate::path::{Found, Last, Limits, Path, power_heuristic};
use lesk_geometry::surfaces::{SURFACES, set_vector, vector};
use lesk_geometry::{Hit, Ray};
use lesk_light::{FarRectangles, Receiver};
use lesk_math::sobol::Sampler;
use lesk_math::{Color, Isa, Vec3};
use lesk_scene::{MAX_PARAMS, Scene};

/// How many paths it pays to follow together.
pub(crate) const WAVE: usize = 256;

/// Paths that are followed together.
pub(crate) struct Wave<'a> {
    scene: &'a Scene,
    limits: Limits,
    isa: Isa,
    paths: Vec<Path>,
    /// Where each path goes next.
    rays: Vec<Ray>,
    hits: Vec<Option<Hit>>,
    /// Where paths go on; the first `used` are those of this bounce.
    groups: Vec<Group>,
    used: usize,
    lobes: Lobes,
    far: FarRectangles,
    shadows: Shadows,
    /// The paths that go on.
    next: Vec<Path>,
    found: Vec<Found>,
}

/// Rays that hit something, and the places of their paths.
struct Arrivals {
    len: usize,
    paths: [u32; SURFACES],
    rays: [Ray; SURFACES],
    hits: [Hit; SURFACES],
}

/// Light that arrives unless something stands in its way.
#[derive(Default)]
struct Shadows {
    rays: Vec<Ray>,
    /// The place of the path that asked, and the light.
    light: Vec<(u32, Color<f32>)>,
}

impl<'a> Wave<'a> {
    pub fn new(scene: &'a Scene, limits: Limits) -> Self {
        Wave {
            scene,
            limits,
            isa: Isa::current(),
            paths: Vec::new(),
            rays: Vec::new(),
            hits: Vec::new(),
            groups: Vec::new(),
            used: 0,
            lobes: Lobes::new(&scene.materials),
            far: FarRectangles::default(),
            shadows: Shadows::default(),
            next: Vec::new(),
            found: Vec::new(),
        }
    }

    pub fn scene(&self) -> &'a Scene {
        self.scene
    }

    /// How many paths wait for [`follow`](Self::follow).
    pub fn len(&self) -> usize {
        self.paths.len()
    }

    /// Adds a path from the camera, with the random numbers that `sampler` gives from here on.
    pub fn add(&mut self, ray: Ray, sampler: Sampler) {
        let last = Last { receiver: Receiver::anywhere(ray.o), pdf: 0.0, only: true };
        self.push(Path::camera(self.len(), last, sampler), ray);
    }

    /// Adds a path that left a receiver of light along `ray`, drawn with the density `pdf` in 1/sr. The receiver asks the
    /// lights itself; what the ray finds of them is weighed against that.
    pub fn add_from(&mut self, receiver: Receiver, ray: Ray, pdf: f32, sampler: Sampler) {
        let last = Last { receiver, pdf, only: false };
        self.push(Path::receiver(self.len(), last, sampler), ray);
    }

    fn push(&mut self, path: Path, ray: Ray) {
        self.paths.push(path);
        self.rays.push(ray);
    }

    /// Follows all paths to their ends; what each found, in the order in which they were added.
    pub fn follow(&mut self) -> &[Found] {
        self.found.clear();
        self.found.resize(self.paths.len(), Found::NOTHING);
        for bounce in 0.. {
            if self.paths.is_empty() {
                break;
            }
            self.hits.clear();
            self.hits.extend(self.rays.iter().map(|ray| self.scene.world.intersect(ray)));
            self.arrive(bounce);
            self.ask_lights();
            self.go_on(bounce);
        }
        &self.found
    }

    /// Adds what shines where the rays end, and makes the vertices of the paths that go on.
    fn arrive(&mut self, bounce: u32) {
        self.used = 0;
        self.lobes.clear();
        let ends = bounce > 0 && bounce >= self.limits.max_depth;
        let mut arrivals = Arrivals::default();
        for i in 0..self.paths.len() {
            let (path, ray) = (&self.paths[i], &self.rays[i]);
            let Some(hit) = &self.hits[i] else {
                path.add_background(self.scene, ray.d, &mut self.found[path.number as usize]);
                continue;
            };
            if ends && self.scene.objects[hit.instance as usize].light.is_none() {
                continue;
            }
            arrivals.add(i, *ray, *hit);
            if arrivals.len == SURFACES {
                self.settle(bounce, &arrivals);
                arrivals.len = 0;
            }
        }
        if arrivals.len > 0 {
            self.settle(bounce, &arrivals);
        }
    }

    /// The same for a group of rays that hit something.
    fn settle(&mut self, bounce: u32, arrivals: &Arrivals) {
        if self.used == self.groups.len() {
            self.groups.push(Group::default());
        }
        let (scene, group) = (self.scene, &mut self.groups[self.used]);
        let (rays, hits) = (&arrivals.rays[..arrivals.len], &arrivals.hits[..arrivals.len]);
        group.start(scene, rays, hits);
        group.path = arrivals.paths;
        let is_last = bounce >= self.limits.max_depth;
        let mut uvs = [[[0.0; 2]; 2]; SURFACES];
        for (i, (ray, hit)) in rays.iter().zip(hits).enumerate() {
            let object = &scene.objects[hit.instance as usize];
            if let Some(light) = object.light {
                let path = &self.paths[group.path[i] as usize];
                let found = &mut self.found[path.number as usize];
                path.add_emission(scene, light, &group.surfaces.get(i), -ray.d, found);
            }
            if let Some(number) = object.material.filter(|_| !is_last || bounce == 0) {
                uvs[i] = group.set_material(i, scene, number, -ray.d);
            }
        }
        if group.alive == 0 {
            return;
        }
        group.turn(self.isa);
        for i in places(group.alive) {
            let material = &scene.materials[group.number[i] as usize];
            if group.is_black(i, material) {
                group.alive &= !(1 << i);
                continue;
            }
            let mut table = [0.0; MAX_PARAMS];
            let params = material.params_at(uvs[i], &mut table);
            group.set_params(i, material, params);
            group.set_origin(i, scene, &hits[i], self.limits.raises);
            if bounce == 0 {
                let path = &self.paths[group.path[i] as usize];
                self.found[path.number as usize].aov = Some(group.aov(i, hits[i].t * rays[i].d.length()));
            }
            if !is_last {
                group.lane[i] = self.lobes.push(group.number[i], vector(&group.wo, i), params);
            }
        }
        // a path that is seen only goes no further
        self.used += usize::from(!is_last);
    }

    /// Light that is asked for directly (next-event estimation).
    fn ask_lights(&mut self) {
        for group in &mut self.groups[..self.used] {
            group.draw_numbers(&mut self.paths, self.isa);
            group.ask(self.scene, &mut self.far, self.isa);
            for i in places(group.alive) {
                self.lobes.of(group.number[i]).set_first(group.lane[i], vector(&group.asked.wi, i));
            }
        }
        self.lobes.eval();
        let shadows = &mut self.shadows;
        shadows.rays.clear();
        shadows.light.clear();
        for group in &self.groups[..self.used] {
            for i in places(group.alive) {
                let pdf = group.asked.pdf[i];
                let (f, other_pdf) = self.lobes.of(group.number[i]).f_and_pdf(group.lane[i]);
                if pdf > 0.0 && f != Color::BLACK {
                    shadows.rays.push(group.asked.ray(i));
                    let weight = power_heuristic(pdf, other_pdf);
                    shadows.light.push((group.path[i], f * group.asked.value(i) * weight));
                }
            }
        }
        for (ray, (path, light)) in shadows.rays.iter().zip(&shadows.light) {
            if !self.scene.world.occluded(ray) {
                let path = &self.paths[*path as usize];
                path.add(*light, path.kind.then(false), &mut self.found[path.number as usize]);
            }
        }
    }

    /// Draws the directions in which the paths go on.
    fn go_on(&mut self, bounce: u32) {
        for group in &self.groups[..self.used] {
            for i in places(group.alive) {
                self.lobes.of(group.number[i]).set_first(group.lane[i], group.u_direction(i));
            }
        }
        self.lobes.draw();
        self.next.clear();
        self.rays.clear();
        for group in &mut self.groups[..self.used] {
            for i in places(group.alive) {
                let wi = self.lobes.of(group.number[i]).drawn_wi(group.lane[i]);
                set_vector(&mut group.wi, i, wi);
            }
            group.leave(self.isa);
            for i in places(group.alive) {
                let (weight, pdf, delta) = self.lobes.of(group.number[i]).drawn(group.lane[i]);
                if pdf <= 0.0 || group.agrees[i] == 0 {
                    continue;
                }
                let path = &mut self.paths[group.path[i] as usize];
                if bounce == 0 {
                    self.found[path.number as usize].set_albedo(weight);
                }
                path.scatter(weight, group.eta_scale(i), delta);
                if path.survives(bounce, group.u_roulette(i), &self.limits) {
                    path.last = Last { receiver: group.receiver(i), pdf, only: delta };
                    self.next.push(*path);
                    self.rays.push(Ray::new(vector(&group.origin, i), vector(&group.wi, i)));
                }
            }
        }
        std::mem::swap(&mut self.paths, &mut self.next);
    }
}

impl Default for Arrivals {
    fn default() -> Self {
        let ray = Ray::new(Vec3::ZERO, Vec3::Z);
        Arrivals { len: 0, paths: [0; SURFACES], rays: [ray; SURFACES], hits: [Hit::default(); SURFACES] }
    }
}

impl Arrivals {
    #[inline]
    fn add(&mut self, path: usize, ray: Ray, hit: Hit) {
        (self.paths[self.len], self.rays[self.len], self.hits[self.len]) = (path as u32, ray, hit);
        self.len += 1;
    }
}
