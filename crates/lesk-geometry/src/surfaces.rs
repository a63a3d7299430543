//! The surfaces at several hits at once: what triangles have in common with their neighbours is computed side by side.

use crate::bvh::World;
use crate::mesh::Mesh;
use crate::ray::{Hit, Ray};
use crate::robust::{abs, lift};
use crate::surface::{Surface, extent, facet, usable_normal};
use crate::transform::{narrow, widen};
use lesk_math::{Frame, Vec3, for_isa, vec3};

/// How many surfaces make a group.
pub const SURFACES: usize = 16;

/// One number for each surface of a group.
pub type Row = [f32; SURFACES];

/// A vector for each surface of a group, by component.
pub type VectorRows = [Row; 3];

/// A group of surfaces: the fields of [`Surface`], each as one array per number.
#[derive(Clone, Debug, Default)]
pub struct Surfaces {
    pub p: VectorRows,
    pub ng: VectorRows,
    pub ns: VectorRows,
    pub uv: [Row; 2],
    pub dpdu: VectorRows,
    pub lift: Row,
    pub instance: [u32; SURFACES],
    pub prim: [u32; SURFACES],
}

/// The vector at a place of its rows.
#[inline(always)]
pub fn vector(rows: &VectorRows, i: usize) -> Vec3<f32> {
    vec3(rows[0][i], rows[1][i], rows[2][i])
}

/// Writes a vector to a place of its rows.
#[inline(always)]
pub fn set_vector(rows: &mut VectorRows, i: usize, v: Vec3<f32>) {
    rows[0][i] = v.x;
    rows[1][i] = v.y;
    rows[2][i] = v.z;
}

impl Surfaces {
    /// One surface.
    #[inline]
    pub fn get(&self, i: usize) -> Surface {
        Surface {
            p: vector(&self.p, i),
            ng: vector(&self.ng, i),
            ns: vector(&self.ns, i),
            uv: [self.uv[0][i], self.uv[1][i]],
            dpdu: vector(&self.dpdu, i),
            lift: self.lift[i],
            instance: self.instance[i],
            prim: self.prim[i],
        }
    }

    /// Replaces one surface.
    pub fn set(&mut self, i: usize, surface: &Surface) {
        set_vector(&mut self.p, i, surface.p);
        set_vector(&mut self.ng, i, surface.ng);
        set_vector(&mut self.ns, i, surface.ns);
        set_vector(&mut self.dpdu, i, surface.dpdu);
        (self.uv[0][i], self.uv[1][i]) = (surface.uv[0], surface.uv[1]);
        self.lift[i] = surface.lift;
        (self.instance[i], self.prim[i]) = (surface.instance, surface.prim);
    }
}

/// Triangles that were hit, in the world, without texture coordinates.
#[derive(Default)]
struct Triangles {
    corners: [VectorRows; 3],
    /// Of the corners; 0 where the mesh has none.
    normals: [VectorRows; 3],
    /// Weights of the second and third corner.
    uv: [Row; 2],
}

impl World {
    /// The surfaces where up to [`SURFACES`] hits, found along their rays, lie: for each what [`surface`](Self::surface)
    /// gives.
    ///
    /// # Panics
    /// If there are more hits.
    pub fn surfaces<'a>(&self, hits: impl Iterator<Item = (&'a Ray, &'a Hit)>, out: &mut Surfaces) {
        let triangles = &mut Triangles::default();
        let mut others = [None; SURFACES];
        for (i, (ray, hit)) in hits.enumerate() {
            match self.plain_triangle(hit) {
                Some((mesh, corners)) => triangles.set(i, mesh, &corners, hit),
                None => others[i] = Some((ray, hit)),
            }
            (out.instance[i], out.prim[i]) = (hit.instance, hit.prim);
        }
        for_isa!(self.isa(), Triangles::surfaces, triangles: &Triangles, out: &mut Surfaces);
        for (i, other) in others.iter().enumerate() {
            if let Some((ray, hit)) = other {
                out.set(i, &self.surface(ray, hit));
            }
        }
    }
}

impl Triangles {
    #[inline(always)]
    fn set(&mut self, i: usize, mesh: &Mesh, corners: &[Vec3<f32>; 3], hit: &Hit) {
        (self.uv[0][i], self.uv[1][i]) = (hit.u, hit.v);
        let normals = mesh.normals();
        let of_corners = if normals.is_empty() { [0; 3] } else { mesh.triangles()[hit.prim as usize] };
        for k in 0..3 {
            set_vector(&mut self.corners[k], i, corners[k]);
            let normal = if normals.is_empty() { Vec3::ZERO } else { normals[of_corners[k] as usize] };
            set_vector(&mut self.normals[k], i, normal);
        }
    }

    /// Without branches, so that the loop is vectorised.
    #[inline(always)]
    fn surfaces(&self, out: &mut Surfaces) {
        for i in 0..SURFACES {
            let corners = [vector(&self.corners[0], i), vector(&self.corners[1], i), vector(&self.corners[2], i)];
            let (u, v) = (self.uv[0][i], self.uv[1][i]);
            let weights = [1.0 - u - v, u, v];
            let (p, outward) = facet([widen(corners[0]), widen(corners[1]), widen(corners[2])], weights);
            let ng = narrow(outward);
            let between = vector(&self.normals[0], i) * weights[0]
                + vector(&self.normals[1], i) * weights[1]
                + vector(&self.normals[2], i) * weights[2];
            let ns = usable_normal(between.normalize(), ng);
            set_vector(&mut out.p, i, p);
            set_vector(&mut out.ng, i, ng);
            set_vector(&mut out.ns, i, ns);
            set_vector(&mut out.dpdu, i, Frame::from_normal(ns).t);
            (out.uv[0][i], out.uv[1][i]) = (u, v);
            out.lift[i] = lift(ng, extent(&corners) + abs(p));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Geometry, MeshData, Transform, WorldBuilder, icosphere, uv_sphere};
    use lesk_math::Isa;
    use std::sync::Arc;

    /// Meshes with and without normals, texture coordinates and places of their own, and a sphere.
    fn world(isa: Isa) -> World {
        let bare = |mesh: Mesh| {
            let MeshData { positions, triangles, .. } = mesh.into_data();
            Mesh::new(MeshData { positions, triangles, ..MeshData::default() }).unwrap().0
        };
        let meshes = [icosphere(2), bare(icosphere(1)), uv_sphere(12, 8), bare(uv_sphere(9, 7))];
        let mut builder = WorldBuilder::new().isa(isa);
        for (k, mesh) in meshes.into_iter().enumerate() {
            let geometry = builder.geometry(Geometry::Mesh(Arc::new(mesh)));
            builder.instance(geometry, Transform::translate(3.0 * k as f64, 0.0, 0.0)).unwrap();
            if k % 2 == 0 {
                builder.instance(geometry, Transform::translate(3.0 * k as f64, 4.0, 0.0)).unwrap();
            }
        }
        let still = builder.geometry(Geometry::Mesh(Arc::new(bare(icosphere(3)))));
        builder.instance(still, Transform::IDENTITY).unwrap();
        let smooth = builder.geometry(Geometry::Mesh(Arc::new(icosphere(1))));
        builder.instance(smooth, Transform::IDENTITY).unwrap();
        let ball = builder.geometry(Geometry::Sphere);
        builder.instance(ball, Transform::translate(0.0, -3.0, 0.0)).unwrap();
        builder.build().unwrap()
    }

    #[test]
    fn a_group_of_surfaces_is_what_each_is_alone() {
        for isa in Isa::ALL.into_iter().filter(|isa| isa.is_available()) {
            let world = world(isa);
            let ray = |i: usize| {
                let target =
                    vec3((i % 47) as f32 * 0.22 - 1.0, (i % 31) as f32 * 0.27 - 3.9, (i % 7) as f32 * 0.1 - 0.3);
                let o = vec3(4.0, 1.0, 9.0);
                Ray::new(o, target - o)
            };
            let all: Vec<(Ray, Hit)> =
                (0..2000).map(ray).filter_map(|ray| world.intersect(&ray).map(|hit| (ray, hit))).collect();
            assert!(all.len() > 400, "{} hits", all.len());
            for group in all.chunks(SURFACES).chain(all.chunks(7)) {
                let mut out = Surfaces::default();
                world.surfaces(group.iter().map(|(ray, hit)| (ray, hit)), &mut out);
                for (i, (ray, hit)) in group.iter().enumerate() {
                    let alone = world.surface(ray, hit);
                    assert_eq!(format!("{:?}", out.get(i)), format!("{alone:?}"), "{isa:?}");
                }
            }
        }
    }
}
