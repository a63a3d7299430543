//! The functions and spellings that a reader of shaders expects: `normalize`, `reflect`, `mix`, `a / b`, `a - b`.

use crate::packed::{Idiom, Op, Packed, Ref};
use lesk_math::expr::{Binary, Unary};

/// Rewrites a packed function, each operation after its operands.
pub fn rewrite(packed: &Packed) -> Packed {
    let live = packed.live();
    let mut uses = vec![0_u32; packed.nodes.len()];
    for (node, _) in packed.nodes.iter().zip(&live).filter(|(_, live)| **live) {
        for operand in node.operands() {
            uses[operand as usize] += 1;
        }
    }
    let mut rewriter = Rewriter { out: Packed::new(packed.members.clone()), once: Vec::new() };
    let mut new: Vec<Ref> = Vec::with_capacity(packed.nodes.len());
    for (i, node) in packed.nodes.iter().enumerate() {
        if !live[i] {
            new.push(0);
            continue;
        }
        let op = node.map(|operand| new[operand as usize]);
        let op = rewriter.improved(op);
        let known = rewriter.out.nodes.len();
        let value = rewriter.push(op);
        rewriter.once[value as usize] = value as usize >= known && uses[i] == 1;
        if let Some(name) = packed.names.get(&(i as Ref)) {
            rewriter.out.names.entry(value).or_insert(name);
        }
        new.push(value);
    }
    let outputs = packed.outputs.iter().map(|&output| rewriter.widened(new[output as usize])).collect();
    rewriter.out.outputs = outputs;
    rewriter.out
}

struct Rewriter {
    out: Packed,
    /// Which nodes have one user.
    once: Vec<bool>,
}

impl Rewriter {
    fn op(&self, a: Ref) -> Op {
        self.out.nodes[a as usize]
    }

    fn is_once(&self, a: Ref) -> bool {
        self.once[a as usize]
    }

    fn is(&self, a: Ref, x: f64) -> bool {
        self.out.number(a) == Some(x)
    }

    fn push(&mut self, op: Op) -> Ref {
        let value = self.out.push(op);
        self.once.resize(self.out.nodes.len(), true);
        value
    }

    /// Exchanges three copies of a choice with zero for a choice of vectors, which becomes an early return.
    fn widened(&mut self, output: Ref) -> Ref {
        let Op::Splat(x) = self.op(output) else { return output };
        let Op::Select(condition, value, zero) = self.op(x) else { return output };
        if !self.is(zero, 0.0) {
            return output;
        }
        let (value, zero) = (self.push(Op::Splat(value)), self.push(Op::ConstVector([0; 3])));
        self.push(Op::Select(condition, value, zero))
    }

    fn improved(&mut self, op: Op) -> Op {
        match op {
            Op::Unary(Unary::Sqrt, a) => match self.op(a) {
                Op::Dot(v, w) if v == w => Op::Idiom(Idiom::Length(v)),
                _ => op,
            },
            Op::Component(v, k) => match self.op(v) {
                Op::Unary(Unary::Neg, w) => Op::Unary(Unary::Neg, self.push(Op::Component(w, k))),
                _ => op,
            },
            Op::Binary(Binary::Div, a, b) => self.quotient(a, b).unwrap_or(op),
            Op::Binary(Binary::Mul, a, b) => self.product(a, b).or_else(|| self.product(b, a)).unwrap_or(op),
            Op::Binary(Binary::Add, a, b) => self.sum(a, b).or_else(|| self.sum(b, a)).unwrap_or(op),
            Op::Binary(Binary::Sub, a, b) => self.difference(a, b).unwrap_or(op),
            Op::Binary(Binary::Min, a, hi) => self.clamped(a, hi).unwrap_or(op),
            Op::Binary(Binary::Max, a, lo) if self.is_floored(a, lo) => self.op(a),
            _ => op,
        }
    }

    fn quotient(&self, a: Ref, b: Ref) -> Option<Op> {
        match (self.op(a), self.op(b)) {
            (_, Op::Unary(Unary::Sqrt, x)) if self.is(a, 1.0) && self.is_once(b) => {
                Some(Op::Idiom(Idiom::InverseSqrt(x)))
            }
            (Op::Unary(Unary::Sin, x), Op::Unary(Unary::Cos, y)) if x == y && self.is_once(a) && self.is_once(b) => {
                Some(Op::Idiom(Idiom::Tan(x)))
            }
            _ => None,
        }
    }

    /// `a * b`, with the recognised factor second.
    fn product(&self, a: Ref, b: Ref) -> Option<Op> {
        match self.op(b) {
            Op::Unary(Unary::Neg, y) => match self.op(a) {
                Op::Unary(Unary::Neg, x) => Some(Op::Binary(Binary::Mul, x, y)),
                _ => None,
            },
            Op::Binary(Binary::Div, one, x) if self.is(one, 1.0) && self.is_once(b) => {
                Some(Op::Binary(Binary::Div, a, x))
            }
            Op::Idiom(Idiom::InverseSqrt(x)) if self.is_length_squared(x, a) => Some(Op::Idiom(Idiom::Normalize(a))),
            _ => None,
        }
    }

    /// Whether `x` is `v . v`, or that with the floor of [`lesk_math::Real::safe_sqrt`].
    fn is_length_squared(&self, x: Ref, v: Ref) -> bool {
        match self.op(x) {
            Op::Binary(Binary::Max, square, floor) => {
                self.is(floor, 1e-36) && matches!(self.op(square), Op::Dot(a, b) if a == v && b == v)
            }
            Op::Dot(a, b) => a == v && b == v,
            _ => false,
        }
    }

    /// `a + b`, with the recognised summand second.
    fn sum(&mut self, a: Ref, b: Ref) -> Option<Op> {
        match self.op(b) {
            Op::Unary(Unary::Neg, x) => Some(Op::Binary(Binary::Sub, a, x)),
            Op::Const(bits) if f64::from_bits(bits) < 0.0 => {
                let positive = Op::Const((-f64::from_bits(bits)).to_bits());
                Some(Op::Binary(Binary::Sub, a, self.push(positive)))
            }
            Op::Binary(Binary::Mul, t, d) if self.is_once(b) => self.mix(a, t, d).or_else(|| self.mix(a, d, t)),
            _ => None,
        }
    }

    /// `a + t (b - a)`.
    fn mix(&self, a: Ref, t: Ref, difference: Ref) -> Option<Op> {
        match self.op(difference) {
            Op::Binary(Binary::Sub, b, from) if from == a => Some(Op::Idiom(Idiom::Mix(a, b, t))),
            _ => None,
        }
    }

    fn difference(&mut self, a: Ref, b: Ref) -> Option<Op> {
        if let Op::Unary(Unary::Neg, x) = self.op(b) {
            let sum = self.sum(a, x).or_else(|| self.sum(x, a));
            return sum.or(Some(Op::Binary(Binary::Add, a, x)));
        }
        // n (2 w.n) - w
        let Op::Binary(Binary::Mul, p, q) = self.op(a) else { return None };
        let n = [(p, q), (q, p)].into_iter().find_map(|(n, twice)| self.is_twice_cosine(twice, n, b).then_some(n))?;
        let incident = self.push(Op::Unary(Unary::Neg, b));
        Some(Op::Idiom(Idiom::Reflect(incident, n)))
    }

    fn is_twice_cosine(&self, twice: Ref, n: Ref, w: Ref) -> bool {
        let Op::Binary(Binary::Mul, two, cosine) = self.op(twice) else { return false };
        let matches = |a, b| (a == w && b == n) || (a == n && b == w);
        self.is(two, 2.0) && matches!(self.op(cosine), Op::Dot(a, b) if matches(a, b))
    }

    /// Whether `a` is `max(x, lo)` already.
    fn is_floored(&self, a: Ref, lo: Ref) -> bool {
        matches!(self.op(a), Op::Binary(Binary::Max, _, floor) if floor == lo)
    }

    fn clamped(&self, a: Ref, hi: Ref) -> Option<Op> {
        let Op::Binary(Binary::Max, x, lo) = self.op(a) else { return None };
        let ordered = self.out.number(lo)? <= self.out.number(hi)?;
        (ordered && self.is_once(a)).then_some(Op::Idiom(Idiom::Clamp(x, lo, hi)))
    }
}
