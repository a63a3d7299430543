//! Quotients that are divided once.

use core::ops::Mul;
use lesk_math::{CHANNELS, Color, Real};

/// `over / under`, not divided yet. A product of several costs one division; both parts must stay within the range of
/// `f32` as products too.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ratio<R> {
    pub over: R,
    pub under: R,
}

impl<R: Real> Ratio<R> {
    #[inline(always)]
    pub fn value(self) -> R {
        self.over / self.under
    }
}

impl<R: Real> Mul for Ratio<R> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, o: Self) -> Self {
        Ratio { over: self.over * o.over, under: self.under * o.under }
    }
}

/// The values of one ratio per channel. Three channels share one division, by the product of their denominators: each of
/// these must lie within 1e-12 and 1e12.
#[inline(always)]
pub(crate) fn values<R: Real>(of: impl Fn(usize) -> Ratio<R>) -> Color<R> {
    if CHANNELS != 3 {
        let mut out = Color::BLACK;
        for c in 0..CHANNELS {
            out.0[c] = of(c).value();
        }
        return out;
    }
    let (a, b, c) = (of(0), of(1), of(2));
    let bc = b.under * c.under;
    let recip = (a.under * bc).recip();
    let mut out = Color::BLACK;
    for (i, over) in [a.over * bc, b.over * (a.under * c.under), c.over * (a.under * b.under)].into_iter().enumerate() {
        out.0[i] = over * recip;
    }
    out
}
