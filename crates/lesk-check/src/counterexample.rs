//! Replays the counterexamples that models store: the property must fail there.

use crate::directions::from_degrees;
use crate::effort::Budget;
use crate::finding::Finding;
use crate::limits::set;
use crate::random::Random;
use crate::subject::{Case, Subject};
use crate::{chi_square, energy, isotropy, non_negative, reciprocity, smooth};
use lesk_bsdf::model::{Counterexample, Property};
use lesk_bsdf::params::defaults;

/// The flat parameter table of a counterexample; an error if a name or a value is wrong.
pub fn parameters(subject: &dyn Subject, example: &Counterexample) -> Result<Vec<f64>, String> {
    let mut params = defaults(subject.specs());
    for &(name, value) in example.params {
        set(subject.specs(), &mut params, name, value)?;
    }
    Ok(params)
}

/// Tests the property at the stored place.
pub fn replay(
    subject: &dyn Subject,
    example: &Counterexample,
    rng: &mut Random,
    budget: &Budget,
) -> Result<Finding, String> {
    let params = parameters(subject, example)?;
    let case = Case::new(subject, &params);
    let (wi, wo) = (from_degrees(example.wi_deg), from_degrees(example.wo_deg));
    Ok(match example.property {
        Property::Reciprocal => reciprocity::at(&case, wi, wo),
        Property::Passive => energy::at(&case, wi),
        Property::SamplesItself => chi_square::at(&case, wo, budget.draws, 1, rng),
        Property::Isotropic => isotropy::at(&case, wi, wo),
        Property::NonNegative => non_negative::at(&case, wi, wo),
        Property::Smooth => smooth::at(&case, wi, wo, rng),
    })
}
