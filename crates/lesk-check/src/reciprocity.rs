//! `Reciprocal`: f(i, o) / eta_o^2 = f(o, i) / eta_i^2, for the continuous part and for delta weights.

use crate::finding::Finding;
use crate::subject::{Case, ULPS, largest, neighbours};
use lesk_bsdf::bsdf::Delta;
use lesk_math::{Color, Vec3};

/// What the value means.
pub const MEASURE: &str = "relative difference of f(i,o)/eta_o^2 and f(o,i)/eta_i^2";

/// Values below this are underflow in the number type of the model, and of no relative accuracy.
pub fn underflow(case: &Case) -> f64 {
    if case.subject.epsilon() > 1e-10 { 1e-30 } else { 1e-200 }
}

/// Compares both orders of one pair of directions, and the delta lobes of both.
pub fn at(case: &Case, wi: Vec3<f64>, wo: Vec3<f64>) -> Finding {
    let (ni, no) = (case.index(wi).powi(2), case.index(wo).powi(2));
    let (there, back) = (case.eval(wi, wo) * (1.0 / no), case.eval(wo, wi) * (1.0 / ni));
    let scale = largest(there).max(largest(back));
    let difference = largest(there - back);
    let mut finding = Finding::new(case, wi, wo, 0.0, 0.0);
    if difference.is_nan() || scale > underflow(case) {
        finding.value = difference / scale;
        finding.allowed = 16.0 * case.subject.epsilon();
        if finding.value > finding.allowed {
            let rounding = case.rounding(wi, wo) / no + case.rounding(wo, wi) / ni;
            finding.allowed += rounding / scale;
        }
    }
    [wi, wo].into_iter().fold(finding, |finding, w| match delta(case, w) {
        Some(other) => finding.worse(other),
        None => finding,
    })
}

/// Compares each delta lobe with that of the way back. A delta lobe of weight W towards `wo` is the f
/// W delta(wi - lobe) / |cos wi|, and |cos| dw eta^2 is the same at both ends of a refraction, so that reciprocity of f
/// is W (eta_i / eta_o)^2 = W' (eta_o / eta_i)^2: both are the share of power that takes the path.
fn delta(case: &Case, wo: Vec3<f64>) -> Option<Finding> {
    let mut worst: Option<Finding> = None;
    for lobe in case.delta(wo) {
        let squeeze = (case.index(lobe.wi) / case.index(wo)).powi(2);
        let (back, rounding) = way_back(case, lobe.wi, wo);
        let (there, back) = (lobe.weight * squeeze, back * (1.0 / squeeze));
        let scale = largest(there).max(largest(back)).max(underflow(case));
        let allowed = ULPS * case.subject.epsilon() + rounding / squeeze / scale;
        let finding = Finding::new(case, lobe.wi, wo, largest(there - back) / scale, allowed).with_note("delta lobe");
        worst = Some(match worst {
            Some(so_far) => so_far.worse(finding),
            None => finding,
        });
    }
    worst
}

/// The weight of the delta lobe that leads from `wo` to the viewer `w`, 0 where none does, and how far it may be off
/// because `w` is rounded: near total reflection Fresnel's terms rise like a square root, or the lobe is gone.
pub fn way_back(case: &Case, w: Vec3<f64>, wo: Vec3<f64>) -> (Color<f64>, f64) {
    let near = case.subject.epsilon().sqrt() * 16.0;
    let towards = |w: Vec3<f64>| {
        let leads = |lobe: &Delta<f64>| (lobe.wi - wo).length() < near;
        case.delta(w).into_iter().find(leads).map_or(Color::BLACK, |lobe| lobe.weight)
    };
    let weight = towards(w);
    let around = neighbours(w, ULPS * case.subject.epsilon());
    (weight, around.iter().map(|&v| largest(towards(v) - weight)).fold(0.0, f64::max))
}
