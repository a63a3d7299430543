//! Writes LM-63.

use super::super::planes::Symmetry;
use super::super::text::digits;
use super::super::{Coordinates, Counted, Photometry};
use super::header::Generation;
use crate::error::LightError;

/// Lines of numbers are at most this long: the limit of 1986 to 1995.
const WIDTH: usize = 78;

/// The text of a file. The values are written as they are, with the factor 1; metres.
pub fn write(photometry: &Photometry, generation: Generation) -> Result<String, LightError> {
    let mut lines = Vec::new();
    if !generation.tag().is_empty() {
        lines.push(generation.tag().to_string());
    }
    label(photometry, generation, &mut lines);
    match &photometry.tilt {
        None => lines.push("TILT=NONE".into()),
        Some(tilt) => {
            lines.push("TILT=INCLUDE".into());
            lines.push(tilt.geometry.to_string());
            lines.push(tilt.angles.len().to_string());
            numbers(&tilt.angles, &mut lines);
            numbers(&tilt.factors, &mut lines);
        }
    }
    let web = &photometry.web;
    let h = stored(photometry, generation);
    let set = photometry.lamps.get(photometry.lamp_set);
    let count = set.map_or(1.0, |set| set.count.abs().max(1.0));
    let lumens = match photometry.lamp_flux() {
        Some(flux) if !photometry.absolute => flux * photometry.ballast_factor / count,
        _ => -1.0,
    };
    let kind = match web.coordinates() {
        Coordinates::C => 1,
        Coordinates::B => 2,
        Coordinates::A => 3,
    };
    let v = web.v();
    let [width, length, height] = opening(photometry, generation).map(digits);
    lines.push(format!(
        "{} {} 1 {} {} {kind} 2 {width} {length} {height}",
        digits(count),
        digits(lumens),
        v.len(),
        h.len()
    ));
    // 1.00001: how the file came about is not stated
    let third = if generation == Generation::Y2019 { "1.00001" } else { "1" };
    lines.push(format!("1 {third} {}", digits(photometry.watts().unwrap_or(0.0))));
    numbers(v, &mut lines);
    numbers(&h.iter().map(|(_, angle)| *angle).collect::<Vec<_>>(), &mut lines);
    // radiant files count mW/sr
    let scale = if photometry.counted == Counted::Power { 1e3 } else { 1.0 };
    for (plane, _) in h {
        let values: Vec<f64> = web.plane(plane).iter().map(|x| x * scale).collect();
        numbers(&values, &mut lines);
    }
    Ok(lines.join("\r\n") + "\r\n")
}

/// The planes that suffice, with the angles under which they are stored.
fn stored(photometry: &Photometry, generation: Generation) -> Vec<(usize, f64)> {
    let h = photometry.web.h();
    let within = |from: f64, to: f64| -> Vec<(usize, f64)> {
        h.iter().copied().enumerate().filter(|(_, a)| *a >= from - 1e-6 && *a <= to + 1e-6).collect()
    };
    if photometry.web.coordinates() != Coordinates::C {
        let from = if photometry.symmetry == Symmetry::C90C270 { 0.0 } else { -180.0 };
        return within(from, 180.0);
    }
    match photometry.detected_symmetry() {
        Symmetry::Rotational => vec![(0, 0.0)],
        Symmetry::Quadrant if ends(h, &[90.0]) => within(0.0, 90.0),
        Symmetry::C0C180 if ends(h, &[180.0]) => within(0.0, 180.0),
        Symmetry::C90C270 if ends(h, &[90.0, 270.0]) && generation == Generation::Y1995 => within(90.0, 270.0),
        _ => within(0.0, 360.0),
    }
}

/// Whether planes stand at the ends of a stored range.
fn ends(h: &[f64], wanted: &[f64]) -> bool {
    wanted.iter().all(|w| h.iter().any(|a| (a - w).abs() < 1e-6))
}

/// Keywords; those that the edition requires are there, free text for 1986.
fn label(photometry: &Photometry, generation: Generation, lines: &mut Vec<String>) {
    let clean = |text: &str| text.chars().filter(|c| !c.is_control()).collect::<String>();
    let mut texts: Vec<(String, String)> = match photometry.format {
        super::super::Format::Ies(_) => photometry.texts.clone(),
        super::super::Format::Eulumdat => from_eulumdat(photometry),
    };
    for required in ["TEST", "TESTLAB", "ISSUEDATE", "MANUFAC"] {
        if generation >= Generation::Y2002 && !texts.iter().any(|(key, _)| key == required) {
            texts.push((required.into(), "unknown".into()));
        }
    }
    let unit = ("_INTENSITYUNITS".to_string(), "mW/sr".to_string());
    if photometry.counted == Counted::Power {
        texts.retain(|(key, _)| *key != unit.0);
        texts.push(unit);
    }
    // the number of the keyword counts in the unit of the values
    texts.retain(|(key, _)| !key.contains("LUMENS"));
    for (key, text) in texts {
        for (i, line) in text.split('\n').enumerate() {
            let line = clean(line);
            let line = line.trim();
            lines.push(match (generation, key.as_str(), i) {
                (Generation::Y1986, ..) if is_special(line) => format!("- {line}"),
                (Generation::Y1986, "_INTENSITYUNITS", _) => format!("[{key}] {line}"),
                (Generation::Y1986, ..) => line.to_string(),
                (_, "", 0) => format!("[OTHER] {line}"),
                (_, _, 0) => format!("[{key}] {line}"),
                _ => format!("[MORE] {line}"),
            });
        }
    }
}

/// Whether a free line would be taken for another one.
fn is_special(line: &str) -> bool {
    let start: String = line.chars().take(4).collect::<String>().to_ascii_uppercase();
    start.starts_with("IES") || start.starts_with("TILT")
}

/// The texts of an EULUMDAT file under the keywords of LM-63.
fn from_eulumdat(photometry: &Photometry) -> Vec<(String, String)> {
    let keys = [
        ("maker", "MANUFAC"),
        ("luminaire", "LUMINAIRE"),
        ("number", "LUMCAT"),
        ("report", "TEST"),
        ("date", "ISSUEDATE"),
    ];
    let mut texts: Vec<(String, String)> = Vec::new();
    for (ours, theirs) in keys {
        if let Some(text) = photometry.text(ours).filter(|text| !text.is_empty()) {
            texts.push((theirs.into(), text.into()));
        }
    }
    if let Some(set) = photometry.lamps.get(photometry.lamp_set).filter(|set| !set.kind.is_empty()) {
        texts.push(("LAMP".into(), set.kind.clone()));
    }
    texts
}

/// Width, length, height with the signs of the edition.
fn opening(photometry: &Photometry, generation: Generation) -> [f64; 3] {
    let dims = photometry.opening.to_ies();
    if generation >= Generation::Y2002 {
        return dims;
    }
    // before 2002 a circle has no length; what these editions cannot say becomes a box
    let [width, length, height] = dims;
    let old = match photometry.opening.name() {
        "circle" | "vertical cylinder" | "sphere" if width == length => [width, 0.0, height],
        "horizontal cylinder" if length > 0.0 => [0.0, length, height],
        "horizontal cylinder" => [width, 0.0, height],
        "ellipse" | "vertical cylinder" | "ellipsoid" => [width, -length, height],
        _ => dims,
    };
    let same = super::super::Opening::from_ies(generation.year(), old) == Some(photometry.opening);
    if same { old } else { dims.map(f64::abs) }
}

fn numbers(values: &[f64], lines: &mut Vec<String>) {
    let mut line = String::new();
    for value in values {
        let word = digits(*value);
        if !line.is_empty() && line.len() + 1 + word.len() > WIDTH {
            lines.push(std::mem::take(&mut line));
        }
        if !line.is_empty() {
            line.push(' ');
        }
        line.push_str(&word);
    }
    lines.push(line);
}
