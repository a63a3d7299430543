//! How much to test.

use serde::{Deserialize, Serialize};

/// How much to test.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Effort {
    /// Seconds per model.
    Quick,
    /// Minutes per model.
    Full,
}

/// The numbers behind an effort.
#[derive(Clone, Copy, Debug)]
pub struct Budget {
    /// Random pairs of directions, each at parameters of its own.
    pub pairs: usize,
    /// Random segments through directions and parameters.
    pub segments: usize,
    /// Parameters at which the scattered power is scanned.
    pub power_params: usize,
    /// Directions at each of them.
    pub power_directions: usize,
    /// Best points of the scan from which a climb starts.
    pub power_climbs: usize,
    /// Steps of a climb.
    pub power_steps: usize,
    /// Histograms, each at a direction and parameters of its own.
    pub histograms: usize,
    /// Draws per histogram.
    pub draws: usize,
    /// Points per axis of the grid that looks for NaN and infinity: directions by parameters.
    pub grid: usize,
}

impl Effort {
    /// The numbers of this effort.
    pub fn budget(self) -> Budget {
        match self {
            Effort::Quick => Budget {
                pairs: 20_000,
                segments: 6_000,
                power_params: 64,
                power_directions: 8,
                power_climbs: 6,
                power_steps: 24,
                histograms: 40,
                draws: 30_000,
                grid: 20,
            },
            Effort::Full => Budget {
                pairs: 300_000,
                segments: 40_000,
                power_params: 400,
                power_directions: 10,
                power_climbs: 24,
                power_steps: 60,
                histograms: 150,
                draws: 200_000,
                grid: 64,
            },
        }
    }
}
