//! Words, numbers and signs of the four C-like languages, as naga's writers print them.

use std::borrow::Cow;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// A name, with its template arguments: `vec3<f32>`.
    Word,
    Number,
    /// An operator or bracket.
    Sign,
    /// White space, preprocessor lines and comments.
    Blank,
}

#[derive(Clone, Debug)]
pub(super) struct Token<'a> {
    pub(super) kind: Kind,
    pub(super) text: Cow<'a, str>,
}

const DOUBLE: [&str; 10] = ["<<", ">>", "<=", ">=", "==", "!=", "&&", "||", "->", "::"];

/// The whole text as tokens.
pub(super) fn split(text: &str) -> Vec<Token<'_>> {
    let mut tokens = Vec::with_capacity(text.len() / 3);
    let mut rest = text;
    while !rest.is_empty() {
        let (kind, length) = next(rest, rest.len() == text.len() || text[..text.len() - rest.len()].ends_with('\n'));
        let (token, after) = rest.split_at(length);
        tokens.push(Token { kind, text: Cow::Borrowed(token) });
        rest = after;
    }
    tokens
}

fn next(rest: &str, line_start: bool) -> (Kind, usize) {
    let until = |stop: fn(char) -> bool| rest.find(stop).unwrap_or(rest.len());
    let first = rest.chars().next().unwrap_or(' ');
    if (line_start && first == '#') || rest.starts_with("//") {
        return (Kind::Blank, until(|c| c == '\n'));
    }
    if first.is_whitespace() {
        return (Kind::Blank, until(|c| !c.is_whitespace()));
    }
    if is_word(first) && !first.is_ascii_digit() {
        let length = until(|c| !is_word(c));
        return (Kind::Word, length + template(&rest[length..]));
    }
    if first.is_ascii_digit() {
        return (Kind::Number, number(rest));
    }
    let double = DOUBLE.iter().any(|sign| rest.starts_with(sign));
    (Kind::Sign, if double { 2 } else { first.len_utf8() })
}

fn is_word(c: char) -> bool {
    c.is_ascii_alphanumeric() || c == '_'
}

/// The length of `<f32>`; a comparison has spaces around it.
fn template(rest: &str) -> usize {
    if !rest.starts_with('<') {
        return 0;
    }
    let inside = |c: char| is_word(c) || c == ',' || c == ' ' || c == ':';
    match rest[1..].find(|c| !inside(c)) {
        Some(at) if at > 0 && rest[1 + at..].starts_with('>') => at + 2,
        _ => 0,
    }
}

fn number(rest: &str) -> usize {
    let bytes = rest.as_bytes();
    let mut at = 0;
    while at < bytes.len() {
        let exponent = at > 0 && matches!(bytes[at], b'+' | b'-') && bytes[at - 1] == b'e';
        if !(is_word(bytes[at] as char) || bytes[at] == b'.' || exponent) {
            break;
        }
        at += 1;
    }
    at
}
