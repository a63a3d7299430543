//! Polygons of files cut into triangles.

use crate::transform::widen;
use lesk_math::Vec3;

/// Corners above which a polygon is cut as a fan: cutting ears takes cubic time.
const MAX_EARS: usize = 64;

/// Cuts the polygon with the given corners (numbers of positions) into triangles of the same winding.
///
/// A quadrilateral is cut along the diagonal that leaves no triangle turned over, and of two such along the shorter
/// one; larger polygons by ears (Meisters 1975) in the plane of their normal. Numbers out of range are passed on as a
/// fan, for the mesh to report.
pub fn triangulate(positions: &[Vec3<f32>], polygon: &[u32], out: &mut Vec<[u32; 3]>) {
    let fan = |out: &mut Vec<[u32; 3]>| {
        out.extend((2..polygon.len()).map(|i| [polygon[0], polygon[i - 1], polygon[i]]));
    };
    if polygon.len() <= 3 || polygon.len() > MAX_EARS || polygon.iter().any(|&i| i as usize >= positions.len()) {
        return fan(out);
    }
    let corners: Vec<Vec3<f64>> = polygon.iter().map(|&i| widen(positions[i as usize])).collect();
    let normal = newell_normal(&corners);
    if !(normal.length() > 0.0 && normal.length().is_finite()) {
        return fan(out);
    }
    match polygon {
        &[a, b, c, d] => {
            if cut_from_second(&corners, normal) {
                out.extend([[b, c, d], [b, d, a]]);
            } else {
                out.extend([[a, b, c], [a, c, d]]);
            }
        }
        _ => cut_ears(polygon, &corners, normal, out),
    }
}

/// The area vector of a closed polygon.
fn newell_normal(p: &[Vec3<f64>]) -> Vec3<f64> {
    let edge = |i: usize| (p[i] - p[0]).cross(p[(i + 1) % p.len()] - p[0]);
    (0..p.len()).fold(Vec3::ZERO, |sum, i| sum + edge(i))
}

/// Whether a quadrilateral should be cut between its second and fourth corner.
fn cut_from_second(p: &[Vec3<f64>], normal: Vec3<f64>) -> bool {
    let upright = |a: usize, b: usize, c: usize| (p[b] - p[a]).cross(p[c] - p[a]).dot(normal) > 0.0;
    let first = upright(0, 1, 2) && upright(0, 2, 3);
    let second = upright(1, 2, 3) && upright(1, 3, 0);
    let shorter = (p[3] - p[1]).length_squared() < (p[2] - p[0]).length_squared();
    second && (!first || shorter)
}

fn cut_ears(polygon: &[u32], p: &[Vec3<f64>], normal: Vec3<f64>, out: &mut Vec<[u32; 3]>) {
    let side = |a: usize, b: usize, c: usize| (p[b] - p[a]).cross(p[c] - p[a]).dot(normal);
    let mut left: Vec<usize> = (0..polygon.len()).collect();
    while left.len() > 3 {
        let n = left.len();
        let is_ear = |&k: &usize| {
            let (a, b, c) = (left[(k + n - 1) % n], left[k], left[(k + 1) % n]);
            let inside = |&q: &usize| side(a, b, q) >= 0.0 && side(b, c, q) >= 0.0 && side(c, a, q) >= 0.0;
            let others = |q: &&usize| ![a, b, c].contains(*q) && p[**q] != p[a] && p[**q] != p[b] && p[**q] != p[c];
            side(a, b, c) > 0.0 && !left.iter().filter(others).any(inside)
        };
        // a polygon that crosses itself may have no ear left: cut anywhere
        let k = (0..n).find(is_ear).unwrap_or(0);
        out.push([left[(k + n - 1) % n], left[k], left[(k + 1) % n]].map(|i| polygon[i]));
        left.remove(k);
    }
    out.push([left[0], left[1], left[2]].map(|i| polygon[i]));
}

#[cfg(test)]
mod tests {
    use super::*;
    use lesk_math::vec3;

    fn area(positions: &[Vec3<f32>], triangles: &[[u32; 3]]) -> (f64, bool) {
        let vectors = triangles.iter().map(|&t| crate::mesh::double_area_vector(positions, t));
        let all: Vec<f64> = vectors.map(|v| 0.5 * v.z).collect();
        (all.iter().sum(), all.iter().all(|a| *a >= 0.0))
    }

    fn check(outline: &[[f32; 2]], expected: f64) {
        let positions: Vec<_> = outline.iter().map(|p| vec3(p[0], p[1], 0.0)).collect();
        for start in 0..outline.len() {
            let polygon: Vec<u32> = (0..outline.len()).map(|i| ((i + start) % outline.len()) as u32).collect();
            let mut out = vec![];
            triangulate(&positions, &polygon, &mut out);
            assert_eq!(out.len(), outline.len() - 2);
            let (sum, upright) = area(&positions, &out);
            assert!((sum - expected).abs() < 1e-9 && upright, "{outline:?} from {start}: {out:?}");
        }
    }

    #[test]
    fn concave_polygons_are_covered_once_from_any_first_corner() {
        check(&[[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]], 2.0);
        // an arrow head
        check(&[[0.0, 0.0], [2.0, -1.0], [0.5, 0.0], [2.0, 1.0]], 0.5);
        // an L
        check(&[[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]], 3.0);
        // a comb
        let comb = [[0.0, 0.0], [5.0, 0.0], [5.0, 2.0], [4.0, 2.0], [4.0, 1.0], [3.0, 1.0], [3.0, 2.0], [0.0, 2.0]];
        check(&comb, 9.0);
    }

    #[test]
    fn polygons_that_are_no_polygons_give_some_triangles_and_no_panic() {
        let positions = vec![Vec3::ZERO; 4];
        for polygon in [&[][..], &[0], &[0, 1], &[0, 1, 2, 3, 0, 1], &[0, 9, 2, 3, 1]] {
            let mut out = vec![];
            triangulate(&positions, polygon, &mut out);
            assert_eq!(out.len(), polygon.len().saturating_sub(2));
        }
    }
}
