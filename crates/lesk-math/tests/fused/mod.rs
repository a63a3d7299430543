//! An `f32` whose `fma` rounds once, as batch lanes have it on hardware with FMA.

use core::ops::{Add, Div, Mul, Neg, Sub};
use lesk_math::{Bits, Real};

#[derive(Clone, Copy)]
pub struct Fused(pub f32);

macro_rules! operator {
    ($trait:ident, $f:ident) => {
        impl $trait for Fused {
            type Output = Fused;
            fn $f(self, o: Fused) -> Fused {
                Fused(self.0.$f(o.0))
            }
        }
    };
}
operator!(Add, add);
operator!(Sub, sub);
operator!(Mul, mul);
operator!(Div, div);

impl Neg for Fused {
    type Output = Fused;
    fn neg(self) -> Fused {
        Fused(-self.0)
    }
}

macro_rules! same_as_f32 {
    ($($f:ident($($arg:ident),*)),*) => {
        $(fn $f(self, $($arg: Fused),*) -> Fused {
            Fused(Real::$f(self.0, $($arg.0),*))
        })*
    };
}
macro_rules! from_poly {
    ($($f:ident($($arg:ident),*)),*) => {
        $(fn $f(self, $($arg: Fused),*) -> Fused {
            lesk_math::poly::$f(self, $($arg),*)
        })*
    };
}

impl Real for Fused {
    type Mask = bool;
    const ZERO: Fused = Fused(0.0);
    const ONE: Fused = Fused(1.0);
    const TWO: Fused = Fused(2.0);
    const HALF: Fused = Fused(0.5);
    const PI: Fused = Fused(core::f32::consts::PI);
    const FRAC_1_PI: Fused = Fused(core::f32::consts::FRAC_1_PI);

    fn lit(x: f64) -> Fused {
        Fused(x as f32)
    }
    fn fma(self, b: Fused, c: Fused) -> Fused {
        Fused(self.0.mul_add(b.0, c.0))
    }
    same_as_f32!(sqrt(), abs(), min(o), max(o), round());
    from_poly!(exp2(), log2(), sin(), cos(), acos(), atan2(x), erf(), erf_inv());
    fn lt(self, o: Fused) -> bool {
        self.0 < o.0
    }
    fn le(self, o: Fused) -> bool {
        self.0 <= o.0
    }
    fn select(mask: bool, a: Fused, b: Fused) -> Fused {
        if mask { a } else { b }
    }
}

impl Bits for Fused {
    fn exp2_int(self) -> Fused {
        Fused(self.0.exp2_int())
    }
    fn split(self) -> (Fused, Fused) {
        let (m, e) = self.0.split();
        (Fused(m), Fused(e))
    }
}
