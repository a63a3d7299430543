//! Vector expressions: what a recorded graph of scalars is packed into.

use lesk_math::expr::{Binary, Compare, Logic, Unary};
use std::collections::HashMap;

/// An index into [`Packed::nodes`].
pub type Ref = u32;

/// The type of a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Type {
    Scalar,
    Vector,
    Bool,
}

/// One operation; operands are earlier nodes. Where a scalar meets a vector, it stands for three equal components.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Op {
    /// The bits of an `f64`.
    Const(u64),
    /// The bits of three `f64`.
    ConstVector([u64; 3]),
    Bool(bool),
    /// A vector argument of the function.
    Argument(u32),
    /// A member of the parameter structure.
    Member(u32),
    Component(Ref, u8),
    Compose([Ref; 3]),
    Splat(Ref),
    Unary(Unary, Ref),
    Binary(Binary, Ref, Ref),
    Compare(Compare, Ref, Ref),
    Logic(Logic, Ref, Ref),
    Not(Ref),
    /// Condition, value if true, value if false.
    Select(Ref, Ref, Ref),
    Dot(Ref, Ref),
    Idiom(Idiom),
}

/// What shading languages have a function for, but [`lesk_math::Real`] has not.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Idiom {
    Normalize(Ref),
    Length(Ref),
    InverseSqrt(Ref),
    Tan(Ref),
    /// `v - 2 (v . n) n` of (v, n).
    Reflect(Ref, Ref),
    /// `a (1 - t) + b t` of (a, b, t).
    Mix(Ref, Ref, Ref),
    /// Value, lower and upper bound.
    Clamp(Ref, Ref, Ref),
}

impl Op {
    /// The operands, in order.
    pub fn operands(&self) -> Operands {
        let (list, len) = match *self {
            Op::Const(_) | Op::ConstVector(_) | Op::Bool(_) | Op::Argument(_) | Op::Member(_) => ([0; 3], 0),
            Op::Component(a, _) | Op::Splat(a) | Op::Unary(_, a) | Op::Not(a) => ([a, 0, 0], 1),
            Op::Binary(_, a, b) | Op::Compare(_, a, b) | Op::Logic(_, a, b) | Op::Dot(a, b) => ([a, b, 0], 2),
            Op::Compose(list) => (list, 3),
            Op::Select(a, b, c) => ([a, b, c], 3),
            Op::Idiom(idiom) => idiom.operands(),
        };
        list.into_iter().take(len)
    }

    /// The same operation with every operand replaced.
    pub fn map(&self, f: impl Fn(Ref) -> Ref) -> Op {
        match *self {
            Op::Const(_) | Op::ConstVector(_) | Op::Bool(_) | Op::Argument(_) | Op::Member(_) => *self,
            Op::Component(a, k) => Op::Component(f(a), k),
            Op::Compose(list) => Op::Compose(list.map(f)),
            Op::Splat(a) => Op::Splat(f(a)),
            Op::Unary(op, a) => Op::Unary(op, f(a)),
            Op::Binary(op, a, b) => Op::Binary(op, f(a), f(b)),
            Op::Compare(op, a, b) => Op::Compare(op, f(a), f(b)),
            Op::Logic(op, a, b) => Op::Logic(op, f(a), f(b)),
            Op::Not(a) => Op::Not(f(a)),
            Op::Select(c, a, b) => Op::Select(f(c), f(a), f(b)),
            Op::Dot(a, b) => Op::Dot(f(a), f(b)),
            Op::Idiom(idiom) => Op::Idiom(idiom.map(f)),
        }
    }
}

/// The operands of one operation.
pub type Operands = core::iter::Take<core::array::IntoIter<Ref, 3>>;

impl Idiom {
    fn operands(self) -> ([Ref; 3], usize) {
        match self {
            Idiom::Normalize(a) | Idiom::Length(a) | Idiom::InverseSqrt(a) | Idiom::Tan(a) => ([a, 0, 0], 1),
            Idiom::Reflect(a, b) => ([a, b, 0], 2),
            Idiom::Mix(a, b, c) | Idiom::Clamp(a, b, c) => ([a, b, c], 3),
        }
    }

    fn map(self, f: impl Fn(Ref) -> Ref) -> Idiom {
        match self {
            Idiom::Normalize(a) => Idiom::Normalize(f(a)),
            Idiom::Length(a) => Idiom::Length(f(a)),
            Idiom::InverseSqrt(a) => Idiom::InverseSqrt(f(a)),
            Idiom::Tan(a) => Idiom::Tan(f(a)),
            Idiom::Reflect(a, b) => Idiom::Reflect(f(a), f(b)),
            Idiom::Mix(a, b, c) => Idiom::Mix(f(a), f(b), f(c)),
            Idiom::Clamp(a, b, c) => Idiom::Clamp(f(a), f(b), f(c)),
        }
    }
}

/// One function over scalars and vectors.
#[derive(Clone, Debug, Default)]
pub struct Packed {
    /// Operations, operands before users, no two alike.
    pub nodes: Vec<Op>,
    pub types: Vec<Type>,
    /// Names that the model's author gave.
    pub names: HashMap<Ref, &'static str>,
    /// One per result.
    pub outputs: Vec<Ref>,
    /// Types of the members of the parameter structure.
    pub members: Vec<Type>,
    known: HashMap<Op, Ref>,
}

impl Packed {
    /// An empty function over a parameter structure with these member types.
    pub fn new(members: Vec<Type>) -> Packed {
        Packed { members, ..Packed::default() }
    }

    /// Enters an operation, or finds it.
    pub fn push(&mut self, op: Op) -> Ref {
        if let Some(&known) = self.known.get(&op) {
            return known;
        }
        let next = self.nodes.len() as Ref;
        self.types.push(self.type_of(&op));
        self.nodes.push(op);
        self.known.insert(op, next);
        next
    }

    /// The number at `a`, if it is constant.
    pub fn number(&self, a: Ref) -> Option<f64> {
        match self.nodes[a as usize] {
            Op::Const(bits) => Some(f64::from_bits(bits)),
            _ => None,
        }
    }

    /// Whether `a` is the only result, and 0 unless a condition holds.
    pub fn is_guarded(&self, a: Ref) -> bool {
        let is_zero = |zero: Ref| matches!(self.nodes[zero as usize], Op::Const(0) | Op::ConstVector([0, 0, 0]));
        self.outputs == [a] && matches!(self.nodes[a as usize], Op::Select(_, _, zero) if is_zero(zero))
    }

    fn type_of(&self, op: &Op) -> Type {
        let of = |a: Ref| self.types[a as usize];
        let wider = |a: Ref, b: Ref| if of(a) == Type::Vector { Type::Vector } else { of(b) };
        match *op {
            Op::Const(_) | Op::Component(..) | Op::Dot(..) => Type::Scalar,
            Op::Bool(_) | Op::Compare(..) | Op::Logic(..) | Op::Not(_) => Type::Bool,
            Op::ConstVector(_) | Op::Argument(_) | Op::Compose(_) | Op::Splat(_) => Type::Vector,
            Op::Member(i) => self.members[i as usize],
            Op::Unary(_, a) => of(a),
            Op::Binary(_, a, b) | Op::Select(_, a, b) => wider(a, b),
            Op::Idiom(Idiom::Length(_)) => Type::Scalar,
            Op::Idiom(Idiom::Normalize(a) | Idiom::InverseSqrt(a) | Idiom::Tan(a) | Idiom::Reflect(a, _)) => of(a),
            Op::Idiom(Idiom::Clamp(a, ..)) => of(a),
            Op::Idiom(Idiom::Mix(a, b, t)) => {
                if of(t) == Type::Vector {
                    Type::Vector
                } else {
                    wider(a, b)
                }
            }
        }
    }

    /// Which nodes the outputs depend on.
    pub fn live(&self) -> Vec<bool> {
        self.live_from(&self.outputs)
    }

    /// Which nodes the given ones depend on.
    pub fn live_from(&self, outputs: &[Ref]) -> Vec<bool> {
        let mut live = vec![false; self.nodes.len()];
        for &output in outputs {
            live[output as usize] = true;
        }
        for i in (0..self.nodes.len()).rev() {
            if live[i] {
                for operand in self.nodes[i].operands() {
                    live[operand as usize] = true;
                }
            }
        }
        live
    }
}
