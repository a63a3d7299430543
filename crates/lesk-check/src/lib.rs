//! Runs the claims of the models: a claim is a test, and a property that is not claimed must be refuted.
//!
//! ```
//! use lesk_check::{Effort, check};
//! let lambert = lesk_bsdf::registry::find("lambert").unwrap();
//! let report = check(lambert, Effort::Quick);
//! assert!(report.passed(), "{}", lesk_check::text(&[report]));
//! ```
//!
//! This crate tests what a model says about itself, and that its `f32` functions give no NaN. It does not compare
//! models with other programs, number types with each other, or shaders with models.

pub mod chi_square;
pub mod condition;
pub mod counterexample;
pub mod cubature;
pub mod directions;
mod effort;
pub mod energy;
mod error;
pub mod finding;
pub mod furnace;
mod html;
pub mod isotropy;
pub mod limits;
pub mod mutants;
pub mod nan_grid;
pub mod non_negative;
pub mod partition;
pub mod random;
pub mod reciprocity;
pub mod region;
mod report;
mod runner;
pub mod smooth;
pub mod statistics;
pub mod subject;
mod text;

pub use effort::{Budget, Effort};
pub use error::Error;
pub use html::html;
pub use report::{Place, Report, Row, Verdict, json};
pub use runner::{check, check_all, check_property, check_subject, measure, worst};
pub use text::text;
