//! Conditions of claims are read as they are written, and errors say where.

use lesk_bsdf::params::{Kind, ParamSpec};
use lesk_check::condition::Condition;
use lesk_check::random::Random;
use lesk_check::region::Region;
use lesk_math::CHANNELS;

const fn spec(name: &'static str, kind: Kind, range: [f64; 2]) -> ParamSpec {
    ParamSpec { name, doc: "", kind, default: &[0.5], range, slider: range, log: false, unit: "" }
}

static SPECS: [ParamSpec; 4] = [
    spec("diffuse", Kind::Color, [0.0, 1.0]),
    spec("specular", Kind::Color, [0.0, 1.0]),
    spec("alpha_x", Kind::Scalar, [1e-3, 1.0]),
    spec("alpha_y", Kind::Scalar, [1e-3, 0.5]),
];

/// Diffuse and specular per channel (the last one repeated), then the widths.
fn table(diffuse: [f64; 3], specular: [f64; 3], alpha_x: f64, alpha_y: f64) -> Vec<f64> {
    let colour = |c: [f64; 3]| (0..CHANNELS).map(move |i| c[i]).collect::<Vec<_>>();
    [colour(diffuse), colour(specular), vec![alpha_x, alpha_y]].concat()
}

fn holds(text: &str, params: &[f64]) -> bool {
    Condition::parse(text, &SPECS).unwrap_or_else(|error| panic!("{error}")).holds(params)
}

#[test]
fn conditions_are_evaluated_by_the_rules_of_arithmetic() {
    let params = table([0.5; 3], [0.25; 3], 0.2, 0.4);
    for text in [
        "diffuse + specular <= 1",
        "diffuse+specular<=0.75",
        "diffuse + specular*2 = 1",
        "(diffuse + specular)*2 = 1.5",
        "alpha_y - alpha_x - alpha_x <= 0",
        "alpha_y / alpha_x / 2 = 1",
        "-alpha_x < 0 and --alpha_x > 0",
        "alpha_x >= 2e-1 and 1e+0 > alpha_x and .5 = diffuse",
        "1 - (1 - diffuse) = diffuse",
    ] {
        assert!(holds(text, &params), "{text}");
    }
    for text in ["alpha_x > alpha_y", "diffuse < 0.5", "diffuse = 0.5 and specular = 0.5", "alpha_x / 0 <= 1"] {
        assert!(!holds(text, &params), "{text}");
    }
}

#[test]
fn a_condition_on_colours_must_hold_in_every_channel() {
    if CHANNELS == 3 {
        let params = table([0.5, 0.5, 0.9], [0.25; 3], 0.2, 0.4);
        assert!(!holds("diffuse + specular <= 1", &params));
        assert!(!holds("diffuse + specular > 1", &params));
    }
}

#[test]
fn errors_name_the_place_and_what_is_accepted() {
    let deep = format!("{}1{} <= 1", "(".repeat(1000), ")".repeat(1000));
    let cases = [
        ("", 1, "nothing stands where a parameter or a number is expected"),
        ("alpha_x", 8, "nothing stands where one of `<`"),
        ("alpha_z = 1", 1, "`alpha_z` is not a parameter"),
        ("alpha_x == 1", 10, "`=` stands where"),
        ("alpha_x < 1 alpha_y", 13, "`alpha_y` stands where `and` or the end is expected"),
        ("(alpha_x < 1", 10, "`<` stands where `)` is expected"),
        ("alpha_x < 1..2", 11, "`1..2` is not a number"),
        ("alpha_x & 1", 9, "`&` is not part of a condition"),
        ("alpha_x < \u{3b1}", 11, "is not part of a condition"),
        ("and and and", 1, "`and` stands where"),
        (deep.as_str(), 33, "nested deeper than 32"),
    ];
    for (text, column, message) in cases {
        let error = Condition::parse(text, &SPECS).unwrap_err();
        assert_eq!(error.column, column, "{error}");
        assert!(error.to_string().contains(message), "{error}");
    }
    let error = Condition::parse("alfa = 1", &SPECS).unwrap_err().to_string();
    assert!(error.ends_with("hint: the parameters are diffuse, specular, alpha_x, alpha_y"), "{error}");
}

#[test]
fn random_parameters_lie_on_the_side_of_the_condition_that_is_asked() {
    for text in
        ["diffuse + specular <= 1", "alpha_x = alpha_y", "alpha_y = alpha_x / 2 and diffuse <= 0.5", "alpha_x > 0.9"]
    {
        let condition = Condition::parse(text, &SPECS).unwrap();
        let (inside, outside) = (Region::inside(&SPECS, condition.clone()), Region::outside(&SPECS, condition.clone()));
        let mut rng = Random::new(text, 0);
        for _ in 0..500 {
            let params = inside.draw(&mut rng).unwrap();
            assert!(condition.holds(&params), "{text}: {params:?}");
            assert!(condition.holds(&inside.near(&params, &mut rng, 0.2)));
            assert!(!condition.holds(&outside.draw(&mut rng).unwrap()));
        }
    }
}

#[test]
fn random_parameters_reach_the_border_of_an_inequality() {
    let condition = Condition::parse("diffuse + specular <= 0.7", &SPECS).unwrap();
    let region = Region::inside(&SPECS, condition);
    let mut rng = Random::new("border", 0);
    // the border is met in the channel that is bound first
    let sum = |p: &[f64]| (0..CHANNELS).map(|c| p[c] + p[CHANNELS + c]).fold(0.0, f64::max);
    let at_border = (0..500).filter(|_| sum(&region.draw(&mut rng).unwrap()) > 0.7 - 1e-9).count();
    assert!(at_border > 50, "{at_border}");
}

#[test]
fn an_empty_region_gives_nothing() {
    let condition = Condition::parse("alpha_x > 2", &SPECS).unwrap();
    assert!(Region::inside(&SPECS, condition).draw(&mut Random::new("empty", 0)).is_none());
}
