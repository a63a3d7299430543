//! What one test of one property found.

use crate::subject::Case;
use lesk_math::Vec3;

/// A measured value, what is allowed, and where.
#[derive(Clone, Debug)]
pub struct Finding {
    /// The measured value; larger is worse. NaN is worst.
    pub value: f64,
    /// The largest value with which the property holds.
    pub allowed: f64,
    /// The estimated numerical error of `value`.
    pub error: f64,
    /// The flat parameter table.
    pub params: Vec<f64>,
    /// The direction to the light.
    pub wi: Vec3<f64>,
    /// The direction to the viewer.
    pub wo: Vec3<f64>,
    /// What the value does not say.
    pub note: String,
}

impl Finding {
    /// A measurement at one pair of directions.
    pub fn new(case: &Case, wi: Vec3<f64>, wo: Vec3<f64>, value: f64, allowed: f64) -> Finding {
        Finding { value, allowed, error: 0.0, params: case.params.to_vec(), wi, wo, note: String::new() }
    }

    /// The same with an estimate of the error of the value.
    pub fn with_error(self, error: f64) -> Finding {
        Finding { error, ..self }
    }

    /// The same with a remark.
    pub fn with_note(self, note: impl Into<String>) -> Finding {
        Finding { note: note.into(), ..self }
    }

    /// Whether the property fails here.
    pub fn violates(&self) -> bool {
        exceeds(self.value, self.allowed)
    }

    /// The worse of two findings: a violation before none, of violations the larger value, else the larger part of what
    /// is allowed.
    pub fn worse(self, other: Finding) -> Finding {
        let size = |f: &Finding| match f.value {
            nan if nan.is_nan() => f64::INFINITY,
            value if f.violates() || f.allowed <= 0.0 => value,
            value => value / f.allowed,
        };
        let rank = |f: &Finding| (f.violates(), size(f));
        let (a, b) = (rank(&self), rank(&other));
        if b.0 & !a.0 || b.0 == a.0 && b.1 > a.1 { other } else { self }
    }
}

/// Whether `value` is more than `allowed`, or NaN.
pub fn exceeds(value: f64, allowed: f64) -> bool {
    value > allowed || value.is_nan() || allowed.is_nan()
}

/// The worst of many findings; `stop` ends the search at the first violation.
pub fn worst(findings: impl Iterator<Item = Finding>, stop: bool) -> Option<Finding> {
    let mut worst: Option<Finding> = None;
    for finding in findings {
        let next = match worst {
            Some(so_far) => so_far.worse(finding),
            None => finding,
        };
        if stop && next.violates() {
            return Some(next);
        }
        worst = Some(next);
    }
    worst
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(value: f64, allowed: f64) -> Finding {
        Finding { value, allowed, error: 0.0, params: vec![], wi: Vec3::Z, wo: Vec3::Z, note: String::new() }
    }

    #[test]
    fn the_worse_finding_is_a_violation_then_the_larger_part_of_what_is_allowed() {
        // (value, allowed) of the worse and of the better one
        for (worse, better) in [
            // half of what is allowed is worse than a larger value where almost anything is
            ((1e-15, 2e-15), (1.0, 1e30)),
            ((2.0, 1.0), (0.9, 1.0)),
            // of violations the larger value, however little was allowed
            ((0.8, 0.1), (0.5, 1e-12)),
            ((f64::NAN, 1.0), (5.0, 1.0)),
            ((1e-3, 0.0), (1e-4, 0.0)),
        ] {
            let (a, b) = (found(worse.0, worse.1), found(better.0, better.1));
            for chosen in [a.clone().worse(b.clone()), b.worse(a)] {
                assert_eq!(chosen.value.to_bits(), worse.0.to_bits(), "{worse:?} {better:?}");
            }
        }
    }
}
