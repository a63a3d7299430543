//! The sky of Hosek and Wilkie.

use crate::errors;
use lesk_light::{Environment, HosekSky, Up};
use lesk_math::Color;
use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray1};
use pyo3::prelude::*;

/// A cloudless sky.
#[pyclass(frozen, name = "HosekSky")]
pub struct PyHosekSky(HosekSky);

#[pymethods]
impl PyHosekSky {
    #[new]
    fn new(turbidity: f64, ground: [f64; 3], elevation_deg: f64, azimuth_deg: f64) -> PyResult<Self> {
        HosekSky::new(turbidity, ground, elevation_deg.to_radians(), azimuth_deg.to_radians())
            .map(PyHosekSky)
            .map_err(errors::light)
    }

    /// Linear Rec.709 in cd/m² at zenith distances and azimuths in degrees, one row for each pair.
    fn rgb<'py>(
        &self,
        py: Python<'py>,
        zenith_deg: PyReadonlyArray1<'py, f64>,
        azimuth_deg: PyReadonlyArray1<'py, f64>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let pairs = pairs(&zenith_deg, &azimuth_deg);
        let values: Vec<f64> = py.detach(|| pairs.iter().flat_map(|[z, a]| self.0.radiance(*z, *a)).collect());
        PyArray1::from_vec(py, values).reshape([pairs.len(), 3])
    }

    /// W/(m² sr nm) at zenith distances and azimuths in degrees and a wavelength in nm.
    fn spectral_radiance<'py>(
        &self,
        py: Python<'py>,
        zenith_deg: PyReadonlyArray1<'py, f64>,
        azimuth_deg: PyReadonlyArray1<'py, f64>,
        lambda_nm: PyReadonlyArray1<'py, f64>,
    ) -> Bound<'py, PyArray1<f64>> {
        let pairs = pairs(&zenith_deg, &azimuth_deg);
        let values = pairs.iter().zip(lambda_nm.as_array());
        PyArray1::from_vec(py, values.map(|([z, a], nm)| self.0.spectral_radiance(*z, *a, *nm)).collect())
    }

    /// Illuminance of a horizontal plane by the sky as scenes have it, lx.
    fn illuminance(&self, py: Python<'_>) -> PyResult<f64> {
        let map = py.detach(|| Environment::new(self.0.picture()?, Color::splat(1.0), Up::Z, 0.0));
        map.map(|map| map.illuminance()).map_err(errors::light)
    }

    /// Linear Rec.709 in lx of a plane perpendicular to the sun.
    fn sun_rgb(&self) -> [f64; 3] {
        self.0.sun_illuminance()
    }

    /// W/(m² nm) of a plane perpendicular to the sun, at wavelengths in nm.
    fn sun_spectral_irradiance<'py>(
        &self,
        py: Python<'py>,
        lambda_nm: PyReadonlyArray1<'py, f64>,
    ) -> Bound<'py, PyArray1<f64>> {
        let values = lambda_nm.as_array().iter().map(|nm| self.0.sun_spectral_irradiance(*nm)).collect();
        PyArray1::from_vec(py, values)
    }
}

/// Pairs of angles in radians.
fn pairs(zenith_deg: &PyReadonlyArray1<'_, f64>, azimuth_deg: &PyReadonlyArray1<'_, f64>) -> Vec<[f64; 2]> {
    let (zenith, azimuth) = (zenith_deg.as_array(), azimuth_deg.as_array());
    zenith.into_iter().zip(azimuth).map(|(z, a)| [z.to_radians(), a.to_radians()]).collect()
}
