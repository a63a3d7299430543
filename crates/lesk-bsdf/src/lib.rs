//! Scattering models, each written once.

extern crate self as lesk_bsdf;

pub mod batch;
pub mod bsdf;
pub mod kernels;
pub mod model;
pub mod models;
pub mod params;
mod prelude;
pub mod registry;
pub mod scatter;
mod target;
pub mod terms;

pub use scatter::Scatter;
