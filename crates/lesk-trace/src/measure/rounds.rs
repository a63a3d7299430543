//! Rounds of samples, until every reading has the wished error.

use super::receiver::{Meter, Start};
use super::{REPLICATES, Reading, Settings};
use crate::render::End;
use crate::wave::{WAVE, Wave};
use lesk_math::sobol::Sampler;
use lesk_scene::Scene;
use lesk_scene::sensor::Probe;
use rayon::prelude::*;
use std::ops::ControlFlow;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::Instant;

/// Samples of each sequence in the first round, in all 512.
const FIRST: u32 = 16;
/// Samples of each sequence after which a reading of 0 counts as dark.
const DARK: u32 = 1024;
/// Sequences per task of a round: a reading is 32.
const SEQUENCES_PER_TASK: usize = 8;

/// Readings that are worked on at once.
pub(super) struct Batch<'a> {
    scene: &'a Scene,
    settings: &'a Settings,
    meters: Vec<State>,
    /// Number of the first reading: decides the random numbers.
    first: u32,
    start: Instant,
}

/// A reading in the making.
struct State {
    meter: Meter,
    /// Sums of direct and other light per sequence.
    sums: [[f64; 2]; REPLICATES],
    /// Samples per sequence.
    count: u32,
    finished: bool,
}

impl<'a> Batch<'a> {
    pub fn new(scene: &'a Scene, settings: &'a Settings, probes: &[Probe], first: u32, start: Instant) -> Self {
        let state = |probe: &Probe| State {
            meter: Meter::new(scene, probe),
            sums: [[0.0; 2]; REPLICATES],
            count: 0,
            finished: false,
        };
        Batch { scene, settings, meters: probes.par_iter().map(state).collect(), first, start }
    }

    /// Samples until all readings are finished. `observe` gets the share of the work that is done and the number of
    /// finished readings.
    pub fn run<F>(&mut self, mut observe: F) -> End
    where
        F: FnMut(f64, usize) -> ControlFlow<()> + Send,
    {
        let most = (self.settings.max_samples / REPLICATES as u64).clamp(FIRST.into(), 1 << 30) as u32;
        loop {
            let active: Vec<usize> = (0..self.meters.len()).filter(|&i| !self.meters[i].finished).collect();
            if active.is_empty() {
                return End::Done;
            }
            let (stop, late) = (AtomicBool::new(false), AtomicBool::new(false));
            let sums = self.round(&active, most, &stop, &late, &mut observe);
            for (&i, new) in active.iter().zip(sums.chunks(REPLICATES)) {
                // a reading counts a round wholly or not at all
                let Some(new) = new.iter().copied().collect::<Option<Vec<_>>>() else { continue };
                let state = &mut self.meters[i];
                state.sums.iter_mut().zip(new).for_each(|(sum, new)| *sum = [sum[0] + new[0], sum[1] + new[1]]);
                state.count = next_count(state.count, most);
                state.finished = state.reached(self.settings.error) || state.count >= most;
            }
            if stop.load(Ordering::Relaxed) {
                return End::Stopped;
            }
            if late.load(Ordering::Relaxed) {
                return End::OutOfTime;
            }
        }
    }

    /// The sums that one round adds to every sequence of the active readings; `None` for what was not done.
    fn round<F>(
        &self,
        active: &[usize],
        most: u32,
        stop: &AtomicBool,
        late: &AtomicBool,
        observe: &mut F,
    ) -> Vec<Option<[f64; 2]>>
    where
        F: FnMut(f64, usize) -> ControlFlow<()> + Send,
    {
        let (before, work) = self.share(active, most);
        let finished = self.meters.len() - active.len();
        let (done, observe) = (AtomicU64::new(0), Mutex::new(observe));
        let tasks: Vec<(usize, usize)> = active.iter().flat_map(|&i| (0..REPLICATES).map(move |k| (i, k))).collect();
        let mut sums = vec![None; tasks.len()];
        sums.par_chunks_mut(SEQUENCES_PER_TASK).zip(tasks.par_chunks(SEQUENCES_PER_TASK)).for_each(|(sums, tasks)| {
            if self.settings.time.is_some_and(|limit| self.start.elapsed() >= limit) {
                late.store(true, Ordering::Relaxed);
            }
            if stop.load(Ordering::Relaxed) || late.load(Ordering::Relaxed) {
                return;
            }
            for (sum, new) in sums.iter_mut().zip(self.sequences(tasks, most)) {
                *sum = Some(new);
            }
            let done = done.fetch_add(tasks.len() as u64, Ordering::Relaxed) + tasks.len() as u64;
            let share = before + work * done as f64 / (active.len() * REPLICATES) as f64;
            // who finds another thread there has nothing newer to tell
            if let Ok(mut observe) = observe.try_lock()
                && observe(share.min(1.0), finished).is_break()
            {
                stop.store(true, Ordering::Relaxed);
            }
        });
        sums
    }

    /// The share of all work that is done, and the share of the coming round, both estimated from the errors so far.
    fn share(&self, active: &[usize], most: u32) -> (f64, f64) {
        let (mut done, mut total, mut round) = (0.0, 0.0, 0.0);
        for state in &self.meters {
            let count = f64::from(state.count);
            done += count;
            total += if state.finished { count } else { state.expected(self.settings.error, most) };
        }
        for &i in active {
            let count = self.meters[i].count;
            round += f64::from(next_count(count, most) - count);
        }
        (done / total, round / total)
    }

    /// What one round adds to some sequences, each given by its reading and its number there. Their samples share waves:
    /// in the first rounds a sequence has only a few.
    fn sequences(&self, sequences: &[(usize, usize)], most: u32) -> Vec<[f64; 2]> {
        let seed = self.settings.seed;
        let mut sampler = Sampler::new((seed ^ (seed >> 32).wrapping_mul(0x9e37_79b9)) as u32);
        let mut wave = Wave::new(self.scene, self.settings.limits());
        let indices = |&(i, _): &(usize, usize)| {
            let count = self.meters[i].count;
            count..next_count(count, most)
        };
        let mut samples =
            sequences.iter().enumerate().flat_map(|(s, of)| indices(of).map(move |index| (s, index))).peekable();
        let mut sums = vec![[0.0; 2]; sequences.len()];
        while samples.peek().is_some() {
            let mut start = |(s, index): (usize, u32)| {
                let (i, k) = sequences[s];
                let number = (self.first + i as u32).wrapping_mul(REPLICATES as u32) + k as u32;
                sampler.start(number, index + first_index(k));
                (s, self.meters[i].meter.start(&mut wave, sampler))
            };
            let starts: Vec<(usize, Start)> = samples.by_ref().take(WAVE).map(&mut start).collect();
            let found = wave.follow();
            for (s, start) in starts {
                let [direct, other] = start.light(found);
                sums[s] = [sums[s][0] + direct, sums[s][1] + other];
            }
        }
        sums
    }

    pub fn readings(&self) -> impl Iterator<Item = Reading> + '_ {
        self.meters.iter().map(State::reading)
    }
}

/// Where in the Sobol sequence sequence `k` begins. Whole blocks from the beginning would hold equally many points on
/// either side of a fraction like p = 3/32, in every scrambling alike: a scatter of 0 around a wrong value.
fn first_index(k: usize) -> u32 {
    (k as u32).wrapping_mul(0x9e37_79b9) >> 8
}

/// Samples per sequence after the next round: 16, 32, 48, 64, 96, 128, 192, ...: whole blocks of the Sobol sequence.
fn next_count(count: u32, most: u32) -> u32 {
    let next = match count {
        0 => FIRST,
        FIRST => 2 * FIRST,
        _ if count.is_power_of_two() => count + count / 2,
        _ => count.next_power_of_two(),
    };
    next.min(most)
}

impl State {
    fn reading(&self) -> Reading {
        if self.count == 0 {
            return Reading::default();
        }
        let n = f64::from(self.count);
        let means = self.sums.map(|[direct, other]| [direct / n, other / n]);
        let (value, standard_error) = mean_and_error(means.map(|[direct, other]| direct + other));
        let (indirect, indirect_error) = mean_and_error(means.map(|[_, other]| other));
        let (direct, _) = mean_and_error(means.map(|[direct, _]| direct));
        let samples = u64::from(self.count) * REPLICATES as u64;
        Reading { value, standard_error, direct, indirect, indirect_error, samples }
    }

    fn reached(&self, error: f64) -> bool {
        let reading = self.reading();
        if reading.value == 0.0 {
            return self.count >= DARK;
        }
        reading.standard_error <= error * reading.value
    }

    /// Samples per sequence that it will need, as if the variance fell with their number.
    fn expected(&self, error: f64, most: u32) -> f64 {
        let reading = self.reading();
        let (count, next) = (f64::from(self.count), f64::from(next_count(self.count, most)));
        if reading.value <= 0.0 {
            return next;
        }
        let relative = reading.standard_error / reading.value / error;
        (count * relative * relative).clamp(next, most.into())
    }
}

fn mean_and_error(means: [f64; REPLICATES]) -> (f64, f64) {
    let n = REPLICATES as f64;
    let mean = means.iter().sum::<f64>() / n;
    let square: f64 = means.iter().map(|m| (m - mean) * (m - mean)).sum();
    (mean, (square / (n * (n - 1.0))).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounds_end_on_halves_and_wholes_of_powers_of_two() {
        let mut counts = vec![0];
        while *counts.last().unwrap() < 300 {
            counts.push(next_count(*counts.last().unwrap(), 300));
        }
        assert_eq!(counts, [0, 16, 32, 48, 64, 96, 128, 192, 256, 300]);
    }

    #[test]
    fn error_is_that_of_the_mean_of_independent_sequences() {
        // 0 and 2 in turn: variance 32/31, of the mean 1/31
        let (mean, error) = mean_and_error(std::array::from_fn(|k| 2.0 * (k % 2) as f64));
        assert_eq!(mean, 1.0);
        assert!((error - (1.0f64 / 31.0).sqrt()).abs() < 1e-15);
    }
}
