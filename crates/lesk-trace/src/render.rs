//! Rendering: tiles over threads, passes over samples, progress and interruption.

use crate::path::Limits;
use crate::split::SPLIT_NAMES;
use crate::wave::{WAVE, Wave};
use lesk_image::{Film, FilmSpec, FilmTile, ImageError, Sample, Tile};
use lesk_math::CHANNELS;
use lesk_math::sobol::Sampler;
use lesk_scene::{RenderSettings, Scene};
use rayon::prelude::*;
use std::fmt;
use std::ops::ControlFlow;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::{Duration, Instant};

/// Side of a tile in pixels.
const TILE: u32 = 16;

/// How to render.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// What the scene states, or the caller instead.
    pub render: RenderSettings,
    /// Stop beginning new passes after this time.
    pub time: Option<Duration>,
}

/// How far a render is.
#[derive(Clone, Copy, Debug)]
pub struct Progress {
    /// Samples done, of all pixels together, those of earlier runs included.
    pub done: u64,
    pub total: u64,
    pub elapsed: Duration,
    /// Estimated time to the end; `None` before anything is done.
    pub left: Option<Duration>,
}

/// How a render ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// All samples are in the film.
    Done,
    /// The time ran out.
    OutOfTime,
    /// The observer said stop; the film holds what was done.
    Stopped,
}

/// Why there is no film.
#[derive(Debug)]
pub enum FilmError {
    /// The name of a layer that is none of [`SPLIT_NAMES`].
    Layer(String),
    /// A size that no film can have.
    Image(ImageError),
}

impl fmt::Display for FilmError {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            FilmError::Layer(name) => {
                write!(f, "there is no layer `{name}`, but {} are accepted", SPLIT_NAMES.join(", "))
            }
            FilmError::Image(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for FilmError {}

/// An empty film for a scene and settings.
///
/// # Errors
/// A size that no film can have, or an unknown layer.
pub fn film_for(scene: &Scene, settings: &Settings) -> Result<Film, FilmError> {
    let RenderSettings { split, aovs, .. } = &settings.render;
    if let Some(name) = split.iter().find(|name| layer(name).is_none()) {
        return Err(FilmError::Layer(name.clone()));
    }
    let spec = FilmSpec { width: scene.film.width, height: scene.film.height, splits: split.clone(), aovs: *aovs };
    Film::new(spec).map_err(FilmError::Image)
}

/// The number of a layer.
fn layer(name: &str) -> Option<usize> {
    SPLIT_NAMES.iter().position(|known| *known == name)
}

/// Renders until every pixel holds `settings.render.spp` samples; a film that already holds samples is continued.
///
/// The pixels are the same bits for any number of threads and any interruption. `observe` is called between tiles,
/// from one thread at a time, with the film as it is; it may stop the render.
pub fn render<F>(scene: &Scene, settings: &Settings, film: &mut Film, mut observe: F) -> End
where
    F: FnMut(Progress, &Film) -> ControlFlow<()> + Send,
{
    let start = Instant::now();
    let tiles = film.tiles(TILE);
    let pixels = u64::from(film.width()) * u64::from(film.height());
    let count = |film: &Film| -> u64 {
        tiles.iter().map(|t| t.pixels().map(|(x, y)| film.sample_count(x, y)).sum::<u64>()).sum()
    };
    let before = count(film);
    let total = pixels * u64::from(settings.render.spp);
    let done = AtomicU64::new(before);
    let stop = AtomicBool::new(false);
    let mut target = tiles.iter().flat_map(|t| t.pixels()).map(|(x, y)| film.sample_count(x, y)).min().unwrap_or(0);
    while target < u64::from(settings.render.spp) {
        if settings.time.is_some_and(|limit| start.elapsed() >= limit) {
            return End::OutOfTime;
        }
        target = next_target(target, settings, start.elapsed()).min(u64::from(settings.render.spp));
        let shared = Mutex::new((&mut *film, &mut observe));
        tiles.par_iter().for_each(|&tile| {
            if stop.load(Ordering::Relaxed) {
                return;
            }
            let mut pixels = lock(&shared).0.take(tile);
            let added = render_tile(scene, settings, tile, &mut pixels, target);
            let done = done.fetch_add(added, Ordering::Relaxed) + added;
            let mut shared = lock(&shared);
            shared.0.put(pixels);
            let elapsed = start.elapsed();
            let rate = (done - before) as f64 / elapsed.as_secs_f64();
            let left = (rate > 0.0).then(|| Duration::from_secs_f64((total.saturating_sub(done)) as f64 / rate));
            let (film, observe) = &mut *shared;
            if observe(Progress { done, total, elapsed, left }, film).is_break() {
                stop.store(true, Ordering::Relaxed);
            }
        });
        if stop.load(Ordering::Relaxed) {
            return End::Stopped;
        }
    }
    End::Done
}

/// A panic in another thread is on its way to the caller; the film itself is whole between calls.
fn lock<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(std::sync::PoisonError::into_inner)
}

/// Passes double, so that a first picture is there soon; with a time limit they stay short against it.
fn next_target(done: u64, settings: &Settings, elapsed: Duration) -> u64 {
    let double = (done * 2).max(1);
    match settings.time {
        Some(limit) if done > 0 => {
            let per_sample = elapsed.as_secs_f64() / done as f64;
            let affordable = (0.25 * limit.as_secs_f64() / per_sample.max(1e-9)) as u64;
            double.min(done + affordable.max(1))
        }
        _ => double.min(done + 64),
    }
}

/// Brings every pixel of a tile to `target` samples; returns how many were added.
fn render_tile(scene: &Scene, settings: &Settings, tile: Tile, pixels: &mut FilmTile, target: u64) -> u64 {
    let render = &settings.render;
    let layers: Vec<usize> = render.split.iter().filter_map(|name| layer(name)).collect();
    // both halves of the seed count
    let mut sampler = Sampler::new((render.seed ^ (render.seed >> 32).wrapping_mul(0x9e37_79b9)) as u32);
    let mut wave = Wave::new(scene, Limits::of(render));
    let mut splits = vec![[0.0; 3]; layers.len()];
    let missing = |(x, y)| (pixels.sample_count(x, y)..target).map(move |index| (x, y, index as u32));
    let samples: Vec<(u32, u32, u32)> = tile.pixels().flat_map(missing).collect();
    for samples in samples.chunks(WAVE) {
        for &(x, y, index) in samples {
            sampler.start(y * scene.film.width + x, index);
            let [u, v, lens_u, lens_v] = sampler.next4d();
            let [dx, dy] = scene.film.filter.sample([u, v]);
            let ray = scene.camera.ray([x as f32 + 0.5 + dx, y as f32 + 0.5 + dy], [lens_u, lens_v]);
            wave.add(ray, sampler);
        }
        for (&(x, y, _), found) in samples.iter().zip(wave.follow()) {
            for (split, &layer) in splits.iter_mut().zip(&layers) {
                *split = rgb(found.splits[layer].0);
            }
            let aov = if render.aovs { found.aov } else { None };
            pixels.add(x, y, &Sample { radiance: rgb(found.radiance.0), splits: &splits, aov });
        }
    }
    samples.len() as u64
}

fn rgb(c: [f32; CHANNELS]) -> [f32; 3] {
    std::array::from_fn(|i| c[i.min(CHANNELS - 1)])
}
