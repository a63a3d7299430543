//! Packed functions to naga's representation.

use crate::packed::{Idiom, Op, Ref, Type};
use crate::{Error, Function, Unit};
use lesk_math::expr::{Binary, Compare, Logic, Unary};
use naga::{
    BinaryOperator, Block, Expression, FunctionArgument, FunctionResult, Handle, Literal, LocalVariable, MathFunction,
    Module, Scalar, ScalarKind, Span, Statement, StructMember, TypeInner, UnaryOperator, VectorSize,
};
use std::collections::HashMap;

/// How names reach the text.
pub(super) enum Names {
    /// As they are (SPIR-V).
    Plain,
    /// As placeholders that no writer changes; [`super::tidy`] puts the entries in their place.
    Placeholders(Vec<String>),
}

impl Names {
    pub(super) fn add(&mut self, name: &str) -> String {
        match self {
            Names::Plain => name.to_owned(),
            Names::Placeholders(list) => {
                list.push(name.to_owned());
                super::tidy::placeholder(list.len() - 1)
            }
        }
    }
}

/// The types of a module.
pub(super) struct Types {
    pub(super) float: Handle<naga::Type>,
    pub(super) vector: Handle<naga::Type>,
    pub(super) bool: Handle<naga::Type>,
    /// None for a model without parameters.
    pub(super) params: Option<Handle<naga::Type>>,
}

impl Types {
    pub(super) fn of(&self, ty: Type) -> Handle<naga::Type> {
        match ty {
            Type::Scalar => self.float,
            Type::Vector => self.vector,
            Type::Bool => self.bool,
        }
    }
}

/// A unit as a module without entry point.
pub(super) struct Lowered {
    pub(super) module: Module,
    pub(super) types: Types,
    pub(super) functions: Vec<Handle<naga::Function>>,
    pub(super) names: Names,
}

/// Lowers the unit. `vector_size` is 12 or 16, the room that a vector takes in the parameter structure.
pub(super) fn lower(unit: &Unit, names: Names, vector_size: u32) -> Result<Lowered, Error> {
    let mut module = Module::default();
    let scalar = |kind, width| TypeInner::Scalar(Scalar { kind, width });
    let float = add_type(&mut module, None, scalar(ScalarKind::Float, 4));
    let bool = add_type(&mut module, None, scalar(ScalarKind::Bool, naga::BOOL_WIDTH));
    let vector = add_type(&mut module, None, TypeInner::Vector { size: VectorSize::Tri, scalar: Scalar::F32 });
    let mut lowered =
        Lowered { module, types: Types { float, vector, bool, params: None }, functions: Vec::new(), names };
    if !unit.members.is_empty() {
        let members: Vec<(&str, Type)> = unit.members.iter().map(|(name, ty)| (name.as_str(), *ty)).collect();
        let name = format!("{}Params", camel(&unit.id));
        lowered.types.params = Some(lowered.add_struct(&name, &members, vector_size));
    }
    for function in &unit.functions {
        lowered.add_function(unit, function, vector_size)?;
    }
    Ok(lowered)
}

/// `rough_dielectric` to `RoughDielectric`.
pub(super) fn camel(id: &str) -> String {
    let capital = |word: &str| word[..1].to_ascii_uppercase() + &word[1..];
    id.split('_').filter(|word| !word.is_empty()).map(capital).collect()
}

pub(super) fn add_type(module: &mut Module, name: Option<String>, inner: TypeInner) -> Handle<naga::Type> {
    module.types.insert(naga::Type { name, inner }, Span::UNDEFINED)
}

impl Lowered {
    fn add_struct(&mut self, name: &str, members: &[(&str, Type)], vector_size: u32) -> Handle<naga::Type> {
        let (mut offset, mut align, mut list) = (0_u32, 4, Vec::new());
        for (name, ty) in members {
            let (size, alignment) = if *ty == Type::Vector { (vector_size, 16) } else { (4, 4) };
            offset = offset.next_multiple_of(alignment);
            align = align.max(alignment);
            list.push(StructMember { name: Some(self.names.add(name)), ty: self.types.of(*ty), binding: None, offset });
            offset += size;
        }
        let span = offset.next_multiple_of(align);
        let name = self.names.add(name);
        add_type(&mut self.module, Some(name), TypeInner::Struct { members: list, span })
    }

    fn add_function(&mut self, unit: &Unit, function: &Function, vector_size: u32) -> Result<(), Error> {
        let result = match function.results[..] {
            [(_, ty)] => self.types.of(ty),
            _ => self.add_struct(
                &format!("{}{}", camel(&unit.id), camel(function.part.name())),
                &function.results,
                vector_size,
            ),
        };
        let name = self.names.add(&format!("{}_{}", unit.id, function.part.name()));
        let vectors = function.part.arguments().into_iter().map(|name| (name, self.types.vector));
        let arguments: Vec<(&str, Handle<naga::Type>)> = vectors.chain(self.types.params.map(|ty| ("p", ty))).collect();
        let argument = |(name, ty)| FunctionArgument { name: Some(self.names.add(name)), ty, binding: None };
        let naga_function = naga::Function {
            name: Some(name),
            arguments: arguments.into_iter().map(argument).collect(),
            result: Some(FunctionResult { ty: result, binding: None }),
            ..naga::Function::default()
        };
        let body = Body {
            function,
            out: naga_function,
            names: &mut self.names,
            types: &self.types,
            values: vec![None; function.packed.nodes.len()],
            arguments: Vec::new(),
            literals: HashMap::new(),
            from: 0,
        };
        let lowered = body.run(result)?;
        self.functions.push(self.module.functions.append(lowered, Span::UNDEFINED));
        Ok(())
    }
}

type Value = Handle<Expression>;

/// One function that is being lowered.
struct Body<'a> {
    function: &'a Function,
    out: naga::Function,
    names: &'a mut Names,
    types: &'a Types,
    /// Values that have been lowered and may be used again: the locals.
    values: Vec<Option<Value>>,
    arguments: Vec<Value>,
    literals: HashMap<Literal32, Value>,
    /// The first expression that has not been emitted.
    from: usize,
}

#[derive(Clone, Copy, PartialEq, Eq, Hash)]
enum Literal32 {
    Float(u32),
    Uint(u32),
    Bool(bool),
}

impl Body<'_> {
    fn run(mut self, result: Handle<naga::Type>) -> Result<naga::Function, Error> {
        for i in 0..self.out.arguments.len() as u32 {
            let argument = self.before_emit(Expression::FunctionArgument(i));
            self.arguments.push(argument);
        }
        let outputs = self.guarded()?;
        self.locals(&outputs)?;
        match self.function.results[..] {
            [(_, ty)] => {
                let value = self.as_type(outputs[0], ty)?;
                self.emit();
                self.out.body.push(Statement::Return { value: Some(value) }, Span::UNDEFINED);
            }
            _ => self.members(&outputs, result)?,
        }
        Ok(self.out)
    }

    /// Returns a structure, set member by member.
    fn members(&mut self, outputs: &[Ref], ty: Handle<naga::Type>) -> Result<(), Error> {
        let variable = LocalVariable { name: Some(self.names.add("result")), ty, init: None };
        let variable = self.out.local_variables.append(variable, Span::UNDEFINED);
        let base = self.before_emit(Expression::LocalVariable(variable));
        let results = &self.function.results;
        for (index, (&output, (_, ty))) in outputs.iter().zip(results).enumerate() {
            let value = self.as_type(output, *ty)?;
            let pointer = self.emitted(Expression::AccessIndex { base, index: index as u32 });
            self.emit();
            self.out.body.push(Statement::Store { pointer, value }, Span::UNDEFINED);
        }
        let value = self.emitted(Expression::Load { pointer: base });
        self.emit();
        self.out.body.push(Statement::Return { value: Some(value) }, Span::UNDEFINED);
        Ok(())
    }

    /// Lowers the locals in the order of the recording, which is the order of the model's formulas.
    fn locals(&mut self, outputs: &[Ref]) -> Result<(), Error> {
        let live = self.function.packed.live_from(outputs);
        for i in 0..live.len() {
            if live[i] && self.function.locals[i].is_some() {
                self.value(i as Ref)?;
            }
        }
        Ok(())
    }

    /// Turns a result that is 0 unless a condition holds into an early return; returns what remains.
    fn guarded(&mut self) -> Result<Vec<Ref>, Error> {
        let packed = &self.function.packed;
        let Op::Select(condition, value, zero) = packed.nodes[packed.outputs[0] as usize] else {
            return Ok(packed.outputs.clone());
        };
        if !packed.is_guarded(packed.outputs[0]) {
            return Ok(packed.outputs.clone());
        }
        let outside = self.opposite(condition)?;
        self.emit();
        let before = core::mem::take(&mut self.out.body);
        let zero = self.as_type(zero, self.function.results[0].1)?;
        self.emit();
        self.out.body.push(Statement::Return { value: Some(zero) }, Span::UNDEFINED);
        let accept = core::mem::replace(&mut self.out.body, before);
        self.out.body.push(Statement::If { condition: outside, accept, reject: Block::new() }, Span::UNDEFINED);
        Ok(vec![value])
    }

    /// The negation of a condition, for finite numbers.
    fn opposite(&mut self, condition: Ref) -> Result<Value, Error> {
        use BinaryOperator as B;
        let is_local = self.function.locals[condition as usize].is_some();
        let expression = match self.function.packed.nodes[condition as usize] {
            Op::Logic(op, a, b) if !is_local => {
                let op = if op == Logic::And { B::LogicalOr } else { B::LogicalAnd };
                Expression::Binary { op, left: self.opposite(a)?, right: self.opposite(b)? }
            }
            Op::Compare(op, a, b) if !is_local => self.comparison(op, a, b, true)?,
            Op::Not(a) if !is_local => return self.value(a),
            _ => Expression::Unary { op: UnaryOperator::LogicalNot, expr: self.value(condition)? },
        };
        Ok(self.emitted(expression))
    }

    fn before_emit(&mut self, expression: Expression) -> Value {
        self.emit();
        let value = self.out.expressions.append(expression, Span::UNDEFINED);
        self.from = self.out.expressions.len();
        value
    }

    fn emitted(&mut self, expression: Expression) -> Value {
        self.out.expressions.append(expression, Span::UNDEFINED)
    }

    fn emit(&mut self) {
        if self.from < self.out.expressions.len() {
            let range = self.out.expressions.range_from(self.from);
            self.out.body.push(Statement::Emit(range), Span::UNDEFINED);
        }
        self.from = self.out.expressions.len();
    }

    fn literal(&mut self, literal: Literal32) -> Value {
        if let Some(&known) = self.literals.get(&literal) {
            return known;
        }
        let expression = match literal {
            Literal32::Float(bits) => Literal::F32(f32::from_bits(bits)),
            Literal32::Uint(n) => Literal::U32(n),
            Literal32::Bool(b) => Literal::Bool(b),
        };
        let value = self.before_emit(Expression::Literal(expression));
        self.literals.insert(literal, value);
        value
    }

    fn float(&mut self, x: f64) -> Result<Value, Error> {
        if !(x as f32).is_finite() {
            return Err(Error::NotFinite { value: x });
        }
        Ok(self.literal(Literal32::Float((x as f32).to_bits())))
    }

    /// A vector where one is needed.
    fn as_type(&mut self, a: Ref, ty: Type) -> Result<Value, Error> {
        let value = self.value(a)?;
        if ty == Type::Vector && self.function.packed.types[a as usize] == Type::Scalar {
            return Ok(self.emitted(Expression::Splat { size: VectorSize::Tri, value }));
        }
        Ok(value)
    }

    fn value(&mut self, a: Ref) -> Result<Value, Error> {
        if let Some(known) = self.values[a as usize] {
            return Ok(known);
        }
        let value = self.operation(a)?;
        if let Some(name) = &self.function.locals[a as usize] {
            self.values[a as usize] = Some(value);
            let name = self.names.add(name);
            self.out.named_expressions.insert(value, name);
        }
        Ok(value)
    }

    fn operation(&mut self, a: Ref) -> Result<Value, Error> {
        let ty = self.function.packed.types[a as usize];
        let expression = match self.function.packed.nodes[a as usize] {
            Op::Const(bits) => return self.float(f64::from_bits(bits)),
            Op::Bool(b) => return Ok(self.literal(Literal32::Bool(b))),
            Op::Argument(i) => return Ok(self.arguments[i as usize]),
            Op::ConstVector(bits) => self.constant_vector(bits)?,
            Op::Member(index) => Expression::AccessIndex { base: self.arguments[2], index },
            Op::Component(v, k) => Expression::AccessIndex { base: self.value(v)?, index: u32::from(k) },
            Op::Compose([x, y, z]) => {
                let components = vec![self.value(x)?, self.value(y)?, self.value(z)?];
                Expression::Compose { ty: self.types.vector, components }
            }
            Op::Splat(x) => Expression::Splat { size: VectorSize::Tri, value: self.value(x)? },
            Op::Unary(op, x) => return self.unary(op, x),
            Op::Binary(op, x, y) => self.binary(op, x, y, ty)?,
            Op::Compare(op, x, y) => self.comparison(op, x, y, false)?,
            Op::Logic(op, x, y) => {
                let op = if op == Logic::And { BinaryOperator::LogicalAnd } else { BinaryOperator::LogicalOr };
                Expression::Binary { op, left: self.value(x)?, right: self.value(y)? }
            }
            Op::Not(x) => Expression::Unary { op: UnaryOperator::LogicalNot, expr: self.value(x)? },
            Op::Select(c, x, y) => Expression::Select {
                condition: self.value(c)?,
                accept: self.as_type(x, ty)?,
                reject: self.as_type(y, ty)?,
            },
            Op::Dot(x, y) => math(MathFunction::Dot, &[self.value(x)?, self.value(y)?]),
            Op::Idiom(idiom) => self.idiom(idiom, ty)?,
        };
        Ok(self.emitted(expression))
    }

    fn constant_vector(&mut self, bits: [u64; 3]) -> Result<Expression, Error> {
        let [x, y, z] = bits.map(f64::from_bits);
        let components = vec![self.float(x)?, self.float(y)?, self.float(z)?];
        if x == y && y == z {
            return Ok(Expression::Splat { size: VectorSize::Tri, value: components[0] });
        }
        Ok(Expression::Compose { ty: self.types.vector, components })
    }

    fn unary(&mut self, op: Unary, x: Ref) -> Result<Value, Error> {
        use MathFunction as M;
        let arg = self.value(x)?;
        let function = match op {
            Unary::Neg => return Ok(self.emitted(Expression::Unary { op: UnaryOperator::Negate, expr: arg })),
            Unary::Exp2Int => return Ok(self.power_of_two(arg)),
            Unary::Mantissa => return Ok(self.mantissa(arg)),
            Unary::Exponent => return Ok(self.exponent(arg)),
            Unary::Sqrt => M::Sqrt,
            Unary::Abs => M::Abs,
            Unary::Round => M::Round,
            Unary::Exp2 => M::Exp2,
            Unary::Log2 => M::Log2,
            Unary::Exp => M::Exp,
            Unary::Ln => M::Log,
            Unary::Sin => M::Sin,
            Unary::Cos => M::Cos,
            Unary::Acos => M::Acos,
        };
        Ok(self.emitted(math(function, &[arg])))
    }

    fn binary(&mut self, op: Binary, x: Ref, y: Ref, ty: Type) -> Result<Expression, Error> {
        let operator = |op, left, right| Expression::Binary { op, left, right };
        if op == Binary::Mul {
            return Ok(operator(BinaryOperator::Multiply, self.value(x)?, self.value(y)?));
        }
        let (left, right) = (self.as_type(x, ty)?, self.as_type(y, ty)?);
        Ok(match op {
            Binary::Add => operator(BinaryOperator::Add, left, right),
            Binary::Sub => operator(BinaryOperator::Subtract, left, right),
            Binary::Div => operator(BinaryOperator::Divide, left, right),
            Binary::Mul => unreachable!("handled above"),
            Binary::Min => math(MathFunction::Min, &[left, right]),
            Binary::Max => math(MathFunction::Max, &[left, right]),
            Binary::Pow => math(MathFunction::Pow, &[left, right]),
            Binary::Atan2 => math(MathFunction::Atan2, &[left, right]),
        })
    }

    /// A comparison or, for finite numbers, its negation; a constant stands on the right.
    fn comparison(&mut self, op: Compare, a: Ref, b: Ref, negated: bool) -> Result<Expression, Error> {
        use BinaryOperator as B;
        let constant = |a: Ref| self.function.packed.number(a).is_some();
        let swap = constant(a) && !constant(b);
        let op = match (op == Compare::Lt, negated, swap) {
            (true, false, false) | (false, true, true) => B::Less,
            (false, false, false) | (true, true, true) => B::LessEqual,
            (true, false, true) | (false, true, false) => B::Greater,
            (false, false, true) | (true, true, false) => B::GreaterEqual,
        };
        let (left, right) = if swap { (b, a) } else { (a, b) };
        Ok(Expression::Binary { op, left: self.value(left)?, right: self.value(right)? })
    }

    fn idiom(&mut self, idiom: Idiom, ty: Type) -> Result<Expression, Error> {
        use MathFunction as M;
        Ok(match idiom {
            Idiom::Normalize(a) => math(M::Normalize, &[self.value(a)?]),
            Idiom::Length(a) => math(M::Length, &[self.value(a)?]),
            Idiom::InverseSqrt(a) => math(M::InverseSqrt, &[self.value(a)?]),
            Idiom::Tan(a) => math(M::Tan, &[self.value(a)?]),
            Idiom::Reflect(v, n) => math(M::Reflect, &[self.value(v)?, self.value(n)?]),
            Idiom::Mix(a, b, t) => {
                let (a, b) = (self.as_type(a, ty)?, self.as_type(b, ty)?);
                math(M::Mix, &[a, b, self.value(t)?])
            }
            Idiom::Clamp(x, lo, hi) => {
                math(M::Clamp, &[self.as_type(x, ty)?, self.as_type(lo, ty)?, self.as_type(hi, ty)?])
            }
        })
    }

    /// 2^n: adding 1.5 * 2^23 + 127 leaves the biased exponent in the low bits of the sum.
    fn power_of_two(&mut self, n: Value) -> Value {
        let shift = self.literal(Literal32::Float(12_583_039.0_f32.to_bits()));
        let place = self.literal(Literal32::Uint(23));
        let sum = self.emitted(Expression::Binary { op: BinaryOperator::Add, left: n, right: shift });
        let bits = self.bits(sum);
        let bits = self.emitted(Expression::Binary { op: BinaryOperator::ShiftLeft, left: bits, right: place });
        self.number_of_bits(bits)
    }

    fn mantissa(&mut self, x: Value) -> Value {
        let mask = self.literal(Literal32::Uint(0x007f_ffff));
        let one = self.literal(Literal32::Uint(0x3f80_0000));
        let bits = self.bits(x);
        let bits = self.emitted(Expression::Binary { op: BinaryOperator::And, left: bits, right: mask });
        let bits = self.emitted(Expression::Binary { op: BinaryOperator::InclusiveOr, left: bits, right: one });
        self.number_of_bits(bits)
    }

    fn exponent(&mut self, x: Value) -> Value {
        let place = self.literal(Literal32::Uint(23));
        let bias = self.literal(Literal32::Float(127.0_f32.to_bits()));
        let bits = self.bits(x);
        let biased = self.emitted(Expression::Binary { op: BinaryOperator::ShiftRight, left: bits, right: place });
        let number = self.emitted(Expression::As { expr: biased, kind: ScalarKind::Float, convert: Some(4) });
        self.emitted(Expression::Binary { op: BinaryOperator::Subtract, left: number, right: bias })
    }

    fn bits(&mut self, x: Value) -> Value {
        self.emitted(Expression::As { expr: x, kind: ScalarKind::Uint, convert: None })
    }

    fn number_of_bits(&mut self, bits: Value) -> Value {
        self.emitted(Expression::As { expr: bits, kind: ScalarKind::Float, convert: None })
    }
}

fn math(fun: MathFunction, args: &[Value]) -> Expression {
    let argument = |k: usize| args.get(k).copied();
    Expression::Math { fun, arg: args[0], arg1: argument(1), arg2: argument(2), arg3: None }
}
