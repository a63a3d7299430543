//! What normal maps and second texture coordinates need of a surface, computed only where a material asks for it.

use crate::mesh::Mesh;
use crate::shapes::Geometry;
use crate::surface::Surface;
use crate::transform::{Transform, narrow, widen};
use lesk_math::Vec3;

/// Texture coordinates of both sets and the tangent space of normal maps at a point of a surface.
#[derive(Clone, Copy, Debug)]
pub struct Detail {
    /// Texture coordinates; the first set stands for the second where the mesh has none.
    pub uvs: [[f32; 2]; 2],
    /// Unit vector along growing u in the world.
    pub tangent: Vec3<f32>,
    /// Unit vector along growing v in the world.
    pub bitangent: Vec3<f32>,
}

impl Detail {
    /// The detail of a surface of the given geometry and place, as a hit gave it: not turned to any viewer.
    pub(crate) fn at(geometry: &Geometry, place: &Transform, surface: &Surface) -> Detail {
        let Some(mesh) = geometry.mesh() else { return Detail::along(surface, [surface.uv; 2], 1.0) };
        let index = surface.prim as usize;
        let weights = weights(mesh.corners(index), narrow(place.inverse().point_f64(widen(surface.p))));
        let first = mesh.uv(0, index, weights).unwrap_or(surface.uv);
        let uvs = [first, mesh.uv(1, index, weights).unwrap_or(first)];
        match tangents(mesh, place, index, weights) {
            Some([tangent, bitangent]) => Detail { uvs, tangent, bitangent },
            None => Detail::along(surface, uvs, place.determinant().signum() as f32 * handedness(mesh, index)),
        }
    }

    /// Tangents from the derivative by u; `side` is -1 where the texture lies mirrored on the surface.
    fn along(surface: &Surface, uvs: [[f32; 2]; 2], side: f32) -> Detail {
        let frame = surface.frame();
        Detail { uvs, tangent: frame.t, bitangent: surface.ns.cross(frame.t) * side }
    }
}

/// Barycentric weights of the corners for a point of the plane of a triangle.
fn weights(corners: [Vec3<f32>; 3], p: Vec3<f32>) -> [f64; 3] {
    let [a, b, c] = corners.map(widen);
    let (e1, e2, d) = (b - a, c - a, widen(p) - a);
    let n = e1.cross(e2);
    let nn = n.length_squared();
    let v = (d.cross(e2).dot(n) / nn).clamp(0.0, 1.0);
    let w = (e1.cross(d).dot(n) / nn).clamp(0.0, 1.0 - v);
    [1.0 - v - w, v, w]
}

/// Interpolated tangents of the mesh in the world; `None` where it has none or they cancel.
fn tangents(mesh: &Mesh, place: &Transform, index: usize, weights: [f64; 3]) -> Option<[Vec3<f32>; 2]> {
    let triangle = mesh.triangles()[index];
    let mut sum = Vec3::<f64>::ZERO;
    let mut sign = 0.0;
    for (vertex, weight) in triangle.into_iter().zip(weights) {
        let [x, y, z, w] = mesh.tangents().get(vertex as usize)?.map(f64::from);
        sum = sum + Vec3::from([x, y, z]) * weight;
        sign += w * weight;
    }
    let [a, b, c] = mesh.corners(index).map(widen);
    let mut n = (b - a).cross(c - a);
    if !mesh.normals().is_empty() {
        n = triangle
            .into_iter()
            .zip(weights)
            .fold(Vec3::ZERO, |n, (vertex, weight)| n + widen(mesh.normals()[vertex as usize]) * weight);
    }
    // in local space, so that a mirrored place mirrors the bitangent too
    let across = n.cross(sum) * f64::signum(sign);
    let world = [sum, across].map(|v| narrow(place.vector_f64(v).normalize()));
    world.iter().all(|v| v.to_array().iter().all(|x| x.is_finite())).then_some(world)
}

/// 1 where the first texture coordinates turn the same way as the triangle, else -1.
fn handedness(mesh: &Mesh, index: usize) -> f32 {
    if mesh.uvs().is_empty() {
        return 1.0;
    }
    let [a, b, c] = mesh.triangles()[index].map(|i| mesh.uvs()[i as usize]);
    ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])).signum()
}

/// Tangents as bakers of normal maps make them (MikkTSpace), for a mesh that has none.
impl Mesh {
    /// The same mesh with tangents along the texture coordinates of `set`, by the algorithm that bakers of normal maps
    /// have agreed on (Mikkelsen, *Simulation of Wrinkled Surfaces Revisited*, 2008). Vertices whose faces disagree are
    /// split. Without texture coordinates the mesh stays as it is.
    #[must_use]
    pub fn with_tangents(&self, set: usize) -> Mesh {
        if self.uv_list(set).is_empty() {
            return self.clone();
        }
        let mut corners = Corners { mesh: self, set, tangents: vec![[0.0; 4]; 3 * self.triangles().len()] };
        match bevy_mikktspace::generate_tangents(&mut corners) {
            Ok(()) => self.split(&corners.tangents),
            Err(_) => self.clone(),
        }
    }
}

/// A mesh as the generator sees it, with what it answers per corner.
struct Corners<'a> {
    mesh: &'a Mesh,
    set: usize,
    tangents: Vec<[f32; 4]>,
}

impl bevy_mikktspace::Geometry for Corners<'_> {
    fn num_faces(&self) -> usize {
        self.mesh.triangles().len()
    }
    fn num_vertices_of_face(&self, _face: usize) -> usize {
        3
    }
    fn position(&self, face: usize, corner: usize) -> [f32; 3] {
        self.mesh.corners(face)[corner].to_array()
    }
    fn normal(&self, face: usize, corner: usize) -> [f32; 3] {
        let vertex = self.mesh.triangles()[face][corner];
        match self.mesh.normals().get(vertex as usize) {
            Some(normal) => normal.to_array(),
            None => {
                let [a, b, c] = self.mesh.corners(face).map(widen);
                narrow((b - a).cross(c - a).normalize()).to_array()
            }
        }
    }
    fn tex_coord(&self, face: usize, corner: usize) -> [f32; 2] {
        self.mesh.uv_list(self.set)[self.mesh.triangles()[face][corner] as usize]
    }
    fn set_tangent(&mut self, space: Option<bevy_mikktspace::TangentSpace>, face: usize, corner: usize) {
        if let Some(space) = space {
            self.tangents[3 * face + corner] = space.tangent_encoded();
        }
    }
}

/// The shading frame that a normal map bends.
impl Surface {
    /// The shading normal bent by `n`, a normal in the tangent space of `detail`; as it was where the result lies
    /// behind the surface.
    pub fn bent(&self, detail: &Detail, n: [f32; 3]) -> Vec3<f32> {
        let bent = detail.tangent * n[0] + detail.bitangent * n[1] + self.ns * n[2];
        let length = bent.length();
        if length > 1e-6 && bent.dot(self.ng) > 0.0 { bent / length } else { self.ns }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::MeshData;
    use crate::{Ray, WorldBuilder};
    use lesk_math::vec3;
    use std::sync::Arc;

    const X: Vec3<f32> = vec3(1.0, 0.0, 0.0);
    const Y: Vec3<f32> = vec3(0.0, 1.0, 0.0);

    /// The square from (0, 0) to (1, 1), normal +z, its texture turned by 90 degrees and mirrored where asked.
    fn square(mirrored: bool) -> MeshData {
        let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0f32]];
        MeshData {
            positions: corners.map(|[x, y]| vec3(x, y, 0.0)).to_vec(),
            normals: vec![Vec3::Z; 4],
            uvs: corners.map(|[x, y]| if mirrored { [1.0 - x, y] } else { [y, 1.0 - x] }).to_vec(),
            uvs_1: corners.map(|[x, y]| [2.0 * x, 3.0 * y]).to_vec(),
            triangles: vec![[0, 1, 2], [0, 2, 3]],
            ..MeshData::default()
        }
    }

    fn detail(mesh: Mesh, place: Transform) -> Detail {
        let mut builder = WorldBuilder::new();
        let number = builder.geometry(Geometry::Mesh(Arc::new(mesh)));
        builder.instance(number, place).unwrap();
        let world = builder.build().unwrap();
        let p = place.point(vec3(0.25, 0.5, 0.0));
        let ray = Ray::new(p + Vec3::Z, vec3(0.0, 0.0, -1.0));
        let surface = world.surface(&ray, &world.intersect(&ray).unwrap());
        world.detail(&surface)
    }

    fn close(a: Vec3<f32>, b: Vec3<f32>) -> bool {
        (a - b).length() < 1e-6
    }

    #[test]
    fn both_sets_of_texture_coordinates_are_found_at_a_point() {
        let place = Transform::translate(3.0, 0.0, 1.0) * Transform::scale(2.0, 2.0, 2.0).unwrap();
        let d = detail(Mesh::new(square(false)).unwrap().0, place);
        for (got, expected) in d.uvs.into_iter().flatten().zip([0.5, 0.75, 0.5, 1.5]) {
            assert!((got - expected).abs() < 1e-6, "{:?}", d.uvs);
        }
    }

    #[test]
    fn tangents_point_along_growing_texture_coordinates() {
        // u = y, v = 1 - x; mirrored: u = 1 - x, v = y
        for (mirrored, t, b) in [(false, Y, -X), (true, -X, Y)] {
            let mesh = Mesh::new(square(mirrored)).unwrap().0;
            for mesh in [mesh.with_tangents(0), mesh] {
                let d = detail(mesh, Transform::IDENTITY);
                assert!(close(d.tangent, t) && close(d.bitangent, b), "{mirrored} {d:?}");
            }
        }
        let d = detail(Mesh::new(square(false)).unwrap().0.with_tangents(1), Transform::IDENTITY);
        assert!(close(d.tangent, X) && close(d.bitangent, Y), "{d:?}");
    }

    #[test]
    fn a_mirroring_place_mirrors_tangents() {
        let place = Transform::scale(-1.0, 1.0, 1.0).unwrap();
        for mesh in [Mesh::new(square(true)).unwrap().0.with_tangents(0), Mesh::new(square(true)).unwrap().0] {
            let d = detail(mesh, place);
            assert!(close(d.tangent, X) && close(d.bitangent, Y), "{d:?}");
        }
    }

    #[test]
    fn vertices_are_split_where_mirrored_halves_of_a_texture_meet() {
        let mut data = square(false);
        // both triangles share the diagonal, but the second has its texture mirrored
        data.positions.extend([vec3(0.0, 0.0, 0.0), vec3(1.0, 1.0, 0.0)]);
        data.normals.extend([Vec3::Z; 2]);
        data.uvs_1 = vec![];
        data.uvs = vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0], [1.0, 1.0]];
        data.triangles = vec![[0, 1, 2], [0, 2, 3]];
        let mesh = Mesh::new(data).unwrap().0.with_tangents(0);
        assert_eq!(mesh.tangents().len(), mesh.positions().len());
        // 0 and 2 are used by both triangles, with tangents of either hand
        assert_eq!(mesh.positions().len(), 6);
        assert!(mesh.triangles()[0].iter().all(|v| !mesh.triangles()[1].contains(v)));
    }

    #[test]
    fn a_bent_normal_leans_along_the_tangents_and_never_behind_the_surface() {
        let d = Detail { uvs: [[0.0; 2]; 2], tangent: X, bitangent: Y };
        let ns = Vec3::Z;
        let surface = Surface { p: Vec3::ZERO, ng: ns, ns, uv: [0.0; 2], dpdu: X, lift: 0.0, instance: 0, prim: 0 };
        assert!(close(surface.bent(&d, [0.6, 0.0, 0.8]), vec3(0.6, 0.0, 0.8)));
        assert!(close(surface.bent(&d, [0.0, 3.0, 4.0]), vec3(0.0, 0.6, 0.8)));
        for behind in [[0.9, 0.0, -0.1], [0.0; 3], [f32::NAN; 3]] {
            assert!(close(surface.bent(&d, behind), ns));
        }
    }
}
