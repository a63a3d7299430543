//! Python bindings: conversion only, no logic. The Python package `lesk` gives them their public face.

mod arrays;
mod checks;
mod draws;
mod errors;
mod image;
mod light;
mod measure;
mod meshes;
mod models;
mod quantities;
mod raster;
mod render;
mod scenes;
mod shaders;
mod skies;
mod supervise;
mod terms;

use pyo3::prelude::*;

/// The compiled core of the package `lesk`.
#[pymodule]
mod _lesk {
    #[pymodule_export]
    use crate::arrays::find_numpy;
    #[pymodule_export]
    use crate::checks::{check_html, check_json};
    #[pymodule_export]
    use crate::draws::{draw, sobol};
    #[pymodule_export]
    use crate::image::{develop, false_color, meter, read_image, read_planes, tone_mappers, write_image, write_planes};
    #[pymodule_export]
    use crate::light::{PyPhotometry, ugr_rooms};
    #[pymodule_export]
    use crate::measure::{PyMeasured, measure_scene, measure_tasks};
    #[pymodule_export]
    use crate::meshes::{mesh_edges, mesh_report_json};
    #[pymodule_export]
    use crate::models::{delta, evaluate, gradient, registry_json};
    #[pymodule_export]
    use crate::quantities::{
        PySpectrum, blackbody_share_below, observer, quantity_convert, quantity_dimensions, quantity_options,
        quantity_parse, quantity_units, reflectance, rgb_convert, rgb_spaces, rgb_to_xyz, spectrum_names, xyz_to_rgb,
    };
    #[pymodule_export]
    use crate::raster::{PyRaster, classic_defaults, shade, shaded_surfaces, shading_names};
    #[pymodule_export]
    use crate::render::{PyPicture, render};
    #[pymodule_export]
    use crate::scenes::{PyScene, scene_schema};
    #[pymodule_export]
    use crate::shaders::{shader, shader_languages};
    #[pymodule_export]
    use crate::skies::PyHosekSky;
    #[pymodule_export]
    use crate::terms::{term, terms_json};

    use lesk_math::Isa;
    use pyo3::prelude::*;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        crate::require_instruction_set()?;
        module.add("__version__", env!("CARGO_PKG_VERSION"))?;
        module.add("isa", Isa::current().name())
    }
}

/// `LESK_ISA` may ask for an instruction set that this processor lacks: better an error on import than a panic later.
fn require_instruction_set() -> PyResult<()> {
    let available: Vec<_> = lesk_math::Isa::ALL.iter().filter(|isa| isa.is_available()).map(|isa| isa.name()).collect();
    match std::env::var("LESK_ISA") {
        Ok(name) if !available.contains(&name.as_str()) => {
            let accepted = available.join(", ");
            Err(errors::parameter(format!("`LESK_ISA` is `{name}`, but this processor accepts {accepted}")))
        }
        _ => Ok(()),
    }
}

/// A Python `ValueError` with the given text: wrong use of this module by the package, not by its user.
fn value_error(text: impl std::fmt::Display) -> PyErr {
    pyo3::exceptions::PyValueError::new_err(text.to_string())
}
