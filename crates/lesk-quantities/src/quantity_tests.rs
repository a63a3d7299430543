use super::*;
use proptest::prelude::*;
use std::f64::consts::PI;

fn si(text: &str) -> f64 {
    Quantity::parse(text).unwrap_or_else(|e| panic!("{text}: {e}")).si()
}

fn error(text: &str, accepted: &[Dimension]) -> String {
    Quantity::parse_as(text, accepted).unwrap_err().to_string()
}

#[test]
fn units_of_scene_files_have_their_si_values() {
    let cases = [
        ("1100 lm", 1100.0),
        ("5 cm", 0.05),
        ("5cm", 0.05),
        ("7 mm", 0.007),
        ("1.5 km", 1500.0),
        ("1 in", 0.0254),
        ("1 ft", 0.3048),
        ("550 nm", 550e-9),
        ("2700 K", 2700.0),
        ("60 W", 60.0),
        ("1.1 klm", 1100.0),
        ("3 W/sr", 3.0),
        ("2 kcd", 2000.0),
        ("500 lx", 500.0),
        ("100 klx", 1e5),
        ("1000 W/m2", 1000.0),
        ("1000 W/m²", 1000.0),
        ("1000 W/m^2", 1000.0),
        ("2 W/m2/sr", 2.0),
        ("2 W/(m² sr)", 2.0),
        ("5 kcd/m2", 5000.0),
        ("300 nit", 300.0),
        ("250 ms", 0.25),
        ("13.5 EV", 13.5),
        ("1e3m", 1000.0),
        ("+2.5E-3 m", 0.0025),
        ("-1 m", -1.0),
        (".5 m", 0.5),
        ("3. m", 3.0),
    ];
    for (text, expected) in cases {
        assert_eq!(si(text), expected, "{text}");
    }
    assert_eq!(si("180 deg"), PI);
    assert_eq!(si("180°"), PI);
}

#[test]
fn old_units_of_light_have_their_published_values() {
    // BIPM, NIST SP 811 appendix B
    for (text, expected) in
        [("1 fc", 10.7639), ("1 fL", 3.42626), ("1 sb", 1e4), ("10 asb", 3.18310), ("1 La", 3183.10)]
    {
        assert!((si(text) / expected - 1.0).abs() < 2e-6, "{text}");
    }
}

#[test]
fn lx_for_a_source_in_cd_is_refused_with_the_reason() {
    assert_eq!(
        error("30 lx", &[Dimension::LuminousIntensity]),
        "`30 lx` is an illuminance, but a luminous intensity (cd, kcd) is accepted\n\
         hint: lx is per area, cd per solid angle: a distance is needed"
    );
}

#[test]
fn watts_for_lumens_are_refused_because_a_spectrum_is_needed() {
    let text = error("60 W", &[Dimension::LuminousFlux]);
    assert!(text.contains("by a spectrum only") && text.contains("683.002"), "{text}");
}

#[test]
fn a_length_for_a_flux_names_what_is_accepted() {
    let text = error("5 m", &[Dimension::LuminousFlux, Dimension::RadiantFlux]);
    assert_eq!(text, "`5 m` is a length, but a luminous flux (lm, klm) or a radiant flux (W, mW) is accepted");
}

#[test]
fn a_missing_unit_gives_an_example() {
    let text = error("1100", &[Dimension::LuminousFlux]);
    assert_eq!(
        text,
        "`1100` has no unit, a luminous flux (lm, klm) is accepted\nhint: add the unit, for example `1100 lm`"
    );
}

#[test]
fn a_unit_in_the_wrong_case_is_corrected() {
    assert_eq!(error("5 LM", &[]), "unknown unit `LM`\nhint: `lm` is known; case matters");
    assert!(error("5 furlong", &[]).starts_with("unknown unit `furlong`"));
}

#[test]
fn numbers_that_are_not_finite_or_not_plain_are_refused() {
    for text in [
        "nan lm", "inf m", "-inf m", "1e999 m", "1e308 km", "1,5 m", "1_000 m", "1.2.3 m", "", "  ", "lm", "e3 m",
        "- m", "+.e1 m",
    ] {
        let result = Quantity::parse(text);
        assert!(matches!(result, Err(QuantityError::NotANumber { .. })), "{text}: {result:?}");
    }
    let lumen = Unit::parse("lm").unwrap();
    assert!(Quantity::new(f64::NAN, lumen).is_err() && Quantity::new(f64::INFINITY, lumen).is_err());
}

#[test]
fn prefixes_stay_with_units_that_take_them() {
    for text in ["1 kin", "1 clm", "1 kdeg", "1 mEV", "1 kkm", "1 cs"] {
        assert!(matches!(Quantity::parse(text), Err(QuantityError::UnknownUnit { .. })), "{text}");
    }
    assert_eq!(Quantity::parse("1 cd").unwrap().dimension(), Dimension::LuminousIntensity);
    assert_eq!(Quantity::parse("1 min").unwrap().dimension(), Dimension::Time);
}

#[test]
fn conversion_keeps_the_dimension() {
    let unit = |text| Unit::parse(text).unwrap();
    assert_eq!(Quantity::parse("254 cm").unwrap().to(unit("in")), Ok(100.0));
    assert_eq!(Quantity::parse("1 klx").unwrap().to(unit("lm/m2")), Ok(1000.0));
    assert!(Quantity::parse("1 cd").unwrap().to(unit("lm")).is_err());
}

proptest! {
    #[test]
    fn any_text_is_read_or_refused(text in "\\PC{0,40}") {
        if let Err(error) = Quantity::parse_as(&text, &[Dimension::Length]) {
            prop_assert!(error.to_string().len() < 400);
        }
    }

    #[test]
    fn number_like_text_is_read_or_refused(text in "[-+0-9.eE_, ]{0,12}[a-zA-Zµ°²/^()0-9 ]{0,8}") {
        if let Ok(quantity) = Quantity::parse(&text) {
            prop_assert!(quantity.si().is_finite());
            prop_assert_eq!(Quantity::parse(&quantity.to_string()).unwrap(), quantity);
        }
    }

    #[test]
    fn printing_and_reading_gives_the_same_bits(value in -1e300f64..1e300) {
        let quantity = Quantity::new(value, Unit::parse("klm").unwrap()).unwrap();
        prop_assert_eq!(Quantity::parse(&quantity.to_string()).unwrap(), quantity);
    }
}
