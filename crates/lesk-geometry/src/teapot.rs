//! The Utah teapot (Newell 1975), evaluated from its published Bézier patches.

use crate::mesh::{Mesh, MeshData};
use crate::polygons::{Corner, PolygonData, PolygonMesh, grid_polygons};
use crate::transform::narrow;
use lesk_math::{Vec3, vec3};
use std::collections::HashMap;
use std::sync::Arc;

/// The control points and patches; see `data/teapot/PROVENANCE.md`.
const TABLE: &str = include_str!("../../../data/teapot/patches.txt");

/// Cells along each side of a patch, at most: 32 * 2 * 256^2 is 4.2 million triangles.
const MAX_LEVEL: u32 = 256;

/// Normals that differ by less than this belong to one smooth surface.
const COS_CREASE: f64 = 0.866_025_403_784_438_6; // 30 degrees

/// The teapot with bottom, each of its 32 patches cut into `level` by `level` cells (1 to 256; 16 looks smooth).
///
/// z is up, the pot stands on z = 0 and reaches 3.15; its body has a radius of 2 around the z axis, the spout points to
/// +x. Normals are those of the patches. Neighbouring patches have the same vertices, bit for bit. Texture coordinates
/// run around and along each part: body, lid, handle, spout, bottom.
pub fn teapot(level: u32) -> Mesh {
    let n = level.clamp(1, MAX_LEVEL) as usize;
    let patches = patches();
    let mut data = MeshData::default();
    let mut normals = Vec::new();
    for (number, patch) in patches.iter().enumerate() {
        let base = data.positions.len();
        for (i, j) in (0..=n).flat_map(|i| (0..=n).map(move |j| (i, j))) {
            data.positions.push(narrow(patch.position(i, j, n)));
            normals.push(patch.normal(i as f64 / n as f64, j as f64 / n as f64));
            data.uvs.push(uv(number, i as f64 / n as f64, j as f64 / n as f64));
        }
        add_cells(base as u32, n as u32, &mut data);
    }
    data.normals = joined_normals(&data.positions, &normals);
    let polygons = Arc::new(cells(&data, n as u32));
    Mesh::new(data).expect("the published patches are valid").0.with_polygons(polygons)
}

/// The cells of all patches as faces of four corners, three where a side has shrunk to a point.
fn cells(data: &MeshData, n: u32) -> PolygonMesh {
    let mut out = PolygonData {
        positions: data.positions.clone(),
        normals: data.normals.clone(),
        uvs: data.uvs.clone(),
        analytic: true,
        ..PolygonData::default()
    };
    let vertices = (n + 1) * (n + 1);
    for (patch, i, j) in (0..data.positions.len() as u32 / vertices)
        .flat_map(|patch| (0..n).flat_map(move |i| (0..n).map(move |j| (patch, i, j))))
    {
        let at = |i: u32, j: u32| patch * vertices + i * (n + 1) + j;
        let mut face = vec![at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)];
        let position = |v: u32| data.positions[v as usize];
        face.dedup_by(|b, a| position(*a) == position(*b));
        if position(face[0]) == position(face[face.len() - 1]) {
            face.pop();
        }
        if face.len() >= 3 {
            out.sizes.push(face.len() as u32);
            out.corners.extend(face.iter().map(|&v| Corner { position: v, normal: v, uv: v }));
        }
    }
    PolygonMesh::new(out).expect("the published patches are valid")
}

/// A bicubic Bézier patch as `level` by `level` faces (1 to 256) with its own normals, which point along dp/du × dp/dv.
///
/// The sixteen control points stand row by row; u runs along a row, v from the first row to the last.
pub fn bezier_patch(points: &[Vec3<f64>; 16], level: u32) -> PolygonMesh {
    let level = level.clamp(1, MAX_LEVEL);
    let patch = Patch { points: *points, numbers: std::array::from_fn(|k| k) };
    grid_polygons(level, level, |u, v| (patch.sum(bernstein(v), bernstein(u)), patch.normal(v, u)))
}

/// Sixteen control points, rows along the profile, columns around; and their numbers, equal where the points are.
struct Patch {
    points: [Vec3<f64>; 16],
    numbers: [usize; 16],
}

fn patches() -> Vec<Patch> {
    let words = |line: &'static str| line.split(' ').skip(1);
    let lines = |key: char| TABLE.lines().filter(move |l| l.starts_with(key));
    let number = |w: &str| w.parse::<f64>().expect("the table holds numbers");
    let points: Vec<[f64; 3]> = lines('v')
        .map(|l| {
            let v: Vec<f64> = words(l).map(number).collect();
            [v[0], v[1], v[2]]
        })
        .collect();
    // the table repeats some points under other numbers
    let first = |p: &[f64; 3]| points.iter().position(|q| q == p).expect("the point itself is there");
    let patch = |l| {
        let given: Vec<usize> = words(l).map(|w| number(w) as usize - 1).collect();
        let numbers = std::array::from_fn(|k| first(&points[given[k]]));
        Patch { points: numbers.map(|k: usize| points[k].into()), numbers }
    };
    lines('p').map(patch).collect()
}

/// Cubic Bernstein polynomials.
fn bernstein(t: f64) -> [f64; 4] {
    let s = 1.0 - t;
    [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t]
}

/// Their derivatives.
fn bernstein_slope(t: f64) -> [f64; 4] {
    let s = 1.0 - t;
    [-3.0 * s * s, 3.0 * s * (s - 2.0 * t), 3.0 * t * (2.0 * s - t), 3.0 * t * t]
}

impl Patch {
    fn sum(&self, a: [f64; 4], b: [f64; 4]) -> Vec3<f64> {
        (0..16).fold(Vec3::ZERO, |p, k| p + self.points[k] * (a[k / 4] * b[k % 4]))
    }

    /// The point at cell corner (i, j) of n; on a border, the same bits as the neighbour computes.
    fn position(&self, i: usize, j: usize, n: usize) -> Vec3<f64> {
        let border = |at: fn(usize) -> usize, k: usize| {
            let numbers: [usize; 4] = std::array::from_fn(|m| self.numbers[at(m)]);
            let points: [Vec3<f64>; 4] = std::array::from_fn(|m| self.points[at(m)]);
            curve(numbers, points, k, n)
        };
        match (i, j) {
            (0, _) => border(|m| m, j),
            (i, _) if i == n => border(|m| 12 + m, j),
            (_, 0) => border(|m| 4 * m, i),
            (_, j) if j == n => border(|m| 4 * m + 3, i),
            _ => self.sum(bernstein(i as f64 / n as f64), bernstein(j as f64 / n as f64)),
        }
    }

    /// The outward unit normal. Where a border has shrunk to a point, one derivative vanishes, and its limit along the
    /// other parameter takes its place.
    fn normal(&self, u: f64, v: f64) -> Vec3<f64> {
        let (b, d) = (bernstein, bernstein_slope);
        let mixed = self.sum(d(u), d(v));
        let limit = |slope: Vec3<f64>, across: f64| {
            let inward = if across < 0.5 { 1.0 } else { -1.0 };
            if slope.length() > 1e-9 { slope } else { mixed * inward }
        };
        let along = limit(self.sum(d(u), b(v)), v);
        let around = limit(self.sum(b(u), d(v)), u);
        around.cross(along).normalize()
    }
}

/// Point k of n of a border curve, evaluated from the end with the smaller number, whichever patch asks.
fn curve(numbers: [usize; 4], points: [Vec3<f64>; 4], k: usize, n: usize) -> Vec3<f64> {
    let backward = numbers.iter().rev().lt(numbers.iter());
    let weights = bernstein(if backward { n - k } else { k } as f64 / n as f64);
    let order = if backward { [3, 2, 1, 0] } else { [0, 1, 2, 3] };
    (0..4).fold(Vec3::ZERO, |p, m| p + points[order[m]] * weights[m])
}

/// Two triangles per cell, one where a side of the cell has shrunk to a point.
fn add_cells(base: u32, n: u32, data: &mut MeshData) {
    for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
        let at = |i: u32, j: u32| base + i * (n + 1) + j;
        let [a, b, c, d] = [at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)];
        for t in [[a, b, c], [a, c, d]] {
            let p = t.map(|v| data.positions[v as usize]);
            if p[0] != p[1] && p[1] != p[2] && p[2] != p[0] {
                data.triangles.push(t);
            }
        }
    }
}

/// Patches come in groups of four: three around the body from the rim down, handle and spout two by two, knob, lid,
/// bottom.
fn uv(patch: usize, i: f64, j: f64) -> [f32; 2] {
    let k = (patch % 4) as f64;
    let around = (k + j) / 4.0;
    let [u, v] = match patch / 4 {
        body @ 0..3 => [around, (body as f64 + i) / 3.0],
        3 | 4 => [((patch % 2) as f64 + j) / 2.0, ((patch % 4 / 2) as f64 + i) / 2.0],
        lid @ 5..7 => [around, ((lid - 5) as f64 + i) / 2.0],
        _ => [around, i],
    };
    [u as f32, v as f32]
}

/// Where patches meet smoothly, the mean of their normals.
fn joined_normals(positions: &[Vec3<f32>], normals: &[Vec3<f64>]) -> Vec<Vec3<f32>> {
    let mut at: HashMap<[u32; 3], Vec<usize>> = HashMap::new();
    let key = |p: &Vec3<f32>| p.to_array().map(|x| (x + 0.0).to_bits());
    positions.iter().enumerate().for_each(|(i, p)| at.entry(key(p)).or_default().push(i));
    let joined = |(i, p): (usize, &Vec3<f32>)| {
        let near = at[&key(p)].iter().filter(|&&k| normals[k].dot(normals[i]) > COS_CREASE);
        narrow(near.fold(vec3(0.0, 0.0, 0.0), |sum, &k| sum + normals[k]).normalize())
    };
    positions.iter().enumerate().map(joined).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::transform::widen;
    use std::collections::HashSet;

    fn bits(p: Vec3<f32>) -> [u32; 3] {
        p.to_array().map(|x| (x + 0.0).to_bits())
    }

    #[test]
    fn level_8_agrees_with_an_independent_evaluation() {
        // numpy evaluation of the same table with 8 x 8 quads per patch: 2081 distinct vertices, 1984 quads and 64
        // triangles, signed volume 25.6807 (which depends in the fourth digit on the diagonals)
        let m = teapot(8);
        let distinct: HashSet<_> = m.positions().iter().map(|p| bits(*p)).collect();
        assert_eq!(distinct.len(), 2081);
        assert_eq!(m.triangles().len(), 2 * 1984 + 64);
        let volume: f64 = (0..m.triangles().len())
            .map(|i| {
                let [a, b, c] = m.corners(i).map(widen);
                a.dot(b.cross(c)) / 6.0
            })
            .sum();
        assert!((volume - 25.6807).abs() < 0.02, "{volume}");
    }

    #[test]
    fn patches_meet_without_gaps() {
        // open are: the rim (4 borders), the edge of the lid (4), both ends of handle and spout (2 each)
        let n = 7;
        let m = teapot(n);
        let mut edges = HashSet::new();
        for i in 0..m.triangles().len() {
            let c = m.corners(i).map(bits);
            (0..3).for_each(|k| assert!(edges.insert((c[k], c[(k + 1) % 3])), "an edge occurs twice"));
        }
        let open = edges.iter().filter(|(a, b)| !edges.contains(&(*b, *a))).count();
        assert_eq!(open, 16 * n as usize);
    }

    #[test]
    fn normals_are_unit_and_on_the_side_of_the_winding() {
        for level in [1, 4, 16] {
            let m = teapot(level);
            assert!(m.normals().iter().all(|n| (n.length() - 1.0).abs() < 1e-6));
            if level == 16 {
                for (i, t) in m.triangles().iter().enumerate() {
                    let face = crate::mesh::double_area_vector(m.positions(), *t).normalize();
                    let least = t.iter().map(|&v| widen(m.normals()[v as usize]).dot(face)).fold(1.0, f64::min);
                    assert!(least > 0.5, "triangle {i}: {least}");
                }
            }
        }
    }

    #[test]
    fn the_top_of_the_knob_and_the_bottom_are_vertical() {
        let m = teapot(6);
        let mut poles = 0;
        for (p, n) in m.positions().iter().zip(m.normals()) {
            if p.x == 0.0 && p.y == 0.0 {
                poles += 1;
                let up = if p.z > 1.0 { 1.0 } else { -1.0 };
                assert!((n.z - up).abs() < 1e-6, "{p:?} {n:?}");
            }
        }
        assert_eq!(poles, 2 * 4 * 7);
        let b = m.bounds();
        assert_eq!((b.min.z, b.max.z), (0.0, 3.15));
    }

    #[test]
    fn normals_have_no_jump_inside_the_body() {
        // the profile of the body is smooth: vertices shared by upper and lower body have one normal
        // (the lower end of the handle touches the body at x = -2)
        let m = teapot(4);
        let mut at: HashMap<[u32; 3], Vec<Vec3<f32>>> = HashMap::new();
        let seam = |p: &Vec3<f32>| (p.z - 0.9).abs() < 1e-6 && p.x > -1.9;
        for (p, n) in m.positions().iter().zip(m.normals()).filter(|(p, _)| seam(p)) {
            at.entry(bits(*p)).or_default().push(*n);
        }
        assert!(at.len() >= 15);
        assert!(at.values().all(|n| n.iter().all(|m| (*m - n[0]).length() < 1e-6)));
    }
}
