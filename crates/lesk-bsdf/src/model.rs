//! What a model says about itself: sources, domain, claims, limits, counterexamples. All of it is tested.

use lesk_math::Vec3;

/// The facts of one model.
#[derive(Clone, Copy, Debug)]
pub struct Model {
    /// One line: what people call it.
    pub title: &'static str,
    /// The key of the paper in `references.bib`.
    pub paper: &'static str,
    pub year: u16,
    pub domain: Domain,
    /// Properties that hold, each a test.
    pub claims: &'static [Claim],
    /// Properties that do not hold, each with the place that proves it, replayed by a test.
    pub counterexamples: &'static [Counterexample],
    /// Parameters at which the model becomes another one.
    pub limits: &'static [Limit],
    /// Where the model has a kink, as the zeros of functions; [`Property::Smooth`] is not tested across them.
    pub seams: &'static [Seam],
}

impl Model {
    /// The values that a model does not mention.
    pub const DEFAULT: Model = Model {
        title: "",
        paper: "",
        year: 0,
        domain: Domain::Upper,
        claims: &[],
        counterexamples: &[],
        limits: &[],
        seams: &[],
    };
}

/// The directions that a model accepts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Domain {
    /// Both directions above the surface (z > 0).
    Upper,
    /// Either direction on either side; eta = n(below) / n(above).
    BothSides,
    /// The whole sphere around a fibre.
    Sphere,
}

/// A property of scattering models; `lesk-check` has the test of each.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Property {
    /// f(i, o) / eta_o^2 = f(o, i) / eta_i^2, and the same for the weights of delta lobes.
    Reciprocal,
    /// For every wi, the power of the delta lobes and of f |cos wo| dwo is at most 1.
    Passive,
    /// `pdf` is the density of `sample`; delta lobes are drawn as often as they say.
    SamplesItself,
    /// Turning both directions about the normal changes nothing.
    Isotropic,
    /// f >= 0.
    NonNegative,
    /// No delta lobe, and f has a continuous gradient except on the model's seams.
    Smooth,
}

impl Property {
    /// All properties, in the order of reports.
    pub const ALL: [Property; 6] = [
        Property::Reciprocal,
        Property::Passive,
        Property::SamplesItself,
        Property::Isotropic,
        Property::NonNegative,
        Property::Smooth,
    ];

    /// The name in reports: `reciprocal`, `samples_itself`, ...
    pub fn name(self) -> &'static str {
        match self {
            Property::Reciprocal => "reciprocal",
            Property::Passive => "passive",
            Property::SamplesItself => "samples_itself",
            Property::Isotropic => "isotropic",
            Property::NonNegative => "non_negative",
            Property::Smooth => "smooth",
        }
    }

    /// A claim that holds for all legal parameters.
    pub const fn always(self) -> Claim {
        Claim { property: self, when: None }
    }

    /// A claim that holds where `condition` does (tested inside, refuted outside). The condition compares sums and
    /// products of parameters and numbers; for colours it must hold in each channel: `diffuse + specular <= 1`.
    pub const fn when(self, condition: &'static str) -> Claim {
        Claim { property: self, when: Some(condition) }
    }
}

/// A property that a model has.
#[derive(Clone, Copy, Debug)]
pub struct Claim {
    pub property: Property,
    /// The condition on the parameters; none means all legal values.
    pub when: Option<&'static str>,
}

/// Where a property fails.
#[derive(Clone, Copy, Debug)]
pub struct Counterexample {
    pub property: Property,
    /// Parameters that differ from their defaults; a colour is grey.
    pub params: &'static [(&'static str, f64)],
    /// Polar angle and azimuth in degrees.
    pub wi_deg: [f64; 2],
    pub wo_deg: [f64; 2],
    /// Why it fails, for the report.
    pub because: &'static str,
}

/// At the given parameters the model equals `other`.
#[derive(Clone, Copy, Debug)]
pub struct Limit {
    /// Parameters of this model that are fixed.
    pub at: &'static [(&'static str, f64)],
    /// The id of the other model.
    pub equals: &'static str,
    /// The other model's parameters: (theirs, ours) by name.
    pub link: &'static [(&'static str, &'static str)],
    /// The other model's parameters that are fixed.
    pub with: &'static [(&'static str, f64)],
    /// The largest relative difference; 0 means to rounding.
    pub tolerance: f64,
}

/// A surface in the space of directions across which the gradient jumps.
#[derive(Clone, Copy, Debug)]
pub struct Seam {
    pub doc: &'static str,
    /// Zero on the seam.
    pub zero: fn(Vec3<f64>, Vec3<f64>) -> f64,
}
