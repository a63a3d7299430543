//! Scene files: text to data, all errors at once. Level 4 of Lesk.
//!
//! ```
//! use lesk_scene::{MAX_PARAMS, Scene};
//!
//! let scene = Scene::parse(
//!     r#"
//!     version = 1
//!     [camera]
//!     eye = [0, -4, 1.5]
//!     target = [0, 0, 0.5]
//!     [materials.clay]
//!     model = "lambert"
//!     reflectance = [0.5, 0.3, 0.2]
//!     [[objects]]
//!     shape = "sphere"
//!     radius = "50 cm"
//!     material = "clay"
//!     [[lights]]
//!     type = "point"
//!     position = [1, -2, 3]
//!     flux = "1100 lm"
//!     "#,
//!     ".",
//! )?;
//! let ray = scene.camera.ray([320.0, 300.0], [0.5, 0.5]);
//! let hit = scene.world.intersect(&ray).expect("the sphere is in the middle");
//! let surface = scene.world.surface(&ray, &hit);
//! let material = scene.material(&surface).expect("it has one");
//! let mut table = [0.0; MAX_PARAMS];
//! assert_eq!(material.params(surface.uv, &mut table), [0.5, 0.3, 0.2]);
//! # Ok::<(), lesk_scene::SceneError>(())
//! ```
//!
//! - [`Scene::load`] and [`Scene::parse`]: a TOML file, everything that it names, and every mistake with its line.
//! - [`description`]: the same as plain structures, for programs; [`SceneDescription::build`] gives the scene.
//! - [`Scene`]: what a tracer needs: world, objects, materials, lights, camera, film, settings.
//! - [`Material::params`]: a model's parameter table at a point of a surface.
//! - [`raster`]: how it is rasterised, by name.
//! - [`sensor`]: where light is measured, and [`tasks`]: the rows of EN 12464-1 it is checked against.
//! - [`json_schema`]: what a file may contain, from the table that the reader itself checks.
//!
//! **Files**: quantities with a dimension are text with a unit (`"1100 lm"`, `"5 cm"`, `"2700 K"`); bare numbers are
//! dimensionless, colours in linear Rec.709, or positions in metres. +z is up unless a key says otherwise.
//!
//! **Files of other programs**: all meshes, materials, cameras and punctual lights; glTF keeps its own axes (turn it by
//! `{ rotate = "90 deg", axis = [1, 0, 0] }`). Emission is taken as cd/m². Opacity, thin transmission and colours of
//! vertices are left out, and noted.
//!
//! It traces nothing and draws nothing; there are no media, no motion and no displacement.

mod camera;
pub mod description;
mod error;
mod material;
mod named;
pub mod raster;
mod read;
mod resolve;
mod scene;
mod schema;
pub mod sensor;
mod tasks;

pub use camera::Camera;
pub use description::SceneDescription;
pub use error::{Place, Problem, SceneError};
pub use material::{Binding, MAX_PARAMS, Material, NormalMap};
pub use raster::RasterSettings;
pub use scene::{Film, Object, RenderSettings, Scene, ShadowTerminator};
pub use schema::json_schema;
pub use sensor::{MeasureSettings, Sensor};
pub use tasks::{TASK_EDITION, Task, tasks};
