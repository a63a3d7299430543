//! Smooth reflectance spectra of RGB colours: Jakob and Hanika, *A Low-Dimensional Function Space for Efficient Spectral
//! Upsampling*, Computer Graphics Forum 38(2), 2019.

use crate::{QuantityError, Spectrum, colorspace, observer};
use std::sync::LazyLock;

/// A reflectance S(c0 t² + c1 t + c2) with S(x) = 1/2 + x / (2 √(1 + x²)), t = (λ - 360 nm) / 470 nm; always between
/// 0 and 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reflectance {
    coefficients: [f64; 3],
    error: f64,
}

/// Rows of t and the three weights that turn a reflectance under D65 into linear sRGB, at 5 nm.
static WEIGHTS: LazyLock<Vec<(f64, [f64; 3])>> = LazyLock::new(|| {
    let d65 = Spectrum::parse("D65").expect("a name of the table");
    let rows: Vec<(f64, [f64; 3])> = (0..=94)
        .map(|i| {
            let nm = 360.0 + 5.0 * f64::from(i);
            let value = d65.at(nm);
            (place(nm), colorspace::rec709_from_xyz(observer::xyz_bar(nm).map(|bar| bar * value)))
        })
        .collect();
    // a white reflectance is white: this also takes away what the 5 nm sum and the white of sRGB differ by
    let white = rows.iter().fold([0.0; 3], |sum, (_, w)| [0, 1, 2].map(|c| sum[c] + w[c]));
    rows.into_iter().map(|(t, w)| (t, [0, 1, 2].map(|c| w[c] / white[c]))).collect()
});

fn place(nm: f64) -> f64 {
    (nm - observer::FIRST_NM) / (observer::LAST_NM - observer::FIRST_NM)
}

fn sigmoid(x: f64) -> f64 {
    0.5 + 0.5 * x / (1.0 + x * x).sqrt()
}

fn polynomial(c: [f64; 3], t: f64) -> f64 {
    (c[0] * t + c[1]) * t + c[2]
}

/// Channels of the nearest colours that are fitted: 0 and 1 themselves need infinite coefficients.
const LIMITS: [f64; 2] = [1e-3, 0.999];

impl Reflectance {
    /// The reflectance whose colour under D65 is a linear sRGB colour.
    ///
    /// # Errors
    /// `OutOfRange` for a channel outside 0 to 1.
    pub fn of_srgb(rgb: [f64; 3]) -> Result<Reflectance, QuantityError> {
        if let Some(given) = rgb.into_iter().find(|v| !(0.0..=1.0).contains(v)) {
            return Err(QuantityError::OutOfRange { name: "rgb", given, accepted: "0 to 1 in each channel" });
        }
        let target = rgb.map(|v| v.clamp(LIMITS[0], LIMITS[1]));
        let grey = (target[0] + target[1] + target[2]) / 3.0;
        // S(x) = grey
        let mut c = [0.0, 0.0, (grey - 0.5) / (grey * (1.0 - grey)).sqrt()];
        // from grey to the colour in small steps: far from the solution the sigmoid is flat
        const STEPS: u32 = 16;
        for i in 1..=STEPS {
            let share = f64::from(i) / f64::from(STEPS);
            c = fit(c, target.map(|v| grey + share * (v - grey)));
        }
        let got = color(c);
        let error = [0, 1, 2].map(|i| (got[i] - rgb[i]).abs()).into_iter().fold(0.0, f64::max);
        Ok(Reflectance { coefficients: c, error })
    }

    /// The reflectance at a wavelength in nm; constant outside 360 to 830 nm.
    pub fn at(&self, lambda_nm: f64) -> f64 {
        let t = place(lambda_nm.clamp(observer::FIRST_NM, observer::LAST_NM));
        sigmoid(polynomial(self.coefficients, t))
    }

    /// c0, c1, c2.
    pub fn coefficients(&self) -> [f64; 3] {
        self.coefficients
    }

    /// The largest difference of a channel between the colour asked for and that of the spectrum under D65.
    pub fn error(&self) -> f64 {
        self.error
    }
}

/// Linear sRGB of the coefficients under D65.
fn color(c: [f64; 3]) -> [f64; 3] {
    WEIGHTS.iter().fold([0.0; 3], |sum, (t, w)| {
        let s = sigmoid(polynomial(c, *t));
        [0, 1, 2].map(|i| sum[i] + w[i] * s)
    })
}

/// Levenberg-Marquardt steps towards a colour.
fn fit(mut c: [f64; 3], target: [f64; 3]) -> [f64; 3] {
    let distance = |c| residual(c, target).iter().map(|r| r * r).sum::<f64>();
    let (mut damping, mut best) = (1e-6, distance(c));
    for _ in 0..60 {
        if best < 1e-22 {
            break;
        }
        let Some(step) = step(c, target, damping) else { break };
        let next = [0, 1, 2].map(|i| c[i] + step[i]);
        let there = distance(next);
        if there < best {
            (c, best, damping) = (next, there, (damping * 0.2).max(1e-14));
        } else {
            damping *= 8.0;
        }
        if damping > 1e9 {
            break;
        }
    }
    c
}

fn residual(c: [f64; 3], target: [f64; 3]) -> [f64; 3] {
    let got = color(c);
    [0, 1, 2].map(|i| target[i] - got[i])
}

/// Solves (JᵀJ + damping diag) step = Jᵀ residual by Cramer's rule.
fn step(c: [f64; 3], target: [f64; 3], damping: f64) -> Option<[f64; 3]> {
    let mut jacobian = [[0.0; 3]; 3];
    for (t, w) in WEIGHTS.iter() {
        let x = polynomial(c, *t);
        let slope = 0.5 / (1.0 + x * x).powf(1.5);
        for i in 0..3 {
            for (k, power) in [t * t, *t, 1.0].into_iter().enumerate() {
                jacobian[i][k] += w[i] * slope * power;
            }
        }
    }
    let r = residual(c, target);
    let mut a = [[0.0; 3]; 3];
    let mut b = [0.0; 3];
    for k in 0..3 {
        b[k] = (0..3).map(|i| jacobian[i][k] * r[i]).sum();
        for l in 0..3 {
            a[k][l] = (0..3).map(|i| jacobian[i][k] * jacobian[i][l]).sum();
        }
    }
    for k in 0..3 {
        a[k][k] += damping * (a[k][k] + 1e-12);
    }
    let det = determinant(a);
    let solved = [0, 1, 2].map(|k| {
        let mut with = a;
        for l in 0..3 {
            with[l][k] = b[l];
        }
        determinant(with) / det
    });
    solved.iter().all(|v| v.is_finite()).then_some(solved)
}

fn determinant(m: [[f64; 3]; 3]) -> f64 {
    m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0])
        + m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn greys_are_constant_and_exact() {
        for v in [0.05, 0.18, 0.5, 0.9] {
            let grey = Reflectance::of_srgb([v; 3]).unwrap();
            for nm in [360.0, 500.0, 650.0, 830.0] {
                assert!((grey.at(nm) - v).abs() < 1e-9, "{v} at {nm}: {}", grey.at(nm));
            }
        }
    }

    #[test]
    fn colors_come_back_within_the_stated_error() {
        let d65 = Spectrum::parse("D65").unwrap();
        let white = d65.xyz(observer::Observer::Cie1931);
        let mut worst: f64 = 0.0;
        for r in 0..6 {
            for g in 0..6 {
                for b in 0..6 {
                    let rgb = [r, g, b].map(|v| f64::from(v) / 5.0);
                    let fitted = Reflectance::of_srgb(rgb).unwrap();
                    worst = worst.max(fitted.error());
                    // an independent sum at 1 nm; the white of sRGB and the 5 nm sum differ from it by 2e-4
                    let got = colorspace::rec709_from_xyz(
                        observer::xyz(|nm| d65.at(nm) * fitted.at(nm)).map(|v| v / white[1]),
                    );
                    for c in 0..3 {
                        assert!((got[c] - rgb[c]).abs() < fitted.error() + 2e-3, "{rgb:?}: {got:?}, {fitted:?}");
                    }
                    assert!((360..=830).all(|nm| (0.0..=1.0).contains(&fitted.at(f64::from(nm)))));
                }
            }
        }
        // the paper reaches all of sRGB; what is left is the limit of 1e-3 to 0.999
        assert!(worst < 2e-3, "{worst}");
    }

    #[test]
    fn colors_that_reflect_more_than_all_are_refused() {
        for rgb in [[1.1, 0.0, 0.0], [0.0, -0.1, 0.0], [f64::NAN, 0.0, 0.0]] {
            assert!(Reflectance::of_srgb(rgb).is_err());
        }
    }
}
