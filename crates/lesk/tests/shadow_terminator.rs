//! The border between light and own shadow on coarse faces with interpolated normals, in both engines.

use lesk::math::Vec3;
use lesk::math::sobol::Sampler;
use lesk::raster::{Interpolation, Raster, Settings};
use lesk::scene::{Scene, ShadowTerminator};
use std::f64::consts::PI;
use std::sync::Arc;

const SIZE: u32 = 120;
const LAMP: [f64; 3] = [3.0, -0.4, 0.7];

fn scene(terminator: &str, object: &str) -> Scene {
    let text = format!(
        "version = 1\n[camera]\neye = [0, -5, 0.4]\ntarget = [0, 0, 0]\nfov = \"28 deg\"\n[film]\nsize = [{SIZE}, {SIZE}]\n\
         [render]\nmax_depth = 1\nshadow_terminator = \"{terminator}\"\n[materials.m]\nmodel = \"lambert\"\n\
         [[objects]]\nmaterial = \"m\"\n{object}\n\
         [[lights]]\ntype = \"point\"\nposition = {LAMP:?}\nintensity = \"100 cd\"\n"
    );
    Scene::parse(&text, ".").unwrap_or_else(|e| panic!("{e}"))
}

/// A pixel: what both engines show, and the closed form for the interpolated normal without any shadow.
struct Pixel {
    raster: f64,
    traced: f64,
    expected: f64,
}

/// Pixels of one face whose interpolated normal faces the viewer.
fn pixels(terminator: &str, object: &str, faces: u32) -> Vec<Pixel> {
    let scene = scene(terminator, object);
    let settings = Settings {
        tessellation: faces,
        interpolation: Interpolation::Barycentric,
        shadows: true,
        ..Settings::default()
    };
    let mut raster = Raster::new(Arc::new(scene.clone()), &settings).unwrap();
    let frame = raster.frame();
    let traced = Scene { world: raster.world().unwrap(), ..scene };
    let mut sampler = Sampler::new(1);
    let mut out = Vec::new();
    for (x, y) in (0..SIZE).flat_map(|y| (0..SIZE).map(move |x| (x, y))) {
        let ray = traced.camera.ray([x as f32 + 0.5, y as f32 + 0.5], [0.5; 2]);
        let Some(hit) = traced.world.intersect(&ray) else { continue };
        let surface = traced.world.surface(&ray, &hit);
        if surface.ns.dot(-ray.d) < 0.05 {
            continue;
        }
        sampler.start(y * SIZE + x, 0);
        let light = lesk::trace::radiance(&traced, &traced.render, ray, sampler);
        let to = Vec3::from(LAMP) - surface.p.map(f64::from);
        let cosine = surface.ns.map(f64::from).dot(to.normalize());
        out.push(Pixel {
            raster: f64::from(frame.rgb[3 * (y * SIZE + x) as usize]),
            traced: f64::from(light[0]),
            expected: 0.5 / PI * 100.0 * cosine.max(0.0) / to.length_squared(),
        });
    }
    assert!(out.len() > 3000, "{} pixels", out.len());
    out
}

const SPHERE: &str = "shape = \"sphere\"\nradius = \"1 m\"\ntransform = [{ rotate = \"12 deg\" }]";

/// Pixels that a closed form lights and an engine leaves dark: rounding may blur the last 1e-3 of a cosine.
fn dark(pixels: &[Pixel], value: impl Fn(&Pixel) -> f64) -> usize {
    let peak = pixels.iter().fold(0.0f64, |m, p| m.max(p.expected));
    pixels.iter().filter(|p| p.expected > 1e-3 * peak && value(p) == 0.0).count()
}

#[test]
fn a_coarse_sphere_has_blocks_without_raised_rays_and_none_with_them() {
    for faces in [12, 16, 24] {
        let blocks = pixels("none", SPHERE, faces);
        let smooth = pixels("hanika", SPHERE, faces);
        let found = [dark(&blocks, |p| p.raster), dark(&blocks, |p| p.traced)];
        assert!(found.iter().all(|&n| n > 100), "{faces} faces: {found:?} dark pixels");
        let peak = smooth.iter().fold(0.0f64, |m, p| m.max(p.expected));
        for p in &smooth {
            // f32 positions and normals
            let tolerance = 1e-5 * peak;
            assert!((p.raster - p.expected).abs() < tolerance, "{faces}: raster {} {}", p.raster, p.expected);
            assert!((p.traced - p.expected).abs() < tolerance, "{faces}: traced {} {}", p.traced, p.expected);
        }
    }
}

#[test]
fn fine_faces_stay_as_they_are() {
    // faces of 0.7 degrees: without raised rays a strip as wide as a face is dark, 1 / 80 of the radius
    let [blocks, smooth] = ["none", "hanika"].map(|t| pixels(t, SPHERE, 512));
    let peak = smooth.iter().fold(0.0f64, |m, p| m.max(p.expected));
    for (a, b) in blocks.iter().zip(&smooth) {
        assert!((a.raster - b.raster).abs() < 0.01 * peak && (a.traced - b.traced).abs() < 0.01 * peak);
    }
    let differ = blocks.iter().zip(&smooth).filter(|(a, b)| a.traced != b.traced).count();
    assert!(differ < blocks.len() / 100, "{differ} of {} pixels", blocks.len());
}

#[test]
fn the_inside_of_a_coarse_pipe_lets_no_light_through_its_wall() {
    // seen through its open end, lit from outside: a hollow is not raised, and rays start on the side of the viewer
    let pipe = "shape = \"cylinder\"\nradius = \"1 m\"\nheight = \"3 m\"\ncapped = false\n\
                transform = [{ translate = [0, 0, -1.5] }, { rotate = \"75 deg\", axis = [1, 0, 0] }]";
    for terminator in ShadowTerminator::NAMES {
        let scene = scene(terminator, pipe);
        let settings = Settings {
            tessellation: 10,
            interpolation: Interpolation::Barycentric,
            shadows: true,
            ..Settings::default()
        };
        let mut raster = Raster::new(Arc::new(scene.clone()), &settings).unwrap();
        let frame = raster.frame();
        let traced = Scene { world: raster.world().unwrap(), ..scene };
        let mut inside = 0;
        for (x, y) in (0..SIZE).flat_map(|y| (0..SIZE).map(move |x| (x, y))) {
            let ray = traced.camera.ray([x as f32 + 0.5, y as f32 + 0.5], [0.5; 2]);
            let Some(hit) = traced.world.intersect(&ray) else { continue };
            let surface = traced.world.surface(&ray, &hit);
            // the lamp stands outside the planes of all faces that it could light from within
            if surface.ng.dot(-ray.d) > 0.0 {
                continue;
            }
            inside += 1;
            let mut sampler = Sampler::new(1);
            sampler.start(y * SIZE + x, 0);
            let light = lesk::trace::radiance(&traced, &traced.render, ray, sampler);
            let shadow = lesk::geometry::Ray::between(surface.p - surface.ng * 1e-3, vec(LAMP));
            if traced.world.occluded(&shadow) {
                assert_eq!(light[0], 0.0, "{terminator}: pixel {x}, {y}");
                assert_eq!(frame.rgb[3 * (y * SIZE + x) as usize], 0.0, "{terminator}: pixel {x}, {y}");
            }
        }
        assert!(inside > 1000, "{inside} pixels");
    }
}

fn vec(p: [f64; 3]) -> Vec3<f32> {
    Vec3::from(p).map(|x| x as f32)
}
