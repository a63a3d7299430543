//! Steps between watts, lumens and photons, and between bands and densities.

use super::assumptions::{Assumptions, Need, OPTIONS};
use super::{Made, Step};
use crate::photometry::Range;
use crate::{Dimension, Form, QuantityError, Spectrum, System, radiometry};

/// The steps from one way of counting to another.
pub(super) fn steps(
    value: f64,
    form: Form,
    from: System,
    to: System,
    a: &Assumptions,
    made: &mut Made,
) -> Result<f64, QuantityError> {
    let mut value = value;
    let mut at = from;
    while at != to {
        // watts lie between all others
        let next = if at == System::Radiometric { to } else { System::Radiometric };
        let (factor, formula, assumption) = factor(at, next, a, made)?;
        value *= factor;
        let Some(dimension) = Dimension::of_light(next, form) else {
            return Err(impossible(form, next));
        };
        made.steps.push(Step::si(formula, assumption, value, dimension));
        at = next;
    }
    Ok(value)
}

fn impossible(form: Form, system: System) -> QuantityError {
    let what = format!("there is no quantity of the form {form:?} in {system:?} units");
    QuantityError::NoConversion { what: what.to_lowercase(), hint: String::new() }
}

/// One of the systems is always the radiometric one.
fn factor(from: System, to: System, a: &Assumptions, made: &mut Made) -> Result<(f64, String, String), QuantityError> {
    use System::*;
    let (system, inverse) = if from == Radiometric { (to, false) } else { (from, true) };
    let (factor, formula, assumption) = match system {
        Photometric if a.has(Need::Efficacy) => {
            made.used.push(Need::Efficacy);
            let k = a.get(Need::Efficacy);
            (k, ["Φv = K Φ", "Φ = Φv / K"], format!("K = {k} lm/W as given"))
        }
        Photometric => efficacy(spectrum(a)?, a),
        Photon => photons(spectrum(a)?, a),
        Spectral => {
            if !a.has(Need::Width) {
                let info = &OPTIONS[Need::Width as usize];
                let what = "W/nm is per wavelength, W is not: the width of the band is needed".into();
                return Err(QuantityError::NoConversion {
                    what,
                    hint: format!("give {} (`{}`)", info.title, info.flag),
                });
            }
            made.used.push(Need::Width);
            let width = a.get(Need::Width);
            (1.0 / width, ["Φλ = Φ / Δλ", "Φ = Φλ Δλ"], format!("even over {:.6} nm", width * 1e9))
        }
        Radiometric => (1.0, ["", ""], String::new()),
    };
    let factor = if inverse { 1.0 / factor } else { factor };
    if !factor.is_finite() || factor == 0.0 {
        let what = format!("the light has nothing to convert: {assumption}");
        return Err(QuantityError::NoConversion { what, hint: "give another spectrum or range".into() });
    }
    Ok((factor, formula[usize::from(inverse)].to_string(), assumption))
}

fn spectrum(a: &Assumptions) -> Result<&Spectrum, QuantityError> {
    a.spectrum.as_ref().ok_or_else(|| QuantityError::NoConversion {
        what: "W, lm and photons are linked by a spectrum only: 683.002 lm/W holds at 555 nm, other light has its own \
               efficacy"
            .into(),
        hint:
            "name it: `1 W @ 600 nm`, `--spectrum D65`, `--spectrum \"blackbody 2856 K\"`; or give `--efficacy 100lm/W`"
                .into(),
    })
}

type Factor = (f64, [&'static str; 2], String);

fn efficacy(spectrum: &Spectrum, a: &Assumptions) -> Factor {
    let k_m = a.k_m.unwrap_or(a.vision.k_m());
    let (v, eye) = match a.vision {
        crate::photometry::Vision::Photopic => ("V", "K_m"),
        crate::photometry::Vision::Scotopic => ("V'", "K'_m"),
    };
    if let Some(nm) = spectrum.single_wavelength() {
        let inside = a.range.is_none_or(|r| (f64::from(r.first_nm)..=f64::from(r.last_nm)).contains(&nm));
        let efficiency = if inside { a.vision.efficiency(nm) } else { 0.0 };
        let says = format!("{v}({nm} nm) = {}, {eye} = {k_m} lm/W", digits(efficiency));
        let formula = match a.vision {
            crate::photometry::Vision::Photopic => ["Φv = K_m V(λ) Φ", "Φ = Φv / (K_m V(λ))"],
            crate::photometry::Vision::Scotopic => ["Φ'v = K'_m V'(λ) Φ", "Φ = Φ'v / (K'_m V'(λ))"],
        };
        return (k_m * efficiency, formula, says);
    }
    let range = a.range.or(spectrum.range());
    let k = spectrum.efficacy_with(range, a.vision, k_m);
    let says = format!("K = {} lm/W: {spectrum}, {}, {eye} = {k_m} lm/W", digits(k), said(range));
    (k, ["Φv = K Φ", "Φ = Φv / K"], says)
}

fn photons(spectrum: &Spectrum, a: &Assumptions) -> Factor {
    if let Some(nm) = spectrum.single_wavelength() {
        let energy = radiometry::photon_energy(nm);
        let says = format!("{nm} nm: h c / λ = {energy:.6e} J of a photon");
        return (1.0 / energy, ["Φp = Φ λ / (h c)", "Φ = Φp h c / λ"], says);
    }
    let range = a.range.or(spectrum.range());
    let per_joule = spectrum.photons_per_joule(range);
    let says = format!("{:.6e} J of a mean photon: {spectrum}, {}", 1.0 / per_joule, said(range));
    (per_joule, ["Φp = Φ / (h c / λ)", "Φ = Φp (h c / λ)"], says)
}

fn said(range: Option<Range>) -> String {
    range.map_or("whole spectrum".to_string(), |range| range.to_string())
}

/// Six significant digits, without zeros at the end.
fn digits(value: f64) -> String {
    let magnitude = if value == 0.0 { 0 } else { value.abs().log10().floor() as i32 };
    if !(-4..6).contains(&magnitude) {
        return format!("{value:.5e}");
    }
    let text = format!("{value:.*}", (5 - magnitude) as usize);
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_string() } else { text }
}
