//! `Smooth`: no delta lobe, and f has a continuous gradient in directions and parameters, except on the seams.
//!
//! Along a segment through directions and parameters the second difference |f(t-h) - 2 f(t) + f(t+h)| / h is followed
//! to where it is largest, while h shrinks. It is the jump of the derivative: where f is smooth it shrinks with h,
//! at a kink it stays, at a cusp or a step it grows.

use crate::directions;
use crate::effort::Budget;
use crate::finding::{Finding, exceeds, worst as worst_of};
use crate::random::Random;
use crate::region::Region;
use crate::subject::{Case, Subject, largest};
use lesk_math::{Color, Vec3, vec3};

/// What the value means.
pub const MEASURE: &str = "jump of the derivative of f along a segment, relative to f";

/// The largest jump that passes, relative to f: far above what rounding leaves (1e-5), far below a kink of a formula.
const JUMP: f64 = 1e-3;

/// Zooms, each by a factor of `POINTS` / 2.
const LEVELS: usize = 8;
const POINTS: usize = 16;

/// A jump that shrinks by more than this per zoom is the curvature of a C1 function (a zoom is a factor 8: 1/8 where
/// the gradient is differentiable, 0.35 at |x|^1.5, 0.7 to 1 at a kink).
const STAYS: f64 = 0.45;

/// Segments keep this distance (a cosine) from the horizon, where the domain ends.
const FLOOR: f64 = 1e-3;

/// A point in the space of the model's arguments.
#[derive(Clone)]
struct Point {
    params: Vec<f64>,
    wi: Vec3<f64>,
    wo: Vec3<f64>,
}

impl Point {
    fn lerp(&self, other: &Point, t: f64) -> Point {
        let mix = |a: f64, b: f64| (a + (b - a) * t).clamp(a.min(b), a.max(b));
        let turn = |a: Vec3<f64>, b: Vec3<f64>| (a + (b - a) * t).normalize();
        Point {
            params: self.params.iter().zip(&other.params).map(|(&a, &b)| mix(a, b)).collect(),
            wi: turn(self.wi, other.wi),
            wo: turn(self.wo, other.wo),
        }
    }
}

/// Where the second difference of a segment stays as h shrinks.
struct Kink {
    jump: f64,
    ends: [Point; 2],
}

/// Follows the largest second difference of the segment; a kink if it does not shrink.
fn kink(subject: &dyn Subject, from: &Point, to: &Point) -> Option<Kink> {
    let f = |t: f64| {
        let point = from.lerp(to, t);
        subject.eval(&point.params, point.wi, point.wo)
    };
    let (mut lo, mut hi) = (0.0, 1.0);
    let mut jumps = [0.0; LEVELS];
    let (mut whole, mut scale) = (0.0f64, 0.0f64);
    let mut stays = 0;
    for level in 0..levels(subject) {
        let h = (hi - lo) / POINTS as f64;
        let values: Vec<Color<f64>> = (0..=POINTS).map(|i| f(lo + h * i as f64)).collect();
        scale = values.iter().fold(0.0, |m, &v| m.max(largest(v)));
        whole = whole.max(scale);
        let bend = |i: usize| largest(values[i - 1] + values[i + 1] - values[i] * 2.0) / h;
        let at = (1..POINTS).max_by(|&a, &b| bend(a).total_cmp(&bend(b)))?;
        jumps[level] = bend(at);
        stays = if level > 0 && jumps[level] > STAYS * jumps[level - 1] { stays + 1 } else { 0 };
        (lo, hi) = (lo + h * (at - 1) as f64, lo + h * (at + 1) as f64);
    }
    // relative to f here, or to a millionth of the largest f of the segment where f vanishes
    let scale = scale.max(1e-6 * whole).max(1e-100);
    let jump = jumps[levels(subject) - 1] / scale;
    let found = stays >= 3 && jump > JUMP || jump.is_nan();
    let ends = [from.lerp(to, lo), from.lerp(to, hi)];
    // the four values of a second difference are rounded
    let noise =
        |end: &Point| 4.0 * Case::new(subject, &end.params).rounding(end.wi, end.wo) / (0.5 * (hi - lo) * scale);
    (found && exceeds(jump, JUMP + noise(&ends[0]).max(noise(&ends[1])))).then_some(Kink { jump, ends })
}

/// Zooms until h nears the root of epsilon, below which differences are rounding.
fn levels(subject: &dyn Subject) -> usize {
    if subject.epsilon() > 1e-10 { 4 } else { LEVELS }
}

/// Whether a seam of the model separates the ends or passes within their distance.
fn on_seam(subject: &dyn Subject, ends: &[Point; 2]) -> bool {
    let [a, b] = ends;
    subject.model().seams.iter().any(|seam| {
        let (za, zb) = ((seam.zero)(a.wi, a.wo), (seam.zero)(b.wi, b.wo));
        za * zb <= 0.0 || za.abs().min(zb.abs()) < 2.0 * (za - zb).abs()
    })
}

fn finding(subject: &dyn Subject, at: &Point, jump: f64, note: &str) -> Finding {
    Finding::new(&Case::new(subject, &at.params), at.wi, at.wo, jump, JUMP).with_note(note)
}

/// Looks for a kink off the seams on one segment.
fn segment(subject: &dyn Subject, from: &Point, to: &Point) -> Finding {
    let lobes = Case::new(subject, &from.params).delta(from.wo);
    if !lobes.is_empty() {
        return finding(subject, from, f64::INFINITY, "there is a delta lobe");
    }
    match kink(subject, from, to) {
        Some(kink) if !on_seam(subject, &kink.ends) => {
            let end = &kink.ends[0];
            finding(subject, end, kink.jump, &toward(end, &kink.ends[1]))
        }
        _ => finding(subject, from, 0.0, ""),
    }
}

/// Says which arguments a segment moves.
fn toward(a: &Point, b: &Point) -> String {
    let moved = |w: Vec3<f64>, v: Vec3<f64>| (w - v).length() > 0.0;
    let mut names = Vec::new();
    if moved(a.wi, b.wi) {
        names.push("wi");
    }
    if moved(a.wo, b.wo) {
        names.push("wo");
    }
    if a.params != b.params {
        names.push("parameters");
    }
    format!("a kink while {} moved", names.join(" and "))
}

/// Whether f is smooth around one pair of directions: segments of every orientation that pass through it.
pub fn at(case: &Case, wi: Vec3<f64>, wo: Vec3<f64>, rng: &mut Random) -> Finding {
    let point = Point { params: case.params.to_vec(), wi, wo };
    let lobes = case.delta(wo);
    if !lobes.is_empty() {
        return finding(case.subject, &point, f64::INFINITY, "there is a delta lobe");
    }
    let region = Region::all(case.subject.specs());
    let mut worst = finding(case.subject, &point, 0.0, "");
    for round in 0..96 {
        // so short that no direction changes sides
        let step = |rng: &mut Random, w: Vec3<f64>| {
            let most = (0.25 * w.z.abs()).min(0.02);
            vec3(rng.within(-most, most), rng.within(-most, most), rng.within(-most, most))
        };
        let (di, d_o) = (step(rng, wi), step(rng, wo));
        let (di, d_o) = match round % 3 {
            0 => (di, Vec3::ZERO),
            1 => (Vec3::ZERO, d_o),
            _ => (di, d_o),
        };
        let params = if round % 4 == 3 { region.near(case.params, rng, 0.1) } else { point.params.clone() };
        let back = region.mirrored(&params, case.params);
        let from = Point { params: back, wi: (wi - di).normalize(), wo: (wo - d_o).normalize() };
        let to = Point { params, wi: (wi + di).normalize(), wo: (wo + d_o).normalize() };
        if let Some(kink) = kink(case.subject, &from, &to) {
            worst = worst.worse(finding(case.subject, &point, kink.jump, &toward(&kink.ends[0], &kink.ends[1])));
        }
    }
    worst
}

/// The largest jump off the seams on random segments of the region.
pub fn worst(subject: &dyn Subject, region: &Region, rng: &mut Random, budget: &Budget, stop: bool) -> Option<Finding> {
    let findings = (0..budget.segments).map_while(|_| {
        let params = region.draw(rng)?;
        let (wi, wo) = directions::pair(rng, &Case::new(subject, &params), FLOOR);
        let from = Point { params, wi, wo };
        let to = other_end(subject, region, rng, &from);
        Some(segment(subject, &from, &to))
    });
    worst_of(findings, stop)
}

/// The other end of a segment: some of the arguments move, near or far, each direction on its side of the surface.
fn other_end(subject: &dyn Subject, region: &Region, rng: &mut Random, from: &Point) -> Point {
    let mut to = from.clone();
    let near = rng.chance(0.3);
    let mut moved = |w: Vec3<f64>| {
        let far = directions::any(rng, subject.model().domain, FLOOR);
        let far = vec3(far.x, far.y, far.z.copysign(w.z));
        if near { (w + (far - w) * 0.03).normalize() } else { far }
    };
    let (wi, wo) = (moved(from.wi), moved(from.wo));
    match rng.index(4) {
        0 => to.wi = wi,
        1 => to.wo = wo,
        2 => (to.wi, to.wo) = (wi, wo),
        _ => {}
    }
    if (to.wi, to.wo) == (from.wi, from.wo) || rng.chance(0.3) {
        to.params = region.near(&from.params, rng, if near { 0.02 } else { 0.5 });
    }
    to
}
