//! Reads LM-63 of all generations.

use super::super::planes::{SAME, Symmetry, whole_turn};
use super::super::text::{Warnings, at, decode, lines as lines_of, number, shown};
use super::super::{
    Coordinates, Counted, Format, LampSet, MAX_ANGLES, MAX_CANDELA, MAX_VALUES, Opening, Photometry, Tilt, Web,
};
use super::header::{Generation, generation, keywords, tilt_of};
use super::numbers::Numbers;
use crate::error::LightError;

const FOOT: f64 = 0.3048;

/// Reads the lines of a file. `tilt_file` gives the bytes of a file that `TILT=` names.
pub fn read(
    lines: &[&str],
    warnings: &mut Warnings,
    tilt_file: &dyn Fn(&str) -> Option<Vec<u8>>,
) -> Result<Photometry, LightError> {
    let (generation, label) = generation(lines, warnings)?;
    let Some(tilt_line) = lines.iter().position(|line| tilt_of(line).is_some()) else {
        return Err(LightError::new("file has no line that starts with `TILT=`")
            .hint("LM-63 wants `TILT=NONE` between the keywords and the numbers"));
    };
    let texts = keywords(&lines[label.min(tilt_line)..tilt_line]);
    let mut numbers = Numbers::new(lines, tilt_line + 1);
    let tilt = tilt(lines[tilt_line], tilt_line as u32 + 1, generation, &mut numbers, warnings, tilt_file)?;
    let head = head(generation, &mut numbers, warnings)?;
    let (web, symmetry) = table(&head, generation, &mut numbers, warnings)?;
    rest(&mut numbers, lines, warnings)?;
    let (counted, factor) = counted(&texts, label as u32, warnings)?;
    let kind = texts.iter().find(|(key, _)| key == "LAMP").map_or(String::new(), |(_, text)| text.clone());
    let absolute = head.lumens < 0.0;
    let lamps = LampSet {
        count: head.lamps,
        kind,
        flux: (head.lumens > 0.0).then_some(head.lamps.max(1.0) * head.lumens),
        color: String::new(),
        rendering: String::new(),
        watts: head.watts.max(0.0),
    };
    let stated_flux = stated_flux(&texts).map(|flux| flux * factor);
    let photometry = Photometry {
        format: Format::Ies(generation),
        web: web.scaled(factor),
        symmetry,
        counted,
        absolute,
        opening: head.opening,
        housing: [0.0; 3],
        lamps: vec![lamps],
        lamp_set: 0,
        ballast_factor: head.ballast,
        stated_lor: None,
        stated_flux,
        tilt,
        warnings: vec![],
        texts,
    };
    compare(&photometry, lines, warnings)?;
    Ok(photometry)
}

/// The two records of numbers before the angles.
struct Head {
    lamps: f64,
    lumens: f64,
    multiplier: f64,
    counts: [usize; 2],
    coordinates: Coordinates,
    opening: Opening,
    /// Ballast factor, times the ballast-lamp factor of 1986 and 1991.
    ballast: f64,
    watts: f64,
}

fn head(generation: Generation, numbers: &mut Numbers, warnings: &mut Warnings) -> Result<Head, LightError> {
    let lamps = numbers.next("number of lamps")?;
    if !(0.0..=1e6).contains(&lamps) {
        return Err(at(numbers.at, "number of lamps", format!("is {lamps}, 0 to 1000000 is accepted")));
    }
    let lumens = numbers.next("lumens per lamp")?;
    if lumens == 0.0 {
        warnings.add(numbers.at, "lumens per lamp", "is 0, read as unknown")?;
    } else if lumens < 0.0 && lumens != -1.0 {
        warnings.add(numbers.at, "lumens per lamp", format!("is {lumens}, read as -1: absolute photometry"))?;
    }
    let multiplier = factor(numbers, "candela multiplier", warnings)?;
    let nv = numbers.whole("number of vertical angles", 1, MAX_ANGLES)?;
    let nh = numbers.whole("number of horizontal angles", 1, MAX_ANGLES)?;
    if nv * nh > MAX_VALUES {
        return Err(at(
            numbers.at,
            "number of horizontal angles",
            format!("makes {nv} x {nh} values, at most {MAX_VALUES} are accepted"),
        ));
    }
    let coordinates = match numbers.next("photometric type")? {
        1.0 => Coordinates::C,
        2.0 => Coordinates::B,
        3.0 => Coordinates::A,
        other => {
            return Err(at(numbers.at, "photometric type", format!("is {other}, 1 (C), 2 (B) or 3 (A) is accepted")));
        }
    };
    let opening = opening(generation, numbers, warnings)?;
    let mut ballast = factor(numbers, "ballast factor", warnings)?;
    if generation <= Generation::Y1991 {
        ballast *= factor(numbers, "ballast-lamp photometric factor", warnings)?;
    } else {
        third_field(generation, numbers, warnings)?;
    }
    let watts = numbers.next("input watts")?;
    if watts < 0.0 {
        warnings.add(numbers.at, "input watts", format!("is {watts}, read as unknown"))?;
    }
    Ok(Head { lamps, lumens, multiplier, counts: [nv, nh], coordinates, opening, ballast, watts })
}

/// Units and luminous dimensions.
fn opening(generation: Generation, numbers: &mut Numbers, warnings: &mut Warnings) -> Result<Opening, LightError> {
    let unit = match numbers.next("units type")? {
        1.0 => FOOT,
        2.0 => 1.0,
        other => return Err(at(numbers.at, "units type", format!("is {other}, 1 (feet) or 2 (metres) is accepted"))),
    };
    let mut extents = [0.0; 3];
    for (extent, field) in extents.iter_mut().zip(["width", "length", "height"]) {
        *extent = numbers.next(field)? * unit;
        if extent.abs() > 1e4 {
            return Err(at(numbers.at, field, format!("is {extent} m, at most 10000 m is accepted")));
        }
    }
    match Opening::from_ies(generation.year(), extents) {
        Some(opening) => Ok(opening),
        None => {
            let [w, l, h] = extents.map(f64::abs);
            let text = format!("signs {extents:?} have no meaning in {}, read as a box", generation.name());
            warnings.add(numbers.at, "luminous dimensions", text)?;
            Ok(Opening::from_ies(2002, [w, l, h]).unwrap_or(Opening::POINT))
        }
    }
}

/// A factor that must be positive; 0 is read as 1.
fn factor(numbers: &mut Numbers, field: &str, warnings: &mut Warnings) -> Result<f64, LightError> {
    let x = numbers.next(field)?;
    if x == 0.0 {
        warnings.add(numbers.at, field, "is 0, read as 1")?;
        return Ok(1.0);
    }
    if !(1e-9..=1e9).contains(&x) {
        return Err(at(numbers.at, field, format!("is {x}, a positive factor up to 1e9 is accepted")));
    }
    Ok(x)
}

/// The field that was a factor until 1991, means nothing in 1995 and 2002, and codes how the file was made in 2019.
fn third_field(generation: Generation, numbers: &mut Numbers, warnings: &mut Warnings) -> Result<(), LightError> {
    if generation == Generation::Y2019 {
        numbers.next("file generation type")?;
    } else if numbers.next("future use")? != 1.0 {
        warnings.add(
            numbers.at,
            "future use",
            format!("is not 1; {} gives it no meaning, so it is skipped", generation.name()),
        )?;
    }
    Ok(())
}

/// What `TILT=` says.
fn tilt(
    line: &str,
    place: u32,
    generation: Generation,
    numbers: &mut Numbers,
    warnings: &mut Warnings,
    tilt_file: &dyn Fn(&str) -> Option<Vec<u8>>,
) -> Result<Option<Tilt>, LightError> {
    let Some((value, exact)) = tilt_of(line) else { return Ok(None) };
    if !exact {
        warnings.add(
            place,
            "TILT",
            format!("is written as {}, read as `TILT={}`", shown(line.trim_end()), value.to_ascii_uppercase()),
        )?;
    }
    if value.eq_ignore_ascii_case("NONE") {
        return Ok(None);
    }
    if value.eq_ignore_ascii_case("INCLUDE") {
        return tilt_section(numbers, warnings).map(Some);
    }
    if generation == Generation::Y2019 {
        warnings.add(place, "TILT", "names a file, which LM-63-2019 does not allow")?;
    }
    let Some(bytes) = tilt_file(value) else {
        warnings.add(
            place,
            "TILT",
            format!("names the file {}, which is not there; read as `TILT=NONE`", shown(value)),
        )?;
        return Ok(None);
    };
    let text = decode(&bytes, warnings)?;
    let own = lines_of(&text);
    let about = |e: LightError| LightError::new(format!("tilt file {}: {}", shown(value), e.message()));
    tilt_section(&mut Numbers::new(&own, 0), warnings).map(Some).map_err(about)
}

fn tilt_section(numbers: &mut Numbers, warnings: &mut Warnings) -> Result<Tilt, LightError> {
    let geometry = numbers.whole("lamp to luminaire geometry", 1, 3)? as u32;
    let count = numbers.whole("number of tilt angles", 1, MAX_ANGLES)?;
    let angles = numbers.angles("tilt angles", count, [-360.0, 360.0])?;
    let factors = numbers.list("tilt factors", count)?;
    if let Some(bad) = factors.iter().find(|f| !(0.0..=1e3).contains(*f)) {
        return Err(at(numbers.at, "tilt factors", format!("has {bad}, 0 to 1000 is accepted")));
    }
    if angles[0] == 0.0 && factors[0] != 1.0 {
        warnings.add(
            numbers.at,
            "tilt factors",
            format!("is {} at 0 deg; the intensities are left as they are", factors[0]),
        )?;
    }
    Ok(Tilt { geometry, angles, factors })
}

/// Angles and values.
fn table(
    head: &Head,
    generation: Generation,
    numbers: &mut Numbers,
    warnings: &mut Warnings,
) -> Result<(Web, Symmetry), LightError> {
    let [nv, nh] = head.counts;
    let range = if head.coordinates == Coordinates::C { [0.0, 180.0] } else { [-180.0, 180.0] };
    let v = numbers.angles("vertical angles", nv, range)?;
    let place = numbers.at;
    let h = numbers.angles("horizontal angles", nh, [-180.0, 360.0])?;
    let h_place = numbers.at;
    numbers.enough("candela values", nv * nh)?;
    let mut values = Vec::with_capacity(nv * nh);
    let mut negative = None;
    for _ in 0..nv * nh {
        let x = numbers.next("candela values")?;
        let scaled = x * head.multiplier * head.ballast;
        if scaled.abs() > MAX_CANDELA {
            return Err(at(numbers.at, "candela values", format!("has {x}, at most {MAX_CANDELA:e} cd is accepted")));
        }
        if x < 0.0 && negative.is_none() {
            negative = Some((numbers.at, x));
        }
        values.push(scaled.max(0.0));
    }
    if let Some((line, x)) = negative {
        warnings.add(line, "candela values", format!("has {x}; negative values are read as 0"))?;
    }
    match head.coordinates {
        Coordinates::C => type_c(v, h, values, generation, [place, h_place], warnings),
        other => type_ab(other, v, h, values, [place, h_place], warnings),
    }
}

fn type_c(
    v: Vec<f64>,
    h: Vec<f64>,
    values: Vec<f64>,
    generation: Generation,
    [place, h_place]: [u32; 2],
    warnings: &mut Warnings,
) -> Result<(Web, Symmetry), LightError> {
    let (first, last) = (v[0], v[v.len() - 1]);
    let legal = [(0.0, 90.0), (90.0, 180.0), (0.0, 180.0)];
    if v.len() < 2 {
        return Err(at(place, "vertical angles", format!("is {first} deg alone, at least two are accepted")));
    }
    if !legal.iter().any(|(a, b)| (a - first).abs() < SAME && (b - last).abs() < SAME) {
        warnings.add(
            place,
            "vertical angles",
            format!("run from {first} to {last} deg, not to 0, 90 or 180; it is dark beyond them"),
        )?;
    }
    let n = v.len();
    if h.len() == 1 || h.len() == 2 && h[0] == 0.0 && (h[1] - 360.0).abs() < SAME {
        if h.len() == 2 {
            warnings.add(h_place, "horizontal angles", "are 0 and 360 alone, read as rotational symmetry")?;
        } else if h[0] != 0.0 {
            warnings.add(h_place, "horizontal angles", format!("is {} alone, read as 0: rotational symmetry", h[0]))?;
        }
        return Ok((Web::new(Coordinates::C, v, vec![0.0], values[..n].to_vec()), Symmetry::Rotational));
    }
    let symmetry = span(&h, generation, h_place, warnings)?;
    let planes: Vec<(f64, &[f64])> = h.iter().copied().zip(values.chunks_exact(n)).collect();
    let (h, values) = whole_turn(&planes, symmetry);
    Ok((Web::new(Coordinates::C, v, h, values), symmetry))
}

/// The symmetry that horizontal angles of type C stand for.
fn span(h: &[f64], generation: Generation, place: u32, warnings: &mut Warnings) -> Result<Symmetry, LightError> {
    let field = "horizontal angles";
    let (first, last) = (h[0], h[h.len() - 1]);
    let is = |a: f64, b: f64| (first - a).abs() < SAME && (last - b).abs() < SAME;
    let known = [(0.0, 90.0, Symmetry::Quadrant), (0.0, 180.0, Symmetry::C0C180), (0.0, 360.0, Symmetry::None)];
    if let Some((.., symmetry)) = known.iter().find(|(a, b, _)| is(*a, *b)) {
        return Ok(*symmetry);
    }
    if is(90.0, 270.0) {
        if generation != Generation::Y1995 {
            warnings.add(place, field, "run from 90 to 270 deg, which only LM-63-1995 allows")?;
        }
        return Ok(Symmetry::C90C270);
    }
    if is(-90.0, 90.0) {
        warnings.add(place, field, "run from -90 to 90 deg, read as symmetric about C90-C270")?;
        return Ok(Symmetry::C90C270);
    }
    let step = h.windows(2).map(|w| w[1] - w[0]).fold(0.0, f64::max);
    if last - first > 180.0 && last - first + 1.001 * step >= 360.0 {
        if last - first < 360.0 - SAME {
            warnings.add(
                place,
                field,
                format!("end at {last} deg; the turn is closed with the plane at {first} deg"),
            )?;
        } else {
            warnings.add(place, field, format!("run from {first} to {last} deg, not from 0 to 360"))?;
        }
        return Ok(Symmetry::None);
    }
    Err(at(place, field, format!("run from {first} to {last} deg, 0 to 0, 90, 180 or 360 is accepted")))
}

fn type_ab(
    coordinates: Coordinates,
    v: Vec<f64>,
    h: Vec<f64>,
    values: Vec<f64>,
    [place, h_place]: [u32; 2],
    warnings: &mut Warnings,
) -> Result<(Web, Symmetry), LightError> {
    for (angles, place, field) in [(&v, place, "vertical angles"), (&h, h_place, "horizontal angles")] {
        if angles.len() < 2 {
            let text =
                format!("of type {} is {} deg alone, at least two are accepted", coordinates.letter(), angles[0]);
            return Err(at(place, field, text));
        }
    }
    // the angle that is a latitude
    let (latitude, where_, field) =
        if coordinates == Coordinates::A { (&v, place, "vertical angles") } else { (&h, h_place, "horizontal angles") };
    if latitude.iter().any(|x| x.abs() > 90.0 + SAME) {
        let text = format!("of type {} leave -90 to 90 deg", coordinates.letter());
        return Err(at(where_, field, text));
    }
    let n = v.len();
    let mut planes: Vec<(f64, Vec<f64>)> = h.iter().copied().zip(values.chunks_exact(n).map(<[f64]>::to_vec)).collect();
    let mirrored = h[0] == 0.0;
    if mirrored {
        let images: Vec<_> = planes.iter().skip(1).rev().map(|(angle, values)| (-angle, values.clone())).collect();
        planes.splice(0..0, images);
    }
    let mut v = v;
    if v[0] == 0.0 {
        warnings.add(place, "vertical angles", "start at 0 deg, read as mirrored to negative ones")?;
        let images: Vec<f64> = v.iter().skip(1).rev().map(|x| -x).collect();
        v.splice(0..0, images);
        for (_, values) in &mut planes {
            let images: Vec<f64> = values.iter().skip(1).rev().copied().collect();
            values.splice(0..0, images);
        }
    }
    let h: Vec<f64> = planes.iter().map(|p| p.0).collect();
    let values = planes.into_iter().flat_map(|p| p.1).collect();
    let symmetry = if mirrored { Symmetry::C90C270 } else { Symmetry::None };
    Ok((Web::new(coordinates, v, h, values), symmetry))
}

/// What stands behind the last value.
fn rest(numbers: &mut Numbers, lines: &[&str], warnings: &mut Warnings) -> Result<(), LightError> {
    let Some(word) = numbers.word() else { return Ok(()) };
    let place = numbers.at;
    if number(word).is_some() {
        let comma = |line: &&str| {
            line.as_bytes().windows(3).any(|w| w[1] == b',' && w[0].is_ascii_digit() && w[2].is_ascii_digit())
        };
        if lines[..place as usize].iter().any(comma) {
            return Err(at(place, "candela values", "has more numbers than the header announces")
                .hint("decimal commas cannot be told from separators: write points"));
        }
        return warnings.add(place, "candela values", "has more numbers than the header announces, they are skipped");
    }
    warnings.add(place, "end of file", format!("has text behind the last value, starting with {}", shown(word)))
}

/// What the intensities count, and the factor that makes W/sr of radiant ones.
fn counted(texts: &[(String, String)], line: u32, warnings: &mut Warnings) -> Result<(Counted, f64), LightError> {
    let units = [("mw/sr", 1e-3), ("uw/sr", 1e-6), ("µw/sr", 1e-6), ("w/sr", 1.0)];
    let unit = |text: &str| {
        let text: String = text.to_lowercase().chars().filter(|c| !c.is_whitespace()).collect();
        units.iter().find(|(unit, _)| text.contains(unit)).map(|(_, factor)| *factor)
    };
    if let Some((_, text)) = texts.iter().find(|(key, _)| key == "_INTENSITYUNITS") {
        return match unit(text) {
            Some(factor) => Ok((Counted::Power, factor)),
            None if text.to_lowercase().trim() == "cd" || text.to_lowercase().contains("candela") => {
                Ok((Counted::Light, 1.0))
            }
            None => {
                warnings.add(line + 1, "_INTENSITYUNITS", format!("is {}, read as cd", shown(text)))?;
                Ok((Counted::Light, 1.0))
            }
        };
    }
    let Some((key, factor)) = texts.iter().find_map(|(key, text)| Some((key, unit(text)?))) else {
        return Ok((Counted::Light, 1.0));
    };
    warnings.add(line + 1, key, "speaks of W/sr, so the values are read as radiant intensities")?;
    Ok((Counted::Power, factor))
}

/// The luminaire's flux where a keyword gives it.
fn stated_flux(texts: &[(String, String)]) -> Option<f64> {
    let keys = ["_TOTALLUMINAIRELUMENS", "_TOTAL_LUMINAIRE_LUMENS", "_LUMINAIRELUMENS", "_LUMINAIRE_LUMENS"];
    let (_, text) = texts.iter().find(|(key, _)| keys.contains(&key.as_str()))?;
    number(text.split_whitespace().next()?).filter(|x| *x > 0.0)
}

/// Warns where the header declares another flux than the table has.
fn compare(photometry: &Photometry, lines: &[&str], warnings: &mut Warnings) -> Result<(), LightError> {
    let Some(stated) = photometry.stated_flux else { return Ok(()) };
    let flux = photometry.flux();
    if (flux / stated - 1.0).abs() <= 0.01 {
        return Ok(());
    }
    let line = lines.iter().position(|line| line.to_ascii_uppercase().contains("LUMENS]")).map_or(1, |i| i as u32 + 1);
    warnings.add(line, "luminaire lumens", format!("is {stated}, but the table has the flux {flux:.6}"))
}
