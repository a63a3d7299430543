//! Light at points: the direct term of every material, or the classic local model.

use crate::classic::{ambient_term, color, light_term};
use crate::lanes::{Lanes, Points, Sides, Work};
use crate::lights::{Source, at, sources};
use crate::{Classic, ClassicLight, Mode, Settings, Space};
use lesk_bsdf::batch::Target;
use lesk_bsdf::kernels::{BLOCK, Block, Kernel, Vectors};
use lesk_bsdf::model::{Domain, Property};
use lesk_geometry::{Detail, Ray, Surface, World};
use lesk_image::tonemap::srgb_decode;
use lesk_math::{CHANNELS, Color, Isa, Vec3};
use lesk_scene::{MAX_PARAMS, Material, NormalMap, Scene, ShadowTerminator};
use std::f32::consts::FRAC_1_PI;

/// Surfaces that are shaded alike: one material, one light that they are.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Kind {
    pub material: Option<u32>,
    pub light: Option<u32>,
}

/// Everything that shading needs, shared between threads.
pub(crate) struct Shader<'a> {
    scene: &'a Scene,
    classic: Option<&'a Classic>,
    sources: Vec<Source>,
    pub lanes: Lanes,
    pub isa: Isa,
    eye: Vec3<f32>,
    renormalize: bool,
    space: Space,
    /// Whether interpolated normals tell which lights an opaque face sees, and rays start raised.
    smooth: bool,
    /// Whether points stand for whole faces, which may be bent: rays start above them.
    flat: bool,
    /// What is in the way of light, where shadows are wanted.
    obstacles: Option<&'a World>,
}

impl<'a> Shader<'a> {
    pub fn new(scene: &'a Scene, settings: &'a Settings, eye: Vec3<f32>, obstacles: Option<&'a World>) -> Self {
        let isa = Isa::current();
        let classic = settings.classic.as_ref();
        let own = |c: &Classic| {
            let light =
                |l: &ClassicLight| Source::Parallel(l.direction.normalize().to_array(), color(|c| l.color[c]).0);
            c.lights.iter().map(light).collect()
        };
        let sources = match classic {
            Some(classic) if !classic.lights.is_empty() => own(classic),
            _ => sources(scene, settings.quadrature),
        };
        Shader {
            scene,
            classic,
            sources,
            lanes: Lanes::for_isa(isa),
            isa,
            eye,
            renormalize: settings.renormalize,
            space: settings.space,
            smooth: settings.shadow_terminator.unwrap_or(scene.render.shadow_terminator) == ShadowTerminator::Hanika,
            flat: settings.shading == Mode::Flat,
            obstacles,
        }
    }

    /// Whether rays to lights want to start raised.
    pub fn raises(&self) -> bool {
        self.smooth && self.obstacles.is_some()
    }

    /// The material of a kind of surface, where materials count.
    fn material(&self, kind: Kind) -> Option<&'a Material> {
        kind.material.filter(|_| self.classic.is_none()).map(|m| &self.scene.materials[m as usize])
    }

    /// Whether texture coordinates, and whether tangents matter to a kind of surface.
    pub fn needs(&self, kind: Kind) -> [bool; 2] {
        match self.material(kind) {
            Some(m) => [!m.bindings().is_empty() || m.normal_map().is_some(), !is_isotropic(m)],
            None => [false; 2],
        }
    }

    /// Whether a normal map bends the normals of a kind of surface.
    pub fn is_mapped(&self, kind: Kind) -> bool {
        self.material(kind).is_some_and(|m| m.normal_map().is_some())
    }

    /// Light towards the viewer, into `work.sum`. `back` says of vertices whether their face shows its back; other points
    /// have the normal of a face, which tells.
    pub fn shade(&self, kind: Kind, back: Option<bool>, points: &mut Points, work: &mut Work) {
        work.sum.iter_mut().for_each(|row| row[..points.n].fill(0.0));
        let material = kind.material.map(|m| &self.scene.materials[m as usize]);
        let transmits = self.classic.is_none() && material.is_some_and(Material::transmits);
        let sides = Sides {
            transmits,
            smooth: self.smooth && !transmits,
            two_sided: self.classic.is_some() || material.is_none_or(Material::two_sided),
            renormalize: self.renormalize,
            anisotropic: self.needs(kind)[1],
            mapped: self.is_mapped(kind),
            classic: self.classic.is_some(),
            back,
        };
        let front: Vec<Vec3<f32>> = match kind.light {
            Some(_) => (0..points.n).map(|i| at(&points.ng, i)).collect(),
            None => Vec::new(),
        };
        if let Some(map) = material.and_then(Material::normal_map).filter(|_| sides.mapped) {
            self.bend(map, points);
        }
        self.lanes.orient(points, work, self.eye.to_array(), sides);
        match (self.classic, material) {
            (Some(classic), _) => self.classic(classic, points, work),
            (None, Some(material)) => self.model(material, points, work, transmits),
            (None, None) => {}
        }
        if let Some(light) = kind.light {
            for (i, &n) in front.iter().enumerate() {
                let surface = Surface::at(at(&points.p, i), n);
                let emitted = self.scene.lights.emitted(light, &surface, at(&work.wo, i));
                (0..CHANNELS).for_each(|c| work.sum[c][i] += emitted.0[c]);
            }
        }
    }

    /// Bends normals by a map, as the path tracer does; `side` keeps them as they were.
    fn bend(&self, map: &NormalMap, points: &mut Points) {
        for i in 0..points.n {
            let (p, ng) = (at(&points.p, i), at(&points.ng, i));
            let ns = at(&points.ns, i).normalize();
            // fails for NaN too
            let ns = if ns.dot(ng) > 1e-4 { ns } else { ng };
            let uv = [points.uv[0][i], points.uv[1][i]];
            let surface = Surface { ns, uv, ..Surface::at(p, ng) };
            let along = at(&points.along, i);
            let tangent = if along == Vec3::ZERO { surface.frame().t } else { along.normalize() };
            let bitangent = ns.cross(tangent).normalize() * points.hand[i];
            let bent = map.normal(&surface, &Detail { uvs: [uv; 2], tangent, bitangent });
            let wo = self.eye - p;
            // bent away from the viewer it would show black
            let usable = (bent.dot(wo) < 0.0) == (ng.dot(wo) < 0.0);
            let bent = if usable { bent } else { ns };
            for c in 0..3 {
                points.side[c][i] = ns.to_array()[c];
                points.ns[c][i] = bent.to_array()[c];
            }
        }
    }

    fn model(&self, material: &Material, points: &Points, work: &mut Work, transmits: bool) {
        let model = material.model();
        let kernel = model.kernels().for_isa(self.isa).eval;
        let mut params = [0.0; MAX_PARAMS];
        let uniform = material.bindings().is_empty();
        let (values, rows);
        let views: Vec<&[f32]> = if uniform {
            values = material.params([0.0; 2], &mut params);
            values.iter().map(std::slice::from_ref).collect()
        } else {
            rows = varying(material, points);
            rows.iter().map(Vec::as_slice).collect()
        };
        for source in &self.sources {
            source.ask(self.scene, &self.lanes, points, work, transmits);
            self.darken(source, points, work, transmits);
            self.lanes.local(points, work);
            evaluate(kernel, points.n, &views, uniform, work);
            self.lanes.add(points.n, work);
        }
    }

    fn classic(&self, classic: &Classic, points: &Points, work: &mut Work) {
        let bridge = if classic.lights.is_empty() { FRAC_1_PI } else { 1.0 };
        let mut sums = [ambient_term(classic); BLOCK];
        for source in &self.sources {
            // the model knows no face, so neither do the lights
            source.ask(self.scene, &self.lanes, points, work, true);
            self.darken(source, points, work, true);
            for (i, sum) in sums[..points.n].iter_mut().enumerate() {
                let mut light = Color::BLACK;
                (0..CHANNELS).for_each(|c| light.0[c] = work.value[c][i] * bridge);
                // not brought to unit length again where that is not wanted
                let n = at(&points.ns, i) * work.length[i];
                *sum = *sum + light_term(classic, n, at(&work.wi, i), at(&work.wo, i), light);
            }
        }
        for (i, sum) in sums[..points.n].iter().enumerate() {
            (0..CHANNELS).for_each(|c| work.sum[c][i] = sum.0[c]);
        }
    }

    /// Takes the light away from points that do not see it.
    fn darken(&self, source: &Source, points: &Points, work: &mut Work, transmits: bool) {
        let Some(world) = self.obstacles else { return };
        let raised = self.classic.is_some() || (self.smooth || self.flat) && !transmits;
        for i in 0..points.n {
            if (0..CHANNELS).all(|c| work.value[c][i] == 0.0) || work.alive[i] == 0.0 {
                continue;
            }
            let mut surface = Surface::at(at(&points.p, i), at(&points.ng, i));
            if raised {
                // on the side of the viewer, whatever the direction: what the face itself hides stays hidden
                let start = if self.smooth || self.flat { at(&points.origin, i) } else { surface.p };
                (surface.p, surface.lift) = (start + surface.ng * surface.lift, 0.0);
            }
            let wi = at(&work.wi, i);
            let ray = match source {
                Source::Point(p, _) => Ray::to_point(&surface, (*p).into()),
                Source::Parallel(..) => Ray::leaving(&surface, wi),
                Source::Asked { .. } => {
                    match source.sample(self.scene, at(&points.p, i), at(&points.side, i), transmits) {
                        Some(sample) => sample.shadow_ray(&surface),
                        None => continue,
                    }
                }
            };
            if world.occluded(&ray) {
                (0..CHANNELS).for_each(|c| work.value[c][i] = 0.0);
            }
        }
    }

    /// Light from outside the scene along a ray; `None` where there is none at all.
    pub fn background(&self) -> Option<impl Fn(Vec3<f32>) -> Color<f32> + use<'_, 'a>> {
        use lesk_light::Light;
        let shows = |l: &Light| matches!(l, Light::Environment(_) | Light::Sky(_));
        let any = self.classic.is_none() && self.scene.lights.list().iter().any(shows);
        any.then_some(|d| self.scene.lights.background(d))
    }

    /// The mean weight of eight draws, which approaches the albedo towards the viewer.
    pub fn albedo(&self, kind: Kind, points: &Points, work: &Work, i: usize) -> [f32; 3] {
        const DRAWS: u32 = 8;
        let Some(m) = kind.material else { return [0.0; 3] };
        let material = &self.scene.materials[m as usize];
        let mut params = [0.0; MAX_PARAMS];
        let params = material.params([points.uv[0][i], points.uv[1][i]], &mut params);
        let wo = at(&work.wo_local, i);
        let mut sum = [0.0; 3];
        for k in 0..DRAWS {
            // a rank-1 lattice with the plastic numbers
            let u = [0.819_172_5, 0.671_043_6, 0.549_700_5].map(|a: f32| (0.5 + a * k as f32).fract());
            let weight = material.model().draw(params, wo, u).weight;
            (0..3).for_each(|c| sum[c] += weight.0[c.min(CHANNELS - 1)] / DRAWS as f32);
        }
        sum
    }

    /// What a sum of light shows, where sums are codes of a screen; `white` has the code 1.
    pub fn show(&self, sum: [f32; 3], white: f32) -> [f32; 3] {
        match self.space {
            Space::Linear => sum,
            Space::Gamma => sum.map(|v| srgb_decode((v / white).clamp(0.0, 1.0)) * white),
        }
    }
}

/// Whether its model does not know directions along the surface.
pub(crate) fn is_isotropic(material: &Material) -> bool {
    let claims = material.model().model().claims;
    claims.iter().any(|c| c.property == Property::Isotropic && c.when.is_none())
        || material.model().model().domain == Domain::BothSides
}

fn evaluate(kernel: Kernel, n: usize, params: &[&[f32]], uniform: bool, work: &mut Work) {
    let (wi, wo) = (&work.wi_local, &work.wo_local);
    let [wi, wo] = [wi, wo].map(|w| [&w[0][..n], &w[1][..n], &w[2][..n]]);
    let block = Block { start: 0, n, params, uniform, first: Vectors::Planes(wi), wo: Vectors::Planes(wo) };
    let mut targets = work.f.each_mut().map(|row| Target::Row(&mut row[..n]));
    // SAFETY: the kernel is one of an instruction set that this processor has
    unsafe { kernel(&block, &mut targets, false) };
}

/// Parameters of the model at the points of a block, one row each.
fn varying(material: &Material, points: &Points) -> Vec<Vec<f32>> {
    let mut params = [0.0; MAX_PARAMS];
    let mut rows = vec![vec![0.0; points.n]; material.model().param_count()];
    for i in 0..points.n {
        let values = material.params([points.uv[0][i], points.uv[1][i]], &mut params);
        rows.iter_mut().zip(values).for_each(|(row, &v)| row[i] = v);
    }
    rows
}
