//! Reports as one HTML page.
use crate::report::Report;
/// todo
pub fn html(_reports: &[Report]) -> String { String::new() }
