//! The contract of every model in `f32`: for legal parameters no output is NaN or infinite, whatever the directions.

use crate::directions::from_cosine;
use crate::finding::Finding;
use crate::random::Random;
use crate::region::Region;
use crate::subject::{Case, Reference};
use lesk_bsdf::Scatter;
use lesk_bsdf::bsdf::MIN_COS;
use lesk_bsdf::model::Domain;
use lesk_math::{Color, Vec3, vec3};

/// What the value means.
pub const MEASURE: &str = "outputs of eval, pdf, draw in f32 that are not finite";

/// Scans `n`^2 pairs of directions by `n`^2 parameters and counts what is not finite (or a density below 0, or a
/// drawn direction that has not length 1); the place is the first of them.
pub fn scan(model: &dyn Scatter, n: usize) -> Finding {
    let mut rng = Random::new("grid", 0);
    let (table, wide) = parameters(model, n * n, &mut rng);
    let pairs = pairs(model.model().domain, n, &mut rng);
    let (mut count, mut first) = (0usize, None);
    for (params, at) in table.iter().zip(&wide) {
        for &(wi, wo) in &pairs {
            let fault = fault(model, params, wi, wo, &mut rng);
            if let Some(fault) = fault {
                count += 1;
                first.get_or_insert((at, wi, wo, fault));
            }
        }
    }
    let reference = Reference(model);
    let (at, wi, wo, note) = first.unwrap_or((&wide[0], Vec3::Z, Vec3::Z, ""));
    let place = Case::new(&reference, at);
    let directions = (wi.map(f64::from), wo.map(f64::from));
    Finding::new(&place, directions.0, directions.1, count as f64, 0.0).with_note(note)
}

/// Random parameters with many at the ends of their ranges, in `f32` and as they were.
fn parameters(model: &dyn Scatter, count: usize, rng: &mut Random) -> (Vec<Vec<f32>>, Vec<Vec<f64>>) {
    let region = Region::all(model.specs());
    let mut wide: Vec<Vec<f64>> = (0..count).filter_map(|_| region.draw(rng)).collect();
    for end in 0..2 {
        wide.push(model.specs().iter().flat_map(|spec| vec![spec.range[end]; spec.len()]).collect());
    }
    (wide.iter().map(|row| row.iter().map(|&p| p as f32).collect()).collect(), wide)
}

/// Pairs of `n` cosines (both ends of the domain at every scale) with the azimuths where formulas degenerate; every
/// fourth pair is equal, mirrored or opposite, and lengths are off by up to 1e-5.
fn pairs(domain: Domain, n: usize, rng: &mut Random) -> Vec<(Vec3<f32>, Vec3<f32>)> {
    // from the horizon up to the normal, and from the normal down to the horizon, in powers of ten
    let cosine = |i: usize| {
        let left = 1.0 - i as f64 / (n - 1).max(1) as f64;
        let z = if i.is_multiple_of(2) { 1e-6f64.powf(left) } else { 1.0 - 1e-9f64.powf(left) };
        z.max(MIN_COS)
    };
    let mut pairs = Vec::new();
    for i in 0..n {
        for o in 0..n {
            let azimuth = [0.0, 90.0, 180.0, 270.0, rng.within(0.0, 360.0)][rng.index(5)];
            let side = |rng: &mut Random| if domain != Domain::Upper && rng.chance(0.5) { -1.0 } else { 1.0 };
            let wo = from_cosine(cosine(o) * side(rng), f64::to_radians(azimuth));
            let wi = match rng.index(12) {
                0 => wo,
                1 => vec3(-wo.x, -wo.y, wo.z),
                2 if domain != Domain::Upper => -wo,
                _ => from_cosine(cosine(i) * side(rng), f64::to_radians(90.0 * rng.index(4) as f64)),
            };
            let mut length = || 1.0 + 1e-5 * [0.0, -1.0, 1.0][rng.index(3)];
            pairs.push(((wi * length()).map(|x| x as f32), (wo * length()).map(|x| x as f32)));
        }
    }
    pairs
}

fn fault(model: &dyn Scatter, params: &[f32], wi: Vec3<f32>, wo: Vec3<f32>, rng: &mut Random) -> Option<&'static str> {
    let finite = |c: Color<f32>| c.0.iter().all(|x| x.is_finite());
    let (f, pdf) = model.eval_pdf(params, wi, wo);
    if !finite(f) || !finite(model.eval(params, wi, wo)) {
        return Some("eval");
    }
    if !(pdf.is_finite() && pdf >= 0.0) {
        return Some("pdf");
    }
    // the ends of [0, 1) as well
    let u = [0; 3].map(|_| match rng.index(8) {
        0 => 0.0,
        1 => 1.0 - f32::EPSILON / 2.0,
        _ => (rng.unit() as f32).min(1.0 - f32::EPSILON / 2.0),
    });
    let s = model.draw(params, wo, u);
    // a length that is off by 1e-5 may come out longer, a rounded one may not
    let exact = (wo.length_squared() - 1.0).abs() < 4.0 * f32::EPSILON;
    let unit = (s.wi.length_squared() - 1.0).abs() < if exact { 1e-4 } else { f32::INFINITY };
    if !(finite(s.weight) && s.pdf.is_finite() && s.pdf >= 0.0 && unit) {
        return Some("draw");
    }
    let lobes = model.delta(params, wo);
    let sound = |lobe: &lesk_bsdf::bsdf::Delta<f32>| {
        finite(lobe.weight)
            && lobe.probability >= 0.0
            && lobe.probability <= 1.0
            && lobe.wi.length_squared().is_finite()
    };
    lobes.is_some_and(|lobes| !lobes.iter().all(sound)).then_some("delta")
}
