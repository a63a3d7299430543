//! Scene files: text to data, all errors at once.

mod camera;
mod material;
mod scene;

pub use camera::Camera;
pub use material::{Binding, MAX_PARAMS, Material};
pub use scene::{Film, Object, RenderSettings, Scene};
