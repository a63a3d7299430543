//! Rays and what they hit.

use crate::shapes::SurfaceSample;
use crate::surface::Surface;
use lesk_math::Vec3;

/// The points `o + t d` for `t_min < t < t_max`.
///
/// `d` need not have unit length; `t` counts in its length. A direction of zero or with an entry that is not finite hits
/// nothing, nor does a ray from farther than 1e27 times the length of its direction (less 1e12 m, the largest coordinate).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Origin, metres.
    pub o: Vec3<f32>,
    /// Direction.
    pub d: Vec3<f32>,
    /// Nearest parameter, exclusive; at least 0 (a negative one counts as 0).
    pub t_min: f32,
    /// Farthest parameter, exclusive.
    pub t_max: f32,
}

impl Ray {
    /// From `o` along `d` without end.
    pub fn new(o: Vec3<f32>, d: Vec3<f32>) -> Self {
        Ray { o, d, t_min: 0.0, t_max: f32::INFINITY }
    }

    /// The point at parameter `t`.
    #[inline]
    pub fn at(&self, t: f32) -> Vec3<f32> {
        self.o + self.d * t
    }

    /// From point `a` to point `b`, both excluded by a ten-thousandth of the way.
    pub fn between(a: Vec3<f32>, b: Vec3<f32>) -> Self {
        Ray { o: a, d: b - a, t_min: 1e-4, t_max: 1.0 - 1e-4 }
    }

    /// From the surface along `d` without end, lifted off the side that `d` leaves from.
    #[inline]
    pub fn leaving(from: &Surface, d: Vec3<f32>) -> Self {
        Ray::new(from.lifted(d), d)
    }

    /// From the surface to the point `b`; `d` spans the whole way, so that `t` runs from 0 to 1.
    /// The last ten-thousandth of the way is not tested.
    pub fn to_point(from: &Surface, b: Vec3<f32>) -> Self {
        let o = from.lifted(b - from.p);
        Ray { o, d: b - o, t_min: 0.0, t_max: 1.0 - 1e-4 }
    }

    /// From the surface to a point on another one, lifted off both.
    #[inline]
    pub fn to_sample(from: &Surface, to: &SurfaceSample) -> Self {
        Self::to_lifted(from, to.p, to.n, to.lift)
    }

    /// From the surface to the point `p` of one with the unit normal `n`, lifted off both, there by `lift` metres.
    #[inline(always)]
    pub fn to_lifted(from: &Surface, p: Vec3<f32>, n: Vec3<f32>, lift: f32) -> Self {
        let back = from.p - p;
        // `d` is rounded to half a digit of its own: far away that is more than the digits of the point
        let rounding = f32::EPSILON * (back.x.abs() + back.y.abs() + back.z.abs());
        let target = p + n * (lift + rounding).copysign(n.dot(back));
        let o = from.lifted(target - from.p);
        Ray { o, d: target - o, t_min: 0.0, t_max: 1.0 }
    }
}

/// The nearest surface along a ray.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Hit {
    /// Parameter along the ray.
    pub t: f32,
    /// Instance, as numbered by the builder.
    pub instance: u32,
    /// Geometry of the instance.
    pub geometry: u32,
    /// Triangle of the mesh; of a cylinder 0 side, 1 bottom, 2 top; of other shapes 0.
    pub prim: u32,
    /// Barycentric weight of the triangle's second corner; 0 for curved shapes.
    pub u: f32,
    /// Barycentric weight of the triangle's third corner; 0 for curved shapes.
    pub v: f32,
    /// The place of a triangle in its tree.
    pub(crate) slot: u32,
}
