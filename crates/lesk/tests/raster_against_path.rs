//! Phong shading against the path tracer: two engines, one direct term.

use lesk::math::sobol::Sampler;
use lesk::raster::{Frame, Interpolation, Raster, Settings};
use lesk::scene::{Scene, ShadowTerminator};
use std::sync::Arc;

const SIZE: [u32; 2] = [160, 120];

fn scene(model: &str, object: &str) -> Scene {
    let text = format!(
        r#"
version = 1
[camera]
eye = [0.9, -3.1, 1.2]
target = [0, 0, 0]
fov = "40 deg"
[film]
size = [{}, {}]
[render]
max_depth = 1
spp = 1
[materials.m]
{model}
[[objects]]
material = "m"
{object}
[[lights]]
type = "point"
position = [-1.5, -3, 2.5]
intensity = "900 cd"
"#,
        SIZE[0], SIZE[1]
    );
    Scene::parse(&text, ".").unwrap_or_else(|e| panic!("{e}"))
}

/// Both pictures, and the face that each pixel shows (0: none).
fn both(scene: &Scene, settings: &Settings) -> (Frame, Vec<[f32; 3]>, Vec<u32>) {
    let mut raster = Raster::new(Arc::new(scene.clone()), settings).unwrap();
    let frame = raster.frame();
    let mut traced = Scene { world: raster.world().unwrap(), ..scene.clone() };
    traced.render.shadow_terminator = settings.shadow_terminator.unwrap_or(scene.render.shadow_terminator);
    let mut sampler = Sampler::new(1);
    let (mut light, mut faces) = (Vec::new(), Vec::new());
    for (x, y) in (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| (x, y))) {
        let ray = traced.camera.ray([x as f32 + 0.5, y as f32 + 0.5], [0.5; 2]);
        sampler.start(y * SIZE[0] + x, 0);
        light.push(lesk::trace::radiance(&traced, &traced.render, ray, sampler));
        faces.push(traced.world.intersect(&ray).map_or(0, |hit| 1 + hit.prim + (hit.instance << 24)));
    }
    (frame, light, faces)
}

/// Pixels whose eight neighbours show the same face.
fn inner(faces: &[u32]) -> Vec<usize> {
    let (w, h) = (SIZE[0] as usize, SIZE[1] as usize);
    let all = (1..h - 1).flat_map(|y| (1..w - 1).map(move |x| y * w + x));
    all.filter(|&k| {
        let around = [k - w - 1, k - w, k - w + 1, k - 1, k + 1, k + w - 1, k + w, k + w + 1];
        faces[k] != 0 && around.iter().all(|&n| faces[n] == faces[k])
    })
    .collect()
}

/// Compares inner pixels and returns how many there were.
fn compare(scene: &Scene, settings: &Settings) -> usize {
    let (frame, light, faces) = both(scene, settings);
    let peak = light.iter().flatten().fold(0.0f32, |m, &v| m.max(v));
    assert!(peak > 1.0, "a lit scene");
    let inner = inner(&faces);
    let mut shadow_edges = 0;
    for &k in &inner {
        let dark = |rgb: &[f32]| rgb.iter().all(|v| *v == 0.0);
        if dark(&frame.rgb[3 * k..3 * k + 3]) != dark(&light[k]) {
            shadow_edges += 1;
            continue;
        }
        for c in 0..3 {
            let (a, b) = (frame.rgb[3 * k + c], light[k][c]);
            assert!((a - b).abs() <= 1e-5 * peak, "pixel {k}: {a} and {b}, peak {peak}");
        }
    }
    // rays that graze an obstacle may decide either way: where the borders of shadows pass, not more
    assert!(shadow_edges * 300 <= inner.len(), "{shadow_edges} of {} pixels", inner.len());
    inner.len()
}

const MODELS: [&str; 5] = [
    "model = \"blinn_phong\"\nshininess = 60",
    "model = \"lambert\"",
    "model = \"ward\"\nalpha_x = 0.15\nalpha_y = 0.4",
    "model = \"oren_nayar\"",
    "model = \"ggx\"",
];

#[test]
fn phong_shading_equals_the_direct_term_of_the_path_tracer() {
    let barycentric = Settings { tessellation: 12, interpolation: Interpolation::Barycentric, ..Settings::default() };
    let terminators = [ShadowTerminator::None, ShadowTerminator::Hanika];
    for (model, terminator) in MODELS.into_iter().flat_map(|m| terminators.map(|t| (m, t))) {
        let coarse = Settings { shadow_terminator: Some(terminator), ..barycentric.clone() };
        for object in ["shape = \"sphere\"", "shape = \"cylinder\"\ntransform = [{ translate = [0, 0, -0.5] }]"] {
            let count = compare(&scene(model, object), &coarse);
            assert!(count > 500, "{model}: {count} pixels");
        }
        let pot = "shape = \"teapot\"\nlevel = 2\ntransform = [{ scale = [0.4, 0.4, 0.3] }, { rotate = \"30 deg\" }]";
        let shadowed = Settings { shadows: true, ..coarse.clone() };
        assert!(compare(&scene(model, pot), &shadowed) > 500, "{model}, {terminator:?}");
    }
}

#[test]
fn a_light_without_its_shadow_is_the_only_difference_that_shadows_make() {
    // a concave scene: the cylinder stands in front of a wall
    let object = "shape = \"cylinder\"\nradius = \"0.3 m\"\n[[objects]]\nmaterial = \"m\"\nshape = \"rectangle\"\nwidth = \"6 m\"\n\
                  height = \"6 m\"\ntransform = [{ rotate = \"90 deg\", axis = [1, 0, 0] }, { translate = [0, 1, 0] }]";
    let scene = scene("model = \"lambert\"", object);
    let settings = Settings { shadows: true, interpolation: Interpolation::Barycentric, ..Settings::default() };
    assert!(compare(&scene, &settings) > 5000);
    let lit = Raster::new(Arc::new(scene.clone()), &Settings { shadows: false, ..settings.clone() }).unwrap().frame();
    let dark = Raster::new(Arc::new(scene.clone()), &settings).unwrap().frame();
    let shadowed = lit.rgb.iter().zip(&dark.rgb).filter(|(l, d)| **l > 0.0 && **d == 0.0).count() / 3;
    assert!(shadowed > 300, "{shadowed} pixels in shadow");
}

#[test]
fn flat_gouraud_and_phong_have_one_limit() {
    use lesk::raster::Mode;
    let scene = scene("model = \"blinn_phong\"\nshininess = 20", "shape = \"sphere\"");
    let picture = |shading, tessellation| {
        let settings = Settings { shading, tessellation, ..Settings::default() };
        Raster::new(Arc::new(scene.clone()), &settings).unwrap().frame().rgb
    };
    let difference = |tessellation| {
        let phong = picture(Mode::Phong, tessellation);
        let peak = phong.iter().fold(0.0f32, |m, &v| m.max(v));
        [Mode::Flat, Mode::Gouraud].map(|mode| {
            let other = picture(mode, tessellation);
            let sum: f64 = phong.iter().zip(&other).map(|(a, b)| f64::from((a - b) / peak).powi(2)).sum();
            (sum / phong.len() as f64).sqrt()
        })
    };
    let curve: Vec<[f64; 2]> = [8, 16, 32, 64, 128, 256, 512].into_iter().map(difference).collect();
    // an error of first order in the size of a face for flat, of second order for Gouraud shading: halving the size
    // divides by 2 and by 4, where the highlight is resolved (20 deg wide: from 32 faces around on)
    for pair in curve[2..].windows(2) {
        assert!(pair[1][0] < 0.62 * pair[0][0], "flat: {curve:?}");
        assert!(pair[1][1] < 0.4 * pair[0][1] || pair[1][1] < 1e-5, "gouraud: {curve:?}");
    }
    assert!(curve[6][0] < 6e-3 && curve[6][1] < 1e-4, "{curve:?}");
}

#[test]
fn a_mirrored_object_shows_its_outside() {
    let object = "shape = \"teapot\"\nlevel = 2\ntransform = [{ scale = [-0.4, 0.4, 0.4] }]";
    let coarse =
        Settings { interpolation: Interpolation::Barycentric, cull: true, shadows: true, ..Settings::default() };
    assert!(compare(&scene("model = \"lambert\"", object), &coarse) > 500);
}
