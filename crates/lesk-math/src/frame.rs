//! Orthonormal frames: world from local, local from world.

use crate::{Real, Vec3, vec3};

/// A right-handed orthonormal frame: tangent, bitangent, normal.
#[derive(Clone, Copy, Debug)]
pub struct Frame<R> {
    pub t: Vec3<R>,
    pub b: Vec3<R>,
    pub n: Vec3<R>,
}

impl<R: Real> Frame<R> {
    /// Some frame around the unit normal `n` (Duff et al., *Building an Orthonormal Basis, Revisited*, JCGT 2017).
    #[inline]
    pub fn from_normal(n: Vec3<R>) -> Self {
        let sign = R::select(n.z.lt(R::ZERO), -R::ONE, R::ONE);
        let a = -(sign + n.z).recip();
        let b = n.x * n.y * a;
        Frame {
            t: vec3(sign.fma(n.x * n.x * a, R::ONE), sign * b, -sign * n.x),
            b: vec3(b, n.y.fma(n.y * a, sign), -n.y),
            n,
        }
    }

    /// The frame around the unit normal `n` whose tangent is `t` made orthogonal to it.
    /// Falls back to [`from_normal`](Frame::from_normal) where `t` is parallel to `n` or zero.
    #[inline]
    pub fn from_normal_tangent(n: Vec3<R>, t: Vec3<R>) -> Self {
        let t = t - n * n.dot(t);
        let ok = t.length_squared().gt(R::lit(1e-20));
        let any = Self::from_normal(n);
        let t = Vec3::select(ok, t.normalize(), any.t);
        Frame { t, b: n.cross(t), n }
    }

    #[inline(always)]
    pub fn local_from_world(&self, v: Vec3<R>) -> Vec3<R> {
        vec3(self.t.dot(v), self.b.dot(v), self.n.dot(v))
    }
    #[inline(always)]
    pub fn world_from_local(&self, v: Vec3<R>) -> Vec3<R> {
        self.t * v.x + self.b * v.y + self.n * v.z
    }
}
