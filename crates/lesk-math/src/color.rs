//! Colour: one number per channel.

use crate::Real;
use core::ops::{Add, Div, Mul, Neg, Sub};

/// Channels of this build: 3 (linear Rec.709), or 1 with the feature `mono`.
pub const CHANNELS: usize = if cfg!(feature = "mono") { 1 } else { 3 };

/// The colour of this build. Models use elementwise operations and [`luminance`](Channels::luminance) only.
pub type Color<R> = Channels<R, CHANNELS>;

/// `N` values, one per channel.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(transparent)]
pub struct Channels<R, const N: usize>(pub [R; N]);

impl<R: Real, const N: usize> Channels<R, N> {
    pub const BLACK: Self = Channels([R::ZERO; N]);
    pub const WHITE: Self = Channels([R::ONE; N]);

    #[inline(always)]
    pub fn splat(v: R) -> Self {
        Channels([v; N])
    }
    #[inline(always)]
    pub fn map(self, f: impl Fn(R) -> R) -> Self {
        let mut out = self.0;
        for i in 0..N {
            out[i] = f(self.0[i]);
        }
        Channels(out)
    }
    #[inline(always)]
    pub fn zip(self, o: Self, f: impl Fn(R, R) -> R) -> Self {
        let mut out = self.0;
        for i in 0..N {
            out[i] = f(self.0[i], o.0[i]);
        }
        Channels(out)
    }
    /// Rec.709 luminance of three channels; the mean of any other number of channels.
    #[inline(always)]
    pub fn luminance(self) -> R {
        if N == 3 {
            return R::lit(0.212639) * self.0[0] + R::lit(0.715169) * self.0[1] + R::lit(0.072192) * self.0[2];
        }
        let mut sum = R::ZERO;
        for i in 0..N {
            sum = sum + self.0[i];
        }
        sum / R::lit(N as f64)
    }
    #[inline(always)]
    pub fn max_component(self) -> R {
        let mut m = self.0[0];
        for i in 1..N {
            m = m.max(self.0[i]);
        }
        m
    }
    #[inline(always)]
    pub fn one_minus(self) -> Self {
        self.map(R::one_minus)
    }
    #[inline(always)]
    pub fn select(mask: R::Mask, a: Self, b: Self) -> Self {
        a.zip(b, |a, b| R::select(mask, a, b))
    }
    /// `a (1 - t) + b t`.
    #[inline(always)]
    pub fn lerp(t: R, a: Self, b: Self) -> Self {
        a.zip(b, |a, b| t.lerp(a, b))
    }
    /// Keeps a name for the colour in exported source.
    #[inline(always)]
    pub fn named(self, name: &'static str) -> Self {
        self.map(|v| v.named(name))
    }
}

impl<R: Real, const N: usize> Add for Channels<R, N> {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        self.zip(o, |a, b| a + b)
    }
}
impl<R: Real, const N: usize> Sub for Channels<R, N> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        self.zip(o, |a, b| a - b)
    }
}
impl<R: Real, const N: usize> Neg for Channels<R, N> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.map(|a| -a)
    }
}
impl<R: Real, const N: usize> Mul for Channels<R, N> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, o: Self) -> Self {
        self.zip(o, |a, b| a * b)
    }
}
impl<R: Real, const N: usize> Mul<R> for Channels<R, N> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, s: R) -> Self {
        self.map(|a| a * s)
    }
}
impl<R: Real, const N: usize> Div<R> for Channels<R, N> {
    type Output = Self;
    #[inline(always)]
    #[allow(clippy::suspicious_arithmetic_impl)] // one division instead of three
    fn div(self, s: R) -> Self {
        self * s.recip()
    }
}
