//! The coefficients of the sky and of the sun; `data/hosek/PROVENANCE.md` says where the numbers come from.

use std::f64::consts::FRAC_PI_2;
use std::sync::LazyLock;

/// Number of bands.
pub(super) const BANDS: usize = 11;
/// Wavelength of the first band, nm.
pub(super) const FIRST_NM: f64 = 320.0;
/// From band to band, nm.
pub(super) const STEP_NM: f64 = 40.0;

const TURBIDITIES: usize = 10;
/// Control points of the Bézier curves over the elevation.
const POINTS: usize = 6;
/// Pieces of the sun's cubic curves over the elevation.
const PIECES: usize = 45;

/// The share of a band at a wavelength: linear interpolation between the bands, zero outside of them.
pub(super) fn share(band: usize, lambda_nm: f64) -> f64 {
    let at = (lambda_nm - FIRST_NM) / STEP_NM;
    if (0.0..=(BANDS - 1) as f64).contains(&at) { (1.0 - (at - band as f64).abs()).max(0.0) } else { 0.0 }
}

/// The distribution of one band: the nine coefficients A to I of Eq. 8 of the paper, then the mean radiance in
/// W/(m² sr nm).
#[derive(Clone, Copy, Debug)]
pub(super) struct Shape([f64; 10]);

impl Shape {
    /// Radiance at the cosine of the zenith distance and the angle γ to the sun (Eq. 8 and 9), W/(m² sr nm).
    ///
    /// F = (1 + A exp(B / (cos θ + 0.01))) (C + D exp(E γ) + F cos² γ + G χ(I, γ) + H √cos θ), with
    /// χ(g, γ) = (1 + cos² γ) / (1 + g² - 2 g cos γ)^(3/2). In the code of the authors, whose coefficients these are, the
    /// last two stand in the order I, H of the paper.
    pub fn radiance(&self, cos_z: f64, gamma: f64, cos_gamma: f64) -> f64 {
        let [a, b, c, d, e, f, g, h, i, mean] = self.0;
        let square = cos_gamma * cos_gamma;
        let below = 1.0 + i * i - 2.0 * i * cos_gamma;
        let aureole = (1.0 + square) / (below * below.sqrt());
        let gradation = 1.0 + a * (b / (cos_z + 0.01)).exp();
        let indicatrix = c + d * (e * gamma).exp() + f * square + g * aureole + h * cos_z.sqrt();
        (gradation * indicatrix * mean).max(0.0)
    }
}

/// All tables.
pub(super) struct Tables {
    /// By band, albedo 0 and 1, turbidity, control point.
    sky: Vec<[f64; 10]>,
    /// By band, turbidity, piece: coefficients of the cubic, highest power first; W/(m² sr nm).
    sun: Vec<[f64; 4]>,
    /// By band: coefficients of the powers of the cosine on the sun.
    limb: Vec<[f64; 6]>,
}

pub(super) static TABLES: LazyLock<Tables> = LazyLock::new(|| Tables {
    sky: rows(include_str!("../../../../data/hosek/sky.csv"), 4),
    sun: rows(include_str!("../../../../data/hosek/sun.csv"), 3),
    limb: rows(include_str!("../../../../data/hosek/limb.csv"), 1),
});

/// The last `N` numbers of every row of one of the project's own tables.
fn rows<const N: usize>(text: &str, keys: usize) -> Vec<[f64; N]> {
    let row = |line: &str| {
        let mut words = line.split(',').skip(keys);
        std::array::from_fn(|_| words.next().and_then(|word| word.parse().ok()).expect("data holds numbers"))
    };
    text.lines().skip(1).map(row).collect()
}

/// The table turbidity at or below, from 0, with the shares of it and of the next one.
fn between(turbidity: f64) -> [(usize, f64); 2] {
    let low = (turbidity as usize).min(TURBIDITIES - 1);
    let t = turbidity - low as f64;
    [(low - 1, 1.0 - t), (low, t)]
}

impl Tables {
    /// The distribution at a turbidity, an albedo of the ground and an elevation of the sun in radians: quintic Bézier
    /// curves over the cube root of the elevation, linear in the other two (section 5.2 of the paper).
    pub fn shape(&self, band: usize, turbidity: f64, albedo: f64, elevation: f64) -> Shape {
        let t = (elevation / FRAC_PI_2).cbrt();
        let bernstein: [f64; POINTS] = std::array::from_fn(|k| {
            [1.0, 5.0, 10.0, 10.0, 5.0, 1.0][k] * (1.0 - t).powi((POINTS - 1 - k) as i32) * t.powi(k as i32)
        });
        let mut out = [0.0; 10];
        for (place, of_albedo) in [(0, 1.0 - albedo), (1, albedo)] {
            for (row, of_turbidity) in between(turbidity) {
                let first = ((band * 2 + place) * TURBIDITIES + row) * POINTS;
                for (coefficients, weight) in self.sky[first..first + POINTS].iter().zip(bernstein) {
                    (0..10).for_each(|i| out[i] += of_albedo * of_turbidity * weight * coefficients[i]);
                }
            }
        }
        Shape(out)
    }

    /// The radiance at the centre of the sun's disk at a turbidity and elevation, W/(m² sr nm).
    pub fn sun_center(&self, band: usize, turbidity: f64, elevation: f64) -> f64 {
        let piece = (((elevation / FRAC_PI_2).cbrt() * PIECES as f64) as usize).min(PIECES - 1);
        let x = elevation - (piece as f64 / PIECES as f64).powi(3) * FRAC_PI_2;
        let cubic = |row: usize| {
            let c = &self.sun[(band * TURBIDITIES + row) * PIECES + piece];
            ((c[0] * x + c[1]) * x + c[2]) * x + c[3]
        };
        between(turbidity).into_iter().map(|(row, share)| share * cubic(row)).sum()
    }

    /// The mean radiance of the projected disk over that at its centre: that of μ^k is 2 / (k + 2).
    pub fn sun_mean(&self, band: usize) -> f64 {
        self.limb[band].iter().zip(2u8..).map(|(c, k)| c * 2.0 / f64::from(k)).sum()
    }
}
