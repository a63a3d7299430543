//! Tables of `data/`: a column of wavelengths at equal steps, then one column per spectrum.

use std::sync::LazyLock;

/// Numbers at equal steps of wavelength.
pub(crate) struct Table {
    pub names: Vec<&'static str>,
    first_nm: f64,
    step_nm: f64,
    rows: Vec<Vec<f64>>,
}

impl Table {
    /// Reads one of the project's own tables; `data/cie/PROVENANCE.md` says where the numbers come from.
    fn read(text: &'static str) -> Table {
        let mut lines = text.lines();
        let names = lines.next().expect("a table has a head").split(',').skip(1).collect();
        let row =
            |line: &str| -> Vec<f64> { line.split(',').map(|n| n.parse().expect("data holds numbers")).collect() };
        let rows: Vec<Vec<f64>> = lines.map(row).collect();
        Table { names, first_nm: rows[0][0], step_nm: rows[1][0] - rows[0][0], rows }
    }

    pub fn first_nm(&self) -> f64 {
        self.first_nm
    }

    pub fn last_nm(&self) -> f64 {
        self.first_nm + self.step_nm * (self.rows.len() - 1) as f64
    }

    /// Place of the row at or below a wavelength and the share of the next one; `None` outside the table and for NaN.
    fn place(&self, lambda_nm: f64) -> Option<(usize, f64)> {
        if !(self.first_nm..=self.last_nm()).contains(&lambda_nm) {
            return None;
        }
        let at = (lambda_nm - self.first_nm) / self.step_nm;
        let i = (at as usize).min(self.rows.len() - 2);
        Some((i, at - i as f64))
    }

    /// A column at a wavelength: linear between the rows, zero outside.
    pub fn at(&self, column: usize, lambda_nm: f64) -> f64 {
        self.place(lambda_nm).map_or(0.0, |(i, t)| self.mix(column, i, t))
    }

    /// The first three columns likewise.
    pub fn triple(&self, lambda_nm: f64) -> [f64; 3] {
        self.place(lambda_nm).map_or([0.0; 3], |(i, t)| [0, 1, 2].map(|c| self.mix(c, i, t)))
    }

    fn mix(&self, column: usize, i: usize, t: f64) -> f64 {
        self.rows[i][column + 1] * (1.0 - t) + self.rows[i + 1][column + 1] * t
    }
}

macro_rules! tables {
    ($($(#[$doc:meta])* $name:ident = $file:literal;)+) => {
        $($(#[$doc])* pub(crate) static $name: LazyLock<Table> =
            LazyLock::new(|| Table::read(include_str!(concat!("../../../data/cie/", $file))));)+
    };
}

tables! {
    CIE_1931 = "cie1931_2deg_1nm.csv";
    CIE_1964 = "cie1964_10deg_1nm.csv";
    CIE_2006_2 = "cie2006_2deg_1nm.csv";
    CIE_2006_10 = "cie2006_10deg_1nm.csv";
    SCOTOPIC = "scotopic_1nm.csv";
    ILLUMINANTS = "illuminants_5nm.csv";
    DAYLIGHT = "daylight_5nm.csv";
    TEST_COLOURS = "test_colours_5nm.csv";
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_have_equal_steps_and_as_many_numbers_as_names() {
        let all = [&CIE_1931, &CIE_1964, &CIE_2006_2, &CIE_2006_10, &SCOTOPIC, &ILLUMINANTS, &DAYLIGHT, &TEST_COLOURS];
        for table in all {
            for (i, row) in table.rows.iter().enumerate() {
                assert_eq!(row.len(), table.names.len() + 1);
                assert_eq!(row[0], table.first_nm + table.step_nm * i as f64);
            }
        }
    }
}
