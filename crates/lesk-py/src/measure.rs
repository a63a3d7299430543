//! Measuring at the sensors of a scene.

use crate::errors;
use crate::scenes::PyScene;
use crate::supervise::supervise;
use lesk_scene::sensor::{Form, MAX_PROBES, Sensor};
use lesk_scene::{TASK_EDITION, Task, tasks};
use lesk_trace::End;
use lesk_trace::measure::{self, Glare, Progress, REPLICATES, Reading, SensorReadings, Settings};
use numpy::{IntoPyArray, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

/// What a caller may set instead of the scene.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct MeasureWishes {
    error: Option<f64>,
    time: Option<f64>,
    seed: Option<u64>,
    max_depth: Option<u32>,
    max_samples: Option<u64>,
    threads: Option<usize>,
    /// Names of sensors; all where absent.
    sensors: Option<Vec<String>>,
    /// Instead of the sensors: a camera of the scene's own view, width and height in pixels, and whether it reads the
    /// illuminance of surfaces.
    camera: Option<(u32, u32, bool)>,
}

/// Readings with how they came about.
#[pyclass(frozen, name = "Measured")]
pub struct PyMeasured {
    sensors: Vec<(Sensor, SensorReadings)>,
    settings: Settings,
    maintenance_factor: f64,
    lights: Vec<String>,
    #[pyo3(get)]
    ended: &'static str,
    #[pyo3(get)]
    seconds: f64,
    /// What Python raised meanwhile: KeyboardInterrupt, or an error of the progress function.
    #[pyo3(get)]
    raised: Option<Py<PyAny>>,
}

/// Measures. `progress` is called with the share done, finished and all readings, and seconds so far.
#[pyfunction]
pub fn measure_scene(
    py: Python<'_>,
    scene: &PyScene,
    wishes: MeasureWishes,
    progress: Option<Py<PyAny>>,
) -> PyResult<PyMeasured> {
    let start = Instant::now();
    let scene = scene.0.clone();
    let settings = settings(&scene, &wishes)?;
    let sensors = sensors(&scene, &wishes)?;
    let pool = match wishes.threads {
        Some(n) => Some(rayon::ThreadPoolBuilder::new().num_threads(n).build().map_err(errors::parameter)?),
        None => None,
    };
    let tell = |py: Python<'_>, now: Progress| match &progress {
        Some(progress) => {
            let [finished, total] = now.readings;
            progress.call1(py, (now.done, finished, total, now.elapsed.as_secs_f64())).map(|_| ())
        }
        None => Ok(()),
    };
    let ((readings, end), raised) = py.detach(|| {
        let work = |shared: &crate::supervise::Shared<Progress>| {
            let observe = |now: Progress| {
                shared.report(now);
                if shared.stopped() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
            };
            let measure = || measure::measure_sensors(&scene, &sensors, &settings, observe);
            match &pool {
                Some(pool) => pool.install(measure),
                None => measure(),
            }
        };
        supervise(work, tell)
    });
    let ended = match end {
        End::Done => "done",
        End::OutOfTime => "out of time",
        End::Stopped => "stopped",
    };
    Ok(PyMeasured {
        sensors: sensors.into_iter().zip(readings).collect(),
        settings,
        maintenance_factor: scene.measure.maintenance_factor,
        lights: light_names(&scene),
        ended,
        seconds: start.elapsed().as_secs_f64(),
        raised: raised.map(|error| error.into_value(py).into_any()),
    })
}

fn settings(scene: &lesk_scene::Scene, wishes: &MeasureWishes) -> PyResult<Settings> {
    let mut settings = Settings::of(scene);
    settings.error = wishes.error.unwrap_or(settings.error);
    if !(settings.error > 0.0 && settings.error <= 1.0) {
        return Err(errors::parameter(format!(
            "`error` is {}, but a relative standard error above 0 and up to 1 is accepted\nhint: 0.01 is 1 %",
            settings.error
        )));
    }
    settings.seed = wishes.seed.unwrap_or(settings.seed);
    settings.max_depth = wishes.max_depth.unwrap_or(settings.max_depth);
    settings.max_samples = wishes.max_samples.unwrap_or(settings.max_samples);
    settings.time = wishes.time.map(Duration::try_from_secs_f64).transpose().map_err(errors::parameter)?;
    Ok(settings)
}

fn sensors(scene: &lesk_scene::Scene, wishes: &MeasureWishes) -> PyResult<Vec<Sensor>> {
    if let Some((width, height, illuminance)) = wishes.camera {
        if width == 0 || height == 0 || (width as usize).saturating_mul(height as usize) > MAX_PROBES {
            let text = format!("the picture has {width} x {height} pixels, but 1 to {MAX_PROBES} are accepted");
            return Err(errors::parameter(text));
        }
        return Ok(vec![Sensor::view_of(&scene.camera, [width, height], illuminance)]);
    }
    let Some(names) = &wishes.sensors else { return Ok(scene.sensors.clone()) };
    let find = |name: &String| {
        scene.sensors.iter().find(|s| s.name == *name).cloned().ok_or_else(|| {
            let known: Vec<_> = scene.sensors.iter().map(|s| format!("`{}`", s.name)).collect();
            errors::parameter(format!("there is no sensor `{name}`, but {}", known.join(", ")))
        })
    };
    names.iter().map(find).collect()
}

/// What each light is called: the object that shines, else its number.
fn light_names(scene: &lesk_scene::Scene) -> Vec<String> {
    let mut names: Vec<String> = (0..scene.lights.list().len()).map(|i| format!("light {}", i + 1)).collect();
    for object in &scene.objects {
        if let Some(light) = object.light
            && !object.name.is_empty()
        {
            names[light as usize].clone_from(&object.name);
        }
    }
    names
}

#[pymethods]
impl PyMeasured {
    /// One dictionary per sensor; arrays have the shape of the sensor.
    fn sensors<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyDict>>> {
        self.sensors.iter().map(|(sensor, readings)| self.dict(py, sensor, readings)).collect()
    }

    #[getter]
    fn maintenance_factor(&self) -> f64 {
        self.maintenance_factor
    }

    /// What decided the numbers.
    fn settings<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let dict = PyDict::new(py);
        dict.set_item("error", self.settings.error)?;
        dict.set_item("max_depth", self.settings.max_depth)?;
        dict.set_item("roulette_depth", self.settings.roulette_depth)?;
        dict.set_item("seed", self.settings.seed)?;
        dict.set_item("replicates", REPLICATES)?;
        Ok(dict)
    }
}

impl PyMeasured {
    fn dict<'py>(&self, py: Python<'py>, sensor: &Sensor, found: &SensorReadings) -> PyResult<Bound<'py, PyDict>> {
        let dict = PyDict::new(py);
        let factor = sensor.quantity.per_lumen();
        let shape = sensor.shape();
        let column = |of: fn(&Reading) -> f64| {
            found.readings.iter().map(|r| of(r) * factor).collect::<Vec<f64>>().into_pyarray(py).reshape(shape)
        };
        dict.set_item("name", &sensor.name)?;
        dict.set_item("form", form_name(&sensor.form))?;
        dict.set_item("unit", sensor.unit())?;
        dict.set_item("conversion", sensor.quantity.conversion())?;
        dict.set_item("value", column(|r| r.value)?)?;
        dict.set_item("standard_error", column(|r| r.standard_error)?)?;
        dict.set_item("half_interval", column(Reading::half_interval)?)?;
        dict.set_item("direct", column(|r| r.direct)?)?;
        dict.set_item("indirect", column(|r| r.indirect)?)?;
        let samples: Vec<u64> = found.readings.iter().map(|r| r.samples).collect();
        dict.set_item("samples", samples.into_pyarray(py).reshape(shape)?)?;
        let places: Vec<f64> = sensor.probes().iter().flat_map(|p| p.position.to_array()).collect();
        dict.set_item("positions", places.into_pyarray(py).reshape([shape[0], shape[1], 3])?)?;
        let limits = sensor.limits();
        dict.set_item("limits", (limits.mean, limits.uniformity, limits.ugr))?;
        dict.set_item("task", sensor.task.map(|t| (t.id.as_str(), t.name.as_str())))?;
        dict.set_item("glare", found.glare.as_ref().map(|g| self.glare(py, g)).transpose()?)?;
        Ok(dict)
    }

    fn glare<'py>(&self, py: Python<'py>, glare: &Glare) -> PyResult<Bound<'py, PyDict>> {
        let dict = PyDict::new(py);
        dict.set_item("ugr", glare.ugr)?;
        dict.set_item("standard_error", glare.standard_error)?;
        dict.set_item("background", glare.background)?;
        dict.set_item("left_out", glare.left_out)?;
        let sources = glare.sources.iter().map(|s| {
            let source = PyDict::new(py);
            source.set_item("light", &self.lights[s.light as usize])?;
            source.set_item("luminance", s.luminance)?;
            source.set_item("solid_angle", s.solid_angle)?;
            source.set_item("position_index", s.position_index)?;
            Ok(source)
        });
        dict.set_item("sources", sources.collect::<PyResult<Vec<_>>>()?)?;
        Ok(dict)
    }
}

fn form_name(form: &Form) -> &'static str {
    match form {
        Form::Point { .. } => "point",
        Form::Line { .. } => "line",
        Form::Grid { .. } => "grid",
        Form::Luminance { .. } => "luminance",
        Form::Camera { .. } => "camera",
        Form::Glare { .. } => "glare",
    }
}

/// Id, name, lx, UGR, U0, Ra.
type TaskRow = (&'static str, &'static str, f64, Option<f64>, Option<f64>, Option<f64>);

/// The rows of EN 12464-1, and the editions that they come from.
#[pyfunction]
pub fn measure_tasks() -> (Vec<TaskRow>, &'static str) {
    let row =
        |t: &'static Task| (t.id.as_str(), t.name.as_str(), t.illuminance, t.ugr, t.uniformity, t.color_rendering);
    (tasks().iter().map(row).collect(), TASK_EDITION)
}
