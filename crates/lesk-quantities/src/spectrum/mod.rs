//! Spectra of light: named illuminants, black bodies, lines, LEDs, tables from files.

mod name;
mod read;
mod sunlight;

use crate::photometry::{Range, Vision};
use crate::{QuantityError, observer::Observer, radiometry, table};
use std::fmt;

pub use name::ACCEPTED;
pub use read::MAX_TEXT;

/// How light is spread over wavelengths, per nm; the scale is free except in tables of measured light.
#[derive(Clone, Debug, PartialEq)]
pub struct Spectrum {
    name: String,
    shape: Shape,
}

#[derive(Clone, Debug, PartialEq)]
enum Shape {
    /// Equal energy per nm.
    Equal,
    /// CIE illuminant A.
    A,
    /// A daylight with its two weights.
    Daylight([f64; 2]),
    /// K.
    Blackbody(f64),
    /// All light at one wavelength in nm.
    Line(f64),
    /// Peak and width at half maximum, nm.
    Gaussian(f64, f64),
    /// A column of the CIE's illuminants.
    Column(usize),
    /// Wavelengths in nm, ascending, and values.
    Table(Vec<[f64; 2]>),
}

impl Spectrum {
    /// Equal energy per nm, the CIE's illuminant E.
    pub fn equal_energy() -> Spectrum {
        Spectrum { name: "E".into(), shape: Shape::Equal }
    }

    /// All light at one wavelength.
    ///
    /// # Errors
    /// `OutOfRange` outside 1 to 100 000 nm.
    pub fn line(lambda_nm: f64) -> Result<Spectrum, QuantityError> {
        within("wavelength", lambda_nm, 1.0, 1e5, "1 nm to 100000 nm")?;
        Ok(Spectrum { name: format!("{lambda_nm} nm"), shape: Shape::Line(lambda_nm) })
    }

    /// A Gaussian with its peak and its width at half maximum in nm: a simple LED.
    ///
    /// # Errors
    /// `OutOfRange` for a peak outside 100 to 10 000 nm or a width outside 1 to 1000 nm.
    pub fn gaussian(peak_nm: f64, width_nm: f64) -> Result<Spectrum, QuantityError> {
        within("peak", peak_nm, 100.0, 1e4, "100 nm to 10000 nm")?;
        within("width", width_nm, 1.0, 1e3, "1 nm to 1000 nm")?;
        let name = format!("gaussian {peak_nm} nm, {width_nm} nm");
        Ok(Spectrum { name, shape: Shape::Gaussian(peak_nm, width_nm) })
    }

    /// A black body at a temperature in K.
    ///
    /// # Errors
    /// `OutOfRange` outside 500 to 100 000 K.
    pub fn blackbody(temperature: f64) -> Result<Spectrum, QuantityError> {
        within("temperature", temperature, 500.0, 1e5, "500 K to 100000 K")?;
        Ok(Spectrum { name: format!("blackbody {temperature} K"), shape: Shape::Blackbody(temperature) })
    }

    /// CIE daylight of a correlated colour temperature in K.
    ///
    /// # Errors
    /// `OutOfRange` outside 4000 to 25 000 K, where the CIE defines it.
    pub fn daylight(temperature: f64) -> Result<Spectrum, QuantityError> {
        within("temperature", temperature, 4000.0, 25_000.0, "4000 K to 25000 K")?;
        Ok(Spectrum { name: format!("D {temperature} K"), shape: Shape::Daylight(daylight_weights(temperature)) })
    }

    /// Its name: `D65`, `blackbody 2856 K`, a file's name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The wavelength in nm if all light is at one.
    pub fn single_wavelength(&self) -> Option<f64> {
        match self.shape {
            Shape::Line(nm) => Some(nm),
            _ => None,
        }
    }

    /// The value at a wavelength in nm; tables are linear between their rows and zero outside. A single line has no
    /// density: zero.
    pub fn at(&self, lambda_nm: f64) -> f64 {
        match &self.shape {
            Shape::Equal => 1.0,
            Shape::A => illuminant_a(lambda_nm),
            Shape::Daylight([m1, m2]) => {
                let [s0, s1, s2] = table::DAYLIGHT.triple(lambda_nm);
                s0 + m1 * s1 + m2 * s2
            }
            Shape::Blackbody(t) => radiometry::blackbody(lambda_nm, *t),
            Shape::Line(_) => 0.0,
            Shape::Gaussian(peak, width) => {
                (-4.0 * std::f64::consts::LN_2 * ((lambda_nm - peak) / width).powi(2)).exp()
            }
            Shape::Column(column) => table::ILLUMINANTS.at(*column, lambda_nm),
            Shape::Table(rows) => linear(rows, lambda_nm),
        }
    }

    /// The range that counts as all of its light; `None` for the whole spectrum.
    ///
    /// A, E and the D series are defined without end, and count from 380 to 780 nm unless told otherwise.
    pub fn range(&self) -> Option<Range> {
        match &self.shape {
            Shape::Blackbody(_) | Shape::Line(_) => None,
            Shape::Equal | Shape::A | Shape::Daylight(_) | Shape::Column(_) => Some(Range::VISIBLE),
            Shape::Gaussian(peak, width) => Some(around(peak - 4.0 * width, peak + 4.0 * width)),
            Shape::Table(rows) => Some(around(rows[0][0], rows[rows.len() - 1][0])),
        }
    }

    /// The integral of the spectrum times a weight over a range: the trapezoid rule at whole nm, and at the rows of a
    /// table. The whole line for single lines within the range.
    pub fn integrate(&self, range: Range, weight: impl Fn(f64) -> f64) -> f64 {
        let (first, last) = (f64::from(range.first_nm), f64::from(range.last_nm));
        if let Some(nm) = self.single_wavelength() {
            return if (first..=last).contains(&nm) { weight(nm) } else { 0.0 };
        }
        let mut nodes: Vec<f64> = (range.first_nm..=range.last_nm).map(f64::from).collect();
        if let Shape::Table(rows) = &self.shape {
            nodes.extend(rows.iter().map(|row| row[0]));
            // outside its rows a table is zero, without a slope to there
            let held = rows[0][0].max(first)..=rows[rows.len() - 1][0].min(last);
            nodes.retain(|nm| held.contains(nm));
            nodes.sort_by(f64::total_cmp);
        }
        let values = nodes.iter().map(|&nm| [nm, self.at(nm) * weight(nm)]);
        values.clone().zip(values.skip(1)).map(|([x0, y0], [x1, y1])| 0.5 * (x1 - x0) * (y0 + y1)).sum()
    }

    /// Energy within a range, or of the whole spectrum, in the unit of the spectrum times nm.
    pub fn energy(&self, range: Option<Range>) -> f64 {
        match (&self.shape, range) {
            (_, Some(range)) => self.integrate(range, |_| 1.0),
            (Shape::Line(_), None) => 1.0,
            (Shape::Blackbody(t), None) => radiometry::blackbody_radiance(*t),
            (_, None) => self.integrate(self.range().unwrap_or(Range::OBSERVER), |_| 1.0),
        }
    }

    /// Luminous efficacy of radiation, lm per watt within a range, or of the whole spectrum.
    pub fn efficacy(&self, range: Option<Range>, vision: Vision) -> f64 {
        self.efficacy_with(range, vision, vision.k_m())
    }

    /// The same with another maximum efficacy, as old books print it.
    pub fn efficacy_with(&self, range: Option<Range>, vision: Vision, k_m: f64) -> f64 {
        let seen = self.integrate(range.unwrap_or(Range::OBSERVER), |nm| vision.efficiency(nm));
        k_m * seen / self.energy(range)
    }

    /// Photons per joule within a range, or of the whole spectrum.
    pub fn photons_per_joule(&self, range: Option<Range>) -> f64 {
        match (&self.shape, range) {
            (Shape::Line(nm), None) => 1.0 / radiometry::photon_energy(*nm),
            (Shape::Blackbody(t), None) => {
                radiometry::blackbody_photon_radiance(*t) / radiometry::blackbody_radiance(*t)
            }
            (_, range) => {
                let range = range.or(self.range()).unwrap_or(Range::OBSERVER);
                self.integrate(range, |nm| 1.0 / radiometry::photon_energy(nm)) / self.energy(Some(range))
            }
        }
    }

    /// XYZ in the unit of the spectrum times nm, without K_m.
    pub fn xyz(&self, observer: Observer) -> [f64; 3] {
        [0, 1, 2].map(|c| self.integrate(Range::OBSERVER, |nm| observer.xyz_bar(nm)[c]))
    }
}

impl fmt::Display for Spectrum {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.name)
    }
}

fn within(name: &'static str, given: f64, low: f64, high: f64, accepted: &'static str) -> Result<(), QuantityError> {
    if (low..=high).contains(&given) { Ok(()) } else { Err(QuantityError::OutOfRange { name, given, accepted }) }
}

/// The whole nm around two wavelengths.
fn around(first: f64, last: f64) -> Range {
    let first_nm = first.floor().max(1.0) as u32;
    Range { first_nm, last_nm: (last.ceil() as u32).max(first_nm + 1) }
}

/// A is 100 (560/λ)^5 (exp(c2/(2848 560 nm)) - 1) / (exp(c2/(2848 λ)) - 1) with c2 = 1.435e-2 m K (CIE 15).
fn illuminant_a(lambda_nm: f64) -> f64 {
    if lambda_nm.is_nan() || lambda_nm <= 0.0 {
        return 0.0;
    }
    let planck = |nm: f64| (1.435e7 / (2848.0 * nm)).exp_m1();
    100.0 * (560.0 / lambda_nm).powi(5) * planck(560.0) / planck(lambda_nm)
}

/// Weights M1, M2 of the D series, rounded to three decimals as in CIE 15.
fn daylight_weights(t: f64) -> [f64; 2] {
    let x = if t <= 7000.0 {
        -4.6070e9 / t.powi(3) + 2.9678e6 / t.powi(2) + 0.09911e3 / t + 0.244_063
    } else {
        -2.0064e9 / t.powi(3) + 1.9018e6 / t.powi(2) + 0.24748e3 / t + 0.237_040
    };
    let y = -3.0 * x * x + 2.87 * x - 0.275;
    let m = 0.0241 + 0.2562 * x - 0.7341 * y;
    let round = |v: f64| (v * 1e3).round() / 1e3;
    [round((-1.3515 - 1.7703 * x + 5.9114 * y) / m), round((0.03 - 31.4424 * x + 30.0717 * y) / m)]
}

/// Linear between rows, zero outside and for NaN.
fn linear(rows: &[[f64; 2]], nm: f64) -> f64 {
    if !(rows[0][0]..=rows[rows.len() - 1][0]).contains(&nm) {
        return 0.0;
    }
    let i = rows.partition_point(|row| row[0] <= nm).clamp(1, rows.len() - 1);
    let ([x0, y0], [x1, y1]) = (rows[i - 1], rows[i]);
    let t = (nm - x0) / (x1 - x0);
    y0 * (1.0 - t) + y1 * t
}

#[cfg(test)]
mod tests;
