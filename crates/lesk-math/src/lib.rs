//! Numbers that become anything.
//!
//! A formula written over [`Real`] runs with `f64` as the reference, with [`Lane`] as a fast batch, with [`Dual`] as a
//! gradient, and with [`Expr`] as a recording that becomes shader source.
//!
//! This crate knows directions, colours, sampling warps and random numbers. It knows no light, no surface and no file.

mod batch;
mod color;
mod dual;
pub mod expr;
mod frame;
pub mod poly;
mod real;
pub mod rng;
pub mod sobol;
mod vec3;
pub mod warp;

pub use batch::{Isa, Lane};
pub use color::{CHANNELS, Channels, Color};
pub use dual::Dual;
pub use expr::Expr;
pub use frame::Frame;
pub use real::{Bits, Mask, Real, TINY};
pub use vec3::{Vec3, vec3};
