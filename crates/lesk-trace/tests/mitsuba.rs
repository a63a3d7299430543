//! Pictures against Mitsuba 3: an independent implementation, whose tile means are stored in `data/mitsuba`.
//!
//! The scenes use only what both define alike. `bench/validate.py` makes the stored numbers and repeats the comparison
//! with Mitsuba itself, at more samples.

use lesk_image::{Image, Tile, Transfer};
use lesk_scene::SceneDescription;
use lesk_scene::description::{EnvironmentKind, Picture};
use lesk_trace::{Settings, film_for, render};
use std::f64::consts::{PI, TAU};
use std::ops::ControlFlow;
use std::path::PathBuf;
use std::sync::Arc;

/// Pixels along a side of a tile, of the stored means.
const SIDE: u32 = 8;
/// Pictures of independent seeds, and their samples per pixel: all scenes take about 8 s on two cores.
const PICTURES: u64 = 12;
const SPP: u32 = 48;
/// Pictures behind the stored means, see `data/mitsuba/PROVENANCE.md`.
const STORED_PICTURES: f64 = 32.0;
/// Largest |z| of chance: 10 scenes of 64 tiles, the whole and the scatter, 3 channels, once in a thousand runs (Šidák); seeds
/// are fixed, so the test never changes its mind by itself.
const LIMIT: f64 = 5.02;
/// Both sum in f32 somewhere: Mitsuba 64 samples of a pixel, each rounded at 6e-8.
const ROUNDING: f64 = 1e-5;

/// Mean of a tile, the variance of that mean, and the number of pictures behind them.
#[derive(Clone, Copy)]
struct Mean {
    value: f64,
    variance: f64,
    pictures: f64,
}

#[test]
fn diffuse_surfaces_under_point_lights_agree() {
    compare("diffuse_point");
}

#[test]
fn diffuse_surfaces_under_area_lights_agree() {
    compare("diffuse_area");
}

#[test]
fn smooth_metal_and_glass_under_an_area_light_agree() {
    compare("smooth_area");
}

#[test]
fn rough_metals_under_an_area_light_agree() {
    compare("rough_conductor_area");
}

#[test]
fn metals_under_an_environment_map_agree() {
    compare("conductors_environment");
}

#[test]
fn rough_glass_under_an_environment_map_agrees() {
    compare("rough_dielectric_environment");
}

#[test]
fn rough_metal_and_glass_under_a_sky_agree() {
    compare("sky");
}

#[test]
fn a_thousand_lights_agree() {
    compare("thousand_lights");
}

#[test]
fn a_glass_ball_close_up_agrees() {
    compare("glass_close");
}

#[test]
fn a_gold_ball_close_up_agrees() {
    compare("gold_close");
}

/// A comparison that sees nothing proves nothing: parameters that are a little off must differ by more than chance.
#[test]
fn a_refractive_index_or_an_extinction_that_is_slightly_off_is_seen() {
    for (name, right, wrong) in [("glass_close", "ior = 1.5", "ior = 1.51"), ("gold_close", "k = [3.6,", "k = [3.5,")] {
        let text = scene_text(name);
        assert!(text.contains(right), "{name} has no `{right}`");
        let found = differences(&rendered(&text.replace(right, wrong)), &stored(name));
        let worst = found.iter().fold(0.0, |m: f64, (_, z)| m.max(*z));
        println!("{name}: `{wrong}` differs by z = {worst:.1}");
        assert!(worst > 2.0 * LIMIT, "{name}: `{wrong}` passes, z = {worst:.2}");
    }
}

/// Every tile, the whole picture and the scatter of the tiles agree, channel by channel.
fn compare(name: &str) {
    for (what, z) in differences(&rendered(&scene_text(name)), &stored(name)) {
        assert!(z < LIMIT, "{name}, {what}: z = {z:.2}");
    }
}

/// What is compared, and by how many standard errors it differs.
fn differences(ours: &[Mean], theirs: &[Mean]) -> Vec<(String, f64)> {
    assert_eq!(ours.len(), theirs.len(), "number of tiles");
    let of_channel = |channel: usize| {
        let pick = |means: &[Mean]| -> Vec<Mean> { means.iter().skip(channel).step_by(3).copied().collect() };
        let (ours, theirs) = (pick(ours), pick(theirs));
        let scores: Vec<f64> = ours.iter().zip(&theirs).map(|(a, b)| z(*a, *b)).collect();
        let tile = |i: usize| {
            let (a, b) = (ours[i].value, theirs[i].value);
            (format!("channel {channel}: tile {i} is {a} here and {b} in Mitsuba"), scores[i].abs())
        };
        let mut found: Vec<(String, f64)> = (0..scores.len()).map(tile).collect();
        found.push((format!("channel {channel}: the whole picture"), z(total(&ours), total(&theirs)).abs()));
        found.push((format!("channel {channel}: the scatter of the tiles"), z_of_scatter(&scores)));
        found
    };
    (0..3).flat_map(of_channel).collect()
}

fn total(means: &[Mean]) -> Mean {
    Mean {
        value: means.iter().map(|m| m.value).sum(),
        variance: means.iter().map(|m| m.variance).sum(),
        pictures: means[0].pictures,
    }
}

/// The sum of squares of normal numbers as a normal number: Wilson & Hilferty, *The Distribution of Chi-Square*, 1931.
fn z_of_scatter(scores: &[f64]) -> f64 {
    let n = scores.len() as f64;
    let chi2 = scores.iter().map(|z| z * z).sum::<f64>();
    ((chi2 / n).cbrt() - (1.0 - 2.0 / (9.0 * n))) / (2.0 / (9.0 * n)).sqrt()
}

/// Difference in standard errors: Welch's statistic, its Student distribution made normal by Wallace's approximation
/// (*Bounds on normal approximations to Student's and the chi-square distributions*, 1959).
fn z(a: Mean, b: Mean) -> f64 {
    let rounding = ROUNDING * a.value.max(b.value);
    let error2 = a.variance + b.variance + rounding * rounding;
    if error2 == 0.0 {
        return 0.0;
    }
    let nu = error2 * error2
        / (a.variance.powi(2) / (a.pictures - 1.0) + b.variance.powi(2) / (b.pictures - 1.0)).max(f64::MIN_POSITIVE);
    let t = (a.value - b.value) / error2.sqrt();
    // beyond this number of degrees of freedom both distributions are the same to the digits of an f64
    let nu = nu.min(1e6);
    t.signum() * (8.0 * nu + 1.0) / (8.0 * nu + 3.0) * (nu * (t * t / nu).ln_1p()).sqrt()
}

fn folder() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../data/mitsuba")
}

/// The stored means, three channels per tile.
fn stored(name: &str) -> Vec<Mean> {
    let text = std::fs::read_to_string(folder().join("tiles.csv")).expect("data/mitsuba/tiles.csv is in the project");
    let rows = text.lines().filter_map(|line| line.strip_prefix(name)?.strip_prefix(','));
    let means = rows.flat_map(|row| {
        let v: Vec<f64> = row.split(',').map(|word| word.parse().expect("a number")).collect();
        [0, 1, 2].map(|c| Mean { value: v[1 + c], variance: v[4 + c], pictures: STORED_PICTURES })
    });
    means.collect()
}

fn scene_text(name: &str) -> String {
    std::fs::read_to_string(folder().join(format!("{name}.toml"))).expect("the scene is in the project")
}

/// The same means of pictures of a scene rendered now.
fn rendered(scene: &str) -> Vec<Mean> {
    let mut description = SceneDescription::parse(scene, folder()).expect("a legal scene");
    if let Some(environment) = &mut description.environment
        && let EnvironmentKind::Map { image, .. } = &mut environment.kind
    {
        *image = Picture::Image(Arc::new(environment_map()));
    }
    let scene = description.build().expect("a legal scene");
    let pictures: Vec<Vec<f64>> = (0..PICTURES)
        .map(|seed| {
            let mut settings = Settings { render: scene.render.clone(), time: None };
            (settings.render.spp, settings.render.seed) = (SPP, seed);
            let mut film = film_for(&scene, &settings).expect("a small film");
            render(&scene, &settings, &mut film, |_, _| ControlFlow::Continue(()));
            let tile_mean = |tile: Tile| {
                let sum =
                    tile.pixels().map(|(x, y)| film.mean(x, y)).fold([0.0; 3], |s, v| [0, 1, 2].map(|c| s[c] + v[c]));
                sum.map(|s| s / f64::from(SIDE * SIDE))
            };
            film.tiles(SIDE).into_iter().flat_map(tile_mean).collect()
        })
        .collect();
    let n = pictures.len() as f64;
    let mean = |i: usize| {
        let value = pictures.iter().map(|p| p[i]).sum::<f64>() / n;
        let spread = pictures.iter().map(|p| (p[i] - value).powi(2)).sum::<f64>() / (n - 1.0);
        Mean { value, variance: spread / n, pictures: n }
    };
    (0..pictures[0].len()).map(mean).collect()
}

/// The closed form `radiance_of_map` of `bench/agreement.py`, cd/m².
fn environment_map() -> Image {
    const SIZE: [u32; 2] = [512, 256];
    let texel = |i: u32| {
        let [x, y] = [i % SIZE[0], i / SIZE[0]].map(|i| f64::from(i) + 0.5);
        let (sin_theta, cos_theta) = (PI * y / f64::from(SIZE[1])).sin_cos();
        let (sin_phi, cos_phi) = (TAU * (x / f64::from(SIZE[0]) - 0.5)).sin_cos();
        let cos_sun = -0.48 * sin_theta * sin_phi - 0.6 * sin_theta * cos_phi + 0.64 * cos_theta;
        let glow = (12.0 * (cos_sun - 1.0)).exp();
        let blend = 1.0 / (1.0 + (-8.0 * cos_theta).exp());
        let (sky, ground, sun) = ([150.0, 220.0, 380.0], [90.0, 70.0, 50.0], [2500.0, 2000.0, 1400.0]);
        [0, 1, 2].map(|c| (blend * sky[c] + (1.0 - blend) * ground[c] + glow * sun[c]) as f32)
    };
    let data = (0..SIZE[0] * SIZE[1]).flat_map(texel).collect();
    Image::new(SIZE[0], SIZE[1], 3, Transfer::Linear, data).expect("a legal image")
}
