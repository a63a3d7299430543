//! Colours of light: chromaticity, correlated colour temperature, Duv, colour rendering.

use crate::observer::{self, Observer};
use crate::{Spectrum, radiometry, table};
use std::sync::LazyLock;

/// Chromaticity x, y of XYZ.
pub fn xy([x, y, z]: [f64; 3]) -> [f64; 2] {
    [x / (x + y + z), y / (x + y + z)]
}

/// Chromaticity u, v of 1960 from x, y: the plane in which colour temperatures are correlated.
pub fn uv([x, y]: [f64; 2]) -> [f64; 2] {
    let d = -2.0 * x + 12.0 * y + 3.0;
    [4.0 * x / d, 6.0 * y / d]
}

/// Correlated colour temperature of x, y in K and the distance Duv from the black body in the plane of 1960, positive
/// above it (towards green).
///
/// `None` where the nearest black body is outside 1000 to 100 000 K or farther than 0.05, where the CIE gives the term
/// no meaning (CIE 15).
pub fn color_temperature(xy: [f64; 2]) -> Option<(f64, f64)> {
    static LOCUS: LazyLock<Vec<(f64, [f64; 2])>> = LazyLock::new(|| {
        let temperatures = (0..=160).map(|i| 1000.0 * 100f64.powf(f64::from(i) / 160.0));
        temperatures.map(|t| (t, planck_uv(t))).collect()
    });
    let at = uv(xy);
    let distance = |[u, v]: [f64; 2]| (u - at[0]).hypot(v - at[1]);
    let nearest = (0..LOCUS.len()).min_by(|a, b| distance(LOCUS[*a].1).total_cmp(&distance(LOCUS[*b].1)))?;
    if nearest == 0 || nearest + 1 == LOCUS.len() || !distance(LOCUS[nearest].1).is_finite() {
        return None;
    }
    let t = minimum(LOCUS[nearest - 1].0.ln(), LOCUS[nearest + 1].0.ln(), |ln| distance(planck_uv(ln.exp()))).exp();
    let locus = planck_uv(t);
    let duv = distance(locus);
    (duv <= 0.05).then_some((t, if at[1] >= locus[1] { duv } else { -duv }))
}

fn planck_uv(t: f64) -> [f64; 2] {
    uv(xy(observer::xyz(|nm| radiometry::blackbody(nm, t))))
}

/// Golden section: the place of the least value between two places.
fn minimum(mut low: f64, mut high: f64, f: impl Fn(f64) -> f64) -> f64 {
    const PART: f64 = 0.618_033_988_749_894_9;
    let (mut a, mut b) = (high - PART * (high - low), low + PART * (high - low));
    let (mut at_a, mut at_b) = (f(a), f(b));
    // 0.06 wide at first; after 36 steps 2e-9, the square root of what f64 resolves at a minimum
    for _ in 0..36 {
        if at_a < at_b {
            (high, b, at_b) = (b, a, at_a);
            a = high - PART * (high - low);
            at_a = f(a);
        } else {
            (low, a, at_a) = (a, b, at_b);
            b = low + PART * (high - low);
            at_b = f(b);
        }
    }
    0.5 * (low + high)
}

/// The colour rendering indices of a light (CIE 13.3-1995).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ColorRendering {
    /// General index Ra, the mean of R1 to R8.
    pub ra: f64,
    /// Special indices R1 to R14.
    pub r: [f64; 14],
}

/// Colour rendering against a black body below 5000 K, and daylight from there on.
///
/// Sums at 1 nm over 360 to 830 nm, tables linear between their steps, 1931 observer. `None` where the light has no
/// colour temperature, or one outside the D series (above 25 000 K).
pub fn color_rendering(light: &Spectrum) -> Option<ColorRendering> {
    let (t, _) = color_temperature(xy(light.xyz(Observer::Cie1931)))?;
    let reference = if t < 5000.0 { Spectrum::blackbody(t) } else { Spectrum::daylight(t) }.ok()?;
    let white = |spectrum: &Spectrum| spectrum.xyz(Observer::Cie1931);
    let (white_k, white_r) = (white(light), white(&reference));
    let (uv_k, uv_r) = (uv(xy(white_k)), uv(xy(white_r)));
    let r = std::array::from_fn(|sample| {
        let seen = |spectrum: &Spectrum, white_y: f64| {
            let lit = |nm: f64| spectrum.at(nm) * table::TEST_COLOURS.at(sample, nm);
            observer::xyz(lit).map(|v| 100.0 * v / white_y)
        };
        let (k, r) = (seen(light, white_k[1]), seen(&reference, white_r[1]));
        let k = uvw(adapted(uv(xy(k)), uv_k, uv_r), k[1], uv_r);
        let r = uvw(uv(xy(r)), r[1], uv_r);
        100.0 - 4.6 * ((k[0] - r[0]).powi(2) + (k[1] - r[1]).powi(2) + (k[2] - r[2]).powi(2)).sqrt()
    });
    Some(ColorRendering { ra: r[..8].iter().sum::<f64>() / 8.0, r })
}

/// CIE 13.3, equation 4 and 5: the chromaticity as an eye adapted to the reference would see it.
fn adapted(uv: [f64; 2], white: [f64; 2], reference: [f64; 2]) -> [f64; 2] {
    let c = |[u, v]: [f64; 2]| (4.0 - u - 10.0 * v) / v;
    let d = |[u, v]: [f64; 2]| (1.708 * v + 0.404 - 1.481 * u) / v;
    let (c, d) = (c(reference) / c(white) * c(uv), d(reference) / d(white) * d(uv));
    let below = 16.518 + 1.481 * c - d;
    [(10.872 + 0.404 * c - 4.0 * d) / below, 5.520 / below]
}

/// U*, V*, W* of 1964.
fn uvw([u, v]: [f64; 2], y: f64, white: [f64; 2]) -> [f64; 3] {
    let w = 25.0 * y.cbrt() - 17.0;
    [13.0 * w * (u - white[0]), 13.0 * w * (v - white[1]), w]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::photometry::{Range, Vision};

    fn named(name: &str) -> Spectrum {
        Spectrum::parse(name).unwrap()
    }

    #[test]
    fn illuminants_have_the_chromaticities_of_cie_15() {
        // CIE 15:2018, tables T.3 and T.8. The CIE sums fluorescent lamps at 5 nm, we integrate lines between the points:
        // 2.3e-4 for the lines of FL11
        let cases = [
            ("A", 0.44758, 0.40745),
            ("D65", 0.31272, 0.32903),
            ("D50", 0.34567, 0.35851),
            ("E", 0.33333, 0.33333),
            ("FL2", 0.3721, 0.3751),
            ("FL7", 0.3129, 0.3292),
            ("FL11", 0.3805, 0.3769),
        ];
        for (name, x, y) in cases {
            let got = xy(named(name).xyz(Observer::Cie1931));
            assert!((got[0] - x).abs() < 3e-4 && (got[1] - y).abs() < 3e-4, "{name}: {got:?}");
        }
    }

    #[test]
    fn a_black_body_has_its_own_temperature_and_lies_on_the_locus() {
        for t in [1100.0, 2000.0, 2856.0, 5000.0, 6504.0, 20_000.0, 90_000.0] {
            let (got, duv) = color_temperature(xy(named(&format!("blackbody {t} K")).xyz(Observer::Cie1931))).unwrap();
            assert!((got / t - 1.0).abs() < 1e-5 && duv.abs() < 1e-7, "{t}: {got} {duv}");
        }
    }

    #[test]
    fn color_temperatures_of_the_illuminants_are_those_of_cie_15() {
        // CIE 15:2018, table T.8.1 and its text: whole kelvins
        for (name, kelvin) in [("FL1", 6430.0), ("FL2", 4230.0), ("FL4", 2940.0), ("FL11", 4000.0), ("FL12", 3000.0)] {
            let (t, _) = color_temperature(xy(named(name).xyz(Observer::Cie1931))).unwrap();
            assert!((t - kelvin).abs() < 10.0, "{name}: {t}");
        }
    }

    #[test]
    fn colors_without_a_black_body_near_have_no_temperature() {
        for name in ["532 nm", "gaussian 450 nm, 20 nm"] {
            assert_eq!(color_temperature(xy(named(name).xyz(Observer::Cie1931))), None, "{name}");
        }
        for broken in [[f64::NAN, 0.3], [0.3, f64::INFINITY], [0.0, 0.0]] {
            assert_eq!(color_temperature(broken), None);
        }
    }

    #[test]
    fn daylight_and_black_bodies_render_all_colors_as_themselves() {
        for name in ["blackbody 2700 K", "blackbody 4900 K", "D65", "D55"] {
            let rendering = color_rendering(&named(name)).unwrap();
            assert!(rendering.r.iter().all(|r| *r > 99.5), "{name}: {rendering:?}");
        }
    }

    #[test]
    fn fluorescent_lamps_have_the_indices_of_cie_15() {
        // CIE 15:2018, table T.8.1: Ra as whole numbers
        for (name, ra) in [("FL1", 76.0), ("FL2", 64.0), ("FL4", 51.0), ("FL7", 90.0), ("FL11", 83.0), ("FL12", 83.0)] {
            let got = color_rendering(&named(name)).unwrap().ra;
            assert!((got - ra).abs() <= 0.75, "{name}: {got}");
        }
    }

    #[test]
    fn efficacies_are_those_of_colour_science() {
        // colour-science 0.4.7 tables, trapezoid at 1 nm; two digits are printed
        let cases = [("E", 182.46), ("A", 156.20), ("D50", 207.70), ("D65", 205.15), ("FL2", 336.73), ("FL11", 336.86)];
        for (name, lm_per_w) in cases.into_iter().chain([("LED-B3", 316.88), ("HP1", 395.11)]) {
            let got = named(name).efficacy(Some(Range::VISIBLE), Vision::Photopic);
            assert!((got - lm_per_w).abs() <= 0.0051, "{name}: {got}");
        }
        for (name, lm_per_w) in [("E", 155.28), ("A", 122.94), ("D50", 185.41), ("D65", 184.43)] {
            let got = named(name).efficacy(Some(Range::OBSERVER), Vision::Photopic);
            assert!((got - lm_per_w).abs() <= 0.0051, "{name}: {got}");
        }
    }
}
