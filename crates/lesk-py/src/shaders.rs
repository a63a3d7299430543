//! Shader source.

use crate::errors;
use crate::models::find;
use lesk_shader::{Language, Math, Options, Part, Product, Source, export};
use pyo3::prelude::*;
use pyo3::types::PyBytes;

/// The names of the languages, and the usual ending of a file of each.
#[pyfunction]
pub fn shader_languages() -> Vec<(&'static str, &'static str)> {
    Language::ALL.iter().map(|language| (language.name(), language.extension())).collect()
}

/// The source of some functions of a model: text, or bytes for SPIR-V.
#[pyfunction]
pub fn shader<'py>(
    py: Python<'py>,
    id: &str,
    language: &str,
    parts: Vec<String>,
    exact: bool,
    complete: bool,
) -> PyResult<Bound<'py, PyAny>> {
    let model = find(id)?;
    let language: Language = language.parse().map_err(errors::parameter)?;
    let parts: Vec<Part> =
        parts.iter().map(|part| part.parse()).collect::<Result<_, _>>().map_err(errors::parameter)?;
    let options = Options {
        math: if exact { Math::Exact } else { Math::Builtin },
        product: if complete { Product::Complete } else { Product::Functions },
    };
    Ok(match py.detach(|| export(model, &parts, language, options)).map_err(errors::parameter)? {
        Source::Text(text) => text.into_pyobject(py)?.into_any(),
        Source::Binary(bytes) => PyBytes::new(py, &bytes).into_any(),
    })
}
