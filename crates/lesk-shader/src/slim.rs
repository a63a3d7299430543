//! Vectors of which only one or two components are used go back to scalars.

use crate::packed::{Op, Packed, Ref, Type};
use std::collections::HashMap;

/// The same function without vector operations that cost more than they save.
pub fn slim(packed: &Packed) -> Packed {
    let loose = loose(packed);
    let mut out = Packed::new(packed.members.clone());
    let mut slimmer = Slimmer { packed, loose, new: vec![0; packed.nodes.len()], components: HashMap::new() };
    let live = packed.live();
    for i in 0..packed.nodes.len() {
        if !live[i] || slimmer.loose[i] {
            continue;
        }
        slimmer.new[i] = match packed.nodes[i] {
            Op::Component(v, k) => slimmer.component(&mut out, v, k),
            op => out.push(op.map(|operand| slimmer.new[operand as usize])),
        };
        if let Some(name) = packed.names.get(&(i as Ref)) {
            out.names.entry(slimmer.new[i]).or_insert(name);
        }
    }
    out.outputs = packed.outputs.iter().map(|&output| slimmer.new[output as usize]).collect();
    out
}

/// Which vector operations are used by no more than two components, directly or through others of the kind.
fn loose(packed: &Packed) -> Vec<bool> {
    const WHOLE: u8 = 0b111;
    let live = packed.live();
    let mut used = vec![0_u8; packed.nodes.len()];
    for &output in &packed.outputs {
        used[output as usize] = WHOLE;
    }
    for i in (0..packed.nodes.len()).rev().filter(|&i| live[i]) {
        let op = packed.nodes[i];
        let (first, mask) = match op {
            Op::Component(_, k) => (0, 1 << k),
            Op::Unary(..) | Op::Binary(..) if used[i].count_ones() < 3 => (0, used[i]),
            Op::Select(..) if used[i].count_ones() < 3 => (1, used[i]),
            _ => (0, WHOLE),
        };
        for operand in op.operands().skip(first) {
            used[operand as usize] |= mask;
        }
    }
    let is_loose = |i: usize| {
        let elementwise = matches!(packed.nodes[i], Op::Unary(..) | Op::Binary(..) | Op::Select(..));
        elementwise && packed.types[i] == Type::Vector && used[i].count_ones() < 3
    };
    (0..packed.nodes.len()).map(is_loose).collect()
}

struct Slimmer<'a> {
    packed: &'a Packed,
    loose: Vec<bool>,
    new: Vec<Ref>,
    components: HashMap<(Ref, u8), Ref>,
}

impl Slimmer<'_> {
    /// Component `k` of a vector, or the scalar that stands for one.
    fn component(&mut self, out: &mut Packed, v: Ref, k: u8) -> Ref {
        if let Some(&known) = self.components.get(&(v, k)) {
            return known;
        }
        let value = match self.packed.nodes[v as usize] {
            _ if self.packed.types[v as usize] == Type::Scalar => self.new[v as usize],
            Op::Unary(op, a) if self.loose[v as usize] => {
                let a = self.component(out, a, k);
                out.push(Op::Unary(op, a))
            }
            Op::Binary(op, a, b) if self.loose[v as usize] => {
                let (a, b) = (self.component(out, a, k), self.component(out, b, k));
                out.push(Op::Binary(op, a, b))
            }
            Op::Select(c, a, b) if self.loose[v as usize] => {
                let (a, b) = (self.component(out, a, k), self.component(out, b, k));
                out.push(Op::Select(self.new[c as usize], a, b))
            }
            Op::ConstVector(bits) => out.push(Op::Const(bits[k as usize])),
            Op::Compose(parts) => self.new[parts[k as usize] as usize],
            Op::Splat(a) => self.new[a as usize],
            _ => out.push(Op::Component(self.new[v as usize], k)),
        };
        self.components.insert((v, k), value);
        value
    }
}
