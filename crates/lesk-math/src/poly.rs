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
