//! The Sobol sampler: the plain sequence against published points, the scrambled one against the properties that
//! Owen scrambling keeps or adds.

use lesk_math::rng::Stream;
use lesk_math::sobol::{Sampler, sobol};

#[test]
fn plain_points_are_those_of_joe_and_kuo() {
    // SciPy 1.17.1, qmc.Sobol(4, scramble=False, bits=32).random(16): Joe & Kuo's numbers in Gray code order
    let published = [
        [0.0, 0.0, 0.0, 0.0],
        [0.5, 0.5, 0.5, 0.5],
        [0.75, 0.25, 0.25, 0.25],
        [0.25, 0.75, 0.75, 0.75],
        [0.375, 0.375, 0.625, 0.875],
        [0.875, 0.875, 0.125, 0.375],
        [0.625, 0.125, 0.875, 0.625],
        [0.125, 0.625, 0.375, 0.125],
        [0.1875, 0.3125, 0.9375, 0.4375],
        [0.6875, 0.8125, 0.4375, 0.9375],
        [0.9375, 0.0625, 0.6875, 0.1875],
        [0.4375, 0.5625, 0.1875, 0.6875],
        [0.3125, 0.1875, 0.3125, 0.5625],
        [0.8125, 0.6875, 0.8125, 0.0625],
        [0.5625, 0.4375, 0.0625, 0.8125],
        [0.0625, 0.9375, 0.5625, 0.3125],
    ];
    for (k, want) in (0..).zip(published) {
        let gray = k ^ (k >> 1);
        assert_eq!(sobol(gray).map(|bits| f64::from(bits) / 2.0_f64.powi(32)), want);
    }
}

#[test]
fn plain_points_with_high_index_are_those_of_joe_and_kuo() {
    // SciPy 1.17.1, the same after fast_forward(k): points k = 2^n, which use every column of the matrices
    for (k, want) in FAR {
        assert_eq!(sobol(k ^ (k >> 1)), want);
    }
}

/// The points of one draw of 2^m samples from an aligned block.
fn block<T>(pixel: u32, m: u32, block: u32, draw: impl Fn(&mut Sampler) -> T) -> Vec<T> {
    let mut sampler = Sampler::new(3);
    (0..1 << m)
        .map(|k| {
            sampler.start(pixel, (block << m) + k);
            draw(&mut sampler)
        })
        .collect()
}

#[test]
fn two_dimensional_draws_are_nets() {
    let draws: [fn(&mut Sampler) -> [f32; 2]; 3] = [
        |s| s.next2d(),
        |s| {
            s.next1d();
            s.next2d();
            s.next2d()
        },
        |s| s.next4d()[..2].try_into().expect("two of four"),
    ];
    for (m, number) in [(1, 0), (4, 0), (4, 5), (9, 0), (10, 3)] {
        for (pixel, draw) in [0, 1, 4711].into_iter().flat_map(|p| draws.map(|d| (p, d))) {
            let points = block(pixel, m, number, draw);
            for a in 0..=m {
                assert_eq!(cells_hit(&points, a, m - a), 1 << m, "2^-{a} by 2^-{}, pixel {pixel}", m - a);
            }
        }
    }
}

/// How many cells of the grid of 2^a by 2^b contain a point.
fn cells_hit(points: &[[f32; 2]], a: u32, b: u32) -> usize {
    let cell = |u: f32, bits: u32| (u * (1 << bits) as f32) as usize;
    let mut hit = vec![false; 1 << (a + b)];
    for p in points {
        hit[cell(p[0], a) << b | cell(p[1], b)] = true;
    }
    hit.into_iter().filter(|&h| h).count()
}

#[test]
fn each_coordinate_of_four_is_stratified() {
    for m in [3, 8, 12] {
        let points = block(9, m, 1, |s| s.next4d());
        for d in 0..4 {
            let line: Vec<_> = points.iter().map(|p| [p[d], 0.0]).collect();
            assert_eq!(cells_hit(&line, m, 0), 1 << m);
        }
    }
}

#[test]
fn three_numbers_are_the_first_of_four() {
    let (mut a, mut b) = (Sampler::new(8), Sampler::new(8));
    for sample in 0..10 {
        a.start(5, sample);
        b.start(5, sample);
        assert_eq!(a.next3d()[..], b.next4d()[..3]);
    }
}

#[test]
fn numbers_lie_in_the_unit_interval_and_repeat_with_the_seed() {
    let draw = |seed, pixel, sample| {
        let mut sampler = Sampler::new(seed);
        sampler.start(pixel, sample);
        let four = sampler.next4d();
        [sampler.next1d(), four[0], four[1], four[2], four[3]]
    };
    for k in 0..10_000_u32 {
        let (seed, pixel, sample) = (k % 7, k.wrapping_mul(2_654_435_761), k.wrapping_mul(40_503));
        let numbers = draw(seed, pixel, sample);
        assert!(numbers.iter().all(|u| (0.0..1.0).contains(u)), "{numbers:?}");
        assert_eq!(numbers, draw(seed, pixel, sample));
        assert_ne!(numbers, draw(seed + 1, pixel, sample));
    }
}

/// Correlation of two lists of numbers.
fn correlation(a: &[f32], b: &[f32]) -> f64 {
    let mean = |x: &[f32]| x.iter().map(|&v| f64::from(v)).sum::<f64>() / x.len() as f64;
    let (ma, mb) = (mean(a), mean(b));
    let product = |x: &[f32], mx: f64, y: &[f32], my: f64| -> f64 {
        x.iter().zip(y).map(|(&u, &v)| (f64::from(u) - mx) * (f64::from(v) - my)).sum()
    };
    product(a, ma, b, mb) / (product(a, ma, a, ma) * product(b, mb, b, mb)).sqrt()
}

#[test]
fn neighbours_are_not_correlated() {
    let n = 1 << 14;
    let at = |pixel: u32, sample: u32, skip: u32, seed: u32| {
        let mut sampler = Sampler::new(seed);
        sampler.start(pixel, sample);
        (0..skip).for_each(|_| _ = sampler.next1d());
        sampler.next2d()
    };
    let over = |f: &dyn Fn(u32) -> f32| -> Vec<f32> { (0..n).map(f).collect() };
    let here = over(&|k| at(k, 0, 0, 1)[0]);
    let others = [
        ("pixel", over(&|k| at(k + 1, 0, 0, 1)[0])),
        ("row", over(&|k| at(k + 1920, 0, 0, 1)[0])),
        ("draw", over(&|k| at(k, 0, 1, 1)[0])),
        ("dimension", over(&|k| at(k, 0, 0, 1)[1])),
        ("seed", over(&|k| at(k, 0, 0, 2)[0])),
    ];
    for (what, other) in others {
        // five standard deviations of the correlation of independent numbers
        let r = correlation(&here, &other);
        assert!(r.abs() < 5.0 / f64::from(n).sqrt(), "{what}: {r}");
    }
    let along = |draw: u32| over(&|k| at(7, k, draw, 1)[0]);
    let r = correlation(&along(0), &along(1));
    assert!(r.abs() < 5.0 / f64::from(n).sqrt(), "draws of one pixel: {r}");
}

/// Variance over 256 pixels of the estimate of the integral of `f` with `n` samples.
fn variance(n: u32, f: fn([f32; 2]) -> f64) -> f64 {
    let estimates: Vec<f64> = (0..256)
        .map(|pixel| block(pixel, n.ilog2(), 0, |s| f(s.next2d())).iter().sum::<f64>() / f64::from(n))
        .collect();
    let mean = estimates.iter().sum::<f64>() / 256.0;
    estimates.iter().map(|e| (e - mean) * (e - mean)).sum::<f64>() / 255.0
}

#[test]
fn variance_of_a_smooth_integrand_falls_faster_than_that_of_random_numbers() {
    let smooth = |u: [f32; 2]| f64::from(u[0] * u[0] * (1.0 + u[1])).exp();
    // Owen 1997: n^-3 (log n) for smooth integrands, so 16 times the samples make 1/4096; random numbers make 1/16
    let ratio = variance(1024, smooth) / variance(64, smooth);
    assert!(ratio < 16.0 / 4096.0, "{ratio}");
}

#[test]
fn the_mean_over_scramblings_is_the_integral() {
    // integral of x^2 y = 1/6; the first sample alone, which without scrambling would be the origin
    let n = 1 << 16;
    let sum: f64 = (0..n)
        .map(|pixel| {
            let mut sampler = Sampler::new(0);
            sampler.start(pixel, 0);
            let [x, y] = sampler.next2d().map(f64::from);
            x * x * y
        })
        .sum();
    // variance of x^2 y: 1/15 - 1/36; five standard deviations of the mean
    let sigma = ((1.0 / 15.0 - 1.0 / 36.0) / f64::from(n)).sqrt();
    assert!((sum / f64::from(n) - 1.0 / 6.0).abs() < 5.0 * sigma);
}

#[test]
fn sobol_beats_independent_numbers_on_an_edge() {
    // indicator of a disc: quasi-Monte Carlo gains n^-3/2 instead of n^-1; at 256 samples at least a factor of four
    let disc = |u: [f32; 2]| if u[0] * u[0] + u[1] * u[1] < 1.0 { 1.0 } else { 0.0 };
    let random: Vec<f64> = (0..256)
        .map(|pixel| {
            let mut stream = Stream::new(0, pixel, 0);
            (0..256).map(|_| disc([stream.next_f32(), stream.next_f32()])).sum::<f64>() / 256.0
        })
        .collect();
    let mean = random.iter().sum::<f64>() / 256.0;
    let of_random = random.iter().map(|e| (e - mean) * (e - mean)).sum::<f64>() / 255.0;
    assert!(variance(256, disc) < of_random / 4.0);
}

const FAR: [(u32, [u32; 4]); 10] = [
    (1 << 4, [0x18000000, 0x78000000, 0x78000000, 0xa8000000]),
    (1 << 7, [0x03000000, 0x55000000, 0x4b000000, 0x31000000]),
    (1 << 10, [0x00600000, 0x60600000, 0x72a00000, 0x7ca00000]),
    (1 << 13, [0x000c0000, 0x44440000, 0x40f40000, 0xcc040000]),
    (1 << 16, [0x00018000, 0x7fff8000, 0x78d58000, 0xe38a8000]),
    (1 << 19, [0x00003000, 0x50005000, 0x4bf0f000, 0x8e331000]),
    (1 << 21, [0x00000c00, 0x44004400, 0xf4f4b400, 0x31cbdc00]),
    (1 << 24, [0x00000180, 0x7f807f80, 0xd5552d80, 0x7d5b6d80]),
    (1 << 27, [0x00000030, 0x50505050, 0xf0004bf0, 0xcf300070]),
    (1 << 30, [0x00000006, 0x66666666, 0xd2007272, 0xe00e00d6]),
];
