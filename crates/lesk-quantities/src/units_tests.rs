use super::*;
use proptest::prelude::*;

fn one(text: &str) -> f64 {
    Unit::parse(text).unwrap_or_else(|e| panic!("{text}: {e}")).factor()
}

#[test]
fn every_unit_of_the_table_is_read_back() {
    for atom in ATOMS {
        for prefix in PREFIXES.iter().filter(|p| allowed(p, atom)) {
            let name = format!("{}{}", prefix.symbol, atom.symbol);
            let unit = Unit::parse(&name).unwrap();
            let found = unit.factors[0].unwrap();
            // PartialEq of the rows: a prefix never hides another unit, as m + in would hide min
            assert!(found.atom() == atom && found.prefix() == prefix, "{name} is read as {found:?}");
            assert_eq!(unit.to_string(), name);
        }
    }
}

#[test]
fn every_word_points_to_a_unit() {
    assert!(PREFIXES.len() < 256 && ATOMS.len() < 256);
    for (word, symbol) in WORDS {
        assert!(Unit::parse(symbol).is_ok() && Unit::parse(word).is_err(), "{word}");
    }
}

#[test]
fn products_have_the_factor_of_their_parts() {
    // 1e4 cm2 in a m2; 1 ft = 0.3048 m; 1e9 nm in a m
    let cases = [
        ("W/cm2", 1e4),
        ("mW/cm^2", 10.0),
        ("uW/cm²", 0.01),
        ("W/m2/nm", 1e9),
        ("W m-2 nm-1", 1e9),
        ("W·m⁻²·nm⁻¹", 1e9),
        ("W/(m2 sr nm)", 1e9),
        ("W/m3/sr", 1.0),
        ("kWh/m2", 3.6e6),
        ("lm s", 1.0),
        ("Mlm h", 3.6e9),
        ("lx*h", 3600.0),
        ("umol/s/m2", 6.022_140_76e17),
        ("mol/m2", 6.022_140_76e23),
        ("lm/W", 1.0),
        ("cd/cm2", 1e4),
        ("lm2·lm-1·s", 1.0),
    ];
    for (text, factor) in cases {
        assert_eq!(one(text), factor, "{text}");
    }
    assert!((one("cd/ft2") * 0.3048 * 0.3048 - 1.0).abs() < 4.0 * f64::EPSILON);
}

#[test]
fn old_units_are_their_products() {
    // the definitions: footcandle lm/ft2, phot lm/cm2, stilb cd/cm2
    for (old, product) in [("fc", "lm/ft2"), ("ph", "lm/cm2"), ("sb", "cd/cm2")] {
        let (old, product) = (Unit::parse(old).unwrap(), Unit::parse(product).unwrap());
        assert_eq!(old.dimension(), product.dimension());
        assert!((old.factor() / product.factor() - 1.0).abs() < 4.0 * f64::EPSILON, "{old} {product}");
    }
}

#[test]
fn units_that_could_mean_two_things_or_nothing_are_refused() {
    for text in ["W/m2 sr", "W//m2", "/m", "lm/", "W/K", "m9", "m0", "(lm)", "lm/(m2 sr", "2 lm", "", "m2m", "lm2"] {
        assert!(Unit::parse(text).is_err(), "{text}");
    }
    assert!(Unit::parse(&"m ".repeat(1000)).is_err());
}

#[test]
fn words_are_answered_with_their_symbol() {
    for (word, symbol) in [("lumens", "lm"), ("Lux", "lx"), ("watts", "W"), ("lambert", "La"), ("LM", "lm")] {
        assert_eq!(meant(word), Some(symbol), "{word}");
    }
    assert_eq!(meant("furlong"), None);
}

proptest! {
    #[test]
    fn any_product_is_refused_or_printed_and_read_back(
        text in "(k|m|u|c)?(lm|W|cd|lx|m|sr|s|nm|mol)[2³]?([ /·](k|m|c)?(m|sr|s|h|nm|lm)(2|\\^2|-1|⁻²)?){0,4}",
    ) {
        if let Ok(unit) = Unit::parse(&text) {
            let back = Unit::parse(&unit.to_string()).unwrap();
            prop_assert_eq!(back, unit);
            prop_assert!(unit.factor().is_finite() && unit.factor() > 0.0);
        }
    }

    #[test]
    fn any_unit_text_is_read_or_refused(text in "\\PC{0,300}") {
        let _ = Unit::parse(&text);
    }
}
