//! Forward-mode derivatives: a value and its partial derivatives.

use crate::real::{Real, TINY};
use core::ops::{Add, Div, Mul, Neg, Sub};

/// A value `v` and its partial derivatives `d` with respect to `N` variables.
///
/// ```
/// use lesk_math::{Dual, Real};
/// let x = Dual::<f64, 1>::variable(3.0, 0);
/// let y = x.sqr() + x.recip();
/// assert!((y.d[0] - (6.0 - 1.0 / 9.0)).abs() < 1e-15);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dual<R, const N: usize> {
    pub v: R,
    pub d: [R; N],
}

impl<R: Real, const N: usize> Dual<R, N> {
    /// A value that depends on no variable.
    #[inline(always)]
    pub fn constant(v: R) -> Self {
        Dual { v, d: [R::ZERO; N] }
    }
    /// The variable with index `i`.
    #[inline(always)]
    pub fn variable(v: R, i: usize) -> Self {
        let mut d = [R::ZERO; N];
        d[i] = R::ONE;
        Dual { v, d }
    }
    /// The value `v` of a function of `self` whose derivative is `slope`.
    #[inline(always)]
    fn chain(self, v: R, slope: R) -> Self {
        let mut d = self.d;
        for i in 0..N {
            d[i] = d[i] * slope;
        }
        Dual { v, d }
    }
    /// The value `v` of a function of two arguments with partial derivatives `da`, `db`.
    #[inline(always)]
    fn chain2(self, o: Self, v: R, da: R, db: R) -> Self {
        let mut d = self.d;
        for i in 0..N {
            d[i] = d[i].fma(da, o.d[i] * db);
        }
        Dual { v, d }
    }
}

impl<R: Real, const N: usize> Add for Dual<R, N> {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        let mut d = self.d;
        for i in 0..N {
            d[i] = d[i] + o.d[i];
        }
        Dual { v: self.v + o.v, d }
    }
}
impl<R: Real, const N: usize> Sub for Dual<R, N> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        let mut d = self.d;
        for i in 0..N {
            d[i] = d[i] - o.d[i];
        }
        Dual { v: self.v - o.v, d }
    }
}
impl<R: Real, const N: usize> Mul for Dual<R, N> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, o: Self) -> Self {
        self.chain2(o, self.v * o.v, o.v, self.v)
    }
}
impl<R: Real, const N: usize> Div for Dual<R, N> {
    type Output = Self;
    #[inline(always)]
    fn div(self, o: Self) -> Self {
        let v = self.v / o.v;
        let recip = o.v.recip();
        let mut d = self.d;
        for i in 0..N {
            d[i] = (d[i] - v * o.d[i]) * recip;
        }
        Dual { v, d }
    }
}
impl<R: Real, const N: usize> Neg for Dual<R, N> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        let mut d = self.d;
        for i in 0..N {
            d[i] = -d[i];
        }
        Dual { v: -self.v, d }
    }
}

macro_rules! constants {
    ($($name:ident),*) => { $(const $name: Self = Dual { v: R::$name, d: [R::ZERO; N] };)* };
}

impl<R: Real, const N: usize> Real for Dual<R, N> {
    type Mask = R::Mask;
    constants!(ZERO, ONE, TWO, HALF, PI, FRAC_1_PI);

    #[inline(always)]
    fn lit(x: f64) -> Self {
        Dual::constant(R::lit(x))
    }
    #[inline(always)]
    fn fma(self, b: Self, c: Self) -> Self {
        let mut d = self.d;
        for i in 0..N {
            d[i] = d[i].fma(b.v, b.d[i].fma(self.v, c.d[i]));
        }
        Dual { v: self.v.fma(b.v, c.v), d }
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        let s = self.v.sqrt();
        // the slope at 0 is infinite; 1e-18 is the root of safe_sqrt's floor
        self.chain(s, R::HALF / s.max(R::lit(1e-18)))
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Self::select(self.v.lt(R::ZERO), -self, self)
    }
    #[inline(always)]
    fn min(self, o: Self) -> Self {
        Self::select(self.v.lt(o.v), self, o)
    }
    #[inline(always)]
    fn max(self, o: Self) -> Self {
        Self::select(o.v.lt(self.v), self, o)
    }
    #[inline(always)]
    fn round(self) -> Self {
        Dual::constant(self.v.round())
    }
    #[inline(always)]
    fn exp2(self) -> Self {
        let v = self.v.exp2();
        self.chain(v, v * R::lit(core::f64::consts::LN_2))
    }
    #[inline(always)]
    fn exp(self) -> Self {
        let v = self.v.exp();
        self.chain(v, v)
    }
    #[inline(always)]
    fn log2(self) -> Self {
        self.chain(self.v.log2(), R::lit(core::f64::consts::LOG2_E) / self.v.max(R::lit(TINY)))
    }
    #[inline(always)]
    fn log2_1p(self) -> Self {
        self.chain(self.v.log2_1p(), R::lit(core::f64::consts::LOG2_E) / (R::ONE + self.v))
    }
    #[inline(always)]
    fn ln(self) -> Self {
        self.chain(self.v.ln(), self.v.max(R::lit(TINY)).recip())
    }
    #[inline(always)]
    fn pow(self, y: Self) -> Self {
        let v = self.v.pow(y.v);
        let x = self.v.max(R::lit(TINY));
        self.chain2(y, v, v * y.v / x, v * x.ln())
    }
    #[inline(always)]
    fn sin(self) -> Self {
        self.chain(self.v.sin(), self.v.cos())
    }
    #[inline(always)]
    fn cos(self) -> Self {
        self.chain(self.v.cos(), -self.v.sin())
    }
    #[inline(always)]
    fn acos(self) -> Self {
        self.chain(self.v.acos(), -(self.v * self.v).one_minus().safe_sqrt().recip())
    }
    #[inline(always)]
    fn atan2(self, x: Self) -> Self {
        let r2 = self.v.fma(self.v, x.v * x.v).max(R::lit(TINY));
        self.chain2(x, self.v.atan2(x.v), x.v / r2, -(self.v / r2))
    }
    #[inline(always)]
    fn erf(self) -> Self {
        let slope = R::lit(core::f64::consts::FRAC_2_SQRT_PI) * (-(self.v * self.v)).exp();
        self.chain(self.v.erf(), slope)
    }
    #[inline(always)]
    fn erf_inv(self) -> Self {
        let v = self.v.erf_inv();
        self.chain(v, R::lit(1.0 / core::f64::consts::FRAC_2_SQRT_PI) * (v * v).exp())
    }
    #[inline(always)]
    fn lt(self, o: Self) -> R::Mask {
        self.v.lt(o.v)
    }
    #[inline(always)]
    fn le(self, o: Self) -> R::Mask {
        self.v.le(o.v)
    }
    #[inline(always)]
    fn select(mask: R::Mask, a: Self, b: Self) -> Self {
        let mut d = a.d;
        for i in 0..N {
            d[i] = R::select(mask, a.d[i], b.d[i]);
        }
        Dual { v: R::select(mask, a.v, b.v), d }
    }
    #[inline(always)]
    fn named(self, name: &'static str) -> Self {
        Dual { v: self.v.named(name), d: self.d }
    }
}
