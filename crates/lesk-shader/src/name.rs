//! Which values become named locals, and their names.

use crate::packed::{Idiom, Op, Packed, Ref, Type};
use lesk_math::expr::{Binary, Unary};
use std::collections::{HashMap, HashSet};

/// The width, in characters, from which an expression is broken into locals.
const WIDE: usize = 96;

/// The length that a local's name is taken to have before it has one.
const TYPICAL: usize = 6;

/// The longest name that is made up from other names.
const LONG: usize = 18;

/// Names of the locals of one function: one entry per node, none for a value that stands where it is used.
pub fn locals(packed: &Packed, arguments: &[&str], members: &[String]) -> Vec<Option<String>> {
    let uses = uses(packed);
    let is_local = Breaker::new(packed, arguments, members).run(&uses);
    let mut namer = Namer {
        packed,
        arguments,
        members,
        names: vec![None; packed.nodes.len()],
        taken: arguments.iter().map(|s| (*s).to_owned()).chain(["p", "result"].map(str::to_owned)).collect(),
        powers: HashMap::new(),
    };
    namer.run(&uses, &is_local);
    namer.names
}

/// Whether a value is so short that it is written again at each use.
pub fn is_short(packed: &Packed, a: Ref) -> bool {
    match packed.nodes[a as usize] {
        Op::Const(_) | Op::ConstVector(_) | Op::Bool(_) | Op::Argument(_) | Op::Member(_) | Op::Component(..) => true,
        Op::Unary(Unary::Neg, b) | Op::Splat(b) => is_leaf(packed, b),
        _ => false,
    }
}

fn is_leaf(packed: &Packed, a: Ref) -> bool {
    matches!(packed.nodes[a as usize], Op::Const(_) | Op::Argument(_) | Op::Member(_) | Op::Component(..))
}

/// How often each value would be written, were there no locals.
fn uses(packed: &Packed) -> Vec<u32> {
    let mut uses = vec![0_u32; packed.nodes.len()];
    for &output in &packed.outputs {
        uses[output as usize] += 1;
    }
    for i in (0..packed.nodes.len()).rev() {
        let times = if is_short(packed, i as Ref) { uses[i] } else { uses[i].min(1) };
        for operand in packed.nodes[i].operands() {
            uses[operand as usize] = uses[operand as usize].saturating_add(times);
        }
    }
    uses
}

/// Decides which values become locals.
struct Breaker<'a> {
    packed: &'a Packed,
    arguments: &'a [&'a str],
    members: &'a [String],
    is_local: Vec<bool>,
    /// The length of each value's text where it is used.
    widths: Vec<usize>,
}

impl<'a> Breaker<'a> {
    fn new(packed: &'a Packed, arguments: &'a [&'a str], members: &'a [String]) -> Breaker<'a> {
        let n = packed.nodes.len();
        Breaker { packed, arguments, members, is_local: vec![false; n], widths: vec![0; n] }
    }

    fn run(mut self, uses: &[u32]) -> Vec<bool> {
        for i in (0..uses.len()).filter(|&i| uses[i] > 0) {
            // a result that is 0 outside the domain becomes an early return, not an expression
            if !self.packed.is_guarded(i as Ref) {
                self.break_up(i);
            }
            let author = self.packed.names.contains_key(&(i as Ref));
            if !is_short(self.packed, i as Ref) && (uses[i] > 1 || author) {
                self.make_local(i);
            }
        }
        self.is_local
    }

    fn make_local(&mut self, i: usize) {
        self.is_local[i] = true;
        self.widths[i] = self.packed.names.get(&(i as Ref)).map_or(TYPICAL, |name| name.len());
    }

    /// Makes locals of the widest operands until the expression fits on a line.
    fn break_up(&mut self, i: usize) {
        let op = self.packed.nodes[i];
        loop {
            let width = self.own_width(&op) + op.operands().map(|a| self.widths[a as usize]).sum::<usize>();
            let can_move = |a: &Ref| !self.is_local[*a as usize] && !is_short(self.packed, *a);
            let widest = op.operands().filter(can_move).max_by_key(|a| self.widths[*a as usize]);
            match widest {
                Some(widest) if width > WIDE && self.widths[widest as usize] > LONG => self.make_local(widest as usize),
                _ => {
                    self.widths[i] = width;
                    return;
                }
            }
        }
    }

    fn own_width(&self, op: &Op) -> usize {
        match *op {
            Op::Const(_) | Op::Bool(_) => 5,
            Op::ConstVector(_) => 15,
            Op::Argument(i) => self.arguments[i as usize].len(),
            Op::Member(i) => self.members[i as usize].len() + 2,
            Op::Component(..) => 2,
            Op::Compose(_) => 10,
            Op::Unary(Unary::Neg, _) | Op::Not(_) => 1,
            Op::Binary(Binary::Add | Binary::Sub | Binary::Mul | Binary::Div, ..) | Op::Compare(..) => 3,
            Op::Idiom(Idiom::Normalize(_) | Idiom::InverseSqrt(_)) => 12,
            _ => 6,
        }
    }
}

/// Finds names for the locals.
struct Namer<'a> {
    packed: &'a Packed,
    arguments: &'a [&'a str],
    members: &'a [String],
    names: Vec<Option<String>>,
    taken: HashSet<String>,
    /// Values that are powers: base and exponent.
    powers: HashMap<Ref, (Ref, u32)>,
}

impl Namer<'_> {
    fn run(&mut self, uses: &[u32], is_local: &[bool]) {
        // the author's names first: made-up ones make way for them
        for i in (0..uses.len()).filter(|&i| is_local[i]) {
            if let Some(name) = self.packed.names.get(&(i as Ref)) {
                self.names[i] = Some(self.unique(name));
            }
        }
        for i in (0..uses.len()).filter(|&i| uses[i] > 0) {
            self.note_power(i as Ref);
            if is_local[i] && self.names[i].is_none() {
                self.names[i] = Some(match self.description(i as Ref) {
                    Some(name) => self.unique(&name),
                    None => self.numbered(self.packed.types[i]),
                });
            }
        }
    }

    fn unique(&mut self, wish: &str) -> String {
        let wish = crate::backend::words::safe(wish);
        let numbered = (2..).map(|k| format!("{wish}_{k}"));
        let mut names = core::iter::once(wish.clone()).chain(numbered);
        let name = names.find(|name| !self.taken.contains(name)).unwrap_or(wish);
        self.taken.insert(name.clone());
        name
    }

    fn numbered(&mut self, ty: Type) -> String {
        let letter = match ty {
            Type::Scalar => 't',
            Type::Vector => 'v',
            Type::Bool => 'b',
        };
        let name = (1..).map(|k| format!("{letter}{k}")).find(|name| !self.taken.contains(name)).unwrap_or_default();
        self.taken.insert(name.clone());
        name
    }

    /// Remembers x x, x x x, ...
    fn note_power(&mut self, i: Ref) {
        if let Op::Binary(Binary::Mul, a, b) = self.packed.nodes[i as usize] {
            let power = |a: Ref| self.powers.get(&a).copied().unwrap_or((a, 1));
            let ((x, m), (y, n)) = (power(a), power(b));
            if x == y && !matches!(self.packed.nodes[x as usize], Op::Const(_)) {
                self.powers.insert(i, (x, m + n));
            }
        }
    }

    /// A name that says what the value is, if its operands have names.
    fn description(&self, i: Ref) -> Option<String> {
        if let Some(&(base, exponent)) = self.powers.get(&i) {
            let base = self.short_name(base)?;
            let name = match exponent {
                _ if base.len() <= 4 && !base.ends_with(|c: char| c.is_ascii_digit()) => format!("{base}{exponent}"),
                2 => format!("{base}_squared"),
                _ => format!("{base}_to_{exponent}"),
            };
            return (name.len() <= LONG).then_some(name);
        }
        let name = match self.packed.nodes[i as usize] {
            Op::Dot(a, b) if a == b => format!("{}_squared", self.short_name(a)?),
            Op::Dot(a, b) => format!("{}_dot_{}", self.short_name(a)?, self.short_name(b)?),
            Op::Binary(Binary::Sub, one, a) if self.packed.number(one) == Some(1.0) => {
                format!("one_minus_{}", self.short_name(a)?)
            }
            Op::Unary(op, a) => {
                let function = function_name(op)?;
                match self.short_name(a) {
                    Some(a) => format!("{function}_{a}"),
                    None if op == Unary::Sqrt => function.to_owned(),
                    None => return None,
                }
            }
            Op::Idiom(Idiom::Tan(a)) => format!("tan_{}", self.short_name(a)?),
            Op::Idiom(Idiom::Length(a)) => format!("{}_length", self.short_name(a)?),
            Op::Idiom(Idiom::Normalize(a)) => format!("{}_unit", self.short_name(a)?),
            _ => return None,
        };
        (name.len() <= LONG).then_some(name)
    }

    fn short_name(&self, a: Ref) -> Option<String> {
        if let Some(name) = &self.names[a as usize] {
            return Some(name.clone());
        }
        match self.packed.nodes[a as usize] {
            Op::Argument(i) => Some(self.arguments[i as usize].to_owned()),
            Op::Member(i) => Some(self.members[i as usize].clone()),
            Op::Component(b, k) => {
                let axes = if matches!(self.packed.nodes[b as usize], Op::Member(_)) { "rgb" } else { "xyz" };
                Some(format!("{}_{}", self.short_name(b)?, &axes[k as usize..=k as usize]))
            }
            _ => None,
        }
    }
}

fn function_name(op: Unary) -> Option<&'static str> {
    match op {
        Unary::Sqrt => Some("root"),
        Unary::Abs => Some("abs"),
        Unary::Sin => Some("sin"),
        Unary::Cos => Some("cos"),
        Unary::Acos => Some("angle"),
        Unary::Exp | Unary::Exp2 => Some("exp"),
        Unary::Ln | Unary::Log2 => Some("log"),
        _ => None,
    }
}
