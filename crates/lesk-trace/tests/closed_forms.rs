//! Pictures whose luminance is known in closed form (lights.md section 6 and textbook furnaces).

mod common;

use common::{Parts, camera, material, mean, settings};
use lesk_geometry::{Geometry, Transform};
use lesk_light::{Light, Point, Sky, Spot};
use lesk_math::{Color, vec3};
use std::f64::consts::PI;

const SIZE: [u32; 2] = [8, 8];

/// Within four standard errors, and within 0.2 % even where the error is tiny (f32 geometry, rectangle pixels).
fn assert_close(what: &str, (value, error): (f64, f64), expected: f64) {
    let allowed = 4.0 * error + 2e-3 * expected;
    assert!((value - expected).abs() <= allowed, "{what}: {value} +- {error}, expected {expected}");
}

#[test]
fn furnace_of_uniform_emission_and_reflectance_is_le_over_one_minus_rho() {
    for (rho, depth) in [(0.2, 32), (0.5, 64), (0.8, 400)] {
        let mut parts = Parts::new();
        // the camera is inside: a sphere turned inside out shines and scatters inwards
        let inward = Transform::scale(-2.0, 2.0, 2.0).unwrap();
        parts.add(
            Geometry::Mesh(lesk_geometry::cube().into()),
            inward,
            Some(material("lambert", &[("reflectance", rho)])),
            100.0,
        );
        let scene = parts.build(camera([0.1, 0.2, 0.3], [1.0, 0.5, 0.2], SIZE, 60.0), SIZE);
        assert_close(&format!("rho {rho}"), mean(&scene, &settings(256, depth)), 100.0 / (1.0 - f64::from(rho)));
    }
}

#[test]
fn white_object_in_a_white_sky_cannot_be_seen() {
    for id in ["lambert", "mirror", "dielectric"] {
        let mut parts = Parts::new();
        let white = if id == "dielectric" { material(id, &[]) } else { material(id, &[("reflectance", 1.0)]) };
        parts.add(Geometry::Sphere, Transform::IDENTITY, Some(white), 0.0);
        parts.lights.push(Light::Sky(Sky::new(Color::splat(50.0)).unwrap()));
        let scene = parts.build(camera([0.0, -5.0, 0.0], [0.0; 3], SIZE, 20.0), SIZE);
        assert_close(id, mean(&scene, &settings(64, 1000)), 50.0);
    }
}

/// A diffuse floor of albedo 0.5 seen from above: L = rho E / pi.
fn floor_luminance(light: impl FnOnce(&mut Parts), at: [f64; 2]) -> (f64, f64) {
    let mut parts = Parts::new();
    let floor = Transform::scale(50.0, 50.0, 1.0).unwrap();
    parts.add(Geometry::Rectangle, floor, Some(material("lambert", &[("reflectance", 0.5)])), 0.0);
    light(&mut parts);
    // from the side and far below the light, so that nothing stands between
    let from = [at[0] - 1.0, at[1] - 1.0, 1.0];
    let scene = parts.build(camera(from, [at[0], at[1], 0.0], SIZE, 0.05), SIZE);
    mean(&scene, &settings(128, 1))
}

#[test]
fn isotropic_point_over_a_floor_gives_the_inverse_square_and_cosine_law() {
    // 10 000 lm, 3 m high: the table of lights.md 6.2
    let expected = [88.4194, 75.4938, 50.9327, 31.2610, 19.0986, 12.0418];
    for (r, e) in expected.into_iter().enumerate() {
        let point = Point::from_flux(vec3(0.0, 0.0, 3.0), Color::splat(10_000.0)).unwrap();
        let found = floor_luminance(|parts| parts.lights.push(Light::Point(point)), [r as f64, 0.0]);
        assert_close(&format!("point at {r} m"), found, 0.5 * e / PI);
    }
}

#[test]
fn rectangle_over_a_floor_gives_the_form_factor() {
    // 2 x 1 m, 1000 cd/m2, facing down at 3 m: the table of lights.md 6.2
    for (x, y, e) in [
        (0.0, 0.0, 203.6260),
        (1.0, 0.0, 172.0659),
        (2.0, 0.0, 109.1303),
        (0.0, 1.0, 167.8287),
        (2.0, 2.0, 63.4235),
        (4.0, 0.0, 30.8028),
    ] {
        let found = floor_luminance(
            |parts| {
                let down = Transform::rotate(vec3(1.0, 0.0, 0.0), PI).unwrap();
                let place = Transform::translate(0.0, 0.0, 3.0) * down * Transform::scale(1.0, 0.5, 1.0).unwrap();
                parts.add(Geometry::Rectangle, place, None, 1000.0);
            },
            [x, y],
        );
        assert_close(&format!("rectangle at ({x}, {y})"), found, 0.5 * e / PI);
    }
}

#[test]
fn spot_concentrates_its_flux_into_the_cone() {
    // hard-cone spot of 1000 lm and 30 degrees half-angle: 1187.95 cd (lights.md 6.2), 2 m above the floor
    let spot = Spot::from_flux(
        vec3(0.0, 0.0, 2.0),
        vec3(0.0, 0.0, -1.0),
        Color::splat(1000.0),
        [30f64.to_radians(), 30f64.to_radians()],
    )
    .unwrap();
    let found = floor_luminance(|parts| parts.lights.push(Light::Spot(spot)), [0.0, 0.0]);
    assert_close("spot", found, 0.5 * 1187.95 / 4.0 / PI);
}

#[test]
fn sky_over_a_floor_gives_pi_l() {
    let found =
        floor_luminance(|parts| parts.lights.push(Light::Sky(Sky::new(Color::splat(1000.0)).unwrap())), [0.0, 0.0]);
    assert_close("sky", found, 0.5 * 1000.0);
}
