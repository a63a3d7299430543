//! Conditions of claims: `diffuse + specular <= 1`, `alpha_x = alpha_y and ior > 1`.
//!
//! Comparisons of sums and products of parameters and numbers, joined by `and`. A comparison of colours holds where
//! it holds in every channel.

use crate::error::Error;
use lesk_bsdf::params::{Kind, ParamSpec, flat_len};
use lesk_math::CHANNELS;

/// A condition on the flat parameter table of one model.
#[derive(Clone, Debug, PartialEq)]
pub struct Condition {
    clauses: Vec<Clause>,
}

#[derive(Clone, Debug, PartialEq)]
struct Clause {
    left: Expr,
    relation: Relation,
    right: Expr,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Relation {
    Less,
    LessEqual,
    Greater,
    GreaterEqual,
    Equal,
}

#[derive(Clone, Debug, PartialEq)]
enum Expr {
    Number(f64),
    Param { spec: usize, offset: usize, kind: Kind },
    Negative(Box<Expr>),
    Binary(char, Box<Expr>, Box<Expr>),
}

/// Parentheses and signs may nest this deep.
const MAX_DEPTH: usize = 32;

impl Expr {
    fn value(&self, params: &[f64], channel: usize) -> f64 {
        match self {
            Expr::Number(x) => *x,
            Expr::Param { offset, kind: Kind::Scalar, .. } => params[*offset],
            Expr::Param { offset, kind: Kind::Color, .. } => params[offset + channel],
            Expr::Negative(a) => -a.value(params, channel),
            Expr::Binary(op, a, b) => {
                let (a, b) = (a.value(params, channel), b.value(params, channel));
                match op {
                    '+' => a + b,
                    '-' => a - b,
                    '*' => a * b,
                    _ => a / b,
                }
            }
        }
    }
}

impl Clause {
    fn holds(&self, params: &[f64]) -> bool {
        (0..CHANNELS).all(|c| {
            let (a, b) = (self.left.value(params, c), self.right.value(params, c));
            match self.relation {
                Relation::Less => a < b,
                Relation::LessEqual => a <= b,
                Relation::Greater => a > b,
                Relation::GreaterEqual => a >= b,
                Relation::Equal => a == b,
            }
        })
    }

    /// Sets the parameter that an equation is solved for; false where there is none, or its value is not legal.
    fn assign(&self, specs: &[ParamSpec], params: &mut [f64]) -> bool {
        let (target, source) = match (&self.left, &self.right) {
            (Expr::Param { .. }, source) => (&self.left, source),
            (source, Expr::Param { .. }) => (&self.right, source),
            _ => return false,
        };
        let Expr::Param { spec, offset, kind } = target else { return false };
        let [lo, hi] = specs[*spec].range;
        let channels = if *kind == Kind::Color { CHANNELS } else { 1 };
        (0..channels).all(|c| {
            let value = source.value(params, c);
            params[offset + c] = value;
            value >= lo && value <= hi
        })
    }
}

impl Condition {
    /// Reads a condition on the parameters of `specs`.
    pub fn parse(text: &str, specs: &'static [ParamSpec]) -> Result<Condition, Error> {
        let tokens = tokens(text)?;
        let mut parser = Parser { text, specs, tokens, at: 0, depth: 0 };
        let mut clauses = vec![parser.clause()?];
        while parser.accept("and") {
            clauses.push(parser.clause()?);
        }
        match parser.peek() {
            None => Ok(Condition { clauses }),
            Some(_) => Err(parser.expected("`and` or the end")),
        }
    }

    /// Whether a flat parameter table fulfils it.
    pub fn holds(&self, params: &[f64]) -> bool {
        self.clauses.iter().all(|clause| clause.holds(params))
    }

    /// Whether it contains an equation, which chance alone never fulfils.
    pub fn has_equation(&self) -> bool {
        self.clauses.iter().any(|clause| clause.relation == Relation::Equal)
    }

    /// Fulfils the equations by assigning to a parameter that stands alone on one side. False where that gives an
    /// illegal value or the whole does not hold afterwards.
    pub fn solve(&self, specs: &[ParamSpec], params: &mut [f64]) -> bool {
        let mut equations = self.clauses.iter().filter(|clause| clause.relation == Relation::Equal);
        equations.all(|clause| clause.holds(params) || clause.assign(specs, params)) && self.holds(params)
    }
}

struct Token<'a> {
    text: &'a str,
    column: usize,
}

/// Cuts the text into names, numbers and signs.
fn tokens(text: &str) -> Result<Vec<Token<'_>>, Error> {
    let mut tokens = Vec::new();
    let mut rest = text;
    loop {
        rest = rest.trim_start();
        let column = text[..text.len() - rest.len()].chars().count() + 1;
        let Some(first) = rest.chars().next() else { return Ok(tokens) };
        let length = if first.is_ascii_digit() || first == '.' {
            number_length(rest)
        } else if first.is_ascii_alphabetic() || first == '_' {
            rest.find(|c: char| !c.is_ascii_alphanumeric() && c != '_').unwrap_or(rest.len())
        } else if rest.starts_with("<=") || rest.starts_with(">=") {
            2
        } else if "+-*/()<>=".contains(first) {
            1
        } else {
            let message = format!("`{first}` is not part of a condition");
            return Err(Error { condition: text.to_owned(), column, message, hint: None });
        };
        tokens.push(Token { text: &rest[..length], column });
        rest = &rest[length..];
    }
}

/// The length of the number at the start: digits, a point, an exponent with its sign.
fn number_length(text: &str) -> usize {
    let bytes = text.as_bytes();
    let mut n = 0;
    while n < bytes.len() {
        let sign = matches!(bytes[n], b'+' | b'-') && matches!(bytes[n - 1], b'e' | b'E');
        if !(bytes[n].is_ascii_digit() || matches!(bytes[n], b'.' | b'e' | b'E') || sign) {
            break;
        }
        n += 1;
    }
    n
}

struct Parser<'a> {
    text: &'a str,
    specs: &'static [ParamSpec],
    tokens: Vec<Token<'a>>,
    at: usize,
    depth: usize,
}

impl<'a> Parser<'a> {
    fn peek(&self) -> Option<&'a str> {
        self.tokens.get(self.at).map(|token| token.text)
    }

    fn accept(&mut self, text: &str) -> bool {
        let found = self.peek() == Some(text);
        self.at += usize::from(found);
        found
    }

    fn error(&self, message: String, hint: Option<String>) -> Error {
        let column = self.tokens.get(self.at).map_or(self.text.chars().count() + 1, |token| token.column);
        Error { condition: self.text.to_owned(), column, message, hint }
    }

    fn expected(&self, what: &str) -> Error {
        let found = self.peek().map_or("nothing".to_owned(), |text| format!("`{text}`"));
        self.error(format!("{found} stands where {what} is expected"), None)
    }

    fn clause(&mut self) -> Result<Clause, Error> {
        let left = self.sum()?;
        let relation = match self.peek() {
            Some("<") => Relation::Less,
            Some("<=") => Relation::LessEqual,
            Some(">") => Relation::Greater,
            Some(">=") => Relation::GreaterEqual,
            Some("=") => Relation::Equal,
            _ => return Err(self.expected("one of `<`, `<=`, `>`, `>=`, `=`")),
        };
        self.at += 1;
        Ok(Clause { left, relation, right: self.sum()? })
    }

    fn sum(&mut self) -> Result<Expr, Error> {
        let mut left = self.product()?;
        while let Some(op @ ("+" | "-")) = self.peek() {
            self.at += 1;
            left = Expr::Binary(op.chars().next().unwrap_or('+'), Box::new(left), Box::new(self.product()?));
        }
        Ok(left)
    }

    fn product(&mut self) -> Result<Expr, Error> {
        let mut left = self.factor()?;
        while let Some(op @ ("*" | "/")) = self.peek() {
            self.at += 1;
            left = Expr::Binary(op.chars().next().unwrap_or('*'), Box::new(left), Box::new(self.factor()?));
        }
        Ok(left)
    }

    fn factor(&mut self) -> Result<Expr, Error> {
        if self.depth == MAX_DEPTH {
            return Err(self.error(format!("nested deeper than {MAX_DEPTH}"), None));
        }
        self.depth += 1;
        let factor = self.factor_inside();
        self.depth -= 1;
        factor
    }

    fn factor_inside(&mut self) -> Result<Expr, Error> {
        if self.accept("-") {
            return Ok(Expr::Negative(Box::new(self.factor()?)));
        }
        if self.accept("(") {
            let inside = self.sum()?;
            return if self.accept(")") { Ok(inside) } else { Err(self.expected("`)`")) };
        }
        let Some(text) = self.peek() else { return Err(self.expected("a parameter or a number")) };
        let expr = match text.chars().next() {
            Some(c) if c.is_ascii_digit() || c == '.' => match text.parse() {
                Ok(number) => Expr::Number(number),
                Err(_) => return Err(self.error(format!("`{text}` is not a number"), None)),
            },
            Some(c) if (c.is_ascii_alphabetic() || c == '_') && text != "and" => self.parameter(text)?,
            _ => return Err(self.expected("a parameter or a number")),
        };
        self.at += 1;
        Ok(expr)
    }

    fn parameter(&self, name: &str) -> Result<Expr, Error> {
        match self.specs.iter().position(|spec| spec.name == name) {
            Some(spec) => Ok(Expr::Param { spec, offset: flat_len(&self.specs[..spec]), kind: self.specs[spec].kind }),
            None => {
                let names: Vec<&str> = self.specs.iter().map(|spec| spec.name).collect();
                let hint = format!("the parameters are {}", names.join(", "));
                Err(self.error(format!("`{name}` is not a parameter"), Some(hint)))
            }
        }
    }
}
