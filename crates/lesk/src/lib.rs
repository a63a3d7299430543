//! Lesk for Rust users: one crate over all parts.
//!
//! ```
//! use lesk::math::Vec3;
//! use lesk::models;
//!
//! let ggx = models::find("ggx").expect("a model of the registry");
//! let params = models::defaults(ggx);
//! let (wi, wo) = (Vec3::from_spherical(0.5, 0.0), Vec3::from_spherical(0.5, std::f32::consts::PI));
//! let f = ggx.eval(&params, wi, wo); // 1/sr per channel
//! assert!(f.0[0] > 1.0);
//! ```
//!
//! It adds nothing of its own but shorter names; each part is a crate with documentation of its own.

pub use lesk_check as check;
pub use lesk_geometry as geometry;
pub use lesk_image as image;
pub use lesk_light as light;
pub use lesk_math as math;
pub use lesk_quantities as quantities;
pub use lesk_raster as raster;
pub use lesk_scene as scene;
pub use lesk_shader as shader;
pub use lesk_trace as trace;

/// Scattering models.
pub mod models {
    pub use lesk_bsdf::registry::{all, find};
    pub use lesk_bsdf::{Scatter, batch, bsdf, model, params, terms};

    /// The flat parameter table of a model with every value at its default.
    pub fn defaults(model: &dyn Scatter) -> Vec<f32> {
        params::defaults(model.specs()).into_iter().map(|value| value as f32).collect()
    }
}
