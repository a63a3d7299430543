//! Dual numbers against derivatives in closed form.

use lesk_math::{Dual, Real};

type D = Dual<f64, 2>;

/// 8 rounding errors: every derivative below takes at most a handful of operations.
fn close(a: f64, b: f64) -> bool {
    (a - b).abs() <= 8.0 * f64::EPSILON * (1.0 + b.abs())
}

#[test]
fn derivatives_of_functions_equal_their_closed_forms() {
    let table: [(&str, fn(D) -> D, fn(f64) -> f64); 14] = [
        ("sqrt", |x| x.sqrt(), |x| 0.5 / x.sqrt()),
        ("exp2", |x| x.exp2(), |x| std::f64::consts::LN_2 * x.exp2()),
        ("exp", |x| x.exp(), |x| x.exp()),
        ("log2", |x| x.log2(), |x| std::f64::consts::LOG2_E / x),
        ("ln", |x| x.ln(), |x| 1.0 / x),
        ("sin", |x| x.sin(), |x| x.cos()),
        ("cos", |x| x.cos(), |x| -x.sin()),
        ("tan", |x| x.tan(), |x| 1.0 + x.tan() * x.tan()),
        ("acos", |x| x.acos(), |x| -1.0 / (1.0 - x * x).sqrt()),
        ("erf", |x| x.erf(), |x| std::f64::consts::FRAC_2_SQRT_PI * (-x * x).exp()),
        ("recip", |x| x.recip(), |x| -1.0 / (x * x)),
        ("powi", |x| x.powi(5), |x| 5.0 * x.powi(4)),
        ("abs", |x| (-x).abs(), |_| 1.0),
        ("round", |x| x.round() * x, |x| x.round()),
    ];
    for (name, dual, slope) in table {
        for x in [0.05, 0.3, 0.7, 0.95] {
            let d = dual(D::variable(x, 1)).d;
            assert!(close(d[1], slope(x)), "{name} at {x}: {} instead of {}", d[1], slope(x));
            assert_eq!(d[0], 0.0, "{name}: the other variable");
        }
    }
}

#[test]
fn derivative_of_erf_inv_is_that_of_the_inverse() {
    for x in [-0.99, -0.2, 0.0, 0.5, 0.999] {
        let y = D::variable(x, 0).erf_inv();
        let back = y.erf();
        assert!((back.d[0] - 1.0).abs() < 1e-9, "erf(erf_inv(x)) must have slope 1 at {x}, not {}", back.d[0]);
    }
}

#[test]
fn pow_and_atan2_have_both_partial_derivatives() {
    let (x, y) = (D::variable(0.3, 0), D::variable(2.5, 1));
    let p = x.pow(y);
    assert!(close(p.d[0], 2.5 * 0.3_f64.powf(1.5)) && close(p.d[1], 0.3_f64.powf(2.5) * 0.3_f64.ln()));
    let a = y.atan2(x);
    let r2 = 0.3 * 0.3 + 2.5 * 2.5;
    assert!(close(a.d[0], -2.5 / r2) && close(a.d[1], 0.3 / r2));
}

#[test]
fn select_takes_value_and_derivative_of_one_side() {
    let (x, y) = (D::variable(1.0, 0), D::variable(2.0, 1));
    assert_eq!(D::select(x.lt(y), x, y), x);
    assert_eq!(x.max(y), y);
    assert_eq!(x.min(y), x);
}

#[test]
fn gradients_stay_finite_at_the_borders_of_domains() {
    let zero = Dual::<f32, 1>::variable(0.0, 0);
    let one = Dual::<f32, 1>::variable(1.0, 0);
    for (name, value) in [
        ("sqrt(0)", zero.sqrt()),
        ("safe_sqrt(-0)", (-zero).safe_sqrt()),
        ("acos(1)", one.safe_acos()),
        ("0^2", zero.pow(Dual::constant(2.0))),
        ("0^1e4", zero.pow(Dual::constant(1e4))),
        ("atan2(0, 0)", zero.atan2(zero)),
        ("log2(0)", zero.log2()),
    ] {
        assert!(value.v.is_finite() && value.d[0].is_finite(), "{name}: {value:?}");
    }
}
