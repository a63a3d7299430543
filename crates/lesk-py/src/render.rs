//! Rendering.

use crate::raster::named;
use crate::scenes::PyScene;
use crate::supervise::{Shared, supervise};
use crate::{errors, image};
use lesk_image::io::{self, Format, exr, png};
use lesk_image::{Film, ImageError, ToneMapper, tonemap};
use lesk_math::Isa;
use lesk_scene::Scene;
use lesk_trace::checkpoint::{self, Identity};
use lesk_trace::{End, Progress, Settings};
use numpy::PyArray3;
use pyo3::prelude::*;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// What a caller may set instead of the scene.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct Wishes {
    spp: Option<u32>,
    /// Seconds after which no pass begins.
    time: Option<f64>,
    seed: Option<u64>,
    max_depth: Option<u32>,
    shadow_terminator: Option<String>,
    split: Option<Vec<String>>,
    aovs: Option<bool>,
    threads: Option<usize>,
    /// Where the exact state is kept, and every how many seconds.
    checkpoint: Option<(PathBuf, f64)>,
    /// Go on from the checkpoint.
    resume: bool,
}

/// A film with what is needed to save it.
#[pyclass(frozen, name = "Picture")]
pub struct PyPicture {
    scene: Arc<Scene>,
    film: Film,
    /// Settings that decided the picture, for the attributes of its files.
    settings: Vec<(&'static str, String)>,
    /// `done`, `out of time`, `stopped`.
    #[pyo3(get)]
    ended: &'static str,
    #[pyo3(get)]
    seconds: f64,
    /// Samples that came from the checkpoint, of all pixels together.
    #[pyo3(get)]
    resumed: u64,
    /// What Python raised meanwhile: KeyboardInterrupt, or an error of the progress function.
    #[pyo3(get)]
    raised: Option<Py<PyAny>>,
}

/// Renders a scene. `progress` is called with samples done and in all, seconds so far and left.
#[pyfunction]
pub fn render(py: Python<'_>, scene: &PyScene, wishes: Wishes, progress: Option<Py<PyAny>>) -> PyResult<PyPicture> {
    let start = Instant::now();
    let scene = scene.0.clone();
    let settings = settings(&scene, &wishes)?;
    let mut film = lesk_trace::film_for(&scene, &settings).map_err(errors::parameter)?;
    let identity = Identity::new(&scene, &settings);
    let mut resumed = 0;
    if let (true, Some((path, _))) = (wishes.resume, &wishes.checkpoint) {
        checkpoint::load(path, &identity, &mut film).map_err(errors::checkpoint)?;
        resumed = sample_count(&film);
    }
    let pool = match wishes.threads {
        Some(n) => Some(rayon::ThreadPoolBuilder::new().num_threads(n).build().map_err(errors::parameter)?),
        None => None,
    };
    let job = Job { scene: &scene, settings: &settings, pool, checkpoint: wishes.checkpoint, identity };
    let (ended, raised) = py.detach(|| job.run(&mut film, progress))?;
    let ended = match ended {
        End::Done => "done",
        End::OutOfTime => "out of time",
        End::Stopped => "stopped",
    };
    let raised = raised.map(|error| error.into_value(py).into_any());
    let seconds = start.elapsed().as_secs_f64();
    let settings = vec![
        ("seed", settings.render.seed.to_string()),
        ("maxDepth", settings.render.max_depth.to_string()),
        ("rouletteDepth", settings.render.roulette_depth.to_string()),
        ("shadowTerminator", settings.render.shadow_terminator.name().to_owned()),
        ("filter", format!("{:?}", scene.film.filter)),
    ];
    Ok(PyPicture { scene: scene.clone(), film, settings, ended, seconds, resumed, raised })
}

fn settings(scene: &Scene, wishes: &Wishes) -> PyResult<Settings> {
    let mut render = scene.render.clone();
    render.spp = wishes.spp.unwrap_or(render.spp);
    render.seed = wishes.seed.unwrap_or(render.seed);
    render.max_depth = wishes.max_depth.unwrap_or(render.max_depth);
    render.aovs = wishes.aovs.unwrap_or(render.aovs);
    render.shadow_terminator = named(wishes.shadow_terminator.as_ref())?.unwrap_or(render.shadow_terminator);
    if let Some(split) = &wishes.split {
        render.split = split.clone();
    }
    let time = wishes.time.map(Duration::try_from_secs_f64).transpose().map_err(errors::parameter)?;
    Ok(Settings { render, time })
}

fn sample_count(film: &Film) -> u64 {
    (0..film.height()).flat_map(|y| (0..film.width()).map(move |x| (x, y))).map(|(x, y)| film.sample_count(x, y)).sum()
}

/// One render.
struct Job<'a> {
    scene: &'a Scene,
    settings: &'a Settings,
    pool: Option<rayon::ThreadPool>,
    checkpoint: Option<(PathBuf, f64)>,
    identity: Identity,
}

impl Job<'_> {
    /// Renders in another thread. Returns how it ended, and what Python raised meanwhile.
    fn run(&self, film: &mut Film, progress: Option<Py<PyAny>>) -> PyResult<(End, Option<PyErr>)> {
        let seconds = |d: Duration| d.as_secs_f64();
        let tell = |py: Python<'_>, now: Progress| match &progress {
            Some(progress) => {
                progress.call1(py, (now.done, now.total, seconds(now.elapsed), now.left.map(seconds))).map(|_| ())
            }
            None => Ok(()),
        };
        let (result, raised) = supervise(|shared| self.trace(film, shared), tell);
        Ok((result.map_err(errors::image)?, raised))
    }

    /// Renders until the end or until it shall stop, and keeps the checkpoint.
    fn trace(&self, film: &mut Film, shared: &Shared<Progress>) -> Result<End, ImageError> {
        let (mut failed, mut saved) = (None, Instant::now());
        let mut observe = |progress: Progress, film: &Film| {
            shared.report(progress);
            if let Some((path, every)) = &self.checkpoint
                && saved.elapsed().as_secs_f64() >= *every
            {
                failed = checkpoint::save(path, &self.identity, film).err();
                saved = Instant::now();
            }
            if failed.is_some() || shared.stopped() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        };
        let end = match &self.pool {
            Some(pool) => pool.install(|| lesk_trace::render(self.scene, self.settings, film, &mut observe)),
            None => lesk_trace::render(self.scene, self.settings, film, &mut observe),
        };
        match (failed, &self.checkpoint) {
            (Some(error), _) => Err(error),
            (None, Some((path, _))) if end != End::Done => {
                checkpoint::save(path, &self.identity, film)?;
                Ok(end)
            }
            _ => Ok(end),
        }
    }
}

#[pymethods]
impl PyPicture {
    /// Linear Rec.709 whose Y is cd/m², shape (height, width, 3).
    fn rgb<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray3<f32>>> {
        image::array(py, py.detach(|| self.film.image()))
    }

    /// All channels by name, shape (height, width).
    fn channels<'py>(&self, py: Python<'py>) -> PyResult<Vec<(String, Bound<'py, PyAny>)>> {
        let planes = py.detach(|| self.film.planes(&[])).map_err(errors::image)?;
        planes.planes().iter().map(|plane| Ok((plane.name.clone(), image::channel(py, &planes, plane)?))).collect()
    }

    /// The exposure that the scene states, or what a meter reads; none for a black picture.
    fn ev100(&self, py: Python<'_>) -> Option<f64> {
        self.scene.film.ev100.or_else(|| py.detach(|| tonemap::meter(&self.film.image())))
    }

    /// Root of the mean variance over the mean luminance.
    #[getter]
    fn relative_error(&self) -> Option<f64> {
        self.film.relative_error()
    }

    /// Samples whose light was not finite.
    #[getter]
    fn rejected(&self) -> u64 {
        self.film.rejected()
    }

    #[getter]
    fn size(&self) -> (u32, u32) {
        (self.film.width(), self.film.height())
    }

    /// Settings that decided the picture, as the attributes of its files.
    fn attributes(&self) -> Vec<(&'static str, String)> {
        let fingerprint: String = self.scene.fingerprint.iter().map(|byte| format!("{byte:02x}")).collect();
        let mut out = vec![
            ("software", format!("lesk {}", env!("CARGO_PKG_VERSION"))),
            ("instructionSet", Isa::current().name().to_owned()),
            ("scene", self.scene.title.clone()),
            ("sceneHash", fingerprint),
            ("spectra", self.scene.spectra.join(", ")),
        ];
        out.extend(self.settings.iter().cloned());
        out
    }

    /// Writes the picture; EXR holds all channels, PNG is exposed and tone mapped.
    fn save(&self, py: Python<'_>, path: PathBuf, ev100: Option<f64>, mapper: &str) -> PyResult<()> {
        let mapper: ToneMapper = mapper.parse().map_err(errors::parameter)?;
        py.detach(|| self.write(&path, ev100, mapper)).map_err(errors::image)
    }
}

impl PyPicture {
    /// A picture that was made without chance.
    pub fn shaded(scene: Arc<Scene>, film: Film, seconds: f64, settings: Vec<(&'static str, String)>) -> Self {
        PyPicture { scene, film, settings, ended: "done", seconds, resumed: 0, raised: None }
    }

    fn write(&self, path: &Path, ev100: Option<f64>, mapper: ToneMapper) -> Result<(), ImageError> {
        let mut attributes = self.attributes();
        if let Some(ev100) = ev100 {
            attributes.push(("ev100", ev100.to_string()));
        }
        let attributes: Vec<(&str, &str)> = attributes.iter().map(|(k, v)| (*k, v.as_str())).collect();
        match Format::of_name(path) {
            Some(Format::Exr) => exr::write(path, &self.film.planes(&attributes)?),
            Some(Format::Png) => {
                let shown = tonemap::develop(&self.film.image(), ev100.unwrap_or(0.0), mapper);
                let bytes = png::encode(&shown, png::Depth::Eight, &attributes).map_err(|error| error.at(path))?;
                io::write_bytes(path, &bytes)
            }
            _ => io::write(path, &self.film.image()),
        }
    }
}
