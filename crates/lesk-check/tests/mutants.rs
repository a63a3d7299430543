//! Each check fails the models that it is there to fail.

use lesk_bsdf::model::Property::{Isotropic, NonNegative, Passive, Reciprocal, SamplesItself, Smooth};
use lesk_bsdf::model::{Claim, Counterexample, Limit, Property};
use lesk_bsdf::registry::find;
use lesk_check::mutants::{Fault, Mutant, Poison, Poisoned};
use lesk_check::nan_grid;
use lesk_check::subject::{Reference, Subject};
use lesk_check::{Effort, Report, Verdict, check, check_property, check_subject};

/// What the check of one property says about a mutant of a model.
fn verdict(id: &str, fault: Fault, property: Property) -> Vec<Verdict> {
    let reference = Reference(find(id).unwrap());
    verdict_of(&Mutant::new(&reference, fault), property)
}

fn verdict_of(subject: &dyn Subject, property: Property) -> Vec<Verdict> {
    let rows = check_property(subject, property, &Effort::Quick.budget());
    rows.into_iter().map(|row| row.verdict).collect()
}

/// The check of `property` fails the mutant. (`claims.rs` sees to it that the sound model passes.)
fn catches(id: &str, fault: Fault, property: Property) {
    assert!(verdict(id, fault, property).contains(&Verdict::Failed), "{fault:?} of {id} passes {property:?}");
}

#[test]
fn reciprocity_fails_a_brdf_that_depends_on_one_side_alone() {
    catches("ggx", Fault::OneSided, Reciprocal);
    catches("lambert", Fault::OneSided, Reciprocal);
}

#[test]
fn reciprocity_fails_delta_lobes_without_the_scaling_of_radiance() {
    catches("dielectric", Fault::NoRadianceScaling, Reciprocal);
}

#[test]
fn passivity_fails_one_percent_more_light() {
    catches("lambert", Fault::TooBright, Passive);
    catches("mirror", Fault::TooBright, Passive);
    catches("ggx", Fault::TooBright, Passive);
    catches("modified_phong", Fault::TooBright, Passive);
}

#[test]
fn chi_square_fails_densities_that_are_scaled() {
    catches("ggx", Fault::Density(1.05), SamplesItself);
    catches("lambert", Fault::Density(1.02), SamplesItself);
    catches("lambert", Fault::Density(0.97), SamplesItself);
}

#[test]
fn chi_square_fails_draws_that_are_biased() {
    catches("lambert", Fault::BiasedDraw, SamplesItself);
    catches("ggx", Fault::BiasedDraw, SamplesItself);
    catches("modified_phong", Fault::BiasedLobe, SamplesItself);
    catches("dielectric", Fault::BiasedLobe, SamplesItself);
}

#[test]
fn chi_square_fails_wrong_weights() {
    catches("ggx", Fault::Weight, SamplesItself);
    catches("mirror", Fault::Weight, SamplesItself);
}

#[test]
fn chi_square_fails_delta_lobes_of_wrong_probability_or_direction() {
    catches("dielectric", Fault::DeltaProbability, SamplesItself);
    catches("mirror", Fault::DeltaDirection, SamplesItself);
    catches("dielectric", Fault::DeltaDirection, SamplesItself);
}

#[test]
fn isotropy_fails_a_change_with_azimuth() {
    catches("lambert", Fault::Anisotropic, Isotropic);
}

#[test]
fn sign_fails_a_negative_value_near_the_horizon() {
    catches("lambert", Fault::Negative, NonNegative);
}

#[test]
fn smoothness_fails_kinks_and_steps() {
    catches("lambert", Fault::Kink, Smooth);
    catches("ggx", Fault::Kink, Smooth);
    catches("lambert", Fault::Step, Smooth);
    catches("lambert", Fault::ParameterKink, Smooth);
}

/// The rows about the limits of a mutant of lambert; without claims, the rest takes no time.
fn limit_rows(limits: &'static [Limit], rounded: bool) -> Vec<Verdict> {
    let reference = Reference(find("lambert").unwrap());
    let quiet = Mutant::new(&reference, Fault::Claims(&[]));
    let limited = Mutant::new(&quiet, Fault::Limits(limits));
    let rounded = rounded.then(|| Mutant::new(&limited, Fault::Rounded));
    let report = match &rounded {
        Some(mutant) => check_subject(mutant, Effort::Quick),
        None => check_subject(&limited, Effort::Quick),
    };
    report.rows.iter().filter(|row| row.property == "limit").map(|row| row.verdict).collect()
}

#[test]
fn limits_fail_a_difference_of_1e_9() {
    const IS_LAMBERT: &[Limit] =
        &[Limit { at: &[], equals: "lambert", link: &[("reflectance", "reflectance")], with: &[], tolerance: 0.0 }];
    assert_eq!(limit_rows(IS_LAMBERT, false), [Verdict::Held]);
    assert_eq!(limit_rows(IS_LAMBERT, true), [Verdict::Failed]);
}

#[test]
fn a_limit_to_an_unknown_model_or_parameter_is_reported() {
    const UNKNOWN: &[Limit] = &[
        Limit { at: &[], equals: "lamberd", link: &[], with: &[], tolerance: 0.0 },
        Limit { at: &[("albedo", 0.5)], equals: "lambert", link: &[], with: &[], tolerance: 0.0 },
        Limit { at: &[("reflectance", 2.0)], equals: "lambert", link: &[], with: &[], tolerance: 0.0 },
        Limit { at: &[], equals: "ggx", link: &[("alpha_x", "reflectance")], with: &[], tolerance: 0.0 },
    ];
    assert_eq!(limit_rows(UNKNOWN, false), [Verdict::Failed; 4]);
}

#[test]
fn the_grid_finds_nan_in_every_function() {
    let lambert = find("lambert").unwrap();
    for place in [Poison::Eval, Poison::Pdf, Poison::Draw] {
        let poisoned = Poisoned { inner: lambert, place: Some(place) };
        assert!(nan_grid::scan(&poisoned, 20).violates(), "{place:?}");
    }
}

#[test]
fn a_model_of_f32_functions_alone_passes_and_its_nan_is_found() {
    let lambert = find("lambert").unwrap();
    let sound = check(&Poisoned { inner: lambert, place: None }, Effort::Quick);
    assert!(sound.passed(), "{}", lesk_check::text(&[sound]));
    let report: Report = check(&Poisoned { inner: lambert, place: Some(Poison::Eval) }, Effort::Quick);
    assert!(report.failures().any(|row| row.property == "finite"));
}

#[test]
fn a_property_that_is_neither_claimed_nor_refuted_is_reported() {
    for property in Property::ALL {
        assert_eq!(verdict("lambert", Fault::Claims(&[]), property), [Verdict::Failed]);
    }
}

#[test]
fn a_condition_that_is_not_needed_or_not_enough_is_reported() {
    const NOT_NEEDED: &[Claim] = &[Reciprocal.when("alpha_x = alpha_y")];
    const NOT_ENOUGH: &[Claim] = &[Isotropic.when("alpha_x <= alpha_y")];
    const ALWAYS: &[Claim] = &[Isotropic.when("alpha_x > 0")];
    const NEVER: &[Claim] = &[Isotropic.when("alpha_x > 2")];
    const UNKNOWN: &[Claim] = &[Isotropic.when("alpha = alpha_y")];
    for (claims, property) in [
        (NOT_NEEDED, Reciprocal),
        (NOT_ENOUGH, Isotropic),
        (ALWAYS, Isotropic),
        (NEVER, Isotropic),
        (UNKNOWN, Isotropic),
    ] {
        assert!(verdict("ggx", Fault::Claims(claims), property).contains(&Verdict::Failed), "{claims:?}");
    }
}

const PAIR: Counterexample = Counterexample {
    property: Reciprocal,
    params: &[("reflectance", 1.0)],
    wi_deg: [89.5, 20.0],
    wo_deg: [89.2, 230.0],
    because: "of the fault",
};

#[test]
fn a_counterexample_that_contradicts_a_claim_is_reported() {
    let fault = Fault::Counterexamples(&[PAIR]);
    assert_eq!(verdict("lambert", fault, Reciprocal), [Verdict::Held, Verdict::Failed]);
}

#[test]
fn a_stored_counterexample_proves_the_fault_of_its_property_and_nothing_else() {
    let of = |property: Property| Counterexample { property, ..PAIR };
    // sin(11.536959 degrees) = 0.2 is the place of the kink
    let kink = Counterexample { wi_deg: [11.536_959, 0.0], ..of(Smooth) };
    let faults = [
        (Fault::OneSided, PAIR),
        (Fault::TooBright, of(Passive)),
        (Fault::BiasedDraw, of(SamplesItself)),
        (Fault::Anisotropic, of(Isotropic)),
        (Fault::Negative, of(NonNegative)),
        (Fault::Kink, kink),
    ];
    let reference = Reference(find("lambert").unwrap());
    let unclaimed = Mutant::new(&reference, Fault::Claims(&[]));
    for (fault, example) in faults {
        // once per test run: a model's tables live for the whole program
        let stored: &'static [Counterexample] = Box::leak(Box::new([example]));
        let sound = Mutant::new(&unclaimed, Fault::Counterexamples(stored));
        assert_eq!(verdict_of(&sound, example.property), [Verdict::Failed], "sound {fault:?}");
        let mutant = Mutant::new(&sound, fault);
        assert_eq!(verdict_of(&mutant, example.property), [Verdict::RefutedAsStored], "{fault:?}");
    }
}

#[test]
fn a_malformed_counterexample_is_reported() {
    const UNKNOWN: Counterexample = Counterexample { params: &[("albedo", 1.0)], ..PAIR };
    const ILLEGAL: Counterexample = Counterexample { params: &[("reflectance", f64::NAN)], ..PAIR };
    let fault = Fault::Counterexamples(&[UNKNOWN, ILLEGAL]);
    assert_eq!(verdict("lambert", fault, Reciprocal)[1..], [Verdict::Failed; 2]);
}
