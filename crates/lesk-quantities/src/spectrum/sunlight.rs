//! The reference spectra of sunlight of ASTM G173-03, in W/m²/nm.

use super::{Shape, Spectrum};
use std::sync::LazyLock;

/// Above the atmosphere; on a plane tilted by 37°, air mass 1.5; from the sun and 2.5° around it, likewise.
pub(super) const NAMES: [&str; 3] = ["AM0", "AM1.5G", "AM1.5D"];

/// The table of the standard; `data/astm/PROVENANCE.md` says where the numbers come from.
static TABLE: LazyLock<Vec<[f64; 4]>> = LazyLock::new(|| {
    let row = |line: &str| {
        let mut numbers = line.split(',').map(|n| n.parse().expect("data holds numbers"));
        std::array::from_fn(|_| numbers.next().expect("a row has four numbers"))
    };
    include_str!("../../../../data/astm/g173.csv").lines().skip(1).map(row).collect()
});

/// One of [`NAMES`], in any case.
pub(super) fn named(name: &str) -> Option<Spectrum> {
    let column = NAMES.iter().position(|known| known.eq_ignore_ascii_case(name))?;
    let rows = TABLE.iter().map(|row| [row[0], row[column + 1]]).collect();
    Some(Spectrum { name: NAMES[column].into(), shape: Shape::Table(rows) })
}
