//! A scene as faces in world space, with the vertices that shading needs.

use crate::error::{Error, Result};
use crate::shade::is_isotropic;
use crate::subdivide::subdivide;
use crate::tangents::{Tangent, split};
use crate::{Interpolation, Mode, Settings};
use lesk_geometry::polygons::{Vertices, cylinder_polygons, grid_polygons, rectangle_polygons, sphere_polygons};
use lesk_geometry::{Geometry, Mesh, MeshData, PolygonMesh, Transform, World, WorldBuilder};
use lesk_math::{Vec3, vec3};
use lesk_scene::Scene;
use std::f64::consts::TAU;
use std::sync::Arc;

/// A vertex; what belongs to it lies in one cache line.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
pub(crate) struct Vertex {
    /// World position, metres.
    pub p: Vec3<f32>,
    /// Unit normal, world space.
    pub n: Vec3<f32>,
    pub uv: [f32; 2],
}

/// All faces of a scene.
#[derive(Clone, Debug, Default)]
pub(crate) struct Prepared {
    pub vertices: Vec<Vertex>,
    /// World space; empty where no object needs any.
    pub tangents: Vec<Tangent>,
    /// First corner of each face, and the end.
    pub starts: Vec<u32>,
    /// Vertices of the corners.
    pub corners: Vec<u32>,
    /// The object of each face.
    pub objects: Vec<u32>,
    /// First face of each object, and the end.
    pub first_face: Vec<u32>,
    /// Length of the diagonal of the box around everything, metres.
    pub extent: f64,
}

/// Most corners of a scene: face numbers leave one bit free.
const MAX_CORNERS: usize = 1 << 30;

impl Prepared {
    pub fn new(scene: &Scene, settings: &Settings) -> Result<Self> {
        let mut out = Prepared { starts: vec![0], first_face: vec![0], ..Prepared::default() };
        let mut made: Vec<(Geometry, bool, Arc<Shaded>)> = Vec::new();
        for number in 0..scene.world.instance_count() as u32 {
            let geometry = scene.world.geometry_of(number);
            let tangents = wants_tangents(scene, settings, number);
            let known = made.iter().find(|(g, t, _)| same(g, geometry) && *t == tangents).map(|(.., s)| s.clone());
            let shaded = match known {
                Some(shaded) => shaded,
                None => {
                    let shaded = Arc::new(Shaded::new(geometry, settings, tangents).map_err(|e| {
                        let name = &scene.objects[number as usize].name;
                        let about = if name.is_empty() { "object".into() } else { format!("object `{name}`") };
                        Error::new(format!("{about}: {e}"))
                    })?);
                    made.push((geometry.clone(), tangents, shaded.clone()));
                    shaded
                }
            };
            out.add(&shaded, scene.world.place(number), number)?;
        }
        let [mut low, mut high] = [[f32::INFINITY; 3], [f32::NEG_INFINITY; 3]];
        for vertex in &out.vertices {
            for (k, x) in vertex.p.to_array().into_iter().enumerate() {
                (low[k], high[k]) = (low[k].min(x), high[k].max(x));
            }
        }
        let size = (0..3).map(|k| f64::from(high[k] - low[k]).powi(2)).sum::<f64>().sqrt();
        out.extent = if size.is_finite() { size } else { 0.0 };
        Ok(out)
    }

    fn add(&mut self, shaded: &Shaded, place: &Transform, object: u32) -> Result<()> {
        if self.corners.len() + shaded.vertices.corners.len() > MAX_CORNERS {
            return Err(Error::new(format!("scene has more than {MAX_CORNERS} corners of faces")));
        }
        let base = self.vertices.len() as u32;
        let wide = |v: Vec3<f32>| v.map(f64::from);
        let Vertices { positions, normals, uvs, .. } = &shaded.vertices;
        self.vertices.extend(positions.iter().zip(normals).enumerate().map(|(k, (&p, &n))| Vertex {
            p: place.point(p),
            n: place.normal_f64(wide(n)).normalize().map(|x| x as f32),
            uv: uvs.get(k).copied().unwrap_or_default(),
        }));
        let mirrored = place.determinant() < 0.0;
        if !shaded.tangents.is_empty() {
            let side = if mirrored { -1.0 } else { 1.0 };
            self.tangents.resize(base as usize, [0.0; 4]);
            self.tangents.extend(shaded.tangents.iter().map(|&[x, y, z, hand]| {
                let [x, y, z] = place.vector(vec3(x, y, z)).to_array();
                [x, y, z, hand * side]
            }));
        } else if !self.tangents.is_empty() {
            self.tangents.resize(self.vertices.len(), [0.0; 4]);
        }
        let mut start = 0;
        for &size in &shaded.sizes {
            let face = &shaded.vertices.corners[start..start + size as usize];
            start += size as usize;
            // the first corner stays the first
            let (first, rest) = face.split_first().expect("a face has three corners");
            self.corners.push(base + first);
            match mirrored {
                true => self.corners.extend(rest.iter().rev().map(|v| base + v)),
                false => self.corners.extend(rest.iter().map(|v| base + v)),
            }
            self.starts.push(self.corners.len() as u32);
            self.objects.push(object);
        }
        self.first_face.push(self.objects.len() as u32);
        Ok(())
    }

    pub fn face_count(&self) -> usize {
        self.objects.len()
    }

    #[inline]
    pub fn face(&self, index: usize) -> &[u32] {
        &self.corners[self.starts[index] as usize..self.starts[index + 1] as usize]
    }

    /// The unit normal of a face (Newell's method), f64; zero without an area.
    pub fn face_normal(&self, index: usize) -> Vec3<f64> {
        let face = self.face(index);
        let at = |k: usize| self.vertices[face[k] as usize].p.map(f64::from);
        let origin = at(0);
        let term = |k: usize| (at(k) - origin).cross(at(k + 1) - origin);
        unit((1..face.len() - 1).fold(Vec3::<f64>::ZERO, |sum, k| sum + term(k)))
    }

    /// dp/du of a face by its first three corners; zero where the texture coordinates give none.
    pub fn tangent(&self, index: usize) -> Vec3<f32> {
        let face = self.face(index);
        let [a, b, c] = [face[0], face[1], face[2]].map(|v| v as usize);
        let wide = |v: usize| self.vertices[v].p.map(f64::from);
        let uv = |v: usize| self.vertices[v].uv.map(f64::from);
        let (e1, e2) = (wide(b) - wide(a), wide(c) - wide(a));
        let [du1, dv1] = [0, 1].map(|k| uv(b)[k] - uv(a)[k]);
        let [du2, dv2] = [0, 1].map(|k| uv(c)[k] - uv(a)[k]);
        let t = ((e1 * dv2 - e2 * dv1) * (1.0 / (du1 * dv2 - dv1 * du2))).map(|x| x as f32);
        if t.length().is_finite() { t } else { Vec3::ZERO }
    }

    /// The tangent of a face by its first three corners, with its hand.
    pub fn whole_tangent(&self, index: usize) -> Tangent {
        let face = self.face(index);
        let [a, b, c] = [face[0], face[1], face[2]].map(|v| self.vertices[v as usize].uv.map(f64::from));
        let turn = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        let [x, y, z] = self.tangent(index).to_array();
        [x, y, z, if turn < 0.0 { -1.0 } else { 1.0 }]
    }

    /// How far spans across a face may lie from the triangles that it is cut into, metres: half the twist of a quadrilateral,
    /// the span of the heights of the corners for faces of more, 0 for flat faces.
    pub fn depth(&self, index: usize) -> f32 {
        let face = self.face(index);
        if face.len() == 3 {
            return 0.0;
        }
        let n = self.face_normal(index).map(|x| x as f32);
        let height = |v: u32| (self.vertices[v as usize].p - self.vertices[face[0] as usize].p).dot(n);
        if let &[a, b, c, d] = face {
            return 0.5 * (height(a) - height(b) + height(c) - height(d)).abs();
        }
        let heights = || face.iter().map(|&v| height(v));
        heights().fold(f32::MIN, f32::max) - heights().fold(f32::MAX, f32::min)
    }

    /// The faces as a world for rays, one mesh per object, in the order of the scene's objects: what the path tracer needs
    /// to see the same surfaces with the same normals. What `keep` says stays the surface of that scene.
    pub fn world(&self, keep: impl Fn(usize) -> Option<(Geometry, Transform)>) -> Result<World> {
        let mut builder = WorldBuilder::new();
        for object in 0..self.first_face.len() - 1 {
            if let Some((geometry, place)) = keep(object) {
                let number = builder.geometry(geometry);
                builder.instance(number, place).map_err(|e| Error::new(e.to_string()))?;
                continue;
            }
            let mut data = MeshData::default();
            let faces = self.first_face[object] as usize..self.first_face[object + 1] as usize;
            let mut polygons = Vec::new();
            let mut local: std::collections::HashMap<u32, u32> = std::collections::HashMap::new();
            for face in faces {
                polygons.clear();
                for &v in self.face(face) {
                    let next = data.positions.len() as u32;
                    let vertex = *local.entry(v).or_insert(next);
                    polygons.push(vertex);
                    if vertex == next {
                        let vertex = self.vertices[v as usize];
                        data.positions.push(vertex.p);
                        data.normals.push(vertex.n);
                        data.uvs.push(vertex.uv);
                        data.tangents.extend(self.tangents.get(v as usize));
                    }
                }
                lesk_geometry::polygons::triangulate(&data.positions, &polygons, &mut data.triangles);
            }
            let mesh = Mesh::new(data).map_err(|e| Error::new(e.to_string()))?.0;
            let number = builder.geometry(Geometry::Mesh(Arc::new(mesh)));
            builder.instance(number, Transform::IDENTITY).map_err(|e| Error::new(e.to_string()))?;
        }
        builder.build().map_err(|e| Error::new(e.to_string()))
    }
}

/// The unit normal of a triangle, as [`Prepared::face_normal`].
#[inline]
pub(crate) fn triangle_normal(corners: [Vec3<f32>; 3]) -> Vec3<f32> {
    let [a, b, c] = [corners[0].map(f64::from), corners[1].map(f64::from), corners[2].map(f64::from)];
    unit((b - a).cross(c - a)).map(|x| x as f32)
}

#[inline]
fn unit(v: Vec3<f64>) -> Vec3<f64> {
    let length = v.length();
    if length > 0.0 { v * (1.0 / length) } else { Vec3::ZERO }
}

/// Whether the vertices of an object need tangents: for a normal map, or to light a brushed material at them.
fn wants_tangents(scene: &Scene, settings: &Settings, object: u32) -> bool {
    let material = scene.objects[object as usize].material.map(|m| &scene.materials[m as usize]);
    let Some(material) = material.filter(|_| settings.classic.is_none()) else { return false };
    material.normal_map().is_some() || (settings.shading == Mode::Gouraud && !is_isotropic(material))
}

/// Whether two instances show the same geometry.
fn same(a: &Geometry, b: &Geometry) -> bool {
    match (a, b) {
        (Geometry::Mesh(a), Geometry::Mesh(b)) => Arc::ptr_eq(a, b),
        (Geometry::Cylinder { capped: a }, Geometry::Cylinder { capped: b }) => a == b,
        _ => std::mem::discriminant(a) == std::mem::discriminant(b),
    }
}

/// A geometry as faces with split vertices, local space.
struct Shaded {
    vertices: Vertices,
    sizes: Vec<u32>,
    /// One per vertex, or none.
    tangents: Vec<Tangent>,
}

impl Shaded {
    fn new(
        geometry: &Geometry,
        settings: &Settings,
        tangents: bool,
    ) -> std::result::Result<Self, lesk_geometry::Error> {
        let mut polygons = polygons_of(geometry, settings.tessellation);
        polygons.turn_to_normals();
        let shading = polygons.shading(settings.normals, settings.edges)?;
        let mut vertices = polygons.vertices(&shading);
        let mut sizes = polygons.data().sizes.clone();
        for _ in 0..if geometry.mesh().is_some() { settings.subdivide } else { 0 } {
            if vertices.corners.len() > MAX_CORNERS / 4 {
                let faces = sizes.len();
                let text = format!("`subdivide` is {}, which makes more faces of {faces} than fit", settings.subdivide);
                return Err(lesk_geometry::Error::new(text));
            }
            subdivide(&mut vertices, &mut sizes);
        }
        let tangents = if tangents { split(&mut vertices, &sizes, geometry.mesh().map(|m| &**m)) } else { Vec::new() };
        let cut = settings.interpolation == Interpolation::Barycentric && settings.shading != Mode::Flat;
        if !cut {
            return Ok(Shaded { vertices, sizes, tangents });
        }
        let mut triangles = Vec::new();
        let mut start = 0;
        for size in sizes {
            let corners = &vertices.corners[start..start + size as usize];
            lesk_geometry::polygons::triangulate(&vertices.positions, corners, &mut triangles);
            start += size as usize;
        }
        vertices.corners = triangles.as_flattened().to_vec();
        Ok(Shaded { vertices, sizes: vec![3; triangles.len()], tangents })
    }
}

/// The faces of a geometry; curved shapes get `around` faces around them.
fn polygons_of(geometry: &Geometry, around: u32) -> PolygonMesh {
    let half = (around / 2).max(2);
    match geometry {
        Geometry::Mesh(mesh) => match mesh.polygons() {
            Some(polygons) => (**polygons).clone(),
            None => PolygonMesh::from_triangles(mesh),
        },
        Geometry::Rectangle => rectangle_polygons(1, 1),
        Geometry::Sphere => sphere_polygons(around, half),
        Geometry::Disk => grid_polygons((around / 8).max(1), around, |r, turn| {
            (vec3(r * (TAU * turn).cos(), r * (TAU * turn).sin(), 0.0), Vec3::Z)
        }),
        Geometry::Cylinder { capped } => cylinder_polygons(around, (around / 8).max(1), *capped),
    }
}
