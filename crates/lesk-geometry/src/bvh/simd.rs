//! Four lanes of f32: SSE where the target is x86-64 (every one has it), an array elsewhere.
//!
//! Only operations that round the same everywhere: no fused multiply-add, so that the hits of every build and of every
//! instruction set are the same bits.

#[cfg(target_arch = "x86_64")]
pub(super) use x86::F4;

#[cfg(not(target_arch = "x86_64"))]
pub(super) use portable::F4;

#[cfg(target_arch = "x86_64")]
mod x86 {
    use core::arch::x86_64::*;
    use core::ops::{Add, Div, Mul, Sub};

    /// Four lanes.
    #[derive(Clone, Copy)]
    pub struct F4(__m128);

    // SAFETY of all calls below: SSE and SSE2 belong to the x86-64 baseline
    impl F4 {
        #[inline(always)]
        pub fn splat(x: f32) -> Self {
            F4(unsafe { _mm_set1_ps(x) })
        }
        #[inline(always)]
        pub fn load(x: &[f32; 4]) -> Self {
            F4(unsafe { _mm_loadu_ps(x.as_ptr()) })
        }
        #[inline(always)]
        pub fn to_array(self) -> [f32; 4] {
            let mut out = [0.0; 4];
            unsafe { _mm_storeu_ps(out.as_mut_ptr(), self.0) };
            out
        }
        /// The larger value per lane; `o` where either is NaN.
        #[inline(always)]
        pub fn max(self, o: Self) -> Self {
            F4(unsafe { _mm_max_ps(self.0, o.0) })
        }
        /// The smaller value per lane; `o` where either is NaN.
        #[inline(always)]
        pub fn min(self, o: Self) -> Self {
            F4(unsafe { _mm_min_ps(self.0, o.0) })
        }
        /// Bit i: lane i of `self` is less than or equal to that of `o`.
        #[inline(always)]
        pub fn le(self, o: Self) -> u32 {
            unsafe { _mm_movemask_ps(_mm_cmple_ps(self.0, o.0)) as u32 }
        }
        /// Bit i: lane i of `self` is less than that of `o`.
        #[inline(always)]
        pub fn lt(self, o: Self) -> u32 {
            unsafe { _mm_movemask_ps(_mm_cmplt_ps(self.0, o.0)) as u32 }
        }
    }

    macro_rules! operator {
        ($trait:ident, $method:ident, $intrinsic:ident) => {
            impl $trait for F4 {
                type Output = Self;
                #[inline(always)]
                fn $method(self, o: Self) -> Self {
                    F4(unsafe { $intrinsic(self.0, o.0) })
                }
            }
        };
    }
    operator!(Add, add, _mm_add_ps);
    operator!(Sub, sub, _mm_sub_ps);
    operator!(Mul, mul, _mm_mul_ps);
    operator!(Div, div, _mm_div_ps);
}

#[cfg(any(test, not(target_arch = "x86_64")))]
mod portable {
    use core::array::from_fn;
    use core::ops::{Add, Div, Mul, Sub};

    /// Four lanes.
    #[derive(Clone, Copy)]
    pub struct F4([f32; 4]);

    impl F4 {
        #[inline(always)]
        pub fn splat(x: f32) -> Self {
            F4([x; 4])
        }
        #[inline(always)]
        pub fn load(x: &[f32; 4]) -> Self {
            F4(*x)
        }
        #[inline(always)]
        pub fn to_array(self) -> [f32; 4] {
            self.0
        }
        #[inline(always)]
        fn mask(self, o: Self, f: impl Fn(f32, f32) -> bool) -> u32 {
            (0..4).map(|i| (f(self.0[i], o.0[i]) as u32) << i).sum()
        }
        /// The larger value per lane; `o` where either is NaN.
        #[inline(always)]
        pub fn max(self, o: Self) -> Self {
            F4(from_fn(|i| if self.0[i] > o.0[i] { self.0[i] } else { o.0[i] }))
        }
        /// The smaller value per lane; `o` where either is NaN.
        #[inline(always)]
        pub fn min(self, o: Self) -> Self {
            F4(from_fn(|i| if self.0[i] < o.0[i] { self.0[i] } else { o.0[i] }))
        }
        /// Bit i: lane i of `self` is less than or equal to that of `o`.
        #[inline(always)]
        pub fn le(self, o: Self) -> u32 {
            self.mask(o, |a, b| a <= b)
        }
        /// Bit i: lane i of `self` is less than that of `o`.
        #[inline(always)]
        pub fn lt(self, o: Self) -> u32 {
            self.mask(o, |a, b| a < b)
        }
    }

    macro_rules! operator {
        ($trait:ident, $method:ident, $op:tt) => {
            impl $trait for F4 {
                type Output = Self;
                #[inline(always)]
                fn $method(self, o: Self) -> Self {
                    F4(from_fn(|i| self.0[i] $op o.0[i]))
                }
            }
        };
    }
    operator!(Add, add, +);
    operator!(Sub, sub, -);
    operator!(Mul, mul, *);
    operator!(Div, div, /);
}

#[cfg(all(test, target_arch = "x86_64"))]
mod tests {
    use super::{portable, x86};

    #[test]
    fn both_kinds_of_lanes_agree_bit_for_bit() {
        let edge = [0.0, -0.0, 1.5, f32::NAN, f32::INFINITY, -3.0e38, 1e-40, 0.1];
        for (i, j) in (0..8).flat_map(|i| (0..8).map(move |j| (i, j))) {
            let a = std::array::from_fn(|k| edge[(i + k) % 8]);
            let b = std::array::from_fn(|k| edge[(j + 3 * k) % 8]);
            let (x, y) = (x86::F4::load(&a), x86::F4::load(&b));
            let (p, q) = (portable::F4::load(&a), portable::F4::load(&b));
            let same = |s: [f32; 4], t: [f32; 4]| {
                (0..4).all(|k| s[k].to_bits() == t[k].to_bits() || (s[k].is_nan() && t[k].is_nan()))
            };
            assert!(same((x + y).to_array(), (p + q).to_array()));
            assert!(same((x - y).to_array(), (p - q).to_array()));
            assert!(same((x * y).to_array(), (p * q).to_array()));
            assert!(same((x / y).to_array(), (p / q).to_array()));
            assert!(same(x.max(y).to_array(), p.max(q).to_array()));
            assert!(same(x.min(y).to_array(), p.min(q).to_array()));
            assert_eq!((x.le(y), x.lt(y)), (p.le(q), p.lt(q)));
            assert_eq!(x86::F4::splat(edge[i]).le(x), portable::F4::splat(edge[i]).le(p));
        }
    }
}
