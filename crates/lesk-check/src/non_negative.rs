//! `NonNegative`: f >= 0, in every channel.

use crate::finding::Finding;
use crate::subject::Case;
use lesk_math::Vec3;

/// What the value means.
pub const MEASURE: &str = "-f in 1/sr, the smallest channel";

/// The value at one pair of directions; delta weights count too.
pub fn at(case: &Case, wi: Vec3<f64>, wo: Vec3<f64>) -> Finding {
    let smallest = |c: lesk_math::Color<f64>| c.0.iter().fold(f64::INFINITY, |m: f64, &x| if x < m { x } else { m });
    let f = case.eval(wi, wo);
    let nan = f.0.iter().any(|x| x.is_nan());
    let least = case.delta(wo).iter().fold(smallest(f), |m, lobe| m.min(smallest(lobe.weight)));
    Finding::new(case, wi, wo, if nan { f64::NAN } else { 0.0 - least }, 0.0)
}
