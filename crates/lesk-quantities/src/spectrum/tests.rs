use super::*;
use crate::photometry::K_M;
use proptest::prelude::*;

fn table(text: &str) -> Result<Spectrum, String> {
    Spectrum::from_text("lamp.csv", text).map_err(|error| error.to_string())
}

#[test]
fn every_listed_name_is_read_and_keeps_its_name() {
    for name in Spectrum::names() {
        assert_eq!(Spectrum::parse(name).unwrap().name(), name);
        assert_eq!(Spectrum::parse(&name.to_lowercase()).unwrap().name(), name);
    }
    for (text, name) in [
        ("F2", "FL2"),
        ("blackbody:2856K", "blackbody 2856 K"),
        ("Blackbody 2856 K", "blackbody 2856 K"),
        ("600nm", "600 nm"),
        ("0.6 um", "600 nm"),
        ("gaussian:450nm,20nm", "gaussian 450 nm, 20 nm"),
        ("d6504", "D6504"),
        ("D 6504.5 K", "D 6504.5 K"),
    ] {
        let spectrum = Spectrum::parse(text).unwrap();
        assert_eq!(spectrum.name(), name, "{text}");
        assert_eq!(Spectrum::parse(name).unwrap(), spectrum, "{text}");
    }
}

#[test]
fn names_that_are_no_spectrum_are_refused() {
    let bad = [
        "",
        " ",
        "f",
        "F",
        "D",
        "D1",
        "D999",
        "FL13",
        "LED-X",
        "blackbody",
        "blackbody 5 m",
        "gaussian 5 nm",
        "5 m",
        "600",
    ];
    for text in bad {
        assert!(Spectrum::parse(text).is_err(), "{text}");
    }
}

#[test]
fn illuminant_a_is_100_at_560_nm_and_has_the_table_of_cie_15() {
    let a = Spectrum::parse("A").unwrap();
    // CIE 15, table T.1: 380, 560, 780 nm
    for (nm, value) in [(380.0, 9.7951), (560.0, 100.0), (780.0, 241.675)] {
        assert!((a.at(nm) / value - 1.0).abs() < 1e-5, "{nm}: {}", a.at(nm));
    }
}

#[test]
fn daylight_at_6504_k_has_the_table_of_d65() {
    let d65 = Spectrum::parse("D65").unwrap();
    // CIE 15, table T.1 (ISO 11664-2): 380, 450, 560, 600, 780 nm
    for (nm, value) in [(380.0, 49.9755), (450.0, 117.008), (560.0, 100.0), (600.0, 90.0062), (780.0, 63.3828)] {
        assert!((d65.at(nm) - value).abs() < 0.01, "{nm}: {}", d65.at(nm));
    }
    assert!(d65.at(830.0) > 0.0 && d65.at(831.0) == 0.0);
}

#[test]
fn a_line_has_the_efficacy_and_the_photons_of_its_wavelength() {
    let line = Spectrum::line(600.0).unwrap();
    assert_eq!(line.efficacy(None, Vision::Photopic), K_M * 0.631);
    assert!((line.photons_per_joule(None) / 3.020_470e18 - 1.0).abs() < 1e-6); // lights.md section 5
    assert_eq!(line.integrate(Range { first_nm: 380, last_nm: 500 }, |_| 1.0), 0.0);
    // V'(600) = 0.03315 (CIE 018)
    assert!((line.efficacy(None, Vision::Scotopic) / (1700.06 * 0.03315) - 1.0).abs() < 1e-12);
}

#[test]
fn a_black_body_counts_its_whole_spectrum() {
    let lamp = Spectrum::blackbody(2856.0).unwrap();
    assert!((lamp.efficacy(None, Vision::Photopic) - 16.446).abs() < 5e-4); // lights.md 3.1
    assert!(lamp.efficacy(Some(Range::VISIBLE), Vision::Photopic) > 150.0);
}

#[test]
fn narrow_gaussians_are_lines() {
    // V is smooth: the mean over a width of 1 nm differs from V(555) by V'' sigma²/2, 4e-5
    let led = Spectrum::gaussian(555.0, 1.0).unwrap();
    assert!((led.efficacy(None, Vision::Photopic) / K_M - 1.0).abs() < 1e-3);
    let wide = Spectrum::gaussian(500.0, 40.0).unwrap();
    // the integral of a Gaussian: width * sqrt(pi / (4 ln 2))
    let area = 40.0 * (std::f64::consts::PI / (4.0 * std::f64::consts::LN_2)).sqrt();
    assert!((wide.energy(None) / area - 1.0).abs() < 1e-6);
}

#[test]
fn tables_of_all_usual_kinds_are_read() {
    let texts = [
        "400,1\n500,3\n",
        "\u{feff}Wellenlaenge (nm),Bestrahlungsstaerke (W/m^2)\r\n400,1.0\r\n500,3e0\r\n",
        "# spd\n400 1\n500 3",
        "400;1,0\n500;3,0",
        "400:1 500:3\n500:3",
        "\"nm\",\"value\",\"sd\"\n400,1,0.1\n\n500,3,0.1",
    ];
    for text in texts {
        let lamp = table(text).unwrap();
        assert_eq!([lamp.at(400.0), lamp.at(450.0), lamp.at(500.0), lamp.at(501.0)], [1.0, 2.0, 3.0, 0.0], "{text}");
        assert!((lamp.energy(None) - 200.0).abs() < 1e-9);
    }
}

#[test]
fn a_table_finer_than_1_nm_is_integrated_between_its_whole_nm() {
    // a triangle of height 1 between two whole nm: its area is 0.5, and a sum at 1 nm would miss it
    let text = "500,0\n500.5,1\n501,0\n501.5,0\n502,0";
    assert!((table(text).unwrap().energy(None) - 0.5).abs() < 1e-12);
}

#[test]
fn a_table_coarser_or_beside_whole_nm_is_integrated_to_its_rows() {
    // linear between 400.25 and 401.75 nm, 7.5 nm² under it; a sum at whole nm would miss its ends
    let lamp = table("400.25,4\n401.75,6").unwrap();
    assert!((lamp.energy(None) - 7.5).abs() < 1e-12);
}

#[test]
fn sunlight_has_the_integrals_of_its_standard() {
    // ASTM G173-03 by the trapezoid rule, W/m² and klx: lights.md, section 5
    for (name, irradiance, illuminance) in
        [("AM0", 1347.93, 133.10), ("AM1.5G", 1000.37, 109.50), ("AM1.5D", 900.14, 97.14)]
    {
        let sun = Spectrum::parse(name).unwrap();
        let energy = sun.energy(None);
        assert!((energy - irradiance).abs() < 0.006, "{name}: {energy} W/m²");
        let klx = energy * sun.efficacy(sun.range(), Vision::Photopic) / 1e3;
        assert!((klx - illuminance).abs() < 0.006, "{name}: {klx} klx");
    }
}

#[test]
fn faults_of_tables_are_named_with_their_line() {
    let cases = [
        ("", "0 rows"),
        ("400,1", "1 rows"),
        ("400,1\nx", "line 2: `x` is not two numbers"),
        ("400,1\n400,2", "line 2: wavelength 400 nm after 400 nm"),
        ("400,1\n399,2", "ascending"),
        ("400,1\n410,nan", "line 2: value NaN"),
        ("0,1\n410,1", "line 1: wavelength 0 nm"),
        ("400,1\n2e5,1", "line 2: wavelength 200000 nm"),
        ("400,0\n500,0", "holds no light"),
        ("400,-1\n500,-1", "holds no light"),
    ];
    for (text, part) in cases {
        let error = table(text).unwrap_err();
        assert!(error.contains(part), "{text}: {error}");
    }
    assert!(table(&" ".repeat(MAX_TEXT + 1)).unwrap_err().contains("bytes"));
}

proptest! {
    #[test]
    fn any_table_is_read_or_refused(text in "[0-9a-z.,;:\\-+ \\t\\n#\"\u{feff}]{0,200}") {
        if let Ok(lamp) = table(&text) {
            prop_assert!(lamp.energy(None).is_finite() && lamp.energy(None) > 0.0);
            prop_assert!(lamp.efficacy(None, Vision::Photopic).is_finite());
        }
    }

    #[test]
    fn any_name_is_read_or_refused(text in "\\PC{0,120}") {
        let _ = Spectrum::parse(&text);
    }

    #[test]
    fn names_like_spectra_are_read_or_refused(text in "(D|FL|F|HP|LED-|blackbody|gaussian)[: ]?[0-9a-zA-Z., ]{0,12}") {
        if let Ok(spectrum) = Spectrum::parse(&text) {
            prop_assert!(spectrum.energy(None) > 0.0, "{}", spectrum);
        }
    }
}
