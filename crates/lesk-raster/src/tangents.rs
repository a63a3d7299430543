//! Tangents of vertices, for normal maps and for brushed materials that are lit at vertices.

use lesk_geometry::polygons::{Vertices, triangulate};
use lesk_geometry::{Mesh, MeshData};
use lesk_math::Vec3;
use std::collections::HashMap;

/// A tangent along growing u and the hand: -1 where v grows against n x t, else 1; all zero where there is none.
pub(crate) type Tangent = [f32; 4];

/// Gives every vertex the tangent that its mesh states, as the path tracer sees it; else, for faces that are not those of
/// the mesh, the one that bakers of normal maps use (MikkTSpace, [`Mesh::with_tangents`]). A vertex whose corners have
/// different ones becomes several. Without texture coordinates all are zero.
pub(crate) fn split(vertices: &mut Vertices, sizes: &[u32], mesh: Option<&Mesh>) -> Vec<Tangent> {
    let own = mesh.and_then(|mesh| stated(vertices, sizes, mesh)).or_else(|| of_corners(vertices, sizes));
    let own = own.unwrap_or_else(|| vec![[0.0; 4]; vertices.corners.len()]);
    let mut known = HashMap::new();
    let mut out = Vertices::default();
    let mut tangents = Vec::new();
    for (&vertex, tangent) in vertices.corners.iter().zip(own) {
        let from = vertex as usize;
        let number = *known.entry((vertex, tangent.map(f32::to_bits))).or_insert_with(|| {
            out.positions.push(vertices.positions[from]);
            out.normals.push(vertices.normals[from]);
            out.uvs.extend(vertices.uvs.get(from));
            tangents.push(tangent);
            tangents.len() as u32 - 1
        });
        out.corners.push(number);
    }
    *vertices = out;
    tangents
}

/// The tangents of a mesh at the corners of faces, where those are its triangles.
fn stated(vertices: &Vertices, sizes: &[u32], mesh: &Mesh) -> Option<Vec<Tangent>> {
    let corners = mesh.triangles().as_flattened();
    let same = |(&own, &other): (&u32, &u32)| vertices.positions[own as usize] == mesh.positions()[other as usize];
    let all = sizes.len() == mesh.triangles().len()
        && corners.len() == vertices.corners.len()
        && vertices.corners.iter().zip(corners).all(same);
    if mesh.tangents().is_empty() || !all {
        return None;
    }
    Some(corners.iter().map(|&v| mesh.tangents()[v as usize]).collect())
}

/// The tangent of each corner of the faces: that of the first triangle of its face which has it.
fn of_corners(vertices: &Vertices, sizes: &[u32]) -> Option<Vec<Tangent>> {
    if vertices.uvs.is_empty() {
        return None;
    }
    let (mut triangles, mut faces) = (Vec::new(), Vec::new());
    let mut start = 0;
    for &size in sizes {
        let corners = &vertices.corners[start..start + size as usize];
        triangulate(&vertices.positions, corners, &mut triangles);
        faces.resize(triangles.len(), start);
        start += size as usize;
    }
    // as a mesh wants them: with an area, and winding as their normals say
    let area = |t: [u32; 3]| {
        let [a, b, c] = t.map(|v| vertices.positions[v as usize].map(f64::from));
        (b - a).cross(c - a)
    };
    let mut kept = Vec::new();
    for (mut t, start) in triangles.into_iter().zip(faces) {
        let around = t.iter().fold(Vec3::<f64>::ZERO, |sum, &v| sum + vertices.normals[v as usize].map(f64::from));
        if area(t).dot(around) < 0.0 {
            t.swap(1, 2);
        }
        if area(t).length_squared() > 0.0 {
            kept.push((t, start));
        }
    }
    let data = MeshData {
        positions: vertices.positions.clone(),
        normals: vertices.normals.clone(),
        uvs: vertices.uvs.clone(),
        triangles: kept.iter().map(|&(t, _)| t).collect(),
        ..MeshData::default()
    };
    let mesh = Mesh::new(data).ok()?.0.with_tangents(0);
    let mut out = vec![[0.0; 4]; vertices.corners.len()];
    for (&(triangle, start), made) in kept.iter().zip(mesh.triangles()) {
        for (vertex, at) in triangle.into_iter().zip(made) {
            let Some(k) = vertices.corners[start..].iter().position(|&v| v == vertex) else { continue };
            let tangent = mesh.tangents().get(*at as usize)?;
            if out[start + k] == [0.0; 4] {
                out[start + k] = *tangent;
            }
        }
    }
    Some(out)
}
