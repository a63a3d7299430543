//! Changes to whole lines.

/// The longest function header on one line.
const HEADER: usize = 110;

/// The text without the lines that fulfil a condition.
pub(in crate::backend) fn without(text: &str, drop: impl Fn(&str) -> bool) -> String {
    let keep: Vec<&str> = text.lines().filter(|line| !drop(line)).collect();
    keep.join("\n")
}

/// `T _e5 = x; return _e5;` becomes `return x;`.
pub(super) fn direct_returns(text: &str) -> String {
    let mut out: Vec<String> = Vec::new();
    for line in text.lines() {
        out.push(line.to_owned());
        while let Some(direct) = out.last().and_then(|last| direct_return(out.get(out.len().wrapping_sub(2))?, last)) {
            out.truncate(out.len() - 2);
            out.push(direct);
        }
    }
    out.join("\n")
}

fn direct_return(previous: &str, line: &str) -> Option<String> {
    let value = line.trim_start().strip_prefix("return ")?.strip_suffix(';')?;
    let (left, right) = previous.split_once(" = ")?;
    // only names that a writer made up
    let is_made_up = super::is_result(value) || (value.starts_with('q') && value.ends_with("z_1"));
    let indent = &previous[..previous.len() - previous.trim_start().len()];
    (is_made_up && left.ends_with(&format!(" {value}"))).then(|| format!("{indent}return {right}"))
}

/// Function headers that a writer spread over several lines, on one.
pub(super) fn joined_headers(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let mut header: Option<Vec<&str>> = None;
    for line in text.lines() {
        match &mut header {
            Some(parts) => {
                parts.push(line);
                if line.starts_with(')') {
                    out.push_str(&join(parts));
                    header = None;
                }
            }
            None if line.ends_with('(') && !line.starts_with(' ') => header = Some(vec![line]),
            None => {
                out.push_str(line);
                out.push('\n');
            }
        }
    }
    out.push_str(&header.unwrap_or_default().join("\n"));
    out
}

fn join(parts: &[&str]) -> String {
    let inner: Vec<&str> = parts[1..parts.len() - 1].iter().map(|part| part.trim()).collect();
    let line = format!("{}{}{}\n", parts[0], inner.join(" "), parts[parts.len() - 1]);
    if line.len() <= HEADER && !line.contains("[[") { line } else { parts.join("\n") + "\n" }
}

/// One blank line between definitions, none at the ends, none twice.
pub(super) fn spaced(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let (mut blank, mut ended) = (true, false);
    for line in text.lines().map(str::trim_end) {
        if line.is_empty() && blank {
            continue;
        }
        if ended && !line.is_empty() {
            out.push('\n');
        }
        out.push_str(line);
        out.push('\n');
        blank = line.is_empty();
        ended = matches!(line, "}" | "};");
    }
    out.truncate(out.trim_end().len());
    out.push('\n');
    out
}
