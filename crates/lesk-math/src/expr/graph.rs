//! The graph that a recording fills: hash-consed nodes in the order of their making, so operands come first.

use super::Expr;
use std::cell::RefCell;
use std::collections::HashMap;
use std::sync::atomic::{AtomicU32, Ordering};

/// An index into the graph of one recording.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Id {
    pub index: u32,
    recording: u32,
}

/// Functions of one number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Unary {
    Neg,
    Sqrt,
    Abs,
    Round,
    Exp2,
    Log2,
    Exp,
    Ln,
    Sin,
    Cos,
    Acos,
    /// 2^n of an integral n.
    Exp2Int,
    /// The mantissa in [1, 2) of a positive normal f32.
    Mantissa,
    /// The exponent of a positive normal f32.
    Exponent,
}

/// Functions of two numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Binary {
    Add,
    Sub,
    Mul,
    Div,
    Min,
    Max,
    Pow,
    Atan2,
}

/// Comparisons.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Compare {
    Lt,
    Le,
}

/// Connectives of conditions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Logic {
    And,
    Or,
}

/// One operation; operands are earlier nodes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Node {
    /// The bits of an `f64`.
    Const(u64),
    Bool(bool),
    /// An index into [`Graph::inputs`].
    Input(u32),
    Unary(Unary, Id),
    Binary(Binary, Id, Id),
    Compare(Compare, Id, Id),
    Logic(Logic, Id, Id),
    Not(Id),
    /// Condition, value if true, value if false.
    Select(Id, Id, Id),
}

/// A finished recording.
#[derive(Clone, Debug, Default)]
pub struct Graph {
    /// Operations, operands before users.
    pub nodes: Vec<Node>,
    /// Names of the inputs, in the order of [`input`] calls.
    pub inputs: Vec<String>,
    /// Node and name of each call of `named`, in order; a vector makes three calls.
    pub names: Vec<(u32, &'static str)>,
}

impl Node {
    /// The operands.
    pub fn operands(&self) -> impl Iterator<Item = Id> {
        let three = match *self {
            Node::Const(_) | Node::Bool(_) | Node::Input(_) => [None; 3],
            Node::Unary(_, a) | Node::Not(a) => [Some(a), None, None],
            Node::Binary(_, a, b) | Node::Compare(_, a, b) | Node::Logic(_, a, b) => [Some(a), Some(b), None],
            Node::Select(m, a, b) => [Some(m), Some(a), Some(b)],
        };
        three.into_iter().flatten()
    }
}

impl Graph {
    /// Which nodes the `outputs` depend on.
    pub fn live(&self, outputs: &[Expr]) -> Vec<bool> {
        let mut live = vec![false; self.nodes.len()];
        for output in outputs {
            if let Expr::Node(id) = output {
                live[id.index as usize] = true;
            }
        }
        for i in (0..self.nodes.len()).rev() {
            if live[i] {
                for operand in self.nodes[i].operands() {
                    live[operand.index as usize] = true;
                }
            }
        }
        live
    }
}

#[derive(Default)]
struct Arena {
    graph: Graph,
    known: HashMap<Node, u32>,
    recording: u32,
    exact: bool,
}

thread_local! {
    static ARENA: RefCell<Option<Arena>> = const { RefCell::new(None) };
}
static RECORDINGS: AtomicU32 = AtomicU32::new(1);

fn with_arena<T>(f: impl FnOnce(&mut Arena) -> T) -> T {
    ARENA.with(|cell| match &mut *cell.borrow_mut() {
        Some(arena) => f(arena),
        None => panic!("an expression was used outside `record`"),
    })
}

/// Runs `f`; returns the graph of what its expressions did, and its result. Recordings nest.
pub fn record<T>(f: impl FnOnce() -> T) -> (Graph, T) {
    /// Puts the outer recording back, also when `f` panics.
    struct Restore(Option<Option<Arena>>);
    impl Drop for Restore {
        fn drop(&mut self) {
            if let Some(outer) = self.0.take() {
                ARENA.with(|cell| *cell.borrow_mut() = outer);
            }
        }
    }
    let fresh = Arena { recording: RECORDINGS.fetch_add(1, Ordering::Relaxed), ..Arena::default() };
    let outer = ARENA.with(|cell| cell.borrow_mut().replace(fresh));
    let restore = Restore(Some(outer));
    let result = f();
    let graph = ARENA.with(|cell| cell.borrow_mut().take()).map(|arena| arena.graph).unwrap_or_default();
    drop(restore);
    (graph, result)
}

/// Makes the current recording spell out exp, log and trigonometry as Lesk's own polynomials (`true`), or record
/// them as calls of the target's functions (`false`, the default).
pub fn set_exact(exact: bool) {
    with_arena(|arena| arena.exact = exact);
}

pub(super) fn is_exact() -> bool {
    with_arena(|arena| arena.exact)
}

/// A new input of the current recording.
pub fn input(name: &str) -> Expr {
    with_arena(|arena| {
        arena.graph.inputs.push(name.to_owned());
        let index = arena.graph.inputs.len() as u32 - 1;
        Expr::Node(arena.push(Node::Input(index)))
    })
}

pub(super) fn push(node: Node) -> Id {
    with_arena(|arena| arena.push(node))
}

pub(super) fn node(id: Id) -> Node {
    with_arena(|arena| {
        arena.check(id);
        arena.graph.nodes[id.index as usize]
    })
}

pub(super) fn set_name(id: Id, name: &'static str) {
    with_arena(|arena| arena.graph.names.push((id.index, name)));
}

impl Arena {
    fn check(&self, id: Id) {
        assert_eq!(id.recording, self.recording, "an expression of another recording was used");
    }

    fn push(&mut self, node: Node) -> Id {
        for operand in node.operands() {
            self.check(operand);
        }
        let next = self.graph.nodes.len() as u32;
        let index = *self.known.entry(node).or_insert(next);
        if index == next {
            self.graph.nodes.push(node);
        }
        Id { index, recording: self.recording }
    }
}
