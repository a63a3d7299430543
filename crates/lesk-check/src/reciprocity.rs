//! `Reciprocal`: f(i, o) / eta_o^2 = f(o, i) / eta_i^2, for the continuous part and for delta weights.

use crate::finding::Finding;
use crate::subject::{Case, largest};
use lesk_math::Vec3;

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

/// Compares the weight of each delta lobe with that of the way back.
fn delta(case: &Case, wo: Vec3<f64>) -> Option<Finding> {
    let mut worst: Option<Finding> = None;
    for lobe in case.delta(wo) {
        let back = way_back(case, lobe.wi, wo);
        let (ni, no) = (case.index(lobe.wi).powi(2), case.index(wo).powi(2));
        let finding = match back {
            Some(weight) => {
                let (there, back) = (lobe.weight * (1.0 / no), weight * (1.0 / ni));
                let scale = largest(there).max(largest(back));
                // the direction of the lobe is rounded, and Fresnel terms have square-root ends
                let allowed = case.subject.epsilon().sqrt();
                Finding::new(case, lobe.wi, wo, largest(there - back) / scale.max(1e-300), allowed)
            }
            None => Finding::new(case, lobe.wi, wo, 1.0, 0.0).with_note("no delta lobe leads back"),
        };
        let finding = Finding { note: format!("delta lobe; {}", finding.note), ..finding };
        worst = Some(match worst {
            Some(so_far) => so_far.worse(finding),
            None => finding,
        });
    }
    worst
}

/// The weight of the delta lobe from `wo` towards the viewer `w`, where there is one.
pub fn way_back(case: &Case, w: Vec3<f64>, wo: Vec3<f64>) -> Option<lesk_math::Color<f64>> {
    let near = case.subject.epsilon().sqrt() * 16.0;
    let leads = |lobe: &lesk_bsdf::bsdf::Delta<f64>| (lobe.wi - wo).length() < near;
    case.delta(w).into_iter().find(leads).map(|lobe| lobe.weight)
}
