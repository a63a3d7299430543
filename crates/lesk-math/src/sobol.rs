//! Sobol points with hash-based Owen scrambling (Burley, *Practical Hash-based Owen Scrambling*, JCGT 9(4), 2020).
//!
//! The first four Sobol dimensions make one set. Every draw takes a set of its own: the same points, in an order and
//! with a scrambling that are hashed from the seed, the pixel and the number of the draw ("padding"). So any number of
//! dimensions costs the same, and the first two numbers of every draw are a (0, m, 2)-net in base 2: of any aligned block
//! of 2^m samples, exactly one falls into each rectangle 2^-a by 2^-(m-a).

use crate::rng::{mix64, unit_f32};

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
        self.pixel_seed = mix64(u64::from(self.seed) << 32 | u64::from(pixel));
        self.reversed_index = sample.reverse_bits();
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
        let [x, y] = scrambled([index, reversed_second(index)], hash);
        let [z, w] = scrambled(reversed_third_and_fourth(index), mix64(hash));
        [x, y, z, w]
    }

    /// The index of the point that this sample takes in the next draw, and a hash of the draw.
    #[inline(always)]
    fn next_set(&mut self) -> (u32, u64) {
        self.draw = self.draw.wrapping_add(GOLDEN);
        let hash = mix64(self.pixel_seed.wrapping_add(self.draw));
        (reversed_owen(self.reversed_index, hash as u32).reverse_bits(), mix64(hash))
    }
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
    let [third, fourth] = reversed_third_and_fourth(index);
    [index, reversed_second(index), third, fourth].map(u32::reverse_bits)
}

/// The second coordinate, bits reversed: bit j is the sum mod 2 of C(k, j) over the bits k of the index, and C(k, j) is
/// odd where the bits of k contain those of j (Lucas), so that five butterfly steps do.
#[inline(always)]
fn reversed_second(mut x: u32) -> u32 {
    x ^= (x >> 1) & 0x5555_5555;
    x ^= (x >> 2) & 0x3333_3333;
    x ^= (x >> 4) & 0x0f0f_0f0f;
    x ^= (x >> 8) & 0x00ff_00ff;
    x ^ (x >> 16)
}

/// The third and fourth coordinate, bits reversed.
#[inline(always)]
fn reversed_third_and_fourth(index: u32) -> [u32; 2] {
    let mut sum = [0, 0];
    for (nibble, table) in NIBBLES.iter().enumerate() {
        let entry = table[(index >> (4 * nibble) & 15) as usize];
        sum = [sum[0] ^ entry[0], sum[1] ^ entry[1]];
    }
    sum
}

/// The sums of direction numbers for every value of every nibble of the index.
static NIBBLES: [[[u32; 2]; 16]; 8] = {
    let columns = [direction_numbers(2, 1, [1, 3, 0]), direction_numbers(3, 1, [1, 3, 1])];
    let mut table = [[[0; 2]; 16]; 8];
    let mut k = 0;
    while k < 8 * 16 * 2 * 4 {
        let (nibble, value, dimension, bit) = (k / 128, k / 8 % 16, k / 4 % 2, k % 4);
        if value >> bit & 1 == 1 {
            table[nibble][value][dimension] ^= columns[dimension][4 * nibble + bit].reverse_bits();
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
