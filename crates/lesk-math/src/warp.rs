//! Sampling warps: the unit square onto the shapes that random points and directions are drawn from.
//!
//! Each module has `sample`, from two (or one) uniform numbers in [0, 1) to the shape; `pdf`, the density there, 0 off
//! the shape; and `invert`, back to the uniform numbers. Directions are unit vectors in the local frame, densities per
//! steradian.
//!
//! ```
//! use lesk_math::warp::cosine_hemisphere;
//! let wi = cosine_hemisphere::sample([0.3_f64, 0.8]);
//! assert_eq!(cosine_hemisphere::pdf(wi), wi.z / std::f64::consts::PI);
//! let [u, v] = cosine_hemisphere::invert(wi);
//! assert!((u - 0.3).abs() < 1e-15 && (v - 0.8).abs() < 1e-15);
//! ```

use crate::{Real, Vec3, vec3};
use core::f64::consts::{FRAC_1_PI, FRAC_PI_4, PI};

/// Cosine and sine of the azimuth that is the fraction `u` of a turn.
#[inline(always)]
fn azimuth<R: Real>(u: R) -> [R; 2] {
    let phi = u * R::lit(2.0 * PI);
    [phi.cos(), phi.sin()]
}

/// The azimuth of (x, y) as a fraction of a turn, in [0, 1).
#[inline(always)]
fn turn<R: Real>(x: R, y: R) -> R {
    let u = y.atan2(x) * R::lit(0.5 * FRAC_1_PI);
    R::select(u.lt(R::ZERO), u + R::ONE, u)
}

/// The unit disk, uniformly. Squares around the centre become circles, so that stratification survives (Shirley & Chiu,
/// *A Low Distortion Map Between Disk and Square*, 1997).
pub mod disk {
    use super::*;

    /// A point (x, y).
    #[inline(always)]
    pub fn sample<R: Real>(u: [R; 2]) -> [R; 2] {
        let (a, b) = (R::TWO * u[0] - R::ONE, R::TWO * u[1] - R::ONE);
        let flat = b.abs().lt(a.abs());
        let (r, s) = (R::select(flat, a, b), R::select(flat, b, a));
        // the centre has r = s = 0; below 1e-30 no angle is worth having
        let angle = R::lit(FRAC_PI_4) * s / R::select(r.abs().lt(R::lit(1e-30)), R::ONE, r);
        let (along, across) = (r * angle.cos(), r * angle.sin());
        [R::select(flat, along, across), R::select(flat, across, along)]
    }

    /// Density per unit area.
    #[inline(always)]
    pub fn pdf<R: Real>(p: [R; 2]) -> R {
        // 1e-6: the rounding of a sample on the rim
        R::select(p[0].fma(p[0], p[1] * p[1]).le(R::lit(1.0 + 1e-6)), R::FRAC_1_PI, R::ZERO)
    }

    /// The uniform numbers that give `p`.
    #[inline(always)]
    pub fn invert<R: Real>(p: [R; 2]) -> [R; 2] {
        let flat = p[1].abs().lt(p[0].abs());
        let (major, minor) = (R::select(flat, p[0], p[1]), R::select(flat, p[1], p[0]));
        let r = p[0].fma(p[0], p[1] * p[1]).safe_sqrt();
        // sample() divides by r with its sign, so the angle is mirrored where it is negative; s = r angle / (pi / 4)
        let s = r * minor.atan2(major.abs()) * R::lit(1.0 / FRAC_PI_4);
        let r = R::select(major.lt(R::ZERO), -r, r);
        let (a, b) = (R::select(flat, r, s), R::select(flat, s, r));
        [a, b].map(|v| v.fma(R::HALF, R::HALF).clamp01())
    }
}

/// The upper hemisphere, with density proportional to the cosine (Malley's method: the disk, lifted).
pub mod cosine_hemisphere {
    use super::*;

    /// A unit direction; its z is positive, also on the horizon.
    #[inline(always)]
    pub fn sample<R: Real>(u: [R; 2]) -> Vec3<R> {
        let [x, y] = disk::sample(u);
        vec3(x, y, (R::ONE - x * x - y * y).safe_sqrt())
    }

    /// Density per steradian: cos(theta) / pi.
    #[inline(always)]
    pub fn pdf<R: Real>(w: Vec3<R>) -> R {
        w.z.max(R::ZERO) * R::FRAC_1_PI
    }

    /// The uniform numbers that give `w`.
    #[inline(always)]
    pub fn invert<R: Real>(w: Vec3<R>) -> [R; 2] {
        disk::invert([w.x, w.y])
    }
}

/// The upper hemisphere, uniformly (the disk, wrapped by Lambert's equal-area projection).
pub mod uniform_hemisphere {
    use super::*;

    /// A unit direction.
    #[inline(always)]
    pub fn sample<R: Real>(u: [R; 2]) -> Vec3<R> {
        let [x, y] = disk::sample(u);
        let r2 = x.fma(x, y * y).min(R::ONE);
        let stretch = (R::TWO - r2).sqrt();
        vec3(x * stretch, y * stretch, R::ONE - r2)
    }

    /// Density per steradian.
    #[inline(always)]
    pub fn pdf<R: Real>(w: Vec3<R>) -> R {
        R::select(w.z.lt(R::ZERO), R::ZERO, R::lit(0.5 * FRAC_1_PI))
    }

    /// The uniform numbers that give `w`.
    #[inline(always)]
    pub fn invert<R: Real>(w: Vec3<R>) -> [R; 2] {
        let shrink = (R::ONE + w.z).sqrt().recip();
        disk::invert([w.x * shrink, w.y * shrink])
    }
}

/// The sphere, uniformly (Archimedes: equal heights have equal areas).
pub mod uniform_sphere {
    use super::*;

    /// A unit direction: `u[0]` from pole +z to pole -z, `u[1]` around.
    #[inline(always)]
    pub fn sample<R: Real>(u: [R; 2]) -> Vec3<R> {
        let [c, s] = azimuth(u[1]);
        // sqrt(1 - z^2) without its cancellation at the poles
        let r = R::TWO * (u[0] * u[0].one_minus()).safe_sqrt();
        vec3(r * c, r * s, R::ONE - R::TWO * u[0])
    }

    /// Density per steradian.
    #[inline(always)]
    pub fn pdf<R: Real>(_w: Vec3<R>) -> R {
        R::lit(0.25 * FRAC_1_PI)
    }

    /// The uniform numbers that give `w`.
    #[inline(always)]
    pub fn invert<R: Real>(w: Vec3<R>) -> [R; 2] {
        [(R::ONE - w.z) * R::HALF, turn(w.x, w.y)]
    }
}

/// A cone of directions around +z, uniformly. Its width is `versine` = 1 - cos(half angle), in (0, 2], which holds narrow
/// cones in `f32` where the cosine would be 1.
pub mod uniform_cone {
    use super::*;

    /// A unit direction: `u[0]` from the axis to the rim, `u[1]` around.
    #[inline(always)]
    pub fn sample<R: Real>(versine: R, u: [R; 2]) -> Vec3<R> {
        let [c, s] = azimuth(u[1]);
        let v = versine * u[0];
        let r = (v * (R::TWO - v)).safe_sqrt();
        vec3(r * c, r * s, R::ONE - v)
    }

    /// Density per steradian.
    #[inline(always)]
    pub fn pdf<R: Real>(versine: R, w: Vec3<R>) -> R {
        // 1e-6: the rounding of a sample on the rim
        let inside = versine_of(w).le(versine * R::lit(1.0 + 1e-6));
        R::select(inside, R::lit(0.5 * FRAC_1_PI) / versine, R::ZERO)
    }

    /// The uniform numbers that give `w`.
    #[inline(always)]
    pub fn invert<R: Real>(versine: R, w: Vec3<R>) -> [R; 2] {
        [(versine_of(w) / versine).clamp01(), turn(w.x, w.y)]
    }

    /// 1 - w.z, from x and y where that would cancel.
    #[inline(always)]
    fn versine_of<R: Real>(w: Vec3<R>) -> R {
        let near = w.x.fma(w.x, w.y * w.y) / (R::ONE + w.z.max(R::ZERO));
        R::select(w.z.lt(R::ZERO), R::ONE - w.z, near)
    }
}

/// The lobe cos^n(theta) around +z, n >= 0: Phong's highlight, or Blinn's distribution with its own factors.
pub mod power_cosine {
    use super::*;

    /// A unit direction: `u[0]` = 1 gives the axis and 0 the horizon, `u[1]` goes around.
    #[inline(always)]
    pub fn sample<R: Real>(n: R, u: [R; 2]) -> Vec3<R> {
        let [c, s] = azimuth(u[1]);
        // z = u^(1 / (n + 1)) = e^-t; the floor keeps ln finite
        let t = -u[0].max(R::lit(crate::TINY)).ln() / (n + R::ONE);
        let r = one_minus_exp(R::TWO * t).safe_sqrt();
        vec3(r * c, r * s, (-t).exp())
    }

    /// Density per steradian: (n + 1) / (2 pi) cos^n(theta).
    #[inline(always)]
    pub fn pdf<R: Real>(n: R, w: Vec3<R>) -> R {
        let density = (n + R::ONE) * R::lit(0.5 * FRAC_1_PI) * w.z.max(R::ZERO).pow(n);
        R::select(w.z.lt(R::ZERO), R::ZERO, density)
    }

    /// The uniform numbers that give `w`; the first carries n + 1 times the relative error of `w.z`.
    #[inline(always)]
    pub fn invert<R: Real>(n: R, w: Vec3<R>) -> [R; 2] {
        [w.z.max(R::ZERO).pow(n + R::ONE).min(R::ONE), turn(w.x, w.y)]
    }

    /// 1 - e^-x for x >= 0; below 0.01 by its series, whose next term is x^5 / 720 = 1.4e-13 of it.
    #[inline(always)]
    fn one_minus_exp<R: Real>(x: R) -> R {
        let mut series = R::ONE;
        for k in [5.0, 4.0, 3.0, 2.0] {
            series = R::ONE - x * R::lit(1.0 / k) * series;
        }
        R::select(x.lt(R::lit(0.01)), x * series, R::ONE - (-x).exp())
    }
}

/// A triangle, uniformly, in barycentric coordinates (Heitz, *A Low-Distortion Map Between Triangle and Square*, 2019).
pub mod triangle {
    use super::*;

    /// Three weights of the corners, which sum to 1.
    #[inline(always)]
    pub fn sample<R: Real>(u: [R; 2]) -> [R; 3] {
        let half = [u[0] * R::HALF, u[1] * R::HALF];
        let upper = u[0].lt(u[1]);
        let b0 = R::select(upper, half[0], u[0] - half[1]);
        let b1 = R::select(upper, u[1] - half[0], half[1]);
        [b0, b1, R::ONE - b0 - b1]
    }

    /// Density over (b0, b1), whose triangle has the area 1/2; divide by twice the area of a triangle for 1/m².
    #[inline(always)]
    pub fn pdf<R: Real>(b: [R; 3]) -> R {
        let least = b[0].min(b[1]).min(b[2]);
        // 1e-6: the rounding of the third weight
        R::select(least.lt(R::lit(-1e-6)), R::ZERO, R::TWO)
    }

    /// The uniform numbers that give `b`.
    #[inline(always)]
    pub fn invert<R: Real>(b: [R; 3]) -> [R; 2] {
        let sum = b[0] + b[1];
        let upper = b[0].lt(b[1]);
        [R::select(upper, R::TWO * b[0], sum), R::select(upper, sum, R::TWO * b[1])]
    }
}

/// The tent 1 - |x| on [-1, 1].
pub mod tent {
    use super::*;

    /// A number in [-1, 1].
    #[inline(always)]
    pub fn sample<R: Real>(u: R) -> R {
        let left = u.lt(R::HALF);
        let tail = R::TWO * R::select(left, u, u.one_minus());
        let x = tail.safe_sqrt() - R::ONE;
        R::select(left, x, -x)
    }

    /// Density at `x`.
    #[inline(always)]
    pub fn pdf<R: Real>(x: R) -> R {
        x.abs().one_minus().max(R::ZERO)
    }

    /// The uniform number that gives `x`.
    #[inline(always)]
    pub fn invert<R: Real>(x: R) -> R {
        let tail = R::HALF * pdf(x).sqr();
        R::select(x.lt(R::ZERO), tail, tail.one_minus())
    }
}

/// The exponential distribution: the distance to the next collision in a medium of the given rate per unit length.
pub mod exponential {
    use super::*;

    /// A distance >= 0.
    #[inline(always)]
    pub fn sample<R: Real>(rate: R, u: R) -> R {
        -u.one_minus().ln() / rate
    }

    /// Density at the distance `x`.
    #[inline(always)]
    pub fn pdf<R: Real>(rate: R, x: R) -> R {
        R::select(x.lt(R::ZERO), R::ZERO, rate * (-rate * x).exp())
    }

    /// The uniform number that gives `x`.
    #[inline(always)]
    pub fn invert<R: Real>(rate: R, x: R) -> R {
        (-rate * x).exp().one_minus()
    }
}
