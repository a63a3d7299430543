//! Where vectors start: arguments, named vectors, dot products and results; and how they grow from there.

use super::{Item, Packer, Shape, Triple, is_constant};
use crate::record::Input;
use lesk_math::expr::{Binary, Id, Node, Unary};
use std::collections::HashMap;

/// An operation by its operands' positions, to find it in the graph.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
enum Key {
    Unary(Unary, u32),
    Binary(Binary, u32, u32),
    Select(u32, u32, u32),
}

fn key(node: &Node) -> Option<Key> {
    match *node {
        Node::Unary(op, a) => Some(Key::Unary(op, a.index)),
        Node::Binary(op, a, b) => Some(Key::Binary(op, a.index, b.index)),
        Node::Select(m, a, b) => Some(Key::Select(m.index, a.index, b.index)),
        _ => None,
    }
}

impl Packer<'_> {
    /// Finds all vectors.
    pub(super) fn seed(&mut self, outputs: &[Vec<Item>]) {
        self.arguments();
        self.named();
        self.sweep();
        for output in outputs {
            if let [x, y, z] = output[..] {
                self.register([x, y, z]);
            }
        }
    }

    fn arguments(&mut self) {
        let mut inputs: HashMap<Input, u32> = HashMap::new();
        for (i, node) in self.graph.nodes.iter().enumerate() {
            if let Node::Input(input) = node {
                inputs.insert(self.inputs[*input as usize], i as u32);
            }
        }
        for (&input, &x) in &inputs {
            let others = match input {
                Input::Argument(a, 0) => [Input::Argument(a, 1), Input::Argument(a, 2)],
                Input::Member(m, 0) => [Input::Member(m, 1), Input::Member(m, 2)],
                _ => continue,
            };
            if let [Some(&y), Some(&z)] = others.map(|other| inputs.get(&other)) {
                self.settle([x, y, z].map(Item::Node));
            }
        }
    }

    /// Three calls of `named` in a row with one name are a vector.
    fn named(&mut self) {
        let calls = &self.graph.names;
        let mut i = 0;
        while i < calls.len() {
            let (first, name) = calls[i];
            let row: Vec<u32> = calls[i..].iter().take(3).filter(|call| call.1 == name).map(|call| call.0).collect();
            if let [x, y, z] = row[..]
                && x != y
                && y != z
            {
                let t = [x, y, z].map(Item::Node);
                self.register(t);
                self.names.entry(t).or_insert(name);
                i += 3;
            } else {
                self.scalar_names.entry(first).or_insert(name);
                i += 1;
            }
        }
    }

    /// Goes through the graph from the operands to the users: dot products, and operations of which x, y and z exist.
    fn sweep(&mut self) {
        let known: HashMap<Key, u32> =
            self.graph.nodes.iter().enumerate().filter_map(|(i, node)| Some((key(node)?, i as u32))).collect();
        for i in 0..self.graph.nodes.len() {
            if !self.live[i] {
                continue;
            }
            self.match_dot(i as u32);
            if self.home[i].is_none()
                && let Some(t) = self.grow(i as u32, &known)
            {
                self.settle(t);
            }
        }
    }

    /// Makes a vector, its operands included, of three scalars that have one operation in common.
    fn register(&mut self, t: Triple) {
        let alive = |item: &Item| !matches!(item, Item::Node(i) if !self.live[*i as usize]);
        if self.registered.contains(&t) || !t.iter().all(alive) || !self.is_natural(t) || self.is_plain(t) {
            return;
        }
        match self.shape(t) {
            Some(Shape::Unary(_, a)) => self.register(a),
            Some(Shape::Binary(_, a, b) | Shape::Select(_, a, b)) => {
                self.register(a);
                self.register(b);
            }
            None => return,
        }
        self.settle(t);
    }

    /// Makes three scalars components of a vector.
    fn settle(&mut self, t: Triple) {
        self.registered.insert(t);
        for k in 0..3 {
            if let Item::Node(i) = t[k] {
                self.home[i as usize].get_or_insert((t, k as u8));
            }
        }
    }

    /// The vectors of which an operand is x, and itself thrice.
    fn partners(&self, a: Id) -> impl Iterator<Item = [u32; 3]> + Clone {
        let home = self.home[a.index as usize].filter(|home| home.1 == 0).map(|home| home.0);
        let composed = self.composed.get(&a.index).copied();
        let nodes = |t: Triple| match t {
            [Item::Node(x), Item::Node(y), Item::Node(z)] => Some([x, y, z]),
            _ => None,
        };
        [home, composed].into_iter().flatten().filter_map(nodes).chain([[a.index; 3]])
    }

    /// The vector whose first component is node `i`, if the graph has the other two.
    fn grow(&self, i: u32, known: &HashMap<Key, u32>) -> Option<Triple> {
        let try_keys = |keys: [Key; 3]| {
            let found = [i, *known.get(&keys[1])?, *known.get(&keys[2])?];
            let fits = found[0] != found[1]
                && found[1] != found[2]
                && found.iter().all(|&j| self.live[j as usize] && self.home[j as usize].is_none());
            fits.then(|| found.map(Item::Node))
        };
        match self.graph.nodes[i as usize] {
            Node::Unary(op, a) => self.partners(a).find_map(|a| try_keys(a.map(|a| Key::Unary(op, a)))),
            Node::Binary(op, a, b) => self.pairs(a, b).find_map(|(a, b)| {
                let keys = core::array::from_fn(|k| Key::Binary(op, a[k], b[k]));
                try_keys(keys)
            }),
            Node::Select(m, a, b) => self.pairs(a, b).find_map(|(a, b)| {
                let keys = core::array::from_fn(|k| Key::Select(m.index, a[k], b[k]));
                try_keys(keys)
            }),
            _ => None,
        }
    }

    fn pairs(&self, a: Id, b: Id) -> impl Iterator<Item = ([u32; 3], [u32; 3])> {
        let seconds = self.partners(b);
        self.partners(a).flat_map(move |a| seconds.clone().map(move |b| (a, b)))
    }

    /// Recognises `x x' + y y' + z z'`, summed from either end.
    fn match_dot(&mut self, i: u32) {
        let add = |i: u32| match self.graph.nodes[i as usize] {
            Node::Binary(Binary::Add, a, b) => Some((a.index, b.index)),
            _ => None,
        };
        let product = |i: u32| match self.graph.nodes[i as usize] {
            Node::Binary(Binary::Mul, a, b) => Some((self.item(a), self.item(b))),
            _ => None,
        };
        let terms = |x, y, z| Some([product(x)?, product(y)?, product(z)?]);
        let Some((a, b)) = add(i) else { return };
        let from_right = add(b).and_then(|(c, d)| terms(a, c, d));
        let from_left = || add(a).and_then(|(c, d)| terms(c, d, b));
        let Some(terms) = from_right.or_else(from_left) else { return };
        let [left, right] = self.aligned(terms.map(|t| t.0), terms.map(|t| t.1));
        if left == right || self.is_direction(left) || self.is_direction(right) {
            for factor in [left, right] {
                self.register(factor);
                if let (Item::Node(x), false) = (factor[0], self.is_plain(factor)) {
                    self.composed.entry(x).or_insert(factor);
                }
            }
            self.dots.insert(i, [left, right]);
        }
    }

    /// Whether three scalars are a vector that is more than one number thrice.
    fn is_direction(&self, t: Triple) -> bool {
        let equal = t[0] == t[1] || t[1] == t[2] || t[0] == t[2];
        !equal && !is_constant(t) && self.is_natural(t)
    }
}
