//! Random numbers of the checks: a function of name, index and counter, so that every run sees the same ones.

use lesk_math::rng::Stream;

/// A stream of numbers that depends on nothing but its name and index.
#[derive(Clone, Debug)]
pub struct Random(Stream);

impl Random {
    /// The stream of a name (a model and a check) and an index within it.
    pub fn new(name: &str, index: u32) -> Random {
        // FNV-1a
        let hash = |h: u64, b: u8| (h ^ u64::from(b)).wrapping_mul(0x0000_0100_0000_01b3);
        Random(Stream::new(name.bytes().fold(0xcbf2_9ce4_8422_2325, hash), index, 0))
    }

    /// A number in [0, 1).
    pub fn unit(&mut self) -> f64 {
        self.0.next_f64()
    }

    /// Three numbers in [0, 1).
    pub fn unit3(&mut self) -> [f64; 3] {
        [self.unit(), self.unit(), self.unit()]
    }

    /// A number in [`lo`, `hi`).
    pub fn within(&mut self, lo: f64, hi: f64) -> f64 {
        lo + (hi - lo) * self.unit()
    }

    /// Whether an event of this probability happens.
    pub fn chance(&mut self, probability: f64) -> bool {
        self.unit() < probability
    }

    /// An index below `n`; 0 for `n` = 0.
    pub fn index(&mut self, n: usize) -> usize {
        ((self.unit() * n as f64) as usize).min(n.saturating_sub(1))
    }
}
