//! Python bindings: conversion only, no logic. The Python package `lesk` gives them their public face.

mod models;

use pyo3::prelude::*;

/// The compiled core of the package `lesk`.
#[pymodule]
mod _lesk {
    #[pymodule_export]
    use crate::models::{batch_f32, batch_f64, gradient, registry_json};

    use pyo3::prelude::*;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))?;
        module.add("isa", lesk_math::Isa::current().name())
    }
}

/// A Python `ValueError` with the given text.
fn value_error(text: impl std::fmt::Display) -> PyErr {
    pyo3::exceptions::PyValueError::new_err(text.to_string())
}
