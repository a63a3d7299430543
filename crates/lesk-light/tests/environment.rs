//! Environment maps: density, orientation, photometry.

use lesk_image::{Image, Transfer};
use lesk_light::{Environment, Light, Lights, Receiver, Up};
use lesk_math::{Color, Vec3, vec3};
use proptest::prelude::*;
use std::f64::consts::PI;

fn map(width: u32, height: u32, pixel: impl FnMut(u32, u32) -> [f32; 3]) -> Image {
    Image::from_fn(width, height, Transfer::Linear, pixel).unwrap()
}

fn environment(image: Image) -> Environment {
    Environment::new(image, Color::WHITE, Up::Z, 0.0).unwrap()
}

/// Midpoint rule over the sphere: the value times the solid angle.
fn over_the_sphere(steps: usize, mut f: impl FnMut(Vec3<f32>) -> f64) -> f64 {
    let (nt, np) = (steps, 2 * steps);
    let mut sum = 0.0;
    for i in 0..nt {
        let theta = PI * (i as f64 + 0.5) / nt as f64;
        for j in 0..np {
            let phi = 2.0 * PI * (j as f64 + 0.5) / np as f64;
            let w = vec3(theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos());
            sum += f(w.map(|x| x as f32)) * theta.sin();
        }
    }
    sum * 2.0 * PI * PI / (nt * np) as f64
}

/// Uneven, with black parts and a sun.
fn uneven() -> Image {
    map(32, 16, |x, y| match (x, y) {
        (20, 3) => [5e4, 4e4, 3e4],
        (0..8, _) => [0.0; 3],
        _ => [(x % 5) as f32, (y % 3) as f32, 1.0],
    })
}

#[test]
fn density_integrates_to_one() {
    for rotation in [0.0, 1.0] {
        let light = Light::Environment(Environment::new(uneven(), Color::WHITE, Up::Z, rotation).unwrap());
        let at = Receiver::anywhere(Vec3::ZERO);
        let integral = over_the_sphere(640, |w| light.pdf_direction(&at, w).into());
        assert!((integral - 1.0).abs() < 2e-3, "{integral}"); // cells' edges at 640 x 1280 points
    }
}

#[test]
fn samples_agree_with_density_and_picture() {
    let lights = Lights::new(vec![Light::Environment(environment(uneven()))]).unwrap();
    let at = Receiver::anywhere(Vec3::ZERO);
    for i in 0..2000 {
        let u = [((i as f64 + 0.5) / 2000.0) as f32, (i as f64 * 0.618_033_988_749_895).fract() as f32];
        let Some(s) = lights.sample(&at, 0.5, u) else { continue };
        let (value, pdf) = lights.escaped(&at, s.wi).next().unwrap();
        // f32 directions: texels are 0.2 rad wide, and the sun is 1e4 times its neighbours
        assert!((pdf / s.pdf - 1.0).abs() < 1e-3, "{pdf} {}", s.pdf);
        assert!((value.luminance() / s.value.luminance() - 1.0).abs() < 1e-2, "{value:?} {:?}", s.value);
    }
}

#[test]
fn sampling_integrates_the_picture() {
    let environment = environment(uneven());
    let expected = over_the_sphere(640, |w| environment.radiance(w).luminance().into());
    let light = Light::Environment(environment);
    let (n, mut sum) = (256, 0.0);
    for i in 0..n * n {
        let u = [(i % n) as f32 + 0.5, (i / n) as f32 + 0.5].map(|v| v / n as f32);
        if let Some(s) = light.sample(0, &Receiver::anywhere(Vec3::ZERO), u) {
            sum += f64::from(s.value.luminance() / s.pdf) / (n * n) as f64;
        }
    }
    assert!((sum / expected - 1.0).abs() < 1e-2, "{sum} {expected}"); // both are midpoint rules over interpolated texels
}

#[test]
fn middle_looks_along_y_right_half_along_x_and_top_is_the_zenith() {
    // four columns of colours and a white cap
    let colors = [[9.0, 0.0, 0.0], [0.0, 9.0, 0.0], [0.0, 0.0, 9.0], [9.0, 9.0, 0.0]];
    let picture = || map(64, 32, |x, y| if y < 2 { [9.0; 3] } else { colors[x as usize / 16] });
    let e = environment(picture());
    // columns 16..48 are in the middle: left of +y green, right of it blue; then +x is the border of blue and yellow
    assert_eq!(e.radiance(vec3(-0.3, 0.9, 0.0).normalize()).0, [0.0, 9.0, 0.0]);
    assert_eq!(e.radiance(vec3(0.3, 0.9, 0.0).normalize()).0, [0.0, 0.0, 9.0]);
    assert_eq!(e.radiance(vec3(0.9, -0.3, 0.0).normalize()).0, [9.0, 9.0, 0.0]);
    assert_eq!(e.radiance(vec3(-0.9, -0.3, 0.0).normalize()).0, [9.0, 0.0, 0.0]);
    assert_eq!(e.radiance(Vec3::Z).0, [9.0; 3]);
    // a quarter turn counter-clockwise seen from above brings what was along +y to -x
    let turned = Environment::new(picture(), Color::WHITE, Up::Z, PI / 2.0).unwrap();
    assert_eq!(turned.radiance(vec3(-0.9, -0.3, 0.0).normalize()).0, [0.0, 9.0, 0.0]);
    // y up: the middle lies along -z
    let y_up = Environment::new(picture(), Color::WHITE, Up::Y, 0.0).unwrap();
    assert_eq!(y_up.radiance(vec3(0.3, 0.0, -0.9).normalize()).0, [0.0, 0.0, 9.0]);
    assert_eq!(y_up.radiance(vec3(0.0, 1.0, 0.0)).0, [9.0; 3]);
}

#[test]
fn even_map_gives_pi_times_its_luminance_and_scales_to_what_is_asked() {
    let e = environment(map(16, 8, |_, _| [100.0; 3]));
    assert!((e.illuminance() / (100.0 * PI) - 1.0).abs() < 1e-6);
    assert!((e.mean_luminance() / 100.0 - 1.0).abs() < 1e-6);
    let lit = e.clone().with_illuminance(12_000.0).unwrap();
    assert!((f64::from(lit.radiance(Vec3::Z).luminance()) / (12_000.0 / PI) - 1.0).abs() < 1e-6);
    let lit = e.with_luminance(5.0).unwrap();
    assert!((lit.radiance(Vec3::Z).luminance() - 5.0).abs() < 1e-5);
}

#[test]
fn traditional_overcast_sky_gives_seven_ninths_pi_of_its_zenith() {
    // (1 + 2 sin elevation)/3: E = 7π/9 of the zenith's luminance; a texel's mean is its middle value to 1/n²
    let n = 256;
    let sky = map(8, n, |_, y| {
        let elevation = PI * (0.5 - (f64::from(y) + 0.5) / f64::from(n));
        [if elevation > 0.0 { (1.0 + 2.0 * elevation.sin()) / 3.0 } else { 0.0 } as f32; 3]
    });
    assert!((environment(sky).illuminance() / (7.0 * PI / 9.0) - 1.0).abs() < 1e-4);
}

#[test]
fn black_and_broken_maps_are_refused_or_repaired() {
    let black = Environment::new(map(4, 2, |_, _| [0.0; 3]), Color::WHITE, Up::Z, 0.0);
    assert!(black.unwrap_err().to_string().contains("mean luminance of 0"));
    let broken = map(4, 2, |x, _| [[f32::NAN, -1.0, f32::INFINITY, 2.0][x as usize], 1.0, 1.0]);
    let e = environment(broken);
    assert_eq!(e.repaired(), 6);
    assert!(e.mean_luminance().is_finite());
    assert!(Environment::new(uneven(), Color::WHITE, Up::Z, f64::NAN).is_err());
    assert!(Environment::new(uneven(), Color::BLACK, Up::Z, 0.0).is_err());
    let below = map(4, 4, |_, y| [if y > 1 { 1.0 } else { 0.0 }; 3]);
    assert!(environment(below).with_illuminance(100.0).is_err());
}

proptest! {
    #[test]
    fn any_picture_gives_finite_samples(
        pixels in prop::collection::vec(any::<f32>(), 24), u in [0f32..1.0, 0f32..1.0], w in [-1f32..1.0, -1f32..1.0, -1f32..1.0],
    ) {
        let image = Image::new(4, 2, 3, Transfer::Linear, pixels).unwrap();
        let Ok(e) = Environment::new(image, Color::WHITE, Up::Z, 0.3) else { return Ok(()) };
        let light = Light::Environment(e);
        let at = Receiver::anywhere(Vec3::ZERO);
        if let Some(s) = light.sample(0, &at, u) {
            prop_assert!(s.pdf.is_finite() && s.value.0.iter().all(|v| v.is_finite()));
        }
        let w = Vec3::from(w).normalize();
        prop_assert!(light.pdf_direction(&at, w) >= 0.0);
    }
}
