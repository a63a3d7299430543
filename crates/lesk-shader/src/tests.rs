//! The recorded and the packed functions, interpreted, against the models themselves.

use crate::interpret::interpret;
use crate::packed::{Packed, Type};
use crate::record::{Recording, record};
use crate::{Math, Part, idiom, pack, slim};
use lesk_bsdf::model::Domain;
use lesk_bsdf::registry;
use lesk_bsdf::scatter::{Methods, Scatter};
use lesk_math::expr::Plain;
use lesk_math::rng::Stream;
use lesk_math::{Expr, Vec3, vec3};

/// Random places per model and part.
const PLACES: u32 = 400;

/// Arguments of one call: two vectors and the flat parameters.
#[derive(Clone, Debug)]
struct Place {
    first: Vec3<f64>,
    second: Vec3<f64>,
    params: Vec<f64>,
}

impl Place {
    /// Random directions of the domain, and parameters between the ends of their sliders, rounded to `f32`.
    fn random(model: &dyn Scatter, part: Part, k: u32) -> Place {
        let mut stream = Stream::new(1, k, 0);
        let mut direction = || {
            let [z, phi] = [stream.next_f64(), stream.next_f64()];
            let (z, phi) = (0.02 + 0.98 * z, core::f64::consts::TAU * phi);
            let below = model.model().domain != Domain::Upper && stream.next_f64() < 0.5;
            let r = (1.0 - z * z).sqrt();
            vec3(r * phi.cos(), r * phi.sin(), if below { -z } else { z })
        };
        let (wi, wo) = (direction(), direction());
        let u = vec3(stream.next_f64(), stream.next_f64(), stream.next_f64());
        let [first, second] = if part.arguments() == ["wi", "wo"] { [wi, wo] } else { [wo, u] };
        let specs = model.specs().iter();
        let params = specs.flat_map(|spec| {
            let [low, high] = spec.slider;
            (0..spec.len()).map(|_| low + (high - low) * stream.next_f64()).collect::<Vec<_>>()
        });
        let params = params.map(round).collect();
        Place { first: first.map(round), second: second.map(round), params }
    }

    fn map<R: Plain>(&self) -> (Vec3<R>, Vec3<R>, Vec<R>) {
        (self.first.map(R::lit), self.second.map(R::lit), self.params.iter().map(|&x| R::lit(x)).collect())
    }

    /// The place with each number changed by at most `scale` of itself.
    fn shaken(&self, scale: f64, k: u32) -> Place {
        let mut stream = Stream::new(2, k, 0);
        let mut shake = |x: f64| x * (1.0 + scale * (2.0 * stream.next_f64() - 1.0));
        let mut vector = |v: Vec3<f64>| vec3(shake(v.x), shake(v.y), shake(v.z));
        let (first, second) = (vector(self.first), vector(self.second));
        Place { first, second, params: self.params.iter().map(|&x| shake(x)).collect() }
    }
}

fn round(x: f64) -> f64 {
    f64::from(x as f32)
}

/// The model's own results, component after component.
fn direct<R: Plain>(methods: &Methods<R>, part: Part, place: &Place) -> Vec<R> {
    let (first, second, p) = place.map::<R>();
    match part {
        Part::Eval => (methods.eval)(&p, first, second).0.to_vec(),
        Part::Pdf => vec![(methods.pdf)(&p, first, second)],
        Part::Sample => (methods.sample)(&p, first, second.to_array()).to_array().to_vec(),
        Part::Draw => {
            let drawn = (methods.draw)(&p, first, second.to_array());
            let [wi, weight] = [drawn.wi.to_array().to_vec(), drawn.weight.0.to_vec()];
            [wi, weight, vec![drawn.pdf, drawn.delta]].concat()
        }
    }
}

fn recorded<R: Plain>(recording: &Recording, place: &Place) -> Vec<R> {
    let (first, second, p) = place.map::<R>();
    let inputs = [&first.to_array()[..], &second.to_array()[..], &p].concat();
    let outputs: Vec<Expr> = recording.outputs.iter().flat_map(|o| o.components.iter().copied()).collect();
    recording.graph.evaluate(&inputs, &outputs)
}

fn packed<R: Plain>(packed: &Packed, place: &Place) -> Vec<R> {
    let (first, second, p) = place.map::<R>();
    let mut rest = &p[..];
    let mut members = Vec::new();
    for ty in &packed.members {
        let (member, others) = rest.split_at(if *ty == Type::Vector { 3 } else { 1 });
        members.push(member.to_vec());
        rest = others;
    }
    interpret(packed, &[first, second], &members)
}

/// Results that belong together have one scale: f, a density, a direction, a weight.
fn scales(part: Part, results: &[f64]) -> Vec<f64> {
    let largest = |range: core::ops::Range<usize>| results[range].iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    match part {
        Part::Draw => [
            vec![1.0; 3],
            vec![largest(3..results.len() - 2); results.len() - 5],
            vec![results[results.len() - 2].abs(), 1.0],
        ]
        .concat(),
        _ => vec![largest(0..results.len()); results.len()],
    }
}

/// The largest change of the results, by their scale, when the arguments change by `scale`.
fn sensitivity(methods: &Methods<f64>, part: Part, place: &Place, scale: f64) -> Vec<f64> {
    let results = direct(methods, part, place);
    let mut change = vec![0.0_f64; results.len()];
    for k in 0..4 {
        for (change, (shaken, x)) in
            change.iter_mut().zip(direct(methods, part, &place.shaken(scale, k)).iter().zip(&results))
        {
            *change = change.max((shaken - x).abs());
        }
    }
    change
}

fn each(math: Math, mut check: impl FnMut(&'static dyn Scatter, Part, &Recording, &Packed)) {
    for model in registry::all() {
        for part in Part::ALL {
            let recording = record(model, part, math).unwrap();
            let packed = idiom::rewrite(&slim::slim(&pack::pack(&recording).unwrap()));
            check(model, part, &recording, &packed);
        }
    }
}

/// The largest error, in units of the rounding error of results and arguments.
fn worst_error(ours: &[f64], theirs: &[f64], scales: &[f64], near: &[f64], epsilon: f64) -> f64 {
    let error = |j: usize| (ours[j] - theirs[j]).abs() / (epsilon * scales[j] + near[j] + f64::from(f32::MIN_POSITIVE));
    (0..theirs.len()).map(error).fold(0.0, f64::max)
}

#[test]
fn the_recorded_graph_is_the_model() {
    each(Math::Builtin, |model, part, recording, _| {
        let methods = model.forms().reference.unwrap();
        for k in 0..PLACES {
            let place = Place::random(model, part, k);
            let (ours, theirs) = (recorded::<f64>(recording, &place), direct(methods, part, &place));
            for ((x, y), scale) in ours.iter().zip(&theirs).zip(scales(part, &theirs)) {
                // the same operations in the same order, except that constants were folded: a few roundings
                assert!(
                    (x - y).abs() <= 8.0 * f64::EPSILON * scale,
                    "{} {part:?}: {x}, not {y}: {place:?}",
                    model.id()
                );
            }
        }
    });
}

#[test]
fn packing_changes_roundings_only() {
    // the arguments are changed by 1024 roundings, lest one rounding happen to change nothing
    const SHAKE: f64 = 1024.0;
    each(Math::Builtin, |model, part, _, packed_function| {
        let methods = model.forms().reference.unwrap();
        for k in 0..PLACES {
            let place = Place::random(model, part, k);
            let (ours, theirs) = (packed::<f64>(packed_function, &place), direct(methods, part, &place));
            let near = sensitivity(methods, part, &place, SHAKE * f64::EPSILON);
            let near: Vec<f64> = near.iter().map(|x| x / SHAKE).collect();
            let error = worst_error(&ours, &theirs, &scales(part, &theirs), &near, f64::EPSILON);
            // 8 ulp times condition: sums and products in another order
            assert!(error <= 8.0, "{} {part:?}: {error} ulp times condition: {place:?}", model.id());
        }
    });
}

#[test]
fn single_precision_loses_a_few_ulp_times_condition() {
    for math in [Math::Builtin, Math::Exact] {
        each(math, |model, part, recording, packed_function| {
            // a drawn direction's rounding enters the weight by the lobe's condition, not by that of the arguments
            if part == Part::Draw {
                return;
            }
            let methods = model.forms().reference.unwrap();
            let epsilon = f64::from(f32::EPSILON);
            for k in 0..PLACES {
                let place = Place::random(model, part, k);
                let theirs = direct(methods, part, &place);
                let near = sensitivity(methods, part, &place, epsilon);
                for ours in [recorded::<f32>(recording, &place), packed::<f32>(packed_function, &place)] {
                    let ours: Vec<f64> = ours.into_iter().map(f64::from).collect();
                    let error = worst_error(&ours, &theirs, &scales(part, &theirs), &near, epsilon);
                    // about as many roundings as the longest formula has steps on the way of an intermediate value
                    assert!(error <= 16.0, "{} {part:?}: {error} ulp times condition: {place:?}", model.id());
                }
            }
        });
    }
}

#[test]
fn outside_the_domain_the_functions_are_zero() {
    each(Math::Builtin, |model, part, _, packed_function| {
        if matches!(part, Part::Sample | Part::Draw) {
            return;
        }
        let mut place = Place::random(model, part, 0);
        let outside = [vec3(1.0, 0.0, 0.0), vec3(0.6, 0.0, -0.8)];
        let count = if model.model().domain == Domain::Upper { 2 } else { 1 };
        for wi in &outside[..count] {
            place.first = *wi;
            assert!(packed::<f32>(packed_function, &place).iter().all(|x| *x == 0.0), "{} {part:?}", model.id());
        }
    });
}

#[test]
fn a_long_chain_is_refused() {
    let (graph, output) =
        lesk_math::expr::record(|| (0..10_000).fold(lesk_math::expr::input("x"), |x, _| lesk_math::Real::exp(x)));
    let recording = Recording {
        graph,
        outputs: vec![crate::record::Output { name: "f", components: vec![output] }],
        inputs: vec![crate::record::Input::Member(0, 0)],
        members: vec![Type::Scalar],
    };
    assert!(matches!(pack::pack(&recording), Err(crate::Error::TooDeep { .. })));
}

#[test]
fn a_cross_product_of_shared_components_packs_without_end() {
    // y and z of one vector are operands of x of the other: vectors must not wait for each other
    let (graph, outputs) = lesk_math::expr::record(|| {
        let v = |n: &str| vec3(lesk_math::expr::input(n), lesk_math::expr::input(n), lesk_math::expr::input(n));
        let (a, b) = (v("a"), v("b"));
        let c = a.cross(b);
        let d = vec3(c.y + a.x, c.z + a.y, c.x + a.z);
        (c + d * d.dot(c)).cross(c.normalize()).normalize()
    });
    let vectors = (0..2).flat_map(|v| (0..3).map(move |k| crate::record::Input::Argument(v, k)));
    let recording = Recording {
        graph,
        outputs: vec![crate::record::Output { name: "v", components: outputs.to_array().to_vec() }],
        inputs: vectors.collect(),
        members: Vec::new(),
    };
    let function = idiom::rewrite(&slim::slim(&pack::pack(&recording).unwrap()));
    let place = Place { first: vec3(0.1, 0.2, 0.3), second: vec3(0.5, -0.4, 0.7), params: Vec::new() };
    for (x, y) in packed::<f64>(&function, &place).iter().zip(recorded::<f64>(&recording, &place)) {
        assert!((x - y).abs() < 64.0 * f64::EPSILON);
    }
}

/// The unit that was made last is kept: neither another model nor other parts or functions may get it.
#[test]
fn what_was_written_before_does_not_matter() {
    let mut asked = Vec::new();
    for id in ["ward", "ggx"] {
        for parts in [&[Part::Eval][..], &[Part::Eval, Part::Pdf], &[Part::Pdf]] {
            asked.extend([Math::Builtin, Math::Exact].map(|math| (id, parts, math)));
        }
    }
    let write = |&(id, parts, math): &(&str, &[Part], Math)| {
        let options = crate::Options { math, ..crate::Options::default() };
        let model = registry::find(id).expect("a model of the registry");
        crate::export(model, parts, crate::Language::Wgsl, options).expect("a model that can be written")
    };
    let forward: Vec<_> = asked.iter().map(write).collect();
    let mut backward: Vec<_> = asked.iter().rev().map(write).collect();
    backward.reverse();
    assert_eq!(forward, backward);
}
