//! The generations of LM-63 and the keywords of a file's label.

use super::super::text::{Warnings, shown};
use crate::error::LightError;

/// The edition of LM-63 that a file follows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Generation {
    /// LM-63-1986: no version line, free text.
    Y1986,
    /// LM-63-1991.
    Y1991,
    /// LM-63-1995.
    Y1995,
    /// LM-63-2002.
    Y2002,
    /// LM-63-2019.
    Y2019,
}

impl Generation {
    /// All editions, oldest first.
    pub const ALL: [Generation; 5] =
        [Generation::Y1986, Generation::Y1991, Generation::Y1995, Generation::Y2002, Generation::Y2019];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Generation::Y1986 => "LM-63-1986",
            Generation::Y1991 => "LM-63-1991",
            Generation::Y1995 => "LM-63-1995",
            Generation::Y2002 => "LM-63-2002",
            Generation::Y2019 => "LM-63-2019",
        }
    }

    /// The year of its publication.
    pub fn year(self) -> u32 {
        match self {
            Generation::Y1986 => 1986,
            Generation::Y1991 => 1991,
            Generation::Y1995 => 1995,
            Generation::Y2002 => 2002,
            Generation::Y2019 => 2019,
        }
    }

    /// The first line of its files.
    pub(super) fn tag(self) -> &'static str {
        match self {
            Generation::Y1986 => "",
            Generation::Y1991 => "IESNA91",
            Generation::Y1995 => "IESNA:LM-63-1995",
            Generation::Y2002 => "IESNA:LM-63-2002",
            Generation::Y2019 => "IES:LM-63-2019",
        }
    }
}

/// Whether some line looks like the tilt line, or the first one like a version.
pub fn is_ies(lines: &[&str]) -> bool {
    let first = lines.first().map_or("", |line| line.trim_start());
    first.get(..3).is_some_and(|word| word.eq_ignore_ascii_case("IES"))
        || lines.iter().any(|line| tilt_of(line).is_some())
}

/// What follows `TILT=`; with whether the line is exactly as the standard wants it.
pub(super) fn tilt_of(line: &str) -> Option<(&str, bool)> {
    let trimmed = line.trim();
    let word = trimmed.get(..4)?;
    if !word.eq_ignore_ascii_case("TILT") {
        return None;
    }
    let rest = trimmed[4..].trim_start().strip_prefix('=')?;
    let value = rest.trim();
    let word = value.to_ascii_uppercase();
    let known = word == "NONE" || word == "INCLUDE";
    let exact = line.starts_with("TILT=") && !line[5..].starts_with(char::is_whitespace) && (!known || value == word);
    Some((value, exact))
}

/// The edition by the first line, and the line where the label begins (from 0).
pub(super) fn generation(lines: &[&str], warnings: &mut Warnings) -> Result<(Generation, usize), LightError> {
    let first = lines.first().map_or("", |line| line.trim_end());
    for generation in Generation::ALL {
        if !generation.tag().is_empty() && first == generation.tag() {
            return Ok((generation, 1));
        }
    }
    let squeezed: String = first.chars().filter(|c| !c.is_whitespace()).collect::<String>().to_ascii_uppercase();
    if !squeezed.starts_with("IES") {
        return Ok((Generation::Y1986, 0));
    }
    if let Some(generation) = Generation::ALL.into_iter().find(|g| !g.tag().is_empty() && squeezed == g.tag()) {
        let text = format!("has blanks or small letters, read as `{}`", generation.tag());
        warnings.add(1, "version", text)?;
        return Ok((generation, 1));
    }
    let years =
        [("86", Generation::Y1986), ("91", Generation::Y1991), ("95", Generation::Y1995), ("19", Generation::Y2019)];
    // the year stands at the end: `IESNA95`, `IESNA:LM-63-1986/1991`
    let generation = match () {
        () if squeezed.contains("86") => Generation::Y1986,
        () => years.iter().find(|(end, _)| squeezed.ends_with(end)).map_or(Generation::Y2002, |(_, g)| *g),
    };
    let text = format!("is {}, which is no line of the standard; read as {}", shown(first), generation.name());
    warnings.add(1, "version", text)?;
    Ok((generation, 1))
}

/// Lines of a label beyond this number are not kept.
const MAX_LABEL: usize = 4096;

/// Keywords with their texts; `[MORE]` continues, lines without keyword are kept under an empty one.
pub(super) fn keywords(lines: &[&str]) -> Vec<(String, String)> {
    let mut found: Vec<(String, String)> = Vec::new();
    for line in lines.iter().take(MAX_LABEL).map(|line| line.trim()).filter(|line| !line.is_empty()) {
        let (key, value) = match line.strip_prefix('[').and_then(|rest| rest.split_once(']')) {
            Some((key, value)) => (key.trim().to_ascii_uppercase(), value.trim()),
            None => (String::new(), line),
        };
        match found.last_mut() {
            Some(last) if key == "MORE" => {
                last.1.push('\n');
                last.1.push_str(value);
            }
            _ => found.push((key, value.to_string())),
        }
    }
    found
}
