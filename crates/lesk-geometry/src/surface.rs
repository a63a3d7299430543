//! The surface at a hit.

use crate::mesh::Mesh;
use crate::ray::{Hit, Ray};
use crate::robust::{abs, lift};
use crate::shapes::{Geometry, shape_surface};
use crate::transform::{Transform, narrow, widen};
use lesk_math::{Frame, Real, Vec3, vec3};

/// A point of a surface in the world, with what shading needs to know.
#[derive(Clone, Copy, Debug)]
pub struct Surface {
    /// Position, metres: on the surface up to rounding, not computed from the ray.
    pub p: Vec3<f32>,
    /// Unit geometric normal, to the outside: the side from which a triangle winds counter-clockwise.
    pub ng: Vec3<f32>,
    /// Unit shading normal, on the same side as `ng`.
    pub ns: Vec3<f32>,
    /// Texture coordinates; barycentric coordinates where the mesh has none.
    pub uv: [f32; 2],
    /// Derivative of the position by u, metres; some tangent where the texture coordinates give none.
    pub dpdu: Vec3<f32>,
    /// How far along `ng` a new ray must start, metres.
    pub lift: f32,
    /// Instance, as numbered by the builder.
    pub instance: u32,
    /// Triangle of the mesh or part of the shape.
    pub prim: u32,
}

impl Surface {
    /// A point of which only place and normal are known: `p` in metres, `n` unit, to the outside.
    #[inline]
    pub fn at(p: Vec3<f32>, n: Vec3<f32>) -> Self {
        let lift = lift(n, abs(p));
        Surface { p, ng: n, ns: n, uv: [0.0; 2], dpdu: Vec3::ZERO, lift, instance: 0, prim: 0 }
    }

    /// The shading frame: normal `ns`, tangent along `dpdu`.
    #[inline]
    pub fn frame(&self) -> Frame<f32> {
        let n = self.ns;
        let t = self.dpdu - n * n.dot(self.dpdu);
        let square = t.length_squared();
        // as `Frame::from_normal_tangent`, which evaluates both sides
        if square > 1e-20 {
            let t = t * (1.0 / square.sqrt());
            Frame { t, b: n.cross(t), n }
        } else {
            Frame::from_normal(n)
        }
    }

    /// The position moved off the surface to the side that `d` points to.
    #[inline]
    pub fn lifted(&self, d: Vec3<f32>) -> Vec3<f32> {
        self.p + self.ng * self.lift.copysign(self.ng.dot(d))
    }
}

/// The surface of a curved shape where `hit` found it.
#[inline(never)]
pub(crate) fn curved_surface(geometry: &Geometry, place: &Transform, ray: &Ray, hit: &Hit) -> Surface {
    let p_ray = widen(ray.o) + widen(ray.d) * hit.t as f64;
    let local = shape_surface(geometry, hit.prim, place.inverse().point_f64(p_ray));
    let p = narrow(place.point_f64(local.p));
    let ng = narrow(place.normal_f64(local.n).normalize());
    let dpdu = narrow(place.vector_f64(local.dpdu));
    Surface {
        p,
        ng,
        ns: ng,
        uv: local.uv.map(|x| x as f32),
        dpdu: if dpdu == Vec3::ZERO { Frame::from_normal(ng).t } else { dpdu },
        lift: lift(ng, abs(p)),
        instance: hit.instance,
        prim: hit.prim,
    }
}

/// The surface of a triangle with the corners `local` where `hit` found it; no `place` is the identity.
#[inline(always)]
pub(crate) fn triangle_surface(mesh: &Mesh, local: &[Vec3<f32>; 3], place: Option<&Transform>, hit: &Hit) -> Surface {
    let index = hit.prim as usize;
    let world = place.map_or(*local, |place| local.map(|v| place.point(v)));
    let corners = world.map(widen);
    let weights = [1.0 - hit.u - hit.v, hit.u, hit.v];
    let (p, outward) = facet(corners, weights);
    let ng = narrow(place.map_or(outward, |place| outward * place.determinant().signum()));
    let ns = shading_normal(mesh, place, index, weights, ng);
    Surface {
        p,
        ng,
        ns,
        uv: triangle_uv(mesh, index, [hit.u, hit.v]),
        dpdu: tangent(mesh, index, [corners[1] - corners[0], corners[2] - corners[0]])
            .unwrap_or_else(|| Frame::from_normal(ns).t),
        lift: lift(ng, magnitude(place, local, p)),
        instance: hit.instance,
        prim: hit.prim,
    }
}

/// The point of a triangle at the weights of its corners, and its unit normal, to the side from which it winds
/// counter-clockwise.
#[inline(always)]
pub(crate) fn facet([a, b, c]: [Vec3<f64>; 3], weights: [f32; 3]) -> (Vec3<f32>, Vec3<f64>) {
    let [wa, wb, wc] = [weights[0] as f64, weights[1] as f64, weights[2] as f64];
    (narrow(a * wa + b * wb + c * wc), (b - a).cross(c - a).normalize())
}

/// The normal between those of the corners, `ng` where they are no use for shading: they cancel, or a coarse mesh bends them
/// beyond the horizon.
#[inline(always)]
pub(crate) fn usable_normal(between: Vec3<f32>, ng: Vec3<f32>) -> Vec3<f32> {
    Vec3::select(between.dot(ng) > 1e-4, between, ng)
}

/// Bounds the coordinates that take part in finding a point of the triangle, in the world and in its local space.
fn magnitude(place: Option<&Transform>, local: &[Vec3<f32>; 3], p: Vec3<f32>) -> Vec3<f32> {
    let Some(place) = place else { return extent(local) + abs(p) };
    let size = extent(local).to_array();
    let row = |r: &[f64; 4]| (0..3).map(|k| r[k].abs() as f32 * size[k]).sum::<f32>() + r[3].abs() as f32;
    let m = place.rows();
    vec3(row(&m[0]), row(&m[1]), row(&m[2])) + abs(p)
}

/// The largest absolute coordinates of three corners.
#[inline(always)]
pub(crate) fn extent([a, b, c]: &[Vec3<f32>; 3]) -> Vec3<f32> {
    let (a, b, c) = (abs(*a), abs(*b), abs(*c));
    vec3(Real::max(Real::max(a.x, b.x), c.x), Real::max(Real::max(a.y, b.y), c.y), Real::max(Real::max(a.z, b.z), c.z))
}

#[inline(always)]
fn shading_normal(mesh: &Mesh, place: Option<&Transform>, index: usize, weights: [f32; 3], ng: Vec3<f32>) -> Vec3<f32> {
    if mesh.normals().is_empty() {
        return ng;
    }
    let n = mesh.triangles()[index].map(|i| mesh.normals()[i as usize]);
    let sum = n[0] * weights[0] + n[1] * weights[1] + n[2] * weights[2];
    let ns = place.map_or_else(|| sum.normalize(), |place| place.normal(sum));
    usable_normal(ns, ng)
}

/// Texture coordinates at the barycentric weights of the second and third corner.
pub(crate) fn triangle_uv(mesh: &Mesh, index: usize, [u, v]: [f32; 2]) -> [f32; 2] {
    if mesh.uvs().is_empty() {
        return [u, v];
    }
    let [a, b, c] = mesh.triangles()[index].map(|i| mesh.uvs()[i as usize]);
    std::array::from_fn(|k| a[k] * (1.0 - u - v) + b[k] * u + c[k] * v)
}

/// dp/du of a triangle with the given edges; `None` where the texture coordinates do not span the plane.
fn tangent(mesh: &Mesh, index: usize, edges: [Vec3<f64>; 2]) -> Option<Vec3<f32>> {
    if mesh.uvs().is_empty() {
        return None;
    }
    let [a, b, c] = mesh.triangles()[index].map(|i| mesh.uvs()[i as usize].map(f64::from));
    let (du1, dv1, du2, dv2) = (b[0] - a[0], b[1] - a[1], c[0] - a[0], c[1] - a[1]);
    let det = du1 * dv2 - dv1 * du2;
    let t = narrow((edges[0] * dv2 - edges[1] * dv1) / det);
    let length = t.length();
    (length.is_finite() && length > 0.0).then_some(t)
}
