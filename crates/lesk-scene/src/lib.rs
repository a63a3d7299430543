//! Scene files: text to data, all errors at once.

mod camera;
pub mod description;
mod error;
mod material;
mod read;
mod resolve;
mod scene;
mod schema;

pub use camera::Camera;
pub use description::SceneDescription;
pub use error::{Place, Problem, SceneError};
pub use material::{Binding, MAX_PARAMS, Material};
pub use scene::{Film, Object, RenderSettings, Scene};
pub use schema::json_schema;
