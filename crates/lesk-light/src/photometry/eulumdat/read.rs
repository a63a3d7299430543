//! Reads EULUMDAT.

use super::super::planes::whole_turn;
use super::super::text::{Warnings, at, number, shown};
use super::super::{
    Coordinates, Counted, Format, LampSet, MAX_ANGLES, MAX_CANDELA, MAX_VALUES, Opening, OpeningShape, Photometry,
    Symmetry, Web,
};
use super::{HEAD, LAMP_LINES, MAX_SETS, RATIOS, SYMMETRIES, stored_planes};
use crate::error::LightError;

/// Whether lines 3, 4 and 6 hold the small numbers that belong there.
pub fn is_eulumdat(lines: &[&str]) -> bool {
    let small = |i: usize| {
        lines.get(i).and_then(|line| number(&line.trim().replace(',', "."))).is_some_and(|x| (0.0..1e9).contains(&x))
    };
    lines.len() >= 8 && small(2) && small(3) && small(5)
}

/// The lines of a file, by position.
struct Lines<'a, 'w> {
    lines: &'a [&'a str],
    warnings: &'w mut Warnings,
    /// Whether decimal commas have been reported.
    commas: bool,
}

impl<'a> Lines<'a, '_> {
    fn text(&self, i: usize, field: &str) -> Result<&'a str, LightError> {
        let missing = || {
            at(self.lines.len() as u32, field, format!("is missing: it belongs on line {}, but the file ends", i + 1))
        };
        self.lines.get(i).map(|line| line.trim()).ok_or_else(missing)
    }

    /// A number; `None` where the line is empty.
    fn maybe(&mut self, i: usize, field: &str) -> Result<Option<f64>, LightError> {
        let text = self.text(i, field)?;
        if text.is_empty() {
            return Ok(None);
        }
        if let Some(x) = number(text) {
            return Ok(Some(x));
        }
        let Some(x) = number(&text.replace(',', ".")) else {
            return Err(at(i as u32 + 1, field, format!("is {}, a finite number is accepted", shown(text))));
        };
        if !self.commas {
            self.commas = true;
            self.warnings.add(i as u32 + 1, field, "has a decimal comma, read as a point here and below")?;
        }
        Ok(Some(x))
    }

    fn number(&mut self, i: usize, field: &str) -> Result<f64, LightError> {
        self.maybe(i, field)?.ok_or_else(|| at(i as u32 + 1, field, "is empty, a number is accepted"))
    }

    /// A number within a range; an empty line counts as 0.
    fn within(&mut self, i: usize, field: &str, range: [f64; 2]) -> Result<f64, LightError> {
        let x = self.maybe(i, field)?.unwrap_or(0.0);
        if !(range[0]..=range[1]).contains(&x) {
            return Err(at(i as u32 + 1, field, format!("is {x}, {} to {} is accepted", range[0], range[1])));
        }
        Ok(x)
    }

    fn whole(&mut self, i: usize, field: &str, most: usize) -> Result<usize, LightError> {
        let x = self.number(i, field)?;
        if x.fract() != 0.0 || x < 0.0 || x > most as f64 {
            return Err(at(i as u32 + 1, field, format!("is {x}, a whole number from 0 to {most} is accepted")));
        }
        Ok(x as usize)
    }
}

/// Reads the lines of a file with one of its lamp sets.
pub fn read(lines: &[&str], lamp_set: usize, warnings: &mut Warnings) -> Result<Photometry, LightError> {
    let mut lines = Lines { lines, warnings, commas: false };
    let kind = lines.whole(2, "symmetry", 4)?;
    let symmetry = SYMMETRIES[kind];
    let planes = lines.whole(3, "number of C-planes", MAX_ANGLES)?;
    let gammas = lines.whole(5, "number of gamma angles", MAX_ANGLES)?;
    if planes == 0 || gammas < 2 || planes * gammas > MAX_VALUES {
        let text = format!("makes {planes} x {gammas} values, 1 x 2 to {MAX_VALUES} in all are accepted");
        return Err(at(6, "number of gamma angles", text));
    }
    let sets = lamps(&mut lines)?;
    let Some(lamp) = sets.get(lamp_set) else {
        return Err(LightError::new(format!("lamp set {lamp_set} does not exist, the file has {}", sets.len())));
    };
    let flux = lamp.flux.unwrap_or(0.0);
    if flux <= 0.0 {
        let line = HEAD + lamp_set * LAMP_LINES + 3;
        return Err(at(line as u32, "total luminous flux", format!("is {flux} lm, a positive one is accepted")));
    }
    let mut conversion = lines.within(23, "conversion factor", [0.0, 1e6])?;
    if conversion == 0.0 {
        lines.warnings.add(24, "conversion factor", "is 0, read as 1")?;
        conversion = 1.0;
    }
    let stated = lines.within(22, "light output ratio", [0.0, 1e6])? / 100.0;
    let web = table(&mut lines, symmetry, [planes, gammas], sets.len(), conversion * flux / 1000.0)?;
    let photometry = Photometry {
        format: Format::Eulumdat,
        texts: texts(&lines)?,
        web,
        symmetry,
        counted: Counted::Light,
        absolute: lamp.count < 0.0,
        opening: opening(&mut lines)?,
        housing: housing(&mut lines)?,
        lamps: sets,
        lamp_set,
        ballast_factor: 1.0,
        stated_lor: (stated > 0.0).then_some(stated),
        stated_flux: None,
        tilt: None,
        warnings: vec![],
    };
    compare(&photometry, &mut lines)?;
    Ok(photometry)
}

fn texts(lines: &Lines) -> Result<Vec<(String, String)>, LightError> {
    let fields = [(0, "maker"), (7, "report"), (8, "luminaire"), (9, "number"), (10, "file"), (11, "date")];
    fields.into_iter().map(|(i, name)| Ok((name.to_string(), lines.text(i, name)?.to_string()))).collect()
}

fn lamps(lines: &mut Lines) -> Result<Vec<LampSet>, LightError> {
    let count = lines.whole(25, "number of lamp sets", MAX_SETS)?;
    if count == 0 {
        return Err(at(26, "number of lamp sets", "is 0, at least 1 is accepted"));
    }
    let mut sets = Vec::new();
    for i in 0..count {
        let first = HEAD + i * LAMP_LINES;
        sets.push(LampSet {
            count: lines.within(first, "number of lamps", [-1e6, 1e6])?,
            kind: lines.text(first + 1, "type of lamps")?.to_string(),
            flux: Some(lines.within(first + 2, "total luminous flux", [0.0, 1e9])?),
            color: lines.text(first + 3, "colour temperature")?.to_string(),
            rendering: lines.text(first + 4, "colour rendering")?.to_string(),
            watts: lines.maybe(first + 5, "wattage")?.unwrap_or(0.0).max(0.0),
        });
    }
    Ok(sets)
}

/// Extents of the luminaire: its length lies along C90, its width along C0; width 0 is a circle.
fn housing(lines: &mut Lines) -> Result<[f64; 3], LightError> {
    let mm = [0.0, 1e7];
    let length = lines.within(12, "length of luminaire", mm)? / 1000.0;
    let width = lines.within(13, "width of luminaire", mm)? / 1000.0;
    let height = lines.within(14, "height of luminaire", mm)? / 1000.0;
    Ok([if width == 0.0 { length } else { width }, length, height])
}

fn opening(lines: &mut Lines) -> Result<Opening, LightError> {
    let mm = [0.0, 1e7];
    let length = lines.within(15, "length of luminous area", mm)? / 1000.0;
    let width = lines.within(16, "width of luminous area", mm)? / 1000.0;
    let mut heights = [0.0; 4];
    for (i, height) in heights.iter_mut().enumerate() {
        *height = lines.within(17 + i, "height of luminous area", [-1e7, 1e7])?.max(0.0) / 1000.0;
    }
    // one height per side of the box; its mean keeps the area of the sides of a rectangle
    let height = heights.iter().sum::<f64>() / 4.0;
    let (shape, size) = match (length > 0.0, width > 0.0, height > 0.0) {
        (false, false, _) => (OpeningShape::Point, [0.0; 3]),
        (true, false, false) => (OpeningShape::Ellipse, [length, length, 0.0]),
        (true, false, true) => (OpeningShape::Cylinder(2), [length, length, height]),
        (_, _, false) => (OpeningShape::Rectangle, [width, length.max(1e-3), 0.0]),
        (_, _, true) => (OpeningShape::Box, [width, length.max(1e-3), height]),
    };
    Ok(Opening { shape, size })
}

/// Angles and intensities, multiplied by `factor`.
fn table(
    lines: &mut Lines,
    symmetry: Symmetry,
    [planes, gammas]: [usize; 2],
    sets: usize,
    factor: f64,
) -> Result<Web, LightError> {
    let first = HEAD + sets * LAMP_LINES + RATIOS;
    let stored = stored_planes(symmetry, planes);
    let needed = first + planes + gammas + stored * gammas;
    if lines.lines.len() < needed {
        let text = format!("end on line {}, but the counts need {needed} lines", lines.lines.len());
        return Err(at(lines.lines.len() as u32, "intensities", text));
    }
    let c = ascending(lines, first, planes, "C angles", [0.0, 360.0])?;
    let gamma = ascending(lines, first + planes, gammas, "gamma angles", [0.0, 180.0])?;
    let mut values = Vec::with_capacity(stored * gammas);
    let mut negative = None;
    for i in 0..stored * gammas {
        let line = first + planes + gammas + i;
        let x = lines.number(line, "intensities")?;
        if (x * factor).abs() > MAX_CANDELA {
            return Err(at(line as u32 + 1, "intensities", format!("has {x}, at most {MAX_CANDELA:e} cd is accepted")));
        }
        if x < 0.0 && negative.is_none() {
            negative = Some((line as u32 + 1, x));
        }
        values.push((x * factor).max(0.0));
    }
    if let Some((line, x)) = negative {
        lines.warnings.add(line, "intensities", format!("has {x}; negative values are read as 0"))?;
    }
    check_rest(lines, needed)?;
    if symmetry == Symmetry::Rotational || planes == 1 {
        return Ok(Web::new(Coordinates::C, gamma, vec![0.0], values));
    }
    let angles = stored_angles(symmetry, &c, stored);
    let list: Vec<(f64, &[f64])> = angles.into_iter().zip(values.chunks_exact(gammas)).collect();
    let (h, values) = whole_turn(&list, symmetry);
    Ok(Web::new(Coordinates::C, gamma, h, values))
}

/// The angles of the planes that are stored; about C90-C270 they run from C270 through C0 to C90.
fn stored_angles(symmetry: Symmetry, c: &[f64], stored: usize) -> Vec<f64> {
    let first = if symmetry == Symmetry::C90C270 { c.len() * 3 / 4 } else { 0 };
    (0..stored).map(|i| c[(first + i) % c.len()]).collect()
}

fn ascending(
    lines: &mut Lines,
    first: usize,
    count: usize,
    field: &str,
    within: [f64; 2],
) -> Result<Vec<f64>, LightError> {
    let mut angles: Vec<f64> = Vec::with_capacity(count);
    for i in first..first + count {
        let angle = lines.number(i, field)?;
        if !(within[0]..=within[1]).contains(&angle) {
            return Err(at(i as u32 + 1, field, format!("is {angle} deg, {} to {} is accepted", within[0], within[1])));
        }
        if let Some(last) = angles.last().filter(|last| angle <= **last) {
            return Err(at(i as u32 + 1, field, format!("is {angle} deg after {last} deg, but angles ascend")));
        }
        angles.push(angle);
    }
    Ok(angles)
}

/// Warns of whatever stands behind the last intensity.
fn check_rest(lines: &mut Lines, end: usize) -> Result<(), LightError> {
    match lines.lines.iter().enumerate().skip(end).find(|(_, line)| !line.trim().is_empty()) {
        Some((i, line)) => {
            let text = format!("has lines behind the last intensity, starting with {}", shown(line.trim()));
            lines.warnings.add(i as u32 + 1, "end of file", text)
        }
        None => Ok(()),
    }
}

/// Warns where the header declares another output ratio than the table has.
fn compare(photometry: &Photometry, lines: &mut Lines) -> Result<(), LightError> {
    let (Some(stated), Some(ratio)) = (photometry.stated_lor, photometry.light_output_ratio()) else { return Ok(()) };
    if (ratio / stated - 1.0).abs() <= 0.01 {
        return Ok(());
    }
    let text = format!("is {:.4} %, but the table has {:.4} %", 100.0 * stated, 100.0 * ratio);
    lines.warnings.add(23, "light output ratio", text)
}
