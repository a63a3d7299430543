//! Normal maps and photometric files in the rasteriser: against closed forms, and against the path tracer.

use lesk::image::{Image, Transfer, io};
use lesk::math::sobol::Sampler;
use lesk::raster::{Frame, Interpolation, Mode, Raster, Settings};
use lesk::scene::Scene;
use std::f64::consts::PI;
use std::path::Path;
use std::sync::Arc;

const SIZE: u32 = 120;

/// A picture of normals, n(u, v) as codes.
fn map(folder: &Path, normal: impl Fn(f32, f32) -> [f32; 3]) {
    let pixel = |x: u32, y: u32| normal((x as f32 + 0.5) / 64.0, (y as f32 + 0.5) / 64.0).map(|n| 0.5 * (n + 1.0));
    let image = Image::from_fn(64, 64, Transfer::Linear, pixel).unwrap();
    io::write(folder.join("n.exr"), &image).unwrap();
}

fn scene(folder: &Path, eye: [f64; 3], model: &str, objects: &str, lights: &str) -> Scene {
    let text = format!(
        "version = 1\n[camera]\neye = {eye:?}\ntarget = [0, 0, 0]\nfov = \"40 deg\"\n[film]\nsize = [{SIZE}, {SIZE}]\n\
         [render]\nmax_depth = 1\n[materials.m]\n{model}\n{objects}\n{lights}"
    );
    Scene::parse(&text, folder).unwrap_or_else(|e| panic!("{e}"))
}

fn draw(scene: &Scene, settings: &Settings) -> (Frame, Scene) {
    let mut raster = Raster::new(Arc::new(scene.clone()), settings).unwrap();
    let frame = raster.frame();
    let traced = Scene { world: raster.world().unwrap(), ..scene.clone() };
    (frame, traced)
}

const SQUARE: &str = "[[objects]]\nmaterial = \"m\"\nshape = \"rectangle\"\nwidth = \"3 m\"\nheight = \"3 m\"";
const MAPPED: &str = "normal_map = { file = \"n.exr\" }";

#[test]
fn a_leaning_map_lights_a_floor_by_the_cosine_to_the_leaning_normal_in_every_mode() {
    let folder = tempfile::tempdir().unwrap();
    map(folder.path(), |_, _| [0.48, 0.36, 0.8]);
    let model = format!("model = \"lambert\"\nreflectance = 0.5\n{MAPPED}");
    // light from there, from its mirror image in x; the floor turned so that u runs along y; mirrored, so that u runs along -x
    let cases = [
        ([0.48, 0.36, 0.8], "", 1.0),
        ([-0.48, 0.36, 0.8], "", 0.5392),
        ([-0.36, 0.48, 0.8], "transform = [{ rotate = \"90 deg\" }]", 1.0),
        ([-0.48, 0.36, 0.8], "transform = [{ scale = [-1, 1, 1] }]", 1.0),
    ];
    for (from, place, cosine) in cases {
        let [x, y, z] = from.map(|v: f64| -v);
        let sun =
            format!("[[lights]]\ntype = \"directional\"\ndirection = [{x}, {y}, {z}]\nilluminance = \"1000 lx\"\n");
        let scene = scene(folder.path(), [0.0, -0.1, 4.0], &model, &format!("{SQUARE}\n{place}\n"), &sun);
        for shading in [Mode::Flat, Mode::Gouraud, Mode::Phong] {
            for aovs in [false, true] {
                let (frame, _) = draw(&scene, &Settings { shading, aovs, ..Settings::default() });
                let middle = f64::from(frame.rgb[3 * (SIZE / 2 * SIZE + SIZE / 2) as usize]);
                // EXR of half floats: 5e-4 of the codes
                let expected = 0.5 * 1000.0 * cosine / PI;
                assert!((middle / expected - 1.0).abs() < 5e-3, "{shading:?} {from:?} {place}: {middle} {expected}");
            }
        }
    }
}

#[test]
fn a_bumpy_map_on_a_curved_mesh_equals_the_path_tracer() {
    let folder = tempfile::tempdir().unwrap();
    let bump = |u: f32, v: f32| {
        let slope = [0.5 * (12.0 * u).sin(), 0.4 * (17.0 * v).cos()];
        let length = (slope[0] * slope[0] + slope[1] * slope[1] + 1.0).sqrt();
        [slope[0] / length, slope[1] / length, 1.0 / length]
    };
    map(folder.path(), bump);
    let lamp = "[[lights]]\ntype = \"point\"\nposition = [-1.5, -3, 2.5]\nintensity = \"900 cd\"\n";
    for model in ["model = \"lambert\"", "model = \"ward\"\nalpha_x = 0.2\nalpha_y = 0.4"] {
        for (place, shadows) in [("", false), ("{ scale = [-1, 1, 1] }, ", true)] {
            let pot = format!(
                "[[objects]]\nmaterial = \"m\"\nshape = \"teapot\"\nlevel = 3\ntransform = [{place}{{ scale = 0.4 }}]\n"
            );
            let scene = scene(folder.path(), [0.9, -3.1, 1.4], &format!("{model}\n{MAPPED}"), &pot, lamp);
            let settings = Settings { interpolation: Interpolation::Barycentric, shadows, ..Settings::default() };
            let (frame, traced) = draw(&scene, &settings);
            let mut sampler = Sampler::new(1);
            let pixels = (0..SIZE * SIZE).filter_map(|k| {
                let ray = traced.camera.ray([(k % SIZE) as f32 + 0.5, (k / SIZE) as f32 + 0.5], [0.5; 2]);
                traced.world.intersect(&ray)?;
                sampler.start(k, 0);
                let light = lesk::trace::radiance(&traced, &traced.render, ray, sampler);
                Some((f64::from(frame.rgb[3 * k as usize]), f64::from(light[0])))
            });
            let pixels: Vec<(f64, f64)> = pixels.collect();
            let peak = pixels.iter().fold(0.0f64, |m, p| m.max(p.1));
            let differ = pixels.iter().filter(|(a, b)| (a - b).abs() > 1e-4 * peak).count();
            // pixels at borders of faces and shadows may show either side
            assert!(pixels.len() > 2500 && peak > 10.0, "{} pixels, {peak}", pixels.len());
            assert!(differ * 50 < pixels.len(), "{model}, {place}: {differ} of {} pixels", pixels.len());
            // and the map is seen at all
            let flat = self::scene(folder.path(), [0.9, -3.1, 1.4], model, &pot, lamp);
            let (plain, _) = draw(&flat, &settings);
            let changed =
                plain.rgb.iter().zip(&frame.rgb).filter(|(a, b)| (**a - **b).abs() > 0.05 * peak as f32).count();
            assert!(changed > 1000, "{changed}");
        }
    }
}

#[test]
fn a_texture_lies_where_its_coordinates_say() {
    // red is u and green is v, whose rows go up; a square of 3 m has u = x/3 + 1/2
    let folder = tempfile::tempdir().unwrap();
    map(folder.path(), |u, down| [2.0 * u - 1.0, 1.0 - 2.0 * down, 0.0]);
    let model = "model = \"lambert\"\nreflectance = { file = \"n.exr\", role = \"data\" }";
    let sun = "[[lights]]\ntype = \"directional\"\ndirection = [0, 0, -1]\nilluminance = \"100 lx\"\n";
    let scene = scene(folder.path(), [0.0, -0.1, 4.0], model, SQUARE, sun);
    for interpolation in [Interpolation::Barycentric, Interpolation::Bilinear] {
        let (frame, _) = draw(&scene, &Settings { interpolation, ..Settings::default() });
        for (x, y) in [(60, 60), (80, 35), (31, 77), (95, 90), (25, 22)] {
            let ray = scene.camera.ray([x as f32 + 0.5, y as f32 + 0.5], [0.5; 2]);
            let hit = scene.world.surface(&ray, &scene.world.intersect(&ray).unwrap());
            let at = hit.p.to_array().map(|p| f64::from(p) / 3.0 + 0.5);
            for c in [0, 1] {
                let found = f64::from(frame.rgb[3 * (y * SIZE + x) as usize + c]);
                // EXR of half floats: 5e-4 of the codes
                let expected = at[c] * 100.0 / PI;
                assert!((found / expected - 1.0).abs() < 2e-3, "{interpolation:?} {x} {y}: {found} {expected}");
            }
        }
    }
}

#[test]
fn tangents_of_a_file_count_in_both_engines() {
    // two triangles with u along +x, whose file says that normal maps go along +y
    let folder = tempfile::tempdir().unwrap();
    map(folder.path(), |_, _| [0.6, 0.0, 0.8]);
    let (corners, tangent) = ([[-1.5, -1.5], [1.5, -1.5], [1.5, 1.5], [-1.5, 1.5]], [0.0f32, 1.0, 0.0, 1.0]);
    let floats = [
        corners.iter().flat_map(|&[x, y]| [x, y, 0.0]).collect::<Vec<f32>>(),
        corners.iter().flat_map(|_| [0.0, 0.0, 1.0]).collect(),
        corners.iter().flat_map(|&[x, y]| [x / 3.0 + 0.5, y / 3.0 + 0.5]).collect(),
        corners.iter().flat_map(|_| tangent).collect(),
    ];
    let mut bytes: Vec<u8> = floats.iter().flatten().flat_map(|x| x.to_le_bytes()).collect();
    bytes.extend([0u16, 1, 2, 0, 2, 3].iter().flat_map(|i| i.to_le_bytes()));
    std::fs::write(folder.path().join("a.bin"), &bytes).unwrap();
    let gltf = r#"{ "asset": { "version": "2.0" }, "scene": 0, "scenes": [{ "nodes": [0] }], "nodes": [{ "mesh": 0 }],
        "meshes": [{ "primitives": [{ "attributes":
            { "POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2, "TANGENT": 3 }, "indices": 4 }] }],
        "buffers": [{ "uri": "a.bin", "byteLength": 204 }],
        "bufferViews": [{ "buffer": 0, "byteLength": 48 }, { "buffer": 0, "byteOffset": 48, "byteLength": 48 },
            { "buffer": 0, "byteOffset": 96, "byteLength": 32 }, { "buffer": 0, "byteOffset": 128, "byteLength": 64 },
            { "buffer": 0, "byteOffset": 192, "byteLength": 12 }],
        "accessors": [
            { "bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [-1.5, -1.5, 0], "max": [1.5, 1.5, 0] },
            { "bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC3" },
            { "bufferView": 2, "componentType": 5126, "count": 4, "type": "VEC2" },
            { "bufferView": 3, "componentType": 5126, "count": 4, "type": "VEC4" },
            { "bufferView": 4, "componentType": 5123, "count": 6, "type": "SCALAR" }] }"#;
    std::fs::write(folder.path().join("a.gltf"), gltf).unwrap();
    let model = format!("model = \"lambert\"\nreflectance = 0.5\n{MAPPED}");
    let sun = "[[lights]]\ntype = \"directional\"\ndirection = [0, -0.6, -0.8]\nilluminance = \"1000 lx\"\n";
    let mesh = "[[objects]]\nmaterial = \"m\"\nshape = \"mesh\"\nfile = \"a.gltf\"\n";
    let scene = scene(folder.path(), [0.0, -0.1, 4.0], &model, mesh, sun);
    // leaning along +y, the normal meets the sun
    let expected = 0.5 * 1000.0 / PI;
    let near = |value: f64| (value / expected - 1.0).abs() < 5e-3;
    for shading in [Mode::Gouraud, Mode::Phong] {
        let (frame, _) = draw(&scene, &Settings { shading, ..Settings::default() });
        let middle = f64::from(frame.rgb[3 * (SIZE / 2 * SIZE + SIZE / 2) as usize]);
        assert!(near(middle), "{shading:?}: {middle} {expected}");
    }
    let mut sampler = Sampler::new(1);
    sampler.start(0, 0);
    let ray = scene.camera.ray([60.5, 60.5], [0.5; 2]);
    let light = lesk::trace::radiance(&scene, &scene.render, ray, sampler);
    assert!(near(f64::from(light[0])), "path: {light:?} {expected}");
}

#[test]
fn a_brushed_material_keeps_its_direction_when_it_is_lit_at_vertices() {
    // fine faces: all modes show the same, so the vertices must know the direction of the brush
    let ward = "model = \"ward\"\nalpha_x = 0.1\nalpha_y = 0.5";
    let lamp = "[[lights]]\ntype = \"point\"\nposition = [-1.5, -3, 2.5]\nintensity = \"900 cd\"\n";
    let pot = "[[objects]]\nmaterial = \"m\"\nshape = \"teapot\"\nlevel = 32\ntransform = [{ scale = 0.4 }]\n";
    let scene = scene(Path::new("."), [0.9, -3.1, 1.4], ward, pot, lamp);
    let [phong, gouraud] =
        [Mode::Phong, Mode::Gouraud].map(|shading| draw(&scene, &Settings { shading, ..Settings::default() }).0.rgb);
    let sum = |f: &dyn Fn(f32, f32) -> f32| phong.iter().zip(&gouraud).map(|(a, b)| f64::from(f(*a, *b))).sum::<f64>();
    let error = sum(&|a, b| (a - b).abs()) / sum(&|a, _| a);
    assert!(error < 0.05, "{error}");
}

#[test]
fn a_photometric_file_lights_a_floor_by_its_candela_over_the_square_of_the_distance() {
    // a point: its opening has no size; candela at 0, 30, 60, 90 degrees, linear between; factor 2
    let file = "IESNA:LM-63-2002\nTILT=NONE\n1 -1 2 4 1 1 2 0 0 0\n1 1 9\n0 30 60 90\n0\n500 400 150 0\n";
    let candela = |deg: f64| {
        let table = [(0.0, 1000.0), (30.0, 800.0), (60.0, 300.0), (90.0, 0.0)];
        let k = ((deg / 30.0) as usize).min(2);
        let ((a, low), (_, high)) = (table[k], table[k + 1]);
        low + (high - low) * (deg - a) / 30.0
    };
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("lamp.ies"), file).unwrap();
    let lamp = "[[lights]]\ntype = \"luminaire\"\nfile = \"lamp.ies\"\nposition = [0.2, -0.1, 1.2]\n";
    let matte = "model = \"lambert\"\nreflectance = 0.5";
    let scene = scene(folder.path(), [0.0, -0.1, 5.0], matte, SQUARE, lamp);
    let (frame, _) = draw(&scene, &Settings { interpolation: Interpolation::Barycentric, ..Settings::default() });
    let mut count = 0;
    for (k, rgb) in frame.rgb.as_chunks::<3>().0.iter().enumerate() {
        let ray = scene.camera.ray([(k as u32 % SIZE) as f32 + 0.5, (k as u32 / SIZE) as f32 + 0.5], [0.5; 2]);
        let (o, d) = (ray.o.map(f64::from), ray.d.map(f64::from));
        let p = o + d * (-o.z / d.z);
        if p.x.abs() > 1.48 || p.y.abs() > 1.48 {
            continue;
        }
        count += 1;
        let (dx, dy) = (p.x - 0.2, p.y + 0.1);
        let r2 = dx * dx + dy * dy + 1.44;
        let gamma = dx.hypot(dy).atan2(1.2).to_degrees();
        let expected = 0.5 / PI * candela(gamma) / r2 * (1.2 / r2.sqrt());
        let value = f64::from(rgb[0]);
        // the lamp keeps its intensity as a table in f32
        assert!((value / expected - 1.0).abs() < 1e-3, "{gamma} deg: {value} {expected}");
    }
    assert!(count > 5000, "{count}");
}

#[test]
fn a_bent_face_does_not_hide_itself() {
    let folder = tempfile::tempdir().unwrap();
    for bend in [0.4, -0.4] {
        let obj = format!("v -1 -1 0\nv 1 -1 {bend}\nv 1 1 0\nv -1 1 {bend}\nf 1 2 3 4\n");
        std::fs::write(folder.path().join("saddle.obj"), obj).unwrap();
        let saddle = "[[objects]]\nmaterial = \"m\"\nshape = \"mesh\"\nfile = \"saddle.obj\"\n";
        let lamp = "[[lights]]\ntype = \"point\"\nposition = [0.5, 0.3, 3]\nintensity = \"100 cd\"\n";
        let scene = scene(folder.path(), [0.0, -0.2, 5.0], "model = \"lambert\"", saddle, lamp);
        use lesk::scene::ShadowTerminator::{Hanika, None};
        for (shading, terminator) in [(Mode::Flat, Hanika), (Mode::Flat, None), (Mode::Phong, Hanika)] {
            let [lit, shadowed] = [false, true].map(|shadows| {
                let shadow_terminator = Some(terminator);
                let settings = Settings { shading, shadows, shadow_terminator, ..Settings::default() };
                draw(&scene, &settings).0.rgb
            });
            assert!(lit.iter().any(|v| *v > 0.0) && lit == shadowed, "{bend}, {shading:?}, {terminator:?}");
        }
    }
}
