//! Scene files.

use crate::errors;
use lesk_scene::Scene;
use pyo3::prelude::*;
use std::path::PathBuf;
use std::sync::Arc;

/// A scene that can be rendered.
#[pyclass(frozen, name = "Scene")]
pub struct PyScene(pub Arc<Scene>);

#[pymethods]
impl PyScene {
    /// Reads a scene file and everything that it names.
    #[staticmethod]
    fn load(py: Python<'_>, path: PathBuf) -> PyResult<PyScene> {
        Ok(PyScene(Arc::new(py.detach(|| Scene::load(path)).map_err(errors::scene)?)))
    }

    /// Reads a scene from text; relative file names start at `folder`.
    #[staticmethod]
    fn parse(py: Python<'_>, text: &str, folder: PathBuf) -> PyResult<PyScene> {
        Ok(PyScene(Arc::new(py.detach(|| Scene::parse(text, folder)).map_err(errors::scene)?)))
    }

    #[getter]
    fn title(&self) -> &str {
        &self.0.title
    }

    /// Width and height in pixels.
    #[getter]
    fn size(&self) -> (u32, u32) {
        (self.0.film.width, self.0.film.height)
    }

    #[getter]
    fn ev100(&self) -> Option<f64> {
        self.0.film.ev100
    }

    #[getter]
    fn spp(&self) -> u32 {
        self.0.render.spp
    }

    /// Names of the objects.
    #[getter]
    fn objects(&self) -> Vec<&str> {
        self.0.objects.iter().map(|object| object.name.as_str()).collect()
    }

    /// Name, smallest and largest coordinates (m) of every object, and whether it shines.
    fn boxes(&self) -> Vec<(&str, [f32; 3], [f32; 3], bool)> {
        let scene = &self.0;
        let of = |(i, object): (usize, &'_ lesk_scene::Object)| {
            let bounds = scene.world.geometry_of(i as u32).bounds().transformed(scene.world.place(i as u32));
            (i, bounds.min.to_array(), bounds.max.to_array(), object.light.is_some())
        };
        let named = |(i, min, max, shines): (usize, _, _, _)| (scene.objects[i].name.as_str(), min, max, shines);
        scene.objects.iter().enumerate().map(of).map(named).collect()
    }

    /// Names and models of the materials.
    #[getter]
    fn materials(&self) -> Vec<(&str, &str)> {
        self.0.materials.iter().map(|material| (material.name(), material.model().id())).collect()
    }

    #[getter]
    fn light_count(&self) -> usize {
        self.0.lights.list().len()
    }

    /// What was repaired, converted or left out.
    #[getter]
    fn notes(&self) -> Vec<String> {
        self.0.notes.clone()
    }

    /// The files that the scene was made of.
    #[getter]
    fn files(&self) -> Vec<PathBuf> {
        self.0.files.clone()
    }

    /// The hash of the description and of all files.
    #[getter]
    fn fingerprint(&self) -> String {
        self.0.fingerprint.iter().map(|byte| format!("{byte:02x}")).collect()
    }
}

/// The JSON Schema of scene files.
#[pyfunction]
pub fn scene_schema() -> String {
    lesk_scene::json_schema().to_string()
}
