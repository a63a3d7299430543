//! `Isotropic`: turning both directions about the normal changes nothing.

use crate::directions::turn;
use crate::finding::Finding;
use crate::reciprocity::underflow;
use crate::subject::{Case, largest};
use lesk_math::Vec3;

/// What the value means.
pub const MEASURE: &str = "relative change of f when both directions turn about the normal";

/// Compares f at one pair of directions with f at turned ones, and the delta weights likewise.
pub fn at(case: &Case, wi: Vec3<f64>, wo: Vec3<f64>) -> Finding {
    let f = case.eval(wi, wo);
    let mut finding = Finding::new(case, wi, wo, 0.0, 0.0);
    // radians: a right angle would miss a model that knows four-fold symmetry
    for angle in [0.7, 1.9, 4.1] {
        let (ti, to) = (turn(wi, angle), turn(wo, angle));
        let turned = case.eval(ti, to);
        let scale = largest(f).max(largest(turned));
        let difference = largest(f - turned);
        if !difference.is_nan() && scale <= underflow(case) {
            continue;
        }
        let mut allowed = 16.0 * case.subject.epsilon();
        if difference / scale > allowed {
            allowed += (case.rounding(wi, wo) + case.rounding(ti, to)) / scale;
        }
        finding = finding.worse(Finding::new(case, wi, wo, difference / scale, allowed));
        finding = finding.worse(delta(case, wo, to, angle));
    }
    finding
}

/// Compares the delta lobes of `wo` and of `to`, which is `wo` turned.
fn delta(case: &Case, wo: Vec3<f64>, to: Vec3<f64>, angle: f64) -> Finding {
    let (lobes, turned) = (case.delta(wo), case.delta(to));
    let mut change = if lobes.len() == turned.len() { 0.0 } else { 1.0f64 };
    for (a, b) in lobes.iter().zip(&turned) {
        let weight = largest(a.weight - b.weight) / largest(a.weight).max(1e-300);
        change = change.max(weight).max((turn(a.wi, angle) - b.wi).length());
    }
    Finding::new(case, wo, wo, change, case.subject.epsilon().sqrt()).with_note("delta lobes")
}
