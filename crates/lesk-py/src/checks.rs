//! The runner of claims.

use crate::models::find;
use lesk_check::{Effort, Report};
use pyo3::prelude::*;

/// What the checks of a model found, as JSON.
#[pyfunction]
pub fn check_json(py: Python<'_>, id: &str, full: bool) -> PyResult<String> {
    let model = find(id)?;
    let effort = if full { Effort::Full } else { Effort::Quick };
    let report = py.detach(|| lesk_check::check(model, effort));
    Ok(lesk_check::json(&[report]).to_string())
}

/// Reports, given as the JSON of [`check_json`], as one HTML page.
#[pyfunction]
pub fn check_html(reports: &str) -> PyResult<String> {
    let reports: Vec<Report> = serde_json::from_str(reports).map_err(crate::value_error)?;
    Ok(lesk_check::html(&reports))
}
