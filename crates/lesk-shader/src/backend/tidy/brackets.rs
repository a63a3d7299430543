//! Brackets that change nothing: dropped by the rules of precedence that the four languages share.

use super::tokens::{Kind, Token};

/// How tightly an operator binds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Level {
    None,
    Choice,
    Or,
    And,
    Bits,
    Relation,
    Sum,
    Product,
    Sign,
    Atom,
}

/// The tokens that are not blank, with the bracket that belongs to each.
struct View {
    /// Positions in the token list.
    at: Vec<usize>,
    /// For each bracket, the index (into `at`) of its partner.
    partner: Vec<usize>,
    /// Brackets that are on their way out.
    dropped: Vec<bool>,
}

impl View {
    fn new(tokens: &[Token]) -> View {
        let at: Vec<usize> =
            (0..tokens.len()).filter(|&i| tokens[i].kind != Kind::Blank && !tokens[i].text.is_empty()).collect();
        let mut partner: Vec<usize> = (0..at.len()).collect();
        let mut open = Vec::new();
        for k in 0..at.len() {
            match &*tokens[at[k]].text {
                "(" => open.push(k),
                ")" => {
                    if let Some(start) = open.pop() {
                        (partner[start], partner[k]) = (k, start);
                    }
                }
                _ => {}
            }
        }
        let dropped = vec![false; at.len()];
        View { at, partner, dropped }
    }

    fn text<'t>(&self, tokens: &'t [Token], k: usize) -> &'t str {
        self.at.get(k).map_or("", |&i| &*tokens[i].text)
    }

    fn before<'t>(&self, tokens: &'t [Token], k: usize) -> &'t str {
        if k == 0 { "" } else { self.text(tokens, k - 1) }
    }

    /// Whether the operator at `k` has no left operand.
    fn is_prefix(&self, tokens: &[Token], k: usize) -> bool {
        let before = self.before(tokens, k);
        k == 0 || level(before) != Level::None || matches!(before, "(" | "," | "=" | "return" | "{" | ";")
    }

    /// The level of the operator at `k`, if it is one.
    fn level(&self, tokens: &[Token], k: usize) -> Level {
        match self.text(tokens, k) {
            "-" | "!" if self.is_prefix(tokens, k) => Level::Sign,
            text => level(text),
        }
    }
}

fn level(sign: &str) -> Level {
    match sign {
        "?" | ":" => Level::Choice,
        "||" => Level::Or,
        "&&" => Level::And,
        "|" | "&" | "^" | "<<" | ">>" => Level::Bits,
        "<" | ">" | "<=" | ">=" | "==" | "!=" => Level::Relation,
        "+" | "-" => Level::Sum,
        "*" | "/" | "%" => Level::Product,
        "!" => Level::Sign,
        _ => Level::None,
    }
}

/// `vec3(s)` and `(s).xxx` beside `+`, `-` or `/` become `s`: the languages widen a number beside a vector.
/// Elsewhere `(1.0).xxx` becomes `float3(1.0, 1.0, 1.0)`.
pub(super) fn drop_splats(tokens: &mut Vec<Token>) {
    let view = View::new(tokens);
    let widens = |sign: &str| matches!(sign, "+" | "-" | "/");
    let mut words = Vec::new();
    for open in 0..view.at.len() {
        let close = view.partner[open];
        if view.text(tokens, open) != "(" || close <= open {
            continue;
        }
        let is_swizzle = view.text(tokens, close + 1) == "." && view.text(tokens, close + 2) == "xxx";
        let is_call = matches!(view.before(tokens, open), "vec3" | "float3") && !has_comma(&view, tokens, open);
        let after = if is_swizzle { close + 3 } else { close + 1 };
        let widened = widens(view.text(tokens, after)) || widens(view.before(tokens, open - usize::from(is_call)));
        if is_call && widened {
            clear(tokens, view.at[open - 1]);
        }
        let is_number = close == open + 2 && tokens[view.at[open + 1]].kind == Kind::Number;
        if is_swizzle && (widened || is_number) {
            clear(tokens, view.at[close + 1]);
            clear(tokens, view.at[close + 2]);
            if !widened {
                let number = view.text(tokens, open + 1);
                tokens[view.at[open + 1]].text = format!("{number}, {number}, {number}").into();
                words.push(view.at[open]);
            }
        }
    }
    for at in words.into_iter().rev() {
        tokens.insert(at, Token { kind: Kind::Word, text: "float3".into() });
    }
}

fn has_comma(view: &View, tokens: &[Token], open: usize) -> bool {
    inside(view, tokens, open).any(|k| view.text(tokens, k) == ",")
}

/// The indices directly inside a bracket; brackets further in are skipped, unless they have been dropped.
fn inside<'v>(view: &'v View, tokens: &'v [Token], open: usize) -> impl Iterator<Item = usize> + 'v {
    let close = view.partner[open];
    let mut k = open + 1;
    core::iter::from_fn(move || {
        while k < close && view.dropped[k] {
            k += 1;
        }
        if k >= close {
            return None;
        }
        let here = k;
        k = if view.text(tokens, k) == "(" { view.partner[k].max(k) + 1 } else { k + 1 };
        Some(here)
    })
}

fn clear(tokens: &mut [Token], i: usize) {
    tokens[i].text = "".into();
}

/// Drops every bracket around an operand that binds more tightly than its surroundings.
pub(super) fn drop_needless(tokens: &mut [Token]) {
    let mut view = View::new(tokens);
    // from the inside out: what a bracket contains has been decided when its turn comes
    let mut pairs: Vec<usize> =
        (0..view.at.len()).filter(|&k| view.text(tokens, k) == "(" && view.partner[k] > k).collect();
    pairs.sort_by_key(|&open| view.partner[open]);
    for open in pairs {
        if is_needless(&view, tokens, open) {
            let close = view.partner[open];
            (view.dropped[open], view.dropped[close]) = (true, true);
        }
    }
    for k in 0..view.at.len() {
        if view.dropped[k] {
            clear(tokens, view.at[k]);
        }
    }
}

fn is_needless(view: &View, tokens: &[Token], open: usize) -> bool {
    let close = view.partner[open];
    let (before, after) = (view.before(tokens, open), view.text(tokens, close + 1));
    if open > 0 && tokens[view.at[open - 1]].kind == Kind::Word && before != "return" {
        return false;
    }
    let mut content = inside(view, tokens, open);
    let is_word = content.next().is_some_and(|k| tokens[view.at[k]].kind == Kind::Word) && content.next().is_none();
    if matches!(before, ")" | "]") || (matches!(after, "." | "[" | "{") && !is_word) || close == open + 1 {
        return false;
    }
    // a cast
    if close + 1 < view.at.len() && matches!(tokens[view.at[close + 1]].kind, Kind::Word | Kind::Number) {
        return false;
    }
    if has_comma(view, tokens, open) {
        return false;
    }
    let inner = inside(view, tokens, open).map(|k| view.level(tokens, k)).filter(|l| *l != Level::None).min();
    let inner = inner.unwrap_or(Level::Atom);
    let left = if open == 0 { Level::None } else { view.level(tokens, open - 1) };
    let right = if close + 1 < view.at.len() { view.level(tokens, close + 1) } else { Level::None };
    let first = inside(view, tokens, open).next().map_or("", |k| view.text(tokens, k));
    fits(inner, left, right, before, first)
}

fn fits(inner: Level, left: Level, right: Level, before: &str, first: &str) -> bool {
    let alone = left == Level::None && right == Level::None;
    match inner {
        Level::Atom => true,
        Level::None => false,
        Level::Choice => alone,
        // WGSL wants brackets where kinds of operators meet
        Level::Bits => alone,
        Level::Or | Level::And => alone || (left.max(right) == inner && left.min(right) <= Level::Choice),
        // WGSL reads `a < b, c > (d)` as a template
        Level::Relation => {
            let condition = |l| matches!(l, Level::None | Level::Choice | Level::And | Level::Or);
            condition(left) && condition(right) && (!alone || !matches!(before, "," | "("))
        }
        Level::Sum | Level::Product | Level::Sign => {
            let minus_twice = first == "-" && left != Level::None;
            inner > left && inner >= right && !minus_twice
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::tokens;
    use super::{drop_needless, drop_splats};
    use proptest::prelude::*;

    fn tidied(text: &str) -> String {
        let mut tokens = tokens::split(text);
        drop_splats(&mut tokens);
        drop_needless(&mut tokens);
        tokens.iter().map(|token| &*token.text).collect()
    }

    #[test]
    fn brackets_stay_where_they_matter() {
        for (given, expected) in [
            ("x = ((a + b) * c);", "x = (a + b) * c;"),
            ("x = (a + (b * c));", "x = a + b * c;"),
            ("x = (a - (b + c));", "x = a - (b + c);"),
            ("x = ((a * b) / c);", "x = a * b / c;"),
            ("x = (a / (b * c));", "x = a / (b * c);"),
            ("x = (-((a + b)) * c);", "x = -(a + b) * c;"),
            ("x = (a - (-(b)));", "x = a - (-b);"),
            ("x = -((wo).x);", "x = -wo.x;"),
            ("x = (a + b).x;", "x = (a + b).x;"),
            ("return (max((a + b), c));", "return max(a + b, c);"),
            ("x = ((a < b) ? (c + d) : (e * f));", "x = a < b ? c + d : e * f;"),
            ("x = ((c ? a : b) * d);", "x = (c ? a : b) * d;"),
            ("x = select(a, b, (c < d));", "x = select(a, b, (c < d));"),
            ("x = ((a < b) && (c < d));", "x = a < b && c < d;"),
            ("x = ((a && b) || c);", "x = (a && b) || c;"),
            ("if ((a && b)) {", "if (a && b) {"),
            ("x = ((v & 3u) | 1u);", "x = (v & 3u) | 1u;"),
            ("x = (v / vec3((a + b)));", "x = v / (a + b);"),
            ("x = (vec3(1.0) - v);", "x = 1.0 - v;"),
            ("x = max(v, vec3(a));", "x = max(v, vec3(a));"),
            ("x = lerp(v, (1.0).xxx, a);", "x = lerp(v, float3(1.0, 1.0, 1.0), a);"),
            ("x = (v / (a).xxx);", "x = v / a;"),
            ("GgxDraw r = (GgxDraw)0;", "GgxDraw r = (GgxDraw)0;"),
        ] {
            assert_eq!(tidied(given), expected);
        }
    }

    /// The value of an expression of digits, signs and brackets.
    struct Parser<'a>(core::iter::Peekable<core::str::Chars<'a>>);

    impl Parser<'_> {
        fn next_is(&mut self, signs: &[char]) -> Option<char> {
            self.0.next_if(|c| signs.contains(c))
        }
        fn sum(&mut self) -> f64 {
            let mut x = self.product();
            while let Some(sign) = self.next_is(&['+', '-']) {
                let y = self.product();
                x = if sign == '+' { x + y } else { x - y };
            }
            x
        }
        fn product(&mut self) -> f64 {
            let mut x = self.atom();
            while let Some(sign) = self.next_is(&['*', '/']) {
                let y = self.atom();
                x = if sign == '*' { x * y } else { x / y };
            }
            x
        }
        fn atom(&mut self) -> f64 {
            if self.next_is(&['-']).is_some() {
                return -self.atom();
            }
            if self.next_is(&['(']).is_some() {
                let x = self.sum();
                assert_eq!(self.0.next(), Some(')'));
                return x;
            }
            f64::from(self.0.next().and_then(|c| c.to_digit(10)).unwrap())
        }
    }

    fn value(text: &str) -> f64 {
        let text: String = text.chars().filter(|c| *c != ' ').collect();
        Parser(text.chars().peekable()).sum()
    }

    /// Expressions as naga writes them: brackets around every operation, and more.
    fn expression() -> impl Strategy<Value = String> {
        let digit = (1..10_u32).prop_map(|n| n.to_string());
        digit.prop_recursive(6, 64, 2, |inner| {
            prop_oneof![
                (inner.clone(), "[-+*/]", inner.clone()).prop_map(|(a, op, b)| format!("({a} {op} {b})")),
                inner.clone().prop_map(|a| format!("-({a})")),
                inner.prop_map(|a| format!("({a})")),
            ]
        })
    }

    proptest! {
        #[test]
        fn dropping_brackets_keeps_the_value(text in expression()) {
            let (before, after) = (value(&text), value(&tidied(&text)));
            // to the bit: not even the order of operations may change
            prop_assert_eq!(before.to_bits(), after.to_bits(), "{} became {}", text, tidied(&text));
        }
    }
}
