//! Rasterising: one call per frame, and what it took.

use crate::errors;
use crate::render::PyPicture;
use crate::scenes::PyScene;
use lesk_geometry::{EdgeRule, NormalRule};
use lesk_raster::{
    Classic, ClassicLight, Correction, FlatPoint, Frame, Highlight, Interpolation, Mode, Raster, Settings, Space,
};
use lesk_scene::{Scene, ShadowTerminator};
use numpy::{IntoPyArray, PyArray2, PyArrayMethods};
use pyo3::prelude::*;
use std::fmt::Display;
use std::str::FromStr;
use std::sync::Arc;

/// What a caller chooses instead of the scene, all by name.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct ShadeWishes {
    shading: Option<String>,
    interpolation: Option<String>,
    correction: Option<String>,
    normals: Option<String>,
    crease_angle_deg: Option<CreaseWish>,
    tessellation: Option<u32>,
    subdivide: Option<u32>,
    renormalize: Option<bool>,
    supersampling: Option<u32>,
    quadrature: Option<u32>,
    shadows: Option<bool>,
    shadow_terminator: Option<String>,
    cull: Option<bool>,
    flat_point: Option<String>,
    space: Option<String>,
    aovs: Option<bool>,
    classic: Option<ClassicWish>,
    threads: Option<usize>,
    frames: u32,
}

/// The crease angle.
#[derive(FromPyObject)]
enum CreaseWish {
    /// Degrees.
    Angle(f64),
    /// `stored`: edges are as the mesh stores them.
    Word(String),
}

/// The classic local model.
#[derive(FromPyObject)]
enum ClassicWish {
    /// False: the materials of the scene.
    Wanted(bool),
    Model(ClassicWishes),
}

/// Its numbers.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
struct ClassicWishes {
    ambient: [f32; 3],
    diffuse: [f32; 3],
    specular: [f32; 3],
    ka: f32,
    kd: f32,
    ks: f32,
    shininess: f32,
    highlight: String,
    /// Directions and colours.
    lights: Vec<([f32; 3], [f32; 3])>,
}

/// What a name stands for, if one is given.
pub(crate) fn named<T: FromStr<Err: Display>>(name: Option<&String>) -> PyResult<Option<T>> {
    name.map(|name| name.parse().map_err(errors::parameter)).transpose()
}

impl ShadeWishes {
    /// The settings of the scene with these wishes.
    fn settings(&self, scene: &Scene) -> PyResult<Settings> {
        let usual = scene.raster.clone();
        Ok(Settings {
            shading: named(self.shading.as_ref())?.unwrap_or(usual.shading),
            interpolation: named(self.interpolation.as_ref())?.unwrap_or(usual.interpolation),
            correction: named(self.correction.as_ref())?.unwrap_or(usual.correction),
            normals: named(self.normals.as_ref())?.unwrap_or(usual.normals),
            edges: self.crease_angle_deg.as_ref().map_or(Ok(usual.edges), CreaseWish::rule)?,
            tessellation: self.tessellation.unwrap_or(usual.tessellation),
            subdivide: self.subdivide.unwrap_or(usual.subdivide),
            renormalize: self.renormalize.unwrap_or(usual.renormalize),
            supersampling: self.supersampling.unwrap_or(usual.supersampling),
            quadrature: self.quadrature.unwrap_or(usual.quadrature),
            shadows: self.shadows.unwrap_or(usual.shadows),
            shadow_terminator: named(self.shadow_terminator.as_ref())?.or(usual.shadow_terminator),
            cull: self.cull.unwrap_or(usual.cull),
            flat_point: named(self.flat_point.as_ref())?.unwrap_or(usual.flat_point),
            space: named(self.space.as_ref())?.unwrap_or(usual.space),
            aovs: self.aovs.unwrap_or(usual.aovs),
            classic: match &self.classic {
                None => usual.classic,
                Some(ClassicWish::Wanted(wanted)) => wanted.then(Classic::default),
                Some(ClassicWish::Model(wishes)) => Some(wishes.model()?),
            },
        })
    }
}

/// The settings as attributes of a file.
fn attributes(settings: &Settings, scene: &Scene) -> Vec<(&'static str, String)> {
    let terminator = settings.shadow_terminator.unwrap_or(scene.render.shadow_terminator);
    let mut out = vec![
        ("engine", "raster".to_owned()),
        ("shading", settings.shading.name().to_owned()),
        ("interpolation", settings.interpolation.name().to_owned()),
        ("correction", settings.correction.name().to_owned()),
        ("normals", settings.normals.name().to_owned()),
        ("supersampling", settings.supersampling.to_string()),
        ("quadrature", settings.quadrature.to_string()),
        ("shadows", settings.shadows.to_string()),
        ("space", settings.space.name().to_owned()),
        ("shadowTerminator", terminator.name().to_owned()),
    ];
    if let EdgeRule::Crease(angle) = settings.edges {
        out.push(("creaseAngleDeg", angle.to_degrees().to_string()));
    }
    out
}

impl CreaseWish {
    fn rule(&self) -> PyResult<EdgeRule> {
        match self {
            Self::Angle(deg) => Ok(EdgeRule::Crease(deg.to_radians())),
            Self::Word(word) if word == "stored" => Ok(EdgeRule::Stored),
            Self::Word(word) => {
                Err(errors::parameter(format!("crease angle is `{word}`, but degrees or `stored` are accepted")))
            }
        }
    }
}

impl ClassicWishes {
    fn model(&self) -> PyResult<Classic> {
        Ok(Classic {
            ambient: self.ambient,
            diffuse: self.diffuse,
            specular: self.specular,
            ka: self.ka,
            kd: self.kd,
            ks: self.ks,
            shininess: self.shininess,
            highlight: self.highlight.parse().map_err(errors::parameter)?,
            lights: self
                .lights
                .iter()
                .map(|&(direction, color)| ClassicLight { direction: direction.into(), color })
                .collect(),
        })
    }
}

/// Counts of the frame, the times of all frames in ms, warnings, and with AOVs the face of each sample (from 1, 0 is none).
type Facts<'py> = (Vec<(&'static str, u64)>, Vec<f64>, Vec<String>, Option<Bound<'py, PyArray2<u32>>>);

/// Shades a scene; `frames` draws it several times, for their times.
#[pyfunction]
pub fn shade<'py>(py: Python<'py>, scene: &PyScene, wishes: ShadeWishes) -> PyResult<(PyPicture, Facts<'py>)> {
    let scene = scene.0.clone();
    let settings = wishes.settings(&scene)?;
    let pool = match wishes.threads {
        Some(n) => Some(rayon::ThreadPoolBuilder::new().num_threads(n).build().map_err(errors::parameter)?),
        None => None,
    };
    let job = || draw(&scene, &settings, wishes.frames);
    let (frame, times, warnings) = py
        .detach(|| match &pool {
            Some(pool) => pool.install(job),
            None => job(),
        })
        .map_err(errors::parameter)?;
    let film = py.detach(|| frame.film()).map_err(errors::image)?;
    let count = frame.work;
    let seconds = count.elapsed.as_secs_f64();
    let counts = vec![
        ("faces", count.faces),
        ("drawn", count.drawn),
        ("vertices", count.vertices),
        ("samples", count.samples),
        ("evaluations", count.evaluations),
    ];
    let attributes = attributes(&settings, &scene);
    let picture = PyPicture::shaded(scene, film, seconds, attributes);
    let number = |h: &Option<lesk_raster::SampleHit>| h.map_or(0, |h| h.face + 1);
    let faces = match frame.hits.is_empty() {
        true => None,
        false => {
            let shape = [frame.height as usize, frame.width as usize];
            Some(frame.hits.iter().map(number).collect::<Vec<u32>>().into_pyarray(py).reshape(shape)?)
        }
    };
    Ok((picture, (counts, times, warnings, faces)))
}

type Drawn = (Frame, Vec<f64>, Vec<String>);

fn draw(scene: &Arc<Scene>, settings: &Settings, frames: u32) -> Result<Drawn, lesk_raster::Error> {
    let mut raster = Raster::new(scene.clone(), settings)?;
    let mut frame = raster.frame();
    let mut times = vec![frame.work.elapsed.as_secs_f64() * 1e3];
    for _ in 1..frames {
        raster.draw(&mut frame);
        times.push(frame.work.elapsed.as_secs_f64() * 1e3);
    }
    let warnings = raster.warnings();
    Ok((frame, times, warnings))
}

/// A scene made ready once, to be drawn often.
#[pyclass(name = "Raster")]
pub struct PyRaster {
    raster: Raster,
    frame: Frame,
    /// One thread.
    pool: rayon::ThreadPool,
}

#[pymethods]
impl PyRaster {
    #[new]
    fn new(py: Python<'_>, scene: &PyScene, wishes: ShadeWishes) -> PyResult<Self> {
        let scene = scene.0.clone();
        let settings = wishes.settings(&scene)?;
        let raster = py.detach(|| Raster::new(scene, &settings)).map_err(errors::parameter)?;
        let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().map_err(errors::parameter)?;
        Ok(PyRaster { raster, frame: Frame::default(), pool })
    }

    /// Draws a frame in one thread; returns how many samples a face covers.
    fn draw(&mut self, py: Python<'_>) -> u64 {
        let PyRaster { raster, frame, pool } = self;
        py.detach(|| pool.install(|| raster.draw(frame)));
        frame.work.samples
    }
}

/// The scene with its surfaces as the rasteriser sees them: faces and normals are those of the settings.
#[pyfunction]
pub fn shaded_surfaces(py: Python<'_>, scene: &PyScene, wishes: ShadeWishes) -> PyResult<PyScene> {
    let scene = scene.0.clone();
    let settings = wishes.settings(&scene)?;
    let world = py.detach(|| Raster::new(scene.clone(), &settings)?.world()).map_err(errors::parameter)?;
    Ok(PyScene(Arc::new(Scene { world, ..(*scene).clone() })))
}

/// The names that settings accept, by setting, the default first.
#[pyfunction]
pub fn shading_names() -> Vec<(&'static str, Vec<&'static str>)> {
    vec![
        ("shading", Mode::NAMES.to_vec()),
        ("interpolation", Interpolation::NAMES.to_vec()),
        ("correction", Correction::NAMES.to_vec()),
        ("normals", NormalRule::NAMES.to_vec()),
        ("flat_point", FlatPoint::NAMES.to_vec()),
        ("space", Space::NAMES.to_vec()),
        ("shadow_terminator", ShadowTerminator::NAMES.to_vec()),
        ("highlight", Highlight::NAMES.to_vec()),
    ]
}

/// The classic local model as it is without wishes: colours, coefficients and exponent, highlight.
#[pyfunction]
pub fn classic_defaults() -> ([[f32; 3]; 3], [f32; 4], &'static str) {
    let Classic { ambient, diffuse, specular, ka, kd, ks, shininess, highlight, lights: _ } = Classic::default();
    ([ambient, diffuse, specular], [ka, kd, ks, shininess], highlight.name())
}
