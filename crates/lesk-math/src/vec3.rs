//! Directions and points: three numbers.

use crate::Real;
use core::ops::{Add, Div, Mul, Neg, Sub};

/// A direction, point or normal.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct Vec3<R> {
    pub x: R,
    pub y: R,
    pub z: R,
}

/// Short form of the constructor.
#[inline(always)]
pub const fn vec3<R>(x: R, y: R, z: R) -> Vec3<R> {
    Vec3 { x, y, z }
}

impl<R: Real> Vec3<R> {
    pub const ZERO: Self = vec3(R::ZERO, R::ZERO, R::ZERO);
    /// The shading normal of the local frame.
    pub const Z: Self = vec3(R::ZERO, R::ZERO, R::ONE);

    #[inline(always)]
    pub fn splat(v: R) -> Self {
        vec3(v, v, v)
    }
    #[inline(always)]
    pub fn dot(self, o: Self) -> R {
        self.x.fma(o.x, self.y.fma(o.y, self.z * o.z))
    }
    #[inline(always)]
    pub fn cross(self, o: Self) -> Self {
        vec3(self.y * o.z - self.z * o.y, self.z * o.x - self.x * o.z, self.x * o.y - self.y * o.x)
    }
    #[inline(always)]
    pub fn length_squared(self) -> R {
        self.dot(self)
    }
    #[inline(always)]
    pub fn length(self) -> R {
        self.length_squared().sqrt()
    }
    /// The unit vector along `self`. A vector shorter than 1e-18 comes out shorter than 1, never as NaN.
    #[inline(always)]
    pub fn normalize(self) -> Self {
        self * self.length_squared().safe_sqrt().recip()
    }
    /// The mirror image of `self` about `axis` (unit): `2 (self . axis) axis - self`.
    #[inline(always)]
    pub fn reflect(self, axis: Self) -> Self {
        let twice = R::TWO * self.dot(axis);
        axis * twice - self
    }
    /// `a` where the mask holds, else `b`.
    #[inline(always)]
    pub fn select(mask: R::Mask, a: Self, b: Self) -> Self {
        vec3(R::select(mask, a.x, b.x), R::select(mask, a.y, b.y), R::select(mask, a.z, b.z))
    }
    /// Keeps a name for the vector in exported source.
    #[inline(always)]
    pub fn named(self, name: &'static str) -> Self {
        vec3(self.x.named(name), self.y.named(name), self.z.named(name))
    }
    /// The unit direction at polar angle `theta` from +z and azimuth `phi` from +x, both in radians.
    #[inline(always)]
    pub fn from_spherical(theta: R, phi: R) -> Self {
        let s = theta.sin();
        vec3(s * phi.cos(), s * phi.sin(), theta.cos())
    }
}

impl<R> Vec3<R> {
    #[inline(always)]
    pub fn to_array(self) -> [R; 3] {
        [self.x, self.y, self.z]
    }
    #[inline(always)]
    pub fn map<S>(self, f: impl Fn(R) -> S) -> Vec3<S> {
        vec3(f(self.x), f(self.y), f(self.z))
    }
}

impl<R: Copy> From<[R; 3]> for Vec3<R> {
    #[inline(always)]
    fn from(a: [R; 3]) -> Self {
        vec3(a[0], a[1], a[2])
    }
}

impl<R: Real> Add for Vec3<R> {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        vec3(self.x + o.x, self.y + o.y, self.z + o.z)
    }
}
impl<R: Real> Sub for Vec3<R> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        vec3(self.x - o.x, self.y - o.y, self.z - o.z)
    }
}
impl<R: Real> Neg for Vec3<R> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        vec3(-self.x, -self.y, -self.z)
    }
}
impl<R: Real> Mul<R> for Vec3<R> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, s: R) -> Self {
        vec3(self.x * s, self.y * s, self.z * s)
    }
}
impl<R: Real> Div<R> for Vec3<R> {
    type Output = Self;
    #[inline(always)]
    #[allow(clippy::suspicious_arithmetic_impl)] // one division instead of three
    fn div(self, s: R) -> Self {
        self * s.recip()
    }
}
