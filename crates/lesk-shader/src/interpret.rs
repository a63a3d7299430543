//! Interpreting a packed function: the check of packing and of the idioms.

use crate::packed::{Idiom, Op, Packed};
use lesk_math::expr::{Logic, Plain};
use lesk_math::{Vec3, vec3};

#[derive(Clone, Copy)]
enum Value<R> {
    Scalar(R),
    Vector(Vec3<R>),
    Bool(bool),
}

impl<R: Plain> Value<R> {
    fn vector(self) -> Vec3<R> {
        match self {
            Value::Scalar(x) => Vec3::splat(x),
            Value::Vector(v) => v,
            Value::Bool(_) => unreachable!("a condition is no number"),
        }
    }
    fn scalar(self) -> R {
        match self {
            Value::Scalar(x) => x,
            _ => unreachable!("packing knows the types"),
        }
    }
    fn truth(self) -> bool {
        matches!(self, Value::Bool(true))
    }
    fn map(self, f: impl Fn(R) -> R) -> Value<R> {
        match self {
            Value::Scalar(x) => Value::Scalar(f(x)),
            other => Value::Vector(other.vector().map(f)),
        }
    }
    fn zip(self, o: Value<R>, f: impl Fn(R, R) -> R) -> Value<R> {
        match (self, o) {
            (Value::Scalar(x), Value::Scalar(y)) => Value::Scalar(f(x, y)),
            _ => {
                let (a, b) = (self.vector(), o.vector());
                Value::Vector(vec3(f(a.x, b.x), f(a.y, b.y), f(a.z, b.z)))
            }
        }
    }
}

/// The results of `packed`, component after component, for vector arguments and the parameter structure's members.
pub fn interpret<R: Plain>(packed: &Packed, arguments: &[Vec3<R>], members: &[Vec<R>]) -> Vec<R> {
    let mut values: Vec<Value<R>> = Vec::with_capacity(packed.nodes.len());
    for op in &packed.nodes {
        let value = step(op, &values, arguments, members);
        values.push(value);
    }
    let components = |&output: &u32| match values[output as usize] {
        Value::Scalar(x) => vec![x],
        other => other.vector().to_array().to_vec(),
    };
    packed.outputs.iter().flat_map(components).collect()
}

fn step<R: Plain>(op: &Op, values: &[Value<R>], arguments: &[Vec3<R>], members: &[Vec<R>]) -> Value<R> {
    let at = |a: u32| values[a as usize];
    let literal = |bits: u64| R::lit(f64::from_bits(bits));
    match *op {
        Op::Const(bits) => Value::Scalar(literal(bits)),
        Op::ConstVector(bits) => Value::Vector(Vec3::from(bits.map(literal))),
        Op::Bool(b) => Value::Bool(b),
        Op::Argument(i) => Value::Vector(arguments[i as usize]),
        Op::Member(i) => match members[i as usize][..] {
            [x, y, z] => Value::Vector(vec3(x, y, z)),
            ref one => Value::Scalar(one[0]),
        },
        Op::Component(a, k) => Value::Scalar(at(a).vector().to_array()[k as usize]),
        Op::Compose(parts) => Value::Vector(Vec3::from(parts.map(|part| at(part).scalar()))),
        Op::Splat(a) => Value::Vector(at(a).vector()),
        Op::Unary(op, a) => at(a).map(|x| op.apply(x)),
        Op::Binary(op, a, b) => at(a).zip(at(b), |x, y| op.apply(x, y)),
        Op::Compare(op, a, b) => Value::Bool(op.apply(at(a).scalar(), at(b).scalar())),
        Op::Logic(Logic::And, a, b) => Value::Bool(at(a).truth() && at(b).truth()),
        Op::Logic(Logic::Or, a, b) => Value::Bool(at(a).truth() || at(b).truth()),
        Op::Not(a) => Value::Bool(!at(a).truth()),
        Op::Select(c, a, b) => at(if at(c).truth() { a } else { b }),
        Op::Dot(a, b) => Value::Scalar(at(a).vector().dot(at(b).vector())),
        Op::Idiom(idiom) => step_idiom(idiom, values),
    }
}

fn step_idiom<R: Plain>(idiom: Idiom, values: &[Value<R>]) -> Value<R> {
    let at = |a: u32| values[a as usize];
    match idiom {
        Idiom::Normalize(a) => {
            let v = at(a).vector();
            Value::Vector(v * (R::ONE / v.dot(v).sqrt()))
        }
        Idiom::Length(a) => Value::Scalar(at(a).vector().length()),
        Idiom::InverseSqrt(a) => at(a).map(|x| R::ONE / x.sqrt()),
        Idiom::Tan(a) => at(a).map(R::tan),
        Idiom::Reflect(v, n) => {
            let (v, n) = (at(v).vector(), at(n).vector());
            Value::Vector(v - n * (R::TWO * v.dot(n)))
        }
        Idiom::Mix(a, b, t) => {
            at(a).zip(at(t), |a, t| a * t.one_minus()).zip(at(b).zip(at(t), |b, t| b * t), |x, y| x + y)
        }
        Idiom::Clamp(x, lo, hi) => at(x).zip(at(lo), R::max).zip(at(hi), R::min),
    }
}
