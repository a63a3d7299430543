//! Shapes at unit size; a [`Transform`](crate::Transform) gives them place and size.

mod analytic;
mod meshes;
mod parametric;
mod sampler;
mod solid_angle;

pub(crate) use analytic::{LocalSurface, shape_bounds, shape_intersect, shape_surface};
pub(crate) use meshes::rectangle_mesh;
pub use meshes::{cube, icosphere, rectangle, uv_sphere};
pub use sampler::{AreaSampler, SurfaceSample};
pub use solid_angle::SphericalRectangle;

use crate::bounds::Bounds;
use crate::mesh::Mesh;
use std::sync::Arc;

/// The form of a surface in its local space.
#[derive(Clone, Debug)]
pub enum Geometry {
    /// Triangles.
    Mesh(Arc<Mesh>),
    /// The square from (-1, -1) to (1, 1) in the plane z = 0, normal +z; u along x, v along y.
    Rectangle,
    /// The exact sphere of radius 1 around the origin, normal outward; u is the azimuth from +x, v the polar angle
    /// from +z, both scaled to 1.
    Sphere,
    /// The exact disk of radius 1 in the plane z = 0, normal +z; u is the radius, v the azimuth scaled to 1.
    Disk,
    /// The exact cylinder of radius 1 around the z axis from z = 0 to z = 1, normal outward; u is the azimuth scaled to
    /// 1, v is z.
    Cylinder {
        /// Whether disks close both ends.
        capped: bool,
    },
}

impl Geometry {
    /// The cube from -1 to 1 along every axis, each face with texture coordinates from 0 to 1.
    pub fn cube() -> Self {
        Geometry::Mesh(Arc::new(cube()))
    }

    /// The triangles of a mesh or rectangle; `None` for a curved shape.
    pub fn mesh(&self) -> Option<&Arc<Mesh>> {
        match self {
            Geometry::Mesh(mesh) => Some(mesh),
            Geometry::Rectangle => Some(rectangle_mesh()),
            _ => None,
        }
    }

    /// The box around it, local space.
    pub fn bounds(&self) -> Bounds {
        self.mesh().map_or_else(|| shape_bounds(self), |m| m.bounds())
    }
}
