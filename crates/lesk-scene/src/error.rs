//! The one error of this crate: every problem of a scene, with its place.

use std::fmt;
use std::ops::Range;
use std::path::PathBuf;

/// Where in a scene file something stands; nothing for scenes built in a program.
#[derive(Clone, Copy, Default, PartialEq, Eq)]
pub struct Place(Option<(usize, usize)>);

impl Place {
    /// Not in a file.
    pub const NONE: Place = Place(None);

    /// The bytes of a file.
    pub(crate) fn bytes(span: Option<Range<usize>>) -> Self {
        Place(span.map(|s| (s.start, s.end)))
    }
}

/// Nothing: a scene does not change when its lines move.
impl fmt::Debug for Place {
    fn fmt(&self, _: &mut fmt::Formatter<'_>) -> fmt::Result {
        Ok(())
    }
}

/// One thing that is wrong.
#[derive(Clone, Debug, PartialEq)]
pub struct Problem {
    /// What was given and what is accepted.
    pub message: String,
    /// What to do about it; empty where nothing helps.
    pub hint: String,
    /// Where it stands.
    pub place: Place,
}

impl Problem {
    pub(crate) fn new(place: Place, message: impl Into<String>) -> Self {
        Problem { message: message.into(), hint: String::new(), place }
    }

    pub(crate) fn hint(mut self, hint: impl Into<String>) -> Self {
        self.hint = hint.into();
        self
    }

    /// A word that is not in a list, with the nearest one.
    pub(crate) fn unknown_name(what: &str, given: &str, known: &[&str]) -> Self {
        let text = format!("there is no {what} `{}`, but {} are accepted", shown(given), known.join(", "));
        let near = nearest(&given.chars().take(64).collect::<String>(), known.iter().copied());
        Problem::new(Place::NONE, text).hint(near.map_or(String::new(), |name| format!("did you mean `{name}`?")))
    }

    /// A problem from an error text whose hint, if any, follows on a line of its own.
    pub(crate) fn from_text(place: Place, text: &str) -> Self {
        match text.split_once("\nhint: ") {
            Some((message, hint)) => Problem::new(place, message).hint(hint),
            None => Problem::new(place, text),
        }
    }
}

/// Message and hint, without the place.
impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)?;
        if self.hint.is_empty() { Ok(()) } else { write!(f, "\nhint: {}", self.hint) }
    }
}

impl std::error::Error for Problem {}

/// All problems of a scene, in the order of their places.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneError {
    problems: Vec<Problem>,
    file: Option<PathBuf>,
    text: String,
}

/// At most so many problems are printed.
const SHOWN: usize = 50;

impl SceneError {
    pub(crate) fn new(mut problems: Vec<Problem>, file: Option<PathBuf>, text: &str) -> Self {
        problems.sort_by_key(|p| p.place.0);
        problems.dedup();
        SceneError { problems, file, text: text.to_string() }
    }

    /// The problems; at least one.
    pub fn problems(&self) -> &[Problem] {
        &self.problems
    }

    /// Line and column of a problem, both from 1; `None` for a scene that was not read from text.
    pub fn position(&self, problem: &Problem) -> Option<(usize, usize)> {
        let (start, _) = problem.place.0?;
        let before = self.text.get(..start)?;
        let line_start = before.rfind('\n').map_or(0, |i| i + 1);
        Some((before.matches('\n').count() + 1, before[line_start..].chars().count() + 1))
    }

    fn write_problem(&self, f: &mut fmt::Formatter<'_>, problem: &Problem) -> fmt::Result {
        write!(f, "error: {}", problem.message)?;
        let name = self.file.as_ref().map_or("scene".into(), |p| p.display().to_string());
        if let Some((line, column)) = self.position(problem) {
            write!(f, "\n  --> {name}:{line}:{column}")?;
            self.write_excerpt(f, problem, line, column)?;
        } else if self.file.is_some() {
            write!(f, "\n  --> {name}")?;
        }
        if !problem.hint.is_empty() {
            write!(f, "\nhint: {}", problem.hint)?;
        }
        Ok(())
    }

    /// The line with a mark under what is meant; lines that are too long to help are left out.
    fn write_excerpt(&self, f: &mut fmt::Formatter<'_>, problem: &Problem, line: usize, column: usize) -> fmt::Result {
        let content = self.text.lines().nth(line - 1).unwrap_or("");
        if content.is_empty() || content.chars().count() > 160 || content.contains(char::is_control) {
            return Ok(());
        }
        let (start, end) = problem.place.0.unwrap_or((0, 0));
        let marked = self.text.get(start..end).map_or(1, |t| t.lines().next().unwrap_or("").chars().count());
        let width = line.to_string().len();
        let room = content.chars().count() + 1 - column.min(content.chars().count());
        let mark = "^".repeat(marked.clamp(1, room.max(1)));
        write!(f, "\n{line} | {content}\n{:width$} | {:skip$}{mark}", "", "", skip = column - 1)
    }
}

impl fmt::Display for SceneError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, problem) in self.problems.iter().take(SHOWN).enumerate() {
            if i > 0 {
                f.write_str("\n\n")?;
            }
            self.write_problem(f, problem)?;
        }
        if self.problems.len() > SHOWN {
            write!(f, "\n\n{} more errors are not shown", self.problems.len() - SHOWN)?;
        }
        Ok(())
    }
}

impl std::error::Error for SceneError {}

/// `hint: did you mean ...` for a misspelt name; empty where nothing is near.
pub(crate) fn nearest<'a>(given: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let scored = known.into_iter().map(|name| (strsim::damerau_levenshtein(given, name), name));
    let (distance, name) = scored.min_by_key(|(distance, _)| *distance)?;
    (distance <= 1 + name.chars().count() / 4).then_some(name)
}

/// The hint for an unknown name: the nearest known one, else all of them.
pub(crate) fn name_hint(given: &str, known: &[&str]) -> String {
    // a name of unbounded length would make the comparison slow
    let short: String = given.chars().take(64).collect();
    match nearest(&short, known.iter().copied()) {
        Some(name) => format!("did you mean `{name}`?"),
        None if known.is_empty() => String::new(),
        None => format!("known are {}", list(known)),
    }
}

/// `a`, `b` and `c`.
pub(crate) fn list(names: &[&str]) -> String {
    let quoted: Vec<String> = names.iter().take(40).map(|n| format!("`{n}`")).collect();
    let more = if names.len() > 40 { ", ..." } else { "" };
    quoted.join(", ") + more
}

/// At most 60 characters of what was given, without line breaks.
pub(crate) fn shown(text: &str) -> String {
    let mut out: String = text.trim().chars().take(60).map(|c| if c.is_control() { ' ' } else { c }).collect();
    if text.trim().chars().nth(60).is_some() {
        out.push('…');
    }
    out
}
