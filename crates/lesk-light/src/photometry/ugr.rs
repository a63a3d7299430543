//! The glare table of a luminaire: UGR in nineteen standard rooms.
//!
//! CIE 117:1995, *Discomfort Glare in Interior Lighting*, and CIE 190:2010, *Calculation and Presentation of Unified Glare
//! Rating Tables*: UGR = 8 log₁₀(0.25 / L_b · Σ L² ω / p²), the luminaires in a grid 2 m above the eye, the observer in the
//! middle of a wall, the line of sight horizontal and perpendicular to that wall.
//!
//! DEPARTS: CIE 190 takes the flux on the floor and the transfer between surfaces from tables; here both are integrals over
//! the same room (rectangles with uniform exitance), and the position index is Levin's formula, of which CIE 117 prints a
//! table. The tests state how far that is from the published factors.

use super::Photometry;
use lesk_math::vec3;
use std::f64::consts::{PI, TAU};

/// Room sizes across and along the line of sight, in multiples of the height of the luminaires above the eye.
pub const ROOMS: [[u32; 2]; 19] = [
    [2, 2],
    [2, 3],
    [2, 4],
    [2, 6],
    [2, 8],
    [2, 12],
    [4, 2],
    [4, 3],
    [4, 4],
    [4, 6],
    [4, 8],
    [4, 12],
    [8, 4],
    [8, 6],
    [8, 8],
    [8, 12],
    [12, 4],
    [12, 6],
    [12, 8],
];

/// Reflectances of ceiling, walls and floor, percent.
pub const REFLECTANCES: [[u32; 3]; 5] = [[70, 50, 20], [70, 30, 20], [50, 50, 20], [50, 30, 20], [30, 30, 20]];

/// Height of the luminaires above the eye, metres.
const HEIGHT: f64 = 2.0;
/// Beyond these, CIE 117 leaves luminaires out: sideways over forward distance, height over forward distance (the end of its
/// table), angle from nadir in degrees.
const MOST_ASIDE: f64 = 3.0;
const MOST_ABOVE: f64 = 1.9;
const MOST_GAMMA: f64 = 85.0;

/// A UGR table for the luminaire's own flux.
#[derive(Clone, Debug, PartialEq)]
pub struct UgrTable {
    /// Spacing of the luminaires over their height above the eye.
    pub spacing: f64,
    /// One row for each of [`ROOMS`]: seen crosswise (C0-C180 along the line of sight) with each of [`REFLECTANCES`], then
    /// endwise.
    pub values: Vec<[f64; 10]>,
    /// What to add for the same luminaire with 1000 lm in its lamps: the uncorrected table.
    pub to_1000_lm: f64,
}

impl Photometry {
    /// The UGR table with a spacing of 0.25 (catalogues) or 1 (examples of CIE 190) times the height above the eye.
    /// `None` where the luminaire has no luminous area, emits nothing, or counts watts.
    pub fn ugr_table(&self, spacing: f64) -> Option<UgrTable> {
        let flux = self.flux();
        let seen = self.opening.projected_area(vec3(0.6, 0.48, -0.64)) > 0.0;
        if !(seen && flux > 0.0 && self.counted == super::Counted::Light && (0.05..=2.0).contains(&spacing)) {
            return None;
        }
        let values = ROOMS.iter().map(|room| self.row(*room, spacing)).collect::<Vec<_>>();
        let lamps = self.lamp_flux().map_or(flux, |f| f * self.ballast_factor);
        Some(UgrTable { spacing, values, to_1000_lm: -8.0 * (lamps / 1000.0).log10() })
    }

    fn row(&self, room: [u32; 2], spacing: f64) -> [f64; 10] {
        let [across, along] = room.map(|n| f64::from(n) * HEIGHT);
        let counts = [across, along].map(|length| (length / (spacing * HEIGHT)).round().max(1.0));
        let shares = self.shares(across, along);
        let flux = self.flux() * counts[0] * counts[1];
        let mut row = [0.0; 10];
        for (orientation, row) in row.chunks_exact_mut(5).enumerate() {
            let sum = self.glare_sum(counts, spacing * HEIGHT, orientation == 1);
            for (value, reflectances) in row.iter_mut().zip(REFLECTANCES) {
                let walls = 2.0 * HEIGHT * (across + along);
                let background = indirect_on_walls(across, along, shares, reflectances) * flux / walls / PI;
                *value = 8.0 * (0.25 / background * sum).log10();
            }
        }
        row
    }

    /// Σ L² ω / p², in cd²/m⁴ sr.
    fn glare_sum(&self, counts: [f64; 2], step: f64, endwise: bool) -> f64 {
        let mut sum = 0.0;
        for i in 0..counts[0] as usize {
            let aside = ((i as f64 + 0.5) - 0.5 * counts[0]) * step;
            for j in 0..counts[1] as usize {
                let forward = (j as f64 + 0.5) * step;
                sum += self.glare(aside, forward, endwise);
            }
        }
        sum
    }

    fn glare(&self, aside: f64, forward: f64, endwise: bool) -> f64 {
        let square = aside * aside + forward * forward + HEIGHT * HEIGHT;
        let r = square.sqrt();
        let left_out = aside.abs() > MOST_ASIDE * forward
            || HEIGHT > MOST_ABOVE * forward
            || HEIGHT < MOST_GAMMA.to_radians().cos() * r;
        if left_out {
            return 0.0;
        }
        // from the luminaire to the eye: crosswise, C0 lies along the line of sight
        let (x, y) = if endwise { (aside, forward) } else { (forward, aside) };
        let to_eye = vec3(x, y, -HEIGHT) * (1.0 / r);
        let area = self.opening.projected_area(to_eye);
        let p = position_index(aside, forward, HEIGHT);
        let intensity = self.toward(to_eye);
        // L = I / A, ω = A / r²
        if area > 0.0 { intensity * intensity / (area * square * p * p) } else { 0.0 }
    }

    /// Shares of the luminaire's flux that fall directly on the floor (at eye level), the walls and the ceiling, on average
    /// over luminaires spread evenly: a ray that lands `dx`, `dy` away hits the floor for (1 - dx/X)(1 - dy/Y) of them.
    fn shares(&self, across: f64, along: f64) -> [f64; 3] {
        const RINGS: usize = 180;
        const TURNS: usize = 72;
        let flux = self.flux();
        let down = self.web.flux_down() / flux;
        let mut floor = 0.0;
        for i in 0..RINGS {
            let theta = (i as f64 + 0.5) * 0.5 * PI / RINGS as f64;
            let (mut mean, mut hits) = (0.0, 0.0);
            for j in 0..TURNS {
                let phi = (j as f64 + 0.5) * TAU / TURNS as f64;
                let (dx, dy) = (HEIGHT * theta.tan() * phi.cos(), HEIGHT * theta.tan() * phi.sin());
                mean += self.intensity(theta, phi);
                hits += (1.0 - dx.abs() / across).max(0.0) * (1.0 - dy.abs() / along).max(0.0);
            }
            // the mean intensity over C, as CIE 190 takes it, so that both orientations have one background
            let ring = theta.sin() * 0.5 * PI / RINGS as f64 * TAU;
            floor += ring * mean / TURNS as f64 * hits / TURNS as f64;
        }
        let floor = (floor / flux).min(down);
        [floor, down - floor, 1.0 - down]
    }
}

/// Guth's position index by Levin's formula (CIE 117:1995; *Lighting Design and Application* 5, 1975): the source lies
/// `aside` of, `forward` along and `above` the horizontal line of sight, in any unit of length.
pub fn position_index(aside: f64, forward: f64, above: f64) -> f64 {
    let alpha = aside.abs().atan2(above).to_degrees();
    let beta = aside.hypot(above).atan2(forward).to_degrees();
    let linear = 35.2 - 0.31889 * alpha - 1.22 * (-2.0 * alpha / 9.0).exp();
    let square = 21.0 + 0.26667 * alpha - 0.002963 * alpha * alpha;
    (linear * 1e-3 * beta + square * 1e-5 * beta * beta).exp()
}

/// Mean illuminance of the walls by interreflection, for 1 lm per m² of wall whose direct shares fall on floor, walls and
/// ceiling.
fn indirect_on_walls(across: f64, along: f64, direct: [f64; 3], reflectances: [u32; 3]) -> f64 {
    let [ceiling, wall, floor] = reflectances.map(|r| f64::from(r) / 100.0);
    let (flat, walls) = (across * along, 2.0 * HEIGHT * (across + along));
    let opposite = parallel_form_factor(across / HEIGHT, along / HEIGHT);
    let from_flat = 1.0 - opposite;
    let to_flat = flat * from_flat / walls;
    let to_wall = 1.0 - 2.0 * to_flat;
    let rho = [floor, wall, ceiling];
    let areas = [flat, walls, flat];
    let transfer = [[0.0, from_flat, opposite], [to_flat, to_wall, to_flat], [opposite, from_flat, 0.0]];
    // exitances by fixed-point iteration: the reflectances are at most 0.7, so 100 rounds leave 0.7^100 = 3e-16
    let start: [f64; 3] = std::array::from_fn(|i| rho[i] * direct[i] * walls / areas[i]);
    let mut exitance = start;
    let received = |exitance: [f64; 3], i: usize| (0..3).map(|j| transfer[i][j] * exitance[j]).sum::<f64>();
    for _ in 0..100 {
        exitance = std::array::from_fn(|i| start[i] + rho[i] * received(exitance, i));
    }
    received(exitance, 1)
}

/// The form factor between two equal parallel rectangles of `x` by `y` at distance 1 (Howell, *A Catalog of Radiation
/// Configuration Factors*, C-11).
fn parallel_form_factor(x: f64, y: f64) -> f64 {
    let (x2, y2) = (1.0 + x * x, 1.0 + y * y);
    let log = (x2 * y2 / (x2 + y2 - 1.0)).sqrt().ln();
    let arcs = x * y2.sqrt() * (x / y2.sqrt()).atan() + y * x2.sqrt() * (y / x2.sqrt()).atan();
    2.0 / (PI * x * y) * (log + arcs - x * x.atan() - y * y.atan())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cube_has_its_form_factor() {
        // lights.md 6.1: 0.199824896
        assert!((parallel_form_factor(1.0, 1.0) - 0.199824896).abs() < 1e-9);
    }

    #[test]
    fn position_index_is_that_of_cie_117() {
        // CIE 117:1995, table 4.1 (values printed by eulumdat-ugr, 123VincentB, MIT): (T/R, H/R, p)
        for (t, h, p) in
            [(0.0, 0.5, 2.86), (0.0, 1.0, 7.00), (0.5, 0.5, 2.91), (1.0, 0.4, 3.50), (1.0, 1.0, 7.00), (2.0, 0.5, 5.80)]
        {
            let got = position_index(t, 1.0, h);
            assert!((got / p - 1.0).abs() < 0.06, "{t} {h}: {got} is not {p}"); // the table was read from a chart
        }
    }

    #[test]
    fn transfer_factors_are_those_of_cie_190() {
        // CIE 190:2010, table 5, room 4H x 8H (values printed by eulumdat-ugr): from floor, walls, ceiling to walls
        for (reflectances, factors) in [
            ([70, 50, 20], [0.115, 0.211, 0.307]),
            ([70, 30, 20], [0.106, 0.117, 0.283]),
            ([50, 30, 20], [0.093, 0.104, 0.196]),
            ([30, 30, 20], [0.081, 0.092, 0.114]),
        ] {
            for (from, factor) in factors.into_iter().enumerate() {
                let mut direct = [0.0; 3];
                direct[from] = 1.0;
                let got = indirect_on_walls(8.0, 16.0, direct, reflectances);
                assert!((got - factor).abs() < 0.0015, "{reflectances:?} {from}: {got} is not {factor}"); // three digits
            }
        }
    }
}
