//! Errors of the crates as exceptions of `lesk.errors`, with the same texts.

use lesk_image::ImageError as ImageFailure;
use lesk_scene::SceneError as SceneFailure;
use lesk_trace::checkpoint::CheckpointError as CheckpointFailure;
use pyo3::prelude::*;

pyo3::import_exception!(lesk.errors, CheckpointError);
pyo3::import_exception!(lesk.errors, FileError);
pyo3::import_exception!(lesk.errors, ImageError);
pyo3::import_exception!(lesk.errors, LightError);
pyo3::import_exception!(lesk.errors, ParameterError);
pyo3::import_exception!(lesk.errors, SceneError);

/// A parameter or name that is not accepted.
pub fn parameter(error: impl std::fmt::Display) -> PyErr {
    ParameterError::new_err(error.to_string())
}

/// A file that cannot be opened, read or written is another matter than one that is damaged.
pub fn image(error: ImageFailure) -> PyErr {
    let text = error.to_string();
    match error {
        ImageFailure::Read { .. } | ImageFailure::Write { .. } => FileError::new_err(text),
        _ => ImageError::new_err(text),
    }
}

/// A light or a luminaire file that is not accepted.
pub fn light(error: lesk_light::LightError) -> PyErr {
    LightError::new_err(error.to_string())
}

/// All problems of a scene.
pub fn scene(error: SceneFailure) -> PyErr {
    SceneError::new_err(error.to_string())
}

/// A checkpoint that cannot be used.
pub fn checkpoint(error: CheckpointFailure) -> PyErr {
    let text = error.to_string();
    match error {
        CheckpointFailure::Io(_) => FileError::new_err(text),
        _ => CheckpointError::new_err(text),
    }
}
