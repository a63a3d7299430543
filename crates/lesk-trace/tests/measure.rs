//! Measuring: closed forms, honest errors, the same bits for any number of threads.

use lesk_scene::Scene;
use lesk_trace::End;
use lesk_trace::measure::{Reading, SensorReadings, Settings, guth_position_index, measure};
use std::f64::consts::PI;
use std::ops::ControlFlow;
use std::time::Duration;

const HEAD: &str = "version = 1\ncamera = { eye = [0, -9, 9], target = [0, 0, 0] }\n";

fn scene(body: &str) -> Scene {
    Scene::parse(&format!("{HEAD}{body}"), ".").unwrap_or_else(|e| panic!("{e}"))
}

fn settings(scene: &Scene, error: f64) -> Settings {
    Settings { error, ..Settings::of(scene) }
}

fn readings(scene: &Scene, error: f64) -> Vec<SensorReadings> {
    let (found, end) = measure(scene, &settings(scene, error), |_| ControlFlow::Continue(()));
    assert_eq!(end, End::Done);
    found
}

/// A closed box that shines a little everywhere: pi Le / (1 - rho) at every point.
fn furnace(points: usize) -> Scene {
    let step = 1.8 / points as f64;
    scene(&format!(
        r#"
        [materials.grey]
        model = "lambert"
        reflectance = 0.5
        [[objects]]
        shape = "cube"
        edge = "2 m"
        material = "grey"
        light = {{ luminance = "100 cd/m2", two_sided = true }}
        [[sensors]]
        type = "grid"
        name = "inside"
        corner = [-0.9, -0.9, 0.3]
        u = [1.8, 0, 0]
        v = [0, 1.8, 0]
        spacing = "{step} m"
        "#
    ))
}

#[test]
fn point_light_gives_the_inverse_square_and_cosine_law_without_noise() {
    // 10 000 lm, 3 m high: the table of lights.md 6.2
    let expected = [88.4194, 75.4938, 50.9327, 31.2610, 19.0986, 12.0418];
    let sensor = |r| format!("[[sensors]]\ntype = \"point\"\nname = \"{r}\"\nposition = [{r}, 0, 0]\n");
    let sensors: String = (0..6).map(sensor).collect();
    let scene = scene(&format!("[[lights]]\ntype = \"point\"\nposition = [0, 0, 3]\nflux = \"10 klm\"\n{sensors}"));
    for (found, e) in readings(&scene, 0.01).iter().zip(expected) {
        let reading = found.readings[0];
        assert!((reading.value - e).abs() < 5e-5 + 1e-6 * e, "{} is not {e}", reading.value);
        assert_eq!((reading.standard_error, reading.indirect), (0.0, 0.0));
    }
}

#[test]
fn rectangle_gives_the_form_factor_within_its_error() {
    // 2 x 1 m, 1000 cd/m2, facing down at 3 m: the table of lights.md 6.2
    let body = r#"
        [[objects]]
        shape = "rectangle"
        width = "2 m"
        height = "1 m"
        transform = [{ rotate = "180 deg", axis = [1, 0, 0] }, { translate = [0, 0, 3] }]
        light = { luminance = "1000 cd/m2" }
        [[sensors]]
        type = "point"
        name = "floor"
        position = [2, 2, 0]
        [[sensors]]
        type = "point"
        name = "wall"
        position = [2, 0, 1]
        normal = [-1, 0, 0]
        "#;
    for (found, e) in readings(&scene(body), 0.001).iter().zip([63.4235, 120.3276]) {
        let Reading { value, standard_error, .. } = found.readings[0];
        assert!(standard_error <= 0.001 * value && (value - e).abs() < 4.0 * standard_error, "{value} is not {e}");
    }
}

#[test]
fn standard_errors_are_what_the_readings_scatter() {
    let expected = PI * 100.0 / 0.5;
    let found = readings(&furnace(16), 0.004).remove(0).readings;
    assert_eq!(found.len(), 256);
    let squares: Vec<f64> = found.iter().map(|r| ((r.value - expected) / r.standard_error).powi(2)).collect();
    let mean = squares.iter().sum::<f64>() / 256.0;
    // Student's t with 31 degrees of freedom has the variance 31/29; the mean of 256 squares scatters by 0.1. Stopping
    // as soon as the error is small enough favours readings whose error came out small: up to 1.6 instead of 1.07
    assert!((0.7..1.6).contains(&mean), "{mean}");
    assert!(squares.iter().all(|z2| *z2 < 25.0));
    assert!(found.iter().all(|r| r.standard_error <= 0.004 * r.value));
}

#[test]
fn readings_are_the_same_for_any_number_of_threads() {
    let scene = furnace(3);
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| readings(&scene, 0.02))
    };
    let one = with(1);
    assert_eq!(one, with(2));
    assert_eq!(one, with(5));
}

#[test]
fn stop_and_time_limit_keep_what_is_done() {
    let scene = furnace(8);
    let mut calls = 0;
    let (found, end) = measure(&scene, &settings(&scene, 1e-4), |progress| {
        assert!((0.0..=1.0).contains(&progress.done));
        calls += 1;
        if calls < 600 { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    });
    assert_eq!(end, End::Stopped);
    assert!(found[0].readings.iter().all(|r| r.samples > 0 && r.value > 0.0 && r.standard_error > 0.0));
    let limited = Settings { time: Some(Duration::ZERO), ..settings(&scene, 0.01) };
    let (found, end) = measure(&scene, &limited, |_| ControlFlow::Continue(()));
    assert_eq!(end, End::OutOfTime);
    assert!(found[0].readings.iter().all(|r| *r == Reading::default()));
}

#[test]
fn dark_readings_end_and_most_samples_are_a_limit() {
    let dark = scene("[[sensors]]\ntype = \"point\"\nname = \"dark\"\nposition = [0, 0, 0]\n");
    let reading = readings(&dark, 0.01)[0].readings[0];
    assert_eq!((reading.value, reading.standard_error), (0.0, 0.0));
    let scene = furnace(1);
    let limited = Settings { max_samples: 3200, ..settings(&scene, 1e-6) };
    let (found, end) = measure(&scene, &limited, |_| ControlFlow::Continue(()));
    assert_eq!((found[0].readings[0].samples, end), (3200, End::Done));
}

#[test]
fn ugr_of_a_disk_before_a_uniform_sky_is_the_formula() {
    // a disk of 0.1 m radius that faces the eye from 4 m, 1 m up and 0.5 m aside of the line of sight
    let (d, r, luminance, sky) = ([0.5, 4.0, 1.0], 0.1, 10_000.0, 60.0);
    let body = format!(
        r#"
        [environment]
        type = "sky"
        luminance = "{sky} cd/m2"
        [[objects]]
        shape = "disk"
        radius = "{r} m"
        transform = {{ look_at = {{ from = [{}, {}, {}], to = [0, 0, 0] }} }}
        light = {{ luminance = "{luminance} cd/m2" }}
        [[lights]]
        type = "point"
        position = [0, 3, 1]
        flux = "1 lm"
        [[sensors]]
        type = "glare"
        name = "eye"
        position = [0, 0, 0]
        direction = [0, 1, 0]
        "#,
        d[0], d[1], d[2]
    );
    let found = readings(&scene(&body), 0.01);
    let glare = found[0].glare.as_ref().expect("a glare sensor has a rating");
    let distance = f64::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    let solid_angle = 2.0 * PI * (1.0 - distance / (distance * distance + r * r).sqrt());
    let vector = |v: [f64; 3]| lesk_math::Vec3::from(v);
    let p = guth_position_index(vector(d), vector([0.0, 1.0, 0.0]), vector([0.0, 0.0, 1.0]));
    // the disk hides as much of the sky's illuminance as it covers
    let background = sky * (1.0 - solid_angle * d[1] / distance / PI);
    let expected = 8.0 * (0.25 / background * luminance * luminance * solid_angle / p / p).log10();
    // 4096 points on each light: some 1e-3 of the terms, 8 / ln 10 * 1e-3 = 0.003 of the rating
    assert!((glare.ugr.unwrap() - expected).abs() < 0.01, "{:?} is not {expected}", glare.ugr);
    assert_eq!((glare.sources.len(), glare.left_out), (1, 1));
    assert!((glare.sources[0].luminance / luminance - 1.0).abs() < 1e-4);
}
