//! Random legal parameters, inside or outside a condition.

use crate::condition::Condition;
use crate::random::Random;
use lesk_bsdf::params::{Kind, ParamSpec};
use lesk_math::CHANNELS;

/// The legal parameters of a model, all of them or those on one side of a condition.
pub struct Region {
    specs: &'static [ParamSpec],
    condition: Option<Condition>,
    outside: bool,
}

/// Draws until this many have missed the condition.
const ATTEMPTS: usize = 10_000;

impl Region {
    /// All legal parameters.
    pub fn all(specs: &'static [ParamSpec]) -> Region {
        Region { specs, condition: None, outside: false }
    }

    /// Those that fulfil the condition.
    pub fn inside(specs: &'static [ParamSpec], condition: Condition) -> Region {
        Region { specs, condition: Some(condition), outside: false }
    }

    /// Those that do not.
    pub fn outside(specs: &'static [ParamSpec], condition: Condition) -> Region {
        Region { specs, condition: Some(condition), outside: true }
    }

    /// Whether the table lies in the region; its values must be legal.
    pub fn contains(&self, params: &[f64]) -> bool {
        self.condition.as_ref().is_none_or(|condition| condition.holds(params) != self.outside)
    }

    /// Parameters of the region: ends of the ranges and defaults more often than chance would have them, and, where
    /// the condition is an inequality, its border. None where 10,000 attempts find none.
    pub fn draw(&self, rng: &mut Random) -> Option<Vec<f64>> {
        let mut other: Option<Vec<f64>> = None;
        for _ in 0..ATTEMPTS {
            let mut params = any(self.specs, rng);
            if self.settle(&mut params) {
                return Some(match other {
                    Some(other) if rng.chance(0.25) => self.towards(params, &other),
                    _ => params,
                });
            }
            other = Some(params);
        }
        None
    }

    /// Parameters of the region near the given ones, moved by up to `scale` of each range; the given ones where
    /// that is not possible.
    pub fn near(&self, params: &[f64], rng: &mut Random, scale: f64) -> Vec<f64> {
        for _ in 0..16 {
            let mut moved = params.to_vec();
            let (grey, mut at) = (rng.chance(0.5), 0);
            for spec in self.specs {
                let step = if rng.chance(0.6) { rng.within(-scale, scale) } else { 0.0 };
                for entry in &mut moved[at..at + spec.len()] {
                    let own = if grey { step } else { step * rng.unit() };
                    *entry = from_unit(spec, (to_unit(spec, *entry) + own).clamp(0.0, 1.0));
                }
                at += spec.len();
            }
            if self.settle(&mut moved) {
                return moved;
            }
        }
        params.to_vec()
    }

    /// The parameters on the other side of `centre`, clamped to the legal ranges.
    pub fn mirrored(&self, params: &[f64], centre: &[f64]) -> Vec<f64> {
        let ranges = self.specs.iter().flat_map(|spec| vec![spec.range; spec.len()]);
        let entries = params.iter().zip(centre).zip(ranges);
        entries.map(|((p, c), [lo, hi])| (2.0 * c - p).clamp(lo, hi)).collect()
    }

    /// Moves the table into the region by its equations, if need be; whether it lies there.
    fn settle(&self, params: &mut [f64]) -> bool {
        match &self.condition {
            Some(condition) if !self.outside && condition.has_equation() => condition.solve(self.specs, params),
            _ => self.contains(params),
        }
    }

    /// The last point of the region on the way from a point in it to one that is not.
    fn towards(&self, inside: Vec<f64>, outside: &[f64]) -> Vec<f64> {
        let between = |t: f64| -> Vec<f64> {
            inside.iter().zip(outside).map(|(a, b)| (a + (b - a) * t).clamp(a.min(*b), a.max(*b))).collect()
        };
        let (mut lo, mut hi) = (0.0, 1.0);
        for _ in 0..60 {
            let middle = 0.5 * (lo + hi);
            if self.contains(&between(middle)) { lo = middle } else { hi = middle }
        }
        if lo > 0.0 { between(lo) } else { inside }
    }
}

/// Legal parameters, condition or not.
fn any(specs: &[ParamSpec], rng: &mut Random) -> Vec<f64> {
    let mut params = Vec::new();
    for spec in specs {
        let first = entry(spec, 0, rng);
        params.push(first);
        if spec.kind == Kind::Color {
            let grey = rng.chance(0.5);
            params.extend((1..CHANNELS).map(|c| if grey { first } else { entry(spec, c, rng) }));
        }
    }
    params
}

fn entry(spec: &ParamSpec, channel: usize, rng: &mut Random) -> f64 {
    match rng.unit() {
        t if t < 0.12 => spec.range[0],
        t if t < 0.24 => spec.range[1],
        t if t < 0.32 => spec.default_of(channel),
        t if t < 0.50 => rng.within(spec.slider[0], spec.slider[1]).clamp(spec.range[0], spec.range[1]),
        _ => from_unit(spec, rng.unit()),
    }
}

fn is_log(spec: &ParamSpec) -> bool {
    spec.log && spec.range[0] > 0.0
}

/// The place of a legal value between the ends of its range, 0 to 1.
fn to_unit(spec: &ParamSpec, value: f64) -> f64 {
    let [lo, hi] = spec.range;
    if lo == hi {
        return 0.0;
    }
    if is_log(spec) { (value / lo).ln() / (hi / lo).ln() } else { (value - lo) / (hi - lo) }
}

fn from_unit(spec: &ParamSpec, t: f64) -> f64 {
    let [lo, hi] = spec.range;
    let value = if is_log(spec) { lo * (hi / lo).powf(t) } else { lo + (hi - lo) * t };
    value.clamp(lo, hi)
}
