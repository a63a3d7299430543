//! Finer faces for meshes, on the curved surface that their normals state.
//!
//! Normals are then those of the finer faces, so that the faces and their normals have one limit.
//!
//! Every new point is moved towards the planes through the corners around it, perpendicular to their normals (Boubekeur &
//! Alexa, *Phong Tessellation*, ACM TOG 27(5), 2008). Points on edges whose sides have different normals stay where they are,
//! so that sharp edges stay closed and straight.

use lesk_geometry::polygons::{Vertices, triangulate};
use lesk_math::Vec3;
use std::collections::HashMap;

/// How far points move, 1 is all the way: the value of the paper.
const SHAPE: f64 = 0.75;

type Place = [u32; 3];

/// Cuts every triangle into four and every quadrilateral into four; faces of more corners into triangles first.
pub(crate) fn subdivide(vertices: &mut Vertices, sizes: &mut Vec<u32>) {
    let faces = faces(vertices, sizes);
    let sharp = sharp_edges(vertices, &faces);
    let mut middles: HashMap<(u32, u32), u32> = HashMap::new();
    let mut corners = Vec::with_capacity(4 * vertices.corners.len());
    for face in &faces {
        let n = face.len();
        let middle: Vec<u32> = (0..n)
            .map(|k| {
                let (a, b) = (face[k].min(face[(k + 1) % n]), face[k].max(face[(k + 1) % n]));
                *middles.entry((a, b)).or_insert_with(|| {
                    let bends = !sharp.get(&edge(vertices, a, b)).is_some_and(|e| e.sharp);
                    add(vertices, &[a, b], bends)
                })
            })
            .collect();
        let centre = if n == 4 { Some(add(vertices, face, true)) } else { None };
        for k in 0..n {
            let before = middle[(k + n - 1) % n];
            match centre {
                Some(centre) => corners.extend([face[k], middle[k], centre, before]),
                None => corners.extend([face[k], middle[k], before]),
            }
        }
        if centre.is_none() {
            corners.extend([middle[0], middle[1], middle[2]]);
        }
    }
    *sizes = faces.iter().flat_map(|face| [face.len() as u32; 4]).collect();
    vertices.corners = corners;
    renew(vertices, sizes);
}

/// Normals as the mean of those of the faces around, weighted by their angles; vertices of one place and about one normal,
/// as at seams of a texture, share it.
fn renew(vertices: &mut Vertices, sizes: &[u32]) {
    let mut at: HashMap<Place, Vec<(Vec3<f32>, usize)>> = HashMap::new();
    let mut sums: Vec<Vec3<f64>> = Vec::new();
    let group: Vec<usize> = vertices
        .positions
        .iter()
        .zip(&vertices.normals)
        .map(|(p, &n)| {
            let known = at.entry(bits(*p)).or_default();
            if let Some((_, group)) = known.iter().find(|(other, _)| other.dot(n) > 0.999) {
                return *group;
            }
            sums.push(Vec3::ZERO);
            known.push((n, sums.len() - 1));
            sums.len() - 1
        })
        .collect();
    let wide = |v: u32| vertices.positions[v as usize].map(f64::from);
    let mut start = 0;
    for &size in sizes {
        let face = &vertices.corners[start..start + size as usize];
        start += size as usize;
        for (k, &v) in face.iter().enumerate() {
            let (before, after) = (face[(k + face.len() - 1) % face.len()], face[(k + 1) % face.len()]);
            let (a, b) = (wide(after) - wide(v), wide(before) - wide(v));
            let across = a.cross(b);
            let length = across.length();
            if length > 0.0 {
                let sum = &mut sums[group[v as usize]];
                *sum = *sum + across * (length.atan2(a.dot(b)) / length);
            }
        }
    }
    for (n, &group) in vertices.normals.iter_mut().zip(&group) {
        let sum = sums[group];
        if sum.length() > 1e-9 {
            *n = sum.normalize().map(|x| x as f32);
        }
    }
}

/// Triangles and quadrilaterals.
fn faces(vertices: &Vertices, sizes: &[u32]) -> Vec<Vec<u32>> {
    let mut out = Vec::with_capacity(sizes.len());
    let (mut start, mut triangles) = (0, Vec::new());
    for &size in sizes {
        let face = &vertices.corners[start..start + size as usize];
        start += size as usize;
        if size <= 4 {
            out.push(face.to_vec());
            continue;
        }
        triangles.clear();
        triangulate(&vertices.positions, face, &mut triangles);
        out.extend(triangles.iter().map(|t| t.to_vec()));
    }
    out
}

/// An edge by the places of its ends, and the normals of the first face that had it.
struct Edge {
    normals: [Place; 2],
    sharp: bool,
}

fn bits(v: Vec3<f32>) -> Place {
    // adding 0 turns -0 into 0
    v.to_array().map(|x| (x + 0.0).to_bits())
}

/// The key of an edge: its ends in a fixed order.
fn edge(vertices: &Vertices, a: u32, b: u32) -> [Place; 2] {
    let ends = [a, b].map(|v| bits(vertices.positions[v as usize]));
    if ends[0] <= ends[1] { ends } else { [ends[1], ends[0]] }
}

/// All edges; sharp are those whose faces have different normals there.
fn sharp_edges(vertices: &Vertices, faces: &[Vec<u32>]) -> HashMap<[Place; 2], Edge> {
    let mut out: HashMap<[Place; 2], Edge> = HashMap::new();
    for face in faces {
        for (k, &a) in face.iter().enumerate() {
            let b = face[(k + 1) % face.len()];
            let key = edge(vertices, a, b);
            let mut normals = [a, b].map(|v| bits(vertices.normals[v as usize]));
            if key[0] != bits(vertices.positions[a as usize]) {
                normals.reverse();
            }
            let known = out.entry(key).or_insert(Edge { normals, sharp: false });
            known.sharp |= known.normals != normals;
        }
    }
    out
}

/// Adds the vertex in the middle of others and returns its number.
fn add(vertices: &mut Vertices, around: &[u32], bends: bool) -> u32 {
    let share = 1.0 / around.len() as f64;
    let of = |list: &[Vec3<f32>], v: u32| list[v as usize].map(f64::from);
    let mean = |list: &[Vec3<f32>]| around.iter().fold(Vec3::<f64>::ZERO, |sum, &v| sum + of(list, v) * share);
    let p = mean(&vertices.positions);
    let pull = around.iter().fold(Vec3::<f64>::ZERO, |sum, &v| {
        let n = of(&vertices.normals, v);
        sum - n * ((p - of(&vertices.positions, v)).dot(n) * share)
    });
    let n = mean(&vertices.normals);
    // normals that cancel: that of a corner
    let n = if n.length() > 1e-9 { n.normalize() } else { of(&vertices.normals, around[0]) };
    let p = if bends { p + pull * SHAPE } else { p };
    vertices.positions.push(p.map(|x| x as f32));
    vertices.normals.push(n.map(|x| x as f32));
    if !vertices.uvs.is_empty() {
        let uv = [0, 1].map(|c| around.iter().map(|&v| f64::from(vertices.uvs[v as usize][c]) * share).sum::<f64>());
        vertices.uvs.push(uv.map(|x| x as f32));
    }
    vertices.positions.len() as u32 - 1
}

#[cfg(test)]
mod tests {
    use super::*;
    use lesk_math::vec3;

    /// An octahedron in the unit sphere, with the normals of the sphere.
    fn octahedron() -> (Vertices, Vec<u32>) {
        let axes = [[1, 0, 0], [0, 1, 0], [0, 0, 1], [-1, 0, 0], [0, -1, 0], [0, 0, -1]];
        let positions: Vec<Vec3<f32>> = axes.iter().map(|a| Vec3::from(a.map(|x| x as f32))).collect();
        let mut corners = Vec::new();
        for (x, y, z) in [(0, 1, 2), (1, 3, 2), (3, 4, 2), (4, 0, 2), (1, 0, 5), (3, 1, 5), (4, 3, 5), (0, 4, 5)] {
            corners.extend([x, y, z]);
        }
        (Vertices { normals: positions.clone(), positions, uvs: vec![], corners }, vec![3; 8])
    }

    #[test]
    fn an_octahedron_with_the_normals_of_its_sphere_becomes_a_ball_without_cracks() {
        let (mut vertices, mut sizes) = octahedron();
        for level in 1..4u32 {
            subdivide(&mut vertices, &mut sizes);
            assert_eq!(sizes.len(), 8 * 4usize.pow(level));
            // Euler: a closed surface has F/2 + 2 vertices; a crack would have more
            assert_eq!(vertices.positions.len(), sizes.len() / 2 + 2);
        }
        // the middle of an edge, 1/sqrt 2 from the centre, lies 1/2 below the planes of both ends, along (1, 1)/2 on average
        let expected = 0.5f64.sqrt() * (1.0 + 0.75 * 0.5);
        let first = f64::from(vertices.positions[6].length());
        assert!((first - expected).abs() < 1e-6, "{first} {expected}");
        assert!(vertices.positions.iter().all(|p| (0.9..1.1).contains(&p.length())));
    }

    #[test]
    fn edges_between_different_normals_stay_straight_and_closed() {
        // a ridge: two quadrilaterals that share places, not normals; their outer corners lean
        let (a, b) = (vec3(0.0, 0.0, 1.0), vec3(0.0, 2.0, 1.0));
        let side = |x: f32| [vec3(x, 2.0, 0.0), vec3(x, 0.0, 0.0)];
        let ([c, d], [e, f]) = (side(-1.0), side(1.0));
        let lean = |x: f32, y: f32| vec3(x, y, 1.0).normalize();
        let mut vertices = Vertices {
            positions: vec![a, b, c, d, b, a, f, e],
            normals: [
                (-1.0, -0.2),
                (-1.0, 0.2),
                (-1.0, 0.2),
                (-1.0, -0.2),
                (1.0, 0.2),
                (1.0, -0.2),
                (1.0, -0.2),
                (1.0, 0.2),
            ]
            .map(|(x, y)| lean(x, y))
            .to_vec(),
            uvs: vec![[0.5, 0.25]; 8],
            corners: (0..8).collect(),
        };
        let mut sizes = vec![4, 4];
        subdivide(&mut vertices, &mut sizes);
        let middle = vec3(0.0, 1.0, 1.0);
        let on_ridge: Vec<_> = vertices.positions[8..].iter().filter(|p| p.x == 0.0).collect();
        assert_eq!(on_ridge, [&middle, &middle]);
        assert!(vertices.uvs.iter().all(|uv| *uv == [0.5, 0.25]) && sizes == [4; 8]);
        // the open borders bend
        assert!(vertices.positions[8..].iter().any(|p| p.x.abs() > 1.0 && p.y == 1.0));
    }
}
