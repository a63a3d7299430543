//! Objects: shapes, files and groups become instances.

use super::Resolver;
use super::groups::Groups;
use crate::description::{GroupDescription, Normals, ObjectDescription, Shape};
use crate::error::{Place, Problem, list, name_hint};
use crate::scene::Object;
use lesk_geometry::{Geometry, Mesh, Transform, teapot};
use lesk_light::{Area, Light};
use std::collections::HashMap;
use std::sync::Arc;

/// Most instances of a scene.
const MAX_INSTANCES: usize = 1 << 22;
/// Largest subdivision of the teapot: 32 patches of 256 x 256 cells are 4.2 million triangles.
pub(crate) const MAX_TEAPOT_LEVEL: u32 = 256;

/// The geometries that are there already, and their numbers.
#[derive(Default)]
pub(super) struct Geometries {
    list: Vec<Geometry>,
    /// Sphere, disk, rectangle, cube, closed and open cylinder.
    simple: [Option<u32>; 6],
    teapots: HashMap<u32, u32>,
    /// By the mesh, which `kept` holds.
    meshes: HashMap<Key, u32>,
    kept: Vec<Arc<Mesh>>,
}

/// The address of a mesh, what its normals are, and the texture coordinates that need tangents.
type Key = (usize, u8, Option<usize>);

/// What stands at a place, before it is an instance.
pub(super) struct Part<'a> {
    pub name: &'a str,
    pub geometry: u32,
    pub transform: Transform,
    pub material: Option<u32>,
    pub place: Place,
}

impl Resolver<'_> {
    pub(super) fn objects(&mut self) {
        let d = self.description;
        let mut groups = Groups::new(&d.groups, self);
        // a group that is never placed may have mistakes too
        for object in d.groups.iter().flat_map(|g| &g.objects) {
            object.material.as_ref().map(|name| self.material_number(name, object.place));
        }
        for object in &d.objects {
            match &object.shape {
                Shape::Group(name) => {
                    if let Some(group) = groups.place(name, object, self) {
                        self.group(group, object.transform, &groups);
                    }
                }
                _ => self.object(object, Transform::IDENTITY),
            }
        }
    }

    /// Places the objects of a group whose nesting has been checked.
    fn group(&mut self, group: &GroupDescription, transform: Transform, groups: &Groups) {
        for object in &group.objects {
            if self.problems.len() >= super::MAX_PROBLEMS {
                return;
            }
            match &object.shape {
                Shape::Group(name) => {
                    if let Some(inner) = groups.find(name, object, self) {
                        self.group(inner, transform * object.transform, groups);
                    }
                }
                _ => self.object(object, transform),
            }
        }
    }

    fn object(&mut self, d: &ObjectDescription, parent: Transform) {
        let transform = parent * d.transform;
        let material = match &d.material {
            Some(name) => match self.material_number(name, d.place) {
                Some(number) => Some(number),
                None => return,
            },
            None => None,
        };
        if let Shape::File { file, normals } = &d.shape {
            return self.file(d, file, *normals, transform, material);
        }
        if d.material.is_none() && d.light.is_none() {
            let about = about(&d.name);
            self.problem(
                Problem::new(d.place, format!("{about} has no material")).hint("add `material`, or `light` for a lamp"),
            );
            return;
        }
        let Some((geometry, size)) = self.shape(d, material) else { return };
        let part = Part { name: &d.name, geometry, transform: transform * size, material, place: d.place };
        self.instance(part, d);
    }

    fn material_number(&mut self, name: &str, place: Place) -> Option<u32> {
        if let Some(number) = self.material_names.get(name) {
            return *number;
        }
        let known: Vec<&str> = self.description.materials.iter().map(|m| m.name.as_str()).collect();
        let text = match known.is_empty() {
            true => format!("unknown material `{name}`, the scene has none"),
            false => format!("unknown material `{name}`, there are {}", list(&known)),
        };
        self.problem(Problem::new(place, text).hint(name_hint(name, &known)));
        None
    }

    /// Adds an instance, and the light that it emits.
    pub(super) fn instance(&mut self, part: Part, d: &ObjectDescription) {
        let light = match &d.light {
            Some(light) => match self.area_light(&part, light) {
                Some(light) => Some(light),
                None => return,
            },
            None => None,
        };
        self.instance_with(part, light);
    }

    pub(super) fn instance_with(&mut self, part: Part, light: Option<Area>) {
        let number = light.as_ref().map(|_| self.lights.len() as u32);
        if self.place_part(part, number) {
            self.lights.extend(light.map(Light::Area));
        }
    }

    /// Adds an instance whose surface is the light of that number; gives whether it could be added.
    pub(super) fn place_part(&mut self, part: Part, light: Option<u32>) -> bool {
        if self.objects.len() >= MAX_INSTANCES {
            let text = format!("scene has more than {MAX_INSTANCES} instances");
            self.problem(Problem::new(part.place, text));
            return false;
        }
        let finite = part.transform.rows().iter().flatten().all(|v| v.is_finite());
        let result = if finite {
            self.world.instance(part.geometry, part.transform).map_err(|e| e.to_string())
        } else {
            Err("its transform is not finite".to_string())
        };
        if self.check(part.place, &about(part.name), result).is_none() {
            return false;
        }
        self.objects.push(Object { name: part.name.to_string(), material: part.material, light });
        true
    }

    /// The geometry of a shape, and the transform that gives it its size.
    fn shape(&mut self, d: &ObjectDescription, material: Option<u32>) -> Option<(u32, Transform)> {
        let sizes = match &d.shape {
            Shape::Sphere { radius } => [*radius; 3],
            Shape::Disk { radius } => [*radius, *radius, 1.0],
            Shape::Rectangle { size } => [0.5 * size[0], 0.5 * size[1], 1.0],
            Shape::Cube { size } => size.map(|s| 0.5 * s),
            Shape::Cylinder { radius, height, .. } => [*radius, *radius, *height],
            _ => [1.0; 3],
        };
        if let Some(bad) = sizes.iter().find(|s| !(1e-9..=1e12).contains(*s)) {
            let text = format!("{} has the extent {bad} m, 1e-9 to 1e12 m is accepted", about(&d.name));
            self.problem(Problem::new(d.place, text));
            return None;
        }
        let size = Transform::scale(sizes[0], sizes[1], sizes[2]);
        let size = self.check(d.place, &about(&d.name), size)?;
        let number = match &d.shape {
            Shape::Sphere { .. } => self.simple(0, || Geometry::Sphere),
            Shape::Disk { .. } => self.simple(1, || Geometry::Disk),
            Shape::Rectangle { .. } => self.simple(2, || Geometry::Rectangle),
            Shape::Cube { .. } => self.simple(3, Geometry::cube),
            Shape::Cylinder { capped: true, .. } => self.simple(4, || Geometry::Cylinder { capped: true }),
            Shape::Cylinder { .. } => self.simple(5, || Geometry::Cylinder { capped: false }),
            Shape::Teapot { level } => self.teapot(*level, d)?,
            Shape::Mesh(mesh) => {
                let mesh = mesh.0.clone();
                if !self.geometries.kept.iter().any(|known| Arc::ptr_eq(known, &mesh)) {
                    self.files.hash_mesh(&mesh);
                }
                self.mesh(&mesh, Normals::File, self.tangent_set(material))
            }
            Shape::File { .. } | Shape::Group(_) => return None,
        };
        Some((number, size))
    }

    fn simple(&mut self, slot: usize, make: fn() -> Geometry) -> u32 {
        if let Some(number) = self.geometries.simple[slot] {
            return number;
        }
        let number = self.add_geometry(make());
        self.geometries.simple[slot] = Some(number);
        number
    }

    pub(super) fn add_geometry(&mut self, geometry: Geometry) -> u32 {
        self.geometries.list.push(geometry.clone());
        self.world.geometry(geometry)
    }

    fn teapot(&mut self, level: u32, d: &ObjectDescription) -> Option<u32> {
        if !(1..=MAX_TEAPOT_LEVEL).contains(&level) {
            let text = format!("`level` is {level}, 1 to {MAX_TEAPOT_LEVEL} is accepted");
            self.problem(Problem::new(d.place, text));
            return None;
        }
        if let Some(&number) = self.geometries.teapots.get(&level) {
            return Some(number);
        }
        let number = self.add_geometry(Geometry::Mesh(Arc::new(teapot(level))));
        self.geometries.teapots.insert(level, number);
        Some(number)
    }

    /// The texture coordinates along which a material needs tangents: those of its normal map.
    pub(super) fn tangent_set(&self, material: Option<u32>) -> Option<usize> {
        self.materials[material? as usize].normal_map().map(|map| map.uv_set)
    }

    /// The geometry of a mesh; the same mesh is one geometry. With `tangents` it has them along that set of texture
    /// coordinates: those of the file, or made.
    pub(super) fn mesh(&mut self, mesh: &Arc<Mesh>, normals: Normals, tangents: Option<usize>) -> u32 {
        let key = (Arc::as_ptr(mesh) as usize, normals as u8, tangents);
        if let Some(&number) = self.geometries.meshes.get(&key) {
            return number;
        }
        let mut shown = mesh.clone();
        match normals {
            Normals::File => {}
            Normals::Smooth => Arc::make_mut(&mut shown).smooth(),
            Normals::Flat => Arc::make_mut(&mut shown).flatten(),
        }
        if let Some(set) = tangents.filter(|_| shown.tangents().is_empty()) {
            shown = Arc::new(shown.with_tangents(set));
        }
        let number = self.add_geometry(Geometry::Mesh(shown));
        self.geometries.meshes.insert(key, number);
        self.geometries.kept.push(mesh.clone());
        number
    }

    pub(super) fn geometry(&self, number: u32) -> &Geometry {
        &self.geometries.list[number as usize]
    }
}

/// What an object is called in a message.
pub(super) fn about(name: &str) -> String {
    if name.is_empty() { "object".to_string() } else { format!("object `{name}`") }
}
