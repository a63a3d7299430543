//! Scalars back into vectors: three equal operations on x, y and z become one operation, a sum of three products
//! becomes a dot product, three unlike scalars a composed vector.

mod seeds;

use crate::Error;
use crate::packed::{Op, Packed, Ref};
use crate::record::{Input, Recording};
use lesk_math::Expr;
use lesk_math::expr::{Binary, Graph, Id, Node};
use std::collections::{HashMap, HashSet};

/// The longest chain of operations that is packed; the passes here are recursive.
const MAX_DEPTH: u32 = 1000;

/// The largest graph that is packed.
const MAX_NODES: usize = 100_000;

/// A scalar: a constant or a node of the graph.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum Item {
    Const(u64),
    Node(u32),
}

/// Three scalars that may become one vector.
type Triple = [Item; 3];

/// How three scalars are one operation on vectors.
#[derive(Clone, Copy)]
enum Shape {
    Unary(lesk_math::expr::Unary, Triple),
    Binary(Binary, Triple, Triple),
    Select(u32, Triple, Triple),
}

/// Packs a recording.
pub fn pack(recording: &Recording) -> Result<Packed, Error> {
    check_size(&recording.graph)?;
    let mut packer = Packer::new(recording);
    let outputs: Vec<Vec<Item>> =
        recording.outputs.iter().map(|o| o.components.iter().map(|&e| packer.output(e)).collect()).collect();
    packer.seed(&outputs);
    for output in &outputs {
        let value = match output[..] {
            [x, y, z] => packer.whole([x, y, z]),
            _ => packer.scalar(output[0]),
        };
        packer.packed.outputs.push(value);
    }
    Ok(packer.packed)
}

fn check_size(graph: &Graph) -> Result<(), Error> {
    if graph.nodes.len() > MAX_NODES {
        return Err(Error::TooLarge { nodes: graph.nodes.len(), limit: MAX_NODES });
    }
    let mut depth = vec![0_u32; graph.nodes.len()];
    for (i, node) in graph.nodes.iter().enumerate() {
        depth[i] = node.operands().map(|id| depth[id.index as usize] + 1).max().unwrap_or(0);
        if depth[i] > MAX_DEPTH {
            return Err(Error::TooDeep { limit: MAX_DEPTH });
        }
    }
    Ok(())
}

struct Packer<'a> {
    graph: &'a Graph,
    inputs: &'a [Input],
    live: Vec<bool>,
    packed: Packed,
    /// The vector of which a node is a component.
    home: Vec<Option<(Triple, u8)>>,
    /// The factors of a node that is a dot product.
    dots: HashMap<u32, [Triple; 2]>,
    /// Factors of dot products that are no operation on vectors, by their first component.
    composed: HashMap<u32, Triple>,
    /// Vectors that are one operation, or arguments.
    registered: HashSet<Triple>,
    /// Names of vectors and of scalars.
    names: HashMap<Triple, &'static str>,
    scalar_names: HashMap<u32, &'static str>,
    scalars: Vec<Option<Ref>>,
    vectors: HashMap<Triple, Ref>,
    /// Vectors that are being entered: their components must not refer to them.
    active: HashSet<Triple>,
}

impl<'a> Packer<'a> {
    fn new(recording: &'a Recording) -> Packer<'a> {
        let graph = &recording.graph;
        let outputs: Vec<Expr> = recording.outputs.iter().flat_map(|o| o.components.iter().copied()).collect();
        Packer {
            graph,
            inputs: &recording.inputs,
            live: graph.live(&outputs),
            packed: Packed::new(recording.members.clone()),
            home: vec![None; graph.nodes.len()],
            dots: HashMap::new(),
            composed: HashMap::new(),
            registered: HashSet::new(),
            names: HashMap::new(),
            scalar_names: HashMap::new(),
            scalars: vec![None; graph.nodes.len()],
            vectors: HashMap::new(),
            active: HashSet::new(),
        }
    }

    fn item(&self, id: Id) -> Item {
        match self.graph.nodes[id.index as usize] {
            Node::Const(bits) => Item::Const(bits),
            _ => Item::Node(id.index),
        }
    }

    fn output(&self, e: Expr) -> Item {
        match e {
            Expr::Const(x) => Item::Const(x.to_bits()),
            Expr::Node(id) => self.item(id),
        }
    }

    /// The operation that three scalars have in common.
    fn shape(&self, [x, y, z]: Triple) -> Option<Shape> {
        let (Item::Node(x), Item::Node(y), Item::Node(z)) = (x, y, z) else { return None };
        let [x, y, z] = [x, y, z].map(|i| self.graph.nodes[i as usize]);
        let triple = |a, b, c| [self.item(a), self.item(b), self.item(c)];
        match (x, y, z) {
            (Node::Unary(op, a), Node::Unary(op1, b), Node::Unary(op2, c)) if op == op1 && op == op2 => {
                Some(Shape::Unary(op, triple(a, b, c)))
            }
            (Node::Binary(op, a, l), Node::Binary(op1, b, m), Node::Binary(op2, c, n)) if op == op1 && op == op2 => {
                let (left, right) = (triple(a, b, c), triple(l, m, n));
                if matches!(op, Binary::Add | Binary::Mul) {
                    let [left, right] = self.aligned(left, right);
                    return Some(Shape::Binary(op, left, right));
                }
                Some(Shape::Binary(op, left, right))
            }
            (Node::Select(m, a, l), Node::Select(m1, b, p), Node::Select(m2, c, q)) if m == m1 && m == m2 => {
                Some(Shape::Select(m.index, triple(a, b, c), triple(l, p, q)))
            }
            _ => None,
        }
    }

    /// Operands of a commutative operation, exchanged per component so that vectors appear where there are any.
    fn aligned(&self, left: Triple, right: Triple) -> [Triple; 2] {
        let swapped = |swap: [bool; 3]| {
            let mut pair = [left, right];
            for k in 0..3 {
                if swap[k] {
                    (pair[0][k], pair[1][k]) = (right[k], left[k]);
                }
            }
            pair
        };
        let choices = [[false; 3], [false, true, false], [false, false, true], [false, true, true]];
        let score = |pair: &[Triple; 2]| pair.iter().filter(|t| self.is_plain(**t)).count();
        let pairs = choices.map(swapped);
        // the first of the best: the order that the model's author wrote
        pairs.into_iter().rev().max_by_key(score).unwrap_or([left, right])
    }

    /// Whether three scalars are known to be a vector, or one value thrice.
    fn is_plain(&self, t: Triple) -> bool {
        t[0] == t[1] && t[1] == t[2] || is_constant(t) || self.registered.contains(&t)
    }

    /// Whether three scalars are worth an operation on vectors.
    fn is_natural(&self, t: Triple) -> bool {
        // deeper vectors are registered by growth; without the limit, shared operands cost 2^depth
        self.is_natural_within(t, 6)
    }

    fn is_natural_within(&self, t: Triple, depth: u32) -> bool {
        if self.is_plain(t) || depth == 0 {
            return self.is_plain(t);
        }
        let natural = |t| self.is_natural_within(t, depth - 1);
        match self.shape(t) {
            Some(Shape::Unary(_, a)) => natural(a),
            Some(Shape::Binary(_, a, b) | Shape::Select(_, a, b)) => natural(a) || natural(b),
            None => false,
        }
    }

    /// A vector, or the scalar of which it would be three copies.
    fn operand(&mut self, t: Triple) -> Option<Ref> {
        if t[0] == t[1] && t[1] == t[2] { Some(self.scalar(t[0])) } else { self.vector(t) }
    }

    /// A vector in any case.
    fn whole(&mut self, t: Triple) -> Ref {
        match self.operand(t) {
            Some(value) if self.packed.types[value as usize] == crate::packed::Type::Vector => value,
            Some(value) => match self.packed.nodes[value as usize] {
                Op::Const(bits) => self.packed.push(Op::ConstVector([bits; 3])),
                _ => self.packed.push(Op::Splat(value)),
            },
            None => self.compose(t),
        }
    }

    /// The vector of three scalars that are not all equal; none while it is being entered.
    fn vector(&mut self, t: Triple) -> Option<Ref> {
        if let Some(&known) = self.vectors.get(&t) {
            return Some(known);
        }
        if let [Item::Const(x), Item::Const(y), Item::Const(z)] = t {
            return Some(self.packed.push(Op::ConstVector([x, y, z])));
        }
        if let Some(source) = self.source(t) {
            return Some(self.packed.push(source));
        }
        if !self.active.insert(t) {
            return None;
        }
        let shaped = if self.is_natural(t) { self.shape(t).and_then(|shape| self.shaped(shape)) } else { None };
        let value = shaped.unwrap_or_else(|| self.compose(t));
        self.active.remove(&t);
        self.vectors.insert(t, value);
        if let Some(name) = self.names.get(&t) {
            self.packed.names.entry(value).or_insert(name);
        }
        Some(value)
    }

    /// The argument or member with these components.
    fn source(&self, t: Triple) -> Option<Op> {
        let input = |k: usize| match t[k] {
            Item::Node(i) => match self.graph.nodes[i as usize] {
                Node::Input(input) => Some(self.inputs[input as usize]),
                _ => None,
            },
            Item::Const(_) => None,
        };
        match (input(0)?, input(1)?, input(2)?) {
            (Input::Argument(a, 0), Input::Argument(b, 1), Input::Argument(c, 2)) if a == b && a == c => {
                Some(Op::Argument(a))
            }
            (Input::Member(a, 0), Input::Member(b, 1), Input::Member(c, 2)) if a == b && a == c => Some(Op::Member(a)),
            _ => None,
        }
    }

    fn shaped(&mut self, shape: Shape) -> Option<Ref> {
        let op = match shape {
            Shape::Unary(op, a) => Op::Unary(op, self.operand(a)?),
            Shape::Binary(op, a, b) => Op::Binary(op, self.operand(a)?, self.operand(b)?),
            Shape::Select(m, a, b) => {
                let condition = self.scalar(Item::Node(m));
                Op::Select(condition, self.whole(a), self.whole(b))
            }
        };
        Some(self.packed.push(op))
    }

    fn compose(&mut self, t: Triple) -> Ref {
        let parts = t.map(|item| self.scalar(item));
        self.packed.push(Op::Compose(parts))
    }

    /// A number or a condition.
    fn scalar(&mut self, item: Item) -> Ref {
        let i = match item {
            Item::Const(bits) => return self.packed.push(Op::Const(bits)),
            Item::Node(i) => i,
        };
        if let Some(known) = self.scalars[i as usize] {
            return known;
        }
        let value = self.component(i).or_else(|| self.dot(i)).unwrap_or_else(|| self.operation(i));
        self.scalars[i as usize] = Some(value);
        if let Some(name) = self.scalar_names.get(&i) {
            self.packed.names.entry(value).or_insert(name);
        }
        value
    }

    fn component(&mut self, i: u32) -> Option<Ref> {
        let (t, k) = self.home[i as usize]?;
        let vector = self.vector(t)?;
        match self.packed.nodes[vector as usize] {
            Op::Compose(parts) => Some(parts[k as usize]),
            _ => Some(self.packed.push(Op::Component(vector, k))),
        }
    }

    fn dot(&mut self, i: u32) -> Option<Ref> {
        let [a, b] = *self.dots.get(&i)?;
        let (a, b) = (self.vector(a)?, self.vector(b)?);
        Some(self.packed.push(Op::Dot(a, b)))
    }

    fn operation(&mut self, i: u32) -> Ref {
        let node = self.graph.nodes[i as usize];
        let mut operand = |id: Id| self.scalar(self.item(id));
        let op = match node {
            Node::Const(bits) => Op::Const(bits),
            Node::Bool(b) => Op::Bool(b),
            Node::Input(input) => self.input(input),
            Node::Unary(op, a) => Op::Unary(op, operand(a)),
            Node::Binary(op, a, b) => Op::Binary(op, operand(a), operand(b)),
            Node::Compare(op, a, b) => Op::Compare(op, operand(a), operand(b)),
            Node::Logic(op, a, b) => Op::Logic(op, operand(a), operand(b)),
            Node::Not(a) => Op::Not(operand(a)),
            Node::Select(m, a, b) => Op::Select(operand(m), operand(a), operand(b)),
        };
        self.packed.push(op)
    }

    fn input(&mut self, input: u32) -> Op {
        match self.inputs[input as usize] {
            Input::Argument(a, k) => Op::Component(self.packed.push(Op::Argument(a)), k),
            Input::Member(m, k) => {
                let member = self.packed.push(Op::Member(m));
                match self.packed.types[member as usize] {
                    crate::packed::Type::Vector => Op::Component(member, k),
                    _ => Op::Member(m),
                }
            }
        }
    }
}

fn is_constant(t: Triple) -> bool {
    t.iter().all(|item| matches!(item, Item::Const(_)))
}
