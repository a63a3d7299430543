//! Interpreting a graph: the check of every export, and the engine of models that are written at run time.

use super::Expr;
use super::graph::{Binary, Compare, Graph, Logic, Node, Unary};
use crate::Real;

impl Unary {
    /// The function for a plain number (constant folding and interpretation).
    pub fn apply<R: Plain>(self, x: R) -> R {
        match self {
            Unary::Neg => -x,
            Unary::Sqrt => x.sqrt(),
            Unary::Abs => x.abs(),
            Unary::Round => x.round(),
            Unary::Exp2 => x.exp2(),
            Unary::Log2 => x.log2(),
            Unary::Exp => x.exp(),
            Unary::Ln => x.ln(),
            Unary::Sin => x.sin(),
            Unary::Cos => x.cos(),
            Unary::Acos => x.acos(),
            Unary::Exp2Int => x.exp2(),
            Unary::Mantissa => x.split_plain().0,
            Unary::Exponent => x.split_plain().1,
        }
    }
}

impl Binary {
    /// The function for plain numbers.
    pub fn apply<R: Real>(self, a: R, b: R) -> R {
        match self {
            Binary::Add => a + b,
            Binary::Sub => a - b,
            Binary::Mul => a * b,
            Binary::Div => a / b,
            Binary::Min => a.min(b),
            Binary::Max => a.max(b),
            Binary::Pow => a.pow(b),
            Binary::Atan2 => a.atan2(b),
        }
    }
}

impl Compare {
    /// The comparison of plain numbers.
    pub fn apply<R: Real>(self, a: R, b: R) -> R::Mask {
        match self {
            Compare::Lt => a.lt(b),
            Compare::Le => a.le(b),
        }
    }
}

/// Numbers that a graph can be evaluated with.
pub trait Plain: Real<Mask = bool> {
    /// Mantissa in [1, 2) and exponent.
    fn split_plain(self) -> (Self, Self);
}
impl Plain for f32 {
    fn split_plain(self) -> (f32, f32) {
        crate::Bits::split(self)
    }
}
impl Plain for f64 {
    fn split_plain(self) -> (f64, f64) {
        let (m, e) = libm::frexp(self);
        (2.0 * m, f64::from(e - 1))
    }
}

#[derive(Clone, Copy)]
enum Value<R> {
    Number(R),
    Bool(bool),
}

impl Graph {
    /// The values of `outputs` for the given `inputs` (in the order of [`Graph::inputs`]).
    ///
    /// # Panics
    /// If there are fewer inputs than the graph has.
    pub fn evaluate<R: Plain>(&self, inputs: &[R], outputs: &[Expr]) -> Vec<R> {
        let mut values: Vec<Value<R>> = Vec::with_capacity(self.nodes.len());
        for node in &self.nodes {
            let number = |id: super::Id| match values[id.index as usize] {
                Value::Number(x) => x,
                Value::Bool(_) => unreachable!("numbers and conditions are different types while recording"),
            };
            let truth = |id: super::Id| matches!(values[id.index as usize], Value::Bool(true));
            let value = match *node {
                Node::Const(bits) => Value::Number(R::lit(f64::from_bits(bits))),
                Node::Bool(b) => Value::Bool(b),
                Node::Input(i) => Value::Number(inputs[i as usize]),
                Node::Unary(op, a) => Value::Number(op.apply(number(a))),
                Node::Binary(op, a, b) => Value::Number(op.apply(number(a), number(b))),
                Node::Compare(op, a, b) => Value::Bool(op.apply(number(a), number(b))),
                Node::Logic(Logic::And, a, b) => Value::Bool(truth(a) && truth(b)),
                Node::Logic(Logic::Or, a, b) => Value::Bool(truth(a) || truth(b)),
                Node::Not(a) => Value::Bool(!truth(a)),
                Node::Select(m, a, b) => Value::Number(if truth(m) { number(a) } else { number(b) }),
            };
            values.push(value);
        }
        let output = |e: &Expr| match e {
            Expr::Const(x) => R::lit(*x),
            Expr::Node(id) => match values[id.index as usize] {
                Value::Number(x) => x,
                Value::Bool(_) => unreachable!("an output is a number"),
            },
        };
        outputs.iter().map(output).collect()
    }
}
