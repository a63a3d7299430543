//! Luminaire files.

use crate::errors;
use lesk_light::photometry::{Counted, Declared, Generation, Photometry, REFLECTANCES, ROOMS, ReadOptions};
use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray1};
use pyo3::prelude::*;
use serde_json::{Value, json};
use std::path::PathBuf;

/// A measured distribution with what its file says.
#[pyclass(frozen, name = "Photometry")]
pub struct PyPhotometry(Photometry);

fn generation(year: u32) -> PyResult<Generation> {
    Generation::ALL.into_iter().find(|g| g.year() == year).ok_or_else(|| {
        errors::parameter(format!("`edition` is {year}, but 1986, 1991, 1995, 2002 or 2019 is accepted"))
    })
}

#[pymethods]
impl PyPhotometry {
    /// Reads a file.
    #[staticmethod]
    fn read(py: Python<'_>, path: PathBuf, strict: bool, lamp_set: usize) -> PyResult<Self> {
        py.detach(|| Photometry::read(path, ReadOptions { strict, lamp_set })).map(PyPhotometry).map_err(errors::light)
    }

    /// Reads the bytes of a file.
    #[staticmethod]
    fn parse(py: Python<'_>, bytes: &[u8], strict: bool, lamp_set: usize) -> PyResult<Self> {
        py.detach(|| Photometry::parse(bytes, ReadOptions { strict, lamp_set }))
            .map(PyPhotometry)
            .map_err(errors::light)
    }

    /// cd (or W/sr) at angles in degrees, one for each pair.
    fn candela<'py>(
        &self,
        py: Python<'py>,
        theta_deg: PyReadonlyArray1<'py, f64>,
        phi_deg: PyReadonlyArray1<'py, f64>,
    ) -> Bound<'py, PyArray1<f64>> {
        let pairs = theta_deg.as_array().into_iter().zip(phi_deg.as_array());
        let values = pairs.map(|(t, p)| self.0.intensity(t.to_radians(), p.to_radians())).collect();
        PyArray1::from_vec(py, values)
    }

    /// Vertical and horizontal angles in degrees, and the values of shape (horizontal, vertical).
    fn table<'py>(
        &self,
        py: Python<'py>,
    ) -> PyResult<(Bound<'py, PyArray1<f64>>, Bound<'py, PyArray1<f64>>, Bound<'py, PyArray2<f64>>)> {
        let web = &self.0.web;
        let shape = [web.h().len(), web.v().len()];
        let values = PyArray1::from_slice(py, web.values()).reshape(shape)?;
        Ok((PyArray1::from_slice(py, web.v()), PyArray1::from_slice(py, web.h()), values))
    }

    /// Everything else, as JSON.
    fn facts_json(&self) -> String {
        facts(&self.0).to_string()
    }

    /// Opening angles in degrees at a share of the maximum, in the planes C0-C180 and C90-C270.
    fn opening_angles(&self, py: Python<'_>, share: f64) -> (f64, f64) {
        let angles = py.detach(|| self.0.opening_angles(share));
        (angles.c0.to_degrees(), angles.c90.to_degrees())
    }

    /// UGR by room (19) and orientation with reflectances (10), and what to add for 1000 lm; none without an area.
    fn ugr<'py>(&self, py: Python<'py>, spacing: f64) -> PyResult<Option<(Bound<'py, PyArray2<f64>>, f64)>> {
        let Some(table) = py.detach(|| self.0.ugr_table(spacing)) else { return Ok(None) };
        let values: Vec<f64> = table.values.iter().flatten().copied().collect();
        Ok(Some((PyArray1::from_vec(py, values).reshape([table.values.len(), 10])?, table.to_1000_lm)))
    }

    /// The same in steps of degrees, type C.
    fn resampled(&self, v_step_deg: f64, h_step_deg: f64) -> PyResult<Self> {
        self.0.resampled(v_step_deg, h_step_deg).map(PyPhotometry).map_err(errors::light)
    }

    /// The text of an IES file.
    fn to_ies(&self, edition: u32) -> PyResult<String> {
        self.0.to_ies(generation(edition)?).map_err(errors::light)
    }

    /// The text of an EULUMDAT file.
    fn to_eulumdat(&self) -> PyResult<String> {
        self.0.to_eulumdat().map_err(errors::light)
    }
}

/// Rooms (across, along, in heights of the luminaire above the eye) and reflectances (ceiling, walls, floor, percent) of
/// UGR tables.
#[pyfunction]
pub fn ugr_rooms() -> (Vec<[u32; 2]>, Vec<[u32; 3]>) {
    (ROOMS.to_vec(), REFLECTANCES.to_vec())
}

fn facts(photometry: &Photometry) -> Value {
    let flux = photometry.flux();
    let light = photometry.counted == Counted::Light;
    let unit = |x: f64, wanted: bool| if wanted { json!(x) } else { Value::Null };
    let declared = photometry.declared_flux();
    let (peak, direction) = photometry.peak();
    let down = photometry.web.flux_down();
    let ratio = photometry.light_output_ratio();
    let opening = photometry.opening;
    let texts: Vec<_> = photometry.texts.iter().map(|(key, text)| json!([key, text])).collect();
    json!({
        "format": photometry.format.name(),
        "type": photometry.web.coordinates().letter(),
        "symmetry": photometry.symmetry.name(),
        "counts": if light { "lumens" } else { "watts" },
        "flux_lm": unit(flux, light),
        "flux_mw": unit(1e3 * flux, !light),
        "declared_flux_lm": declared.filter(|_| light).map(|(flux, _)| flux),
        "declared_flux_mw": declared.filter(|_| !light).map(|(flux, _)| 1e3 * flux),
        "declared_of": declared.map(|(_, of)| if of == Declared::Lamps { "lamps" } else { "luminaire" }),
        "absolute": photometry.absolute,
        "peak_cd": unit(peak, light),
        "peak_mw_sr": unit(1e3 * peak, !light),
        "peak_theta_deg": (-direction.z).clamp(-1.0, 1.0).acos().to_degrees(),
        "peak_phi_deg": direction.y.atan2(direction.x).to_degrees().rem_euclid(360.0),
        "lamp_flux_lm": photometry.lamp_flux(),
        "light_output_ratio": ratio,
        "light_output_ratio_up": ratio.map(|r| r * (1.0 - down / flux)),
        "light_output_ratio_down": ratio.map(|r| r * down / flux),
        "downward_fraction": (flux > 0.0).then(|| down / flux),
        "ballast_factor": photometry.ballast_factor,
        "watts": photometry.watts(),
        "efficacy_lm_per_w": photometry.watts().filter(|_| light).map(|w| flux / w),
        "lamp_sets": photometry.lamps.iter().map(|set| json!({
            "count": set.count, "type": set.kind, "flux_lm": set.flux, "color": set.color, "rendering": set.rendering,
            "watts": set.watts,
        })).collect::<Vec<_>>(),
        "opening": {
            "shape": opening.name(), "c0_m": opening.size[0], "c90_m": opening.size[1], "height_m": opening.size[2],
        },
        "tilt": photometry.tilt.as_ref().map(|tilt| json!({
            "geometry": tilt.geometry, "angles_deg": tilt.angles, "factors": tilt.factors,
        })),
        "texts": texts,
        "warnings": photometry.warnings.iter().map(|w| json!({
            "line": w.line, "field": w.field, "text": w.text,
        })).collect::<Vec<_>>(),
    })
}
