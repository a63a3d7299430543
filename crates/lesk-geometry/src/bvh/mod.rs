//! Ray casting against all surfaces of a scene.
//!
//! Meshes that occur once are put into one tree in world space; meshes that occur often have a tree of their own, and
//! the world tree holds their instances. Spheres, disks and cylinders are met exactly.

mod build;
mod plan;
mod simd;
mod traverse;
mod tree;
mod triangle;
#[cfg(target_arch = "x86_64")]
mod turns;
mod world;

pub use world::{Caster, World, WorldBuilder};
