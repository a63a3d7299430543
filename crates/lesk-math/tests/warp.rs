//! Each warp: `invert` undoes `sample`, `pdf` integrates to one, and samples are distributed as `pdf` says.

use lesk_math::rng::Stream;
use lesk_math::warp::*;
use lesk_math::{Real, Vec3, vec3};
use proptest::prelude::*;
use std::f64::consts::PI;

/// Largest distance between two pairs of uniform numbers; the second of a pair may be periodic.
fn distance<R: Real + Into<f64>>(u: [R; 2], v: [R; 2], periodic: bool) -> f64 {
    let [du, dv] = [0, 1].map(|k| (u[k].into() - v[k].into()).abs());
    du.max(if periodic { dv.min(1.0 - dv) } else { dv })
}

/// The spacing of numbers above 1.
trait Spacing: Real + Into<f64> {
    const EPS: f64;
}
impl Spacing for f64 {
    const EPS: f64 = f64::EPSILON;
}
impl Spacing for f32 {
    const EPS: f64 = f32::EPSILON as f64;
}

/// Every warp there and back, within a dozen roundings of numbers up to 1: functions of 3 ulp, products, one division.
fn there_and_back<R: Spacing>(u: [R; 2], versine: R, n: R) {
    let close = |what: &str, v: [R; 2], periodic: bool, condition: f64| {
        let d = distance(u, v, periodic);
        let given: [f64; 2] = u.map(Into::into);
        assert!(d <= 12.0 * condition * R::EPS, "{what} at {given:?}: {d:e}");
    };
    close("disk", disk::invert(disk::sample(u)), false, 1.0);
    close("cosine hemisphere", cosine_hemisphere::invert(cosine_hemisphere::sample(u)), false, 1.0);
    close("uniform hemisphere", uniform_hemisphere::invert(uniform_hemisphere::sample(u)), false, 1.0);
    close("uniform sphere", uniform_sphere::invert(uniform_sphere::sample(u)), true, 1.0);
    close("uniform cone", uniform_cone::invert(versine, uniform_cone::sample(versine, u)), true, 1.0);
    close("triangle", triangle::invert(triangle::sample(u)), false, 1.0);
    // the n + 1 st power of a rounded cosine
    let condition = 1.0 + n.into();
    close("power cosine", power_cosine::invert(n, power_cosine::sample(n, u)), true, condition);
    close("tent", [tent::invert(tent::sample(u[0])), u[1]], false, 1.0);
    close("exponential", [exponential::invert(n, exponential::sample(n, u[0])), u[1]], false, 1.0);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4096))]

    #[test]
    fn invert_undoes_sample_in_f64(u in 0.0..1.0_f64, v in 0.0..1.0_f64, log_versine in -30.0..0.69_f64, n in 0.01..1e4_f64) {
        there_and_back([u, v], log_versine.exp(), n);
    }

    #[test]
    fn invert_undoes_sample_in_f32(u in 0.0..1.0_f32, v in 0.0..1.0_f32, log_versine in -30.0..0.69_f32, n in 0.01..1e3_f32) {
        there_and_back([u, v], Real::exp(log_versine), n);
    }

    #[test]
    fn sampled_directions_are_unit_vectors_of_positive_density(u in 0.0..1.0_f32, v in 0.0..1.0_f32, n in 0.0..1e4_f32) {
        let u = [u, v];
        let narrow = 1e-9;
        let directions = [
            (cosine_hemisphere::sample(u), cosine_hemisphere::pdf(cosine_hemisphere::sample(u))),
            (uniform_hemisphere::sample(u), uniform_hemisphere::pdf(uniform_hemisphere::sample(u))),
            (uniform_sphere::sample(u), uniform_sphere::pdf(uniform_sphere::sample(u))),
            (uniform_cone::sample(narrow, u), uniform_cone::pdf(narrow, uniform_cone::sample(narrow, u))),
            (uniform_cone::sample(2.0, u), uniform_cone::pdf(2.0, uniform_cone::sample(2.0, u))),
        ];
        for (w, pdf) in directions {
            prop_assert!((w.length() - 1.0).abs() <= 6.0 * f32::EPSILON, "{w:?}");
            prop_assert!(pdf > 0.0 && pdf.is_finite(), "{w:?}: {pdf}");
        }
        prop_assert!((power_cosine::sample(n, u).length() - 1.0).abs() <= 6.0 * f32::EPSILON);
        prop_assert!(disk::pdf(disk::sample(u)) > 0.0 && triangle::pdf(triangle::sample(u)) > 0.0);
    }
}

#[test]
fn corners_and_centre_of_the_square_give_finite_samples() {
    let last = 1.0 - f32::EPSILON / 2.0;
    for u in [[0.0, 0.0], [0.0, last], [last, 0.0], [last, last], [0.5, 0.5], [0.5, 0.0], [0.0, 0.5]] {
        there_and_back(u, 2.0, 5.0);
        assert!(power_cosine::sample(0.0, u).to_array().iter().all(|x| x.is_finite()), "{u:?}");
        assert!(exponential::sample(1.0, u[0]).is_finite(), "{u:?}");
    }
    assert_eq!(disk::sample([0.5, 0.5]), [0.0, 0.0]);
}

#[test]
fn densities_vanish_off_their_shape() {
    let down = vec3(0.0, 0.6, -0.8);
    assert_eq!(cosine_hemisphere::pdf(down), 0.0);
    assert_eq!(uniform_hemisphere::pdf(down), 0.0);
    assert_eq!(power_cosine::pdf(3.0, down), 0.0);
    assert_eq!(uniform_cone::pdf(0.1, vec3(0.6, 0.0, 0.8)), 0.0);
    assert_eq!(disk::pdf([0.8, 0.8]), 0.0);
    assert_eq!(triangle::pdf([0.7, 0.5, -0.2]), 0.0);
    assert_eq!((tent::pdf(-1.5), exponential::pdf(2.0, -0.1)), (0.0, 0.0));
}

#[test]
fn a_cone_of_a_milliarcsecond_keeps_its_shape_in_f32() {
    // half angle 4.8e-9 rad: versine = angle^2 / 2; uniform in area, so half of the samples lie within angle / sqrt 2
    let angle = 4.8e-9_f64;
    let versine = (angle * angle / 2.0) as f32;
    let w = uniform_cone::sample(versine, [0.5, 0.0]);
    assert!((f64::from(w.x) / (angle / 2.0_f64.sqrt()) - 1.0).abs() < 8.0 * f64::from(f32::EPSILON));
    // 1/(2 pi versine)
    let want = 1.0 / (PI * angle * angle);
    assert!((f64::from(uniform_cone::pdf(versine, w)) / want - 1.0).abs() < 8.0 * f64::from(f32::EPSILON));
}

/// A warp onto directions: name, lowest z, density, sample.
type Directions = (&'static str, f64, Box<dyn Fn(Vec3<f64>) -> f64>, Box<dyn Fn([f64; 2]) -> Vec3<f64>>);

fn directions() -> Vec<Directions> {
    let mut all: Vec<Directions> = vec![
        ("cosine hemisphere", 0.0, Box::new(cosine_hemisphere::pdf), Box::new(cosine_hemisphere::sample)),
        ("uniform hemisphere", 0.0, Box::new(uniform_hemisphere::pdf), Box::new(uniform_hemisphere::sample)),
        ("uniform sphere", -1.0, Box::new(uniform_sphere::pdf), Box::new(uniform_sphere::sample)),
    ];
    for versine in [1e-6, 0.3, 2.0] {
        let (pdf, sample) = (move |w| uniform_cone::pdf(versine, w), move |u| uniform_cone::sample(versine, u));
        all.push(("cone", 1.0 - versine, Box::new(pdf), Box::new(sample)));
    }
    for n in [0.0, 0.7, 20.0] {
        let (pdf, sample) = (move |w| power_cosine::pdf(n, w), move |u| power_cosine::sample(n, u));
        all.push(("power cosine", 0.0, Box::new(pdf), Box::new(sample)));
    }
    all
}

/// Integral of `f` over directions with z and azimuth in the given ranges, by the midpoint rule with `n` by `n` points.
fn integral(f: &dyn Fn(Vec3<f64>) -> f64, z: [f64; 2], phi: [f64; 2], n: usize) -> f64 {
    let at = |[lo, hi]: [f64; 2], k: usize| lo + (hi - lo) * (k as f64 + 0.5) / n as f64;
    let mut sum = 0.0;
    for k in 0..n * n {
        let (z, phi) = (at(z, k / n), at(phi, k % n));
        let r = (1.0 - z * z).sqrt();
        sum += f(vec3(r * phi.cos(), r * phi.sin(), z));
    }
    sum * (z[1] - z[0]) * (phi[1] - phi[0]) / (n * n) as f64
}

#[test]
fn densities_of_directions_integrate_to_one() {
    for (name, z, pdf, _) in directions() {
        // midpoint rule: its error is n (n - 1) / 24 h^2, 4e-6 for z^20 and h = 1/1000; z^0.7 has h^1.7 at 0
        let total = integral(&pdf, [z, 1.0], [0.0, 2.0 * PI], 1000);
        assert!((total - 1.0).abs() < 2e-5, "{name}: {total}");
    }
}

/// Asserts that the counts follow the expectations: chi-square within five standard deviations above its mean.
fn assert_distributed(name: &str, counts: &[f64], expected: &[f64]) {
    let (mut chi2, mut freedom) = (0.0, -1.0);
    let mut rest = (0.0, 0.0);
    for (&count, &expected) in counts.iter().zip(expected) {
        if expected < 10.0 {
            rest = (rest.0 + count, rest.1 + expected);
        } else {
            chi2 += (count - expected).powi(2) / expected;
            freedom += 1.0;
        }
    }
    if rest.1 >= 10.0 {
        chi2 += (rest.0 - rest.1).powi(2) / rest.1;
        freedom += 1.0;
    }
    assert!(chi2 < freedom + 5.0 * (2.0_f64 * freedom).sqrt(), "{name}: chi-square {chi2} of {freedom} cells");
}

const SAMPLES: u32 = 400_000;

/// Uniform numbers, fixed.
fn uniform() -> impl Iterator<Item = [f64; 2]> {
    let mut stream = Stream::new(11, 0, 0);
    (0..SAMPLES).map(move |_| [stream.next_f64(), stream.next_f64()])
}

#[test]
fn directions_are_distributed_as_their_density() {
    const N: usize = 20;
    for (name, lowest, pdf, sample) in directions() {
        let mut counts = vec![0.0; N * N];
        for u in uniform() {
            let w = sample(u);
            let row = ((w.z - lowest) / (1.0 - lowest) * N as f64).clamp(0.0, N as f64 - 0.5) as usize;
            let column = ((w.y.atan2(w.x) / (2.0 * PI)).rem_euclid(1.0) * N as f64) as usize % N;
            counts[row * N + column] += 1.0;
        }
        let edge = |lo: f64, hi: f64, k: usize| lo + (hi - lo) * k as f64 / N as f64;
        let expected: Vec<f64> = (0..N * N)
            .map(|k| {
                let z = [edge(lowest, 1.0, k / N), edge(lowest, 1.0, k / N + 1)];
                let phi = [edge(0.0, 2.0 * PI, k % N), edge(0.0, 2.0 * PI, k % N + 1)];
                f64::from(SAMPLES) * integral(&pdf, z, phi, 20)
            })
            .collect();
        assert_distributed(name, &counts, &expected);
    }
}

#[test]
fn points_of_the_disk_are_distributed_uniformly() {
    // cells of equal area: 20 rings of r^2 by 20 sectors
    let mut counts = vec![0.0; 400];
    for p in uniform().map(disk::sample) {
        let ring = ((p[0] * p[0] + p[1] * p[1]) * 20.0) as usize;
        let sector = ((p[1].atan2(p[0]) / (2.0 * PI)).rem_euclid(1.0) * 20.0) as usize % 20;
        counts[ring.min(19) * 20 + sector] += 1.0;
    }
    assert_distributed("disk", &counts, &vec![f64::from(SAMPLES) / 400.0; 400]);
}

#[test]
fn points_of_the_triangle_are_distributed_uniformly() {
    // squares of side 1/20 below the diagonal hold 2/400 of the area, those cut by it half of that
    let mut counts = vec![0.0; 400];
    for b in uniform().map(triangle::sample) {
        counts[(b[0] * 20.0) as usize * 20 + (b[1] * 20.0) as usize] += 1.0;
    }
    let share = |k: usize| match (k / 20 + k % 20).cmp(&19) {
        std::cmp::Ordering::Less => 2.0,
        std::cmp::Ordering::Equal => 1.0,
        std::cmp::Ordering::Greater => 0.0,
    };
    let expected: Vec<f64> = (0..400).map(|k| f64::from(SAMPLES) / 400.0 * share(k)).collect();
    assert_distributed("triangle", &counts, &expected);
    assert!(counts.iter().zip(&expected).all(|(&count, &expected)| expected > 0.0 || count == 0.0));
}

#[test]
fn numbers_are_distributed_as_their_density() {
    let cases: [(&str, [f64; 2], fn(f64) -> f64, fn(f64) -> f64); 2] = [
        ("tent", [-1.0, 1.0], tent::pdf, tent::sample),
        ("exponential", [0.0, 8.0], |x| exponential::pdf(2.0, x), |u| exponential::sample(2.0, u)),
    ];
    for (name, [lo, hi], pdf, sample) in cases {
        let n = 50;
        let width = (hi - lo) / f64::from(n);
        let mut counts = vec![0.0; n as usize];
        for x in uniform().map(|u| sample(u[0])).filter(|&x| x < hi) {
            counts[((x - lo) / width) as usize] += 1.0;
        }
        // midpoint rule with 20 points: relative error (2 width / 20)^2 / 24 = 1e-5, below 1/sqrt(samples per cell)
        let cell =
            |k: i32| (0..20).map(|j| pdf(lo + width * (f64::from(k) + (f64::from(j) + 0.5) / 20.0))).sum::<f64>();
        let expected: Vec<f64> = (0..n).map(|k| f64::from(SAMPLES) * cell(k) * width / 20.0).collect();
        assert_distributed(name, &counts, &expected);
    }
}
