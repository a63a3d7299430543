//! The parts of models, one function per published formula, usable alone.

pub mod diffuse;
pub mod facet;
pub mod fresnel;
pub mod lobe;
pub mod masking;
pub mod ndf;
pub(crate) mod ratio;
