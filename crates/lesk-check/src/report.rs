//! What the checks of one model found, as data.

use crate::effort::Effort;
use crate::furnace::Curve;
use serde::{Deserialize, Serialize};

/// The outcome of one row.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// The property holds wherever it was tested.
    Held,
    /// The property is claimed under a condition, and fails outside it, as it should.
    RefutedOutside,
    /// The property is not claimed, and fails at the stored counterexample, as it should.
    RefutedAsStored,
    /// The model is not what it says.
    Failed,
}

/// Where a value was measured.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Place {
    /// The flat parameter table by name.
    pub params: Vec<(String, f64)>,
    /// Polar angle and azimuth of the direction to the light, degrees.
    pub wi_deg: [f64; 2],
    /// The same of the direction to the viewer.
    pub wo_deg: [f64; 2],
}

/// One tested statement.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Row {
    /// `reciprocal`, ..., `limit`, `finite`.
    pub property: String,
    /// The condition of the claim, or the parameters of the limit.
    pub condition: Option<String>,
    /// The outcome.
    pub verdict: Verdict,
    /// What `value` is.
    pub measure: String,
    /// The worst value that was found; none where nothing could be measured, or it is not finite.
    pub value: Option<f64>,
    /// The largest value with which the property holds.
    pub allowed: Option<f64>,
    /// The estimated numerical error of `value`.
    pub error: f64,
    /// Where the value was found.
    pub place: Option<Place>,
    /// Why it failed, or why the property does not hold.
    pub note: String,
    /// Time spent, seconds.
    pub seconds: f64,
}

/// All that was found about one model.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Report {
    /// The model.
    pub id: String,
    /// Its title.
    pub title: String,
    /// The key of its paper.
    pub paper: String,
    /// How much was tested.
    pub effort: Effort,
    /// One row per statement.
    pub rows: Vec<Row>,
    /// Directional albedo at the default parameters.
    pub albedo: Vec<Curve>,
    /// Time spent, seconds.
    pub seconds: f64,
}

impl Report {
    /// Whether the model is what it says.
    pub fn passed(&self) -> bool {
        self.failures().next().is_none()
    }

    /// The rows that failed.
    pub fn failures(&self) -> impl Iterator<Item = &Row> {
        self.rows.iter().filter(|row| row.verdict == Verdict::Failed)
    }
}

/// The reports as JSON: `{"version": 1, "models": [...]}`.
pub fn json(reports: &[Report]) -> serde_json::Value {
    serde_json::json!({ "version": 1, "models": reports })
}
