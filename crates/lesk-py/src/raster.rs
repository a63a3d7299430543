//! Rasterising: one call per frame, and what it took.

use crate::errors;
use crate::render::{PyPicture, terminator};
use crate::scenes::PyScene;
use lesk_geometry::EdgeRule;
use lesk_raster::{Classic, ClassicLight, Frame, Highlight, Raster, Settings};
use lesk_scene::Scene;
use numpy::{IntoPyArray, PyArray2, PyArrayMethods};
use pyo3::prelude::*;
use std::sync::Arc;

/// What a caller chooses, all by name.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct ShadeWishes {
    shading: String,
    interpolation: String,
    correction: String,
    normals: String,
    /// Degrees; without it, edges are as stored.
    crease_angle_deg: Option<f64>,
    tessellation: u32,
    subdivide: u32,
    renormalize: bool,
    supersampling: u32,
    quadrature: u32,
    shadows: bool,
    /// Without it, what the scene says.
    shadow_terminator: Option<String>,
    cull: bool,
    flat_point: String,
    space: String,
    aovs: bool,
    classic: Option<ClassicWishes>,
    threads: Option<usize>,
    frames: u32,
}

/// The classic local model.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct ClassicWishes {
    ambient: [f32; 3],
    diffuse: [f32; 3],
    specular: [f32; 3],
    ka: f32,
    kd: f32,
    ks: f32,
    shininess: f32,
    blinn: bool,
    /// Directions and colours.
    lights: Vec<([f32; 3], [f32; 3])>,
}

impl ShadeWishes {
    fn settings(&self) -> PyResult<Settings> {
        self.chosen().map_err(errors::parameter).and_then(|settings| {
            let shadow_terminator = terminator(self.shadow_terminator.as_deref())?;
            Ok(Settings { shadow_terminator, ..settings })
        })
    }

    fn chosen(&self) -> Result<Settings, lesk_raster::Error> {
        Ok(Settings {
            shading: self.shading.parse()?,
            interpolation: self.interpolation.parse()?,
            correction: self.correction.parse()?,
            normals: self.normals.parse().map_err(|e| lesk_raster::Error::from_text(&e))?,
            edges: self.crease_angle_deg.map_or(EdgeRule::Stored, |a| EdgeRule::Crease(a.to_radians())),
            tessellation: self.tessellation,
            subdivide: self.subdivide,
            renormalize: self.renormalize,
            supersampling: self.supersampling,
            quadrature: self.quadrature,
            shadows: self.shadows,
            shadow_terminator: None,
            cull: self.cull,
            flat_point: self.flat_point.parse()?,
            space: self.space.parse()?,
            classic: self.classic.as_ref().map(ClassicWishes::model),
            aovs: self.aovs,
        })
    }

    /// The settings as attributes of a file.
    fn attributes(&self) -> Vec<(&'static str, String)> {
        let mut out = vec![
            ("engine", "raster".to_owned()),
            ("shading", self.shading.clone()),
            ("interpolation", self.interpolation.clone()),
            ("correction", self.correction.clone()),
            ("normals", self.normals.clone()),
            ("supersampling", self.supersampling.to_string()),
            ("quadrature", self.quadrature.to_string()),
            ("shadows", self.shadows.to_string()),
            ("space", self.space.clone()),
        ];
        out.extend(self.crease_angle_deg.map(|a| ("creaseAngleDeg", a.to_string())));
        out.extend(self.shadow_terminator.clone().map(|name| ("shadowTerminator", name)));
        out
    }
}

impl ClassicWishes {
    fn model(&self) -> Classic {
        Classic {
            ambient: self.ambient,
            diffuse: self.diffuse,
            specular: self.specular,
            ka: self.ka,
            kd: self.kd,
            ks: self.ks,
            shininess: self.shininess,
            highlight: if self.blinn { Highlight::Blinn } else { Highlight::Phong },
            lights: self
                .lights
                .iter()
                .map(|&(direction, color)| ClassicLight { direction: direction.into(), color })
                .collect(),
        }
    }
}

/// Counts of the frame, the times of all frames in ms, warnings, and with AOVs the face of each sample (from 1, 0 is none).
type Facts<'py> = (Vec<(&'static str, u64)>, Vec<f64>, Vec<String>, Option<Bound<'py, PyArray2<u32>>>);

/// Shades a scene; `frames` draws it several times, for their times.
#[pyfunction]
pub fn shade<'py>(py: Python<'py>, scene: &PyScene, wishes: ShadeWishes) -> PyResult<(PyPicture, Facts<'py>)> {
    let settings = wishes.settings()?;
    let scene = scene.0.clone();
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
    let picture = PyPicture::shaded(scene, film, seconds, wishes.attributes());
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
        let settings = wishes.settings()?;
        let scene = scene.0.clone();
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
    let settings = wishes.settings()?;
    let scene = scene.0.clone();
    let world = py.detach(|| Raster::new(scene.clone(), &settings)?.world()).map_err(errors::parameter)?;
    Ok(PyScene(Arc::new(Scene { world, ..(*scene).clone() })))
}

/// The names that settings accept, by setting, the default first.
#[pyfunction]
pub fn shading_names() -> Vec<(&'static str, Vec<&'static str>)> {
    use lesk_raster::{Correction, FlatPoint, Interpolation, Mode, Space};
    vec![
        ("shading", Mode::ALL.iter().map(|x| x.name()).collect()),
        ("interpolation", Interpolation::ALL.iter().map(|x| x.name()).collect()),
        ("correction", Correction::ALL.iter().map(|x| x.name()).collect()),
        ("normals", lesk_geometry::NormalRule::ALL.iter().map(|x| x.name()).collect()),
        ("flat_point", FlatPoint::ALL.iter().map(|x| x.name()).collect()),
        ("space", Space::ALL.iter().map(|x| x.name()).collect()),
    ]
}
