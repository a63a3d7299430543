//! `SamplesItself`: `pdf` is the density of `draw`, delta lobes are drawn as often as they say, rejected draws as
//! often as `pdf` leaves over, and the weight of a draw is f |cos wi| / pdf.
//!
//! The design is Mitsuba's (a histogram over theta and phi, the density integrated over each cell, cells pooled to at
//! least 5 expected draws, Šidák's correction over the configurations), with cells that are small where a first set
//! of draws lies, so that a lobe of any width is resolved.

use crate::cubature::{Integral, integrate};
use crate::directions;
use crate::effort::Budget;
use crate::finding::{Finding, exceeds, worst as worst_of};
use crate::partition::{Partition, with_halo};
use crate::random::Random;
use crate::region::Region;
use crate::statistics::{chi_square_survival, sidak};
use crate::subject::{Case, Subject, largest};
use lesk_bsdf::bsdf::{Delta, Sample};
use lesk_math::{CHANNELS, Vec3, vec3};

/// What the value means.
pub const MEASURE: &str = "-log10 of the smallest p-value";

/// The probability that chance makes one of the configurations of a claim suspicious.
pub const SIGNIFICANCE: f64 = 0.01;

/// Draws that shape the cells, and draws per cell among them.
const PILOT: usize = 4096;
const PER_CELL: usize = 16;

/// The error of the expected counts, summed over all cells, to aim at: this share of the root of the number of draws.
const ERROR: f64 = 0.02;

/// The most evaluations of the density.
const EVALUATIONS: usize = 600_000;

/// Draws whose weight and density are compared with the functions.
const WEIGHED: usize = 512;

/// The outcome of one histogram.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// The probability of a chi-square at least as large, if the density is that of the draws.
    pub p: f64,
    /// Chi-square and its degrees of freedom.
    pub chi_square: [f64; 2],
    /// The integral of the density and its error.
    pub integral: [f64; 2],
    /// A fault that needs no statistics.
    pub fault: Option<String>,
}

/// One bin: expected and observed counts, and the error of the former.
#[derive(Clone, Copy, Default)]
struct Bin {
    expected: f64,
    observed: f64,
    error: f64,
}

/// The bins of one direction: cells of the sphere, then delta lobes, then the rejected draws.
struct Bins {
    partition: Partition,
    lobes: Vec<Delta<f64>>,
    bins: Vec<Bin>,
}

impl Bins {
    /// Cells that follow a pilot set of draws, with the counts that `draws` should give. The draws also show the
    /// integration where the density is: a part of a cell that they reach is not overlooked.
    fn new(case: &Case, wo: Vec3<f64>, draws: &[Sample<f64>], rng: &mut Random) -> Bins {
        let n = draws.len() as f64;
        let lobes = case.delta(wo);
        let directions = |samples: &[Sample<f64>]| -> Vec<Vec3<f64>> {
            samples.iter().filter(|s| s.pdf > 0.0 && s.delta == 0.0).map(|s| s.wi).collect()
        };
        let pilot: Vec<Sample<f64>> = (0..PILOT).map(|_| case.draw(wo, rng.unit3())).collect();
        let mut hints = directions(&pilot);
        hints.push(vec3(-wo.x, -wo.y, wo.z));
        let partition = Partition::new(case.domain(), &hints, PER_CELL);
        let mut probes = with_halo(hints);
        probes.extend(directions(draws));
        let density = |wi| [case.pdf(wi, wo); CHANNELS];
        let integrals = integrate(&partition, density, &probes, ERROR / n.sqrt(), EVALUATIONS);
        let cell = |i: &Integral| Bin { expected: n * i.value[0], observed: 0.0, error: n * i.error };
        let mut bins: Vec<Bin> = integrals.iter().map(cell).collect();
        bins.extend(lobes.iter().map(|lobe| Bin { expected: n * lobe.probability, ..Bin::default() }));
        let expected: f64 = bins.iter().map(|b| b.expected).sum();
        let error: f64 = bins.iter().map(|b| b.error).sum();
        bins.push(Bin { expected: (n - expected).max(0.0), observed: 0.0, error });
        Bins { partition, lobes, bins }
    }

    /// Counts one draw.
    fn add(&mut self, s: &Sample<f64>) {
        let cells = self.partition.cells.len();
        let rejected = cells + self.lobes.len();
        let at = if s.delta != 0.0 {
            nearest(&self.lobes, s.wi).map_or(rejected, |lobe| cells + lobe)
        } else if s.pdf > 0.0 {
            self.partition.find(s.wi).unwrap_or(rejected)
        } else {
            rejected
        };
        self.bins[at].observed += 1.0;
    }

    /// The expected share of all but the rejected draws, and its error.
    fn integral(&self, n: f64) -> [f64; 2] {
        let kept = &self.bins[..self.bins.len() - 1];
        [kept.iter().map(|b| b.expected).sum::<f64>() / n, kept.iter().map(|b| b.error).sum::<f64>() / n]
    }

    /// What no density of draws can be.
    fn fault(&self, n: f64) -> Option<String> {
        let [integral, error] = self.integral(n);
        if exceeds(integral, 1.0001 + error) {
            return Some(format!("the density integrates to {integral:.5}, more than 1"));
        }
        let cells = &self.bins[..self.partition.cells.len()];
        let empty = cells.iter().find(|b| b.observed > 2.0 && b.expected + b.error < 1e-6)?;
        Some(format!("{} draws where the density is zero", empty.observed))
    }
}

/// Draws `count` directions for `wo` and compares.
pub fn histogram(case: &Case, wo: Vec3<f64>, count: usize, rng: &mut Random) -> Outcome {
    let n = count as f64;
    let draws: Vec<Sample<f64>> = (0..count).map(|_| case.draw(wo, rng.unit3())).collect();
    let mut bins = Bins::new(case, wo, &draws, rng);
    draws.iter().for_each(|s| bins.add(s));
    let misdirected = bins.lobes.iter().find_map(|lobe| misdirected(case, wo, lobe));
    let weighed = draws.iter().enumerate().filter(|(i, s)| *i < WEIGHED || s.delta != 0.0);
    let misweighed = || weighed.into_iter().find_map(|(_, s)| misweighed(case, wo, s, &bins.lobes));
    let fault = misdirected.or_else(misweighed).or_else(|| bins.fault(n));
    let integral = bins.integral(n);
    let [x, dof] = chi_square(bins.bins);
    let p = if dof > 0.0 { chi_square_survival(x, dof) } else { 1.0 };
    Outcome { p, chi_square: [x, dof], integral, fault }
}

/// Chi-square and degrees of freedom of bins pooled to at least 5 expected. Deviations count beyond the error of the
/// expected count only.
fn chi_square(mut bins: Vec<Bin>) -> [f64; 2] {
    bins.sort_by(|a, b| a.expected.total_cmp(&b.expected));
    let mut pooled: Vec<Bin> = Vec::new();
    let mut open = Bin::default();
    for bin in bins {
        open.expected += bin.expected;
        open.observed += bin.observed;
        open.error += bin.error;
        if open.expected >= 5.0 {
            pooled.push(std::mem::take(&mut open));
        }
    }
    match pooled.last_mut() {
        Some(last) => {
            last.expected += open.expected;
            last.observed += open.observed;
            last.error += open.error;
        }
        None => pooled.push(open),
    }
    let term = |b: &Bin| ((b.observed - b.expected).abs() - b.error).max(0.0).powi(2) / b.expected.max(1e-9);
    [pooled.iter().map(term).sum(), (pooled.len() - 1) as f64]
}

fn nearest(lobes: &[Delta<f64>], wi: Vec3<f64>) -> Option<usize> {
    let distance = |lobe: &Delta<f64>| (lobe.wi - wi).length();
    (0..lobes.len()).min_by(|&a, &b| distance(&lobes[a]).total_cmp(&distance(&lobes[b])))
}

/// The tolerance of comparisons that should be exact: 1e-6 as the contract states, or the number type's.
fn close(case: &Case) -> f64 {
    (64.0 * case.subject.epsilon()).max(1e-6)
}

/// What is wrong with one draw: its density or weight differs from the functions', or its lobe from the list.
fn misweighed(case: &Case, wo: Vec3<f64>, s: &Sample<f64>, lobes: &[Delta<f64>]) -> Option<String> {
    let close = close(case);
    if s.delta != 0.0 {
        let Some(lobe) = nearest(lobes, s.wi).map(|at| &lobes[at]) else {
            return Some("a delta lobe is drawn that `delta` does not list".to_owned());
        };
        let weight = lobe.weight * (1.0 / lobe.probability);
        let wrong = largest(s.weight - weight) / largest(weight).max(1e-30);
        let off = (lobe.wi - s.wi).length().max((s.pdf - lobe.probability).abs());
        return exceeds(wrong.max(off), close).then(|| "a delta draw differs from its lobe".to_owned());
    }
    if s.pdf == 0.0 {
        let black = largest(s.weight) == 0.0;
        return (!black).then(|| "a rejected draw has a weight".to_owned());
    }
    let pdf = case.pdf(s.wi, wo);
    let f = case.eval(s.wi, wo);
    let weight = f * (s.wi.z.abs() / s.pdf);
    let wrong = largest(s.weight - weight) / largest(weight).max(1e-30);
    if exceeds((s.pdf - pdf).abs(), close * pdf) {
        return Some(format!("a draw states density {}, `pdf` says {pdf}", s.pdf));
    }
    exceeds(wrong, close).then(|| format!("the weight of a draw is off by {wrong:.2e} from f cos / pdf"))
}

/// The direction of a delta lobe against the law of reflection or of refraction.
fn misdirected(case: &Case, wo: Vec3<f64>, lobe: &Delta<f64>) -> Option<String> {
    let across = lobe.wi.z * wo.z < 0.0;
    let ratio = if across { case.index(wo) / case.index(lobe.wi) } else { 1.0 };
    let (x, y) = (-wo.x * ratio, -wo.y * ratio);
    let off = (lobe.wi.x - x).abs().max((lobe.wi.y - y).abs()).max((lobe.wi.length() - 1.0).abs());
    let law = if across { "Snell's law" } else { "the mirror image" };
    exceeds(off, close(case)).then(|| format!("a delta lobe is {off:.1e} away from {law}"))
}

/// The outcome at one direction, as a finding; `configurations` is how many share the significance. What fails by
/// chance is drawn again, four times as much, and counts only if it fails again.
pub fn at(case: &Case, wo: Vec3<f64>, count: usize, configurations: usize, rng: &mut Random) -> Finding {
    let threshold = sidak(SIGNIFICANCE, configurations);
    let mut outcome = histogram(case, wo, count, rng);
    if outcome.fault.is_none() && outcome.p < threshold {
        outcome = histogram(case, wo, 4 * count, rng);
    }
    let allowed = -threshold.log10();
    let [x, dof] = outcome.chi_square;
    match outcome.fault {
        Some(fault) => Finding::new(case, wo, wo, f64::INFINITY, allowed).with_note(fault),
        None => {
            let note = format!("chi-square {x:.0} of {dof:.0}");
            // 300: the smallest probability that f64 holds
            Finding::new(case, wo, wo, -outcome.p.max(1e-300).log10(), allowed).with_note(note)
        }
    }
}

/// The smallest p-value of many configurations in the region.
pub fn worst(subject: &dyn Subject, region: &Region, rng: &mut Random, budget: &Budget, stop: bool) -> Option<Finding> {
    let findings = (0..budget.histograms).map_while(|_| {
        let params = region.draw(rng)?;
        let wo = directions::any(rng, subject.model().domain, 0.0);
        Some(at(&Case::new(subject, &params), wo, budget.draws, budget.histograms, rng))
    });
    worst_of(findings, stop)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::directions::from_degrees;
    use crate::subject::Reference;
    use lesk_bsdf::registry::find;

    /// Light that leaves glass within 0.15 degrees of the horizon needs facets that face down: its density ends at
    /// once. Expected: Gauss-Legendre in sqrt |cos| (200 cells of 8 points above that line, 16,000 azimuths) gives
    /// 0.0755991 reflected and 0.9243032 transmitted; 4e7 draws 0.07561 and 0.92429.
    #[test]
    fn a_density_that_ends_near_the_horizon_integrates_to_what_other_rules_give() {
        let glass = Reference(find("rough_dielectric").unwrap());
        let case = Case::new(&glass, &[1.5, 0.2, 1.0]);
        let wo = from_degrees([89.780_382_667_212_78, 66.063_600_817_546_17]);
        for seed in 0..8 {
            let mut rng = Random::new("ridge", seed);
            let draws: Vec<Sample<f64>> = (0..200_000).map(|_| case.draw(wo, rng.unit3())).collect();
            let [integral, error] = Bins::new(&case, wo, &draws, &mut rng).integral(200_000.0);
            assert!((integral - 0.999_902_3).abs() <= error, "{integral} +- {error}");
        }
    }
}
