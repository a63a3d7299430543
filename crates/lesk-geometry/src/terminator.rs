//! Where rays of light start on a coarse mesh with interpolated normals, so that they meet the surface that it stands for.
//!
//! Faces that turn from the light still have interpolated normals that see it: a ray that starts on such a face is stopped
//! by the face itself or its neighbours, in whole blocks along the terminator. Hanika, *Hacking the Shadow Terminator*
//! (Ray Tracing Gems II, 2021, chapter 4), starts it above the face, where the planes through the corners, perpendicular to
//! their normals, meet: on a bulge they pass above the face, in a hollow below it, and nothing is moved.

use crate::bvh::World;
use crate::ray::Hit;
use crate::surface::Surface;
use crate::transform::widen;
use lesk_math::Vec3;

/// A corner of a face: its weight at the point, its position, metres, and its unit normal on the side of the viewer.
pub type WeightedCorner = (f64, Vec3<f64>, Vec3<f64>);

/// The point of a face where rays of light start: each corner asks for the point to be moved into its tangent plane, if it
/// lies below; the weights of the corners decide.
pub fn raised(p: Vec3<f64>, corners: impl IntoIterator<Item = WeightedCorner>) -> Vec3<f64> {
    corners.into_iter().fold(p, |moved, (weight, corner, normal)| {
        let above = (p - corner).dot(normal);
        moved - normal * (weight * above.min(0.0))
    })
}

impl World {
    /// [`raised`] for the surface at `hit`, whose `ng` points to the side of the viewer; the point itself where the surface
    /// has no normals of vertices.
    pub fn raised(&self, surface: &Surface, hit: &Hit) -> Vec3<f32> {
        let (geometry, place) = (self.geometry_of(hit.instance), self.place(hit.instance));
        let Some(mesh) = geometry.mesh().filter(|mesh| !mesh.normals().is_empty()) else { return surface.p };
        let weights = [1.0 - hit.u - hit.v, hit.u, hit.v].map(f64::from);
        let ng = widen(surface.ng);
        let corners = mesh.triangles()[hit.prim as usize].into_iter().zip(weights).map(|(vertex, weight)| {
            let normal = place.normal_f64(widen(mesh.normals()[vertex as usize])).normalize();
            // normals of a mesh are on one side of its faces
            let side = if normal.dot(ng) < 0.0 { -1.0 } else { 1.0 };
            (weight, place.point_f64(widen(mesh.positions()[vertex as usize])), normal * side)
        });
        raised(widen(surface.p), corners).map(|x| x as f32)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use lesk_math::vec3;

    /// The middle of a chord of the unit circle, of half angle `half`, with the normals of the circle at its ends.
    fn chord(half: f64, side: f64) -> (f64, f64) {
        let p = vec3(0.0, 0.0, half.cos());
        let end = |x: f64| {
            let n = vec3(x * half.sin(), 0.0, half.cos());
            (0.5, n, n * side)
        };
        let up = raised(p, [end(-1.0), end(1.0)]);
        assert!(up.x.abs() < 1e-15 && up.y == 0.0);
        (p.z, up.z)
    }

    #[test]
    fn a_bulge_is_raised_above_the_circle_that_it_stands_for_and_a_hollow_stays() {
        for half in [0.05f64, 0.2, 0.5] {
            let (p, up) = chord(half, 1.0);
            // the planes lie above the middle by sin^2 of the half angle along the normals, whose share along the axis is cos
            let expected = half.cos() + half.sin().powi(2) * half.cos();
            assert!((up - expected).abs() < 1e-15, "{half}: {up} {expected}");
            // the arc is 1 - cos above the chord, half as high to leading order
            assert!(up > 1.0 && p < 1.0);
            let (p, stays) = chord(half, -1.0);
            assert_eq!(stays, p);
        }
    }

    #[test]
    fn a_corner_of_a_face_stays_where_it_is() {
        let corner = vec3(0.3, 0.1, 2.0);
        let other = (0.0, vec3(1.0, 0.0, 9.0), vec3(0.0, 0.0, 1.0));
        assert_eq!(raised(corner, [(1.0, corner, vec3(0.0, 0.6, 0.8)), other]), corner);
    }
}
