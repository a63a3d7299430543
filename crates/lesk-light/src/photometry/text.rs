//! Text of photometric files: lines with numbers, warnings with their place.

use crate::error::LightError;
use std::borrow::Cow;
use std::fmt;

/// Largest file that is read, bytes; the largest one seen in the wild has 2 MB. Together with the other limits it keeps
/// the memory of reading below 64 MB.
pub const MAX_BYTES: usize = 8 << 20;
/// Most lines of a file; a table of the largest size has as many with one value per line.
const MAX_LINES: usize = 1 << 19;
/// Warnings beyond this number are not kept.
const MAX_WARNINGS: usize = 100;

/// Something that was repaired or is doubtful.
#[derive(Clone, Debug, PartialEq)]
pub struct Warning {
    /// Line of the file, from 1.
    pub line: u32,
    /// What the line holds, in the words of the standard.
    pub field: String,
    /// What is wrong and how it was read.
    pub text: String,
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "line {}: `{}`: {}", self.line, self.field, self.text)
    }
}

/// Collects warnings; in strict reading the first one is an error.
#[derive(Debug, Default)]
pub(super) struct Warnings {
    pub list: Vec<Warning>,
    strict: bool,
}

impl Warnings {
    pub fn new(strict: bool) -> Self {
        Warnings { list: Vec::new(), strict }
    }

    pub fn add(&mut self, line: u32, field: &str, text: impl Into<String>) -> Result<(), LightError> {
        let warning = Warning { line, field: field.to_string(), text: text.into() };
        if self.strict {
            return Err(LightError::new(warning.to_string()).hint("read it without `strict` to have this repaired"));
        }
        if self.list.len() < MAX_WARNINGS {
            self.list.push(warning);
        }
        Ok(())
    }
}

/// An error at a line, about a field.
pub(super) fn at(line: u32, field: &str, text: impl fmt::Display) -> LightError {
    LightError::new(format!("line {line}: `{field}` {text}"))
}

/// At most 40 characters of a text, for messages.
pub(super) fn shown(text: &str) -> String {
    let short: String = text.chars().filter(|c| !c.is_control()).take(40).collect();
    if short.len() < text.len() { format!("`{short}...`") } else { format!("`{short}`") }
}

/// The text of a file: UTF-8, else Latin-1; without byte order mark and end-of-file byte.
pub(super) fn decode<'a>(bytes: &'a [u8], warnings: &mut Warnings) -> Result<Cow<'a, str>, LightError> {
    if bytes.len() > MAX_BYTES {
        return Err(LightError::new(format!("file has {} bytes, at most {MAX_BYTES} are accepted", bytes.len())));
    }
    let without_mark = bytes.strip_prefix(b"\xef\xbb\xbf");
    if without_mark.is_some() {
        warnings.add(1, "first line", "starts with a byte order mark, which is skipped")?;
    }
    let bytes = without_mark.unwrap_or(bytes);
    let text = match std::str::from_utf8(bytes) {
        Ok(text) => Cow::Borrowed(text),
        Err(_) => Cow::Owned(bytes.iter().map(|&b| char::from(b)).collect()),
    };
    let breaks = text.bytes().filter(|b| matches!(b, b'\r' | b'\n')).count();
    if breaks > 2 * MAX_LINES || lines(&text).len() > MAX_LINES {
        return Err(LightError::new(format!("file has more than {MAX_LINES} lines")));
    }
    let Some(end) = text.find('\x1a') else { return Ok(text) };
    let line = lines(&text[..end]).len() as u32;
    warnings.add(line, "end of file", "has a DOS end-of-file byte (Ctrl-Z), which ends the reading")?;
    Ok(match text {
        Cow::Borrowed(text) => Cow::Borrowed(&text[..end]),
        Cow::Owned(mut text) => {
            text.truncate(end);
            Cow::Owned(text)
        }
    })
}

/// Lines that end in CR LF, LF or CR.
pub(super) fn lines(text: &str) -> Vec<&str> {
    // a CR LF counts twice
    let most = text.bytes().filter(|b| matches!(b, b'\r' | b'\n')).count() + 1;
    let mut lines = Vec::with_capacity(most);
    let mut rest = text;
    while let Some(end) = rest.find(['\r', '\n']) {
        lines.push(&rest[..end]);
        let skip = if rest[end..].starts_with("\r\n") { 2 } else { 1 };
        rest = &rest[end + skip..];
    }
    if !rest.is_empty() {
        lines.push(rest);
    }
    lines
}

/// A finite number; `nan`, `inf` and hexadecimal are none.
pub(super) fn number(text: &str) -> Option<f64> {
    text.parse::<f64>().ok().filter(|x| x.is_finite())
}

/// A number as files hold it: nine significant digits, no exponent, no needless zeros.
pub(super) fn digits(x: f64) -> String {
    if x == 0.0 {
        return "0".into();
    }
    let places = (8 - x.abs().log10().floor() as i32).clamp(0, 17) as usize;
    let text = format!("{x:.places$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_string() } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_end_in_three_ways() {
        assert_eq!(lines("a\r\nb\rc\n\nd"), ["a", "b", "c", "", "d"]);
        assert_eq!(lines("a\n"), ["a"]);
    }

    #[test]
    fn numbers_are_finite_decimals() {
        assert_eq!(number("1e3"), Some(1000.0));
        for bad in ["nan", "inf", "-infinity", "1e999", "0x10", "", "1,5"] {
            assert_eq!(number(bad), None, "{bad}");
        }
    }

    #[test]
    fn digits_are_nine_and_plain() {
        for (x, text) in
            [(0.0, "0"), (100.0, "100"), (1.0 / 3.0, "0.333333333"), (-2.5e-7, "-0.00000025"), (1e7, "10000000")]
        {
            assert_eq!(digits(x), text);
        }
    }
}
