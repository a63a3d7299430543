//! Where some paths meet surfaces: the surfaces, their frames and materials, what light they ask for, and how they are left.
//!
//! What all of them do alike runs in loops over arrays, which the compiler vectorises.

use crate::path::Path;
use lesk_bsdf::model::Domain;
use lesk_geometry::surfaces::{Row, SURFACES, Surfaces, VectorRows, set_vector, vector};
use lesk_geometry::{Hit, Ray, Surface};
use lesk_image::Aov;
use lesk_light::{FarRectangles, LightSample, Receiver};
use lesk_math::sobol::Sampler;
use lesk_math::{CHANNELS, Channels, Color, Frame, Isa, Vec3, for_isa, vec3};
use lesk_scene::{Material, Scene};

/// Vertices of paths, up to [`SURFACES`] of them.
#[derive(Default)]
pub(crate) struct Group {
    /// The vertices that scatter: bit i for place i.
    pub alive: u32,
    /// The place of each path in the wave.
    pub path: [u32; SURFACES],
    /// The number of each material in the scene.
    pub number: [u32; SURFACES],
    /// The place among the vertices with the same model.
    pub lane: [u32; SURFACES],
    /// With opaque surfaces turned to the viewer; `p` is where light arrives.
    pub surfaces: Surfaces,
    /// Where rays leave from, metres.
    from: VectorRows,
    /// The direction to the viewer: in the world, then in the frame.
    pub wo: VectorRows,
    /// 1 for opaque surfaces, whose back scatters as their front does, else 0.
    opaque: [u32; SURFACES],
    /// 1 where the viewer was behind the surface, else 0.
    behind: [u32; SURFACES],
    /// Tells the sides of the surface: the interpolated normal without normal map, then the normal of the face where rays
    /// leave from the face itself.
    side: VectorRows,
    /// Tangents of the frame around the shading normal.
    t: VectorRows,
    b: VectorRows,
    /// Refractive index of surfaces that bound a body, else 1.
    ior: Row,
    /// Whether anything but delta lobes scatters: only then light is asked for.
    rough: [bool; SURFACES],
    /// Two sets of numbers in [0, 1): for the point on a light, the choice of a light, and whether the path goes on; for the
    /// direction in which it goes on.
    u: [[Row; 4]; 2],
    pub asked: Asked,
    /// Directions drawn: in the frame, then in the world.
    pub wi: VectorRows,
    /// 1 where a direction drawn is on the same side for all normals, else 0.
    pub agrees: [u32; SURFACES],
    /// Where the rays along them begin, metres.
    pub origin: VectorRows,
}

/// Answers of lights.
#[derive(Default)]
pub(crate) struct Asked {
    /// Directions to the lights in the frames.
    pub wi: VectorRows,
    /// Radiance times cosine over density; illuminance times cosine over probability of delta lights.
    value: [Row; CHANNELS],
    /// Density in 1/sr, 0 without an answer; infinite for delta lights, which no other way finds.
    pub pdf: Row,
    /// The rays that must be free: origin, direction with its length, and end.
    o: VectorRows,
    d: VectorRows,
    t_max: Row,
}

impl Group {
    /// Takes the next surfaces.
    pub fn start<'a>(&mut self, scene: &Scene, hits: impl Iterator<Item = (&'a Ray, &'a Hit)>) {
        self.alive = 0;
        scene.world.surfaces(hits, &mut self.surfaces);
        self.side = self.surfaces.ns;
    }

    /// The material of a place, as seen from `wo`; gives texture coordinates of both sets.
    #[inline]
    pub fn set_material(&mut self, i: usize, scene: &Scene, number: u32, wo: Vec3<f32>) -> [[f32; 2]; 2] {
        let material = &scene.materials[number as usize];
        self.number[i] = number;
        self.alive |= 1 << i;
        set_vector(&mut self.wo, i, wo);
        self.opaque[i] = u32::from(material.domain() == Domain::Upper);
        if material.needs_detail() {
            return self.bend(i, scene, material, wo);
        }
        [[self.surfaces.uv[0][i], self.surfaces.uv[1][i]]; 2]
    }

    /// Bends the shading normal by the normal map and gives both sets of texture coordinates.
    #[inline(never)]
    fn bend(&mut self, i: usize, scene: &Scene, material: &Material, wo: Vec3<f32>) -> [[f32; 2]; 2] {
        let surface = self.surfaces.get(i);
        let detail = scene.world.detail(&surface);
        if let Some(map) = material.normal_map() {
            let bent = map.normal(&surface, &detail);
            // bent away from the viewer it would show black
            if (bent.dot(wo) < 0.0) == (surface.ng.dot(wo) < 0.0) {
                set_vector(&mut self.surfaces.ns, i, bent);
            }
        }
        detail.uvs
    }

    /// Turns opaque surfaces to the viewer, makes their frames and brings `wo` into them.
    pub fn turn(&mut self, isa: Isa) {
        let this = self;
        for_isa!(isa, Group::turn_lanes, this: &mut Group);
    }

    #[inline(always)]
    fn turn_lanes(&mut self) {
        for i in 0..SURFACES {
            let wo = vector(&self.wo, i);
            let (ng, ns, side) = (vector(&self.surfaces.ng, i), vector(&self.surfaces.ns, i), vector(&self.side, i));
            let behind = ng.dot(wo) < 0.0;
            let sign = if behind & (self.opaque[i] != 0) { -1.0 } else { 1.0 };
            let (ng, ns, side) = (ng * sign, ns * sign, side * sign);
            // an interpolated normal that faces away from the viewer would leave a black edge: use the true one there
            let faces = (ns.dot(wo) > 0.0) == (ng.dot(wo) > 0.0);
            let (ns, side) = (Vec3::select(faces, ns, ng), Vec3::select(faces, side, ng));
            let frame = Frame::from_normal_tangent(ns, vector(&self.surfaces.dpdu, i));
            self.behind[i] = u32::from(behind);
            set_vector(&mut self.surfaces.ng, i, ng);
            set_vector(&mut self.surfaces.ns, i, ns);
            set_vector(&mut self.side, i, side);
            set_vector(&mut self.t, i, frame.t);
            set_vector(&mut self.b, i, frame.b);
            set_vector(&mut self.wo, i, frame.local_from_world(wo));
        }
        self.from = self.surfaces.p;
    }

    /// Whether a place shows the back of a surface that scatters on its front only.
    #[inline]
    pub fn is_black(&self, i: usize, material: &Material) -> bool {
        self.behind[i] & self.opaque[i] != 0 && !material.two_sided()
    }

    /// What the parameters say about a vertex.
    #[inline]
    pub fn set_params(&mut self, i: usize, material: &Material, params: &[f32]) {
        let bounds_body = material.domain() == Domain::BothSides;
        self.ior[i] = material.ior_entry().filter(|_| bounds_body).map_or(1.0, |entry| params[entry]);
        self.rough[i] = !material.may_be_delta() || has_continuous_part(material, params, vector(&self.wo, i));
    }

    /// Where rays leave from. With `raises`, on curved opaque meshes that is above the face, on the side of the viewer
    /// whatever their direction: what the face itself hides stays hidden.
    #[inline]
    pub fn set_origin(&mut self, i: usize, scene: &Scene, hit: &Hit, raises: bool) {
        let ng = vector(&self.surfaces.ng, i);
        if raises && self.opaque[i] != 0 && vector(&self.side, i) != ng {
            self.raise(i, scene, hit);
        } else {
            set_vector(&mut self.side, i, ng);
        }
    }

    #[inline(never)]
    fn raise(&mut self, i: usize, scene: &Scene, hit: &Hit) {
        let surface = self.surfaces.get(i);
        set_vector(&mut self.from, i, scene.world.raised(&surface, hit) + surface.ng * surface.lift);
        self.surfaces.lift[i] = 0.0;
    }

    /// As the first surface of a path, `depth` metres from the camera.
    pub fn aov(&self, i: usize, depth: f32) -> Aov {
        Aov {
            albedo: [0.0; 3],
            normal: vector(&self.surfaces.ns, i).to_array(),
            depth,
            object: self.surfaces.instance[i] + 1,
            material: self.number[i] + 1,
        }
    }

    #[inline]
    pub fn receiver(&self, i: usize) -> Receiver {
        let p = vector(&self.surfaces.p, i);
        if self.opaque[i] != 0 { Receiver::opaque(p, vector(&self.side, i)) } else { Receiver::anywhere(p) }
    }

    /// Draws the random numbers of this bounce.
    pub fn draw_numbers(&mut self, paths: &mut [Path], isa: Isa) {
        let mut samplers = [Sampler::new(0); SURFACES];
        for i in places(self.alive) {
            samplers[i] = paths[self.path[i] as usize].sampler;
        }
        self.u = Sampler::next4d_all(&mut samplers, isa);
        for i in places(self.alive) {
            paths[self.path[i] as usize].sampler = samplers[i];
        }
    }

    /// The number that decides whether the path goes on.
    #[inline]
    pub fn u_roulette(&self, i: usize) -> f32 {
        self.u[0][3][i]
    }

    /// The numbers that choose the direction in which the path goes on.
    #[inline]
    pub fn u_direction(&self, i: usize) -> Vec3<f32> {
        let [x, y, z, _] = &self.u[1];
        vec3(x[i], y[i], z[i])
    }

    /// Asks one light for each vertex.
    pub fn ask(&mut self, scene: &Scene, far: &mut FarRectangles, isa: Isa) {
        let (mut noted, mut others) = (0, [None; SURFACES]);
        for i in places(self.alive) {
            if !self.rough[i] {
                continue;
            }
            // the first two are the best spread: they choose the point
            let [u_x, u_y, u_light, _] = self.u[0].each_ref().map(|row| row[i]);
            match scene.lights.sample_or_note(&self.receiver(i), u_light, [u_x, u_y], i, far) {
                Some(lesk_light::Answer::Noted) => noted |= 1 << i,
                Some(lesk_light::Answer::Sample(sample)) => others[i] = Some(sample),
                None => {}
            }
        }
        if noted != 0 {
            far.sample(isa);
            let (this, far) = (&mut *self, &*far);
            for_isa!(isa, Group::connect_lanes, this: &mut Group, far: &FarRectangles);
        }
        for i in places(self.alive & !noted) {
            match &others[i] {
                Some(sample) => self.connect(i, sample),
                None => self.asked.pdf[i] = 0.0,
            }
        }
        for i in places(self.alive) {
            // a direction that every model knows, where there is no answer
            if self.asked.pdf[i] <= 0.0 {
                set_vector(&mut self.asked.wi, i, Vec3::Z);
            }
        }
    }

    /// The rays to the points of rectangles, as [`Ray::to_sample`] makes them.
    #[inline(always)]
    fn connect_lanes(&mut self, far: &FarRectangles) {
        for i in 0..SURFACES {
            let (p, n) = (vector(&far.p, i), vector(&far.n, i));
            let surface = Surface {
                lift: self.surfaces.lift[i],
                ..Surface::at(vector(&self.from, i), vector(&self.surfaces.ng, i))
            };
            let ray = Ray::to_lifted(&surface, p, n, far.lift[i]);
            let wi = vector(&far.wi, i);
            let local = self.frame(i).local_from_world(wi);
            let agrees = (vector(&self.side, i).dot(wi) > 0.0) == (local.z > 0.0);
            let factor = local.z.abs() / far.pdf[i];
            set_vector(&mut self.asked.wi, i, local);
            for c in 0..CHANNELS {
                self.asked.value[c][i] = far.value[c][i] * factor;
            }
            self.asked.pdf[i] = if agrees { far.pdf[i] } else { 0.0 };
            set_vector(&mut self.asked.o, i, ray.o);
            set_vector(&mut self.asked.d, i, ray.d);
            self.asked.t_max[i] = ray.t_max;
        }
    }

    /// The ray to any other light.
    fn connect(&mut self, i: usize, sample: &LightSample) {
        let wi = sample.wi;
        let local = self.frame(i).local_from_world(wi);
        let surface = Surface { p: vector(&self.from, i), ..self.surfaces.get(i) };
        let ray = sample.shadow_ray(&surface);
        let value = sample.value * (local.z.abs() / sample.pdf);
        let agrees = (vector(&self.side, i).dot(wi) > 0.0) == (local.z > 0.0);
        let pdf = if sample.delta { f32::INFINITY } else { sample.pdf };
        let asked = &mut self.asked;
        asked.pdf[i] = if agrees { pdf } else { 0.0 };
        set_vector(&mut asked.wi, i, local);
        for c in 0..CHANNELS {
            asked.value[c][i] = value.0[c];
        }
        set_vector(&mut asked.o, i, ray.o);
        set_vector(&mut asked.d, i, ray.d);
        asked.t_max[i] = ray.t_max;
    }

    /// Brings the directions drawn into the world and finds where the rays along them begin.
    pub fn leave(&mut self, isa: Isa) {
        let this = self;
        for_isa!(isa, Group::leave_lanes, this: &mut Group);
    }

    #[inline(always)]
    fn leave_lanes(&mut self) {
        for i in 0..SURFACES {
            let local = vector(&self.wi, i);
            let wi = self.frame(i).world_from_local(local);
            let ng = vector(&self.surfaces.ng, i);
            self.agrees[i] = u32::from((vector(&self.side, i).dot(wi) > 0.0) == (local.z > 0.0));
            let lift = self.surfaces.lift[i].copysign(ng.dot(wi));
            set_vector(&mut self.wi, i, wi);
            set_vector(&mut self.origin, i, vector(&self.from, i) + ng * lift);
        }
    }

    /// The shading frame of a vertex.
    #[inline(always)]
    fn frame(&self, i: usize) -> Frame<f32> {
        Frame { t: vector(&self.t, i), b: vector(&self.b, i), n: vector(&self.surfaces.ns, i) }
    }

    /// What a transmission into the direction drawn did to radiance, to be undone for the roulette: 1 for reflection.
    #[inline]
    pub fn eta_scale(&self, i: usize) -> f32 {
        let is_outside = self.wo[2][i] > 0.0;
        let passes = vector(&self.surfaces.ns, i).dot(vector(&self.wi, i)) * self.wo[2][i] <= 0.0;
        if !passes {
            return 1.0;
        }
        let eta = if is_outside { self.ior[i] } else { 1.0 / self.ior[i] };
        eta * eta
    }
}

impl Asked {
    /// Radiance times cosine over density.
    #[inline]
    pub fn value(&self, i: usize) -> Color<f32> {
        Channels(std::array::from_fn(|c| self.value[c][i]))
    }

    /// The ray that must be free.
    #[inline]
    pub fn ray(&self, i: usize) -> Ray {
        Ray { o: vector(&self.o, i), d: vector(&self.d, i), t_min: 0.0, t_max: self.t_max[i] }
    }
}

/// The numbers of the bits that are set.
#[inline]
pub(crate) fn places(mut bits: u32) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let i = bits.trailing_zeros() as usize;
        (bits != 0).then(|| {
            bits &= bits - 1;
            i
        })
    })
}

/// Whether anything but delta lobes scatters towards `wo`.
fn has_continuous_part(material: &Material, params: &[f32], wo: Vec3<f32>) -> bool {
    let lobes = material.model().delta(params, wo);
    lobes.is_none_or(|[a, b]| a.probability + b.probability < 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use lesk_bsdf::registry::find;

    #[test]
    fn what_glass_does_to_radiance_is_undone_for_the_roulette() {
        let glass = find("dielectric").unwrap();
        let material = Material::new("glass", glass, &[1.5], false);
        let mut group = Group::default();
        for side in [1.0, -1.0] {
            let wo = vec3(0.0, 0.6, 0.8 * side);
            set_vector(&mut group.wo, 0, wo);
            set_vector(&mut group.surfaces.ns, 0, Vec3::Z);
            group.set_params(0, &material, &[1.5]);
            let mut passed = 0;
            for i in 0..100 {
                let drawn = glass.draw(&[1.5], wo, [0.5, 0.5, (i as f32 + 0.5) / 100.0]);
                set_vector(&mut group.wi, 0, drawn.wi);
                // smooth glass absorbs nothing: the weight is the probability over itself, times the change of radiance
                let undone = drawn.weight.0[0] * group.eta_scale(0);
                assert!((undone - 1.0).abs() < 1e-5, "{side} {i}: {undone}");
                passed += usize::from(drawn.wi.z * side < 0.0);
            }
            // from within, 37 degrees still pass
            assert!(passed > 50, "{passed} of 100 draws pass");
        }
    }
}
