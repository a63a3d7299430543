//! Writes EULUMDAT.

use super::super::text::digits;
use super::super::{Format, Opening, OpeningShape, Photometry, Symmetry};
use super::{SYMMETRIES, stored_planes};
use crate::error::LightError;

/// The text of a file, from a table of type C.
pub fn write(photometry: &Photometry) -> Result<String, LightError> {
    let web = &photometry.web;
    let (symmetry, c) = planes(photometry);
    let flux = photometry.flux();
    if flux <= 0.0 {
        return Err(LightError::new("the luminaire emits nothing, EULUMDAT needs a flux to relate to"));
    }
    let lamps =
        photometry.lamp_flux().filter(|f| *f > 0.0 && !photometry.absolute).map(|f| f * photometry.ballast_factor);
    let base = lamps.unwrap_or(flux);
    let number = SYMMETRIES.iter().position(|s| *s == symmetry).unwrap_or(0);
    let kind = if symmetry == Symmetry::Rotational { 1 } else { 3 };
    let mut lines: Vec<String> = vec![text(photometry, "maker", "MANUFAC"), kind.to_string(), number.to_string()];
    lines.extend([c.len().to_string(), step(&c), web.v().len().to_string(), step(web.v())]);
    lines.push(text(photometry, "report", "TEST"));
    lines.push(text(photometry, "luminaire", "LUMINAIRE"));
    lines.push(text(photometry, "number", "LUMCAT"));
    lines.push(text(photometry, "file", ""));
    lines.push(text(photometry, "date", "ISSUEDATE"));
    extents(photometry, &mut lines);
    lines.push(digits(100.0 * web.flux_down() / flux));
    lines.push(digits(100.0 * flux / base));
    lines.extend(["1".into(), "0".into(), "1".into()]);
    lamp(photometry, lamps, base, &mut lines);
    // direct ratios are not used by Lesk and depend on a method of their own
    lines.extend(std::iter::repeat_n("0".to_string(), super::RATIOS));
    lines.extend(c.iter().map(|x| digits(*x)));
    lines.extend(web.v().iter().map(|x| digits(*x)));
    let first = if symmetry == Symmetry::C90C270 { c.len() * 3 / 4 } else { 0 };
    for i in 0..stored_planes(symmetry, c.len()) {
        let plane = web.plane((first + i) % c.len());
        lines.extend(plane.iter().map(|x| digits(x * 1000.0 / base)));
    }
    Ok(lines.join("\r\n") + "\r\n")
}

/// The symmetry that can be stored, and the C angles of a whole turn without 360.
fn planes(photometry: &Photometry) -> (Symmetry, Vec<f64>) {
    let h = photometry.web.h();
    let symmetry = photometry.detected_symmetry();
    if symmetry == Symmetry::Rotational {
        return (symmetry, vec![0.0]);
    }
    let c = h[..h.len() - 1].to_vec();
    // the counts of stored planes divide the number of planes, so it must have a plane on each axis
    let even = match symmetry {
        Symmetry::C0C180 => c.len().is_multiple_of(2),
        _ => c.len().is_multiple_of(4),
    };
    let on_axes = [90.0, 180.0, 270.0].iter().enumerate().all(|(i, axis)| {
        let wanted = symmetry != Symmetry::C0C180 || *axis == 180.0;
        !wanted || c.get(c.len() * (i + 1) / 4).is_some_and(|x| (x - axis).abs() < 1e-6)
    });
    if symmetry == Symmetry::None || even && on_axes { (symmetry, c) } else { (Symmetry::None, c) }
}

/// The step of equally spaced angles, else 0.
fn step(angles: &[f64]) -> String {
    let Some(first) = angles.windows(2).map(|w| w[1] - w[0]).next() else { return "0".into() };
    let equal = angles.windows(2).all(|w| (w[1] - w[0] - first).abs() < 1e-6);
    if equal { digits(first) } else { "0".into() }
}

/// A description in one line, which holds at most 78 characters.
fn text(photometry: &Photometry, ours: &str, theirs: &str) -> String {
    let key = if photometry.format == Format::Eulumdat { ours } else { theirs };
    let text = if key.is_empty() { "" } else { photometry.text(key).unwrap_or("") };
    text.replace('\n', " ").chars().filter(|c| !c.is_control()).take(78).collect()
}

/// Millimetres of the luminaire and its luminous area: length along C90, width along C0.
fn extents(photometry: &Photometry, lines: &mut Vec<String>) {
    let mm = |x: f64| digits(1000.0 * x);
    let Opening { shape, size: [x, y, z] } = photometry.opening;
    let [width, length, height] = photometry.housing.map(|a| a.max(0.0));
    let shown = |own: f64, luminous: f64| mm(if own > 0.0 { own } else { luminous });
    let round = matches!(shape, OpeningShape::Ellipse | OpeningShape::Cylinder(2) | OpeningShape::Ellipsoid) && x == y;
    lines.extend([
        shown(length, y),
        if round && width == length { "0".into() } else { shown(width, x) },
        shown(height, z),
    ]);
    lines.extend([mm(y), if round { "0".into() } else { mm(x) }]);
    lines.extend(std::iter::repeat_n(mm(z), 4));
}

/// The lamp set, with the flux that the intensities relate to; its number is negative where they are absolute.
fn lamp(photometry: &Photometry, lamps: Option<f64>, base: f64, lines: &mut Vec<String>) {
    let set = photometry.lamps.get(photometry.lamp_set);
    let count = set.map_or(1.0, |set| set.count.abs().max(1.0));
    let clean = |text: &str| text.replace('\n', " ").chars().filter(|c| !c.is_control()).take(78).collect::<String>();
    lines.push(digits(if lamps.is_some() { count } else { -count }));
    lines.push(set.map_or(String::new(), |set| clean(&set.kind)));
    lines.push(digits(base));
    lines.push(set.map_or(String::new(), |set| clean(&set.color)));
    lines.push(set.map_or(String::new(), |set| clean(&set.rendering)));
    lines.push(digits(photometry.watts().unwrap_or(0.0)));
}
