use super::*;
use proptest::prelude::*;
use std::f64::consts::PI;

fn ask(given: &str, to: &str, options: &[(&str, &str)]) -> Result<Conversion, QuantityError> {
    let mut assumptions = Assumptions::none();
    for (name, text) in options {
        assumptions.set(name, text)?;
    }
    convert(&Given::parse(given)?, &Target::parse(to)?, &assumptions)
}

fn value(given: &str, to: &str, options: &[(&str, &str)]) -> f64 {
    ask(given, to, options).unwrap_or_else(|e| panic!("{given} to {to}: {e}")).value
}

fn error(given: &str, to: &str, options: &[(&str, &str)]) -> String {
    ask(given, to, options).expect_err(given).to_string()
}

/// The value that the source prints with its digits.
fn printed(got: f64, expected: f64, digit: f64) {
    assert!((got - expected).abs() <= 0.5 * digit, "{got} is not {expected}");
}

#[test]
fn exercises_of_the_lecture_have_their_values() {
    // lecture.md, lights.md section 5
    printed(value("3.86e26 W", "W/m2", &[("distance", "1.5e11m")]), 1365.196, 1e-3);
    printed(value("3.828e26 W", "W/m2", &[("distance", "1 au")]), 1361.166, 1e-3);
    printed(value("1100 lm", "cd", &[]), 87.5352, 1e-4);
    printed(value("1100 lm", "lx", &[("distance", "1.5m")]), 38.9045, 1e-4);
    printed(value("1600 lm", "lx", &[("distance", "2 m")]), 31.831, 1e-3);
    printed(value("1 W @ 600 nm", "photons/s", &[]) / 1e18, 3.020470, 1e-6);
    printed(value("1 W @ 600 nm", "umol/s", &[]), 5.0156, 1e-4);
    printed(value("1 W @ 600 nm", "lm", &[]), 430.974, 1e-3);
    printed(value("1 W @ 555 nm", "lm", &[]), 683.002, 1e-3);
    printed(value("1 W @ 555 nm", "photons/s", &[]) / 1e18, 2.79393, 1e-5);
    printed(value("600 nm", "J", &[]) * 1e19, 3.310743, 1e-6);
    printed(value("600 nm", "eV", &[]), 2.06640, 1e-5);
    // the constants of the slides: 680 lm/W, 380 to 770 nm; equal energy over 390 instead of 400 nm, and V beyond
    // 770 nm is 1e-6 of its integral
    let [ours, theirs] = [vec![], vec![("km", "680"), ("range", "380:770")]].map(|o| value("1 W @ E", "lm", &o));
    assert!((theirs / ours / (680.0 / 683.002 * 400.0 / 390.0) - 1.0).abs() < 1e-5);
}

#[test]
fn both_directions_of_every_rule_undo_each_other() {
    let options = [
        ("distance", "3 m"),
        ("cone", "20 deg"),
        ("solid_angle", "0.3 sr"),
        ("area", "2 m2"),
        ("reflectance", "0.4"),
        ("incidence", "35 deg"),
        ("time", "90 s"),
        ("lambertian", ""),
        ("dome", ""),
    ];
    let mut assumptions = Assumptions::none();
    for (name, text) in options {
        assumptions.set(name, text).unwrap();
    }
    for rule in rules::RULES.iter().filter(|rule| rule.from != Node::Temperature) {
        let back =
            rules::RULES.iter().find(|b| b.from == rule.to && b.to == rule.from && b.needs == rule.needs).unwrap();
        let there = (rule.apply)(7.0, &assumptions);
        assert!(((back.apply)(there, &assumptions) / 7.0 - 1.0).abs() < 1e-14, "{}", rule.formula);
        assert!(!rule.says(&assumptions).contains(['{', '}']) && !rule.says(&assumptions).contains("NaN"));
    }
}

#[test]
fn closed_forms_of_sources_hold() {
    // hard cones of 1000 lm: lights.md section 6
    for (half_angle, cd) in [("15 deg", 4670.84), ("30 deg", 1187.95), ("45 deg", 543.39), ("60 deg", 318.31)] {
        printed(value("1000 lm", "cd", &[("cone", half_angle)]), cd, 0.011);
    }
    // a Lambertian patch: Φ = π L A; a lit one: L = ρ E / π; a dome: E = π L
    printed(value("1000 cd/m2", "lm", &[("area", "0.5 m2"), ("lambertian", "")]), 500.0 * PI, 1e-9);
    printed(value("500 lx", "cd/m2", &[("reflectance", "0.5")]), 250.0 / PI, 1e-9);
    printed(value("500 lx", "cd/m2", &[("reflectance", "50 %")]), 250.0 / PI, 1e-9);
    printed(value("2000 cd/m2", "lx", &[("dome", "")]), 2000.0 * PI, 1e-9);
    // cosine law at 60 degrees: half
    printed(value("100 cd", "lx", &[("distance", "2 m"), ("incidence", "60 deg")]), 12.5, 1e-9);
    // the Sun's disc of 6.8e-5 sr and 1.6e9 cd/m2
    printed(value("1.6e9 cd/m2", "lx", &[("solid_angle", "6.8e-5 sr")]), 108_800.0, 1e-6);
    printed(value("90 deg", "sr", &[]), 2.0 * PI, 1e-12);
    printed(value("6.283185307179586 sr", "deg", &[]), 90.0, 1e-12);
    // EV of ISO 2720
    printed(value("10 EV", "cd/m2", &[]), 128.0, 1e-9);
    printed(value("640 lx", "EV", &[]), 8.0, 1e-9);
}

#[test]
fn chains_cross_several_rules() {
    // 1000 lm in all directions, 2 m away, on grey paper: 1000/4π/4 * 0.18/π
    let got = ask("1000 lm", "cd/m2", &[("distance", "2 m"), ("reflectance", "0.18")]).unwrap();
    printed(got.value, 1000.0 / (4.0 * PI) / 4.0 * 0.18 / PI, 1e-12);
    assert_eq!(got.steps.len(), 3);
    assert_eq!(got.steps[1].unit.to_string(), "lx");
    // watts of a lamp to µmol on a square metre and to lux hours
    printed(value("10 W @ 450 nm", "umol/s/m2", &[("area", "2 m2")]), 5.0 / 0.2658, 2e-2);
    printed(value("1000 lm", "lx h", &[("area", "4 m2"), ("time", "2 h")]), 500.0, 1e-9);
    // Stefan-Boltzmann at 1000 K: 56703.74 W/m2
    printed(value("1000 K", "W/m2", &[("lambertian", "")]), 56_703.744, 1e-2);
    // 2042 K, the old candela: 60 cd/cm2, 5.986e5 cd/m2 with today's constants (lights.md 3.1)
    printed(value("2042 K", "cd/m2", &[]), 5.986e5, 100.0);
    printed(value("5778 K", "nm", &[]), 501.5, 0.1);
    printed(value("10 W/m2/nm", "W/m2", &[("width", "5 nm")]), 50.0, 1e-9);
}

#[test]
fn the_chain_uses_what_was_given() {
    let cone = ask("1000 lm", "lx", &[("distance", "1 m"), ("cone", "30 deg")]).unwrap();
    assert!(cone.steps[0].assumption.contains("half-angle 30°") && cone.unused.is_empty(), "{cone:?}");
    let area = ask("1000 lm", "lx", &[("area", "2 m2")]).unwrap();
    assert_eq!((area.value, area.steps.len()), (500.0, 1));
    let idle = ask("1000 lm", "cd", &[("time", "1 s")]).unwrap();
    assert_eq!(idle.unused, ["time"]);
    assert!(ask("1 fc", "lx", &[]).unwrap().steps.is_empty());
}

#[test]
fn what_is_missing_is_named_with_its_option() {
    let text = error("300 lx", "cd", &[]);
    assert!(text.contains("lx is per area, cd per solid angle: a distance is needed"), "{text}");
    assert!(text.contains("`--at 1.5m`, in Python `distance`"), "{text}");
    let text = error("1100 lm", "lx", &[]);
    assert!(text.contains("--at") && text.contains("--area"), "{text}");
    let text = error("60 W", "lm", &[]);
    assert!(text.contains("by a spectrum only") && text.contains("--spectrum D65"), "{text}");
    assert!(error("300 cd/m2", "lm", &[("area", "1 m2")]).contains("--lambertian"));
    assert!(error("1100 lm", "cd/m2", &[("distance", "2 m"), ("lambertian", "")]).contains("--area"));
    assert!(error("5 m", "lm", &[]).contains("no link"));
    assert!(error("1 W/nm", "W", &[]).contains("--width"));
    assert!(error("1 W @ 2000 nm", "lm", &[]).contains("nothing to convert"));
    assert!(error("1 lm @ 2000 nm", "W", &[]).contains("nothing to convert"));
}

#[test]
fn options_outside_their_range_are_refused() {
    let cases = [
        ("distance", "0 m"),
        ("distance", "-1 m"),
        ("distance", "1 s"),
        ("cone", "181 deg"),
        ("reflectance", "1.2"),
        ("reflectance", "x"),
        ("incidence", "90 deg"),
        ("km", "0"),
        ("range", "5"),
        ("spectrum", "blue"),
        ("colour", "blue"),
    ];
    for (name, text) in cases {
        assert!(Assumptions::none().set(name, text).is_err(), "{name} {text}");
    }
}

#[test]
fn efficacy_and_scotopic_vision_are_named() {
    let lamp = ask("11 W", "lm", &[("efficacy", "100 lm/W")]).unwrap();
    assert_eq!((lamp.value, lamp.unused.len()), (1100.0, 0));
    // K'm V'(507) = 1700.06
    let night = ask("1 W @ 507 nm", "lm", &[("scotopic", "")]).unwrap();
    assert!((night.value - 1700.06).abs() < 1e-9 && night.steps[0].assumption.contains("K'_m = 1700.06"));
    // 54 lx per umol/s/m2 of sunlight within 400 to 700 nm is the figure of horticulture (McCree 1972: 51 to 57)
    let sun = value("100 klx @ D55", "PPFD", &[]);
    assert!((51.0..57.0).contains(&(1e5 / sun)), "{sun}");
}

#[test]
fn options_and_needs_stand_in_the_same_order() {
    for (i, need) in Need::ALL.into_iter().enumerate() {
        assert_eq!(need as usize, i);
    }
    for info in &OPTIONS {
        let flag = info.flag.split(' ').next().unwrap().trim_start_matches("--");
        assert!(flag.replace('-', "_") == info.name || flag == "at" && info.name == "distance", "{flag}");
    }
}

proptest! {
    #[test]
    fn given_texts_are_read_printed_and_read_again(
        text in "[0-9.e]{1,6} ?(lm|W|lx|cd/m2|umol/s)( ?@ ?(D65|600 nm|A|FL2|blackbody 2856 K))?",
    ) {
        if let Ok(given) = Given::parse(&text) {
            prop_assert_eq!(Given::parse(&given.to_string()).unwrap(), given);
        }
    }

    #[test]
    fn any_given_text_is_read_or_refused(text in "\\PC{0,60}") {
        let _ = Given::parse(&text);
        let _ = Target::parse(&text);
        for name in ["distance", "reflectance", "km", "range", "spectrum"] {
            let _ = Assumptions::none().set(name, &text);
        }
    }

    #[test]
    fn every_pair_of_units_converts_to_a_finite_number_or_explains(from in 0usize..31, to in 0usize..31, x in -1e12f64..1e12) {
        let all: Vec<Dimension> = Dimension::all().collect();
        let text = format!("{x} {} @ D65", all[from].si_symbol());
        let options = [("distance", "2 m"), ("area", "3 m2"), ("lambertian", ""), ("time", "1 h"), ("width", "1 nm")];
        match ask(&text, all[to].si_symbol(), &options) {
            Ok(made) => prop_assert!(made.value.is_finite()),
            Err(error) => prop_assert!(!error.to_string().is_empty()),
        }
    }
}
