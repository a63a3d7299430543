//! What must be the same to the bit: threads, interruptions, checkpoints.

mod common;

use common::{Parts, camera, material, settings};
use lesk_geometry::{Geometry, Transform};
use lesk_image::Film;
use lesk_math::sobol::Sampler;
use lesk_scene::Scene;
use lesk_trace::checkpoint::{self, CheckpointError, Identity};
use lesk_trace::{End, SPLIT_NAMES, Settings, film_for, radiance, render};
use std::ops::ControlFlow;

const SIZE: [u32; 2] = [40, 24];

/// Glass, mirror, satin and a lamp over a floor: every kind of path.
fn scene() -> Scene {
    let mut parts = Parts::new();
    let ball = |x: f64| Transform::translate(x, 0.0, 0.5) * Transform::scale(0.5, 0.5, 0.5).unwrap();
    let floor = Transform::scale(5.0, 5.0, 1.0).unwrap();
    parts.add(Geometry::Rectangle, floor, Some(material("lambert", &[])), 0.0);
    parts.add(Geometry::Sphere, ball(-1.1), Some(material("dielectric", &[])), 0.0);
    parts.add(Geometry::Sphere, ball(0.0), Some(material("ggx", &[("alpha_x", 0.1), ("f0", 0.8)])), 0.0);
    parts.add(Geometry::Sphere, ball(1.1), Some(material("mirror", &[])), 0.0);
    let lamp = Transform::translate(0.3, -0.5, 3.0) * Transform::scale(0.3, 0.3, 0.3).unwrap();
    parts.add(Geometry::Sphere, lamp, None, 5000.0);
    parts.build(camera([0.0, -4.0, 1.5], [0.0, 0.0, 0.4], SIZE, 45.0), SIZE)
}

fn all_layers() -> Settings {
    let mut settings = settings(9, 6);
    settings.render.split = SPLIT_NAMES.map(String::from).to_vec();
    settings.render.aovs = true;
    settings
}

fn whole(scene: &Scene, settings: &Settings) -> Film {
    let mut film = film_for(scene, settings).unwrap();
    assert_eq!(render(scene, settings, &mut film, |_, _| ControlFlow::Continue(())), End::Done);
    film
}

#[test]
fn picture_is_the_same_for_any_number_of_threads() {
    let (scene, settings) = (scene(), all_layers());
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| whole(&scene, &settings))
    };
    let one = with(1);
    assert_eq!(one, with(2));
    assert_eq!(one, with(5));
}

#[test]
fn a_path_finds_alone_what_it_finds_among_others() {
    let (scene, settings) = (scene(), settings(1, 6));
    let film = whole(&scene, &settings);
    let (mut sampler, mut lit) = (Sampler::new(settings.render.seed as u32), 0);
    for (x, y) in (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| (x, y))) {
        sampler.start(y * SIZE[0] + x, 0);
        let mut rest = sampler;
        let [u, v, lens_u, lens_v] = rest.next4d();
        let [dx, dy] = scene.film.filter.sample([u, v]);
        let ray = scene.camera.ray([x as f32 + 0.5 + dx, y as f32 + 0.5 + dy], [lens_u, lens_v]);
        let alone = radiance(&scene, &settings.render, ray, rest);
        assert_eq!(film.mean(x, y), alone.map(f64::from), "pixel {x}, {y}");
        lit += usize::from(alone[0] > 0.0);
    }
    assert!(lit > 300, "{lit} pixels show light");
}

#[test]
fn interrupted_render_that_goes_on_from_a_checkpoint_equals_an_uninterrupted_one() {
    let (scene, settings) = (scene(), all_layers());
    let identity = Identity::new(&scene, &settings);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("picture.ckpt");
    let mut film = film_for(&scene, &settings).unwrap();
    let mut tiles = 0;
    let end = render(&scene, &settings, &mut film, |_, _| {
        tiles += 1;
        if tiles == 8 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    assert_eq!(end, End::Stopped);
    checkpoint::save(&path, &identity, &film).unwrap();
    let mut resumed = film_for(&scene, &settings).unwrap();
    checkpoint::load(&path, &identity, &mut resumed).unwrap();
    assert_eq!(resumed, film);
    assert_eq!(render(&scene, &settings, &mut resumed, |_, _| ControlFlow::Continue(())), End::Done);
    assert_eq!(resumed, whole(&scene, &settings));
}

#[test]
fn checkpoint_of_another_picture_is_refused_with_what_differs() {
    let (scene, settings) = (scene(), all_layers());
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("picture.ckpt");
    let film = film_for(&scene, &settings).unwrap();
    checkpoint::save(&path, &Identity::new(&scene, &settings), &film).unwrap();
    let mut other = settings.clone();
    other.render.seed = 5;
    let mut target = film_for(&scene, &other).unwrap();
    let error = checkpoint::load(&path, &Identity::new(&scene, &other), &mut target).unwrap_err();
    assert!(matches!(error, CheckpointError::Mismatch(_)));
    assert!(error.to_string().contains("`seed` is `0` in it and `5` now"), "{error}");
}

#[test]
fn damaged_checkpoints_are_refused() {
    let (scene, settings) = (scene(), all_layers());
    let identity = Identity::new(&scene, &settings);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("picture.ckpt");
    let film = whole(&scene, &settings);
    checkpoint::save(&path, &identity, &film).unwrap();
    let bytes = std::fs::read(&path).unwrap();
    for cut in [0, 5, 17, 60, bytes.len() / 2, bytes.len() - 1] {
        std::fs::write(&path, &bytes[..cut]).unwrap();
        let mut target = film_for(&scene, &settings).unwrap();
        assert!(checkpoint::load(&path, &identity, &mut target).is_err(), "cut at {cut}");
    }
}

#[test]
fn layers_sum_to_the_picture() {
    let film = whole(&scene(), &all_layers());
    let mut seen = [0.0; 4];
    for y in 0..SIZE[1] {
        for x in 0..SIZE[0] {
            let total = film.mean(x, y)[0];
            let sum: f64 = (0..4).map(|i| film.split(i, x, y)[0]).sum();
            // f32 sums per path: a few roundings
            assert!((total - sum).abs() <= 1e-5 * total.max(1.0), "({x}, {y}): {total} {sum}");
            (0..4).for_each(|i| seen[i] += film.split(i, x, y)[0]);
        }
    }
    assert!(seen.iter().all(|&v| v > 0.0), "the scene has every kind of path: {seen:?}");
}

#[test]
fn time_limit_ends_between_passes_and_keeps_what_is_done() {
    let mut settings = settings(1_000_000, 6);
    settings.time = Some(std::time::Duration::from_millis(200));
    let scene = scene();
    let mut film = film_for(&scene, &settings).unwrap();
    assert_eq!(render(&scene, &settings, &mut film, |_, _| ControlFlow::Continue(())), End::OutOfTime);
    assert!(film.sample_count(0, 0) >= 1);
}
