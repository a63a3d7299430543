//! Illuminance by integrating with the sampling routines, against closed forms.

use lesk_geometry::{Geometry, Transform};
use lesk_light::{Area, Directional, Light, Lights, Point, Receiver, Sky, Spectrum, Spot};
use lesk_math::{Color, Vec3, vec3};
use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::Arc;

const WHITE: Color<f32> = Color::WHITE;

/// Illuminance in lx of a surface with normal `n` at `p`: the midpoint rule over the numbers that choose the direction.
fn illuminance(light: &Light, p: Vec3<f32>, n: Vec3<f32>, steps: usize) -> f64 {
    let lights = Lights::new(vec![light.clone()]).unwrap();
    let at = Receiver::opaque(p, n);
    let mut sum = 0.0;
    for i in 0..steps * steps {
        let u = [(i % steps) as f32 + 0.5, (i / steps) as f32 + 0.5].map(|v| v / steps as f32);
        // the light number matters for lights of several parts only: golden-ratio steps cover it evenly
        let choice = (i as f64 * 0.618_033_988_749_895).fract() as f32;
        if let Some(s) = lights.sample(&at, choice, u) {
            sum += f64::from(s.value.luminance() * s.wi.dot(n).max(0.0) / s.pdf);
        }
    }
    sum / (steps * steps) as f64
}

fn facing_down(height: f64) -> Transform {
    Transform::translate(0.0, 0.0, height) * Transform::rotate_x(PI)
}

fn close(got: f64, expected: f64, relative: f64) {
    assert!((got / expected - 1.0).abs() <= relative, "{got} is not {expected}");
}

#[test]
fn led_of_1100_lm_gives_38_9045_lx_at_1_5_m() {
    let lamp = Light::Point(Point::from_flux(vec3(0.0, 0.0, 1.5), WHITE * 1100.0).unwrap());
    close(illuminance(&lamp, Vec3::ZERO, Vec3::Z, 1), 38.9045, 2e-6);
    close(lamp.flux(1.0).into(), 1100.0, 1e-6);
}

#[test]
fn isotropic_10_000_lm_at_3_m_give_the_tabulated_illuminances() {
    // E = Φ h / (4π (h² + r²)^1.5)
    let lamp = Light::Point(Point::from_flux(vec3(0.0, 0.0, 3.0), WHITE * 10_000.0).unwrap());
    for (r, lx) in [88.4194, 75.4938, 50.9327, 31.2610, 19.0986, 12.0418].into_iter().enumerate() {
        let got = illuminance(&lamp, vec3(r as f32, 0.0, 0.0), Vec3::Z, 1);
        assert!((got - lx).abs() < 5e-5 + 1e-6 * lx, "{got} is not {lx}"); // printed digits and f32
    }
}

#[test]
fn hard_cones_of_1000_lm_have_the_tabulated_intensities() {
    for (deg, cd) in [(15.0f64, 4670.84), (30.0, 1187.95), (45.0, 543.39), (60.0, 318.31)] {
        let angles = [deg.to_radians(); 2];
        let spot = Spot::from_flux(vec3(0.0, 0.0, 2.0), vec3(0.0, 0.0, -1.0), WHITE * 1000.0, angles).unwrap();
        close(spot.intensity().luminance().into(), cd, 2e-5);
        close(illuminance(&Light::Spot(spot), Vec3::ZERO, Vec3::Z, 1), cd / 4.0, 2e-5);
    }
}

#[test]
fn flux_of_a_soft_spot_through_a_plane_is_its_flux() {
    // ∫ E dA over the plane below, in rings of equal width in the cosine
    let (inner, outer) = (20f64.to_radians(), 35f64.to_radians());
    let spot = Spot::from_flux(vec3(0.0, 0.0, 1.0), vec3(0.0, 0.0, -1.0), WHITE * 250.0, [inner, outer]).unwrap();
    let (light, n) = (Light::Spot(spot), 4000);
    let mut flux = 0.0;
    for i in 0..n {
        let r = outer.tan() * (i as f64 + 0.5) / n as f64;
        let e = illuminance(&light, vec3(r as f32, 0.0, 0.0), Vec3::Z, 1);
        flux += e * 2.0 * PI * r * outer.tan() / n as f64;
    }
    close(flux, 250.0, 1e-5); // midpoint rule with 4000 steps, f32 values
}

#[test]
fn parallel_light_is_stated_by_its_perpendicular_illuminance() {
    let sun = Light::Directional(Directional::new(vec3(3.0, 0.0, -4.0), WHITE * 1000.0).unwrap());
    close(illuminance(&sun, Vec3::ZERO, Vec3::Z, 1), 800.0, 1e-6);
}

#[test]
fn rectangle_of_1000_nit_gives_the_tabulated_illuminances() {
    let place = facing_down(3.0) * Transform::scale(1.0, 0.5, 1.0).unwrap();
    let lamp = Light::Area(Area::new(&Geometry::Rectangle, &place, WHITE * 1000.0, false).unwrap());
    let table = [
        ((0.0, 0.0), 203.6260),
        ((1.0, 0.0), 172.0659),
        ((2.0, 0.0), 109.1303),
        ((0.0, 1.0), 167.8287),
        ((0.0, 2.0), 102.3892),
        ((1.0, 1.0), 143.5404),
        ((2.0, 2.0), 63.4235),
        ((4.0, 0.0), 30.8028),
    ];
    for ((x, y), lx) in table {
        close(illuminance(&lamp, vec3(x, y, 0.0), Vec3::Z, 64), lx, 2e-5); // midpoint rule, 64 x 64
    }
    close(illuminance(&lamp, vec3(2.0, 0.0, 1.0), vec3(-1.0, 0.0, 0.0), 64), 120.3276, 2e-5);
    assert_eq!(illuminance(&lamp, vec3(0.0, 0.0, 4.0), vec3(0.0, 0.0, -1.0), 8), 0.0, "dark on its back");
}

#[test]
fn mesh_of_two_triangles_gives_what_the_rectangle_does() {
    let place = facing_down(3.0) * Transform::scale(1.0, 0.5, 1.0).unwrap();
    let mesh = Geometry::Mesh(Arc::new(lesk_geometry::rectangle()));
    let lamp = Light::Area(Area::new(&mesh, &place, WHITE * 1000.0, false).unwrap());
    for ((x, y), lx) in [((0.0, 0.0), 203.6260), ((1.0, 1.0), 143.5404), ((4.0, 0.0), 30.8028)] {
        close(illuminance(&lamp, vec3(x, y, 0.0), Vec3::Z, 64), lx, 2e-5); // midpoint rule, 64 x 64
    }
}

#[test]
fn rectangles_near_and_far_are_seen_under_their_solid_angle() {
    // from the axis 4 asin(sin(a) sin(b)) with the half angles a and b of the sides; the mean of 1/pdf is the solid angle
    let scale = Transform::scale(1.0, 0.5, 1.0).unwrap();
    for height in [0.02, 0.1, 0.5, 2.0, 3.7, 4.2, 20.0] {
        let light = Light::Area(Area::new(&Geometry::Rectangle, &(facing_down(height) * scale), WHITE, false).unwrap());
        let at = Receiver::opaque(Vec3::ZERO, Vec3::Z);
        let n = 128;
        let of = |i: usize| {
            let u = [i % n, i / n].map(|k| (k as f32 + 0.5) / n as f32);
            light.sample(0, &at, u).map_or(0.0, |s| 1.0 / f64::from(s.pdf))
        };
        let got = (0..n * n).map(of).sum::<f64>() / (n * n) as f64;
        let half = |x: f64| x / x.hypot(height);
        close(got, 4.0 * (half(1.0) * half(0.5)).asin(), 2e-5); // midpoint rule, 128 x 128, f32
    }
}

#[test]
fn disk_of_5000_nit_gives_the_tabulated_illuminances() {
    let place = facing_down(2.0) * Transform::scale(0.5, 0.5, 0.5).unwrap();
    let lamp = Light::Area(Area::new(&Geometry::Disk, &place, WHITE * 5000.0, false).unwrap());
    for (a, lx) in [(0.0, 923.9978), (0.5, 829.1669), (1.0, 615.4743), (2.0, 249.1493)] {
        close(illuminance(&lamp, vec3(a, 0.0, 0.0), Vec3::Z, 64), lx, 1e-4); // midpoint rule, 64 x 64, over the area
    }
}

#[test]
fn sphere_of_1000_nit_is_a_point_source_from_outside() {
    let place = Transform::translate(0.0, 0.0, 2.0) * Transform::scale(0.25, 0.25, 0.25).unwrap();
    let lamp = Light::Area(Area::new(&Geometry::Sphere, &place, WHITE * 1000.0, false).unwrap());
    close(illuminance(&lamp, Vec3::ZERO, Vec3::Z, 64), 49.0874, 1e-5);
}

#[test]
fn cube_of_triangles_gives_the_sum_of_the_faces_that_are_seen() {
    // from straight below, one face of 0.4 m at 1.8 m: four corner rectangles of 0.2 x 0.2 (Howell C-1)
    let place = Transform::translate(0.0, 0.0, 2.0) * Transform::scale(0.2, 0.2, 0.2).unwrap();
    let lamp = Light::Area(Area::new(&Geometry::cube(), &place, WHITE * 1000.0, false).unwrap());
    let a: f64 = 0.2 / 1.8;
    let root = (1.0 + a * a).sqrt();
    let corner = 2.0 * a / root * (a / root).atan() / (2.0 * PI);
    close(illuminance(&lamp, Vec3::ZERO, Vec3::Z, 128), 4.0 * corner * PI * 1000.0, 1e-3); // six faces chosen by quasi-random numbers
}

#[test]
fn every_area_light_states_its_flux() {
    let scale = Transform::scale(0.3, 0.3, 0.3).unwrap();
    let shapes =
        [Geometry::Rectangle, Geometry::Disk, Geometry::Sphere, Geometry::cube(), Geometry::Cylinder { capped: true }];
    for shape in shapes {
        for two_sided in [false, true] {
            let light = Area::from_flux(&shape, &scale, WHITE * 1100.0, two_sided).unwrap();
            close(light.flux().into(), 1100.0, 1e-5);
        }
    }
    let sphere = Area::from_flux(&Geometry::Sphere, &scale, WHITE * 100.0, false).unwrap();
    close(sphere.luminance().luminance().into(), 100.0 / (4.0 * PI * PI * 0.09), 1e-5);
}

#[test]
fn uniform_sky_gives_pi_times_its_luminance() {
    for sky in [Sky::new(WHITE * 100.0).unwrap(), Sky::dome(WHITE * 100.0, Vec3::Z).unwrap()] {
        close(illuminance(&Light::Sky(sky), Vec3::ZERO, Vec3::Z, 16), PI * 100.0, 1e-5);
    }
    // a wall sees half of the dome
    let dome = Light::Sky(Sky::dome(WHITE * 100.0, Vec3::Z).unwrap());
    close(illuminance(&dome, Vec3::ZERO, vec3(1.0, 0.0, 0.0), 256), FRAC_PI_2 * 100.0, 4e-3); // edge at 256 steps
}

#[test]
fn efficacies_of_named_spectra_are_those_printed() {
    // colour-science 0.4.7 tables: illuminants over 380 to 780 nm, black bodies over the whole spectrum
    for (name, lm_per_w, digit) in [
        ("E", 182.46, 0.005),
        ("A", 156.20, 0.005),
        ("D50", 207.70, 0.005),
        ("D65", 205.15, 0.005),
        ("FL2", 336.73, 0.005),
        ("LED-B3", 316.88, 0.005),
        ("blackbody 2856 K", 16.446, 5e-4),
        ("blackbody 6500 K", 95.36, 5e-3),
    ] {
        let got = Spectrum::parse(name).unwrap().efficacy();
        assert!((got - lm_per_w).abs() <= digit, "{name}: {got}");
        assert_eq!(Spectrum::parse(name).unwrap().to_string(), name);
    }
}

#[test]
fn colours_of_spectra_have_luminance_one_and_d65_is_white() {
    for name in ["E", "A", "D50", "D65", "FL2", "HP1", "blackbody 2700 K", "blackbody 1000 K"] {
        let rgb = Spectrum::parse(name).unwrap().rgb();
        assert!((lesk_quantities::colorspace::luminance(rgb) - 1.0).abs() < 1e-12, "{name}");
        assert!(rgb.iter().all(|c| *c >= 0.0));
    }
    // illuminant A is a black body of 2856 K up to the rounding of its chromaticity to five digits
    let (a, b) = (Spectrum::A.rgb(), Spectrum::Blackbody(2855.54).rgb());
    (0..3).for_each(|c| assert!((a[c] - b[c]).abs() < 2e-3, "{a:?} {b:?}"));
    assert_eq!(Spectrum::D65.rgb(), [1.0; 3]);
}

#[test]
fn lights_that_cannot_shine_are_refused() {
    let up = Vec3::<f32>::Z;
    for bad in [0.0, -1.0, f32::NAN, f32::INFINITY] {
        assert!(Point::new(up, WHITE * bad).is_err());
        assert!(Spot::from_flux(up, up, WHITE * bad, [0.1, 0.2]).is_err());
        assert!(Directional::new(up, WHITE * bad).is_err());
        assert!(Area::new(&Geometry::Sphere, &Transform::IDENTITY, WHITE * bad, false).is_err());
        assert!(Sky::new(WHITE * bad).is_err());
    }
    assert!(Directional::new(Vec3::ZERO, WHITE).is_err());
    for angles in [[0.3, 0.2], [0.0, 0.0], [-0.1, 0.2], [0.1, 4.0], [f64::NAN, 0.2]] {
        assert!(Spot::new(up, up, WHITE, angles).is_err(), "{angles:?}");
    }
    for text in ["", "D66", "blackbody", "blackbody 2700", "blackbody 10 K", "blackbody 5 m"] {
        assert!(Spectrum::parse(text).is_err(), "{text}");
    }
}
