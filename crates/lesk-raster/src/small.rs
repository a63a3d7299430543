//! Small triangles, eight columns at a time, with AVX2.
//!
//! A sample lies inside where three edge functions of whole numbers are not negative (Pineda, *A Parallel Algorithm for
//! Polygon Rasterization*, SIGGRAPH 1988). Up to [`REACH`] steps they fit into 32 bits, so they are exact.

use crate::scan::{Band, Plane, centre, centres};
use crate::view::{STEPS, Screen};
use std::arch::x86_64::*;

/// Largest width and height, steps: products of two such lengths, one of them with a row of lanes more, stay below 2^30.
const REACH: i32 = 64 * STEPS;

/// Columns that are done at once.
const LANES: usize = 8;

/// Whether a triangle is small enough.
#[inline]
pub(crate) fn is_small([a, b, c]: &[Screen; 3]) -> bool {
    let spread = |a: i32, b: i32, c: i32| a.max(b).max(c) - a.min(b).min(c);
    spread(a.x, b.x, c.x) <= REACH && spread(a.y, b.y, c.y) <= REACH
}

/// An edge function: at least 0 inside and on left and top edges.
struct Edge {
    value: i32,
    per_column: i32,
    per_row: i32,
}

impl Edge {
    /// Of the edge from `a` to `b`, the inside on its right hand on the screen, at the sample (`x`, `y`), steps.
    #[inline(always)]
    fn new(a: Screen, b: Screen, x: i32, y: i32) -> Edge {
        let (dx, dy) = (b.x - a.x, b.y - a.y);
        // an edge that leads up has the inside at its right: it is a left one
        let has_border = dy < 0 || (dy == 0 && dx > 0);
        let value = dx * (y - a.y) - dy * (x - a.x) - i32::from(!has_border);
        Edge { value, per_column: -dy * STEPS, per_row: dx * STEPS }
    }
}

/// Draws a small triangle.
#[target_feature(enable = "avx2")]
pub(crate) fn triangle(band: &mut Band, id: u32, corners: [Screen; 3]) {
    let [a, b, c] = corners;
    let area = (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
    let columns = centres(a.x.min(b.x).min(c.x), a.x.max(b.x).max(c.x), band.width);
    let rows = band.covered(a.y.min(b.y).min(c.y), a.y.max(b.y).max(c.y));
    if area == 0 || columns.is_empty() || rows.is_empty() {
        return;
    }
    // most of the smallest triangles lie between the samples
    let mut plane = None;
    let (b, c) = if area > 0 { (b, c) } else { (c, b) };
    let (x, y) = (centre(columns.start), centre(rows.start));
    let edges = [Edge::new(a, b, x, y), Edge::new(b, c, x, y), Edge::new(c, a, x, y)];
    if columns.len() == 1 && rows.len() == 1 {
        if edges.iter().all(|edge| edge.value >= 0) {
            band.triangle_span(id, &Plane::new(corners), rows.start, columns.start as usize..columns.end as usize);
        }
        return;
    }
    let lane = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
    let all = |v: i32| _mm256_set1_epi32(v);
    let mut at_row =
        [0, 1, 2].map(|k| _mm256_add_epi32(all(edges[k].value), _mm256_mullo_epi32(all(edges[k].per_column), lane)));
    let per_row = [0, 1, 2].map(|k| all(edges[k].per_row));
    let per_lanes = [0, 1, 2].map(|k| all(edges[k].per_column * LANES as i32));
    let offsets = _mm256_mul_ps(_mm256_cvtepi32_ps(lane), _mm256_set1_ps(STEPS as f32));
    let ids = all(id as i32);
    for y in rows {
        let start = band.row(y).start;
        let (mut at, mut column) = (at_row, columns.start as usize);
        while column < columns.end as usize {
            let outside = _mm256_or_si256(_mm256_or_si256(at[0], at[1]), at[2]);
            if _mm256_movemask_ps(_mm256_castsi256_ps(outside)) != 0xff {
                let plane = plane.get_or_insert_with(|| Plane::new(corners));
                // whole numbers below 2^24: exact
                let first = _mm256_set1_ps(centre(column as u32) as f32 - plane.x);
                let along = _mm256_add_ps(first, offsets);
                let z = _mm256_add_ps(_mm256_set1_ps(plane.row(y)), _mm256_mul_ps(_mm256_set1_ps(plane.per_x), along));
                // beyond the corners only rounding leads
                let z = _mm256_min_ps(_mm256_max_ps(z, _mm256_set1_ps(plane.low)), _mm256_set1_ps(plane.high));
                let from = start + column;
                // SAFETY: behind every row there is room for eight columns more, which is checked here
                unsafe {
                    let depth = band.depth[from..from + LANES].as_mut_ptr();
                    let own = band.ids[from..from + LANES].as_mut_ptr().cast::<__m256i>();
                    let before = _mm256_loadu_ps(depth);
                    let nearer = _mm256_cmp_ps::<_CMP_GT_OQ>(z, before);
                    let shown = _mm256_andnot_ps(_mm256_castsi256_ps(_mm256_srai_epi32::<31>(outside)), nearer);
                    _mm256_storeu_ps(depth, _mm256_blendv_ps(before, z, shown));
                    let numbers = _mm256_loadu_si256(own);
                    _mm256_storeu_si256(own, _mm256_blendv_epi8(numbers, ids, _mm256_castps_si256(shown)));
                }
            }
            at = [0, 1, 2].map(|k| _mm256_add_epi32(at[k], per_lanes[k]));
            column += LANES;
        }
        at_row = [0, 1, 2].map(|k| _mm256_add_epi32(at_row[k], per_row[k]));
    }
}
