//! Pictures on lights in scene files.

use lesk_geometry::Ray;
use lesk_image::{Image, Transfer, io};
use lesk_light::{Light, Receiver};
use lesk_math::{Color, Vec3, vec3};
use lesk_scene::Scene;
use std::f64::consts::PI;

/// White where the column and row of four by four texels say so, else black.
fn pictures() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, lit: fn(u32, u32) -> bool| {
        let image = Image::from_fn(4, 4, Transfer::Srgb, |x, y| [f32::from(u8::from(lit(x, y))); 3]).unwrap();
        io::write(folder.path().join(name), &image).unwrap();
    };
    write("checker.png", |x, y| (x + y) % 2 == 0);
    write("left.png", |x, _| x < 2);
    write("black.png", |_, _| false);
    let grey = Image::from_fn(1, 1, Transfer::Srgb, |_, _| [0.5; 3]).unwrap();
    io::write(folder.path().join("grey.png"), &grey).unwrap();
    folder
}

fn scene(shape: &str, light: &str) -> Result<Scene, String> {
    let folder = pictures();
    let text = format!(
        "version = 1\ncamera = {{ eye = [0, -3, 1], target = [0, 0, 1] }}\n[[objects]]\n{shape}\nlight = {{ {light} }}\n"
    );
    Scene::parse(&text, folder.path()).map_err(|e| e.to_string())
}

fn light(scene: &Scene) -> &lesk_light::Area {
    match scene.lights.list() {
        [Light::Area(area)] => area,
        other => panic!("{} lights", other.len()),
    }
}

const NEAREST: &str = "interpolation = \"nearest\"";
/// Shapes with their areas in m².
const SHAPES: [(&str, f64); 6] = [
    ("shape = \"rectangle\"\nwidth = \"2 m\"\nheight = \"1 m\"", 2.0),
    ("shape = \"disk\"\nradius = \"0.5 m\"", 0.25 * PI),
    ("shape = \"sphere\"\nradius = \"0.5 m\"", PI),
    ("shape = \"cylinder\"\nradius = \"0.5 m\"\nheight = \"2 m\"", 2.5 * PI),
    ("shape = \"cylinder\"\nradius = \"0.5 m\"\nheight = \"2 m\"\ncapped = false", 2.0 * PI),
    ("shape = \"cube\"\nsize = [2, 1, 0.5]", 7.0),
];

#[test]
fn a_checker_halves_the_flux_of_a_luminance_and_keeps_a_stated_flux() {
    for (shape, area) in SHAPES {
        for (two_sided, sides) in [(false, 1.0), (true, 2.0)] {
            let texture = format!("two_sided = {two_sided}, texture = {{ file = \"checker.png\", {NEAREST} }}");
            let by_luminance = scene(shape, &format!("luminance = \"100 cd/m2\", {texture}")).unwrap();
            // π L A, of which the checker leaves half; 5e-3: small triangles of a cube that edges of texels cut
            let expected = 0.5 * PI * 100.0 * area * sides;
            let flux = f64::from(light(&by_luminance).flux());
            assert!((flux / expected - 1.0).abs() < 5e-3, "{shape}: {flux} {expected}");
            let by_flux = scene(shape, &format!("flux = \"800 lm\", {texture}")).unwrap();
            assert!((light(&by_flux).flux() / 800.0 - 1.0).abs() < 1e-5);
            // all of it comes from the white half
            let white = f64::from(light(&by_flux).luminance().luminance());
            assert!((white * 0.5 * PI * area * sides / 800.0 - 1.0).abs() < 5e-3, "{shape}: {white}");
        }
    }
}

#[test]
fn an_encoded_grey_is_as_bright_as_its_colour_space_says() {
    let flux = |space: &str| {
        let texture = format!("luminance = \"100 cd/m2\", texture = {{ file = \"grey.png\"{space} }}");
        light(&scene("shape = \"rectangle\"", &texture).unwrap()).flux()
    };
    // 0.5 is stored as 128/255; IEC 61966-2-1: ((0.50196 + 0.055) / 1.055)^2.4 = 0.215861
    assert!((flux("") / (PI as f32 * 100.0 * 0.215_861) - 1.0).abs() < 1e-4, "{}", flux(""));
    let linear = flux(", color_space = \"linear\"");
    assert!((linear / (PI as f32 * 100.0 * 128.0 / 255.0) - 1.0).abs() < 1e-4, "{linear}");
}

/// Evenly spread numbers that choose the triangle and the point: Roberts' sequence R3, whose base solves x⁴ = x + 1.
fn numbers(count: u32) -> impl Iterator<Item = (f32, [f32; 2])> {
    let base = 1.220_744_084_605_759_5f64;
    (0..count).map(move |i| {
        let [a, b, c] = [1, 2, 3].map(|k| ((f64::from(i) + 0.5) * base.powi(-k)).fract() as f32);
        (a, [b, c])
    })
}

const ASKED: u32 = 1 << 17;

/// Illuminance at a receiver by asking the light.
fn asked(scene: &Scene, at: &Receiver) -> f64 {
    let mut sum = 0.0;
    for (pick, u) in numbers(ASKED) {
        let Some(s) = scene.lights.sample(at, pick, u) else { continue };
        let cosine = at.n.map_or(0.0, |n| n.dot(s.wi)).max(0.0);
        sum += f64::from(s.value.luminance() * cosine / s.pdf);
    }
    sum / f64::from(ASKED)
}

/// Howell B-3: form factor of an element under the corner of a parallel rectangle a x b at distance 1.
fn corner(a: f64, b: f64) -> f64 {
    let part = |a: f64, b: f64| a / (1.0 + a * a).sqrt() * (b / (1.0 + a * a).sqrt()).atan();
    (part(a, b) + part(b, a)) / (2.0 * PI)
}

#[test]
fn a_half_lit_rectangle_gives_the_illuminance_of_its_half() {
    let lamp = format!("luminance = \"100 cd/m2\", texture = {{ file = \"left.png\", {NEAREST} }}");
    let scene = scene(SHAPES[0].0, &lamp).unwrap();
    for (x, expected) in [
        // under the middle, half of all four corners; under the lit edge, two of 1 x 0.5; under the dark one, what is left
        (0.0, 2.0 * corner(1.0, 0.5)),
        (-1.0, 2.0 * corner(1.0, 0.5)),
        (1.0, 2.0 * (corner(2.0, 0.5) - corner(1.0, 0.5))),
    ] {
        let at = Receiver::opaque(vec3(x, 0.0, 1.0), vec3(0.0, 0.0, -1.0));
        let expected = PI * 100.0 * expected;
        let got = asked(&scene, &at);
        assert!((got / expected - 1.0).abs() < 2e-3, "{x}: {got} {expected}");
    }
    // the back of a one-sided light is dark
    let behind = Receiver::opaque(vec3(0.0, 0.0, -1.0), Vec3::Z);
    assert_eq!(asked(&scene, &behind), 0.0);
}

#[test]
fn a_two_sided_half_shines_to_both_sides() {
    let lamp = format!("luminance = \"100 cd/m2\", two_sided = true, texture = {{ file = \"left.png\", {NEAREST} }}");
    let scene = scene(SHAPES[0].0, &lamp).unwrap();
    let expected = PI * 100.0 * 2.0 * corner(1.0, 0.5);
    for z in [1.0f32, -1.0] {
        let got = asked(&scene, &Receiver::opaque(vec3(0.0, 0.0, z), vec3(0.0, 0.0, -z)));
        assert!((got / expected - 1.0).abs() < 2e-3, "{z}: {got} {expected}");
    }
}

#[test]
fn shapes_with_a_picture_give_what_rays_to_them_find() {
    // E = ∫ L cos dω over the hemisphere of the receiver, by rays in a grid of projected solid angle
    let at = Receiver::opaque(vec3(0.9, -1.1, -1.2), vec3(-0.4, 0.5, 0.75).normalize());
    let frame = lesk_math::Frame::from_normal(at.n.unwrap());
    for (shape, _) in SHAPES {
        for file in ["left.png", "checker.png"] {
            let lamp =
                format!("luminance = \"100 cd/m2\", two_sided = true, texture = {{ file = \"{file}\", {NEAREST} }}");
            let scene = scene(shape, &lamp).unwrap();
            let n = 1000;
            let mut sum = 0.0;
            for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
                let (x, y) = ((f64::from(i) + 0.5) / 500.0 - 1.0, (f64::from(j) + 0.5) / 500.0 - 1.0);
                let z = 1.0 - x * x - y * y;
                if z <= 0.0 {
                    continue;
                }
                let wi = frame.world_from_local(vec3(x as f32, y as f32, z.sqrt() as f32));
                let ray = Ray::new(at.p, wi);
                if let Some(hit) = scene.world.intersect(&ray) {
                    let surface = scene.world.surface(&ray, &hit);
                    sum += f64::from(scene.lights.emitted(0, &surface, -wi).luminance());
                }
            }
            let expected = sum * 4.0 / f64::from(n * n);
            // asking the light knows no shadow: bodies hide part of themselves
            let got = unhidden(&scene, &at);
            assert!((got / expected - 1.0).abs() < 1e-2, "{shape} {file}: {got} {expected}");
        }
    }
}

/// As [`asked`], with shadow rays; every density must be the one that a ray to the point finds.
fn unhidden(scene: &Scene, at: &Receiver) -> f64 {
    let from = lesk_geometry::Surface::at(at.p, at.n.unwrap());
    let mut sum = 0.0;
    for (i, (pick, u)) in numbers(ASKED).enumerate() {
        let Some(s) = scene.lights.sample(at, pick, u) else { continue };
        if scene.world.occluded(&s.shadow_ray(&from)) {
            continue;
        }
        sum += f64::from(s.value.luminance() * at.n.unwrap().dot(s.wi).max(0.0) / s.pdf);
        if i % 32 == 0 {
            let ray = Ray::new(at.p, s.wi);
            // a ray along a silhouette may miss
            let Some(hit) = scene.world.intersect(&ray) else { continue };
            let surface = scene.world.surface(&ray, &hit);
            let value = scene.lights.emitted(0, &surface, -s.wi);
            // at grazing angles the density follows the last digits of the point
            if value != Color::BLACK && surface.ng.dot(s.wi).abs() > 0.05 {
                let pdf = scene.lights.pdf_surface(at, 0, &surface);
                // a point beside an edge of a texel or of a triangle may be found beyond it
                let beside = (pdf / s.pdf - 1.0).abs() > 2e-3;
                assert!(!beside || near_an_edge(&surface), "{pdf} {} at {:?}", s.pdf, surface.uv);
            }
        }
    }
    sum / f64::from(ASKED)
}

fn near_an_edge(surface: &lesk_geometry::Surface) -> bool {
    let [u, v] = surface.uv;
    [u, v, u - v].iter().any(|x| (64.0 * x - (64.0 * x).round()).abs() < 0.1)
}

#[test]
fn mistakes_are_told() {
    for (light, message) in [
        ("luminance = \"1 cd/m2\", texture = {}", "has no `file`"),
        ("luminance = \"1 cd/m2\", texture = { file = \"none.png\" }", "none.png"),
        ("luminance = \"1 cd/m2\", texture = { file = \"black.png\" }", "the picture on the light is black"),
        ("flux = \"1 lm\", texture = { file = \"black.png\" }", "the picture on the light is black"),
        ("flux = \"1 lm\", texture = { file = \"grey.png\", role = \"data\" }", "unknown key `role` in light texture"),
        ("flux = \"1 lm\", texture = \"grey.png\"", "`texture` is \"grey.png\", a table is accepted"),
    ] {
        let error = scene("shape = \"sphere\"", light).err().unwrap_or_else(|| panic!("accepted: {light}"));
        assert!(error.contains(message), "{light}: {error}");
    }
}
