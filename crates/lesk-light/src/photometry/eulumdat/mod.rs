//! EULUMDAT: one value per line, and the line number says what it is.

mod read;
mod write;

pub(super) use read::{is_eulumdat, read};
pub(super) use write::write;

use super::Symmetry;

/// The symmetries by their number in a file.
const SYMMETRIES: [Symmetry; 5] =
    [Symmetry::None, Symmetry::Rotational, Symmetry::C0C180, Symmetry::C90C270, Symmetry::Quadrant];

/// Lines before the lamp sets, and of one lamp set.
const HEAD: usize = 26;
const LAMP_LINES: usize = 6;
/// Most lamp sets of a file.
const MAX_SETS: usize = 20;
const RATIOS: usize = 10;

/// How many planes are stored for `count` of a whole turn.
fn stored_planes(symmetry: Symmetry, count: usize) -> usize {
    match symmetry {
        Symmetry::None => count,
        Symmetry::Rotational => 1,
        Symmetry::C0C180 | Symmetry::C90C270 => count / 2 + 1,
        Symmetry::Quadrant => count / 4 + 1,
    }
}
