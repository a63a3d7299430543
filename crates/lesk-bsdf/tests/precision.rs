//! `f32` against `f64`, batches against single calls, on every instruction set that this processor has.
//!
//! The tolerance is a number of roundings times the condition of the value: u (|f| + sum |x df/dx|), u = 2^-24, the sum
//! over all parameters and components of directions. That is what `f64` says a change of each input by one rounding
//! does; a formula that rounds in a few dozen places and loses nothing by cancellation stays within a few dozen of it.

mod common;

use common::{Random, condition, reference, rounded};
use lesk_bsdf::batch::{self, Column, Target};
use lesk_bsdf::kernels::DRAW_OUTPUTS;
use lesk_bsdf::{Scatter, registry};
use lesk_math::{CHANNELS, Isa, Vec3};

/// The unit roundoff of `f32`.
const U: f64 = f32::EPSILON as f64 / 2.0;

/// Roundings that eval and pdf may be off by, times the condition; measured: at most 4.
const ROUNDINGS: f64 = 8.0;

/// The same for models with the Fresnel term of metals, which cancels for small eta and near eta = 1, k = 0 (measured:
/// at most 27).
const METAL_ROUNDINGS: f64 = 64.0;

/// Below this, `f32` underflows in the factors of a value.
const UNDERFLOW: f64 = 1e-30;

/// Outputs that are compared: the channels of f, and the density.
const OUTPUTS: usize = CHANNELS + 1;

/// Directions of a case: `f32` numbers, in both types.
struct Pair {
    wi: Vec3<f32>,
    wo: Vec3<f32>,
}

fn wide(w: Vec3<f32>) -> Vec3<f64> {
    w.map(f64::from)
}

/// Half of the pairs anywhere, half where the model draws, which is where its lobes are.
fn pair(model: &dyn Scatter, params: &[f64], random: &mut Random) -> Pair {
    let domain = model.model().domain;
    let mut anywhere = || if random.unit() < 0.3 { random.grazing(domain) } else { random.direction(domain, 1e-3) };
    let (mut wi, wo) = (anywhere(), anywhere());
    if random.unit() < 0.5 {
        let drawn = (reference(model).draw)(params, wo, [random.unit(), random.unit(), random.unit()]);
        if drawn.delta == 0.0 && drawn.pdf > 0.0 && drawn.wi.z.abs() > 2e-6 {
            wi = drawn.wi;
        }
    }
    Pair { wi: wi.map(|x| x as f32), wo: wo.map(|x| x as f32) }
}

fn outputs64(model: &dyn Scatter, params: &[f64], wi: Vec3<f64>, wo: Vec3<f64>) -> [f64; OUTPUTS] {
    let f = (reference(model).eval)(params, wi, wo);
    let pdf = (reference(model).pdf)(params, wi, wo);
    std::array::from_fn(|c| if c < CHANNELS { f.0[c] } else { pdf })
}

fn outputs32(model: &dyn Scatter, params: &[f32], pair: &Pair) -> [f32; OUTPUTS] {
    let (f, pdf) = model.eval_pdf(params, pair.wi, pair.wo);
    std::array::from_fn(|c| if c < CHANNELS { f.0[c] } else { pdf })
}

/// What one rounding of each input, and of the result, may change.
fn roundings(model: &dyn Scatter, params: &[f64], pair: &Pair) -> ([f64; OUTPUTS], [f64; OUTPUTS]) {
    let (wi, wo) = (wide(pair.wi), wide(pair.wo));
    let exact = outputs64(model, params, wi, wo);
    let change = condition(|params, wi, wo| outputs64(model, params, wi, wo), params, wi, wo);
    (exact, std::array::from_fn(|c| U * (exact[c].abs() + change[c])))
}

fn allowed_roundings(model: &dyn Scatter) -> f64 {
    if model.specs().iter().any(|spec| spec.name == "k") { METAL_ROUNDINGS } else { ROUNDINGS }
}

/// Fails unless all outputs are within the allowed number of roundings of `exact`.
#[track_caller]
fn assert_within(model: &dyn Scatter, what: &str, got: &[f32], exact: &[f64], unit: &[f64], at: (&[f32], &Pair)) {
    for c in 0..got.len() {
        let roundings = (f64::from(got[c]) - exact[c]).abs() / (unit[c] + UNDERFLOW);
        assert!(
            roundings <= allowed_roundings(model),
            "{} {what}, output {c}: {} instead of {}, {roundings:.1} roundings, wi {:?} wo {:?} parameters {:?}",
            model.id(),
            got[c],
            exact[c],
            at.1.wi,
            at.1.wo,
            at.0
        );
    }
}

#[test]
fn f32_agrees_with_f64_at_the_rounded_inputs() {
    for model in registry::all() {
        let mut random = Random::new(1);
        for _ in 0..20_000 {
            let (narrow, params) = rounded(&random.params(model.specs()));
            let pair = pair(model, &params, &mut random);
            let (exact, unit) = roundings(model, &params, &pair);
            let got = outputs32(model, &narrow, &pair);
            assert_within(model, "in f32", &got, &exact, &unit, (&narrow, &pair));
        }
    }
}

/// Arrays of directions, one row per component, and a stretch of directions outside the domain at the end.
struct Directions {
    pairs: Vec<Pair>,
    wi: [Vec<f32>; 3],
    wo: [Vec<f32>; 3],
}

/// Not a multiple of a block, nor of a vector.
const N: usize = 2 * lesk_bsdf::kernels::BLOCK + 77;

impl Directions {
    fn new(model: &dyn Scatter, params: &[f64], random: &mut Random) -> Directions {
        let mut pairs: Vec<Pair> = (0..N).map(|_| pair(model, params, random)).collect();
        pairs[N - 1].wi.z = 0.0;
        pairs[N - 2].wo = Vec3::splat(f32::NAN);
        pairs[N - 3].wi = Vec3 { x: f32::INFINITY, y: 0.0, z: 1.0 };
        let rows = |of: fn(&Pair) -> Vec3<f32>| [0, 1, 2].map(|c| pairs.iter().map(|p| of(p).to_array()[c]).collect());
        let (wi, wo) = (rows(|p| p.wi), rows(|p| p.wo));
        Directions { pairs, wi, wo }
    }
}

fn columns(rows: &[Vec<f32>; 3]) -> [Column<'_>; 3] {
    [0, 1, 2].map(|c| Column::contiguous(&rows[c]))
}

type Call = fn(&dyn Scatter, Isa, &[Column], [Column; 3], [Column; 3], usize, &mut [Target]);

/// The rows that a batch call writes.
fn run<const ROWS: usize>(
    call: Call,
    model: &dyn Scatter,
    isa: Isa,
    params: &[Column],
    first: &[Vec<f32>; 3],
    second: &[Vec<f32>; 3],
) -> [Vec<f32>; ROWS] {
    let mut rows: [Vec<f32>; ROWS] = std::array::from_fn(|_| vec![f32::NAN; N]);
    let mut targets: Vec<Target> = rows.iter_mut().map(|row| Target::Row(row)).collect();
    call(model, isa, params, columns(first), columns(second), N, &mut targets);
    rows
}

const EVAL: Call = |model, isa, params, wi, wo, n, out| _ = batch::eval(model, isa, params, wi, wo, n, out);
const PDF: Call = |model, isa, params, wi, wo, n, out| _ = batch::pdf(model, isa, params, wi, wo, n, out);
const DRAW: Call = |model, isa, params, u, wo, n, out| _ = batch::draw(model, isa, params, u, wo, n, out);

fn available() -> impl Iterator<Item = Isa> {
    Isa::ALL.into_iter().filter(|isa| isa.is_available())
}

fn uniform(params: &[f32]) -> Vec<Column<'_>> {
    params.iter().map(Column::uniform).collect()
}

/// Parameter tables per model.
const TABLES: usize = 8;

/// Without fused multiply-adds a batch does the same operations as a single call, so the bits are the same.
#[test]
fn baseline_batches_equal_single_calls_bit_for_bit() {
    for model in registry::all() {
        let mut random = Random::new(2);
        for _ in 0..TABLES {
            let (narrow, params) = rounded(&random.params(model.specs()));
            let directions = Directions::new(model, &params, &mut random);
            let (wi, wo) = (&directions.wi, &directions.wo);
            let table = uniform(&narrow);
            let f: [_; CHANNELS] = run(EVAL, model, Isa::Baseline, &table, wi, wo);
            let [pdf] = run(PDF, model, Isa::Baseline, &table, wi, wo);
            for (i, pair) in directions.pairs.iter().enumerate() {
                let single = outputs32(model, &narrow, pair);
                for c in 0..CHANNELS {
                    assert_eq!(f[c][i].to_bits(), single[c].to_bits(), "{} eval {i} {narrow:?}", model.id());
                }
                assert_eq!(pdf[i].to_bits(), single[CHANNELS].to_bits(), "{} pdf {i} {narrow:?}", model.id());
            }
            let u = random_numbers(&mut random);
            let drawn: [_; DRAW_OUTPUTS] = run(DRAW, model, Isa::Baseline, &table, &u, wo);
            for (i, pair) in directions.pairs.iter().enumerate() {
                let s = model.draw(&narrow, pair.wo, [u[0][i], u[1][i], u[2][i]]);
                let single = [&[s.wi.x, s.wi.y, s.wi.z] as &[f32], &s.weight.0, &[s.pdf, s.delta]].concat();
                for c in 0..DRAW_OUTPUTS {
                    assert_eq!(drawn[c][i].to_bits(), single[c].to_bits(), "{} draw {i} output {c}", model.id());
                }
            }
        }
    }
}

fn random_numbers(random: &mut Random) -> [Vec<f32>; 3] {
    let draws: Vec<[f32; 3]> = (0..N).map(|_| random.unit3_f32()).collect();
    [0, 1, 2].map(|c| draws.iter().map(|u| u[c]).collect())
}

#[test]
fn batches_of_every_instruction_set_agree_with_f64() {
    for model in registry::all() {
        for isa in available() {
            let mut random = Random::new(3);
            for _ in 0..TABLES {
                let (narrow, params) = rounded(&random.params(model.specs()));
                let directions = Directions::new(model, &params, &mut random);
                let f: [_; CHANNELS] = run(EVAL, model, isa, &uniform(&narrow), &directions.wi, &directions.wo);
                let [pdf] = run(PDF, model, isa, &uniform(&narrow), &directions.wi, &directions.wo);
                for (i, pair) in directions.pairs.iter().enumerate() {
                    let got: [f32; OUTPUTS] = std::array::from_fn(|c| if c < CHANNELS { f[c][i] } else { pdf[i] });
                    if i >= N - 3 {
                        assert_eq!(got, [0.0; OUTPUTS], "{} outside the domain", model.id());
                        continue;
                    }
                    let (exact, unit) = roundings(model, &params, pair);
                    assert_within(model, isa.name(), &got, &exact, &unit, (&narrow, pair));
                }
            }
        }
    }
}

/// Draws that fail may do so by rounding alone, and one that hits the border of two lobes may take either: the density
/// and the weight have to fit the direction that came out.
#[test]
fn draws_of_every_instruction_set_have_the_density_and_the_weight_of_their_direction() {
    for model in registry::all() {
        for isa in available() {
            let mut random = Random::new(4);
            for _ in 0..TABLES {
                let (narrow, params) = rounded(&random.params(model.specs()));
                let directions = Directions::new(model, &params, &mut random);
                let u = random_numbers(&mut random);
                let drawn: [_; DRAW_OUTPUTS] = run(DRAW, model, isa, &uniform(&narrow), &u, &directions.wo);
                for (i, pair) in directions.pairs.iter().enumerate() {
                    let at = |c: usize| drawn[c][i];
                    let wi = Vec3 { x: at(0), y: at(1), z: at(2) };
                    assert!((wide(wi).length() - 1.0).abs() < 1e-5, "{} drew {wi:?}", model.id());
                    let (pdf, delta) = (at(3 + CHANNELS), at(4 + CHANNELS));
                    if pdf == 0.0 || delta == 1.0 {
                        continue;
                    }
                    let pair = Pair { wi, wo: pair.wo };
                    let (exact, unit) = roundings(model, &params, &pair);
                    let what = format!("draw {}", isa.name());
                    assert_within(model, &what, &[pdf], &exact[CHANNELS..], &unit[CHANNELS..], (&narrow, &pair));
                    // f = weight pdf / cos, up to the rounding of these three operations
                    let f: [f64; CHANNELS] =
                        std::array::from_fn(|c| f64::from(at(3 + c)) * f64::from(pdf) / f64::from(wi.z.abs()));
                    let both: [f64; CHANNELS] = std::array::from_fn(|c| unit[c] + 4.0 * U * exact[c].abs());
                    let f32s = f.map(|x| x as f32);
                    assert_within(model, &what, &f32s, &exact[..CHANNELS], &both, (&narrow, &pair));
                }
            }
        }
    }
}

#[test]
fn varying_parameters_give_the_bits_of_uniform_ones() {
    for model in registry::all() {
        for isa in available() {
            let mut random = Random::new(5);
            let (narrow, params) = rounded(&random.params(model.specs()));
            let directions = Directions::new(model, &params, &mut random);
            let (wi, wo) = (&directions.wi, &directions.wo);
            let arrays: Vec<Vec<f32>> = narrow.iter().map(|&p| vec![p; N]).collect();
            let varying: Vec<Column> = arrays.iter().map(|row| Column::contiguous(row)).collect();
            let mut mixed = uniform(&narrow);
            mixed[narrow.len() - 1] = Column::contiguous(&arrays[narrow.len() - 1]);
            let u = random_numbers(&mut random);
            let all = |table: &[Column]| {
                let f: [_; CHANNELS] = run(EVAL, model, isa, table, wi, wo);
                let pdf: [_; 1] = run(PDF, model, isa, table, wi, wo);
                let draw: [_; DRAW_OUTPUTS] = run(DRAW, model, isa, table, &u, wo);
                f.into_iter().chain(pdf).chain(draw).flatten().map(f32::to_bits).collect::<Vec<u32>>()
            };
            let expected = all(&uniform(&narrow));
            assert_eq!(all(&varying), expected, "{} {}", model.id(), isa.name());
            assert_eq!(all(&mixed), expected, "{} {}", model.id(), isa.name());
        }
    }
}
