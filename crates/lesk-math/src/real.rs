//! The number trait. A formula is written once over `R: Real`; the choice of `R` decides what it becomes.

use core::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

/// The outcome of a comparison: `bool` for plain numbers, a recorded condition for expressions.
pub trait Mask: Copy + BitAnd<Output = Self> + BitOr<Output = Self> + Not<Output = Self> {}
impl<T: Copy + BitAnd<Output = T> + BitOr<Output = T> + Not<Output = T>> Mask for T {}

/// A real number: `f32`, `f64`, a batch [`Lane`](crate::Lane), a [`Dual`](crate::Dual) or a recorded [`Expr`](crate::Expr).
///
/// There is no `PartialOrd`: a formula that branched on a number could neither be vectorised nor recorded.
/// Comparisons return a [`Mask`], and [`select`](Real::select) chooses; both sides are always evaluated.
///
/// ```
/// use lesk_math::Real;
/// fn schlick<R: Real>(f0: R, cos_theta: R) -> R {
///     f0 + f0.one_minus() * cos_theta.one_minus().powi(5)
/// }
/// assert_eq!(schlick(0.04, 1.0_f64), 0.04);
/// ```
pub trait Real:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> + Neg<Output = Self> + 'static
{
    type Mask: Mask;

    const ZERO: Self;
    const ONE: Self;
    const TWO: Self;
    const HALF: Self;
    const PI: Self;
    const FRAC_1_PI: Self;

    /// The literal `x`, as a formula of a paper prints it.
    fn lit(x: f64) -> Self;

    /// `self * b + c`; one rounding where the hardware has it, two elsewhere.
    fn fma(self, b: Self, c: Self) -> Self;
    fn sqrt(self) -> Self;
    fn abs(self) -> Self;
    /// The smaller value; `o` if `self` is NaN.
    fn min(self, o: Self) -> Self;
    /// The larger value; `o` if `self` is NaN.
    fn max(self, o: Self) -> Self;
    /// The nearest integer, ties to even (within |x| < 2^22 for `f32`).
    fn round(self) -> Self;

    fn exp2(self) -> Self;
    fn log2(self) -> Self;
    fn sin(self) -> Self;
    fn cos(self) -> Self;
    /// Arc cosine; the argument must lie in [-1, 1] (see [`safe_acos`](Real::safe_acos)).
    fn acos(self) -> Self;
    /// The angle of the point (x, y) = (`x`, `self`), in (-pi, pi]; 0 at the origin.
    fn atan2(self, x: Self) -> Self;
    fn erf(self) -> Self;
    /// The inverse of [`erf`](Real::erf) on (-1, 1).
    fn erf_inv(self) -> Self;

    fn lt(self, o: Self) -> Self::Mask;
    fn le(self, o: Self) -> Self::Mask;
    /// `a` where the mask holds, else `b`. A NaN on the side not chosen stays there.
    fn select(mask: Self::Mask, a: Self, b: Self) -> Self;

    /// Keeps a name for the value in exported source; does nothing to a number.
    #[inline(always)]
    fn named(self, _name: &'static str) -> Self {
        self
    }

    #[inline(always)]
    fn gt(self, o: Self) -> Self::Mask {
        o.lt(self)
    }
    #[inline(always)]
    fn ge(self, o: Self) -> Self::Mask {
        o.le(self)
    }
    #[inline(always)]
    fn sqr(self) -> Self {
        self * self
    }
    #[inline(always)]
    fn one_minus(self) -> Self {
        Self::ONE - self
    }
    #[inline(always)]
    fn recip(self) -> Self {
        Self::ONE / self
    }
    /// log2(1 + self) for `self >= 0`, with all digits where it is small.
    #[inline(always)]
    fn log2_1p(self) -> Self {
        let sum = Self::ONE + self;
        // the second term is what rounding took from the sum
        sum.log2() + (self - (sum - Self::ONE)) / sum * Self::lit(core::f64::consts::LOG2_E)
    }
    /// `self` to the power of a small constant, by repeated multiplication.
    #[inline(always)]
    fn powi(self, n: u32) -> Self {
        // square and multiply; a recursive function would not be inlined, and a loop around it not vectorised
        let (mut result, mut square, mut n) = (Self::ONE, self, n);
        while n > 1 {
            if n % 2 == 1 {
                result = result * square;
            }
            square = square * square;
            n /= 2;
        }
        if n == 1 { result * square } else { result }
    }
    #[inline(always)]
    fn exp(self) -> Self {
        (self * Self::lit(core::f64::consts::LOG2_E)).exp2()
    }
    #[inline(always)]
    fn ln(self) -> Self {
        self.log2() * Self::lit(core::f64::consts::LN_2)
    }
    /// `self^y` for `self >= 0`; 0^0 = 1 and 0^y = 0 for y > 0.
    #[inline(always)]
    fn pow(self, y: Self) -> Self {
        // the floor keeps log2 finite: (2^-126)^y is 0 in f32 for any y that matters, and 1 for y = 0
        (self.max(Self::lit(TINY)).log2() * y).exp2()
    }
    #[inline(always)]
    fn tan(self) -> Self {
        self.sin() / self.cos()
    }
    #[inline(always)]
    fn clamp(self, lo: Self, hi: Self) -> Self {
        self.max(lo).min(hi)
    }
    #[inline(always)]
    fn clamp01(self) -> Self {
        self.clamp(Self::ZERO, Self::ONE)
    }
    /// `sqrt(max(self, 0))`. The argument is clamped to 0 with a finite derivative there.
    #[inline(always)]
    fn safe_sqrt(self) -> Self {
        // 1e-36: its root 1e-18 is below every length that a unit direction resolves, and 1/root stays finite in f32
        self.max(Self::lit(1e-36)).sqrt()
    }
    /// `acos` of the argument clamped to [-1, 1].
    #[inline(always)]
    fn safe_acos(self) -> Self {
        self.clamp(-Self::ONE, Self::ONE).acos()
    }
    /// `a (1 - self) + b self`.
    #[inline(always)]
    fn lerp(self, a: Self, b: Self) -> Self {
        self.fma(b - a, a)
    }
}

/// The smallest normal `f32`, 2^-126: the floor under logarithms.
pub const TINY: f64 = 1.1754943508222875e-38;

/// What the polynomials of [`poly`](crate::poly) need besides arithmetic: access to the binary exponent.
pub trait Bits: Real {
    /// `2^self` for an integral `self` in [-126, 127].
    fn exp2_int(self) -> Self;
    /// Mantissa in [sqrt(1/2), sqrt(2)) and exponent of a positive normal number.
    fn split(self) -> (Self, Self);
}

macro_rules! consts {
    ($t:ty, $wrap:expr) => {
        const ZERO: Self = $wrap(0.0);
        const ONE: Self = $wrap(1.0);
        const TWO: Self = $wrap(2.0);
        const HALF: Self = $wrap(0.5);
        const PI: Self = $wrap(core::f64::consts::PI as $t);
        const FRAC_1_PI: Self = $wrap(core::f64::consts::FRAC_1_PI as $t);
    };
}
pub(crate) use consts;

const fn id32(x: f32) -> f32 {
    x
}
const fn id64(x: f64) -> f64 {
    x
}

impl Real for f32 {
    type Mask = bool;
    consts!(f32, id32);

    #[inline(always)]
    fn lit(x: f64) -> f32 {
        x as f32
    }
    #[inline(always)]
    fn fma(self, b: f32, c: f32) -> f32 {
        self * b + c
    }
    #[inline(always)]
    fn sqrt(self) -> f32 {
        f32::sqrt(self)
    }
    #[inline(always)]
    fn abs(self) -> f32 {
        f32::abs(self)
    }
    #[inline(always)]
    fn min(self, o: f32) -> f32 {
        if self < o { self } else { o }
    }
    #[inline(always)]
    fn max(self, o: f32) -> f32 {
        if self > o { self } else { o }
    }
    #[inline(always)]
    fn round(self) -> f32 {
        // adding 1.5 * 2^23 leaves no bits for a fraction; vectorises on every instruction set
        const MAGIC: f32 = 12582912.0;
        (self + MAGIC) - MAGIC
    }
    #[inline(always)]
    fn exp2(self) -> f32 {
        crate::poly::exp2(self)
    }
    #[inline(always)]
    fn exp(self) -> f32 {
        crate::poly::exp(self)
    }
    #[inline(always)]
    fn log2(self) -> f32 {
        crate::poly::log2(self)
    }
    #[inline(always)]
    fn log2_1p(self) -> f32 {
        crate::poly::log2_1p(self)
    }
    #[inline(always)]
    fn sin(self) -> f32 {
        crate::poly::sin(self)
    }
    #[inline(always)]
    fn cos(self) -> f32 {
        crate::poly::cos(self)
    }
    #[inline(always)]
    fn acos(self) -> f32 {
        crate::poly::acos(self)
    }
    #[inline(always)]
    fn atan2(self, x: f32) -> f32 {
        crate::poly::atan2(self, x)
    }
    #[inline(always)]
    fn erf(self) -> f32 {
        crate::poly::erf(self)
    }
    #[inline(always)]
    fn erf_inv(self) -> f32 {
        crate::poly::erf_inv(self)
    }
    #[inline(always)]
    fn lt(self, o: f32) -> bool {
        self < o
    }
    #[inline(always)]
    fn le(self, o: f32) -> bool {
        self <= o
    }
    #[inline(always)]
    fn select(mask: bool, a: f32, b: f32) -> f32 {
        if mask { a } else { b }
    }
}

impl Bits for f32 {
    #[inline(always)]
    fn exp2_int(self) -> f32 {
        // 1.5 * 2^23 + 127: the sum has self + 127, the biased exponent, in its lowest bits
        const MAGIC: f32 = 12583039.0;
        f32::from_bits((self + MAGIC).to_bits() << 23)
    }
    #[inline(always)]
    fn split(self) -> (f32, f32) {
        // the bits of sqrt(1/2): what is at least a power of two above them belongs to a higher exponent
        const LOWEST: i32 = 0x3f35_04f3;
        let bits = self.to_bits() as i32;
        let exponent = bits.wrapping_sub(LOWEST) >> 23;
        (f32::from_bits(bits.wrapping_sub(exponent << 23) as u32), exponent as f32)
    }
}

impl Real for f64 {
    type Mask = bool;
    consts!(f64, id64);

    #[inline(always)]
    fn lit(x: f64) -> f64 {
        x
    }
    #[inline(always)]
    fn fma(self, b: f64, c: f64) -> f64 {
        self * b + c
    }
    #[inline(always)]
    fn sqrt(self) -> f64 {
        f64::sqrt(self)
    }
    #[inline(always)]
    fn abs(self) -> f64 {
        f64::abs(self)
    }
    #[inline(always)]
    fn min(self, o: f64) -> f64 {
        if self < o { self } else { o }
    }
    #[inline(always)]
    fn max(self, o: f64) -> f64 {
        if self > o { self } else { o }
    }
    #[inline(always)]
    fn round(self) -> f64 {
        self.round_ties_even()
    }
    #[inline]
    fn exp2(self) -> f64 {
        libm::exp2(self)
    }
    #[inline]
    fn log2(self) -> f64 {
        libm::log2(self)
    }
    #[inline]
    fn log2_1p(self) -> f64 {
        libm::log1p(self) * core::f64::consts::LOG2_E
    }
    #[inline]
    fn exp(self) -> f64 {
        libm::exp(self)
    }
    #[inline]
    fn ln(self) -> f64 {
        libm::log(self)
    }
    #[inline]
    fn pow(self, y: f64) -> f64 {
        libm::pow(self.max(0.0), y)
    }
    #[inline]
    fn sin(self) -> f64 {
        libm::sin(self)
    }
    #[inline]
    fn cos(self) -> f64 {
        libm::cos(self)
    }
    #[inline]
    fn acos(self) -> f64 {
        libm::acos(self)
    }
    #[inline]
    fn atan2(self, x: f64) -> f64 {
        libm::atan2(self, x)
    }
    #[inline]
    fn erf(self) -> f64 {
        libm::erf(self)
    }
    #[inline]
    fn erf_inv(self) -> f64 {
        crate::poly::erf_inv_f64(self)
    }
    #[inline(always)]
    fn lt(self, o: f64) -> bool {
        self < o
    }
    #[inline(always)]
    fn le(self, o: f64) -> bool {
        self <= o
    }
    #[inline(always)]
    fn select(mask: bool, a: f64, b: f64) -> f64 {
        if mask { a } else { b }
    }
}
