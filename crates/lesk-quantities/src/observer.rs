//! The CIE 1931 2° standard observer.

use std::sync::LazyLock;

/// First wavelength of the table, nm.
pub const FIRST_NM: f64 = 360.0;
/// Last wavelength of the table, nm.
pub const LAST_NM: f64 = 830.0;

/// `data/cie/PROVENANCE.md` says where the numbers come from.
const TABLE: &str = include_str!("../../../data/cie/cie1931_2deg_1nm.csv");

static ROWS: LazyLock<Vec<[f64; 3]>> = LazyLock::new(|| TABLE.lines().skip(1).map(row).collect());

/// The three functions of one line `nm,x,y,z`.
fn row(line: &str) -> [f64; 3] {
    let mut numbers = line.split(',').skip(1).map(|n| n.parse().expect("data/cie holds numbers"));
    [(); 3].map(|()| numbers.next().expect("data/cie has four columns"))
}

/// The colour matching functions x, y, z at a wavelength in nm; linear between the 1 nm steps of the table,
/// zero outside 360 to 830 nm and for NaN.
pub fn xyz_bar(lambda_nm: f64) -> [f64; 3] {
    if !(FIRST_NM..=LAST_NM).contains(&lambda_nm) {
        return [0.0; 3];
    }
    let at = lambda_nm - FIRST_NM;
    let i = (at as usize).min(ROWS.len() - 2);
    let t = at - i as f64;
    [0, 1, 2].map(|c| ROWS[i][c] * (1.0 - t) + ROWS[i + 1][c] * t)
}

/// XYZ of a spectrum per nm, by the trapezoid rule at 1 nm from 360 to 830 nm; in the unit of the spectrum times nm,
/// without K_m.
pub fn xyz(spectrum: impl Fn(f64) -> f64) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for (i, row) in ROWS.iter().enumerate() {
        let end = i == 0 || i + 1 == ROWS.len();
        let value = spectrum(FIRST_NM + i as f64) * if end { 0.5 } else { 1.0 };
        for c in 0..3 {
            sum[c] += value * row[c];
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn table_has_471_rows_and_y_is_one_at_555_nm() {
        assert_eq!(ROWS.len(), 471);
        assert_eq!(xyz_bar(555.0)[1], 1.0);
        assert_eq!(xyz_bar(600.0), [1.0622, 0.631, 0.0008]); // CIE 018, table of 1931
    }

    #[test]
    fn table_ends_are_inside_and_everything_else_is_zero() {
        assert_eq!(xyz_bar(360.0)[1], 3.917e-6);
        assert_eq!(xyz_bar(830.0)[1], 4.5181e-7);
        for outside in [359.999, 830.001, f64::NAN, f64::INFINITY, -1.0] {
            assert_eq!(xyz_bar(outside), [0.0; 3]);
        }
    }

    #[test]
    fn halfway_between_two_rows_is_their_mean() {
        let (a, b, m) = (xyz_bar(500.0), xyz_bar(501.0), xyz_bar(500.5));
        for c in 0..3 {
            assert!((m[c] - 0.5 * (a[c] + b[c])).abs() <= 2.0 * f64::EPSILON);
        }
    }

    #[test]
    fn equal_energy_light_has_equal_x_y_and_z() {
        // the three functions were scaled to equal sums; the 1 nm table keeps this to 1e-4 (x 106.865, y 106.857, z 106.892)
        let [x, y, z] = xyz(|_| 1.0);
        assert!((x / y - 1.0).abs() < 1e-4 && (z / y - 1.0).abs() < 4e-4, "{x} {y} {z}");
    }
}
