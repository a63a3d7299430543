//! What a scene file may contain: one table, from which the reader, its hints and the JSON Schema are made.

mod json;
mod raster;
mod sections;
mod sensors;

pub use json::json_schema;
pub(crate) use raster::*;
pub(crate) use sections::*;
pub(crate) use sensors::*;

use lesk_quantities::Dimension;

/// One key of a table.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Field {
    pub name: &'static str,
    pub doc: &'static str,
    pub kind: Kind,
    pub required: bool,
}

/// What a key accepts.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Kind {
    /// Any text.
    Text,
    Bool,
    /// One of these words.
    Choice(&'static [&'static str]),
    /// A list of these words.
    Choices(&'static [&'static str]),
    Integer([i64; 2]),
    Number([f64; 2]),
    /// So many numbers.
    Numbers(usize),
    /// One number, or so many.
    NumberOr(usize),
    /// So many integers.
    Integers(usize, [i64; 2]),
    /// Three rows of four numbers.
    Matrix,
    /// Text of a number with a unit; the range counts in SI units.
    Quantity(&'static [Dimension], [f64; 2]),
    /// A number, or text with the unit EV.
    Exposure,
    /// A table.
    Table(Section),
    /// A list of tables.
    List(Section),
    /// Tables by names that the author chooses.
    Named(Section),
    /// One step of a transform, or a list of them.
    Steps,
}

/// The keys of a table.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Section {
    /// These.
    Plain(&'static str, &'static [Field]),
    /// Some for all, and more by the word under the key `tag`.
    Variants(&'static Variants),
    /// A material: the keys depend on the model.
    Material,
}

#[derive(Debug)]
pub(crate) struct Variants {
    /// What a table of this kind is called in messages.
    pub name: &'static str,
    pub tag: &'static str,
    pub common: &'static [Field],
    pub cases: &'static [(&'static str, &'static [Field])],
}

const fn field(name: &'static str, kind: Kind, doc: &'static str) -> Field {
    Field { name, doc, kind, required: false }
}

const fn needed(name: &'static str, kind: Kind, doc: &'static str) -> Field {
    Field { name, doc, kind, required: true }
}
