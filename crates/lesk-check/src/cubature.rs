//! Adaptive integration over cells of the sphere.

use crate::partition::{Cell, Place};
use lesk_math::{CHANNELS, Vec3};
use std::collections::BinaryHeap;

/// One value per channel.
pub type Values = [f64; CHANNELS];

/// An integral over one cell.
#[derive(Clone, Copy, Debug, Default)]
pub struct Integral {
    /// The value per channel.
    pub value: Values,
    /// Estimate of its error, the largest of the channels.
    pub error: f64,
}

/// A part of a cell, with the integral over it.
struct Part {
    cell: Cell,
    /// The cell of the caller that it belongs to.
    owner: usize,
    value: Values,
    error: f64,
    axis: usize,
}

impl PartialEq for Part {
    fn eq(&self, other: &Self) -> bool {
        self.error.total_cmp(&other.error).is_eq()
    }
}
impl Eq for Part {}
impl PartialOrd for Part {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}
impl Ord for Part {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.error.total_cmp(&other.error)
    }
}

/// The integral of `f` over solid angle on each cell, until the estimated errors sum to `tolerance` or `most`
/// evaluations are spent. The errors returned are the estimates, whatever was asked.
///
/// The rule is Genz and Malik's of degree 7 with its embedded one of degree 5 (*An adaptive algorithm for numerical
/// integration over an N-dimensional rectangular region*, J. Comput. Appl. Math. 6, 1980); the part with the largest
/// difference of the two is halved along the axis with the largest fourth difference. The difference estimates the
/// error of the worse rule, so that for smooth functions the true error is far below it.
pub fn integrate(cells: &[Cell], f: impl Fn(Vec3<f64>) -> Values, tolerance: f64, most: usize) -> Vec<Integral> {
    let mut heap: BinaryHeap<Part> =
        cells.iter().enumerate().map(|(owner, &cell)| measure(cell, owner, &f)).collect();
    let mut error: f64 = heap.iter().map(|part| part.error).sum();
    let mut spent = POINTS * cells.len();
    let mut done = Vec::new();
    while error > tolerance && spent < most {
        let Some(part) = heap.pop() else { break };
        if part.error.is_nan() || part.cell.is_tiny(part.axis) {
            error -= part.error;
            done.push(part);
            continue;
        }
        let halves = part.cell.halves(part.axis).map(|half| measure(half, part.owner, &f));
        error += halves[0].error + halves[1].error - part.error;
        spent += 2 * POINTS;
        heap.extend(halves);
    }
    let mut integrals = vec![Integral::default(); cells.len()];
    for part in heap.into_iter().chain(done) {
        let integral = &mut integrals[part.owner];
        integral.error += part.error;
        (0..CHANNELS).for_each(|c| integral.value[c] += part.value[c]);
    }
    integrals
}

/// The sum over cells.
pub fn total(integrals: &[Integral]) -> Integral {
    let mut sum = Integral::default();
    for integral in integrals {
        sum.error += integral.error;
        (0..CHANNELS).for_each(|c| sum.value[c] += integral.value[c]);
    }
    sum
}

/// Evaluations of the rule.
pub const POINTS: usize = 17;

/// Genz and Malik's abscissae: sqrt(9/70), sqrt(9/10), sqrt(9/19).
const NEAR: f64 = 0.358_568_582_800_318_1;
const FAR: f64 = 0.948_683_298_050_513_8;
const INNER: f64 = 0.688_247_201_611_685_3;

/// Weights of the rules of degree 7 and 5 for two dimensions, relative to the area.
const SEVEN: [f64; 5] = [
    (12824.0 - 9120.0 * 2.0 + 400.0 * 4.0) / 19683.0,
    980.0 / 6561.0,
    (1820.0 - 400.0 * 2.0) / 19683.0,
    200.0 / 19683.0,
    6859.0 / 19683.0 / 4.0,
];
const FIVE: [f64; 4] =
    [(729.0 - 950.0 * 2.0 + 50.0 * 4.0) / 729.0, 245.0 / 486.0, (265.0 - 100.0 * 2.0) / 1458.0, 25.0 / 729.0];

/// Applies the rule to one cell.
fn measure(cell: Cell, owner: usize, f: &impl Fn(Vec3<f64>) -> Values) -> Part {
    let half = [0.5 * (cell.hi[0] - cell.lo[0]), 0.5 * (cell.hi[1] - cell.lo[1])];
    let sample = |u: f64, v: f64| -> Values {
        let at = [cell.lo[0] + half[0] * (1.0 + u), cell.lo[1] + half[1] * (1.0 + v)];
        let value = f(Place { below: cell.below, at }.direction());
        value.map(|x| x * 2.0 * at[0])
    };
    let pair = |a: Values, b: Values| -> Values { std::array::from_fn(|c| a[c] + b[c]) };
    let centre = sample(0.0, 0.0);
    let near = [pair(sample(-NEAR, 0.0), sample(NEAR, 0.0)), pair(sample(0.0, -NEAR), sample(0.0, NEAR))];
    let far = [pair(sample(-FAR, 0.0), sample(FAR, 0.0)), pair(sample(0.0, -FAR), sample(0.0, FAR))];
    let corners = |d: f64| pair(pair(sample(-d, -d), sample(d, d)), pair(sample(-d, d), sample(d, -d)));
    let (outer, inner) = (corners(FAR), corners(INNER));
    let area = 4.0 * half[0] * half[1];
    let (mut value, mut error, mut fourth) = ([0.0; CHANNELS], 0.0f64, [0.0f64; 2]);
    for c in 0..CHANNELS {
        let (sum_near, sum_far) = (near[0][c] + near[1][c], far[0][c] + far[1][c]);
        let four = SEVEN[0] * centre[c] + SEVEN[1] * sum_near + SEVEN[2] * sum_far;
        value[c] = area * (four + SEVEN[3] * outer[c] + SEVEN[4] * inner[c]);
        let five = FIVE[0] * centre[c] + FIVE[1] * sum_near + FIVE[2] * sum_far + FIVE[3] * outer[c];
        let difference = (value[c] - area * five).abs();
        error = if difference.is_nan() { f64::NAN } else { error.max(difference) };
        for axis in 0..2 {
            // (9/70) / (9/10) = 1/7
            let bend = near[axis][c] - 2.0 * centre[c] - (far[axis][c] - 2.0 * centre[c]) / 7.0;
            fourth[axis] = fourth[axis].max(bend.abs());
        }
    }
    let longer = usize::from(half[1] > 3.0 * half[0]);
    let axis = if fourth[0] == fourth[1] { longer } else { usize::from(fourth[1] > fourth[0]) };
    Part { cell, owner, value, error, axis }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::partition::Partition;
    use lesk_bsdf::model::Domain;
    use std::f64::consts::{PI, TAU};

    fn over(domain: Domain, f: impl Fn(Vec3<f64>) -> f64, tolerance: f64) -> Integral {
        let cells = Partition::new(domain, &[], 1).cells;
        total(&integrate(&cells, |w| [f(w); CHANNELS], tolerance, 1_000_000))
    }

    #[test]
    fn solid_angle_cosine_and_powers_have_their_closed_forms() {
        let cases: [(f64, fn(Vec3<f64>) -> f64); 4] =
            [(TAU, |_| 1.0), (PI, |w| w.z), (TAU / 21.0, |w| w.z.powi(20)), (TAU / 3.0, |w| w.x * w.x)];
        for (exact, f) in cases {
            let got = over(Domain::Upper, f, 1e-9);
            assert!((got.value[0] - exact).abs() <= got.error + 1e-12, "{exact}: {got:?}");
        }
    }

    #[test]
    fn a_lobe_on_both_sides_integrates_to_its_closed_form() {
        // the integral of exp(k (w.a - 1)) is 2 pi (1 - exp(-2 k)) / k for any axis a
        let (k, axis) = (200.0, Vec3::from([0.6, 0.0, -0.8]));
        let got = over(Domain::BothSides, |w| (k * (w.dot(axis) - 1.0)).exp(), 1e-8);
        assert!((got.value[0] - TAU / k).abs() <= got.error + 1e-12, "{got:?}");
    }

    #[test]
    fn a_kink_is_integrated_within_the_error_that_is_stated() {
        // the integral of |w.x| over the hemisphere is pi
        let got = over(Domain::Upper, |w| w.x.abs(), 1e-5);
        assert!((got.value[0] - PI).abs() <= got.error, "{got:?}");
    }
}
