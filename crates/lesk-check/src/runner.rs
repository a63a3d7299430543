//! Runs every statement that a model makes about itself, and looks for those that it should make.

use crate::condition::Condition;
use crate::directions::{degrees, pair};
use crate::effort::{Budget, Effort};
use crate::finding::{Finding, worst as worst_of};
use crate::random::Random;
use crate::region::Region;
use crate::report::{Place, Report, Row, Verdict};
use crate::subject::{Case, Reference, Subject};
use crate::{chi_square, counterexample, energy, furnace, isotropy, limits, nan_grid};
use crate::{non_negative, reciprocity, smooth};
use lesk_bsdf::Scatter;
use lesk_bsdf::model::{Claim, Counterexample, Limit, Property};
use lesk_bsdf::params::{defaults, flat_names};
use lesk_bsdf::registry;
use rayon::prelude::*;
use std::time::Instant;

/// Checks one model: its claims inside and outside their conditions, its counterexamples, its limits, and that its
/// `f32` functions give no NaN.
pub fn check(model: &dyn Scatter, effort: Effort) -> Report {
    let start = Instant::now();
    let reference = Reference(model);
    let mut report = check_subject(&reference, effort);
    let row = timed(|| {
        let finding = nan_grid::scan(model, effort.budget().grid);
        let verdict = if finding.violates() { Verdict::Failed } else { Verdict::Held };
        row(&reference, "finite", None, nan_grid::MEASURE, verdict, finding)
    });
    report.rows.push(row);
    report.albedo = furnace::curves(&Case::new(&reference, &defaults(model.specs())), "default");
    report.seconds = start.elapsed().as_secs_f64();
    report
}

/// Checks every model of the registry, in parallel, in the order of the registry.
pub fn check_all(effort: Effort) -> Vec<Report> {
    let models: Vec<&dyn Scatter> = registry::all().collect();
    models.into_par_iter().with_max_len(1).map(|model| check(model, effort)).collect()
}

/// Checks what a subject says about itself; [`check`] adds what only a [`Scatter`] has.
pub fn check_subject(subject: &dyn Subject, effort: Effort) -> Report {
    let start = Instant::now();
    let (model, budget) = (subject.model(), effort.budget());
    let mut rows = Vec::new();
    for property in Property::ALL {
        rows.extend(check_property(subject, property, &budget));
    }
    rows.extend(model.limits.iter().map(|limit| timed(|| limit_row(subject, limit, &budget))));
    Report {
        id: subject.id().to_owned(),
        title: model.title.to_owned(),
        paper: model.paper.to_owned(),
        effort,
        rows,
        albedo: Vec::new(),
        seconds: start.elapsed().as_secs_f64(),
    }
}

/// The worst that a search finds for one property in a region; none if the region is empty. `stop` ends the search at
/// the first violation.
pub fn worst(
    property: Property,
    subject: &dyn Subject,
    region: &Region,
    budget: &Budget,
    stop: bool,
) -> Option<Finding> {
    let mut rng = Random::new(&format!("{} {}", subject.id(), property.name()), u32::from(stop));
    let rng = &mut rng;
    let pairs = |rng: &mut Random, at: fn(&Case, _, _) -> Finding| {
        let findings = (0..budget.pairs).map_while(|_| {
            let params = region.draw(rng)?;
            let case = Case::new(subject, &params);
            let (wi, wo) = pair(rng, &case, 0.0);
            Some(at(&case, wi, wo))
        });
        worst_of(findings, stop)
    };
    match property {
        Property::Reciprocal => pairs(rng, reciprocity::at),
        Property::Isotropic => pairs(rng, isotropy::at),
        Property::NonNegative => pairs(rng, non_negative::at),
        Property::Passive => energy::worst(subject, region, rng, budget, stop),
        Property::SamplesItself => chi_square::worst(subject, region, rng, budget, stop),
        Property::Smooth => smooth::worst(subject, region, rng, budget, stop),
    }
}

/// What the value of a property's rows is.
pub fn measure(property: Property) -> &'static str {
    match property {
        Property::Reciprocal => reciprocity::MEASURE,
        Property::Isotropic => isotropy::MEASURE,
        Property::NonNegative => non_negative::MEASURE,
        Property::Passive => energy::MEASURE,
        Property::SamplesItself => chi_square::MEASURE,
        Property::Smooth => smooth::MEASURE,
    }
}

/// Checks what a subject says about one property: its claims, its counterexamples, or that it says nothing.
pub fn check_property(subject: &dyn Subject, property: Property, budget: &Budget) -> Vec<Row> {
    let model = subject.model();
    let examples: Vec<&Counterexample> = model.counterexamples.iter().filter(|e| e.property == property).collect();
    let claims: Vec<&Claim> = model.claims.iter().filter(|claim| claim.property == property).collect();
    let mut rows = Vec::new();
    for claim in &claims {
        claim_rows(subject, claim, examples.is_empty(), budget, &mut rows);
    }
    for example in &examples {
        rows.push(timed(|| example_row(subject, example, &claims, budget)));
    }
    if rows.is_empty() {
        let note = "neither claimed nor refuted: state a claim or store a counterexample";
        rows.push(failed(property.name(), None, measure(property), note.to_owned()));
    }
    rows
}

/// The rows of a claim: tested where it should hold, and, unless a stored counterexample will do, refuted elsewhere.
fn claim_rows(subject: &dyn Subject, claim: &Claim, refute: bool, budget: &Budget, rows: &mut Vec<Row>) {
    let (name, measure) = (claim.property.name(), measure(claim.property));
    let specs = subject.specs();
    let condition = match claim.when.map(|text| Condition::parse(text, specs)).transpose() {
        Ok(condition) => condition,
        Err(error) => return rows.push(failed(name, claim.when, measure, error.to_string())),
    };
    let inside = condition.clone().map_or(Region::all(specs), |condition| Region::inside(specs, condition));
    rows.push(timed(|| match worst(claim.property, subject, &inside, budget, false) {
        Some(finding) => {
            let verdict = if finding.violates() { Verdict::Failed } else { Verdict::Held };
            row(subject, name, claim.when, measure, verdict, finding)
        }
        None => failed(name, claim.when, measure, "no legal parameters fulfil the condition".to_owned()),
    }));
    let Some(condition) = condition.filter(|_| refute) else { return };
    let outside = Region::outside(specs, condition);
    rows.push(timed(|| match worst(claim.property, subject, &outside, budget, true) {
        Some(finding) if finding.violates() => {
            row(subject, name, claim.when, measure, Verdict::RefutedOutside, finding)
        }
        Some(finding) => {
            let finding = finding.with_note("no violation found outside the condition: is it needed?");
            row(subject, name, claim.when, measure, Verdict::Failed, finding)
        }
        None => failed(name, claim.when, measure, "all legal parameters fulfil the condition".to_owned()),
    }));
}

fn example_row(subject: &dyn Subject, example: &Counterexample, claims: &[&Claim], budget: &Budget) -> Row {
    let (name, measure) = (example.property.name(), measure(example.property));
    let mut rng = Random::new(&format!("{} {name} counterexample", subject.id()), 0);
    let replayed = counterexample::parameters(subject, example)
        .and_then(|params| contradiction(subject, &params, claims).map_or(Ok(()), Err))
        .and_then(|()| counterexample::replay(subject, example, &mut rng, budget));
    match replayed {
        Ok(finding) if finding.violates() => {
            let note = if finding.note.is_empty() {
                example.because.to_owned()
            } else {
                format!("{} ({})", example.because, finding.note)
            };
            row(subject, name, None, measure, Verdict::RefutedAsStored, finding.with_note(note))
        }
        Ok(finding) => {
            let note = format!("the property holds at the stored counterexample ({})", example.because);
            row(subject, name, None, measure, Verdict::Failed, finding.with_note(note))
        }
        Err(note) => failed(name, None, measure, format!("counterexample: {note}")),
    }
}

/// Why a counterexample at these parameters contradicts a claim.
fn contradiction(subject: &dyn Subject, params: &[f64], claims: &[&Claim]) -> Option<String> {
    claims.iter().find_map(|claim| match claim.when {
        None => Some("the property is claimed without a condition".to_owned()),
        Some(text) => {
            let holds = Condition::parse(text, subject.specs()).is_ok_and(|condition| condition.holds(params));
            holds.then(|| format!("its parameters fulfil the condition `{text}` of the claim"))
        }
    })
}

fn limit_row(subject: &dyn Subject, limit: &Limit, budget: &Budget) -> Row {
    let at: Vec<String> = limit.at.iter().map(|(name, value)| format!("{name} = {value}")).collect();
    let text =
        if at.is_empty() { format!("is {}", limit.equals) } else { format!("{}: {}", at.join(", "), limit.equals) };
    let mut rng = Random::new(&format!("{} limit {text}", subject.id()), 0);
    match limits::worst(subject, limit, &mut rng, budget.pairs / 4) {
        Ok(finding) => {
            let verdict = if finding.violates() { Verdict::Failed } else { Verdict::Held };
            row(subject, "limit", Some(&text), limits::MEASURE, verdict, finding)
        }
        Err(note) => failed("limit", Some(&text), limits::MEASURE, note),
    }
}

/// Runs and times one row.
fn timed(run: impl FnOnce() -> Row) -> Row {
    let start = Instant::now();
    let row = run();
    Row { seconds: start.elapsed().as_secs_f64(), ..row }
}

fn row(
    subject: &dyn Subject,
    property: &str,
    condition: Option<&str>,
    measure: &str,
    verdict: Verdict,
    finding: Finding,
) -> Row {
    let finite = |x: f64| x.is_finite().then_some(x);
    let names = flat_names(subject.specs());
    Row {
        property: property.to_owned(),
        condition: condition.map(str::to_owned),
        verdict,
        measure: measure.to_owned(),
        value: finite(finding.value),
        allowed: finite(finding.allowed),
        error: finding.error,
        place: Some(Place {
            params: names.into_iter().zip(finding.params).collect(),
            wi_deg: degrees(finding.wi),
            wo_deg: degrees(finding.wo),
        }),
        note: finding.note,
        seconds: 0.0,
    }
}

/// A row about which nothing could be measured.
fn failed(property: &str, condition: Option<&str>, measure: &str, note: String) -> Row {
    Row {
        property: property.to_owned(),
        condition: condition.map(str::to_owned),
        verdict: Verdict::Failed,
        measure: measure.to_owned(),
        value: None,
        allowed: None,
        error: 0.0,
        place: None,
        note,
        seconds: 0.0,
    }
}
