//! Tables of spectra: CSV and the .spd files of renderers.

use super::{Shape, Spectrum};
use crate::QuantityError;

/// Longest text of a table in bytes: a spectrometer with 0.01 nm steps stays below.
pub const MAX_TEXT: usize = 4 << 20;

impl Spectrum {
    /// Reads a table: two columns, wavelengths in nm and values, one row per line.
    ///
    /// Columns are parted by commas, semicolons, tabs, blanks or colons; with semicolons or tabs a comma may be the
    /// decimal point. Lines that start with `#` and lines of text before the first number are passed over; more columns
    /// are, too.
    ///
    /// # Errors
    /// `BadTable` with the line: too long, fewer than two rows, wavelengths outside 1 to 100 000 nm or not ascending,
    /// numbers that are not finite, no light at all.
    pub fn from_text(name: &str, text: &str) -> Result<Spectrum, QuantityError> {
        let bad = |line: usize, what: String| Err(QuantityError::BadTable { line, what });
        if text.len() > MAX_TEXT {
            return bad(0, format!("the table has {} bytes, at most {MAX_TEXT} are accepted", text.len()));
        }
        let mut rows: Vec<[f64; 2]> = Vec::new();
        for (i, line) in text.trim_start_matches('\u{feff}').lines().enumerate() {
            let line = line.trim();
            if line.is_empty() || line.starts_with('#') {
                continue;
            }
            let Some(row) = row(line) else {
                if rows.is_empty() {
                    continue;
                }
                let shown: String = line.chars().take(40).collect();
                return bad(
                    i + 1,
                    format!("`{shown}` is not two numbers, a wavelength in nm and a value are accepted"),
                );
            };
            if let Some(what) = fault(&rows, row) {
                return bad(i + 1, what);
            }
            rows.push(row);
        }
        if rows.len() < 2 {
            let hint = "two columns of numbers are accepted: a wavelength in nm and a value";
            return bad(
                0,
                format!("the table has {} rows of numbers, at least 2 are accepted\nhint: {hint}", rows.len()),
            );
        }
        let spectrum = Spectrum { name: name.to_string(), shape: Shape::Table(rows) };
        if spectrum.energy(None) > 0.0 {
            Ok(spectrum)
        } else {
            bad(0, "the table holds no light: the sum of its values is not positive".into())
        }
    }
}

/// The first two numbers of a line.
fn row(line: &str) -> Option<[f64; 2]> {
    let line = if line.contains([';', '\t']) { line.replace(',', ".") } else { line.to_string() };
    let parted = |c: char| c.is_whitespace() || matches!(c, ',' | ';' | ':');
    let mut words = line.split(parted).filter(|word| !word.is_empty()).map(|word| word.trim_matches('"'));
    Some([words.next()?.parse().ok()?, words.next()?.parse().ok()?])
}

/// Why a row cannot follow the rows before it.
fn fault(rows: &[[f64; 2]], [nm, value]: [f64; 2]) -> Option<String> {
    if !(1.0..=1e5).contains(&nm) {
        return Some(format!("wavelength {nm} nm, 1 to 100000 nm is accepted"));
    }
    // beyond 1e30 products with other numbers of the formulas could overflow
    if !(-1e30..=1e30).contains(&value) {
        return Some(format!("value {value}, a finite number up to 1e30 is accepted"));
    }
    let last = rows.last().map_or(0.0, |row| row[0]);
    // a step below 1e-6 nm is no measurement, and its slope would overflow
    (nm < last + 1e-6).then(|| format!("wavelength {nm} nm after {last} nm, ascending wavelengths are accepted"))
}
