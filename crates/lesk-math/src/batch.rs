//! The batch lane: a scalar `f32` that loops over arrays turn into vector code.
//!
//! There is no SIMD type. A generic body, inlined into an index loop inside a function with `#[target_feature]`, is
//! vectorised by the compiler; [`Isa`] says at run time which of these functions this processor can run.

use crate::real::{Bits, Real, consts};
use core::ops::{Add, Div, Mul, Neg, Sub};
use std::sync::OnceLock;

/// An `f32` inside a batch loop. With `FMA`, products and sums fuse: use it only inside a function that enables the
/// instruction, or every `fma` becomes a slow library call.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(transparent)]
pub struct Lane<const FMA: bool>(pub f32);

macro_rules! operator {
    ($trait:ident, $method:ident, $op:tt) => {
        impl<const FMA: bool> $trait for Lane<FMA> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, o: Self) -> Self {
                Lane(self.0 $op o.0)
            }
        }
    };
}
operator!(Add, add, +);
operator!(Sub, sub, -);
operator!(Mul, mul, *);
operator!(Div, div, /);
impl<const FMA: bool> Neg for Lane<FMA> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Lane(-self.0)
    }
}

impl<const FMA: bool> Real for Lane<FMA> {
    type Mask = bool;
    consts!(f32, Lane);

    #[inline(always)]
    fn lit(x: f64) -> Self {
        Lane(x as f32)
    }
    #[inline(always)]
    fn fma(self, b: Self, c: Self) -> Self {
        if FMA { Lane(self.0.mul_add(b.0, c.0)) } else { Lane(self.0 * b.0 + c.0) }
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Lane(self.0.sqrt())
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Lane(self.0.abs())
    }
    #[inline(always)]
    fn min(self, o: Self) -> Self {
        Lane(Real::min(self.0, o.0))
    }
    #[inline(always)]
    fn max(self, o: Self) -> Self {
        Lane(Real::max(self.0, o.0))
    }
    #[inline(always)]
    fn round(self) -> Self {
        Lane(Real::round(self.0))
    }
    #[inline(always)]
    fn exp2(self) -> Self {
        crate::poly::exp2(self)
    }
    #[inline(always)]
    fn exp(self) -> Self {
        crate::poly::exp(self)
    }
    #[inline(always)]
    fn log2(self) -> Self {
        crate::poly::log2(self)
    }
    #[inline(always)]
    fn log2_1p(self) -> Self {
        crate::poly::log2_1p(self)
    }
    #[inline(always)]
    fn sin(self) -> Self {
        crate::poly::sin(self)
    }
    #[inline(always)]
    fn cos(self) -> Self {
        crate::poly::cos(self)
    }
    #[inline(always)]
    fn acos(self) -> Self {
        crate::poly::acos(self)
    }
    #[inline(always)]
    fn atan2(self, x: Self) -> Self {
        crate::poly::atan2(self, x)
    }
    #[inline(always)]
    fn erf(self) -> Self {
        crate::poly::erf(self)
    }
    #[inline(always)]
    fn erf_inv(self) -> Self {
        crate::poly::erf_inv(self)
    }
    #[inline(always)]
    fn lt(self, o: Self) -> bool {
        self.0 < o.0
    }
    #[inline(always)]
    fn le(self, o: Self) -> bool {
        self.0 <= o.0
    }
    #[inline(always)]
    fn select(mask: bool, a: Self, b: Self) -> Self {
        if mask { a } else { b }
    }
}

impl<const FMA: bool> Bits for Lane<FMA> {
    #[inline(always)]
    fn exp2_int(self) -> Self {
        Lane(self.0.exp2_int())
    }
    #[inline(always)]
    fn split(self) -> (Self, Self) {
        let (m, e) = self.0.split();
        (Lane(m), Lane(e))
    }
}

/// The instruction sets that batch loops are compiled for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Isa {
    /// What every processor of the target has (x86-64: SSE2).
    Baseline,
    /// AVX2 with FMA.
    Avx2,
    /// AVX-512 F, VL, BW and DQ, with BMI1, BMI2 and POPCNT.
    Avx512,
}

impl Isa {
    /// All instruction sets, slowest first.
    pub const ALL: [Isa; 3] = [Isa::Baseline, Isa::Avx2, Isa::Avx512];

    /// The name used by the environment variable `LESK_ISA` and in reports.
    pub fn name(self) -> &'static str {
        match self {
            Isa::Baseline => "baseline",
            Isa::Avx2 => "avx2",
            Isa::Avx512 => "avx512",
        }
    }

    /// Whether this processor can run it.
    pub fn is_available(self) -> bool {
        match self {
            Isa::Baseline => true,
            #[cfg(target_arch = "x86_64")]
            Isa::Avx2 => is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma"),
            #[cfg(target_arch = "x86_64")]
            Isa::Avx512 => {
                Isa::Avx2.is_available()
                    && is_x86_feature_detected!("avx512f")
                    && is_x86_feature_detected!("avx512vl")
                    && is_x86_feature_detected!("avx512bw")
                    && is_x86_feature_detected!("avx512dq")
                    && is_x86_feature_detected!("bmi1")
                    && is_x86_feature_detected!("bmi2")
                    && is_x86_feature_detected!("popcnt")
            }
            #[cfg(not(target_arch = "x86_64"))]
            _ => false,
        }
    }

    /// The instruction set in use: the best available one, or the one that `LESK_ISA` names.
    ///
    /// # Panics
    /// If `LESK_ISA` names an unknown or unavailable instruction set.
    pub fn current() -> Isa {
        static CURRENT: OnceLock<Isa> = OnceLock::new();
        *CURRENT.get_or_init(|| match std::env::var("LESK_ISA") {
            Ok(name) => match Isa::ALL.into_iter().find(|isa| isa.name() == name && isa.is_available()) {
                Some(isa) => isa,
                None => panic!("`LESK_ISA` is `{name}`, but this processor accepts {}", Isa::available_names()),
            },
            Err(_) => Isa::ALL.into_iter().rev().find(|isa| isa.is_available()).unwrap_or(Isa::Baseline),
        })
    }

    fn available_names() -> String {
        let names: Vec<_> = Isa::ALL.iter().filter(|isa| isa.is_available()).map(|isa| isa.name()).collect();
        names.join(", ")
    }
}

/// Calls a function without return value, compiled for the instruction set given: `for_isa!(isa, function, x: X, y: Y)`,
/// or `for_isa!(isa, function, [generics], x: X, y: Y)`.
///
/// The function has to be `#[inline(always)]`, and the loops in it without branches. No fused products: the results are
/// the same bits for every instruction set.
///
/// # Panics
/// If this processor lacks the instruction set.
#[macro_export]
macro_rules! for_isa {
    // the instruction set is available
    (@with $features:literal, $function:expr, [$($generics:tt)*], $($argument:ident: $Type:ty),+) => {{
        #[target_feature(enable = $features)]
        fn enabled<$($generics)*>($($argument: $Type),+) {
            $function($($argument),+)
        }
        // SAFETY: the caller of this rule has checked it
        unsafe { enabled($($argument),+) }
    }};
    ($isa:expr, $function:expr, $($argument:ident: $Type:ty),+) => {
        $crate::for_isa!($isa, $function, [], $($argument: $Type),+)
    };
    ($isa:expr, $function:expr, [$($generics:tt)*], $($argument:ident: $Type:ty),+) => {{
        let isa: $crate::Isa = $isa;
        assert!(isa.is_available(), "this processor lacks {}", isa.name());
        match isa {
            #[cfg(target_arch = "x86_64")]
            $crate::Isa::Avx512 => $crate::for_isa!(
                @with "avx2,avx512f,avx512vl,avx512bw,avx512dq", $function, [$($generics)*], $($argument: $Type),+
            ),
            #[cfg(target_arch = "x86_64")]
            $crate::Isa::Avx2 => $crate::for_isa!(@with "avx2", $function, [$($generics)*], $($argument: $Type),+),
            _ => $function($($argument),+),
        }
    }};
}
