//! `Reciprocal`: f(i, o) / eta_o^2 = f(o, i) / eta_i^2, for the continuous part and for delta weights.

use crate::finding::Finding;
use crate::subject::{Case, ULPS, largest, neighbours};
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

/// Compares each delta lobe with that of the way back. A delta lobe of weight W towards `wo` is the f
/// W delta(wi - lobe) / |cos wi|, and |cos| dw eta^2 is the same at both ends of a refraction, so that reciprocity of f
/// is W (eta_i / eta_o)^2 = W' (eta_o / eta_i)^2: both are the share of power that takes the path.
fn delta(case: &Case, wo: Vec3<f64>) -> Option<Finding> {
    let mut worst: Option<Finding> = None;
    for lobe in case.delta(wo) {
        let squeeze = (case.index(lobe.wi) / case.index(wo)).powi(2);
        let finding = match way_back(case, lobe.wi, wo) {
            Some(back) => {
                let (there, back) = (lobe.weight * squeeze, back * (1.0 / squeeze));
                let scale = largest(there).max(largest(back)).max(underflow(case));
                let rounding = delta_rounding(case, lobe.wi, wo) / squeeze;
                let allowed = ULPS * case.subject.epsilon() + rounding / scale;
                Finding::new(case, lobe.wi, wo, largest(there - back) / scale, allowed).with_note("delta lobe")
            }
            None => Finding::new(case, lobe.wi, wo, 1.0, 0.0).with_note("no delta lobe leads back"),
        };
        worst = Some(match worst {
            Some(so_far) => so_far.worse(finding),
            None => finding,
        });
    }
    worst
}

/// How far the weight of the lobe back may be off because the direction `w` of the lobe is rounded: near total
/// reflection Fresnel's terms rise like a square root.
pub fn delta_rounding(case: &Case, w: Vec3<f64>, wo: Vec3<f64>) -> f64 {
    let Some(weight) = way_back(case, w, wo) else { return 0.0 };
    let around = neighbours(w, ULPS * case.subject.epsilon());
    let change = around.iter().filter_map(|&v| way_back(case, v, wo)).map(|other| largest(other - weight));
    change.fold(0.0, f64::max)
}

/// The weight of the delta lobe from `wo` towards the viewer `w`, where there is one.
pub fn way_back(case: &Case, w: Vec3<f64>, wo: Vec3<f64>) -> Option<lesk_math::Color<f64>> {
    let near = case.subject.epsilon().sqrt() * 16.0;
    let leads = |lobe: &lesk_bsdf::bsdf::Delta<f64>| (lobe.wi - wo).length() < near;
    case.delta(w).into_iter().find(leads).map(|lobe| lobe.weight)
}
