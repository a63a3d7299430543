//! IES LM-63.

mod header;
mod numbers;
mod read;
mod write;

pub use header::Generation;
pub(super) use header::is_ies;
pub(super) use read::read;
pub(super) use write::write;
