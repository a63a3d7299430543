//! A picture on a mesh.

use super::{Mean, Picture};
use lesk_geometry::Mesh;
use lesk_image::distribution::Distribution1D;
use lesk_math::Color;
use std::sync::Arc;

/// Places on all triangles of a mesh together at which its picture is read, at most: what lies between them is found by
/// the half of the samples that knows nothing of the picture.
const MOST_PLACES: usize = 1 << 21;

/// Small triangles along each side of a triangle with several texels, at least: their mean is the flux.
const LEAST_CELLS: usize = 64;

/// A mesh with the light of each triangle.
#[derive(Clone, Debug)]
pub(crate) struct MeshMap {
    mesh: Arc<Mesh>,
    set: usize,
    triangles: Vec<Lit>,
}

/// The picture on one triangle.
#[derive(Clone, Debug)]
struct Lit {
    mean: Color<f32>,
    /// Small triangles along each side, and how bright each of them is; `None` where the triangle is one.
    cells: Option<(usize, Distribution1D)>,
}

impl MeshMap {
    pub fn new(picture: &Picture, mesh: Arc<Mesh>, set: usize) -> Self {
        let mut map = MeshMap { mesh, set, triangles: Vec::new() };
        let count = map.mesh.triangles().len();
        let most = ((MOST_PLACES / count.max(1)) as f64).sqrt() as usize;
        map.triangles = (0..count).map(|i| map.lit(picture, i, most.max(1))).collect();
        map
    }

    pub fn mean(&self, triangle: usize) -> Color<f32> {
        self.triangles[triangle].mean
    }

    pub fn uv(&self, triangle: usize, weights: [f64; 3]) -> [f32; 2] {
        self.mesh.uv(self.set, triangle, weights).or(self.mesh.uv(0, triangle, weights)).unwrap_or([0.0; 2])
    }

    /// About one place per texel, in the middles of small triangles of equal area.
    fn lit(&self, picture: &Picture, triangle: usize, most: usize) -> Lit {
        let [w, h] = picture.size();
        let corners = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|c| picture.place(self.uv(triangle, c)));
        let apart = |a: [f32; 2], b: [f32; 2]| ((a[0] - b[0]) * w as f32).hypot((a[1] - b[1]) * h as f32);
        let longest =
            apart(corners[0], corners[1]).max(apart(corners[1], corners[2])).max(apart(corners[2], corners[0]));
        // as: a huge or NaN distance saturates
        let n = if longest > 1.0 { (longest.ceil() as usize).max(LEAST_CELLS) } else { 1 }.min(most);
        let mut mean = Mean::default();
        let mut weights = Vec::with_capacity(n * n);
        for cell in 0..n * n {
            let [a, b, c] = corners_of(n, cell);
            let weight = |k: usize| (a[k] + b[k] + c[k]) / 3.0;
            let value = picture.at(self.uv(triangle, [1.0 - weight(0) - weight(1), weight(0), weight(1)]));
            mean.add(value, 1.0);
            weights.push(f64::from(value.luminance()));
        }
        let varied = n > 1 && weights.iter().any(|w| *w != weights[0]);
        let cells = if varied { Distribution1D::new(weights).ok().map(|pick| (n, pick)) } else { None };
        Lit { mean: mean.color(), cells }
    }

    /// Whether a triangle is brighter in some places than in others.
    pub fn varies(&self, triangle: usize) -> bool {
        self.triangles[triangle].cells.is_some()
    }

    /// Barycentric weights of a point of a triangle where the picture is bright; `None` where it is the same all over.
    pub fn sample(&self, triangle: usize, u: [f32; 2]) -> Option<[f64; 3]> {
        let (n, pick) = self.triangles[triangle].cells.as_ref()?;
        let (cell, rest) = pick.sample_cell(u[0].into());
        let [a, b, c] = corners_of(*n, cell);
        let within = crate::triangle::by_area([rest as f32, u[1]]).map(f64::from);
        let [v, w] = [0, 1].map(|k| a[k] * within[0] + b[k] * within[1] + c[k] * within[2]);
        Some([(1.0 - v - w).max(0.0), v, w])
    }

    /// The density of [`sample`](Self::sample) over that of a uniform point.
    pub fn density(&self, triangle: usize, weights: [f64; 3]) -> Option<f64> {
        let (n, pick) = self.triangles[triangle].cells.as_ref()?;
        Some(pick.probability(cell_at(*n, weights)) * (n * n) as f64)
    }
}

/// The corners of a cell of n² small triangles, as weights of the second and third corner of the large one. Row i holds
/// 2 (n - i) - 1 of them, in turns upright and upside down, so that 2 n i - i² lie before it.
fn corners_of(n: usize, cell: usize) -> [[f64; 2]; 3] {
    let left = (n * n - 1 - cell) as f64;
    let row = n - 1 - (left.sqrt() as usize).min(n - 1);
    let along = cell - (2 * n * row - row * row);
    let at = |i: usize, j: usize| [i, j].map(|k| k as f64 / n as f64);
    let (i, j) = (row, along / 2);
    if along.is_multiple_of(2) {
        [at(i, j), at(i + 1, j), at(i, j + 1)]
    } else {
        [at(i + 1, j + 1), at(i, j + 1), at(i + 1, j)]
    }
}

/// The cell that holds a point.
fn cell_at(n: usize, [_, v, w]: [f64; 3]) -> usize {
    let (v, w) = (v * n as f64, w * n as f64);
    let row = (v as usize).min(n - 1);
    let column = (w as usize).min(n - 1 - row);
    let upside_down = (v - row as f64) + (w - column as f64) > 1.0 && row + column + 1 < n;
    2 * n * row - row * row + 2 * column + usize::from(upside_down)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_cell_is_found_by_its_middle() {
        for n in [1, 2, 3, 7, 100] {
            for cell in 0..n * n {
                let [a, b, c] = corners_of(n, cell);
                let [v, w] = [0, 1].map(|k| (a[k] + b[k] + c[k]) / 3.0);
                assert_eq!(cell_at(n, [1.0 - v - w, v, w]), cell, "{n}");
            }
        }
    }
}
