//! Environment maps of scene files, calibrated and turned, against closed forms.

use lesk_image::{Image, Transfer, io};
use lesk_light::{Light, Receiver};
use lesk_math::{Vec3, vec3};
use lesk_scene::Scene;
use std::f64::consts::PI;

const ROWS: u32 = 256;

/// Latitude-longitude maps: the same everywhere, the cosine from the zenith, white in the right half.
fn scene(file: &str, rest: &str) -> Result<Scene, String> {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, value: fn(f64, u32) -> f64| {
        let texel = |x: u32, y: u32| [value(PI * (f64::from(y) + 0.5) / f64::from(ROWS), x) as f32; 3];
        let image = Image::from_fn(2 * ROWS, ROWS, Transfer::Linear, texel).unwrap();
        io::write(folder.path().join(name), &image).unwrap();
    };
    write("uniform.exr", |_, _| 3.0);
    write("cosine.exr", |theta, _| theta.cos().max(0.0));
    write("half.exr", |_, x| if x >= ROWS { 1.0 } else { 0.0 });
    write("below.exr", |theta, _| if theta > 0.5 * PI { 1.0 } else { 0.0 });
    let text = format!(
        "version = 1\ncamera = {{ eye = [0, -3, 1], target = [0, 0, 1] }}\n[environment]\ntype = \"map\"\n\
         file = \"{file}.exr\"\n{rest}\n"
    );
    Scene::parse(&text, folder.path()).map_err(|e| e.to_string())
}

/// Illuminance of a plane, by asking the light for directions: Roberts' sequence R2, whose base solves x³ = x + 1.
fn illuminance(scene: &Scene, n: Vec3<f32>) -> f64 {
    let at = Receiver::opaque(Vec3::ZERO, n);
    let base = 1.324_717_957_244_746f64;
    let count = 1 << 17;
    let mut sum = 0.0;
    for i in 0..count {
        let u = [1, 2].map(|k| ((f64::from(i) + 0.5) * base.powi(-k)).fract() as f32);
        if let Some(s) = scene.lights.sample(&at, 0.5, u) {
            sum += f64::from(s.value.luminance() * s.wi.dot(n).max(0.0) / s.pdf);
        }
    }
    sum / f64::from(count)
}

fn close(got: f64, expected: f64, what: &str) {
    // 2e-3 of what the whole map gives: texels of 0.7 degrees, 131,072 points
    assert!((got - expected).abs() <= 2e-3 * expected.max(10.0), "{what}: {got} is not {expected}");
}

const UP: Vec3<f32> = Vec3 { x: 0.0, y: 0.0, z: 1.0 };
const SIDE: Vec3<f32> = Vec3 { x: 1.0, y: 0.0, z: 0.0 };

#[test]
fn a_uniform_map_has_the_luminance_that_its_calibration_says() {
    // E = π L on every plane
    for (rest, luminance) in [
        ("illuminance = \"1000 lx\"", 1000.0 / PI),
        ("luminance = \"200 cd/m2\"", 200.0),
        ("scale = 50", 150.0),
        ("", 3.0),
    ] {
        let scene = scene("uniform", rest).unwrap();
        for n in [UP, SIDE, vec3(0.0, 0.6, -0.8)] {
            close(illuminance(&scene, n), PI * luminance, rest);
        }
        let [Light::Environment(map)] = scene.lights.list() else { panic!() };
        close(map.mean_luminance(), luminance, rest);
    }
}

#[test]
fn a_cosine_map_has_two_thirds_pi_of_its_zenith() {
    // L = Lz cos θ above the horizon: the mean over all directions is Lz / 4, on a horizontal plane E = 2π/3 Lz, on a
    // vertical one 2/3 Lz
    for (rest, zenith) in [("luminance = \"100 cd/m2\"", 400.0), ("illuminance = \"1000 lx\"", 1500.0 / PI)] {
        let scene = scene("cosine", rest).unwrap();
        close(illuminance(&scene, UP), 2.0 * PI / 3.0 * zenith, rest);
        close(illuminance(&scene, SIDE), 2.0 / 3.0 * zenith, rest);
        close(f64::from(scene.lights.background(UP).luminance()), zenith, rest);
    }
}

#[test]
fn a_turned_half_white_map_shines_from_where_it_was_turned_to() {
    // the right half is the half space of +x, which a rotation turns counter-clockwise seen from above; a half space of
    // luminance L at the angle β to the normal of a plane gives E = π L (1 + cos β) / 2
    for (degrees, up) in [(0.0f64, "z"), (30.0, "z"), (90.0, "z"), (215.0, "z"), (-60.0, "z"), (30.0, "y")] {
        let rest = format!("rotation = \"{degrees} deg\"\nluminance = \"100 cd/m2\"\nup = \"{up}\"");
        let scene = scene("half", &rest).unwrap();
        // counter-clockwise from +x: with z up toward +y, with y up toward -z
        let turn = degrees.to_radians();
        let lit = if up == "z" { vec3(turn.cos(), turn.sin(), 0.0) } else { vec3(turn.cos(), 0.0, -turn.sin()) };
        for n in [SIDE, vec3(0.0, 1.0, 0.0), UP, vec3(-0.6, 0.8, 0.0)] {
            // the mean of 100 over all directions is 200 in the white half
            let expected = PI * 200.0 * (1.0 + lit.dot(n.map(f64::from))) / 2.0;
            close(illuminance(&scene, n), expected, &format!("{rest} {n:?}"));
        }
    }
}

#[test]
fn a_rotation_keeps_the_calibration() {
    for rest in ["illuminance = \"700 lx\"", "luminance = \"80 cd/m2\""] {
        let of = |rotation: &str| {
            let scene = scene("half", &format!("{rest}\nrotation = \"{rotation}\"")).unwrap();
            illuminance(&scene, UP)
        };
        // half of the upper half is lit: E = π L / 2, and the mean is L / 2
        let expected = if rest.starts_with('i') { 700.0 } else { 80.0 * PI };
        close(of("0 deg"), expected, rest);
        close(of("77 deg"), expected, rest);
    }
}

#[test]
fn mistakes_are_told() {
    for (file, rest, message) in [
        ("below", "illuminance = \"10 lx\"", "black above the horizon"),
        ("uniform", "illuminance = \"10 lx\"\nscale = 2", "both there"),
        ("uniform", "illuminance = \"10 cd/m2\"", "illuminance"),
        ("uniform", "luminance = \"-10 cd/m2\"", "luminance"),
        ("none", "", "none.exr"),
    ] {
        let error = scene(file, rest).err().unwrap_or_else(|| panic!("accepted: {rest}"));
        assert!(error.contains(message), "{rest}: {error}");
    }
}
