//! Shapes made of triangles.

use crate::mesh::{Mesh, MeshData};
use lesk_math::{Vec3, vec3};
use std::collections::HashMap;
use std::f64::consts::{PI, TAU};
use std::sync::{Arc, OnceLock};

/// A mesh of this file: its vertices are finite and its indices in range.
fn trusted(data: MeshData) -> Mesh {
    Mesh::new(data).expect("a generated mesh is valid").0
}

/// The square from (-1, -1) to (1, 1) in the plane z = 0, normal +z, two triangles.
pub fn rectangle() -> Mesh {
    let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    trusted(MeshData {
        positions: corners.map(|[u, v]: [f32; 2]| vec3(2.0 * u - 1.0, 2.0 * v - 1.0, 0.0)).to_vec(),
        uvs: corners.to_vec(),
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        ..MeshData::default()
    })
}

/// The one mesh that all rectangles share.
pub(crate) fn rectangle_mesh() -> &'static Arc<Mesh> {
    static MESH: OnceLock<Arc<Mesh>> = OnceLock::new();
    MESH.get_or_init(|| Arc::new(rectangle()))
}

/// The cube from -1 to 1 along every axis: flat faces, each with texture coordinates from 0 to 1.
pub fn cube() -> Mesh {
    let mut data = MeshData::default();
    for axis in 0..3 {
        for side in [-1.0f32, 1.0] {
            let base = data.positions.len() as u32;
            for [u, v] in [[0.0f32, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]] {
                let mut p = [0.0; 3];
                p[axis] = side;
                // u runs backward on the negative side, so that both wind outward
                p[(axis + 1) % 3] = side * (2.0 * u - 1.0);
                p[(axis + 2) % 3] = 2.0 * v - 1.0;
                data.positions.push(p.into());
                data.uvs.push([u, v]);
            }
            data.triangles.extend([[base, base + 1, base + 2], [base, base + 2, base + 3]]);
        }
    }
    trusted(data)
}

/// The unit sphere as `columns` by `rows` cells between azimuth and polar angle, with smooth normals; at least 3 by 2.
pub fn uv_sphere(columns: u32, rows: u32) -> Mesh {
    let (columns, rows) = (columns.clamp(3, 1 << 14), rows.clamp(2, 1 << 14));
    let mut data = MeshData::default();
    for j in 0..=rows {
        for i in 0..=columns {
            let (u, v) = (i as f64 / columns as f64, j as f64 / rows as f64);
            // the seam and the poles repeat the same positions, bit for bit
            let phi = TAU * (i % columns) as f64 / columns as f64;
            let r = if j == 0 || j == rows { 0.0 } else { (PI * v).sin() };
            let p = vec3((r * phi.cos()) as f32, (r * phi.sin()) as f32, (PI * v).cos() as f32);
            data.positions.push(p);
            data.normals.push(p);
            data.uvs.push([u as f32, 1.0 - v as f32]);
        }
    }
    let at = |i: u32, j: u32| j * (columns + 1) + i;
    for (j, i) in (0..rows).flat_map(|j| (0..columns).map(move |i| (j, i))) {
        let [a, b, c, d] = [at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)];
        data.triangles.extend([[a, b, c], [a, c, d]]);
    }
    trusted(data)
}

/// The unit sphere as an icosahedron whose triangles are split in four `level` times (20 * 4^level triangles, at most
/// level 9), closed, with shared vertices and without normals.
pub fn icosphere(level: u32) -> Mesh {
    let g = (1.0 + 5f64.sqrt()) / 2.0;
    let mut points: Vec<Vec3<f64>> = Vec::new();
    for axis in 0..3 {
        for (a, b) in [(-1.0, g), (1.0, g), (-1.0, -g), (1.0, -g)] {
            let mut p = [0.0; 3];
            (p[axis], p[(axis + 1) % 3]) = (a, b);
            points.push(Vec3::from(p).normalize());
        }
    }
    let mut triangles = hull_faces(&points);
    for _ in 0..level.min(9) {
        triangles = split(&mut points, &triangles);
    }
    trusted(MeshData {
        positions: points.iter().map(|p| crate::transform::narrow(*p)).collect(),
        triangles,
        ..MeshData::default()
    })
}

/// The faces of the icosahedron: all triples of neighbours, wound outward.
fn hull_faces(p: &[Vec3<f64>]) -> Vec<[u32; 3]> {
    // neighbours are 63.4 degrees apart, others at least 116.6
    let near = |a: usize, b: usize| p[a].dot(p[b]) > 0.3;
    let mut faces = Vec::new();
    for a in 0..12 {
        for b in a + 1..12 {
            for c in b + 1..12 {
                if near(a, b) && near(b, c) && near(c, a) {
                    let outward = (p[b] - p[a]).cross(p[c] - p[a]).dot(p[a]) > 0.0;
                    let (b, c) = if outward { (b, c) } else { (c, b) };
                    faces.push([a as u32, b as u32, c as u32]);
                }
            }
        }
    }
    faces
}

fn split(points: &mut Vec<Vec3<f64>>, triangles: &[[u32; 3]]) -> Vec<[u32; 3]> {
    let mut middles = HashMap::new();
    let mut middle = |a: u32, b: u32, points: &mut Vec<Vec3<f64>>| {
        *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
            points.push((points[a as usize] + points[b as usize]).normalize());
            points.len() as u32 - 1
        })
    };
    let mut out = Vec::with_capacity(4 * triangles.len());
    for &[a, b, c] in triangles {
        let (ab, bc, ca) = (middle(a, b, points), middle(b, c, points), middle(c, a, points));
        out.extend([[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]]);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Six times the enclosed volume; positive where triangles wind outward (divergence theorem).
    fn volume(m: &Mesh) -> f64 {
        let term = |i| {
            let [a, b, c] = m.corners(i).map(crate::transform::widen);
            a.dot(b.cross(c)) / 6.0
        };
        (0..m.triangles().len()).map(term).sum()
    }

    #[test]
    fn cube_and_rectangle_have_their_area_and_wind_outward() {
        assert_eq!(cube().area(), 24.0);
        assert_eq!(volume(&cube()), 8.0);
        assert_eq!(rectangle().area(), 4.0);
        let n = crate::mesh::double_area_vector(rectangle().positions(), [0, 1, 2]);
        assert!(n.z > 0.0);
    }

    #[test]
    fn tessellated_spheres_approach_the_volume_of_the_sphere() {
        let exact = 4.0 / 3.0 * PI;
        // the relative gap of a faceted sphere is about (edge length)^2 / 5
        assert!((volume(&icosphere(5)) / exact - 1.0).abs() < 2e-3);
        assert!((volume(&uv_sphere(128, 64)) / exact - 1.0).abs() < 2e-3);
        assert_eq!(icosphere(2).triangles().len(), 320);
    }

    #[test]
    fn every_edge_of_the_icosphere_is_shared_by_two_triangles_of_opposite_winding() {
        let m = icosphere(3);
        let mut edges = std::collections::HashSet::new();
        for t in m.triangles() {
            for k in 0..3 {
                assert!(edges.insert((t[k], t[(k + 1) % 3])));
            }
        }
        assert!(edges.iter().all(|&(a, b)| edges.contains(&(b, a))));
    }
}
