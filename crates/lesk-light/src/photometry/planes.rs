//! Unfolding the planes that a file stores to the whole turn, and finding which of them suffice.

/// The symmetry of a table of type C.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Symmetry {
    /// The same all around.
    Rotational,
    /// About C0-C180 and C90-C270.
    Quadrant,
    /// About the plane C0-C180.
    C0C180,
    /// About the plane C90-C270.
    C90C270,
    /// None is stated.
    None,
}

impl Symmetry {
    /// Its name in reports.
    pub fn name(self) -> &'static str {
        match self {
            Symmetry::Rotational => "rotational",
            Symmetry::Quadrant => "quadrant",
            Symmetry::C0C180 => "c0_c180",
            Symmetry::C90C270 => "c90_c270",
            Symmetry::None => "none",
        }
    }

    /// The angles at which the plane `h` (degrees) stands by this symmetry.
    pub(super) fn images(self, h: f64) -> Vec<f64> {
        match self {
            Symmetry::Rotational | Symmetry::None => vec![h],
            Symmetry::C0C180 => vec![h, 360.0 - h],
            Symmetry::C90C270 => vec![h, 540.0 - h],
            Symmetry::Quadrant => vec![h, 180.0 - h, 180.0 + h, 360.0 - h],
        }
    }
}

/// Angles nearer than this are the same, degrees.
pub(super) const SAME: f64 = 1e-3;

/// Planes of a whole turn from 0 to 360, both included, from planes at any angles; each has its values by V.
///
/// The plane at 0 is interpolated where it is not among them.
pub(super) fn whole_turn(planes: &[(f64, &[f64])], symmetry: Symmetry) -> (Vec<f64>, Vec<f64>) {
    let mut all: Vec<(f64, &[f64])> = Vec::with_capacity(planes.len() * 4);
    for (angle, values) in planes {
        all.extend(symmetry.images(*angle).into_iter().map(|image| (turn(image), *values)));
    }
    all.sort_by(|a, b| a.0.total_cmp(&b.0));
    all.dedup_by(|b, a| b.0 - a.0 < SAME);
    let count = planes.first().map_or(0, |p| p.1.len());
    let mut angles = Vec::with_capacity(all.len() + 2);
    let mut values = Vec::with_capacity((all.len() + 2) * count);
    let first = seam(&all);
    if all.first().is_none_or(|p| p.0 > 0.0) {
        angles.push(0.0);
        values.extend_from_slice(&first);
    }
    for (angle, plane) in &all {
        angles.push(*angle);
        values.extend_from_slice(plane);
    }
    angles.push(360.0);
    values.extend_from_slice(&first);
    (angles, values)
}

/// An angle within [0, 360), where those next to 360 are 0.
fn turn(angle: f64) -> f64 {
    let angle = angle.rem_euclid(360.0);
    if (SAME..=360.0 - SAME).contains(&angle) { angle } else { 0.0 }
}

/// The plane at 0 degrees.
fn seam(all: &[(f64, &[f64])]) -> Vec<f64> {
    let (Some(first), Some(last)) = (all.first(), all.last()) else { return vec![] };
    let gap = first.0 + 360.0 - last.0;
    let share = if first.0 == 0.0 { 1.0 } else { (360.0 - last.0) / gap };
    first.1.iter().zip(last.1).map(|(f, l)| f * share + l * (1.0 - share)).collect()
}

/// The strongest symmetry that planes from 0 to 360 have exactly.
pub(super) fn detect(h: &[f64], plane: impl Fn(usize) -> Vec<f64>) -> Symmetry {
    let find = |angle: f64| h.iter().position(|x| (x - turn(angle)).abs() < SAME);
    let equal = |a: usize, b: usize| {
        let (a, b) = (plane(a), plane(b));
        a.iter().zip(&b).all(|(x, y)| (x - y).abs() <= 1e-9 * x.abs().max(y.abs()))
    };
    if h.len() < 2 || (1..h.len()).all(|j| equal(0, j)) {
        return Symmetry::Rotational;
    }
    let mirrored = |axis: f64| (0..h.len()).all(|j| find(axis - h[j]).is_some_and(|k| equal(j, k)));
    match (mirrored(360.0), mirrored(540.0)) {
        (true, true) => Symmetry::Quadrant,
        (true, false) => Symmetry::C0C180,
        (false, true) => Symmetry::C90C270,
        (false, false) => Symmetry::None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quadrant_unfolds_to_its_mirror_images() {
        let (a, b, c) = ([1.0], [2.0], [3.0]);
        let (h, values) = whole_turn(&[(0.0, &a), (45.0, &b), (90.0, &c)], Symmetry::Quadrant);
        assert_eq!(h, [0.0, 45.0, 90.0, 135.0, 180.0, 225.0, 270.0, 315.0, 360.0]);
        assert_eq!(values, [1.0, 2.0, 3.0, 2.0, 1.0, 2.0, 3.0, 2.0, 1.0]);
        assert_eq!(detect(&h, |j| vec![values[j]]), Symmetry::Quadrant);
    }

    #[test]
    fn planes_from_90_to_270_unfold_about_that_axis() {
        let planes = [[1.0], [2.0], [3.0], [4.0], [5.0]];
        let list: Vec<(f64, &[f64])> = (0..5).map(|i| (90.0 + 45.0 * i as f64, &planes[i][..])).collect();
        let (h, values) = whole_turn(&list, Symmetry::C90C270);
        assert_eq!(h, [0.0, 45.0, 90.0, 135.0, 180.0, 225.0, 270.0, 315.0, 360.0]);
        assert_eq!(values, [3.0, 2.0, 1.0, 2.0, 3.0, 4.0, 5.0, 4.0, 3.0]);
        assert_eq!(detect(&h, |j| vec![values[j]]), Symmetry::C90C270);
    }

    #[test]
    fn a_missing_plane_at_0_is_interpolated() {
        let (a, b) = ([1.0], [2.0]);
        let (h, values) = whole_turn(&[(90.0, &a), (330.0, &b)], Symmetry::None);
        assert_eq!(h, [0.0, 90.0, 330.0, 360.0]);
        assert_eq!(values, [1.75, 1.0, 2.0, 1.75]);
    }
}
