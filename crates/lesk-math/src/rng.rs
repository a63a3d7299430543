//! Random numbers without state: Philox4x32-10, a function of key and counter (Salmon, Moraes, Dror & Shaw, *Parallel
//! Random Numbers: As Easy as 1, 2, 3*, SC 2011), and the conversion of bits to numbers in [0, 1).

/// Four random words for each counter, different for each key. Equal arguments give equal words on every machine.
#[inline]
pub fn philox(mut counter: [u32; 4], mut key: [u32; 2]) -> [u32; 4] {
    for _ in 0..10 {
        let (high0, low0) = wide_product(0xD251_1F53, counter[0]);
        let (high1, low1) = wide_product(0xCD9E_8D57, counter[2]);
        counter = [high1 ^ counter[1] ^ key[0], low1, high0 ^ counter[3] ^ key[1], low0];
        // Weyl sequences: the golden ratio and sqrt(3) - 1
        key = [key[0].wrapping_add(0x9E37_79B9), key[1].wrapping_add(0xBB67_AE85)];
    }
    counter
}

/// High and low word of `a * b`.
#[inline(always)]
fn wide_product(a: u32, b: u32) -> (u32, u32) {
    let product = u64::from(a) * u64::from(b);
    ((product >> 32) as u32, product as u32)
}

/// The stream of random numbers of one sample of one pixel.
///
/// ```
/// use lesk_math::rng::Stream;
/// let mut stream = Stream::new(7, 100, 3);
/// let (a, b) = (stream.next_f32(), stream.next_f32());
/// assert_eq!([a, b], [Stream::new(7, 100, 3).at(0), Stream::new(7, 100, 3).at(1)].map(lesk_math::rng::unit_f32));
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Stream {
    key: [u32; 2],
    pixel: u32,
    sample: u32,
    dimension: u32,
    block: [u32; 4],
}

impl Stream {
    /// The stream of `sample` of `pixel`; streams of different arguments are independent.
    #[inline]
    pub fn new(seed: u64, pixel: u32, sample: u32) -> Stream {
        Stream { key: [seed as u32, (seed >> 32) as u32], pixel, sample, dimension: 0, block: [0; 4] }
    }

    /// The word of number `dimension`, wherever the stream stands.
    #[inline]
    pub fn at(&self, dimension: u32) -> u32 {
        self.block_at(dimension / 4)[(dimension % 4) as usize]
    }

    #[inline]
    fn block_at(&self, block: u32) -> [u32; 4] {
        philox([block, self.sample, self.pixel, 0], self.key)
    }

    /// The next word; after 2^32 words the stream repeats.
    #[inline]
    pub fn next_u32(&mut self) -> u32 {
        let lane = (self.dimension % 4) as usize;
        if lane == 0 {
            self.block = self.block_at(self.dimension / 4);
        }
        self.dimension = self.dimension.wrapping_add(1);
        self.block[lane]
    }

    /// The next number in [0, 1).
    #[inline]
    pub fn next_f32(&mut self) -> f32 {
        unit_f32(self.next_u32())
    }

    /// The next number in [0, 1), from two words.
    #[inline]
    pub fn next_f64(&mut self) -> f64 {
        unit_f64(u64::from(self.next_u32()) << 32 | u64::from(self.next_u32()))
    }
}

/// The upper 24 bits as a number in [0, 1 - 2^-24].
#[inline(always)]
pub fn unit_f32(bits: u32) -> f32 {
    (bits >> 8) as f32 * (1.0 / (1 << 24) as f32)
}

/// The upper 53 bits as a number in [0, 1 - 2^-53].
#[inline(always)]
pub fn unit_f64(bits: u64) -> f64 {
    (bits >> 11) as f64 * (1.0 / (1u64 << 53) as f64)
}

/// A bijection of 64-bit words in which each input bit flips each output bit about half of the time (the finalizer of
/// SplitMix64; constants by D. Stafford, *Better Bit Mixing*, 2011, variant 13).
#[inline(always)]
pub const fn mix64(mut x: u64) -> u64 {
    x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}
