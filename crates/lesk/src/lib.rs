//! Lesk for Rust users: one crate over all parts.
