//! The polynomials against `libm` in `f64`, in units in the last place of the `f32` result, once with a separate
//! multiplication and addition and once with fused ones.

use lesk_math::{Lane, Real, poly};

/// A lane whose `fma` rounds once; without the target feature that is slow, but right.
fn fused(x: f32) -> Lane<true> {
    Lane(x)
}

/// Spacing of `f32` at the size of `x`.
fn ulp(x: f64) -> f64 {
    let exponent = x.abs().max(f64::from(f32::MIN_POSITIVE)).log2().floor();
    (exponent - 23.0).exp2()
}

/// Every `stride`-th `f32` of [lo, hi], both ends and everything within 2^12 steps of the `critical` numbers.
/// The stride is odd, so that all patterns of low bits occur.
fn numbers(lo: f32, hi: f32, stride: usize, critical: &[f32]) -> impl Iterator<Item = f32> {
    let (first, last) = (ordinal(lo), ordinal(hi));
    let near: Vec<i32> = critical
        .iter()
        .flat_map(|&c| ordinal(c) - 4096..=ordinal(c) + 4096)
        .filter(move |k| (first..=last).contains(k))
        .collect();
    (first..=last).step_by(stride).chain([last]).chain(near).map(number)
}

/// Position of `x` in the ascending list of all `f32`.
fn ordinal(x: f32) -> i32 {
    let bits = x.to_bits() as i32;
    if bits < 0 { i32::MIN - bits } else { bits }
}

fn number(ordinal: i32) -> f32 {
    f32::from_bits(if ordinal < 0 { i32::MIN - ordinal } else { ordinal } as u32)
}

/// The largest error over `xs`, where it occurs, for both kinds of arithmetic.
struct Worst {
    error: f64,
    at: f32,
}

impl Worst {
    fn of(xs: impl Iterator<Item = f32>, f: impl Fn(f32) -> f32, truth: fn(f64) -> f64, unit: fn(f64) -> f64) -> Worst {
        let mut worst = Worst { error: 0.0, at: 0.0 };
        for x in xs {
            let want = truth(f64::from(x));
            let error = (f64::from(f(x)) - want).abs() / unit(want);
            if error > worst.error || error.is_nan() {
                worst = Worst { error, at: x };
            }
        }
        worst
    }
}

macro_rules! error_bound {
    ($test:ident, $f:ident, $truth:expr, $lo:expr, $hi:expr, $stride:expr, $critical:expr, $unit:expr, $bound:expr) => {
        #[test]
        fn $test() {
            let xs = || numbers($lo, $hi, $stride, &$critical);
            let plain = Worst::of(xs(), poly::$f::<f32>, $truth, $unit);
            let fused = Worst::of(xs(), |x| poly::$f(fused(x)).0, $truth, $unit);
            for (kind, worst) in [("separate", plain), ("fused", fused)] {
                println!("{} {kind}: {:.3e} at {:e}", stringify!($test), worst.error, worst.at);
                assert!(worst.error <= $bound, "{kind}: error {} at {:e}", worst.error, worst.at);
            }
        }
    };
}

const TINY: f32 = f32::MIN_POSITIVE;
const LAST_BELOW_1: f32 = 0.99999994;
const PI: f32 = core::f32::consts::PI;
fn absolute(_: f64) -> f64 {
    1.0
}

// the bounds are the largest errors over every 17th number, with 5 to 15 % on top for those between; see the module documentation
error_bound!(exp2_is_within_1_2_ulp, exp2, libm::exp2, -126.0, 127.5, 601, [0.0, 0.5, -0.5, 1.0], ulp, 1.2);
error_bound!(exp2_is_within_101_ulp_up_to_overflow, exp2, libm::exp2, 127.5, 127.999, 1, [], ulp, 101.0);
error_bound!(exp_is_within_1_2_ulp, exp, libm::exp, -87.336, 88.37, 601, [0.0, 0.3466, -0.3466], ulp, 1.2);
error_bound!(
    log2_is_within_2_1_ulp,
    log2,
    libm::log2,
    TINY,
    f32::MAX,
    601,
    [TINY, 0.5, core::f32::consts::FRAC_1_SQRT_2, 1.0, core::f32::consts::SQRT_2],
    ulp,
    2.1
);
error_bound!(
    log2_1p_is_within_2_4_ulp,
    log2_1p,
    |x| libm::log1p(x) * core::f64::consts::LOG2_E,
    0.0,
    f32::MAX,
    601,
    [TINY, 1e-7, core::f32::consts::SQRT_2 - 1.0, 1.0],
    ulp,
    2.4
);
error_bound!(
    sin_is_within_2_2_ulp_for_two_turns,
    sin,
    libm::sin,
    -12.6,
    12.6,
    601,
    [0.0, PI, 2.0 * PI, 3.0 * PI, 0.5 * PI],
    ulp,
    2.2
);
error_bound!(
    cos_is_within_2_2_ulp_for_two_turns,
    cos,
    libm::cos,
    -12.6,
    12.6,
    601,
    [0.0, 0.5 * PI, 1.5 * PI, 2.5 * PI, 3.5 * PI],
    ulp,
    2.2
);
error_bound!(sin_is_within_1_4e_7_up_to_1e5, sin, libm::sin, -1e5, 1e5, 601, [1e5], absolute, 1.4e-7);
error_bound!(cos_is_within_1_4e_7_up_to_1e5, cos, libm::cos, -1e5, 1e5, 601, [1e5], absolute, 1.4e-7);
error_bound!(acos_is_within_2_8_ulp, acos, libm::acos, -1.0, 1.0, 601, [-1.0, 0.0, 0.5, 1.0], ulp, 2.8);
error_bound!(erf_is_within_9_ulp, erf, libm::erf, -5.0, 5.0, 601, [0.0, 0.5, 1.0, 3.92], ulp, 9.0);
error_bound!(
    erf_inv_is_within_5_ulp,
    erf_inv,
    poly::erf_inv_f64,
    -LAST_BELOW_1,
    LAST_BELOW_1,
    6001,
    [0.0, 0.5, 1.0],
    ulp,
    5.0
);

/// Points on all rays of slope 2^-30 to 2^30 at radii 2^-100 to 2^100, and on the axes.
fn plane() -> impl Iterator<Item = (f32, f32)> {
    let parts = |k: u32| {
        let h = k.wrapping_mul(0x9e37_79b9) ^ (k.wrapping_mul(0x85eb_ca6b) >> 13);
        let fraction = 1.0 + (h >> 8) as f32 / (1 << 24) as f32;
        let slope = ((h % 61) as f32 - 30.0).exp2() * fraction;
        let radius = ((k % 201) as f32 - 100.0).exp2();
        let (x, y) = if h & 64 == 0 { (radius, radius * slope) } else { (radius * slope, radius) };
        (if h & 128 == 0 { x } else { -x }, if h & 256 == 0 { y } else { -y })
    };
    let axes = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0), (1.0, 1.0), (-1.0, -1.0)];
    (0..4_000_000).map(parts).chain(axes)
}

#[test]
fn atan2_is_within_3_ulp() {
    for (kind, f) in [
        ("separate", (|y, x| poly::atan2(y, x)) as fn(f32, f32) -> f32),
        ("fused", |y, x| poly::atan2(fused(y), fused(x)).0),
    ] {
        let mut worst = (0.0, (0.0, 0.0));
        for (x, y) in plane() {
            let want = libm::atan2(f64::from(y), f64::from(x));
            let error = (f64::from(f(y, x)) - want).abs() / ulp(want);
            if error > worst.0 || error.is_nan() {
                worst = (error, (x, y));
            }
        }
        println!("atan2 {kind}: {:.3} at {:?}", worst.0, worst.1);
        assert!(worst.0 <= 3.0, "{kind}: error {} at {:?}", worst.0, worst.1);
    }
}

/// The exponent e = y log2 x is off by at most 2.1 ulp of the logarithm and half an ulp of the product, each at most
/// 2^-23 of e; that is multiplied by ln 2 and counted in ulps of at least 2^-24: ln 2 * 2.6 * 2 |e| = 3.6 |e|.
/// The rounding of x alone makes |y| / 2, so more digits of the logarithm would be lost on most arguments.
#[test]
fn pow_is_within_3_6_ulp_for_each_power_of_two() {
    let mut worst = 0.0_f64;
    for k in 0..4_000_000_u32 {
        // a low-discrepancy set (golden ratio, square root of 2) of exponents and of bases near to and far from 1
        let u = f64::from(k.wrapping_mul(0x9e37_79b9)) / 4294967296.0 * 2.0 - 1.0;
        let v = f64::from(k.wrapping_mul(0x6a09_e667)) / 4294967296.0 * 2.0 - 1.0;
        let x = libm::exp2(16.0 * v * v * v) as f32;
        let y = (126.0 * u / libm::log2(f64::from(x))) as f32;
        let exponent = libm::log2(f64::from(x)) * f64::from(y);
        if exponent.is_nan() || exponent.abs() > 126.0 {
            continue;
        }
        let want = libm::pow(f64::from(x), f64::from(y));
        for got in [Real::pow(x, y), fused(x).pow(Lane(y)).0] {
            let error = (f64::from(got) - want).abs() / ulp(want);
            worst = worst.max((error - 1.2) / exponent.abs());
            assert!(error <= 1.2 + 3.6 * exponent.abs(), "{x:e}^{y:e}: {error}");
        }
    }
    println!("pow: 1.2 + {worst:.3} |exponent|");
}

#[test]
fn atan2_takes_minus_zero_for_zero() {
    let half_turn = core::f32::consts::PI;
    assert_eq!(poly::atan2(-0.0_f32, -1.0), half_turn);
    assert_eq!(poly::atan2(-0.0_f32, 1.0), 0.0);
    assert_eq!(poly::atan2(-0.0_f32, -0.0), 0.0);
    assert_eq!(poly::atan2(0.0_f32, 0.0), 0.0);
    assert!((poly::atan2(f32::MAX, f32::MAX) - half_turn / 4.0).abs() <= 2.0 * 2.0_f32.powi(-24));
}

#[test]
fn simple_arguments_give_exact_results() {
    for n in -126..=127 {
        let power = f32::from_bits(((n + 127) << 23) as u32);
        assert_eq!(poly::exp2(n as f32), power);
        assert_eq!(poly::log2(power), n as f32);
    }
    assert_eq!(poly::exp(0.0_f32), 1.0);
    assert_eq!(poly::sin(0.0_f32), 0.0);
    assert_eq!(poly::cos(0.0_f32), 1.0);
    assert_eq!(poly::acos(1.0_f32), 0.0);
    assert_eq!(poly::acos(0.0_f32), core::f32::consts::FRAC_PI_2);
    assert_eq!(poly::acos(-1.0_f32), core::f32::consts::PI);
    assert_eq!(poly::erf(0.0_f32), 0.0);
    assert_eq!(poly::erf_inv(0.0_f32), 0.0);
}

#[test]
fn exp2_and_exp_end_in_zero_and_infinity() {
    let below = f32::from_bits((-126.0_f32).to_bits() + 1);
    assert_eq!(poly::exp2(below), 0.0);
    assert_eq!(poly::exp2(-126.0_f32), TINY);
    for x in [-1e30, f32::MIN, f32::NEG_INFINITY] {
        assert_eq!(poly::exp2(x), 0.0, "{x}");
        assert_eq!(poly::exp(x), 0.0, "{x}");
    }
    for x in [128.01, 1e30, f32::MAX, f32::INFINITY] {
        assert_eq!(poly::exp2(x), f32::INFINITY, "{x}");
        assert_eq!(poly::exp(x), f32::INFINITY, "{x}");
    }
    assert!(poly::exp2(f32::NAN).is_nan());
    assert!(poly::exp(f32::NAN).is_nan());
}

#[test]
fn log2_is_finite_for_every_f32() {
    for x in numbers(0.0, TINY, 61, &[]).filter(|&x| x < TINY) {
        assert!((-127.0..=-126.0).contains(&poly::log2(x)), "{x:e}");
    }
    assert_eq!(poly::log2(f32::INFINITY), 128.0);
    for x in [-1.0, -0.0, f32::NEG_INFINITY, f32::NAN] {
        assert!(poly::log2(x).is_finite(), "{x}");
    }
}

#[test]
fn bounded_functions_stay_within_their_bounds() {
    for x in numbers(-1e5, 1e5, 601, &[]) {
        assert!(poly::sin(x).abs() <= 1.0, "sin {x:e}");
        assert!(poly::cos(x).abs() <= 1.0, "cos {x:e}");
    }
    for x in numbers(f32::NEG_INFINITY, f32::INFINITY, 601, &[]) {
        assert!(poly::erf(x).abs() <= 1.0, "erf {x:e}");
        // 3.8325: erf_inv(1 - 2^-24) = 3.8325...
        assert!(poly::erf_inv(x.clamp(-1.0, 1.0)).abs() < 3.84, "erf_inv {x:e}");
    }
    for x in numbers(-1.0, 1.0, 601, &[]) {
        assert!((0.0..=PI).contains(&poly::acos(x)), "acos {x:e}");
    }
}

#[test]
fn functions_of_nan_are_nan_or_documented() {
    let nan = f32::NAN;
    assert!(poly::sin(nan).is_nan() && poly::cos(nan).is_nan() && poly::acos(nan).is_nan());
    assert!(poly::erf(nan).is_nan() && poly::erf_inv(nan).is_nan() && poly::atan2(nan, 1.0).is_nan());
    assert!(poly::acos(1.0000001_f32).is_nan());
}

#[test]
fn erf_inv_f64_undoes_erf() {
    for k in 1..20_000 {
        let t = f64::from(k) * 2.9e-4;
        let x = libm::erf(t);
        // erf loses what the spacing of x cannot carry: dt = spacing / (2/sqrt(pi) exp(-t^2))
        let lost = f64::EPSILON * x / (core::f64::consts::FRAC_2_SQRT_PI * (-t * t).exp());
        let error = (poly::erf_inv_f64(x) - t).abs();
        assert!(error <= 2.0 * lost + 4.0 * f64::EPSILON * t, "{t}: {error:e}");
        assert_eq!(poly::erf_inv_f64(-x), -poly::erf_inv_f64(x));
    }
    assert_eq!(poly::erf_inv_f64(0.0), 0.0);
    assert_eq!(poly::erf_inv_f64(1.0), f64::INFINITY);
    assert!(poly::erf_inv_f64(1.1).is_nan());
}

#[test]
fn erf_inv_f64_agrees_with_mpmath() {
    // mpmath 1.4.1, mp.dps = 40: erfinv(mpf(x)) for the f64 x
    for (x, want) in ERF_INV {
        let error = (poly::erf_inv_f64(x) / want - 1.0).abs();
        assert!(error <= 4.0 * f64::EPSILON, "{x:e}: {error:e}");
    }
}

const ERF_INV: [(f64, f64); 15] = [
    (1e-300, 8.86226925452758e-301),
    (1e-20, 8.86226925452758e-21),
    (1e-05, 8.862269254759594e-06),
    (0.1, 0.08885599049425769),
    (0.3, 0.2724627147267543),
    (0.4999999, 0.4769361649459939),
    (0.5, 0.4769362762044699),
    (0.7, 0.7328690779592167),
    (0.9, 1.1630871536766743),
    (0.99, 1.8213863677184494),
    (0.999, 2.3267537655135246),
    (0.999999, 3.458910737275499),
    (0.9999999403953552, 3.832506856900711),
    (0.9999999999, 4.572824958544925),
    (0.9999999999999999, 5.8635847487551676),
];
