//! Recorded expressions: a formula run with [`Expr`] leaves a graph of its operations behind.
//!
//! ```
//! use lesk_math::{Real, expr};
//! let (graph, sum) = expr::record(|| {
//!     let (x, y) = (expr::input("x"), expr::input("y"));
//!     x.fma(y, x * y)
//! });
//! assert_eq!(graph.nodes.len(), 4); // x, y, one product, one sum
//! assert_eq!(graph.evaluate(&[3.0_f64, 5.0], &[sum]), [30.0]);
//! ```

mod evaluate;
mod graph;

pub use evaluate::Plain;
pub use graph::{Binary, Compare, Graph, Id, Logic, Node, Unary, input, record, set_exact};

use crate::real::{Bits, Real};
use core::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};
use graph::push;

/// A recorded number: a constant, or an index into the graph being recorded on this thread.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Expr {
    Const(f64),
    Node(Id),
}

/// A recorded condition.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ExprMask {
    Const(bool),
    Node(Id),
}

fn unary(op: Unary, a: Expr) -> Expr {
    match a {
        Expr::Const(x) => Expr::Const(op.apply(x)),
        Expr::Node(_) => Expr::Node(push(Node::Unary(op, a.id()))),
    }
}

/// Records `a op b`; folds constants and the identities that dual numbers leave behind (x*0, x+0, x*1, ...).
fn binary(op: Binary, a: Expr, b: Expr) -> Expr {
    use Binary::{Add, Div, Mul, Sub};
    use Expr::Const;
    match (op, a, b) {
        (_, Const(x), Const(y)) => Const(op.apply(x, y)),
        (Add, Const(0.0), x) | (Add | Sub, x, Const(0.0)) => x,
        (Mul, Const(1.0), x) | (Mul | Div, x, Const(1.0)) => x,
        (Mul, Const(0.0), _) | (Mul, _, Const(0.0)) | (Div, Const(0.0), _) => Const(0.0),
        (Sub, Const(0.0), x) | (Mul, Const(-1.0), x) | (Mul, x, Const(-1.0)) => -x,
        // like x * 0, this takes x for finite: the test for non-finite directions stays out of shaders
        (Sub, x, y) if x == y => Const(0.0),
        _ => Expr::Node(push(Node::Binary(op, a.id(), b.id()))),
    }
}

fn compare(op: Compare, a: Expr, b: Expr) -> ExprMask {
    match (a, b) {
        (Expr::Const(x), Expr::Const(y)) => ExprMask::Const(op.apply(x, y)),
        _ => ExprMask::Node(push(Node::Compare(op, a.id(), b.id()))),
    }
}

impl Expr {
    /// The graph index; constants are entered into the graph.
    pub(crate) fn id(self) -> Id {
        match self {
            Expr::Const(x) => push(Node::Const(x.to_bits())),
            Expr::Node(id) => id,
        }
    }
}

impl Add for Expr {
    type Output = Expr;
    fn add(self, o: Expr) -> Expr {
        binary(Binary::Add, self, o)
    }
}
impl Sub for Expr {
    type Output = Expr;
    fn sub(self, o: Expr) -> Expr {
        binary(Binary::Sub, self, o)
    }
}
impl Mul for Expr {
    type Output = Expr;
    fn mul(self, o: Expr) -> Expr {
        binary(Binary::Mul, self, o)
    }
}
impl Div for Expr {
    type Output = Expr;
    fn div(self, o: Expr) -> Expr {
        binary(Binary::Div, self, o)
    }
}
impl Neg for Expr {
    type Output = Expr;
    fn neg(self) -> Expr {
        if let Expr::Node(id) = self
            && let Node::Unary(Unary::Neg, inner) = graph::node(id)
        {
            return Expr::Node(inner);
        }
        unary(Unary::Neg, self)
    }
}

impl ExprMask {
    fn id(self) -> Id {
        match self {
            ExprMask::Const(x) => push(Node::Bool(x)),
            ExprMask::Node(id) => id,
        }
    }
}
impl BitAnd for ExprMask {
    type Output = ExprMask;
    fn bitand(self, o: ExprMask) -> ExprMask {
        match (self, o) {
            (ExprMask::Const(true), x) | (x, ExprMask::Const(true)) => x,
            (ExprMask::Const(false), _) | (_, ExprMask::Const(false)) => ExprMask::Const(false),
            _ => ExprMask::Node(push(Node::Logic(Logic::And, self.id(), o.id()))),
        }
    }
}
impl BitOr for ExprMask {
    type Output = ExprMask;
    fn bitor(self, o: ExprMask) -> ExprMask {
        match (self, o) {
            (ExprMask::Const(false), x) | (x, ExprMask::Const(false)) => x,
            (ExprMask::Const(true), _) | (_, ExprMask::Const(true)) => ExprMask::Const(true),
            _ => ExprMask::Node(push(Node::Logic(Logic::Or, self.id(), o.id()))),
        }
    }
}
impl Not for ExprMask {
    type Output = ExprMask;
    fn not(self) -> ExprMask {
        match self {
            ExprMask::Const(x) => ExprMask::Const(!x),
            ExprMask::Node(id) => ExprMask::Node(push(Node::Not(id))),
        }
    }
}

/// Records one node, or the polynomial that replaces it where the recording asks for exact mathematics.
macro_rules! function {
    ($($method:ident => $op:ident),*) => { $(
        fn $method(self) -> Expr {
            if graph::is_exact() { crate::poly::$method(self) } else { unary(Unary::$op, self) }
        }
    )* };
}

impl Real for Expr {
    type Mask = ExprMask;
    const ZERO: Expr = Expr::Const(0.0);
    const ONE: Expr = Expr::Const(1.0);
    const TWO: Expr = Expr::Const(2.0);
    const HALF: Expr = Expr::Const(0.5);
    const PI: Expr = Expr::Const(core::f64::consts::PI);
    const FRAC_1_PI: Expr = Expr::Const(core::f64::consts::FRAC_1_PI);

    function!(exp2 => Exp2, log2 => Log2, sin => Sin, cos => Cos, acos => Acos);

    fn lit(x: f64) -> Expr {
        Expr::Const(x)
    }
    fn fma(self, b: Expr, c: Expr) -> Expr {
        // shading languages contract by themselves, and readers expect a * b + c
        self * b + c
    }
    fn sqrt(self) -> Expr {
        unary(Unary::Sqrt, self)
    }
    fn abs(self) -> Expr {
        unary(Unary::Abs, self)
    }
    fn min(self, o: Expr) -> Expr {
        binary(Binary::Min, self, o)
    }
    fn max(self, o: Expr) -> Expr {
        binary(Binary::Max, self, o)
    }
    fn round(self) -> Expr {
        unary(Unary::Round, self)
    }
    fn exp(self) -> Expr {
        if graph::is_exact() {
            return crate::poly::exp(self);
        }
        unary(Unary::Exp, self)
    }
    fn ln(self) -> Expr {
        if graph::is_exact() {
            return self.log2() * Expr::lit(core::f64::consts::LN_2);
        }
        unary(Unary::Ln, self)
    }
    fn pow(self, y: Expr) -> Expr {
        let x = self.max(Expr::lit(crate::TINY));
        if graph::is_exact() {
            return (x.log2() * y).exp2();
        }
        binary(Binary::Pow, x, y)
    }
    fn atan2(self, x: Expr) -> Expr {
        if graph::is_exact() {
            return crate::poly::atan2(self, x);
        }
        binary(Binary::Atan2, self, x)
    }
    // no shading language has these: always the polynomial
    fn erf(self) -> Expr {
        crate::poly::erf(self)
    }
    fn erf_inv(self) -> Expr {
        crate::poly::erf_inv(self)
    }
    fn lt(self, o: Expr) -> ExprMask {
        compare(Compare::Lt, self, o)
    }
    fn le(self, o: Expr) -> ExprMask {
        compare(Compare::Le, self, o)
    }
    fn select(mask: ExprMask, a: Expr, b: Expr) -> Expr {
        match mask {
            _ if a == b => a,
            ExprMask::Const(true) => a,
            ExprMask::Const(false) => b,
            ExprMask::Node(m) => Expr::Node(push(Node::Select(m, a.id(), b.id()))),
        }
    }
    fn named(self, name: &'static str) -> Expr {
        if let Expr::Node(id) = self {
            graph::set_name(id, name);
        }
        self
    }
}

impl Bits for Expr {
    fn exp2_int(self) -> Expr {
        unary(Unary::Exp2Int, self)
    }
    fn split(self) -> (Expr, Expr) {
        let (m, e) = (unary(Unary::Mantissa, self), unary(Unary::Exponent, self));
        let big = m.gt(Expr::lit(core::f64::consts::SQRT_2));
        (Expr::select(big, m * Expr::HALF, m), Expr::select(big, e + Expr::ONE, e))
    }
}
