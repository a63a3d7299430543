//! The table of intensities over two angles, and what follows from it exactly.
//!
//! **Contract**: between its angles the table is bilinear in (V, H), and 0 where it says nothing. LM-63 and EULUMDAT do
//! not state any interpolation; for steps of 10 degrees the choice moves the flux by percents, so it is stated here and
//! everything (look-up, flux, sampling, conversion) follows it.

use lesk_math::{Vec3, vec3};
use std::f64::consts::PI;

/// What the two angles of a table mean. Directions are in the frame of the luminaire: x along C0, y along C90, z up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Coordinates {
    /// V is the angle from nadir, H the azimuth: d = (sin V cos H, sin V sin H, -cos V).
    C,
    /// V turns about the horizontal axis x, H is the angle out of that turning plane:
    /// d = (sin H, cos H sin V, -cos H cos V); 0, 0 is nadir.
    B,
    /// H turns about the vertical axis, clockwise seen from above, V is the elevation:
    /// d = (cos V cos H, -cos V sin H, sin V); 0, 0 is horizontal along C0, V -90 is nadir.
    A,
}

impl Coordinates {
    /// The letter of the type.
    pub fn letter(self) -> &'static str {
        match self {
            Coordinates::A => "A",
            Coordinates::B => "B",
            Coordinates::C => "C",
        }
    }

    /// The unit direction of V and H in degrees.
    pub fn direction(self, v_deg: f64, h_deg: f64) -> Vec3<f64> {
        let ((sv, cv), (sh, ch)) = (v_deg.to_radians().sin_cos(), h_deg.to_radians().sin_cos());
        match self {
            Coordinates::C => vec3(sv * ch, sv * sh, -cv),
            Coordinates::B => vec3(sh, ch * sv, -(ch * cv)),
            Coordinates::A => vec3(cv * ch, -(cv * sh), sv),
        }
    }

    /// V and H in degrees of a unit direction; H of type C in [0, 360), all others in [-180, 180].
    pub fn angles(self, d: Vec3<f64>) -> [f64; 2] {
        let [v, h] = match self {
            Coordinates::C => [d.x.hypot(d.y).atan2(-d.z), d.y.atan2(d.x)],
            Coordinates::B => [d.y.atan2(-d.z), d.x.atan2(d.y.hypot(d.z))],
            Coordinates::A => [d.z.atan2(d.x.hypot(d.y)), (-d.y).atan2(d.x)],
        }
        .map(f64::to_degrees);
        if self != Coordinates::C || h >= 0.0 {
            return [v, h];
        }
        // -1e-20 + 360 rounds to 360
        [v, if h + 360.0 < 360.0 { h + 360.0 } else { 0.0 }]
    }
}

/// Intensities in cd (or W/sr) over V and H.
///
/// Symmetries are unfolded: H of type C is one 0 (rotational) or runs from 0 to 360.
#[derive(Clone, Debug, PartialEq)]
pub struct Web {
    coordinates: Coordinates,
    v: Vec<f64>,
    h: Vec<f64>,
    /// Plane by plane: the value of `v[i]`, `h[j]` is at `j * v.len() + i`.
    values: Vec<f64>,
}

impl Web {
    /// A table. The angles ascend, degrees.
    ///
    /// # Panics
    /// If there are no angles, or not one value for each pair of them.
    pub fn new(coordinates: Coordinates, v: Vec<f64>, h: Vec<f64>, values: Vec<f64>) -> Self {
        assert!(
            !v.is_empty() && !h.is_empty() && values.len() == v.len() * h.len(),
            "one value for each pair of angles"
        );
        debug_assert!(v.windows(2).chain(h.windows(2)).all(|w| w[0] < w[1]), "angles ascend");
        Web { coordinates, v, h, values }
    }

    /// The meaning of the angles.
    pub fn coordinates(&self) -> Coordinates {
        self.coordinates
    }

    /// Vertical angles, degrees.
    pub fn v(&self) -> &[f64] {
        &self.v
    }

    /// Horizontal angles, degrees.
    pub fn h(&self) -> &[f64] {
        &self.h
    }

    /// The values of the plane `j`, one for each V.
    pub fn plane(&self, j: usize) -> &[f64] {
        &self.values[j * self.v.len()..(j + 1) * self.v.len()]
    }

    /// All values, plane by plane.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// Whether the values are the same all around.
    pub fn is_rotational(&self) -> bool {
        self.coordinates == Coordinates::C && self.h.len() == 1
    }

    /// The same with all values multiplied.
    #[must_use]
    pub fn scaled(mut self, factor: f64) -> Self {
        self.values.iter_mut().for_each(|x| *x *= factor);
        self
    }

    /// The value at V and H in degrees, bilinear; 0 outside of the table. H of type C may be any angle.
    pub fn at(&self, v_deg: f64, h_deg: f64) -> f64 {
        let h_deg = match self.coordinates {
            Coordinates::C if self.h.len() == 1 => self.h[0],
            Coordinates::C => h_deg.rem_euclid(360.0),
            _ => h_deg,
        };
        let (Some((i, s)), Some((j, t))) = (cell(&self.v, v_deg), cell(&self.h, h_deg)) else { return 0.0 };
        let n = self.v.len();
        let (i1, j1) = ((i + 1).min(n - 1), (j + 1).min(self.h.len() - 1));
        let along = |j: usize| self.values[j * n + i] * (1.0 - s) + self.values[j * n + i1] * s;
        along(j) * (1.0 - t) + along(j1) * t
    }

    /// The value in a unit direction of the luminaire's frame.
    pub fn toward(&self, d: Vec3<f64>) -> f64 {
        let [v, h] = self.coordinates.angles(d);
        self.at(v, h)
    }

    /// The exact integral of the table over solid angle: lm for cd.
    pub fn flux(&self) -> f64 {
        self.flux_within(-180.0, 180.0)
    }

    /// The exact integral over all directions below the horizontal plane.
    pub fn flux_down(&self) -> f64 {
        match self.coordinates {
            Coordinates::C | Coordinates::B => self.flux_within(-90.0, 90.0),
            Coordinates::A => self.flux_within(-90.0, 0.0),
        }
    }

    /// The exact integral over all directions whose V lies between two angles in degrees.
    ///
    /// A bilinear function is linear along H, so the trapezoid rule over H is exact at each V; then the product of a
    /// linear function with the sine or cosine of the solid angle has a closed form. For type B the roles are changed.
    pub fn flux_within(&self, from_deg: f64, to_deg: f64) -> f64 {
        match self.coordinates {
            Coordinates::C => polar_integral(&self.v, &self.means(), 0.0, [from_deg, to_deg]),
            Coordinates::A => polar_integral(&self.v, &self.means(), 90.0, [from_deg, to_deg]),
            Coordinates::B => {
                let rows: Vec<f64> =
                    (0..self.h.len()).map(|j| trapezoid(&self.v, self.plane(j), [from_deg, to_deg])).collect();
                polar_integral(&self.h, &rows, 90.0, [-180.0, 180.0])
            }
        }
    }

    /// The integral over H in radians at each V.
    fn means(&self) -> Vec<f64> {
        let n = self.v.len();
        if self.is_rotational() {
            return self.values.iter().map(|x| x * 2.0 * PI).collect();
        }
        let column = |i: usize| -> Vec<f64> { (0..self.h.len()).map(|j| self.values[j * n + i]).collect() };
        (0..n).map(|i| trapezoid(&self.h, &column(i), [-360.0, 720.0])).collect()
    }

    /// The largest value and its direction: (value, V, H).
    pub fn peak(&self) -> (f64, f64, f64) {
        let n = self.v.len();
        let mut best = 0;
        for (k, x) in self.values.iter().enumerate() {
            if *x > self.values[best] {
                best = k;
            }
        }
        (self.values[best], self.v[best % n], self.h[best / n])
    }

    /// The same distribution as a table of type C with these angles in degrees, by look-up.
    pub fn resampled(&self, v: Vec<f64>, h: Vec<f64>) -> Web {
        let mut values = Vec::with_capacity(v.len() * h.len());
        for &phi in &h {
            for &theta in &v {
                values.push(match self.coordinates {
                    Coordinates::C => self.at(theta, phi),
                    _ => self.toward(Coordinates::C.direction(theta, phi)),
                });
            }
        }
        Web::new(Coordinates::C, v, h, values)
    }
}

/// The cell of ascending numbers that holds `x`, and the place within it; `None` outside, with a slack for rounding.
fn cell(grid: &[f64], x: f64) -> Option<(usize, f64)> {
    const SLACK: f64 = 1e-9; // degrees: rounding of angles from directions
    let (first, last) = (grid[0], grid[grid.len() - 1]);
    if !(x >= first - SLACK && x <= last + SLACK) {
        return None;
    }
    if grid.len() == 1 {
        return Some((0, 0.0));
    }
    let i = grid.partition_point(|&g| g <= x).clamp(1, grid.len() - 1) - 1;
    Some((i, ((x - grid[i]) / (grid[i + 1] - grid[i])).clamp(0.0, 1.0)))
}

/// The part of a linear piece between two limits: (a, b, value at a, value at b); `None` where it is empty.
fn clipped(x: [f64; 2], y: [f64; 2], within: [f64; 2]) -> Option<[f64; 4]> {
    let (a, b) = (x[0].max(within[0]), x[1].min(within[1]));
    let value = |t: f64| y[0] + (y[1] - y[0]) * (t - x[0]) / (x[1] - x[0]);
    (a < b).then(|| [a, b, value(a), value(b)])
}

/// ∫ y dx of a piecewise linear function over radians, its angles in degrees.
fn trapezoid(x: &[f64], y: &[f64], within: [f64; 2]) -> f64 {
    let pieces = x.windows(2).zip(y.windows(2));
    let part = |(x, y): (&[f64], &[f64])| {
        clipped([x[0], x[1]], [y[0], y[1]], within).map_or(0.0, |[a, b, p, q]| 0.5 * (p + q) * (b - a).to_radians())
    };
    pieces.map(part).sum()
}

/// ∫ y(x) sin(x + offset) dx of a piecewise linear y, angles in degrees.
fn polar_integral(x: &[f64], y: &[f64], offset_deg: f64, within: [f64; 2]) -> f64 {
    let mut sum = 0.0;
    for (x, y) in x.windows(2).zip(y.windows(2)) {
        let Some([a, b, p, q]) = clipped([x[0], x[1]], [y[0], y[1]], within) else { continue };
        let (a, b) = ((a + offset_deg).to_radians(), (b + offset_deg).to_radians());
        let slope = (q - p) / (b - a);
        // the antiderivative of (p + m (x - a)) sin x is m sin x - (p + m (x - a)) cos x
        sum += slope * (b.sin() - a.sin()) - q * b.cos() + p * a.cos();
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    fn steps(from: f64, to: f64, count: usize) -> Vec<f64> {
        (0..=count).map(|i| from + (to - from) * i as f64 / count as f64).collect()
    }

    fn web(coordinates: Coordinates, v: Vec<f64>, h: Vec<f64>, f: impl Fn(f64, f64) -> f64) -> Web {
        let values = h.iter().flat_map(|&h| v.iter().map(move |&v| (v, h))).map(|(v, h)| f(v, h)).collect();
        Web::new(coordinates, v, h, values)
    }

    fn close(got: f64, expected: f64, relative: f64) {
        assert!((got / expected - 1.0).abs() <= relative, "{got} is not {expected}");
    }

    #[test]
    fn angles_undo_directions() {
        for coordinates in [Coordinates::A, Coordinates::B, Coordinates::C] {
            for v in [5.0, 40.0, 80.0] {
                for h in [-70.0, -10.0, 0.0, 30.0] {
                    let [v1, h1] = coordinates.angles(coordinates.direction(v, h));
                    let h1 = if coordinates == Coordinates::C && h < 0.0 { h1 - 360.0 } else { h1 };
                    assert!((v - v1).abs() < 1e-10 && (h - h1).abs() < 1e-10, "{coordinates:?} {v} {h}: {v1} {h1}");
                }
            }
        }
    }

    #[test]
    fn nadir_is_where_lm_63_puts_it() {
        let down = vec3(0.0, 0.0, -1.0);
        for (coordinates, v) in [(Coordinates::C, 0.0), (Coordinates::B, 0.0), (Coordinates::A, -90.0)] {
            assert!((coordinates.direction(v, 0.0) - down).length() < 1e-15, "{coordinates:?}");
        }
    }

    #[test]
    fn constant_intensity_gives_4_pi_in_all_coordinates() {
        for (coordinates, v, h) in [
            (Coordinates::C, [0.0, 180.0], [0.0, 360.0]),
            (Coordinates::A, [-90.0, 90.0], [-180.0, 180.0]),
            (Coordinates::B, [-180.0, 180.0], [-90.0, 90.0]),
        ] {
            let web = web(coordinates, steps(v[0], v[1], 7), steps(h[0], h[1], 5), |_, _| 2.0);
            close(web.flux(), 8.0 * PI, 1e-14);
            close(web.flux_down(), 4.0 * PI, 1e-14);
        }
    }

    #[test]
    fn flux_is_the_integral_of_what_at_returns() {
        // midpoint rule over 2000 x 2000 cells: its error for a function with kinks is of the order of the step squared
        let f = |v: f64, h: f64| (v * 0.7).sin() + (h * 1.3).cos() + 3.0;
        for (coordinates, v, h) in [
            (Coordinates::C, [10.0, 110.0], [0.0, 360.0]),
            (Coordinates::A, [-50.0, 80.0], [-60.0, 40.0]),
            (Coordinates::B, [-50.0, 80.0], [-60.0, 40.0]),
        ] {
            let web = web(coordinates, steps(v[0], v[1], 6), steps(h[0], h[1], 9), f);
            let n = 2000;
            let (dv, dh) = ((v[1] - v[0]) / f64::from(n), (h[1] - h[0]) / f64::from(n));
            let mut sum = 0.0;
            for i in 0..n * n {
                let (x, y) = (v[0] + (f64::from(i % n) + 0.5) * dv, h[0] + (f64::from(i / n) + 0.5) * dh);
                let weight = match coordinates {
                    Coordinates::C => x.to_radians().sin(),
                    Coordinates::A => x.to_radians().cos(),
                    Coordinates::B => y.to_radians().cos(),
                };
                sum += web.at(x, y) * weight;
            }
            close(web.flux(), sum * dv.to_radians() * dh.to_radians(), 1e-6);
        }
    }

    #[test]
    fn cosine_powers_have_their_flux() {
        // ∫ cosⁿ dΩ = 2π / (n + 1); a table of 0.1 deg steps is off by n h²/12
        for n in [1, 4, 20] {
            let web = web(Coordinates::C, steps(0.0, 90.0, 900), vec![0.0], |v, _| v.to_radians().cos().powi(n));
            close(web.flux(), 2.0 * PI / f64::from(n + 1), f64::from(n) * 3e-7);
        }
    }

    #[test]
    fn outside_of_the_table_is_dark() {
        let web = web(Coordinates::C, vec![90.0, 180.0], vec![0.0], |_, _| 1.0);
        assert_eq!(web.at(89.0, 0.0), 0.0);
        assert_eq!(web.toward(vec3(0.0, 0.0, 1.0)), 1.0);
        assert_eq!(web.toward(vec3(0.0, 0.0, -1.0)), 0.0);
    }
}
