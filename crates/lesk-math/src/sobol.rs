//! Sobol points with hash-based Owen scrambling (Burley, *Practical Hash-based Owen Scrambling*, JCGT 9(4), 2020).
//!
//! The first four Sobol dimensions make one set. Every draw takes a set of its own: the same points, in an order and
//! with a scrambling that are hashed from the seed, the pixel and the number of the draw ("padding"). So any number of
//! dimensions costs the same, and the first two numbers of every draw are a (0, m, 2)-net in base 2: of any aligned block
//! of 2^m samples, exactly one falls into each rectangle 2^-a by 2^-(m-a). That holds up to m = 16: each 65,536 samples of
//! a pixel are scrambled anew, so that points need 16 bits of their index only.

use crate::rng::{mix64, unit_f32};
use crate::{Isa, for_isa};

/// The numbers of one sample of one pixel, drawn in order.
///
/// ```
/// use lesk_math::sobol::Sampler;
/// let mut sampler = Sampler::new(1);
/// sampler.start(1920 * 20 + 10, 0);
/// let [x, y] = sampler.next2d();
/// assert!((0.0..1.0).contains(&x) && (0.0..1.0).contains(&y));
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Sampler {
    seed: u32,
    pixel_seed: u64,
    /// The lower 16 bits of the sample number, reversed.
    reversed_index: u32,
    draw: u64,
}

impl Sampler {
    /// A sampler at pixel 0, sample 0. Pictures of different seeds are independent.
    #[inline]
    pub fn new(seed: u32) -> Sampler {
        let mut sampler = Sampler { seed, pixel_seed: 0, reversed_index: 0, draw: 0 };
        sampler.start(0, 0);
        sampler
    }

    /// Goes to the first draw of a sample of a pixel.
    #[inline]
    pub fn start(&mut self, pixel: u32, sample: u32) {
        let pixel_seed = mix64(u64::from(self.seed) << 32 | u64::from(pixel));
        self.pixel_seed = mix64(pixel_seed ^ u64::from(sample >> 16));
        self.reversed_index = sample.reverse_bits() >> 16;
        self.draw = 0;
    }

    /// One number in [0, 1).
    #[inline]
    pub fn next1d(&mut self) -> f32 {
        let (index, hash) = self.next_set();
        unit_f32(reversed_owen(index, (hash >> 32) as u32).reverse_bits())
    }

    /// Two numbers in [0, 1), jointly stratified.
    #[inline]
    pub fn next2d(&mut self) -> [f32; 2] {
        let (index, hash) = self.next_set();
        scrambled([index, reversed_second(index)], hash)
    }

    /// Three numbers in [0, 1), jointly stratified.
    #[inline]
    pub fn next3d(&mut self) -> [f32; 3] {
        let [x, y, z, _] = self.next4d();
        [x, y, z]
    }

    /// Four numbers in [0, 1), jointly stratified.
    #[inline]
    pub fn next4d(&mut self) -> [f32; 4] {
        let (index, hash) = self.next_set();
        four(index, hash)
    }

    /// What `N` samplers each give by `D` calls of [`next4d`](Self::next4d): number `k` of draw `d` for sampler `i` is at
    /// `[d][k][i]`.
    ///
    /// # Panics
    /// If this processor lacks `isa`.
    pub fn next4d_all<const D: usize, const N: usize>(samplers: &mut [Sampler; N], isa: Isa) -> [[[f32; N]; 4]; D] {
        let mut out = [[[0.0; N]; 4]; D];
        let mut state = State { pixel_seed: [0; N], reversed_index: [0; N], draw: [0; N] };
        for (i, sampler) in samplers.iter_mut().enumerate() {
            (state.pixel_seed[i], state.reversed_index[i]) = (sampler.pixel_seed, sampler.reversed_index);
            state.draw[i] = sampler.draw;
            sampler.draw = sampler.draw.wrapping_add(GOLDEN.wrapping_mul(D as u64));
        }
        draws(isa, &state, &mut out);
        out
    }

    /// The index of the point that this sample takes in the next draw, and a hash of the draw.
    #[inline(always)]
    fn next_set(&mut self) -> (u32, u64) {
        self.draw = self.draw.wrapping_add(GOLDEN);
        set(self.pixel_seed, self.reversed_index, self.draw)
    }
}

/// Samplers side by side.
struct State<const N: usize> {
    pixel_seed: [u64; N],
    reversed_index: [u32; N],
    draw: [u64; N],
}

impl<const N: usize> State<N> {
    /// Without branches, so that the loop is vectorised.
    #[inline(always)]
    fn draws<const D: usize>(&self, out: &mut [[[f32; N]; 4]; D]) {
        for d in 0..D {
            for i in 0..N {
                let draw = self.draw[i].wrapping_add(GOLDEN.wrapping_mul(d as u64 + 1));
                let (index, hash) = set(self.pixel_seed[i], self.reversed_index[i], draw);
                let u = four(index, hash);
                for k in 0..4 {
                    out[d][k][i] = u[k];
                }
            }
        }
    }
}

/// [`State::draws`] compiled for an instruction set.
fn draws<const D: usize, const N: usize>(isa: Isa, state: &State<N>, out: &mut [[[f32; N]; 4]; D]) {
    for_isa!(isa, State::draws, [const D: usize, const N: usize], state: &State<N>, out: &mut [[[f32; N]; 4]; D]);
}

/// The index of the point that a sample takes in a draw, and a hash of the draw.
#[inline(always)]
fn set(pixel_seed: u64, reversed_index: u32, draw: u64) -> (u32, u64) {
    let hash = mix64(pixel_seed.wrapping_add(draw));
    (reversed_owen(reversed_index, hash as u32).reverse_bits() >> 16, mix64(hash))
}

/// Four coordinates of a point.
#[inline(always)]
fn four(index: u32, hash: u64) -> [f32; 4] {
    let [x, y] = scrambled([index, reversed_second(index)], hash);
    let [z, w] = scrambled(reversed_third_and_fourth(index), mix64(hash));
    [x, y, z, w]
}

/// 2^64 over the golden ratio, the step between draws (Steele, Lea & Flood, *Fast Splittable Pseudorandom Number
/// Generators*, 2014).
const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;

/// Two coordinates, given with reversed bits, scrambled with the two halves of `hash`, as numbers in [0, 1).
#[inline(always)]
fn scrambled(reversed: [u32; 2], hash: u64) -> [f32; 2] {
    let x = reversed_owen(reversed[0], (hash >> 32) as u32);
    let y = reversed_owen(reversed[1], hash as u32);
    // one reversal of 64 bits instead of two of 32
    let both = (u64::from(y) << 32 | u64::from(x)).reverse_bits();
    [unit_f32((both >> 32) as u32), unit_f32(both as u32)]
}

/// Owen scrambling of a number whose bits are reversed: each bit flips as a hash of the bits below it says. The Laine-
/// Karras hash with the constants of N. Vegdahl, *Building a Better LK Hash*, 2021; it needs a well-mixed seed.
#[inline(always)]
fn reversed_owen(mut x: u32, seed: u32) -> u32 {
    x ^= x.wrapping_mul(0x3d20_adea);
    x = x.wrapping_add(seed);
    x = x.wrapping_mul((seed >> 16) | 1);
    x ^= x.wrapping_mul(0x0552_6c56);
    x ^ x.wrapping_mul(0x53a2_2864)
}

/// The point of number `index` of the Sobol sequence in its first four dimensions, as binary fractions of 32 bits, with the
/// direction numbers of Joe & Kuo, *Constructing Sobol Sequences with Better Two-Dimensional Projections*, 2008.
pub fn sobol(index: u32) -> [u32; 4] {
    let bits = || (0..32).filter(|bit| index >> bit & 1 == 1);
    let [third, fourth] = COLUMNS.map(|column| bits().fold(0, |sum, bit| sum ^ column[bit]));
    // bit j of the second is the sum mod 2 of C(k, j) over the bits k of the index: the lower half, then the upper
    let (low, high) = (reversed_second(index & 0xffff), reversed_second(index >> 16));
    let second = (low ^ high) | high << 16;
    [index.reverse_bits(), second.reverse_bits(), third, fourth]
}

/// The second coordinate of a point of number below 2^16, bits reversed: bit j is the sum mod 2 of C(k, j) over the bits k
/// of the index, and C(k, j) is odd where the bits of k contain those of j (Lucas), so that four butterfly steps do.
#[inline(always)]
fn reversed_second(mut x: u32) -> u32 {
    x ^= (x >> 1) & 0x5555;
    x ^= (x >> 2) & 0x3333;
    x ^= (x >> 4) & 0x0f0f;
    x ^ (x >> 8)
}

/// The third and fourth coordinate of a point of number below 2^16, bits reversed.
#[inline(always)]
fn reversed_third_and_fourth(index: u32) -> [u32; 2] {
    let mut both = 0;
    for (nibble, table) in NIBBLES.iter().enumerate() {
        both ^= table[(index >> (4 * nibble) & 15) as usize];
    }
    [both & 0xffff, both >> 16]
}

/// Direction numbers of the third and fourth dimension.
const COLUMNS: [[u32; 32]; 2] = [direction_numbers(2, 1, [1, 3, 0]), direction_numbers(3, 1, [1, 3, 1])];

/// The sums of direction numbers for every value of every nibble of a 16-bit index: the third dimension, bits reversed,
/// in the lower half, the fourth in the upper.
static NIBBLES: [[u32; 16]; 4] = {
    let mut table = [[0; 16]; 4];
    let mut k = 0;
    while k < 4 * 16 * 4 {
        let (nibble, value, bit) = (k / 64, k / 4 % 16, k % 4);
        if value >> bit & 1 == 1 {
            let column = 4 * nibble + bit;
            table[nibble][value] ^= COLUMNS[0][column].reverse_bits() | COLUMNS[1][column].reverse_bits() << 16;
        }
        k += 1;
    }
    table
};

/// Direction numbers from a primitive polynomial of the given degree, its inner coefficients `a`, and the first values
/// `m`, in the notation of Joe & Kuo.
const fn direction_numbers(degree: usize, a: u32, m: [u32; 3]) -> [u32; 32] {
    let mut v = [0; 32];
    let mut k = 0;
    while k < 32 {
        if k < degree {
            v[k] = m[k] << (31 - k);
        } else {
            v[k] = v[k - degree] ^ (v[k - degree] >> degree);
            let mut j = 1;
            while j < degree {
                if a >> (degree - 1 - j) & 1 == 1 {
                    v[k] ^= v[k - j];
                }
                j += 1;
            }
        }
        k += 1;
    }
    v
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samplers_side_by_side_give_what_each_gives_alone() {
        for isa in Isa::ALL.into_iter().filter(|isa| isa.is_available()) {
            let mut samplers: [Sampler; 16] = std::array::from_fn(|i| {
                let mut sampler = Sampler::new(7);
                sampler.start(31 * i as u32, 70_000 * i as u32);
                (0..i).for_each(|_| sampler.draw = sampler.draw.wrapping_add(GOLDEN));
                sampler
            });
            let mut alone = samplers;
            for _ in 0..3 {
                let u = Sampler::next4d_all::<2, 16>(&mut samplers, isa);
                for (d, draw) in u.iter().enumerate() {
                    for (i, sampler) in alone.iter_mut().enumerate() {
                        assert_eq!(
                            sampler.next4d(),
                            std::array::from_fn(|k| draw[k][i]),
                            "draw {d}, sampler {i}, {isa:?}"
                        );
                    }
                }
            }
        }
    }

    #[test]
    fn short_points_are_the_first_ones_of_the_sequence() {
        for index in 0..1 << 16 {
            let [third, fourth] = reversed_third_and_fourth(index);
            let short = [index, reversed_second(index), third, fourth].map(u32::reverse_bits);
            assert_eq!(short, sobol(index));
        }
    }
}
