//! The standard observers of the CIE.

use crate::table::{self, Table};

/// First wavelength of the 1931 and 1964 tables, nm.
pub const FIRST_NM: f64 = 360.0;
/// Last wavelength of the tables, nm.
pub const LAST_NM: f64 = 830.0;

/// A standard observer of the CIE: three colour matching functions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Observer {
    /// 1931, 2° field; what film, sRGB and all of Lesk's pictures use.
    Cie1931,
    /// 1964, 10° field.
    Cie1964,
    /// 2°, from the cone fundamentals of 2006 (CIE 170-2:2015); from 390 nm.
    Cie2006Deg2,
    /// 10°, likewise.
    Cie2006Deg10,
}

impl Observer {
    /// All of them, by the names that [`parse`](Self::parse) reads.
    pub const ALL: [(&str, Observer); 4] = [
        ("1931", Observer::Cie1931),
        ("1964", Observer::Cie1964),
        ("2006-2", Observer::Cie2006Deg2),
        ("2006-10", Observer::Cie2006Deg10),
    ];

    /// Reads `1931`, `1964`, `2006-2`, `2006-10`.
    pub fn parse(name: &str) -> Option<Observer> {
        Self::ALL.iter().find(|(known, _)| *known == name.trim()).map(|(_, observer)| *observer)
    }

    fn table(self) -> &'static Table {
        match self {
            Self::Cie1931 => &table::CIE_1931,
            Self::Cie1964 => &table::CIE_1964,
            Self::Cie2006Deg2 => &table::CIE_2006_2,
            Self::Cie2006Deg10 => &table::CIE_2006_10,
        }
    }

    /// The functions x, y, z at a wavelength in nm; linear between the 1 nm steps of the table, zero outside and for NaN.
    pub fn xyz_bar(self, lambda_nm: f64) -> [f64; 3] {
        self.table().triple(lambda_nm)
    }

    /// XYZ of a spectrum per nm, by the trapezoid rule at 1 nm over the table; in the unit of the spectrum times nm,
    /// without K_m.
    pub fn xyz(self, spectrum: impl Fn(f64) -> f64) -> [f64; 3] {
        let (first, last) = (self.table().first_nm() as u32, self.table().last_nm() as u32);
        let mut sum = [0.0; 3];
        for nm in first..=last {
            let weight = if nm == first || nm == last { 0.5 } else { 1.0 };
            let value = spectrum(f64::from(nm)) * weight;
            let row = self.xyz_bar(f64::from(nm));
            for c in 0..3 {
                sum[c] += value * row[c];
            }
        }
        sum
    }
}

/// [`Observer::xyz_bar`] of 1931.
pub fn xyz_bar(lambda_nm: f64) -> [f64; 3] {
    Observer::Cie1931.xyz_bar(lambda_nm)
}

/// [`Observer::xyz`] of 1931.
pub fn xyz(spectrum: impl Fn(f64) -> f64) -> [f64; 3] {
    Observer::Cie1931.xyz(spectrum)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn y_is_one_at_555_nm() {
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
    fn all_observers_see_equal_energy_light_as_white() {
        for (name, observer) in Observer::ALL {
            assert_eq!(Observer::parse(name), Some(observer));
            let [x, y, z] = observer.xyz(|_| 1.0);
            let white = (x / (x + y + z), y / (x + y + z));
            // each is scaled so that E is at 1/3, 1/3; the 1 nm tables keep it to 2e-4
            assert!((white.0 - 1.0 / 3.0).abs() < 2e-4 && (white.1 - 1.0 / 3.0).abs() < 2e-4, "{name}: {white:?}");
        }
    }

    #[test]
    fn equal_energy_light_has_equal_x_y_and_z() {
        // the three functions were scaled to equal sums; the 1 nm table keeps this to 1e-4 (x 106.865, y 106.857, z 106.892)
        let [x, y, z] = xyz(|_| 1.0);
        assert!((x / y - 1.0).abs() < 1e-4 && (z / y - 1.0).abs() < 4e-4, "{x} {y} {z}");
    }
}
