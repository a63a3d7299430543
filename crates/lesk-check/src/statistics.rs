//! The few functions of statistics that the checks need.

/// ln Gamma(x) for x > 0, relative error below 1e-10 (Stirling's series after a shift to x >= 10).
pub fn ln_gamma(x: f64) -> f64 {
    let (mut x, mut shift) = (x, 0.0);
    while x < 10.0 {
        shift -= x.ln();
        x += 1.0;
    }
    let r = 1.0 / (x * x);
    let series = (1.0 / 12.0 - r * (1.0 / 360.0 - r * (1.0 / 1260.0 - r / 1680.0))) / x;
    shift + (x - 0.5) * x.ln() - x + 0.5 * std::f64::consts::TAU.ln() + series
}

/// The probability that chi-square with `dof` degrees of freedom exceeds `x`: Q(dof/2, x/2), by series or continued
/// fraction (DLMF 8.7.1 and 8.9.2).
pub fn chi_square_survival(x: f64, dof: f64) -> f64 {
    let (a, x) = (0.5 * dof, 0.5 * x);
    if x.is_nan() || a.is_nan() || a <= 0.0 {
        return f64::NAN;
    }
    if x <= 0.0 {
        return 1.0;
    }
    if x.is_infinite() {
        return 0.0;
    }
    let scale = (a * x.ln() - x - ln_gamma(a)).exp();
    if x < a + 1.0 { 1.0 - scale * lower_series(a, x) } else { scale * upper_fraction(a, x) }
}

fn lower_series(a: f64, x: f64) -> f64 {
    let (mut term, mut sum) = (1.0 / a, 1.0 / a);
    for n in 1..100_000 {
        term *= x / (a + f64::from(n));
        sum += term;
        if term < sum * 1e-15 {
            break;
        }
    }
    sum
}

/// Lentz's evaluation of the continued fraction.
fn upper_fraction(a: f64, x: f64) -> f64 {
    const TINY: f64 = 1e-300;
    let mut b = x + 1.0 - a;
    let mut c = 1.0 / TINY;
    let mut d = 1.0 / b;
    let mut h = d;
    for n in 1..100_000 {
        let n = f64::from(n);
        let an = n * (a - n);
        b += 2.0;
        d = an * d + b;
        d = 1.0 / if d.abs() < TINY { TINY } else { d };
        c = b + an / c;
        c = if c.abs() < TINY { TINY } else { c };
        h *= d * c;
        if (d * c - 1.0).abs() < 1e-15 {
            break;
        }
    }
    h
}

/// The significance of each of `n` tests that gives `alpha` for all together (Šidák 1967).
pub fn sidak(alpha: f64, n: usize) -> f64 {
    -((-alpha).ln_1p() / n.max(1) as f64).exp_m1()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// NIST/SEMATECH e-Handbook of Statistical Methods, 1.3.6.7.4, upper critical values, 5 digits.
    #[test]
    fn chi_square_survival_gives_the_nist_table() {
        for (dof, x, p) in [(1.0, 3.841, 0.05), (10.0, 18.307, 0.05), (100.0, 135.807, 0.01), (1.0, 10.828, 0.001)] {
            let got = chi_square_survival(x, dof);
            // the table's last digit moves the probability by 5e-4 relative
            assert!((got / p - 1.0).abs() < 1e-3, "{dof} {x}: {got}");
        }
    }

    #[test]
    fn chi_square_survival_with_two_degrees_is_exponential() {
        for x in [1e-3f64, 0.5, 2.0, 9.0, 80.0, 300.0] {
            let p = (-0.5 * x).exp();
            assert!((chi_square_survival(x, 2.0) / p - 1.0).abs() < 1e-9);
        }
    }

    #[test]
    fn sidak_of_all_tests_gives_the_total() {
        assert!((1.0 - (1.0 - sidak(0.01, 24)).powi(24) - 0.01).abs() < 1e-14);
    }
}
