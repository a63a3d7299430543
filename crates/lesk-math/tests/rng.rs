//! Philox against the known answers of its authors, and the streams made from it.

use lesk_math::rng::{Stream, mix64, philox, unit_f32, unit_f64};

#[test]
fn philox4x32_10_gives_the_known_answers_of_random123() {
    // Random123 1.14.0, tests/kat_vectors: counter, key, answer; the third one counts through the digits of pi
    let known = [
        ([0; 4], [0; 2], [0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8]),
        ([u32::MAX; 4], [u32::MAX; 2], [0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd]),
        (
            [0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344],
            [0xa4093822, 0x299f31d0],
            [0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1],
        ),
    ];
    for (counter, key, answer) in known {
        assert_eq!(philox(counter, key), answer);
    }
}

#[test]
fn a_stream_reads_its_words_in_order() {
    let mut stream = Stream::new(0x1234_5678_9abc_def0, 17, 4);
    let fixed = stream;
    for dimension in 0..100 {
        assert_eq!(stream.next_u32(), fixed.at(dimension));
    }
}

#[test]
fn streams_of_neighbours_share_no_word() {
    let words = |seed, pixel, sample| (0..64).map(move |d| Stream::new(seed, pixel, sample).at(d));
    let mut all: Vec<u32> = words(1, 0, 0)
        .chain(words(2, 0, 0))
        .chain(words(1 << 32, 0, 0))
        .chain(words(1, 1, 0))
        .chain(words(1, 0, 1))
        .collect();
    let count = all.len();
    all.sort_unstable();
    all.dedup();
    // 320 words out of 2^32 coincide with probability 320^2 / 2^33 = 1e-5
    assert_eq!(all.len(), count);
}

#[test]
fn uniform_numbers_never_reach_one() {
    assert_eq!(unit_f32(u32::MAX), 1.0 - f32::EPSILON / 2.0);
    assert_eq!(unit_f64(u64::MAX), 1.0 - f64::EPSILON / 2.0);
    assert_eq!((unit_f32(0), unit_f64(0)), (0.0, 0.0));
    assert_eq!((unit_f32(1 << 31), unit_f64(1 << 63)), (0.5, 0.5));
}

#[test]
fn uniform_numbers_have_the_moments_of_the_uniform_distribution() {
    let n = 1_000_000;
    let mut stream = Stream::new(5, 0, 0);
    let (mut first, mut second) = (0.0, 0.0);
    for _ in 0..n {
        let (a, b) = (f64::from(stream.next_f32()) - 0.5, stream.next_f64() - 0.5);
        first += a + b;
        second += a * b;
    }
    // five standard deviations: of the sum of 2n numbers sqrt(2n / 12), of the sum of n products sqrt(n) / 12
    assert!(first.abs() < 5.0 * (f64::from(n) / 6.0).sqrt(), "{first}");
    assert!(second.abs() < 5.0 * f64::from(n).sqrt() / 12.0, "{second}");
}

#[test]
fn mix64_gives_the_numbers_of_splitmix64() {
    // the first numbers of SplittableRandom(0): Java 8, and the C version of S. Vigna (splitmix64.c)
    let golden = 0x9e37_79b9_7f4a_7c15_u64;
    let numbers = [1, 2, 3].map(|k| mix64(golden.wrapping_mul(k)));
    assert_eq!(numbers, [0xe220a8397b1dcdaf, 0x6e789e6aa1b965f4, 0x06c45d188009454f]);
}
