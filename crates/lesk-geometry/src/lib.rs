//! Shapes, meshes, importers and ray casting.
//!
//! | part | what |
//! |---|---|
//! | [`Transform`] | affine map with its inverse, f64 |
//! | [`Mesh`] | triangles, checked and repaired once ([`Repairs`]) |
//! | [`polygons`] | meshes of real polygons: vertex normals, real and auxiliary edges, a report |
//! | [`Geometry`] | a mesh, or an exact rectangle, sphere, disk or cylinder of unit size |
//! | [`WorldBuilder`] → [`World`] | instances of geometries; nearest hit, occlusion, surface at a hit |
//! | [`Surface`] | position, normals, texture coordinates and tangent; where the next ray starts |
//! | [`AreaSampler`] | points on a placed geometry by area or by solid angle |
//! | [`import`] | OBJ, PLY, glTF into plain data |
//! | [`teapot`] | the Utah teapot from its Bézier patches |
//!
//! ```
//! use lesk_geometry::{Geometry, Ray, Transform, WorldBuilder};
//! use lesk_math::vec3;
//! let mut builder = WorldBuilder::new();
//! let square = builder.geometry(Geometry::Rectangle);
//! let floor = builder.instance(square, Transform::scale(10.0, 10.0, 1.0)?)?;
//! let world = builder.build()?;
//!
//! let ray = Ray::new(vec3(1.0, 2.0, 3.0), vec3(0.0, 0.0, -1.0));
//! let hit = world.intersect(&ray).expect("the floor is below");
//! assert_eq!((hit.instance, hit.t), (floor, 3.0));
//!
//! let surface = world.surface(&ray, &hit);
//! let lamp = vec3(0.0, 0.0, 4.0);
//! assert!(!world.occluded(&Ray::to_point(&surface, lamp)));
//!
//! let sample = world.area_sampler(floor)?.sample([0.5, 0.5]);
//! assert!((sample.pdf - 1.0 / 400.0).abs() < 1e-9); // one per 20 m x 20 m
//! # Ok::<(), lesk_geometry::Error>(())
//! ```
//!
//! Conventions: metres; world coordinates f32; a triangle winds counter-clockwise seen from outside; `t` of a ray counts
//! in the length of its direction, which need not be 1; numbers of instances are those that
//! [`WorldBuilder::instance`] returned, and a material or light belongs to an instance.
//!
//! This crate knows no material, no light and no pixel: importers return what files say about them as plain data.

mod bounds;
mod bvh;
mod detail;
mod error;
pub mod import;
mod mesh;
pub mod polygons;
mod ray;
mod robust;
mod shapes;
mod surface;
pub mod surfaces;
mod teapot;
mod terminator;
mod transform;

pub use bounds::Bounds;
pub use bvh::{Caster, World, WorldBuilder};
pub use detail::Detail;
pub use error::{Error, Result};
pub use mesh::{MAX_COORDINATE, Mesh, MeshData, Repairs};
pub use polygons::{EdgeRule, NormalRule, PolygonMesh};
pub use ray::{Hit, Ray};
pub use shapes::{AreaSampler, Geometry, SphericalRectangle, SurfaceSample, cube, icosphere, rectangle, uv_sphere};
pub use surface::Surface;
pub use teapot::{bezier_patch, teapot};
pub use terminator::{WeightedCorner, raised};
pub use transform::{Rows, Transform};
