//! Readable text: names instead of placeholders, numbers as people write them, no needless brackets.

mod brackets;
mod lines;
mod tokens;

pub(super) use lines::without as without_lines;
use tokens::Kind;

/// A name that every writer leaves as it is: no keyword, no digit at the end.
pub(super) fn placeholder(k: usize) -> String {
    format!("q{k}z")
}

/// The word with its placeholder, if it has one, replaced. Writers put words of their own around some names.
fn resolved(word: &str, names: &[String]) -> Option<String> {
    for (start, _) in word.match_indices('q') {
        let rest = &word[start + 1..];
        let digits = rest.len() - rest.trim_start_matches(|c: char| c.is_ascii_digit()).len();
        let after = rest[digits..].strip_prefix('z');
        if let (Some(after), Some(name)) = (after, rest[..digits].parse().ok().and_then(|k: usize| names.get(k))) {
            return Some(format!("{}{name}{after}", &word[..start]));
        }
    }
    None
}

/// Makes a writer's text readable. `calls` names the results of the entry point's calls, in order.
pub(super) fn tidy(text: &str, names: &[String], calls: &[&str]) -> String {
    let text = lines::direct_returns(text);
    let mut tokens = tokens::split(&text);
    let mut results: Vec<String> = Vec::new();
    for token in &mut tokens {
        match token.kind {
            Kind::Word if is_result(&token.text) => {
                let known = results.iter().position(|result| *result == token.text);
                let k = known.unwrap_or_else(|| {
                    results.push(token.text.to_string());
                    results.len() - 1
                });
                if let Some(name) = calls.get(k) {
                    token.text = (*name).to_owned().into();
                }
            }
            Kind::Word => {
                if let Some(name) = resolved(&token.text, names) {
                    token.text = name.into();
                }
            }
            Kind::Number => token.text = number(&token.text).into(),
            _ => {}
        }
    }
    brackets::drop_splats(&mut tokens);
    brackets::drop_needless(&mut tokens);
    let text: String = tokens.iter().map(|token| &*token.text).collect();
    lines::spaced(&lines::joined_headers(&text))
}

/// Whether a writer made up this word for the result of a call: `_e12`.
fn is_result(word: &str) -> bool {
    word.strip_prefix("_e").is_some_and(|rest| !rest.is_empty() && rest.bytes().all(|b| b.is_ascii_digit()))
}

/// The shortest decimal that is the same `f32`; integers as they are.
fn number(text: &str) -> String {
    let digits = text.strip_suffix('f').unwrap_or(text);
    let is_float = digits.len() < text.len() || digits.contains(['.', 'e']);
    match digits.parse::<f32>() {
        Ok(x) if is_float => format!("{x:?}"),
        _ => text.to_owned(),
    }
}
