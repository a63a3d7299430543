//! What the tests of models share: parameters by name, directions by angle, random numbers, conditions.

#![allow(dead_code)] // each test file uses a part of it

use lesk_bsdf::model::Domain;
use lesk_bsdf::params::{ParamSpec, defaults, offset_of};
use lesk_bsdf::scatter::Methods;
use lesk_bsdf::{Scatter, registry};
use lesk_math::{Vec3, vec3};

/// The model with this id.
pub fn model(id: &str) -> &'static dyn Scatter {
    registry::find(id).unwrap_or_else(|| panic!("no model `{id}`"))
}

/// The functions in `f64`.
pub fn reference(model: &dyn Scatter) -> &'static Methods<f64> {
    model.forms().reference.expect("every model of the registry has a reference")
}

/// The flat table of defaults with some values replaced; a colour becomes grey.
pub fn table(model: &dyn Scatter, values: &[(&str, f64)]) -> Vec<f64> {
    let mut params = defaults(model.specs());
    for &(name, value) in values {
        let at = offset_of(model.specs(), name).unwrap_or_else(|| panic!("`{}` has no `{name}`", model.id()));
        let spec = model.specs().iter().find(|spec| spec.name == name).expect("found above");
        params[at..at + spec.len()].fill(value);
    }
    params
}

/// The unit direction at these angles in degrees.
pub fn direction(theta_deg: f64, phi_deg: f64) -> Vec3<f64> {
    Vec3::from_spherical(theta_deg.to_radians(), phi_deg.to_radians())
}

/// Reproducible random numbers (Knuth's linear congruential generator, upper bits).
pub struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Random {
        Random(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) ^ 0x5DEE_CE66)
    }
    /// In [0, 1).
    pub fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }
    pub fn within(&mut self, lo: f64, hi: f64) -> f64 {
        lo + (hi - lo) * self.unit()
    }
    pub fn index(&mut self, n: usize) -> usize {
        (self.unit() * n as f64) as usize
    }
    /// In [0, 1), as `f32`.
    pub fn unit3_f32(&mut self) -> [f32; 3] {
        [0; 3].map(|_| (self.unit() as f32).min(1.0 - f32::EPSILON / 2.0))
    }
    /// A direction of the domain at least `floor` (a cosine) from the horizon, uniform in solid angle.
    pub fn direction(&mut self, domain: Domain, floor: f64) -> Vec3<f64> {
        let z = self.within(floor, 1.0);
        let side = if domain != Domain::Upper && self.unit() < 0.5 { -1.0 } else { 1.0 };
        let (sin, cos) = self.within(0.0, std::f64::consts::TAU).sin_cos();
        let r = (1.0 - z * z).sqrt();
        vec3(r * cos, r * sin, side * z)
    }
    /// A direction near the horizon: the cosine is uniform in the logarithm from 2e-6 to 0.1.
    pub fn grazing(&mut self, domain: Domain) -> Vec3<f64> {
        let w = self.direction(domain, 0.0);
        let z = 2e-6 * 5e4f64.powf(self.unit());
        let scale = (1.0 - z * z).sqrt() / (w.x * w.x + w.y * w.y).sqrt();
        vec3(w.x * scale, w.y * scale, z.copysign(w.z))
    }
    /// Legal parameters: each uniform, or uniform in the logarithm where the scale is.
    pub fn params(&mut self, specs: &[ParamSpec]) -> Vec<f64> {
        specs.iter().flat_map(|spec| (0..spec.len()).map(|_| self.value(spec)).collect::<Vec<_>>()).collect()
    }
    fn value(&mut self, spec: &ParamSpec) -> f64 {
        let [lo, hi] = spec.range;
        if spec.log {
            // ranges of a logarithmic scale may start at 0
            let lo = lo.max(1e-3 * hi);
            return lo * (hi / lo).powf(self.unit());
        }
        self.within(lo, hi)
    }
}

/// The nearest `f32` of each entry, and that number in `f64`.
pub fn rounded(params: &[f64]) -> (Vec<f32>, Vec<f64>) {
    let narrow = narrow(params);
    let wide = narrow.iter().map(|&p| f64::from(p)).collect();
    (narrow, wide)
}

/// Conditions of a function of parameters and directions: how much each output moves, absolutely, when every input
/// moves by its own size times 1, to first order and with all signs against us. Central differences in `f64`.
pub fn condition<const N: usize>(
    f: impl Fn(&[f64], Vec3<f64>, Vec3<f64>) -> [f64; N],
    params: &[f64],
    wi: Vec3<f64>,
    wo: Vec3<f64>,
) -> [f64; N] {
    const STEP: f64 = 1e-6;
    let at = |input: &[f64]| {
        let (params, directions) = input.split_at(params.len());
        f(params, Vec3::from([directions[0], directions[1], directions[2]]), {
            Vec3::from([directions[3], directions[4], directions[5]])
        })
    };
    let mut input: Vec<f64> = params.to_vec();
    input.extend(wi.to_array());
    input.extend(wo.to_array());
    let mut sum = [0.0; N];
    for i in 0..input.len() {
        let x = input[i];
        input[i] = x * (1.0 + STEP);
        let above = at(&input);
        input[i] = x * (1.0 - STEP);
        let below = at(&input);
        input[i] = x;
        for c in 0..N {
            sum[c] += (above[c] - below[c]).abs() / (2.0 * STEP);
        }
    }
    sum
}

/// The (first) entry of a parameter.
pub fn value_of(model: &dyn Scatter, params: &[f64], name: &str) -> f64 {
    params[offset_of(model.specs(), name).unwrap_or_else(|| panic!("`{}` has no `{name}`", model.id()))]
}

/// A flat table in `f32`.
pub fn narrow(params: &[f64]) -> Vec<f32> {
    params.iter().map(|&p| p as f32).collect()
}
