//! Conversions between quantities of light: a chain of rules, each of which names what it assumes.
//!
//! ```
//! use lesk_quantities::conversion::{Assumptions, Given, Target, convert};
//!
//! let mut assumptions = Assumptions::none();
//! assumptions.set("distance", "1.5 m")?;
//! let lux = convert(&Given::parse("1100 lm")?, &Target::parse("lx")?, &assumptions)?;
//! assert!((lux.value - 38.9045).abs() < 5e-5);
//! assert_eq!(lux.steps[0].assumption, "shines alike in all directions");
//! # Ok::<(), lesk_quantities::QuantityError>(())
//! ```
//!
//! Rules are edges between the forms of light (flux, intensity, irradiance, radiance, energy, exposure); the planner
//! takes the chain that uses what was given. A step between watts, lumens and photons comes first and needs a spectrum.

mod assumptions;
mod plan;
mod rules;
mod spectral;

pub use assumptions::{Assumptions, Need, OPTIONS, OptionInfo};

use crate::error::reason;
use crate::photometry::Range;
use crate::{Dimension, Quantity, QuantityError, Spectrum, System, Unit, radiometry};
use rules::Node;
use std::fmt;

/// A quantity with the spectrum of its light, if it is known: `1 W @ 600 nm`.
#[derive(Clone, Debug, PartialEq)]
pub struct Given {
    /// The number with its unit.
    pub quantity: Quantity,
    /// What stands behind `@`.
    pub spectrum: Option<Spectrum>,
}

impl Given {
    /// Reads `1100 lm`, `1 W @ 600 nm`, `500 lx @ D65`.
    ///
    /// # Errors
    /// Those of [`Quantity::parse`] and [`Spectrum::parse`].
    pub fn parse(text: &str) -> Result<Given, QuantityError> {
        let (quantity, spectrum) = match text.split_once('@') {
            Some((quantity, spectrum)) => (quantity, Some(Spectrum::parse(spectrum)?)),
            None => (text, None),
        };
        Ok(Given { quantity: Quantity::parse(quantity)?, spectrum })
    }
}

impl fmt::Display for Given {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.spectrum {
            Some(spectrum) => write!(f, "{} @ {spectrum}", self.quantity),
            None => write!(f, "{}", self.quantity),
        }
    }
}

/// What is wanted: a unit, or the name of a quantity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Target {
    /// The unit of the result.
    pub unit: Unit,
    /// The range that the name implies: 400 to 700 nm for PPFD.
    range: Option<Range>,
}

/// Photosynthetically active radiation.
const PAR: Range = Range { first_nm: 400, last_nm: 700 };

impl Target {
    /// Reads a unit (`lx`, `umol/s/m2`) or a name (`illuminance`, `luminous exitance`, `PPFD`).
    ///
    /// # Errors
    /// `UnknownUnit`.
    pub fn parse(text: &str) -> Result<Target, QuantityError> {
        let name = text.trim().to_lowercase().replace('_', " ");
        let (unit, range) = match name.as_str() {
            "ppf" => ("umol/s", Some(PAR)),
            "ppfd" => ("umol/s/m2", Some(PAR)),
            "exitance" | "radiant exitance" | "radiosity" => ("W/m2", None),
            "luminous exitance" => ("lm/m2", None),
            _ => match Dimension::all().find(|dimension| dimension.name() == name) {
                Some(dimension) => (dimension.si_symbol(), None),
                None => (text, None),
            },
        };
        Ok(Target { unit: Unit::parse(unit)?, range })
    }
}

/// One step of a conversion.
#[derive(Clone, Debug, PartialEq)]
pub struct Step {
    /// `E = I cos θ / d²`.
    pub formula: String,
    /// What the formula assumes, with its numbers.
    pub assumption: String,
    /// The value after the step.
    pub value: f64,
    /// Its unit.
    pub unit: Unit,
}

impl Step {
    fn si(formula: String, assumption: String, value: f64, dimension: Dimension) -> Step {
        let unit = Unit::parse(dimension.si_symbol()).expect("the table's units are read");
        Step { formula, assumption, value, unit }
    }
}

/// The result of a conversion.
#[derive(Clone, Debug, PartialEq)]
pub struct Conversion {
    /// In `unit`.
    pub value: f64,
    /// As it was asked for.
    pub unit: Unit,
    /// From the given quantity to the result; empty where only the unit changed.
    pub steps: Vec<Step>,
    /// Names of options that were given and not needed.
    pub unused: Vec<&'static str>,
}

/// Steps made so far and the options that they used.
#[derive(Default)]
struct Made {
    steps: Vec<Step>,
    used: Vec<Need>,
}

/// Converts a quantity.
///
/// # Errors
/// `NoConversion`: what is missing and the option that gives it; or two quantities that are not linked.
pub fn convert(given: &Given, target: &Target, assumptions: &Assumptions) -> Result<Conversion, QuantityError> {
    let (from, to) = (given.quantity.dimension(), target.unit.dimension());
    let mut a = assumptions.clone();
    a.spectrum = given.spectrum.clone().or(a.spectrum);
    a.range = a.range.or(target.range);
    if from == Dimension::Temperature && a.spectrum.is_none() && to.light().is_some() {
        a.spectrum = Some(Spectrum::blackbody(given.quantity.si())?);
    }
    let mut made = Made::default();
    let si = if from == to {
        given.quantity.si()
    } else if let Some((formula, assumption, apply)) = direct(from, to) {
        let value = apply(given.quantity.si());
        made.steps.push(Step::si(formula.into(), assumption.into(), value, to));
        value
    } else {
        along_rules(given, target.unit, &a, &mut made)?
    };
    let value = if target.unit == given.quantity.unit() && from == to {
        given.quantity.value()
    } else {
        target.unit.value_of(si)
    };
    if !value.is_finite() {
        let what = format!("`{given}` in {} is no finite number", target.unit);
        return Err(QuantityError::NoConversion { what, hint: String::new() });
    }
    if let Some(last) = made.steps.last_mut() {
        (last.value, last.unit) = (value, target.unit);
    }
    let unused = Need::ALL.into_iter().filter(|need| a.has(*need) && !made.used.contains(need));
    let unused = unused.map(|need| need.info().name).collect();
    Ok(Conversion { value, unit: target.unit, steps: made.steps, unused })
}

/// The system and node of a dimension; a meter's exposure value is photometric, a temperature radiometric.
fn place(dimension: Dimension) -> Option<(System, Node)> {
    match dimension {
        Dimension::ExposureValue => Some((System::Photometric, Node::Exposure)),
        Dimension::Temperature => Some((System::Radiometric, Node::Temperature)),
        _ => dimension.light().map(|(system, form)| (system, Node::Light(form))),
    }
}

fn along_rules(given: &Given, unit: Unit, a: &Assumptions, made: &mut Made) -> Result<f64, QuantityError> {
    let (from, to) = (given.quantity.dimension(), unit.dimension());
    let unlinked = || {
        let what = format!("`{given}` is {from}, which has no link to {to} ({unit})");
        QuantityError::NoConversion { what, hint: String::new() }
    };
    let ((system, start), (wanted, end)) = (place(from).ok_or_else(unlinked)?, place(to).ok_or_else(unlinked)?);
    let chain = plan::best(start, end, a).map_err(|sets| {
        if sets.is_empty() {
            return unlinked();
        }
        let why = reason(from.photometric(), to.photometric()).map_or(String::new(), |why| format!(": {why}"));
        let what = format!("`{given}` is {from}, {unit} is {to}{why}");
        QuantityError::NoConversion { what, hint: format!("give {}", plan::advice(&sets)) }
    })?;
    let mut value = given.quantity.si();
    // densities and photons become watts at the start where light is given; meters and black bodies at the end
    if let Node::Light(form) = start {
        value = spectral::steps(value, form, system, wanted, a, made)?;
    }
    let system = if matches!(start, Node::Light(_)) { wanted } else { system };
    for rule in &chain {
        value = (rule.apply)(value, a);
        made.used.extend(rule.needs.iter().chain(rule.takes));
        let dimension = node_dimension(system, rule.to).ok_or_else(unlinked)?;
        made.steps.push(Step::si(rule.formula.into(), rule.says(a), value, dimension));
    }
    match end {
        Node::Light(form) if system != wanted => spectral::steps(value, form, system, wanted, a, made),
        _ => Ok(value),
    }
}

fn node_dimension(system: System, node: Node) -> Option<Dimension> {
    match node {
        Node::Light(form) => Dimension::of_light(system, form),
        Node::Exposure => Some(Dimension::ExposureValue),
        Node::Temperature => Some(Dimension::Temperature),
    }
}

type Direct = (&'static str, &'static str, fn(f64) -> f64);

/// Links that hold alone and are no part of a chain.
fn direct(from: Dimension, to: Dimension) -> Option<Direct> {
    use Dimension::*;
    Some(match (from, to) {
        (Length, RadiantEnergy) => ("E = h c / λ", "one photon", |x| radiometry::photon_energy(x * 1e9)),
        (RadiantEnergy, Length) => ("λ = h c / E", "one photon", |x| radiometry::PLANCK * radiometry::LIGHT_SPEED / x),
        (Frequency, RadiantEnergy) => ("E = h ν", "one photon", |x| radiometry::PLANCK * x),
        (RadiantEnergy, Frequency) => ("ν = E / h", "one photon", |x| x / radiometry::PLANCK),
        (Length, Frequency) => ("ν = c / λ", "in vacuum", |x| radiometry::LIGHT_SPEED / x),
        (Frequency, Length) => ("λ = c / ν", "in vacuum", |x| radiometry::LIGHT_SPEED / x),
        (Angle, SolidAngle) => ("Ω = 2π (1 - cos a)", "a cone of this half-angle", rules::cone_solid_angle),
        (SolidAngle, Angle) => ("a = acos(1 - Ω / 2π)", "the half-angle of a cone", |x| {
            2.0 * (x / (4.0 * std::f64::consts::PI)).sqrt().asin()
        }),
        (Temperature, Length) => ("λ = b / T", "peak of a black body per wavelength (Wien)", |x| radiometry::WIEN / x),
        (Length, Temperature) => ("T = b / λ", "peak of a black body per wavelength (Wien)", |x| radiometry::WIEN / x),
        _ => return None,
    })
}

#[cfg(test)]
mod tests;
