//! Scanline rasterising: a scene becomes a picture by flat, Gouraud or Phong shading.
//!
//! [`Raster::new`] turns every surface of a scene into faces with vertex normals, [`Raster::frame`] draws them polygon by
//! polygon into a depth buffer and computes the direct light of every material of Lesk: at faces, at vertices or at pixels
//! ([`Mode`]). [`Classic`] is the local model of textbooks, without units.
//!
//! ```
//! use lesk_raster::{Mode, Raster, Settings};
//! use lesk_scene::Scene;
//! let scene = Scene::parse(r#"
//!     version = 1
//!     [camera]
//!     eye = [0, -4, 0]
//!     target = [0, 0, 0]
//!     [film]
//!     size = [32, 24]
//!     [materials.clay]
//!     model = "lambert"
//!     [[objects]]
//!     shape = "sphere"
//!     material = "clay"
//!     [[lights]]
//!     type = "point"
//!     position = [0, -4, 4]
//!     intensity = "100 cd"
//! "#, ".")?;
//! let mut raster = Raster::new(scene.into(), &Settings { shading: Mode::Gouraud, ..Settings::default() })?;
//! let frame = raster.frame();
//! assert!(frame.work.evaluations < frame.work.vertices); // only those that show
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! It does not trace reflections, interreflections or soft shadows, has no lens and filters pixels by a box only.

mod band;
mod classic;
mod clip;
mod error;
mod frame;
mod inside;
mod lanes;
mod lights;
mod memory;
mod prepare;
mod run;
mod samples;
mod scan;
mod shade;
#[cfg(target_arch = "x86_64")]
mod small;
mod subdivide;
mod tangents;
mod view;

pub use error::{Error, Result};
pub use frame::{Count, Frame, Raster, SampleHit};
pub use lesk_scene::raster::{
    Classic, ClassicLight, Correction, FlatPoint, Highlight, Interpolation, Mode, RasterSettings as Settings, Space,
};
