//! Measuring: illuminance, luminance and glare at the sensors of a scene, with standard errors.
//!
//! Every reading is an unbiased Monte Carlo estimate: each sample asks the lights directly, draws one direction, and
//! follows a path from there; both ways of finding a light are weighed (multiple importance sampling). The samples of a
//! reading are [`REPLICATES`] independently scrambled Sobol sequences. Their scatter gives the standard error, so that it
//! counts what stratification gains; sampling goes on, reading by reading, until the wished relative error is reached.
//! Readings are independent of each other: they share no paths.

mod glare;
mod receiver;
mod rounds;

pub use glare::{Glare, GlareSource, guth_position_index};

use crate::path::Limits;
use crate::render::End;
use lesk_scene::sensor::{Form, Sensor};
use lesk_scene::{Scene, ShadowTerminator};
use rounds::Batch;
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

/// Independent sequences behind every reading.
pub const REPLICATES: usize = 32;

/// Student's t for a two-sided 95 % interval with 31 degrees of freedom (R: `qt(0.975, 31)`).
const T_95: f64 = 2.0395134464;

/// Readings that are worked on at once: bounds the memory of a camera.
const CHUNK: usize = 1 << 14;

/// How to measure.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// Relative standard error that every reading shall reach.
    pub error: f64,
    /// Most reflections of a path.
    pub max_depth: u32,
    /// Reflections after which a path may end by Russian roulette.
    pub roulette_depth: u32,
    /// Seed of the random numbers.
    pub seed: u64,
    /// Stop sampling after this time; what is not finished has a larger error.
    pub time: Option<Duration>,
    /// Most samples of a reading.
    pub max_samples: u64,
    /// Where rays to lights start on faces with interpolated normals.
    pub shadow_terminator: ShadowTerminator,
}

impl Settings {
    /// What the scene says.
    pub fn of(scene: &Scene) -> Settings {
        Settings {
            error: scene.measure.error,
            max_depth: scene.measure.max_depth,
            roulette_depth: scene.render.roulette_depth,
            seed: scene.render.seed,
            time: None,
            max_samples: 1 << 28,
            shadow_terminator: scene.render.shadow_terminator,
        }
    }

    fn limits(&self) -> Limits {
        let raises = self.shadow_terminator == ShadowTerminator::Hanika;
        Limits { max_depth: self.max_depth, roulette_depth: self.roulette_depth, raises }
    }
}

/// One reading, lx or cd/m².
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Reading {
    /// The estimate.
    pub value: f64,
    /// Its standard error.
    pub standard_error: f64,
    /// Light that came straight from a light.
    pub direct: f64,
    /// Light that was reflected or refracted on the way.
    pub indirect: f64,
    /// The standard error of `indirect`.
    pub indirect_error: f64,
    /// Samples behind it; 0 where there was no time.
    pub samples: u64,
}

impl Reading {
    /// Half the width of the 95 % interval around the value (Student's t with 31 degrees of freedom).
    pub fn half_interval(&self) -> f64 {
        T_95 * self.standard_error
    }
}

/// What a sensor reads.
#[derive(Clone, Debug, PartialEq)]
pub struct SensorReadings {
    /// The readings, row by row.
    pub readings: Vec<Reading>,
    /// The glare of a glare sensor, whose reading is the vertical illuminance at the eye.
    pub glare: Option<Glare>,
}

/// How far measuring is.
#[derive(Clone, Copy, Debug)]
pub struct Progress {
    /// Estimated share of the work that is done, 0 to 1.
    pub done: f64,
    /// Readings that have reached their error, and all readings.
    pub readings: [usize; 2],
    /// Time so far.
    pub elapsed: Duration,
}

/// Measures at all sensors of the scene.
///
/// The numbers are the same bits for any number of threads; a time limit or a stop leaves readings with larger errors.
/// `observe` is called from one thread at a time and may stop the work.
pub fn measure<F>(scene: &Scene, settings: &Settings, observe: F) -> (Vec<SensorReadings>, End)
where
    F: FnMut(Progress) -> ControlFlow<()> + Send,
{
    measure_sensors(scene, &scene.sensors, settings, observe)
}

/// Measures at the given sensors, which need not be those of the scene.
pub fn measure_sensors<F>(
    scene: &Scene,
    sensors: &[Sensor],
    settings: &Settings,
    mut observe: F,
) -> (Vec<SensorReadings>, End)
where
    F: FnMut(Progress) -> ControlFlow<()> + Send,
{
    let start = Instant::now();
    let probes: Vec<Vec<_>> = sensors.iter().map(Sensor::probes).collect();
    let total = probes.iter().map(Vec::len).sum::<usize>();
    let all: Vec<_> = probes.iter().flatten().copied().collect();
    let (mut readings, mut end) = (Vec::with_capacity(total), End::Done);
    for (number, chunk) in all.chunks(CHUNK).enumerate() {
        let mut batch = Batch::new(scene, settings, chunk, (number * CHUNK) as u32, start);
        if end == End::Done {
            let before = readings.len();
            end = batch.run(|share, finished| {
                let done = (before as f64 + share * chunk.len() as f64) / total as f64;
                observe(Progress { done, readings: [before + finished, total], elapsed: start.elapsed() })
            });
        }
        readings.extend(batch.readings());
    }
    let mut rest = readings.into_iter();
    let by_sensor = |(sensor, probes): (&Sensor, &Vec<_>)| {
        let readings: Vec<Reading> = rest.by_ref().take(probes.len()).collect();
        let glare = match &sensor.form {
            Form::Glare { position, direction, up } => {
                Some(glare::glare(scene, *position, *direction, *up, &readings[0]))
            }
            _ => None,
        };
        SensorReadings { readings, glare }
    };
    (sensors.iter().zip(&probes).map(by_sensor).collect(), end)
}
