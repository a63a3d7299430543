//! `Passive`: for every wi, the power of the delta lobes and of f |cos wo| dwo is at most 1.

use crate::cubature::{Integral, Values, integrate};
use crate::directions;
use crate::effort::Budget;
use crate::finding::Finding;
use crate::partition::{Partition, with_halo};
use crate::random::Random;
use crate::reciprocity::way_back;
use crate::region::Region;
use crate::subject::{Case, Subject};
use lesk_math::{CHANNELS, Vec3, vec3};

/// What the value means.
pub const MEASURE: &str = "scattered power per incident power";

/// How exactly to integrate.
#[derive(Clone, Copy, Debug)]
pub struct Accuracy {
    /// The sum of estimated errors to aim at.
    pub tolerance: f64,
    /// The most evaluations of f.
    pub evaluations: usize,
    /// Draws that show where f is large.
    pub hints: usize,
}

impl Accuracy {
    /// To find candidates.
    pub const SCAN: Accuracy = Accuracy { tolerance: 5e-3, evaluations: 20_000, hints: 64 };
    /// To judge, to tabulate.
    pub const FINE: Accuracy = Accuracy { tolerance: 3e-5, evaluations: 1_000_000, hints: 4096 };
}

/// Scattered power, or a directional albedo, by side.
#[derive(Clone, Copy, Debug, Default)]
pub struct Power {
    /// On the side of the given direction.
    pub reflected: Values,
    /// On the other side.
    pub transmitted: Values,
    /// The part of the sum that delta lobes carry.
    pub delta: Values,
    /// Estimate of the numerical error of the sum.
    pub error: f64,
}

impl Power {
    /// Reflected and transmitted together.
    pub fn total(&self) -> Values {
        std::array::from_fn(|c| self.reflected[c] + self.transmitted[c])
    }

    /// The channel with the most power.
    pub fn largest(&self) -> f64 {
        self.total().iter().fold(0.0, |m: f64, &x| if x.is_nan() { x } else { m.max(x) })
    }

    fn add(&mut self, reflected: bool, value: Values) {
        let side = if reflected { &mut self.reflected } else { &mut self.transmitted };
        (0..CHANNELS).for_each(|c| side[c] += value[c]);
    }
}

/// The power that light from `wi` scatters into all directions, per incident power: what [`Passive`] bounds.
///
/// Cells start small where the model draws directions and around the mirror image, and are refined where the rules
/// disagree. What lies within 1e-6 of the horizon (a cosine) is no part of a model, and of the integral.
///
/// [`Passive`]: lesk_bsdf::model::Property::Passive
pub fn power_from(case: &Case, wi: Vec3<f64>, accuracy: Accuracy) -> Power {
    let mut power = integral(case, wi, accuracy, |wo| case.eval(wi, wo).0.map(|f| f * wo.z.abs()));
    for lobe in case.delta(wi) {
        // light from wi goes where its own lobes would come from; |cos| dw eta^2 is the same at both ends. A lobe that
        // is no way back carries nothing here, and is reported as not reciprocal
        let (weight, rounding) = way_back(case, lobe.wi, wi);
        let ratio = (case.index(wi) / case.index(lobe.wi)).powi(2);
        let value = weight.0.map(|w| w * ratio);
        power.add(lobe.wi.z * wi.z > 0.0, value);
        power.error += rounding * ratio;
        (0..CHANNELS).for_each(|c| power.delta[c] += value[c]);
    }
    power
}

/// The directional albedo: the radiance towards `wo` under a sky of radiance 1.
pub fn albedo(case: &Case, wo: Vec3<f64>, accuracy: Accuracy) -> Power {
    let mut power = integral(case, wo, accuracy, |wi| case.eval(wi, wo).0.map(|f| f * wi.z.abs()));
    for lobe in case.delta(wo) {
        power.add(lobe.wi.z * wo.z > 0.0, lobe.weight.0);
        (0..CHANNELS).for_each(|c| power.delta[c] += lobe.weight.0[c]);
    }
    power
}

fn integral(case: &Case, w: Vec3<f64>, accuracy: Accuracy, f: impl Fn(Vec3<f64>) -> Values) -> Power {
    let mut rng = Random::new("hints", 0);
    let mut hints = vec![w, vec3(-w.x, -w.y, w.z)];
    for _ in 0..accuracy.hints {
        let s = case.draw(w, rng.unit3());
        if s.pdf > 0.0 && s.delta == 0.0 {
            hints.push(s.wi);
        }
    }
    let hints = with_halo(hints);
    let cells = Partition::new(case.domain(), &hints, 4);
    let integrals = integrate(&cells, f, &hints, accuracy.tolerance, accuracy.evaluations);
    let mut power = Power::default();
    for (cell, Integral { value, error }) in cells.cells.iter().zip(integrals) {
        power.add(cell.below == (w.z < 0.0), value);
        power.error += error;
    }
    power
}

/// The power from one direction, to the accuracy of a verdict.
pub fn at(case: &Case, wi: Vec3<f64>) -> Finding {
    judge(case, wi, Accuracy::FINE)
}

/// The error with which a verdict still makes sense.
const USEFUL_ERROR: f64 = 2e-3;

fn judge(case: &Case, wi: Vec3<f64>, accuracy: Accuracy) -> Finding {
    let power = power_from(case, wi, accuracy);
    // beside the error of the rule: rounding of the sum, and of f
    let error = power.error + 1e-12 + 64.0 * case.subject.epsilon();
    let finding = Finding::new(case, wi, wi, power.largest(), 1.0 + error).with_error(error);
    if error <= USEFUL_ERROR || finding.violates() {
        return finding;
    }
    Finding { value: f64::NAN, ..finding }.with_note(format!("the integral did not converge (error {error:.1e})"))
}

/// The most power that a search over the region finds: a scan, a climb from its best points, an exact value there.
pub fn worst(subject: &dyn Subject, region: &Region, rng: &mut Random, budget: &Budget, stop: bool) -> Option<Finding> {
    let scan = |params: &[f64], wi: Vec3<f64>| {
        let power = power_from(&Case::new(subject, params), wi, Accuracy::SCAN);
        let value = power.largest() - power.error;
        if value.is_nan() { f64::INFINITY } else { value }
    };
    let mut best: Vec<(f64, Vec<f64>, Vec3<f64>)> = Vec::new();
    for _ in 0..budget.power_params {
        let params = region.draw(rng)?;
        for _ in 0..budget.power_directions {
            let wi = directions::any(rng, subject.model().domain, 0.0);
            best.push((scan(&params, wi), params.clone(), wi));
        }
    }
    best.sort_by(|a, b| b.0.total_cmp(&a.0));
    best.truncate(budget.power_climbs);
    let mut found: Option<Finding> = None;
    for (mut value, mut params, mut wi) in best {
        for step in 0..budget.power_steps {
            let scale = 0.3 * 0.02f64.powf(step as f64 / budget.power_steps as f64);
            let (near, towards) = (region.near(&params, rng, scale), move_direction(rng, wi, scale));
            let next = scan(&near, towards);
            if next > value {
                (value, params, wi) = (next, near, towards);
            }
        }
        let finding = at(&Case::new(subject, &params), wi);
        let finding = match found {
            Some(so_far) => so_far.worse(finding),
            None => finding,
        };
        if stop && finding.violates() {
            return Some(finding);
        }
        found = Some(finding);
    }
    found
}

/// A direction of the same side, moved by up to `scale` radians or towards or away from the horizon.
fn move_direction(rng: &mut Random, w: Vec3<f64>, scale: f64) -> Vec3<f64> {
    let z = if rng.chance(0.5) {
        w.z.abs() * (rng.within(-8.0, 8.0) * scale).exp()
    } else {
        (w.z.abs().min(1.0).acos() + rng.within(-scale, scale)).cos().abs()
    };
    let z = z.clamp(lesk_bsdf::bsdf::MIN_COS, 1.0);
    directions::from_cosine(z.copysign(w.z), w.y.atan2(w.x) + rng.within(-3.0, 3.0) * scale)
}
