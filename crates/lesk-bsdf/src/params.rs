//! Parameters: one flat table per model, in field order.

use lesk_math::CHANNELS;

/// What a parameter holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// One number.
    Scalar,
    /// One number per channel.
    Color,
}

/// One row of a model's parameter table.
#[derive(Clone, Copy, Debug)]
pub struct ParamSpec {
    pub name: &'static str,
    pub doc: &'static str,
    pub kind: Kind,
    /// One value, or one per channel of three.
    pub default: &'static [f64],
    /// Legal values, both ends included.
    pub range: [f64; 2],
    /// Useful values, for sliders and plots.
    pub slider: [f64; 2],
    /// Whether equal ratios, not equal differences, look alike.
    pub log: bool,
    /// The unit; empty for a dimensionless number.
    pub unit: &'static str,
}

impl ParamSpec {
    /// The number of entries in the flat table.
    pub const fn len(&self) -> usize {
        match self.kind {
            Kind::Scalar => 1,
            Kind::Color => CHANNELS,
        }
    }

    /// Never: every parameter has an entry.
    pub const fn is_empty(&self) -> bool {
        false
    }

    /// The default of channel `c`.
    pub fn default_of(&self, c: usize) -> f64 {
        self.default[c.min(self.default.len() - 1)]
    }
}

/// A model's parameters as a list of specifications and back again; derived, see `lesk_derive::Params`.
pub trait Params<R>: Sized {
    /// The doc comment of the struct: Markdown with LaTeX between `$$`.
    const DOC: &'static str;
    const SPECS: &'static [ParamSpec];

    /// Builds the parameters from the flat table, entry by entry.
    fn gather(get: impl Fn(usize) -> R) -> Self;
}

/// The length of the flat table.
pub const fn flat_len(specs: &[ParamSpec]) -> usize {
    let (mut i, mut sum) = (0, 0);
    while i < specs.len() {
        sum += specs[i].len();
        i += 1;
    }
    sum
}

/// The flat table of all defaults.
pub fn defaults(specs: &[ParamSpec]) -> Vec<f64> {
    specs.iter().flat_map(|spec| (0..spec.len()).map(|c| spec.default_of(c))).collect()
}

/// The position of the parameter `name` in the flat table.
pub fn offset_of(specs: &[ParamSpec], name: &str) -> Option<usize> {
    let at = specs.iter().position(|spec| spec.name == name)?;
    Some(flat_len(&specs[..at]))
}

/// The names of all entries of the flat table: `alpha_x`, `f0.r`, `f0.g`, `f0.b`.
pub fn flat_names(specs: &[ParamSpec]) -> Vec<String> {
    let channels = if CHANNELS == 3 { ["r", "g", "b"].as_slice() } else { &["y"] };
    let names = specs.iter().flat_map(|spec| match spec.kind {
        Kind::Scalar => vec![spec.name.to_owned()],
        Kind::Color => channels.iter().map(|c| format!("{}.{c}", spec.name)).collect(),
    });
    names.collect()
}
