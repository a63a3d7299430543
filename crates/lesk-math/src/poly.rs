//! The elementary functions of `f32`, as polynomials over any [`Bits`] number, so that loops over them vectorise
//! and shaders can carry them along.

use crate::{Bits, Real};

/// 2^x. Placeholder accuracy until the tested version lands.
#[inline(always)]
pub fn exp2<R: Bits>(x: R) -> R {
    let x = x.clamp(R::lit(-126.0), R::lit(127.0));
    let n = x.round();
    let f = x - n;
    let p = f.fma(R::lit(0.00015403530393381608), R::lit(0.0013333558146428443));
    let p = p.fma(f, R::lit(0.009618129107628477)).fma(f, R::lit(0.05550410866482158));
    let p = p.fma(f, R::lit(0.2402265069591007)).fma(f, R::lit(0.6931471805599453)).fma(f, R::ONE);
    p * n.exp2_int()
}

#[inline(always)]
pub fn log2<R: Bits>(x: R) -> R {
    let (m, e) = x.split();
    let big = m.gt(R::lit(core::f64::consts::SQRT_2));
    let m = R::select(big, m * R::HALF, m);
    let e = R::select(big, e + R::ONE, e);
    let s = (m - R::ONE) / (m + R::ONE);
    let z = s * s;
    let p = z.fma(R::lit(0.32063761), R::lit(0.41218)).fma(z, R::lit(0.57707802));
    let p = p.fma(z, R::lit(0.96179669)).fma(z, R::lit(2.88539008));
    p.fma(s, e)
}
// ---- placeholders until the tested versions land ----
#[inline(always)]
pub fn sin<R: Bits>(x: R) -> R {
    let n = (x * R::FRAC_1_PI).round();
    let r = x - n * R::PI;
    let odd = (n * R::HALF).round() * R::TWO - n;
    let z = r * r;
    let s = r * (R::ONE + z * (R::lit(-1.0 / 6.0) + z * (R::lit(1.0 / 120.0) + z * (R::lit(-1.0 / 5040.0) + z * R::lit(1.0 / 362880.0)))));
    R::select(odd.abs().gt(R::HALF), -s, s)
}
#[inline(always)]
pub fn cos<R: Bits>(x: R) -> R {
    sin(x + R::PI * R::HALF)
}
#[inline(always)]
pub fn acos<R: Bits>(x: R) -> R {
    let a = x.abs();
    let p = R::lit(1.5707288) + a * (R::lit(-0.2121144) + a * (R::lit(0.0742610) + a * R::lit(-0.0187293)));
    let r = p * (R::ONE - a).max(R::ZERO).sqrt();
    R::select(x.lt(R::ZERO), R::PI - r, r)
}
#[inline(always)]
pub fn atan2<R: Bits>(y: R, x: R) -> R {
    let l = (x * x + y * y).sqrt().max(R::lit(1e-30));
    let a = acos(x / l);
    R::select(y.lt(R::ZERO), -a, a)
}
#[inline(always)]
pub fn erf<R: Bits>(x: R) -> R {
    let a = x.abs();
    let t = (R::ONE + R::lit(0.3275911) * a).recip();
    let p = t * (R::lit(0.254829592) + t * (R::lit(-0.284496736) + t * (R::lit(1.421413741) + t * (R::lit(-1.453152027) + t * R::lit(1.061405429)))));
    let e = R::ONE - p * (-(a * a)).exp();
    R::select(x.lt(R::ZERO), -e, e)
}
#[inline(always)]
pub fn erf_inv<R: Bits>(x: R) -> R {
    let w = -(R::ONE - x * x).ln();
    let b = R::lit(4.3307467508) + w * R::HALF;
    let s = (b * b - w * R::lit(6.802721088)).safe_sqrt() - b;
    s.safe_sqrt() * R::select(x.lt(R::ZERO), -R::ONE, R::ONE)
}
pub fn erf_inv_f64(x: f64) -> f64 {
    let mut y = 0.0;
    for _ in 0..60 { y -= (libm::erf(y) - x) / (core::f64::consts::FRAC_2_SQRT_PI * libm::exp(-y * y)); }
    y
}
