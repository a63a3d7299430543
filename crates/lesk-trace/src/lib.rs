//! Path tracing: a scene becomes a film.
//!
//! [`render`] traces paths from the camera, asks lights directly at every rough surface and weighs both ways of finding
//! light (multiple importance sampling). Many lights are chosen through a tree; dim paths end by Russian roulette; delta
//! lobes and transmission are followed. [`checkpoint`] saves and restores exactly. [`measure`] reads illuminance, luminance
//! and glare at the sensors of a scene, with their standard errors.
//!
//! It does not denoise, does not clamp, and knows no model by name.

pub mod checkpoint;
mod group;
mod lobes;
pub mod measure;
mod path;
mod render;
mod split;
mod wave;

pub use render::{End, FilmError, Progress, Settings, film_for, render};
pub use split::SPLIT_NAMES;

use lesk_geometry::Ray;
use lesk_math::sobol::Sampler;
use lesk_scene::{RenderSettings, Scene};

/// Light along one camera ray, linear Rec.709 whose Y is cd/m²: one path, with the random numbers of `sampler`.
pub fn radiance(scene: &Scene, settings: &RenderSettings, ray: Ray, sampler: Sampler) -> [f32; 3] {
    let mut wave = wave::Wave::new(scene, path::Limits::of(settings));
    wave.add(ray, sampler);
    let light = wave.follow()[0].radiance;
    std::array::from_fn(|c| light.0[c.min(lesk_math::CHANNELS - 1)])
}
