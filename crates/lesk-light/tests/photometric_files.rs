//! Luminaire files that are made here: written, read again, converted, integrated. Expected values are closed forms.

use lesk_light::photometry::{
    Coordinates, Counted, Generation, LampSet, Opening, OpeningShape, Photometry, ReadOptions, Symmetry, Tilt, Web,
};
use std::f64::consts::PI;

fn steps(from: f64, to: f64, step: f64) -> Vec<f64> {
    (0..=((to - from) / step).round() as usize).map(|i| from + step * i as f64).collect()
}

/// A luminaire of type C whose intensity is `f` of theta and phi in radians.
fn luminaire(v: Vec<f64>, h: Vec<f64>, f: impl Fn(f64, f64) -> f64) -> Photometry {
    let values = h.iter().flat_map(|h| v.iter().map(|v| f(v.to_radians(), h.to_radians()))).collect();
    Photometry::new(Web::new(Coordinates::C, v, h, values))
}

fn parse(text: &str) -> Photometry {
    Photometry::parse(text.as_bytes(), ReadOptions { strict: true, lamp_set: 0 }).unwrap()
}

fn close(got: f64, expected: f64, relative: f64) {
    assert!((got - expected).abs() <= relative * expected.abs(), "{got} is not {expected}");
}

/// What a file keeps: nine digits of each number.
const DIGITS: f64 = 1e-8;

#[test]
fn closed_fluxes_survive_writing_and_reading_in_every_edition() {
    // error of the bilinear table: about n h²/12 with the step h = 0.5 deg in radians, at most n * 6.4e-6
    for generation in Generation::ALL {
        let iso = luminaire(steps(0.0, 180.0, 5.0), vec![0.0], |_, _| 100.0);
        close(parse(&iso.to_ies(generation).unwrap()).flux(), 400.0 * PI, DIGITS);
        for n in [1, 3, 30] {
            let cosine = luminaire(steps(0.0, 90.0, 0.5), vec![0.0], |theta, _| 100.0 * theta.cos().max(0.0).powi(n));
            let read = parse(&cosine.to_ies(generation).unwrap());
            close(read.flux(), 100.0 * 2.0 * PI / f64::from(n + 1), f64::from(n) * 6.4e-6 + DIGITS);
            close(read.flux(), cosine.flux(), DIGITS);
        }
    }
    let lambert = luminaire(steps(0.0, 90.0, 0.5), vec![0.0], |theta, _| 100.0 * theta.cos().max(0.0));
    close(parse(&lambert.to_eulumdat().unwrap()).flux(), 100.0 * PI, 6.4e-6 + DIGITS);
}

/// One distribution per symmetry, of known flux: Lambert's times a function of phi with mean 1.
fn shapes() -> Vec<(Symmetry, Photometry)> {
    let h = steps(0.0, 360.0, 15.0);
    let shape = |f: fn(f64) -> f64| {
        luminaire(steps(0.0, 90.0, 1.0), h.clone(), move |theta, phi| 100.0 * theta.cos().max(0.0) * f(phi))
    };
    vec![
        (Symmetry::Quadrant, shape(|phi| 1.0 + 0.5 * (2.0 * phi).cos())),
        (Symmetry::C0C180, shape(|phi| 1.0 + 0.5 * phi.cos())),
        (Symmetry::C90C270, shape(|phi| 1.0 + 0.5 * phi.sin())),
        (Symmetry::None, shape(|phi| 1.0 + 0.3 * phi.cos() + 0.4 * (2.0 * phi).sin())),
    ]
}

#[test]
fn every_symmetry_is_found_stored_and_unfolded() {
    for (symmetry, photometry) in shapes() {
        assert_eq!(photometry.detected_symmetry(), symmetry);
        let mut texts = vec![photometry.to_eulumdat().unwrap()];
        texts.extend(Generation::ALL.map(|generation| photometry.to_ies(generation).unwrap()));
        for text in texts {
            let read = parse(&text);
            // C90-C270 can be stored in IES of 1995 and in EULUMDAT only
            assert!(read.symmetry == symmetry || symmetry == Symmetry::C90C270 && read.symmetry == Symmetry::None);
            // 1 degree: h²/12 = 2.5e-5
            close(read.flux(), 100.0 * PI, 3e-5);
            for (theta, phi) in [(10, 0), (30, 45), (50, 120), (70, 200), (85, 300)] {
                let (theta, phi) = (f64::from(theta).to_radians(), f64::from(phi).to_radians());
                close(read.intensity(theta, phi), photometry.intensity(theta, phi), DIGITS);
            }
        }
    }
}

#[test]
fn a_file_of_fewer_planes_is_shorter() {
    let length = |i: usize| shapes()[i].1.to_ies(Generation::Y2019).unwrap().len();
    assert!(2 * length(0) < length(1) + 2000 && length(1) < length(3) * 2 / 3);
}

#[test]
fn types_a_and_b_are_written_read_and_turned_into_c() {
    for coordinates in [Coordinates::A, Coordinates::B] {
        let v = steps(-90.0, 90.0, 2.5);
        let f = |v: f64, h: f64| {
            100.0 * (v.to_radians().cos() * h.to_radians().cos()).max(0.0) * (1.0 + 0.3 * h.to_radians().sin())
        };
        let values = v.iter().flat_map(|h| v.iter().map(|v| f(*v, *h))).collect();
        let photometry = Photometry::new(Web::new(coordinates, v.clone(), v.clone(), values));
        let read = parse(&photometry.to_ies(Generation::Y2002).unwrap());
        assert_eq!(read.web.coordinates(), coordinates);
        // Lambert about the axis with an odd part: π; 2.5 degrees: h²/6 = 3e-4
        close(read.flux(), 100.0 * PI, 4e-4);
        let c = read.resampled(1.0, 1.0).unwrap();
        close(c.flux(), read.flux(), 5e-4); // looked up again in steps of 1 degree
        let d = coordinates.direction(20.0, -35.0);
        close(c.toward(d), read.toward(d), 1e-3);
    }
}

#[test]
fn eulumdat_and_ies_convert_into_each_other() {
    let mut photometry = shapes().remove(3).1;
    photometry.absolute = false;
    photometry.lamps = vec![LampSet {
        count: 2.0,
        kind: "T5".into(),
        flux: Some(500.0),
        color: "4000".into(),
        rendering: "80".into(),
        watts: 9.0,
    }];
    photometry.opening = Opening { shape: OpeningShape::Box, size: [1.2, 0.3, 0.05] };
    photometry.texts = vec![("MANUFAC".into(), "Lesk".into()), ("LUMINAIRE".into(), "Tube".into())];
    let ldt = parse(&photometry.to_eulumdat().unwrap());
    let ies = parse(&ldt.to_ies(Generation::Y2019).unwrap());
    for read in [&ldt, &ies] {
        close(read.flux(), photometry.flux(), DIGITS);
        close(read.light_output_ratio().unwrap(), photometry.flux() / 500.0, DIGITS);
        close(read.watts().unwrap(), 9.0, DIGITS);
        assert!(!read.absolute);
        assert_eq!(read.opening.shape, OpeningShape::Box);
        (0..3).for_each(|i| close(read.opening.size[i], photometry.opening.size[i], DIGITS));
    }
    assert_eq!(ies.text("manufac"), Some("Lesk"));
    assert_eq!(ldt.text("luminaire"), Some("Tube"));
}

#[test]
fn openings_survive_in_every_edition_that_has_them() {
    let round = [
        (OpeningShape::Ellipse, [0.2, 0.2, 0.0]),
        (OpeningShape::Cylinder(2), [0.2, 0.2, 0.4]),
        (OpeningShape::Ellipsoid, [0.2; 3]),
    ];
    let flat = [
        (OpeningShape::Point, [0.0; 3]),
        (OpeningShape::Rectangle, [1.2, 0.3, 0.0]),
        (OpeningShape::Box, [1.2, 0.3, 0.1]),
    ];
    let lying = [(OpeningShape::Cylinder(0), [1.2, 0.1, 0.1]), (OpeningShape::Cylinder(1), [0.1, 1.2, 0.1])];
    for (shape, size) in round.into_iter().chain(flat).chain(lying) {
        for generation in [Generation::Y1995, Generation::Y2002, Generation::Y2019] {
            let mut photometry = luminaire(steps(0.0, 90.0, 10.0), vec![0.0], |_, _| 1.0);
            photometry.opening = Opening { shape, size };
            let read = parse(&photometry.to_ies(generation).unwrap());
            assert_eq!(read.opening.shape, shape, "{generation:?}");
            (0..3).for_each(|i| assert!((read.opening.size[i] - size[i]).abs() < 1e-9, "{shape:?}"));
        }
    }
}

#[test]
fn factors_count_by_their_edition() {
    let file = |tag: &str, ballast: &str, third: &str| {
        format!("{tag}\n[TEST] x\nTILT=NONE\n1 -1 2 2 1 1 2 0 0 0\n{ballast} {third} 10\n0 180\n0\n10 10\n")
    };
    for (tag, third, factor) in [
        ("free text", "0.5", 0.5),
        ("IESNA91", "0.5", 0.5),
        ("IESNA:LM-63-1995", "1", 1.0),
        ("IESNA:LM-63-2002", "1", 1.0),
        ("IES:LM-63-2019", "1.11100", 1.0),
    ] {
        // 10 cd * multiplier 2 * ballast 0.9 * the third field until 1991
        close(parse(&file(tag, "0.9", third)).flux(), 4.0 * PI * 18.0 * factor, 1e-12);
    }
}

#[test]
fn radiant_files_count_watts_and_stay_radiant() {
    let text =
        "IES:LM-63-2019\n[_INTENSITYUNITS] mW/sr\nTILT=NONE\n1 -1 1 2 1 1 2 0 0 0\n1 1.00001 10\n0 180\n0\n10 10\n";
    let photometry = parse(text);
    assert_eq!(photometry.counted, Counted::Power);
    close(photometry.flux(), 4.0 * PI * 0.01, 1e-12);
    let again = parse(&photometry.to_ies(Generation::Y2002).unwrap());
    assert_eq!(again.counted, Counted::Power);
    close(again.flux(), photometry.flux(), DIGITS);
    assert!(photometry.to_eulumdat().unwrap_err().message().contains("counts watts"));
}

#[test]
fn tilt_factors_are_kept_and_interpolated() {
    let mut photometry = luminaire(steps(0.0, 90.0, 10.0), vec![0.0], |_, _| 1.0);
    photometry.tilt = Some(Tilt { geometry: 2, angles: vec![0.0, 30.0, 90.0], factors: vec![1.0, 0.9, 0.6] });
    let tilt = parse(&photometry.to_ies(Generation::Y2002).unwrap()).tilt.unwrap();
    assert_eq!(tilt.geometry, 2);
    for (angle, factor) in [(0.0, 1.0), (15.0, 0.95), (60.0, 0.75), (90.0, 0.6), (120.0, 0.6), (-5.0, 1.0)] {
        close(tilt.factor(angle), factor, 1e-12);
    }
}

#[test]
fn beam_angles_of_a_cosine_power_are_those_of_its_formula() {
    // cosⁿ(x) = share at x = acos(share^(1/n))
    let spot = luminaire(steps(0.0, 90.0, 0.25), vec![0.0], |theta, _| theta.cos().max(0.0).powi(40));
    for share in [0.5, 0.1] {
        let expected = 2.0 * f64::powf(share, 1.0 / 40.0).acos();
        let angles = spot.opening_angles(share);
        close(angles.c0, expected, 1e-4); // chords of a quarter of a degree
        close(angles.c90, expected, 1e-4);
    }
    let everywhere = luminaire(steps(0.0, 180.0, 10.0), vec![0.0], |_, _| 1.0);
    assert_eq!(everywhere.opening_angles(0.5).c0, 2.0 * PI);
}

#[test]
fn halves_below_and_above_add_up() {
    let both = luminaire(steps(0.0, 180.0, 1.0), vec![0.0], |theta, _| if theta <= 0.5 * PI { 3.0 } else { 1.0 });
    close(both.web.flux_down(), 6.0 * PI, 1e-12);
    // one cell of 1 degree falls from 3 to 1 just above the horizon
    close(both.flux(), 8.0 * PI, 0.005);
}

#[test]
fn resampling_keeps_the_flux_and_says_what_it_cannot_do() {
    let (_, photometry) = shapes().remove(3);
    close(photometry.resampled(0.5, 7.5).unwrap().flux(), photometry.flux(), 1e-5);
    for (v, h) in [(0.0, 5.0), (7.0, 5.0), (5.0, 7.0), (f64::NAN, 5.0), (1e-9, 5.0), (-5.0, 5.0), (0.05, 0.05)] {
        assert!(photometry.resampled(v, h).is_err(), "{v} {h}");
    }
}

#[test]
fn messages_name_line_and_field() {
    let good = "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 3 1 1 2 0 0 0\n1 1 10\n0 45 90\n0\n10 9 8\n";
    parse(good);
    for (old, new, line, field) in [
        ("1 -1 1 3", "x -1 1 3", 3, "number of lamps"),
        ("1 -1 1 3", "1 -1 1 3.5", 3, "number of vertical angles"),
        ("1 1 2 0 0 0", "1 4 2 0 0 0", 3, "photometric type"),
        ("1 1 2 0 0 0", "1 1 3 0 0 0", 3, "units type"),
        ("1 1 10", "-1 1 10", 4, "ballast factor"),
        ("0 45 90", "0 45 45", 5, "vertical angles"),
        ("0 45 90", "0 45 190", 5, "vertical angles"),
        ("10 9 8", "10 inf 8", 7, "candela values"),
        ("10 9 8", "10 9", 7, "candela values"),
        ("10 9 8", "10 9 1e300", 7, "candela values"),
    ] {
        let error = Photometry::parse(good.replacen(old, new, 1).as_bytes(), ReadOptions::default()).unwrap_err();
        let start = format!("line {line}: `{field}");
        assert!(error.message().starts_with(&start), "{new}: {error}");
    }
}
