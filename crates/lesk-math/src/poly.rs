//! The elementary functions of `f32`, as polynomials over any [`Bits`] number, so that loops over them vectorise
//! and shaders can carry them along.
//!
//! Largest errors over every 17th number of the domain and all numbers near zeros and borders, in units in the last place
//! of the exact result; *separate*: multiplication and addition round separately, *fused*: they round once. `tests/poly.rs`
//! asserts the bounds on every 601st number.
//!
//! | function | domain | separate | fused | bound |
//! |---|---|---|---|---|
//! | [`exp2`] | [-126, 127.5] | 1.08 | 0.83 | 1.2 |
//! | [`exp2`] | [127.5, 128) | 99.6 | 99.7 | 101 |
//! | [`exp`] | [-87.33, 88.37] | 1.19 | 0.91 | 1.2 |
//! | [`log2`] | [2^-126, largest] | 2.06 | 1.93 | 2.1 |
//! | [`log2_1p`] | [0, largest] | 2.28 | 2.03 | 2.4 |
//! | [`sin`], [`cos`] | [-4 pi, 4 pi], zeros included | 2.02 | 2.10 | 2.2 |
//! | [`sin`], [`cos`] | [-1e5, 1e5] | 1.22e-7 absolute | 1.26e-7 absolute | 1.4e-7 |
//! | [`acos`] | [-1, 1] | 2.62 | 2.62 | 2.8 |
//! | [`atan2`] | finite, radius above 2^-126 | 2.03 | 1.98 | 3 |
//! | [`erf`] | all | 6.37 | 5.95 | 9 |
//! | [`erf_inv`] | (-1, 1) | 4.82 | 4.22 | 5 |
//! | [`pow`](Real::pow) | e = y log2 x in [-126, 126] | 1.2 + 2.2 \|e\| | the same | 1.2 + 3.6 \|e\| |
//!
//! `pow` is `exp2(y * log2(x))` and has no function here: the rounding of x alone costs |y| / 2 ulp, and |e| < 1.5 |y|
//! for x in [0.37, 2.7].

use crate::{Bits, Real};
use core::f64::consts::{FRAC_1_PI, FRAC_PI_2, LOG2_E, PI};

mod table;

/// The polynomial with the coefficients `c` (ascending powers) at `x`.
///
/// Pairs of terms are summed by powers of x^2, so that half as many operations wait for each other as in Horner's scheme.
/// The constant term comes last: its sum is the only rounding that counts in full where x is small.
#[inline(always)]
fn polynomial<R: Real, const N: usize>(x: R, c: [f64; N]) -> R {
    let square = x * x;
    let pair = |k: usize| if k + 1 < N { R::lit(c[k + 1]).fma(x, R::lit(c[k])) } else { R::lit(c[k]) };
    // pairs from c[1] on
    let last = (N - 2) / 2;
    let mut sum = pair(2 * last + 1);
    for k in (0..last).rev() {
        sum = sum.fma(square, pair(2 * k + 1));
    }
    sum.fma(x, R::lit(c[0]))
}

/// 2^x. 0 below -126 (no denormal results), infinity from 128 on; NaN stays NaN.
#[inline(always)]
pub fn exp2<R: Bits>(x: R) -> R {
    // below -126 it means nothing, and is not selected
    let n = x.min(R::lit(127.0)).round();
    let r = x - n;
    let p = polynomial(r, table::EXP2).fma(r, R::ONE);
    R::select(x.lt(R::lit(-126.0)), R::ZERO, p * n.exp2_int())
}

/// The first 16 bits of ln 2, so that n * LN2_HI is exact for |n| <= 128, and the rest.
const LN2_HI: f64 = 0.693145751953125;
const LN2_LO: f64 = 1.428606765330187e-6;

/// e^x. 0 below -126 ln 2 = -87.34 (no denormal results), infinity from 88.73 on; NaN stays NaN.
#[inline(always)]
pub fn exp<R: Bits>(x: R) -> R {
    let n = (x * R::lit(LOG2_E)).min(R::lit(127.0)).round();
    let r = n.fma(R::lit(-LN2_LO), n.fma(R::lit(-LN2_HI), x));
    let p = polynomial(r, table::EXP).fma(r, R::ONE);
    R::select(x.lt(R::lit(-87.33654)), R::ZERO, p * n.exp2_int())
}

/// The binary logarithm of a normal positive number. Below 2^-126, zero included, it lies in [-127, -126];
/// of infinity it is 128. A negative number or NaN gives some finite number.
#[inline(always)]
pub fn log2<R: Bits>(x: R) -> R {
    let (m, e) = x.split();
    let t = m - R::ONE;
    polynomial(t, table::LOG2).fma(t, e)
}

/// log2(1 + x) for `x` >= 0, with all digits where x is small; infinity gives 128.
#[inline(always)]
pub fn log2_1p<R: Bits>(x: R) -> R {
    let (m, e) = (R::ONE + x).split();
    // without an exponent, x is what is left of the sum without its rounding; with one, the logarithm is at least 1/2
    let t = R::select(e.lt(R::HALF), x, m - R::ONE);
    polynomial(t, table::LOG2).fma(t, e)
}

/// Pi as a sum of three 8-bit numbers and an `f32`: an integral or half-integral multiple up to 2^15 of the
/// first three is exact without a fused multiply-add.
const PI_PARTS: [f64; 4] = [3.140625, 0.000965118408203125, 2.5331974029541016e-6, 1.984187258941006e-9];

/// `x - m pi` for integral or half-integral `m`.
#[inline(always)]
fn minus_pi<R: Real>(x: R, m: R) -> R {
    PI_PARTS.iter().fold(x, |r, &part| m.fma(R::lit(-part), r))
}

/// 0 for even, 1/2 for odd integral `n`.
#[inline(always)]
fn half_if_odd<R: Real>(n: R) -> R {
    let half = n * R::HALF;
    (half - half.round()).abs()
}

/// Sine of `r` in [-pi/2, pi/2].
#[inline(always)]
fn sin_reduced<R: Real>(r: R) -> R {
    let z = r * r;
    (r * z).fma(polynomial(z, table::SIN), r)
}

/// Sine of an angle in radians, |x| <= 1e5; beyond, accuracy fades, and from 2^22 on the result means nothing.
#[inline(always)]
pub fn sin<R: Bits>(x: R) -> R {
    let n = (x * R::lit(FRAC_1_PI)).round();
    let sign = half_if_odd(n).fma(R::lit(-4.0), R::ONE);
    sign * sin_reduced(minus_pi(x, n))
}

/// Cosine of an angle in radians, |x| <= 1e5; beyond, accuracy fades, and from 2^22 on the result means nothing.
#[inline(always)]
pub fn cos<R: Bits>(x: R) -> R {
    let n = x.fma(R::lit(FRAC_1_PI), -R::HALF).round();
    let sign = half_if_odd(n).fma(R::lit(4.0), -R::ONE);
    sign * sin_reduced(minus_pi(x, n + R::HALF))
}

/// Arc cosine, in [0, pi], of `x` in [-1, 1]; NaN outside. Relative accuracy holds up to the zero at 1.
#[inline(always)]
pub fn acos<R: Bits>(x: R) -> R {
    let a = x.abs();
    let r = (R::ONE - a).sqrt() * polynomial(a, table::ACOS);
    R::select(x.lt(R::ZERO), R::PI - r, r)
}

/// The angle of the point (`x`, `y`) in (-pi, pi]. Both must be finite; -0 counts as +0, and the origin gives 0.
#[inline(always)]
pub fn atan2<R: Bits>(y: R, x: R) -> R {
    let (ax, ay) = (x.abs(), y.abs());
    let steep = ax.lt(ay);
    // the floor makes the origin 0/TINY = 0
    let a = R::select(steep, ax, ay) / R::select(steep, ay, ax).max(R::lit(crate::TINY));
    let r = a * polynomial(a * a, table::ATAN);
    let r = R::select(steep, R::lit(FRAC_PI_2) - r, r);
    let r = R::select(x.lt(R::ZERO), R::lit(PI) - r, r);
    R::select(y.lt(R::ZERO), -r, r)
}

/// The error function 2/sqrt(pi) * integral of exp(-t^2) from 0 to `x`.
#[inline(always)]
pub fn erf<R: Bits>(x: R) -> R {
    // beyond 3.92, erf is 1 to the last bit; this order of arguments lets NaN through
    let x = R::lit(3.92).min(R::lit(-3.92).max(x));
    let z = x * x;
    let y = x * polynomial(z, table::ERF_P) / polynomial(z, table::ERF_Q);
    R::ONE.min((-R::ONE).max(y))
}

/// The inverse of [`erf`] on (-1, 1). From +-(1 - 2^-24) on it stays at +-3.83, so that no infinity arises.
#[inline(always)]
pub fn erf_inv<R: Bits>(x: R) -> R {
    // 1 - x^2 would cancel near 1
    let q = ((R::ONE - x) * (R::ONE + x)).clamp(R::lit(1.19e-7), R::ONE);
    let w = -log2(q);
    x * polynomial(w, table::ERF_INV_P) / polynomial(w, table::ERF_INV_Q)
}

/// The inverse of `erf` in `f64`: infinite at +-1, NaN outside.
#[inline]
pub fn erf_inv_f64(x: f64) -> f64 {
    let a = x.abs();
    if a >= 1.0 || a.is_nan() {
        return if a == 1.0 { f64::INFINITY.copysign(x) } else { f64::NAN };
    }
    let mut t = erf_inv_start(a);
    // each Halley step triples the number of right digits: 1e-2, 1e-6, 1e-18
    for _ in 0..3 {
        // erfc keeps all digits where erf is near 1; 1 - a is exact there
        let off = if a < 0.5 { libm::erf(t) - a } else { (1.0 - a) - libm::erfc(t) };
        let newton = off * core::f64::consts::FRAC_2_SQRT_PI.recip() * libm::exp(t * t);
        t -= newton / (1.0 + t * newton);
    }
    t.copysign(x)
}

/// `erf_inv` of `a` in [0, 1) to a relative error below 1e-2: a series near 0, else S. Winitzki,
/// *A handy approximation for the error function and its inverse*, 2008.
fn erf_inv_start(a: f64) -> f64 {
    if a < 0.5 {
        return a * (0.886_226_925_452_758 + a * a * 0.232_013_666_534_654_5);
    }
    let half_log = 0.5 * libm::log((1.0 - a) * (1.0 + a));
    let b = 2.0 / (PI * 0.147) + half_log;
    (-b + (b * b - 2.0 * half_log / 0.147).sqrt()).sqrt()
}
