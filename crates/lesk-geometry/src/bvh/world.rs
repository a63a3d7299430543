//! The surfaces of a scene, ready for rays.

use super::build::{Item, Items, build};
use super::traverse::{Best, LocalRay, NoOthers, Others, Portable, walk};
use super::tree::Tree;
#[cfg(target_arch = "x86_64")]
use super::turns::{TURNS, Turns};
use crate::bounds::Bounds;
use crate::detail::Detail;
use crate::error::{Error, Result};
use crate::mesh::Mesh;
use crate::ray::{Hit, Ray};
use crate::shapes::{AreaSampler, Geometry, shape_intersect};
use crate::surface::{Surface, curved_surface, triangle_surface};
use crate::transform::{Transform, narrow, widen};
use lesk_math::{Isa, Vec3};

/// A mesh of at most this many triangles is copied into the world tree for every instance.
const COPIED_TRIANGLES: usize = 16;

/// Collects geometries and their instances.
///
/// ```
/// use lesk_geometry::{Geometry, Ray, Transform, WorldBuilder};
/// use lesk_math::vec3;
/// let mut builder = WorldBuilder::new();
/// let sphere = builder.geometry(Geometry::Sphere);
/// let ball = builder.instance(sphere, Transform::translate(0.0, 0.0, 5.0))?;
/// let world = builder.build()?;
/// let ray = Ray::new(vec3(0.0, 0.0, 0.0), vec3(0.0, 0.0, 1.0));
/// let hit = world.intersect(&ray).unwrap();
/// assert_eq!((hit.instance, hit.t), (ball, 4.0));
/// let surface = world.surface(&ray, &hit);
/// assert!(!world.occluded(&Ray::leaving(&surface, surface.ng)));
/// # Ok::<(), lesk_geometry::Error>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct WorldBuilder {
    geometries: Vec<Geometry>,
    instances: Vec<Instance>,
    isa: Option<Isa>,
}

/// A geometry at a place.
#[derive(Clone, Copy, Debug)]
struct Instance {
    geometry: u32,
    /// Whether `place` is not the identity.
    moved: bool,
    place: Transform,
}

impl WorldBuilder {
    /// Nothing yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a geometry and returns its number; it shows only where it has an instance.
    pub fn geometry(&mut self, geometry: Geometry) -> u32 {
        self.geometries.push(geometry);
        self.geometries.len() as u32 - 1
    }

    /// Places a geometry and returns the number of the instance.
    ///
    /// # Errors
    /// A number that [`geometry`](Self::geometry) did not return; more than 2^28 instances; a place whose coordinates
    /// f32 cannot hold.
    pub fn instance(&mut self, geometry: u32, world_from_local: Transform) -> Result<u32> {
        let number = self.instances.len();
        let Some(shape) = self.geometries.get(geometry as usize) else {
            let count = self.geometries.len();
            return Err(Error::new(format!("instance of geometry {geometry}, but there are {count} (counted from 0)")));
        };
        let bounds = shape.bounds().transformed(&world_from_local);
        let limit = crate::mesh::MAX_COORDINATE;
        if !(bounds.is_empty() || bounds.reach() <= limit) {
            return Err(Error::new(format!(
                "instance {number} reaches to coordinate {:e}, up to {limit:e} is accepted",
                bounds.reach()
            ))
            .hint("the scene unit is the metre"));
        }
        if number >= super::tree::Child::LIMIT {
            return Err(Error::new(format!("scene has more than {number} instances")));
        }
        let moved = world_from_local != Transform::IDENTITY;
        self.instances.push(Instance { geometry, moved, place: world_from_local });
        Ok(number as u32)
    }

    /// Uses the given instruction set instead of [`Isa::current`]; one that is not available counts as the baseline.
    #[must_use]
    pub fn isa(mut self, isa: Isa) -> Self {
        self.isa = Some(isa);
        self
    }

    /// Builds the trees.
    ///
    /// # Errors
    /// More than 2^28 triangles and instances together.
    pub fn build(self) -> Result<World> {
        let mut uses = vec![0usize; self.geometries.len()];
        self.instances.iter().for_each(|i| uses[i.geometry as usize] += 1);
        let mut parts = Parts::new(&self.geometries, &self.instances);
        let mut lower: Vec<Option<Tree>> = vec![None; self.geometries.len()];
        for (number, instance) in self.instances.iter().enumerate() {
            let g = instance.geometry as usize;
            let Some(mesh) = self.geometries[g].mesh() else {
                parts.others.push(number as u32);
                continue;
            };
            if uses[g] == 1 || mesh.triangles().len() <= COPIED_TRIANGLES {
                parts.copy(number as u32, mesh.triangles().len())?;
            } else {
                if lower[g].is_none() {
                    lower[g] = Some(build(&Own(mesh))?);
                }
                parts.others.push(number as u32);
            }
        }
        let upper = build(&parts)?;
        let Parts { copies, others, .. } = parts;
        let isa = self.isa.unwrap_or_else(Isa::current);
        Ok(World {
            isa: if isa.is_available() { isa } else { Isa::Baseline },
            geometries: self.geometries,
            instances: self.instances,
            upper,
            lower,
            copies,
            others,
        })
    }
}

/// The triangles of one mesh in its own space.
struct Own<'a>(&'a Mesh);

impl Items for Own<'_> {
    fn len(&self) -> usize {
        self.0.triangles().len()
    }
    fn other_count(&self) -> usize {
        0
    }
    fn item(&self, index: u32) -> Item {
        Item::Triangle(self.0.corners(index as usize), index)
    }
}

/// What the world tree holds: first copied triangles, then everything else.
struct Parts<'a> {
    geometries: &'a [Geometry],
    instances: &'a [Instance],
    /// First number and instance of each copied mesh.
    copies: Vec<(u32, u32)>,
    triangles: usize,
    others: Vec<u32>,
}

impl<'a> Parts<'a> {
    fn new(geometries: &'a [Geometry], instances: &'a [Instance]) -> Self {
        Parts { geometries, instances, copies: vec![], triangles: 0, others: vec![] }
    }

    fn copy(&mut self, instance: u32, triangles: usize) -> Result<()> {
        if triangles > 0 {
            self.copies.push((self.triangles as u32, instance));
            self.triangles += triangles;
        }
        if self.triangles >= super::tree::Child::LIMIT {
            return Err(Error::new(format!("scene has {} triangles or more", self.triangles)));
        }
        Ok(())
    }
}

impl Items for Parts<'_> {
    fn len(&self) -> usize {
        self.triangles + self.others.len()
    }

    fn other_count(&self) -> usize {
        self.others.len()
    }

    fn item(&self, index: u32) -> Item {
        if (index as usize) < self.triangles {
            let (number, prim) = owner(&self.copies, index);
            let instance = &self.instances[number as usize];
            let corners = self.geometries[instance.geometry as usize].mesh().map(|m| m.corners(prim as usize));
            let corners = corners.expect("only meshes are copied").map(|p| instance.place.point(p));
            return Item::Triangle(corners, index);
        }
        let other = index - self.triangles as u32;
        let instance = &self.instances[self.others[other as usize] as usize];
        let bounds = self.geometries[instance.geometry as usize].bounds().transformed(&instance.place);
        Item::Other(bounds, other)
    }
}

/// The instance that a number of the world tree belongs to, and the triangle in it.
fn owner(copies: &[(u32, u32)], id: u32) -> (u32, u32) {
    let at = copies.partition_point(|&(first, _)| first <= id) - 1;
    (copies[at].1, id - copies[at].0)
}

/// All surfaces of a scene. Shared between threads; never changes.
#[derive(Clone, Debug)]
pub struct World {
    geometries: Vec<Geometry>,
    instances: Vec<Instance>,
    upper: Tree,
    /// Trees of the geometries that are instanced.
    lower: Vec<Option<Tree>>,
    copies: Vec<(u32, u32)>,
    others: Vec<u32>,
    /// Available on this processor.
    isa: Isa,
}

/// Room for the work of casting many rays at once.
#[derive(Default)]
pub struct Caster {
    #[cfg(target_arch = "x86_64")]
    turns: Option<Turns>,
}

/// `source` of hits in the world tree; an instance has its number plus one.
const UPPER: u32 = 0;

impl World {
    /// The nearest surface along the ray. Of several at exactly the same distance, always the same one.
    #[inline]
    pub fn intersect(&self, ray: &Ray) -> Option<Hit> {
        let mut best = Best::none(ray.t_max);
        self.cast::<false>(ray, &mut best).then(|| self.hit(&best))
    }

    /// Whether anything lies on the ray.
    #[inline]
    pub fn occluded(&self, ray: &Ray) -> bool {
        self.cast::<true>(ray, &mut Best::none(ray.t_max))
    }

    /// The nearest surface along each ray, as [`intersect`](Self::intersect) finds it.
    pub fn intersect_all(&self, rays: &[Ray], caster: &mut Caster, hits: &mut Vec<Option<Hit>>) {
        hits.clear();
        #[cfg(target_arch = "x86_64")]
        if self.isa == Isa::Avx512 {
            for rays in rays.chunks(TURNS) {
                let turns = self.take_turns::<false>(rays, caster);
                let hit = |i: usize| turns.best(&self.upper, i).map(|best| self.hit(&best));
                hits.extend((0..rays.len()).map(hit));
            }
            return;
        }
        let _ = caster;
        hits.extend(rays.iter().map(|ray| self.intersect(ray)));
    }

    /// Whether anything lies on each ray, as [`occluded`](Self::occluded) finds it.
    pub fn occluded_all(&self, rays: &[Ray], caster: &mut Caster, occluded: &mut Vec<bool>) {
        occluded.clear();
        #[cfg(target_arch = "x86_64")]
        if self.isa == Isa::Avx512 {
            for rays in rays.chunks(TURNS) {
                let turns = self.take_turns::<true>(rays, caster);
                occluded.extend((0..rays.len()).map(|i| turns.is_improved(i)));
            }
            return;
        }
        let _ = caster;
        occluded.extend(rays.iter().map(|ray| self.occluded(ray)));
    }

    #[cfg(target_arch = "x86_64")]
    fn take_turns<'a, const ANY: bool>(&self, rays: &[Ray], caster: &'a mut Caster) -> &'a Turns {
        let visit = |i: usize, index: u32, best: &mut Best| {
            let ray = &rays[i];
            Entered::<ANY> { world: self, ray, t_min: first_t(ray) }.visit(index, best)
        };
        let locals = rays.iter().map(|ray| {
            let (local, is_usable) = usable(ray);
            (local, ray.t_max, is_usable)
        });
        let turns = caster.turns.get_or_insert_with(Turns::new);
        // SAFETY: `isa` is available
        unsafe { turns.walk::<ANY>(&self.upper, locals, &visit) };
        turns
    }

    #[inline(always)]
    fn cast<const ANY: bool>(&self, ray: &Ray, best: &mut Best) -> bool {
        let (local, true) = usable(ray) else { return false };
        let entered = Entered { world: self, ray, t_min: local.t_min };
        self.walk::<Entered<'_, ANY>, ANY>(&self.upper, &local, UPPER, &entered, best)
    }

    #[inline(always)]
    fn walk<O: Others, const ANY: bool>(
        &self,
        tree: &Tree,
        ray: &LocalRay,
        source: u32,
        others: &O,
        best: &mut Best,
    ) -> bool {
        // SAFETY: `isa` is available
        #[cfg(target_arch = "x86_64")]
        match self.isa {
            Isa::Avx512 => return unsafe { walk_avx512::<O, ANY>(tree, ray, source, others, best) },
            Isa::Avx2 => return unsafe { walk_avx2::<O, ANY>(tree, ray, source, others, best) },
            Isa::Baseline => {}
        }
        walk::<Portable, O, ANY>(tree, ray, source, others, best)
    }

    #[inline]
    fn hit(&self, best: &Best) -> Hit {
        let (instance, prim) =
            if best.source == UPPER { owner(&self.copies, best.id) } else { (best.source - 1, best.id) };
        Hit {
            t: best.t,
            instance,
            geometry: self.instances[instance as usize].geometry,
            prim,
            u: best.uv[0],
            v: best.uv[1],
            slot: best.slot,
        }
    }

    /// The surface where `hit`, found along `ray`, lies.
    #[inline(always)]
    pub fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
        let instance = &self.instances[hit.instance as usize];
        let (geometry, place) = (&self.geometries[instance.geometry as usize], &instance.place);
        match geometry.mesh() {
            Some(mesh) => {
                let corners = self.corners(instance, mesh, hit);
                triangle_surface(mesh, &corners, instance.moved.then_some(place), hit)
            }
            None => curved_surface(geometry, place, ray, hit),
        }
    }

    /// The corners of a triangle that was hit, in the space of its mesh: from the tree if they stand there, since its memory
    /// has just been read.
    #[inline(always)]
    fn corners(&self, instance: &Instance, mesh: &Mesh, hit: &Hit) -> [Vec3<f32>; 3] {
        match &self.lower[instance.geometry as usize] {
            Some(tree) => tree.corners(hit.slot),
            None if instance.moved => mesh.corners(hit.prim as usize),
            None => self.upper.corners(hit.slot),
        }
    }

    /// The mesh of a hit and the corners of its triangle, where the mesh stands in the world as it is and has no texture
    /// coordinates.
    #[inline(always)]
    pub(crate) fn plain_triangle(&self, hit: &Hit) -> Option<(&Mesh, [Vec3<f32>; 3])> {
        let instance = &self.instances[hit.instance as usize];
        let mesh = self.geometries[instance.geometry as usize].mesh()?;
        (!instance.moved && mesh.uvs().is_empty()).then(|| (&**mesh, self.corners(instance, mesh, hit)))
    }

    /// The instruction set that it uses; this processor has it.
    pub(crate) fn isa(&self) -> Isa {
        self.isa
    }

    /// What normal maps and second texture coordinates need at a surface, as [`surface`](Self::surface) gave it.
    pub fn detail(&self, surface: &Surface) -> Detail {
        let instance = &self.instances[surface.instance as usize];
        Detail::at(&self.geometries[instance.geometry as usize], &instance.place, surface)
    }

    /// Prepares choosing points on an instance, as for an area light.
    ///
    /// # Errors
    /// An instance without area.
    ///
    /// # Panics
    /// If there is no such instance.
    pub fn area_sampler(&self, instance: u32) -> Result<AreaSampler> {
        let i = &self.instances[instance as usize];
        AreaSampler::new(&self.geometries[i.geometry as usize], &i.place)
            .map_err(|e| e.at(format!("instance {instance}")))
    }

    /// A box around everything.
    pub fn bounds(&self) -> Bounds {
        self.upper.bounds
    }

    /// Number of instances.
    pub fn instance_count(&self) -> usize {
        self.instances.len()
    }

    /// Where an instance is.
    ///
    /// # Panics
    /// If there is no such instance.
    pub fn place(&self, instance: u32) -> &Transform {
        &self.instances[instance as usize].place
    }

    /// What an instance shows.
    ///
    /// # Panics
    /// If there is no such instance.
    pub fn geometry_of(&self, instance: u32) -> &Geometry {
        &self.geometries[self.instances[instance as usize].geometry as usize]
    }

    /// Bytes that the trees hold (meshes excluded).
    pub fn tree_bytes(&self) -> usize {
        self.upper.bytes() + self.lower.iter().flatten().map(Tree::bytes).sum::<usize>()
    }
}

/// Everything in the world tree besides triangles, entered by one ray.
struct Entered<'a, const ANY: bool> {
    world: &'a World,
    ray: &'a Ray,
    t_min: f32,
}

impl<const ANY: bool> Others for Entered<'_, ANY> {
    #[inline(never)]
    fn visit(&self, index: u32, best: &mut Best) -> bool {
        let number = self.world.others[index as usize];
        let instance = &self.world.instances[number as usize];
        let inverse = instance.place.inverse();
        let (o, d) = (inverse.point_f64(widen(self.ray.o)), inverse.vector_f64(widen(self.ray.d)));
        let source = number + 1;
        if let Some(tree) = &self.world.lower[instance.geometry as usize] {
            let local = local_ray(narrow(o), narrow(d), self.t_min);
            return local.is_usable() && self.world.walk::<NoOthers, ANY>(tree, &local, source, &NoOthers, best);
        }
        let shape = &self.world.geometries[instance.geometry as usize];
        // the next number above the limit: a hit at exactly `best.t` is compared by number
        let hit = shape_intersect(shape, o, d, self.t_min, best.t.next_up());
        let Some((t, prim)) = hit.filter(|&(t, prim)| best.is_beaten_by(t, source, prim)) else {
            return false;
        };
        *best = Best { t, source, id: prim, uv: [0.0; 2], slot: 0 };
        true
    }
}

/// Where a ray begins: a `t_min` that is negative or no number counts as 0.
#[inline(always)]
fn first_t(ray: &Ray) -> f32 {
    if ray.t_min > 0.0 { ray.t_min } else { 0.0 }
}

/// The ray, and whether it can meet something.
#[inline(always)]
fn usable(ray: &Ray) -> (LocalRay, bool) {
    let local = local_ray(ray.o, ray.d, first_t(ray));
    (local, (local.t_min < ray.t_max) & local.is_usable())
}

fn local_ray(o: Vec3<f32>, d: Vec3<f32>, t_min: f32) -> LocalRay {
    LocalRay { o: o.to_array(), d: d.to_array(), t_min }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma")]
unsafe fn walk_avx2<O: Others, const ANY: bool>(
    tree: &Tree,
    ray: &LocalRay,
    source: u32,
    others: &O,
    best: &mut Best,
) -> bool {
    walk::<super::traverse::avx2::Wide, O, ANY>(tree, ray, source, others, best)
}

/// The same code: what AVX-512 brings is twice the registers.
#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma,avx512f,avx512vl,avx512bw,avx512dq")]
unsafe fn walk_avx512<O: Others, const ANY: bool>(
    tree: &Tree,
    ray: &LocalRay,
    source: u32,
    others: &O,
    best: &mut Best,
) -> bool {
    walk::<super::traverse::avx2::Wide, O, ANY>(tree, ray, source, others, best)
}
