//! Meshes of real polygons: what a modeller drew, before anything is cut into triangles.
//!
//! A [`PolygonMesh`] keeps faces of any number of corners, the normals and texture coordinates of each corner, smoothing
//! groups and sharp edges. [`PolygonMesh::shading`] decides on vertex normals ([`NormalRule`]) and on which edges are real
//! ([`EdgeRule`]); [`PolygonMesh::vertices`] splits vertices where normals differ.

mod cut;
mod edges;
mod normals;
mod report;
mod surfaces;

pub use cut::triangulate;
pub use edges::{DEFAULT_CREASE, Edge, EdgeKind, EdgeRule};
pub use normals::{NormalRule, Shading, Vertices};
pub use report::{MAX_LISTED, MeshReport};
pub use surfaces::{
    cone_polygons, cube_polygons, cylinder_polygons, disk_polygons, grid_polygons, rectangle_polygons, sphere_polygons,
    torus_polygons,
};

use crate::error::{Error, Result};
use crate::mesh::{MAX_COORDINATE, Mesh, first_equal};
use crate::transform::{narrow, widen};
use lesk_math::Vec3;

/// A number that stands for no normal or no texture coordinates.
pub const NONE: u32 = u32::MAX;

/// One corner of a face.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Corner {
    /// Number of the position.
    pub position: u32,
    /// Number of the normal, or [`NONE`].
    pub normal: u32,
    /// Number of the texture coordinates, or [`NONE`].
    pub uv: u32,
}

/// A polygon mesh as a file or a program states it, unchecked.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PolygonData {
    /// Positions, metres.
    pub positions: Vec<Vec3<f32>>,
    /// Normals that corners refer to; any length but zero.
    pub normals: Vec<Vec3<f32>>,
    /// Texture coordinates that corners refer to.
    pub uvs: Vec<[f32; 2]>,
    /// The corners of all faces, face after face, counter-clockwise seen from outside.
    pub corners: Vec<Corner>,
    /// How many corners each face has: 3 or more.
    pub sizes: Vec<u32>,
    /// Smoothing group of each face, 0 for none; empty where no groups are stated.
    pub smoothing: Vec<u32>,
    /// Pairs of positions whose edge is stored as real (edge flags, sharp edges).
    pub sharp: Vec<[u32; 2]>,
    /// Whether the normals are those of the surface that the mesh approximates.
    pub analytic: bool,
}

/// A mesh of polygons whose indices and positions have been checked.
#[derive(Clone, Debug, PartialEq)]
pub struct PolygonMesh {
    data: PolygonData,
    /// First corner of each face, and the end.
    starts: Vec<u32>,
    /// For each position the first one with the same coordinates.
    weld: Vec<u32>,
}

impl PolygonMesh {
    /// Checks a mesh. Normals become unit length; unusable ones and those out of reach count as not stated.
    ///
    /// # Errors
    /// A position that is not finite or beyond [`MAX_COORDINATE`], a face with fewer than 3 corners, sizes that do not
    /// add up to the corners, an index out of range, smoothing groups that are neither none nor one per face, more than
    /// 2^30 corners.
    pub fn new(mut data: PolygonData) -> Result<Self> {
        check(&data)?;
        let usable: Vec<bool> = data.normals.iter_mut().map(make_unit).collect();
        for corner in &mut data.corners {
            if corner.normal != NONE && !usable[corner.normal as usize] {
                corner.normal = NONE;
            }
        }
        data.uvs.iter_mut().filter(|uv| !uv.iter().all(|x| x.is_finite())).for_each(|uv| *uv = [0.0; 2]);
        let mut starts = Vec::with_capacity(data.sizes.len() + 1);
        let mut start = 0;
        starts.push(0);
        for size in &data.sizes {
            start += size;
            starts.push(start);
        }
        let weld = first_equal(&data.positions);
        Ok(PolygonMesh { data, starts, weld })
    }

    /// The triangles of a mesh as faces, with its vertices as corners.
    ///
    /// # Panics
    /// Never: a checked mesh of triangles is a valid mesh of polygons.
    pub fn from_triangles(mesh: &Mesh) -> Self {
        let number = |has: bool, i: u32| if has { i } else { NONE };
        let (has_normals, has_uvs) = (!mesh.normals().is_empty(), !mesh.uvs().is_empty());
        let corner = |&i: &u32| Corner { position: i, normal: number(has_normals, i), uv: number(has_uvs, i) };
        let data = PolygonData {
            positions: mesh.positions().to_vec(),
            normals: mesh.normals().to_vec(),
            uvs: mesh.uvs().to_vec(),
            corners: mesh.triangles().iter().flatten().map(corner).collect(),
            sizes: vec![3; mesh.triangles().len()],
            ..PolygonData::default()
        };
        Self::new(data).expect("a checked mesh is valid")
    }

    /// What it was made of.
    pub fn data(&self) -> &PolygonData {
        &self.data
    }

    /// Number of faces.
    pub fn face_count(&self) -> usize {
        self.data.sizes.len()
    }

    /// Where the corners of a face stand in [`PolygonData::corners`].
    pub fn face(&self, index: usize) -> std::ops::Range<usize> {
        self.starts[index] as usize..self.starts[index + 1] as usize
    }

    /// The corner after `corner` in its face, and the one before.
    fn neighbours(&self, face: usize, corner: usize) -> [usize; 2] {
        let range = self.face(face);
        let next = if corner + 1 == range.end { range.start } else { corner + 1 };
        let previous = if corner == range.start { range.end - 1 } else { corner - 1 };
        [previous, next]
    }

    /// Position of a corner.
    fn point(&self, corner: usize) -> Vec3<f64> {
        widen(self.data.positions[self.data.corners[corner].position as usize])
    }

    /// The number that all corners at the same place share.
    fn place(&self, corner: usize) -> u32 {
        self.weld[self.data.corners[corner].position as usize]
    }

    /// The area vector of a face: its area in m² along its normal (Newell's method). Zero for a face without area.
    pub fn area_vector(&self, face: usize) -> Vec3<f64> {
        let range = self.face(face);
        let origin = self.point(range.start);
        let term = |c: usize| {
            let next = self.neighbours(face, c)[1];
            (self.point(c) - origin).cross(self.point(next) - origin)
        };
        range.clone().fold(Vec3::ZERO, |sum, c| sum + term(c)) * 0.5
    }

    /// The unit normal of a face; zero for a face without area.
    pub fn face_normal(&self, face: usize) -> Vec3<f64> {
        let area = self.area_vector(face);
        let length = area.length();
        if length > 0.0 { area * (1.0 / length) } else { Vec3::ZERO }
    }

    /// Whether any corner states a normal.
    pub fn has_normals(&self) -> bool {
        self.data.corners.iter().any(|c| c.normal != NONE)
    }

    /// Whether the mesh says itself which edges are real: by smoothing groups, sharp edges or normals.
    pub fn states_edges(&self) -> bool {
        !self.data.smoothing.is_empty() || !self.data.sharp.is_empty() || self.has_normals()
    }

    /// Turns faces around that wind against the normals of their corners; returns how many.
    pub fn turn_to_normals(&mut self) -> usize {
        let mut turned = 0;
        for face in 0..self.face_count() {
            let normals = self.face(face).filter_map(|c| self.normal_of(c));
            let sum = normals.fold(Vec3::ZERO, |sum, n| sum + n);
            if self.area_vector(face).dot(sum) < 0.0 {
                let range = self.face(face);
                self.data.corners[range.start + 1..range.end].reverse();
                turned += 1;
            }
        }
        turned
    }

    /// The normal that a corner states.
    fn normal_of(&self, corner: usize) -> Option<Vec3<f64>> {
        let normal = self.data.corners[corner].normal;
        (normal != NONE).then(|| widen(self.data.normals[normal as usize]))
    }

    /// The same faces with angle-weighted normals across all edges.
    #[must_use]
    pub fn smoothed(&self) -> Self {
        let shading = self
            .shading(NormalRule::Angle, EdgeRule::Crease(std::f64::consts::PI))
            .expect("angle-weighted normals always exist");
        let mut out = self.clone();
        out.data.corners.iter_mut().zip(&shading.corners).for_each(|(c, &n)| c.normal = n);
        out.data.normals = shading.normals;
        out.data.analytic = false;
        out
    }

    /// The same faces without normals, every edge real.
    #[must_use]
    pub fn flattened(&self) -> Self {
        let mut out = self.clone();
        out.data.corners.iter_mut().for_each(|c| c.normal = NONE);
        out.data.normals.clear();
        out.data.smoothing = vec![0; self.face_count()];
        out.data.analytic = false;
        out
    }
}

/// Whether the normal could be brought to unit length.
fn make_unit(n: &mut Vec3<f32>) -> bool {
    let wide = widen(*n);
    let length = wide.length();
    let usable = length.is_finite() && length > 1e-30;
    if usable {
        *n = narrow(wide / length);
    }
    usable
}

fn check(data: &PolygonData) -> Result<()> {
    for (i, p) in data.positions.iter().enumerate() {
        // the comparison fails for NaN too
        if !p.to_array().iter().all(|x| x.abs() <= MAX_COORDINATE) {
            return Err(Error::new(format!(
                "vertex {i} is at {:?}, coordinates from {:e} to {MAX_COORDINATE:e} are accepted",
                p.to_array(),
                -MAX_COORDINATE
            )));
        }
    }
    if let Some((face, size)) = data.sizes.iter().enumerate().find(|(_, size)| **size < 3) {
        return Err(Error::new(format!("face {face} has {size} corners, at least 3 are needed")));
    }
    let total: u64 = data.sizes.iter().map(|&s| u64::from(s)).sum();
    if total != data.corners.len() as u64 || total > 1 << 30 {
        return Err(Error::new(format!(
            "faces have {total} corners in all, but {} are given; at most {} are accepted",
            data.corners.len(),
            1 << 30
        )));
    }
    if !data.smoothing.is_empty() && data.smoothing.len() != data.sizes.len() {
        let (groups, faces) = (data.smoothing.len(), data.sizes.len());
        return Err(Error::new(format!("mesh has {groups} smoothing groups for {faces} faces, one each or none")));
    }
    check_indices(data)
}

fn check_indices(data: &PolygonData) -> Result<()> {
    let out = |what: &str, index: u32, count: usize| {
        Error::new(format!("corner uses {what} {index}, but there are {count} (counted from 0)"))
    };
    let [positions, normals, uvs] = [data.positions.len(), data.normals.len(), data.uvs.len()];
    for c in &data.corners {
        if c.position as usize >= positions {
            return Err(out("position", c.position, positions));
        }
        if c.normal != NONE && c.normal as usize >= normals {
            return Err(out("normal", c.normal, normals));
        }
        if c.uv != NONE && c.uv as usize >= uvs {
            return Err(out("texture coordinates", c.uv, uvs));
        }
    }
    match data.sharp.iter().flatten().find(|&&p| p as usize >= positions) {
        Some(&p) => Err(Error::new(format!("sharp edge uses position {p}, but there are {positions}"))),
        None => Ok(()),
    }
}
