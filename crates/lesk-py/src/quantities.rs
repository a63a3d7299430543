//! Quantities, their conversions, and spectra.

use crate::errors;
use lesk_quantities::colorimetry::{color_rendering, color_temperature, xy};
use lesk_quantities::colorspace::RgbSpace;
use lesk_quantities::conversion::{Assumptions, Given, OPTIONS, Target, convert};
use lesk_quantities::observer::Observer;
use lesk_quantities::photometry::{Range, Vision};
use lesk_quantities::upsampling::Reflectance;
use lesk_quantities::{Dimension, Spectrum, Unit, photometry, radiometry};
use pyo3::prelude::*;

/// Number, unit, dimension and spectrum of a text like `1 W @ 600 nm`.
#[pyfunction]
pub fn quantity_parse(text: &str) -> PyResult<(f64, String, &'static str, Option<String>)> {
    let given = Given::parse(text).map_err(errors::parameter)?;
    let unit = given.quantity.unit();
    let spectrum = given.spectrum.map(|spectrum| spectrum.name().to_string());
    Ok((given.quantity.value(), unit.to_string(), unit.dimension().name(), spectrum))
}

/// Formula, assumption, value and unit.
type Step = (String, String, f64, String);

/// Value, unit, steps, and the options that were not needed.
#[pyfunction]
pub fn quantity_convert(
    given: &str,
    to: &str,
    options: Vec<(String, String)>,
    spectrum: Option<&PySpectrum>,
) -> PyResult<(f64, String, Vec<Step>, Vec<&'static str>)> {
    let made = (|| {
        let mut assumptions = Assumptions::none();
        for (name, text) in &options {
            assumptions.set(name, text)?;
        }
        if let Some(spectrum) = spectrum {
            assumptions.spectrum = Some(spectrum.0.clone());
        }
        convert(&Given::parse(given)?, &Target::parse(to)?, &assumptions)
    })();
    let made = made.map_err(errors::parameter)?;
    let steps = made.steps.into_iter().map(|s| (s.formula, s.assumption, s.value, s.unit.to_string())).collect();
    Ok((made.value, made.unit.to_string(), steps, made.unused))
}

/// Rows of name, Czech name, symbol and units of every quantity.
#[pyfunction]
pub fn quantity_dimensions() -> Vec<(&'static str, &'static str, &'static str, Vec<&'static str>)> {
    Dimension::all().map(|d| (d.name(), d.czech(), d.symbol(), d.examples().to_vec())).collect()
}

/// Rows of symbol, name, dimension and SI units in one of every unit.
#[pyfunction]
pub fn quantity_units() -> PyResult<Vec<(&'static str, &'static str, &'static str, f64)>> {
    let factor = |symbol| Unit::parse(symbol).map(Unit::factor).map_err(errors::parameter);
    Unit::symbols().map(|(symbol, name, d)| Ok((symbol, name, d.name(), factor(symbol)?))).collect()
}

/// Names of the options of conversions that are numbers or flags, and their flags with an example.
#[pyfunction]
pub fn quantity_options() -> Vec<(&'static str, &'static str)> {
    OPTIONS.iter().map(|option| (option.name, option.flag)).collect()
}

/// The share of a black body's radiation below a wavelength in nm.
#[pyfunction]
pub fn blackbody_share_below(lambda_nm: f64, temperature: f64) -> f64 {
    radiometry::blackbody_share_below(lambda_nm, temperature)
}

/// A spectrum of light.
#[pyclass(frozen, name = "Spectrum")]
pub struct PySpectrum(pub Spectrum);

fn range_of(range: Option<&str>) -> PyResult<Option<Range>> {
    range.map(Range::parse).transpose().map_err(errors::parameter)
}

fn observer_of(name: &str) -> PyResult<Observer> {
    let known = Observer::ALL.map(|(name, _)| format!("`{name}`")).join(", ");
    Observer::parse(name)
        .ok_or_else(|| errors::parameter(format!("there is no observer `{name}`, {known} are accepted")))
}

impl PySpectrum {
    /// A ratio is not finite where there is no light to divide by.
    fn finite(&self, ratio: f64) -> PyResult<f64> {
        if ratio.is_finite() {
            Ok(ratio)
        } else {
            Err(errors::parameter(format!("`{}` has no light within this range", self.0)))
        }
    }
}

#[pymethods]
impl PySpectrum {
    /// Reads a name.
    #[staticmethod]
    fn parse(name: &str) -> PyResult<PySpectrum> {
        Spectrum::parse(name).map(PySpectrum).map_err(errors::parameter)
    }

    /// Reads a table.
    #[staticmethod]
    fn from_text(name: &str, text: &str) -> PyResult<PySpectrum> {
        Spectrum::from_text(name, text).map(PySpectrum).map_err(errors::parameter)
    }

    #[getter]
    fn name(&self) -> &str {
        self.0.name()
    }

    #[getter]
    fn single_wavelength(&self) -> Option<f64> {
        self.0.single_wavelength()
    }

    /// First and last nm that count as all of its light.
    #[getter]
    fn range(&self) -> Option<(u32, u32)> {
        self.0.range().map(|range| (range.first_nm, range.last_nm))
    }

    fn at(&self, lambda_nm: Vec<f64>) -> Vec<f64> {
        lambda_nm.into_iter().map(|nm| self.0.at(nm)).collect()
    }

    fn efficacy(&self, range: Option<&str>, scotopic: bool) -> PyResult<f64> {
        let vision = if scotopic { Vision::Scotopic } else { Vision::Photopic };
        self.finite(self.0.efficacy(range_of(range)?.or(self.0.range()), vision))
    }

    fn energy(&self, range: Option<&str>) -> PyResult<f64> {
        Ok(self.0.energy(range_of(range)?))
    }

    fn photons_per_joule(&self, range: Option<&str>) -> PyResult<f64> {
        self.finite(self.0.photons_per_joule(range_of(range)?))
    }

    fn xyz(&self, observer: &str) -> PyResult<[f64; 3]> {
        Ok(self.0.xyz(observer_of(observer)?))
    }

    /// Correlated colour temperature in K and Duv.
    fn color_temperature(&self) -> Option<(f64, f64)> {
        color_temperature(xy(self.0.xyz(Observer::Cie1931)))
    }

    /// Ra and R1 to R14.
    fn color_rendering(&self) -> Option<(f64, Vec<f64>)> {
        color_rendering(&self.0).map(|rendering| (rendering.ra, rendering.r.to_vec()))
    }
}

/// Names of illuminants.
#[pyfunction]
pub fn spectrum_names() -> Vec<&'static str> {
    Spectrum::names().collect()
}

/// Colour matching functions of an observer; `V` and `V'` give one column.
#[pyfunction]
pub fn observer(name: &str, lambda_nm: Vec<f64>) -> PyResult<Vec<Vec<f64>>> {
    let single: Option<fn(f64) -> f64> = match name {
        "V" => Some(photometry::v),
        "V'" => Some(photometry::v_scotopic),
        _ => None,
    };
    if let Some(efficiency) = single {
        return Ok(lambda_nm.into_iter().map(|nm| vec![efficiency(nm)]).collect());
    }
    let observer = observer_of(name)?;
    Ok(lambda_nm.into_iter().map(|nm| observer.xyz_bar(nm).to_vec()).collect())
}

fn space(name: &str) -> PyResult<RgbSpace> {
    let known = RgbSpace::ALL.map(|space| format!("`{}`", space.name())).join(", ");
    let found = RgbSpace::ALL.into_iter().find(|space| space.name() == name);
    found.ok_or_else(|| errors::parameter(format!("there is no colour space `{name}`, {known} are accepted")))
}

/// Names of the colour spaces.
#[pyfunction]
pub fn rgb_spaces() -> Vec<&'static str> {
    RgbSpace::ALL.iter().map(|space| space.name()).collect()
}

/// Linear RGB of one space in another, adapted from white to white.
#[pyfunction]
pub fn rgb_convert(rgb: [f64; 3], from: &str, to: &str) -> PyResult<[f64; 3]> {
    Ok(space(from)?.convert(space(to)?, rgb))
}

/// XYZ of linear RGB, without adaptation.
#[pyfunction]
pub fn rgb_to_xyz(rgb: [f64; 3], from: &str) -> PyResult<[f64; 3]> {
    Ok(space(from)?.xyz(rgb))
}

/// Linear RGB of XYZ, without adaptation.
#[pyfunction]
pub fn xyz_to_rgb(xyz: [f64; 3], to: &str) -> PyResult<[f64; 3]> {
    Ok(space(to)?.rgb(xyz))
}

/// Values of a smooth reflectance spectrum of linear sRGB at wavelengths in nm, its coefficients, and its largest error.
#[pyfunction]
pub fn reflectance(rgb: [f64; 3], lambda_nm: Vec<f64>) -> PyResult<(Vec<f64>, [f64; 3], f64)> {
    let spectrum = Reflectance::of_srgb(rgb).map_err(errors::parameter)?;
    let values = lambda_nm.into_iter().map(|nm| spectrum.at(nm)).collect();
    Ok((values, spectrum.coefficients(), spectrum.error()))
}
