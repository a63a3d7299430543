//! Many paths side by side: all of them look for their next surface, then all ask the lights, then all go on.
//!
//! What one path finds does not depend on the others. Together they let surfaces, lights, random numbers and models be
//! computed by loops over arrays; rays take turns.

use crate::group::{Group, places};
use crate::lobes::Lobes;
use crate::path::{Found, Last, Limits, Path, power_heuristic};
use lesk_geometry::surfaces::{SURFACES, set_vector, vector};
use lesk_geometry::{Caster, Hit, Ray};
use lesk_light::{FarRectangles, Receiver};
use lesk_math::sobol::Sampler;
use lesk_math::{Color, Isa};
use lesk_scene::{MAX_PARAMS, Scene};

/// How many paths it pays to follow together.
pub(crate) const WAVE: usize = 256;

/// Paths that are followed together.
pub(crate) struct Wave<'a> {
    scene: &'a Scene,
    limits: Limits,
    isa: Isa,
    paths: Vec<Path>,
    /// Where the paths that go on go next, and their places in `paths`.
    rays: Vec<Ray>,
    of: Vec<u32>,
    hits: Vec<Option<Hit>>,
    caster: Caster,
    /// Where paths go on; the first `used` are those of this bounce.
    groups: Vec<Group>,
    used: usize,
    lobes: Lobes,
    far: FarRectangles,
    shadows: Shadows,
    found: Vec<Found>,
}

/// Light that arrives unless something stands in its way.
#[derive(Default)]
struct Shadows {
    rays: Vec<Ray>,
    /// The place of the path that asked, and the light.
    light: Vec<(u32, Color<f32>)>,
    occluded: Vec<bool>,
}

impl<'a> Wave<'a> {
    pub fn new(scene: &'a Scene, limits: Limits) -> Self {
        Wave {
            scene,
            limits,
            isa: Isa::current(),
            paths: Vec::new(),
            rays: Vec::new(),
            of: Vec::new(),
            hits: Vec::new(),
            caster: Caster::default(),
            groups: Vec::new(),
            used: 0,
            lobes: Lobes::new(&scene.materials),
            far: FarRectangles::default(),
            shadows: Shadows::default(),
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
        self.push(Path::camera(last, sampler), ray);
    }

    /// Adds a path that left a receiver of light along `ray`, drawn with the density `pdf` in 1/sr. The receiver asks the
    /// lights itself; what the ray finds of them is weighed against that.
    pub fn add_from(&mut self, receiver: Receiver, ray: Ray, pdf: f32, sampler: Sampler) {
        let last = Last { receiver, pdf, only: false };
        self.push(Path::receiver(last, sampler), ray);
    }

    fn push(&mut self, path: Path, ray: Ray) {
        self.of.push(self.paths.len() as u32);
        self.paths.push(path);
        self.rays.push(ray);
    }

    /// Follows all paths to their ends; what each found, in the order in which they were added.
    pub fn follow(&mut self) -> &[Found] {
        let count = self.paths.len();
        self.found.resize(self.found.len().max(count), Found::NOTHING);
        self.found[..count].iter_mut().for_each(|found| *found = Found::NOTHING);
        for bounce in 0.. {
            if self.rays.is_empty() {
                break;
            }
            self.scene.world.intersect_all(&self.rays, &mut self.caster, &mut self.hits);
            self.arrive(bounce);
            self.ask_lights();
            self.go_on(bounce);
        }
        self.paths.clear();
        &self.found[..count]
    }

    /// Adds what shines where the rays end, and makes the vertices of the paths that go on.
    fn arrive(&mut self, bounce: u32) {
        self.used = 0;
        self.lobes.clear();
        let ends = bounce > 0 && bounce >= self.limits.max_depth;
        let mut which = [0; SURFACES];
        let mut count = 0;
        for i in 0..self.rays.len() {
            let Some(hit) = &self.hits[i] else {
                let path = self.of[i] as usize;
                self.paths[path].add_background(self.scene, self.rays[i].d, &mut self.found[path]);
                continue;
            };
            if ends && self.scene.objects[hit.instance as usize].light.is_none() {
                continue;
            }
            which[count] = i as u32;
            count += 1;
            if count == SURFACES {
                self.settle(bounce, &which);
                count = 0;
            }
        }
        if count > 0 {
            self.settle(bounce, &which[..count]);
        }
    }

    /// The same for a group of rays that hit something.
    fn settle(&mut self, bounce: u32, which: &[u32]) {
        if self.used == self.groups.len() {
            self.groups.push(Group::default());
        }
        let (scene, group) = (self.scene, &mut self.groups[self.used]);
        let (rays, hits) = (&self.rays, &self.hits);
        let met = which.iter().filter_map(|&i| Some((&rays[i as usize], hits[i as usize].as_ref()?)));
        group.start(scene, met.clone());
        let is_last = bounce >= self.limits.max_depth;
        let mut uvs = [[[0.0; 2]; 2]; SURFACES];
        for (i, (ray, hit)) in met.clone().enumerate() {
            group.path[i] = self.of[which[i] as usize];
            let object = &scene.objects[hit.instance as usize];
            if let Some(light) = object.light {
                let path = group.path[i] as usize;
                self.paths[path].add_emission(scene, light, &group.surfaces.get(i), -ray.d, &mut self.found[path]);
            }
            if let Some(number) = object.material.filter(|_| !is_last || bounce == 0) {
                uvs[i] = group.set_material(i, scene, number, -ray.d);
            }
        }
        if group.alive == 0 {
            return;
        }
        group.turn(self.isa);
        for (i, (ray, hit)) in met.enumerate() {
            if group.alive >> i & 1 == 0 {
                continue;
            }
            let material = &scene.materials[group.number[i] as usize];
            if group.is_black(i, material) {
                group.alive &= !(1 << i);
                continue;
            }
            let mut table = [0.0; MAX_PARAMS];
            let params = material.params_at(uvs[i], &mut table);
            group.set_params(i, material, params);
            group.set_origin(i, scene, hit, self.limits.raises);
            if bounce == 0 {
                self.found[group.path[i] as usize].aov = Some(group.aov(i, hit.t * ray.d.length()));
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
        self.scene.world.occluded_all(&shadows.rays, &mut self.caster, &mut shadows.occluded);
        for (occluded, (path, light)) in shadows.occluded.iter().zip(&shadows.light) {
            if !occluded {
                let (path, found) = (&self.paths[*path as usize], &mut self.found[*path as usize]);
                path.add(*light, path.kind.then(false), found);
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
        self.of.clear();
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
                    self.found[group.path[i] as usize].set_albedo(weight);
                }
                path.scatter(weight, group.eta_scale(i), delta);
                if path.survives(bounce, group.u_roulette(i), &self.limits) {
                    path.last = Last { receiver: group.receiver(i), pdf, only: delta };
                    self.of.push(group.path[i]);
                    self.rays.push(Ray::new(vector(&group.origin, i), vector(&group.wi, i)));
                }
            }
        }
    }
}
