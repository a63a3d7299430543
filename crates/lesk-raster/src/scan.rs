//! Which samples a face covers, and how far away they are.
//!
//! Vertices stand on a grid of [`STEPS`] steps per sample. A sample belongs to a face if its centre lies inside, or on a
//! left or top edge; where an edge meets a line of centres is computed exactly, so faces that share an edge neither
//! overlap nor leave a gap.

use crate::view::{STEPS, Screen};
use lesk_math::Isa;

/// Columns or rows whose centres lie in `[low, high)`, steps; clipped to 0..`count`.
#[inline]
pub(crate) fn centres(low: i32, high: i32, count: u32) -> std::ops::Range<u32> {
    // the first whole number k with 256 k + 128 >= low
    let first = |v: i32| (v + STEPS / 2 - 1) >> STEPS.trailing_zeros();
    let clamp = |v: i32| v.clamp(0, count as i32) as u32;
    clamp(first(low))..clamp(first(high))
}

/// The centre of a column or row, steps.
#[inline]
pub(crate) fn centre(k: u32) -> i32 {
    k as i32 * STEPS + STEPS / 2
}

/// An edge with its upper end first.
#[derive(Clone, Copy)]
struct Side {
    x: f64,
    y: f64,
    dx: f64,
    dy: f64,
}

impl Side {
    #[inline]
    fn new(a: Screen, b: Screen) -> Side {
        let (a, b) = if a.y <= b.y { (a, b) } else { (b, a) };
        Side { x: f64::from(a.x), y: f64::from(a.y), dx: f64::from(b.x - a.x), dy: f64::from(b.y - a.y) }
    }

    /// The first column whose centre lies at or right of the edge in a row whose centre is `y`.
    ///
    /// Numerator and denominator are whole numbers below 2^53, and a quotient that is not whole differs from the next
    /// whole number by 1 / (256 · 2^24) or more, which one rounding of a number below 2^16 cannot bridge.
    #[inline]
    fn column(&self, y: f64) -> f64 {
        const HALF: f64 = STEPS as f64 / 2.0;
        let numerator = (self.x - HALF) * self.dy + (y - self.y) * self.dx;
        ceil(numerator / (self.dy * STEPS as f64))
    }
}

/// The least whole number that is not below `v`, |v| < 2^31: without SSE4.1 the library function is a call.
#[inline]
fn ceil(v: f64) -> f64 {
    let whole = f64::from(v as i32);
    if whole < v { whole + 1.0 } else { whole }
}

/// Depth over a triangle: 1/w at a column and row.
pub(crate) struct Plane {
    z: f32,
    pub x: f32,
    y: f32,
    pub per_x: f32,
    per_y: f32,
    pub low: f32,
    pub high: f32,
}

impl Plane {
    #[inline]
    pub fn new([a, b, c]: [Screen; 3]) -> Plane {
        let d = |p: i32, q: i32| f64::from(p - q);
        let area = d(b.x, a.x) * d(c.y, a.y) - d(c.x, a.x) * d(b.y, a.y);
        let (zb, zc) = (f64::from(b.inverse_w - a.inverse_w), f64::from(c.inverse_w - a.inverse_w));
        let inverse = 1.0 / area;
        let low = a.inverse_w.min(b.inverse_w).min(c.inverse_w);
        let high = a.inverse_w.max(b.inverse_w).max(c.inverse_w);
        Plane {
            z: a.inverse_w,
            x: a.x as f32,
            y: a.y as f32,
            per_x: ((zb * d(c.y, a.y) - zc * d(b.y, a.y)) * inverse) as f32,
            per_y: ((zc * d(b.x, a.x) - zb * d(c.x, a.x)) * inverse) as f32,
            low,
            high,
        }
    }

    /// The depth of a row, at column `x`.
    #[inline]
    pub fn row(&self, y: u32) -> f32 {
        self.z + self.per_y * (centre(y) as f32 - self.y)
    }
}

/// Memory behind each row that lanes may touch but never change.
const SPARE: usize = 8;

/// Depth and face number of a band of rows. Depth is 1/w; 0 is infinitely far. Face numbers begin at 1.
pub(crate) struct Band {
    pub width: u32,
    /// From one row to the next.
    stride: usize,
    /// Whether the lanes of `small.rs` may run.
    #[cfg(target_arch = "x86_64")]
    lanes: bool,
    /// First row and the one after the last.
    pub rows: std::ops::Range<u32>,
    pub depth: Vec<f32>,
    pub ids: Vec<u32>,
}

impl Band {
    pub fn new(isa: Isa) -> Band {
        assert!(isa.is_available(), "this processor lacks {}", isa.name());
        Band {
            width: 0,
            stride: 0,
            #[cfg(target_arch = "x86_64")]
            lanes: isa != Isa::Baseline,
            rows: 0..0,
            depth: Vec::new(),
            ids: Vec::new(),
        }
    }

    pub fn start(&mut self, width: u32, rows: std::ops::Range<u32>) {
        let stride = width as usize + SPARE;
        let count = stride * rows.len();
        (self.width, self.stride, self.rows) = (width, stride, rows);
        self.depth.clear();
        self.depth.resize(count, 0.0);
        self.ids.clear();
        self.ids.resize(count, 0);
    }

    #[inline]
    pub fn row(&self, y: u32) -> std::ops::Range<usize> {
        let start = (y - self.rows.start) as usize * self.stride;
        start..start + self.width as usize
    }

    /// The rows of the band that a face between two heights may cover.
    #[inline]
    pub fn covered(&self, low: i32, high: i32) -> std::ops::Range<u32> {
        let all = centres(low, high, self.rows.end);
        all.start.max(self.rows.start)..all.end
    }

    /// A triangle, by lanes where it is small.
    #[inline]
    pub fn triangle(&mut self, id: u32, corners: [Screen; 3]) {
        #[cfg(target_arch = "x86_64")]
        if self.lanes && crate::small::is_small(&corners) {
            // SAFETY: `new` set `lanes` only where the processor has AVX2
            unsafe { crate::small::triangle(self, id, corners) };
            return;
        }
        self.triangle_by_spans(id, corners);
    }

    fn triangle_by_spans(&mut self, id: u32, [a, b, c]: [Screen; 3]) {
        let order = |p: Screen, q: Screen| if p.y <= q.y { (p, q) } else { (q, p) };
        let (top, low) = order(a, b);
        let (middle, bottom) = order(low, c);
        let (top, middle) = order(top, middle);
        let rows = self.covered(top.y, bottom.y);
        if rows.is_empty() {
            return;
        }
        let d = |p: i32, q: i32| f64::from(p - q);
        // which side the middle vertex is on: positive has it on the right
        let turn = d(middle.x, top.x) * d(bottom.y, top.y) - d(bottom.x, top.x) * d(middle.y, top.y);
        if turn == 0.0 {
            return;
        }
        let plane = Plane::new([a, b, c]);
        let long = Side::new(top, bottom);
        let (upper, lower) = (Side::new(top, middle), Side::new(middle, bottom));
        let limit = f64::from(self.width);
        for y in rows {
            let cy = centre(y);
            let short = if cy < middle.y { &upper } else { &lower };
            let (p, q) = (long.column(f64::from(cy)), short.column(f64::from(cy)));
            let (left, right) = if turn > 0.0 { (p, q) } else { (q, p) };
            let (left, right) = (left.max(0.0) as usize, right.clamp(0.0, limit) as usize);
            if left < right {
                self.triangle_span(id, &plane, y, left..right);
            }
        }
    }

    #[inline]
    pub fn triangle_span(&mut self, id: u32, plane: &Plane, y: u32, columns: std::ops::Range<usize>) {
        let row = self.row(y);
        let base = plane.row(y);
        let (depth, ids) = (&mut self.depth[row.clone()][columns.clone()], &mut self.ids[row][columns.clone()]);
        let first = centre(columns.start as u32) as f32 - plane.x;
        for (k, (depth, own)) in depth.iter_mut().zip(ids).enumerate() {
            let z = base + plane.per_x * (first + (k as f32) * STEPS as f32);
            // beyond the corners only rounding leads
            let z = z.max(plane.low).min(plane.high);
            if z > *depth {
                *depth = z;
                *own = id;
            }
        }
    }

    /// A face of any number of corners; one that crosses itself is filled by the even-odd rule.
    pub fn polygon(&mut self, id: u32, corners: &[Screen], crossings: &mut Vec<Crossing>) {
        let heights = || corners.iter().map(|c| c.y);
        let (Some(low), Some(high)) = (heights().min(), heights().max()) else { return };
        for y in self.covered(low, high) {
            cross(corners, y, crossings);
            for pair in crossings.as_chunks::<2>().0 {
                self.polygon_span(id, y, pair);
            }
        }
    }

    fn polygon_span(&mut self, id: u32, y: u32, [left, right]: &[Crossing; 2]) {
        let limit = f64::from(self.width);
        let columns = left.column.max(0.0) as usize..right.column.clamp(0.0, limit) as usize;
        let row = self.row(y);
        let (low, high) = (left.inverse_w.min(right.inverse_w), left.inverse_w.max(right.inverse_w));
        for x in columns {
            let gamma = gamma(left.x, right.x, x as u32);
            let z = (left.inverse_w + (right.inverse_w - left.inverse_w) * gamma).clamp(low, high) as f32;
            let k = row.start + x;
            if z > self.depth[k] {
                self.depth[k] = z;
                self.ids[k] = id;
            }
        }
    }
}

/// Where a line of centres crosses an edge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Crossing {
    /// The first column at or right of the edge.
    pub column: f64,
    /// Where exactly, steps.
    pub x: f64,
    /// Corners at the ends, and the share of the second.
    pub ends: [usize; 2],
    pub share: f64,
    /// 1/w there.
    pub inverse_w: f64,
}

/// γ along a span from `left` to `right` (steps) at the centre of a column.
#[inline]
pub(crate) fn gamma(left: f64, right: f64, x: u32) -> f64 {
    let width = right - left;
    if width > 0.0 { ((f64::from(centre(x)) - left) / width).clamp(0.0, 1.0) } else { 0.0 }
}

/// All crossings of a row with a polygon, from left to right.
pub(crate) fn cross(corners: &[Screen], y: u32, out: &mut Vec<Crossing>) {
    out.clear();
    let cy = centre(y);
    for (k, &a) in corners.iter().enumerate() {
        let next = (k + 1) % corners.len();
        let b = corners[next];
        if (a.y <= cy) == (b.y <= cy) {
            continue;
        }
        let side = Side::new(a, b);
        let share = f64::from(cy - a.y) / f64::from(b.y - a.y);
        out.push(Crossing {
            column: side.column(f64::from(cy)),
            x: side.x + (f64::from(cy) - side.y) * side.dx / side.dy,
            ends: [k, next],
            share,
            inverse_w: f64::from(a.inverse_w) + f64::from(b.inverse_w - a.inverse_w) * share,
        });
    }
    out.sort_by(|p, q| (p.column, p.x).partial_cmp(&(q.column, q.x)).expect("crossings are finite"));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Correction;
    use crate::inside::{Row, Weighted};
    use proptest::prelude::*;

    const SIDE: u32 = 24;

    fn at(x: f64, y: f64, inverse_w: f32) -> Screen {
        Screen { x: (x * 256.0) as i32, y: (y * 256.0) as i32, inverse_w }
    }

    /// The ways to draw a triangle.
    #[derive(Clone, Copy, Debug, PartialEq)]
    enum Way {
        Usual,
        Spans,
        Polygons,
    }
    const WAYS: [Way; 3] = [Way::Usual, Way::Spans, Way::Polygons];

    fn draw(band: &mut Band, id: u32, face: &[Screen], way: Way) {
        match (face, way) {
            (&[a, b, c], Way::Usual) => band.triangle(id, [a, b, c]),
            (&[a, b, c], Way::Spans) => band.triangle_by_spans(id, [a, b, c]),
            _ => band.polygon(id, face, &mut Vec::new()),
        }
    }

    /// The numbers of a band, row by row.
    fn ids(band: &Band) -> Vec<u32> {
        band.rows.clone().flat_map(|y| band.ids[band.row(y)].to_vec()).collect()
    }

    /// How often each sample is covered by the faces, drawn one by one.
    fn cover(faces: &[Vec<Screen>], way: Way) -> Vec<u32> {
        let mut count = vec![0; (SIDE * SIDE) as usize];
        let mut band = Band::new(Isa::current());
        for face in faces {
            // two bands: the second starts inside most faces
            let mut all = Vec::new();
            for rows in [0..5, 5..SIDE] {
                band.start(SIDE, rows);
                draw(&mut band, 1, face, way);
                all.extend(ids(&band));
            }
            all.iter().zip(&mut count).for_each(|(id, n)| *n += id);
        }
        count
    }

    /// The definition: inside, or on a left or top edge. Exact in whole numbers.
    fn inside(face: &[Screen], x: u32, y: u32) -> bool {
        let (px, py) = (i64::from(centre(x)), i64::from(centre(y)));
        let mut odd = false;
        for (k, a) in face.iter().enumerate() {
            let b = &face[(k + 1) % face.len()];
            let (a, b) = if a.y <= b.y { (a, b) } else { (b, a) };
            if i64::from(a.y) <= py && py < i64::from(b.y) {
                let (dx, dy) = (i64::from(b.x - a.x), i64::from(b.y - a.y));
                // at or right of the edge
                odd ^= (px - i64::from(a.x)) * dy >= (py - i64::from(a.y)) * dx;
            }
        }
        odd
    }

    fn coordinates() -> impl Strategy<Value = Vec<(i32, i32)>> {
        prop::collection::vec((-800i32..7000, -800i32..7000), 3..7)
    }

    proptest! {
        #[test]
        fn samples_are_covered_as_the_top_left_rule_says(points in coordinates(), half_steps in any::<bool>()) {
            // whole and half samples meet centres often
            let snap = |v: i32| if half_steps { v / 128 * 128 } else { v };
            let face: Vec<Screen> =
                points.iter().map(|&(x, y)| Screen { x: snap(x), y: snap(y), inverse_w: 1.0 }).collect();
            for faces in [vec![face.clone()], vec![face[..3].to_vec()]] {
                for way in WAYS {
                    let count = cover(&faces, way);
                    for (k, n) in count.iter().enumerate() {
                        let expected = inside(&faces[0], k as u32 % SIDE, k as u32 / SIDE);
                        prop_assert_eq!(*n == 1, expected, "{} {}", k as u32 % SIDE, k as u32 / SIDE);
                    }
                }
            }
        }

        #[test]
        fn faces_that_share_edges_neither_overlap_nor_leave_gaps(
            moves in prop::collection::vec((-0.3f64..0.3, -0.3f64..0.3), 49),
            kinds in prop::collection::vec(0u8..3, 36),
            scale in 3.0f64..9.0,
        ) {
            // a net of 6 x 6 cells around the screen, inner knots moved, cells whole or cut along either diagonal
            let knot = |i: usize, j: usize| {
                let (dx, dy) = moves[j * 7 + i];
                let free = |k: usize, d: f64| if k == 0 || k == 6 { 0.0 } else { d };
                at((i as f64 + free(i, dx) - 0.5) * scale, (j as f64 + free(j, dy) - 0.5) * scale, 1.0)
            };
            let mut faces = Vec::new();
            for (j, i) in (0..6).flat_map(|j| (0..6).map(move |i| (j, i))) {
                let [a, b, c, d] = [knot(i, j), knot(i + 1, j), knot(i + 1, j + 1), knot(i, j + 1)];
                match kinds[j * 6 + i] {
                    0 => faces.push(vec![a, b, c, d]),
                    1 => faces.extend([vec![a, b, c], vec![a, c, d]]),
                    _ => faces.extend([vec![a, b, d], vec![d, b, c]]),
                }
            }
            let whole = vec![knot(0, 0), knot(6, 0), knot(6, 6), knot(0, 6)];
            for way in WAYS {
                for (k, n) in cover(&faces, way).iter().enumerate() {
                    let expected = u32::from(inside(&whole, k as u32 % SIDE, k as u32 / SIDE));
                    prop_assert_eq!(*n, expected, "{:?}, sample {} {}", way, k as u32 % SIDE, k as u32 / SIDE);
                }
            }
        }
    }

    /// f at a sample of a face whose corners have the given values.
    fn value(face: &[Screen], values: &[f64], [x, y]: [u32; 2], correction: Correction) -> f64 {
        let mut row = Row::default();
        row.of(face, y);
        let mut weights = Weighted::new();
        row.weights(x, correction, &mut weights);
        weights.iter().map(|&(corner, w)| w * values[corner as usize]).sum()
    }

    #[test]
    fn one_quad_by_hand() {
        // row 2 has its centre at 2.5: alpha = (2.5 - 0.5)/8 = 1/4 along AC, beta = 2/4 along BD;
        // the span runs from 1.5 to 11, column 5 has its centre at 5.5: gamma = 4/9.5 = 8/19
        let (a, b) = (at(1.0, 0.5, 1.0), at(10.0, 0.5, 1.0));
        let (c, d) = (at(3.0, 8.5, 0.5), at(12.0, 4.5, 0.25));
        let (face, values) = ([a, c, d, b], [1.0, 5.0, 10.0, 2.0]);
        // (1 - g) [3/4 * 1 + 1/4 * 5] + g [1/2 * 2 + 1/2 * 10] = 11/19 * 2 + 8/19 * 6
        let screen = value(&face, &values, [5, 2], Correction::Screen);
        assert!((screen - 70.0 / 19.0).abs() < 1e-12, "{screen}");
        // f/w: left 3/4 * 1 + 1/4 * 2.5, right 1/2 * 2 + 1/2 * 2.5; 1/w: left .875, right .625
        let expected = (11.0 * 1.375 + 8.0 * 2.25) / (11.0 * 0.875 + 8.0 * 0.625);
        let perspective = value(&face, &values, [5, 2], Correction::Perspective);
        assert!((perspective - expected).abs() < 1e-12, "{perspective}");
    }

    #[test]
    fn a_linear_function_on_the_screen_is_reproduced_inside_any_polygon() {
        let face =
            [at(2.0, 1.0, 1.0), at(20.0, 3.0, 1.0), at(22.0, 15.0, 1.0), at(11.0, 23.0, 1.0), at(1.0, 12.0, 1.0)];
        let f = |x: f64, y: f64| 3.0 - 0.5 * x + 0.25 * y;
        let values = face.map(|c| f(f64::from(c.x) / 256.0, f64::from(c.y) / 256.0));
        for (x, y) in [(10, 5), (4, 12), (18, 8), (12, 20)] {
            let got = value(&face, &values, [x, y], Correction::Screen);
            assert!((got - f(f64::from(x) + 0.5, f64::from(y) + 0.5)).abs() < 1e-12);
        }
    }

    #[test]
    fn the_nearer_face_shows_in_either_order() {
        let face = |z| [at(1.0, 1.0, z), at(20.0, 1.0, z), at(1.0, 20.0, z)];
        for (first, second) in [(0.5, 1.0), (1.0, 0.5)] {
            for way in WAYS {
                let mut band = Band::new(Isa::current());
                band.start(SIDE, 0..SIDE);
                draw(&mut band, 1, &face(first), way);
                draw(&mut band, 2, &face(second), way);
                let expected = if first > second { 1 } else { 2 };
                assert_eq!(ids(&band)[(5 * SIDE + 5) as usize], expected);
            }
        }
    }

    proptest! {
        #[test]
        fn lanes_and_spans_give_the_same_depths(
            points in prop::collection::vec((-800i32..7000, -800i32..7000, 0.1f32..10.0), 3..60),
        ) {
            let faces: Vec<Vec<Screen>> = points
                .as_chunks::<3>()
                .0
                .iter()
                .map(|face| face.map(|(x, y, inverse_w)| Screen { x, y, inverse_w }).to_vec())
                .collect();
            let bits = |way| {
                let mut band = Band::new(Isa::current());
                band.start(SIDE, 0..SIDE);
                faces.iter().enumerate().for_each(|(k, face)| draw(&mut band, 1 + k as u32, face, way));
                let depths: Vec<u32> = band.rows.clone().flat_map(|y| band.depth[band.row(y)].to_vec()).map(f32::to_bits).collect();
                (ids(&band), depths)
            };
            prop_assert!(bits(Way::Usual) == bits(Way::Spans));
        }
    }
}
