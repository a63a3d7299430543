//! Triangle meshes: checked once, then trusted.

use crate::bounds::Bounds;
use crate::error::{Error, Result};
use crate::polygons::PolygonMesh;
use crate::transform::{narrow, widen};
use lesk_math::{Vec3, vec3};
use std::sync::Arc;

/// The largest coordinate that a vertex may have, in metres: beyond it, squares of coordinates leave the range of f32.
pub const MAX_COORDINATE: f32 = 1e12;

/// A mesh as a file or a program states it, unchecked. Empty `normals` and `uvs` mean that there are none.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MeshData {
    /// Vertex positions, metres.
    pub positions: Vec<Vec3<f32>>,
    /// Shading normals, one per position or none; any length but zero.
    pub normals: Vec<Vec3<f32>>,
    /// Texture coordinates, one per position or none; v runs upward.
    pub uvs: Vec<[f32; 2]>,
    /// A second set of texture coordinates, one per position or none.
    pub uvs_1: Vec<[f32; 2]>,
    /// Tangents of normal maps, one per position or none: along growing u, and -1 where v grows against n x t, else 1.
    pub tangents: Vec<[f32; 4]>,
    /// Three positions each, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
}

/// What [`Mesh::new`] repaired, for the caller to report.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Repairs {
    /// Triangles without an area, dropped.
    pub degenerate_triangles: usize,
    /// Normals of length zero or not finite, replaced by the angle-weighted normal of the faces around.
    pub replaced_normals: usize,
    /// Texture coordinates that are not finite, replaced by 0.
    pub replaced_uvs: usize,
    /// Whether tangents were dropped, since some were no directions.
    pub dropped_tangents: bool,
    /// Triangles that wound against their own normals, turned around.
    pub turned_triangles: usize,
}

impl Repairs {
    /// Whether anything was repaired.
    pub fn any(&self) -> bool {
        *self != Self::default()
    }
}

/// A triangle mesh whose indices, positions and normals have been checked.
///
/// Positions are finite, normals have unit length, every triangle has an area and winds counter-clockwise seen from
/// the side of its normals.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    data: MeshData,
    bounds: Bounds,
    polygons: Option<Arc<PolygonMesh>>,
}

impl Mesh {
    /// Checks and repairs a mesh.
    ///
    /// # Errors
    /// A position that is not finite or beyond [`MAX_COORDINATE`] (named), an index out of range, normals or texture
    /// coordinates that are neither none nor one per position, more than 2^30 triangles.
    pub fn new(mut data: MeshData) -> Result<(Self, Repairs)> {
        check_counts(&data)?;
        let bounds = check_positions(&data.positions)?;
        check_indices(&data)?;
        let before = data.triangles.len();
        let positions = &data.positions;
        data.triangles.retain(|&t| double_area_vector(positions, t).length_squared() > 0.0);
        let mut repairs = Repairs { degenerate_triangles: before - data.triangles.len(), ..Repairs::default() };
        repairs.replaced_uvs = repair_uvs(&mut data.uvs) + repair_uvs(&mut data.uvs_1);
        repairs.dropped_tangents = drop_bad_tangents(&mut data.tangents);
        repairs.replaced_normals = repair_normals(&mut data);
        repairs.turned_triangles = turn_triangles(&mut data);
        Ok((Mesh { data, bounds, polygons: None }, repairs))
    }

    /// The same mesh with the polygons that it was cut from.
    #[must_use]
    pub fn with_polygons(mut self, polygons: Arc<PolygonMesh>) -> Self {
        self.polygons = Some(polygons);
        self
    }

    /// The polygons that the mesh was cut from, where they say more than its triangles.
    pub fn polygons(&self) -> Option<&Arc<PolygonMesh>> {
        self.polygons.as_ref()
    }

    /// Vertex positions, metres.
    pub fn positions(&self) -> &[Vec3<f32>] {
        &self.data.positions
    }

    /// Unit shading normals, one per position, or empty.
    pub fn normals(&self) -> &[Vec3<f32>] {
        &self.data.normals
    }

    /// Texture coordinates, one per position, or empty.
    pub fn uvs(&self) -> &[[f32; 2]] {
        &self.data.uvs
    }

    /// The texture coordinates of set 0 or 1, one per position, or empty.
    pub fn uv_list(&self, set: usize) -> &[[f32; 2]] {
        if set == 0 { &self.data.uvs } else { &self.data.uvs_1 }
    }

    /// Texture coordinates of set 0 or 1 in triangle `index` at barycentric weights of its corners; `None` where the
    /// mesh has none.
    pub fn uv(&self, set: usize, index: usize, weights: [f64; 3]) -> Option<[f32; 2]> {
        let list = self.uv_list(set);
        let corners = self.data.triangles[index].map(|i| list.get(i as usize).map(|uv| uv.map(f64::from)));
        let [Some(a), Some(b), Some(c)] = corners else { return None };
        Some([0, 1].map(|k| (a[k] * weights[0] + b[k] * weights[1] + c[k] * weights[2]) as f32))
    }

    /// Tangents of normal maps, one per position, or empty: unit vector and hand, 1 or -1.
    pub fn tangents(&self) -> &[[f32; 4]] {
        &self.data.tangents
    }

    /// The mesh with a tangent per corner of its triangles: vertices whose corners differ become several.
    pub(crate) fn split(&self, tangents: &[[f32; 4]]) -> Mesh {
        let old = &self.data;
        let mut data = MeshData { triangles: old.triangles.clone(), ..MeshData::default() };
        let mut known = std::collections::HashMap::new();
        for (vertex, tangent) in data.triangles.iter_mut().flatten().zip(tangents) {
            let from = *vertex as usize;
            *vertex = *known.entry((from, tangent.map(f32::to_bits))).or_insert_with(|| {
                data.positions.push(old.positions[from]);
                data.normals.extend(old.normals.get(from));
                data.uvs.extend(old.uvs.get(from));
                data.uvs_1.extend(old.uvs_1.get(from));
                data.tangents.push(*tangent);
                data.positions.len() as u32 - 1
            });
        }
        // the polygons keep their own numbering of vertices
        Mesh { data, bounds: self.bounds, polygons: self.polygons.clone() }
    }

    /// Three positions each, counter-clockwise seen from outside.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.data.triangles
    }

    /// The box around all positions.
    pub fn bounds(&self) -> Bounds {
        self.bounds
    }

    /// The corners of triangle `index`.
    #[inline]
    pub fn corners(&self, index: usize) -> [Vec3<f32>; 3] {
        self.data.triangles[index].map(|i| self.data.positions[i as usize])
    }

    /// Replaces the normals by angle-weighted means of the faces around each vertex
    /// (Thürmer & Wüthrich, *Computing Vertex Normals from Polygonal Facets*, 1998). Drops tangents, which belong to the
    /// old normals.
    pub fn smooth(&mut self) {
        self.data.tangents = Vec::new();
        self.data.normals = angle_weighted_normals(&self.data.positions, &self.data.triangles);
        self.polygons = self.polygons.as_ref().map(|p| Arc::new(p.smoothed()));
    }

    /// Drops normals and tangents: every triangle is flat.
    pub fn flatten(&mut self) {
        self.data.tangents = Vec::new();
        self.data.normals = Vec::new();
        self.polygons = self.polygons.as_ref().map(|p| Arc::new(p.flattened()));
    }

    /// Surface area, square metres.
    pub fn area(&self) -> f64 {
        let half = |&t: &[u32; 3]| 0.5 * double_area_vector(&self.data.positions, t).length();
        self.data.triangles.iter().map(half).sum()
    }

    /// Gives the parts back.
    pub fn into_data(self) -> MeshData {
        self.data
    }
}

/// Twice the area of a triangle along its normal, in f64.
pub(crate) fn double_area_vector(positions: &[Vec3<f32>], t: [u32; 3]) -> Vec3<f64> {
    let [a, b, c] = t.map(|i| widen(positions[i as usize]));
    (b - a).cross(c - a)
}

fn check_counts(data: &MeshData) -> Result<()> {
    let count = data.positions.len();
    for (what, n) in [
        ("normals", data.normals.len()),
        ("texture coordinates", data.uvs.len()),
        ("second texture coordinates", data.uvs_1.len()),
        ("tangents", data.tangents.len()),
    ] {
        if n != 0 && n != count {
            return Err(Error::new(format!(
                "mesh has {n} {what} for {count} positions, one each or none are accepted"
            )));
        }
    }
    let limit = 1 << 30;
    if data.triangles.len() > limit || count > u32::MAX as usize {
        return Err(Error::new(format!(
            "mesh has {} triangles and {count} positions, at most {limit} triangles are accepted",
            data.triangles.len()
        ))
        .hint("split the mesh into several"));
    }
    Ok(())
}

fn check_positions(positions: &[Vec3<f32>]) -> Result<Bounds> {
    let mut bounds = Bounds::EMPTY;
    for (i, p) in positions.iter().enumerate() {
        // the comparison fails for NaN too
        if !p.to_array().iter().all(|x| x.abs() <= MAX_COORDINATE) {
            return Err(Error::new(format!(
                "vertex {i} is at {:?}, coordinates from {:e} to {MAX_COORDINATE:e} are accepted",
                p.to_array(),
                -MAX_COORDINATE
            )));
        }
        bounds.add(*p);
    }
    Ok(bounds)
}

fn check_indices(data: &MeshData) -> Result<()> {
    let count = data.positions.len();
    for (i, t) in data.triangles.iter().enumerate() {
        if let Some(index) = t.iter().find(|&&v| v as usize >= count) {
            return Err(Error::new(format!(
                "triangle {i} uses vertex {index}, but the mesh has {count} vertices (counted from 0)"
            )));
        }
    }
    Ok(())
}

fn repair_uvs(uvs: &mut [[f32; 2]]) -> usize {
    let mut replaced = 0;
    for uv in uvs.iter_mut().filter(|uv| !(uv[0].is_finite() && uv[1].is_finite())) {
        *uv = [0.0; 2];
        replaced += 1;
    }
    replaced
}

/// Tangents can be made anew, so that one which is no direction drops them all.
fn drop_bad_tangents(tangents: &mut Vec<[f32; 4]>) -> bool {
    let usable = |t: &[f32; 4]| {
        let length = vec3(t[0], t[1], t[2]).length();
        length.is_finite() && length > 1e-6 && t[3].is_finite()
    };
    let bad = !tangents.iter().all(usable);
    if bad {
        tangents.clear();
    }
    bad
}

fn repair_normals(data: &mut MeshData) -> usize {
    let mut bad = Vec::new();
    for (i, n) in data.normals.iter_mut().enumerate() {
        let wide = widen(*n);
        let length = wide.length();
        if length.is_finite() && length > 1e-30 {
            *n = narrow(wide / length);
        } else {
            bad.push(i);
        }
    }
    if !bad.is_empty() {
        let around = angle_weighted_normals(&data.positions, &data.triangles);
        for &i in &bad {
            data.normals[i] = around[i];
        }
    }
    bad.len()
}

fn turn_triangles(data: &mut MeshData) -> usize {
    if data.normals.is_empty() {
        return 0;
    }
    let mut turned = 0;
    for t in &mut data.triangles {
        let around = t.iter().fold(Vec3::ZERO, |sum, &i| sum + widen(data.normals[i as usize]));
        if double_area_vector(&data.positions, *t).dot(around) < 0.0 {
            t.swap(1, 2);
            turned += 1;
        }
    }
    turned
}

/// For every position the number of the first one with the same coordinates: a seam of the texture coordinates is no
/// seam of the surface.
pub(crate) fn first_equal(positions: &[Vec3<f32>]) -> Vec<u32> {
    let mut first = std::collections::HashMap::with_capacity(positions.len());
    // adding 0 turns -0 into 0
    let key = |p: &Vec3<f32>| p.to_array().map(|x| (x + 0.0).to_bits());
    positions.iter().enumerate().map(|(i, p)| *first.entry(key(p)).or_insert(i as u32)).collect()
}

/// Unit normals; +z for a vertex whose faces cancel or that has none.
fn angle_weighted_normals(positions: &[Vec3<f32>], triangles: &[[u32; 3]]) -> Vec<Vec3<f32>> {
    let first = first_equal(positions);
    let mut sums = vec![Vec3::<f32>::ZERO; positions.len()];
    for &t in triangles {
        let n = double_area_vector(positions, t);
        let n = n / n.length().max(f64::MIN_POSITIVE);
        let p = t.map(|i| widen(positions[i as usize]));
        for k in 0..3 {
            let (a, b) = (p[(k + 1) % 3] - p[k], p[(k + 2) % 3] - p[k]);
            let angle = a.cross(b).length().atan2(a.dot(b));
            let sum = &mut sums[first[t[k] as usize] as usize];
            *sum = *sum + narrow(n * angle);
        }
    }
    let unit = |&f: &u32| {
        let sum = sums[f as usize];
        let length = sum.length();
        if length > 1e-6 { sum / length } else { vec3(0.0, 0.0, 1.0) }
    };
    first.iter().map(unit).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shapes::cube;

    fn triangle() -> MeshData {
        MeshData {
            positions: vec![vec3(0.0, 0.0, 0.0), vec3(2.0, 0.0, 0.0), vec3(0.0, 3.0, 0.0)],
            triangles: vec![[0, 1, 2]],
            ..MeshData::default()
        }
    }

    #[test]
    fn area_of_a_right_triangle_is_half_the_product_of_its_legs() {
        assert_eq!(Mesh::new(triangle()).unwrap().0.area(), 3.0);
    }

    #[test]
    fn vertices_that_are_not_finite_are_named() {
        for bad in [f32::NAN, f32::INFINITY, -2e12] {
            let mut data = triangle();
            data.positions[1].y = bad;
            let message = Mesh::new(data).unwrap_err().to_string();
            assert!(message.contains("vertex 1"), "{message}");
        }
    }

    #[test]
    fn an_index_out_of_range_is_an_error() {
        let mut data = triangle();
        data.triangles.push([0, 1, 3]);
        let message = Mesh::new(data).unwrap_err().to_string();
        assert!(message.contains("triangle 1 uses vertex 3"), "{message}");
    }

    #[test]
    fn triangles_without_area_are_dropped_and_counted() {
        let mut data = triangle();
        data.positions.push(vec3(4.0, 0.0, 0.0));
        data.triangles.extend([[0, 0, 1], [0, 1, 3], [1, 1, 1]]);
        let (mesh, repairs) = Mesh::new(data).unwrap();
        assert_eq!((mesh.triangles().len(), repairs.degenerate_triangles), (1, 3));
    }

    #[test]
    fn unusable_normals_and_uvs_are_replaced_and_counted() {
        let mut data = triangle();
        data.normals = vec![vec3(0.0, 0.0, 5.0), vec3(f32::NAN, 0.0, 0.0), Vec3::ZERO];
        data.uvs = vec![[0.5, 0.5], [f32::INFINITY, 0.0], [0.0, 0.0]];
        let (mesh, repairs) = Mesh::new(data).unwrap();
        assert_eq!((repairs.replaced_normals, repairs.replaced_uvs), (2, 1));
        // one ulp: `Vec3` divides by multiplying with the reciprocal
        assert!(mesh.normals().iter().all(|n| (*n - Vec3::Z).length() <= f32::EPSILON));
    }

    #[test]
    fn triangles_that_wind_against_their_normals_are_turned_and_counted() {
        let mut data = triangle();
        data.normals = vec![vec3(0.0, 0.0, -1.0); 3];
        let (mesh, repairs) = Mesh::new(data).unwrap();
        assert_eq!((mesh.triangles(), repairs.turned_triangles), (&[[0, 2, 1]][..], 1));
    }

    #[test]
    fn attribute_counts_must_match() {
        let mut data = triangle();
        data.uvs = vec![[0.0; 2]; 2];
        assert!(Mesh::new(data).unwrap_err().to_string().contains("2 texture coordinates for 3 positions"));
    }

    #[test]
    fn smooth_normals_of_a_cube_point_along_the_diagonals_across_seams() {
        // by symmetry, whatever way the faces are cut into triangles: angles sum to 90 degrees per face
        let mut mesh = cube();
        mesh.smooth();
        for (p, n) in mesh.positions().iter().zip(mesh.normals()) {
            assert!((p.normalize() - *n).length() < 4.0 * f32::EPSILON, "{p:?} {n:?}");
        }
    }
}
