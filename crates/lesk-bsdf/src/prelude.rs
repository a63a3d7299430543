//! What every model file imports.

pub(crate) use crate::bsdf::{Bsdf, Delta};
pub(crate) use crate::model::Property::{Isotropic, NonNegative, Passive, Reciprocal, SamplesItself, Smooth};
pub(crate) use crate::model::{Counterexample, Domain, Limit, Model, Seam};
pub(crate) use crate::terms::{diffuse, facet, fresnel, lobe, masking, ndf};
pub(crate) use lesk_derive::Params;
pub(crate) use lesk_math::{Color, Real, Vec3, vec3};
