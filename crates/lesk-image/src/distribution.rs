//! Piecewise-constant densities over 0..1 and 0..1 x 0..1: sample and pdf, by inversion, so that evenly spread numbers
//! stay evenly spread.
//!
//! The density is read from the very table that is searched: sample and pdf agree exactly, whatever was rounded.

use crate::ImageError;

/// A density over 0..1 in cells of equal width.
#[derive(Clone, Debug, PartialEq)]
pub struct Distribution1D {
    /// Sums of the weights from the left over the whole: n + 1 entries, first 0, last 1.
    cdf: Vec<f64>,
    /// A power of two plus one entries: where the search for u in i / guides .. (i + 1) / guides begins and ends.
    guide: Vec<u32>,
    mean: f64,
}

impl Distribution1D {
    /// The density that is proportional to `weights`; uniform where all are zero.
    ///
    /// # Errors
    /// No weight, one that is negative or not finite, or a sum that overflows.
    pub fn new(weights: impl IntoIterator<Item = f64>) -> Result<Distribution1D, ImageError> {
        let mut cdf = vec![0.0];
        for (i, weight) in weights.into_iter().enumerate() {
            let sum = cdf[i] + weight;
            if !(weight >= 0.0 && sum.is_finite()) {
                return Err(ImageError::invalid(format!(
                    "weight {i} is {weight}, but finite and not negative is accepted"
                )));
            }
            cdf.push(sum);
        }
        let n = cdf.len() - 1;
        if n == 0 || n > u32::MAX as usize {
            return Err(ImageError::invalid(format!("{n} weights, but 1 to {} are accepted", u32::MAX)));
        }
        let sum = cdf[n];
        for (i, entry) in cdf.iter_mut().enumerate() {
            *entry = if sum > 0.0 { *entry / sum } else { i as f64 / n as f64 };
        }
        let guides = n.next_power_of_two();
        let guide = (0..=guides).map(|i| cell_of(&cdf, i as f64 / guides as f64, 0, n - 1) as u32).collect();
        Ok(Distribution1D { cdf, guide, mean: sum / n as f64 })
    }

    /// The number of cells.
    pub fn len(&self) -> usize {
        self.cdf.len() - 1
    }

    /// Never: a distribution has at least one cell.
    pub fn is_empty(&self) -> bool {
        false
    }

    /// The mean of the weights, which is their integral over 0..1.
    pub fn mean(&self) -> f64 {
        self.mean
    }

    /// The probability of a cell.
    ///
    /// # Panics
    /// Beyond the last cell.
    pub fn probability(&self, cell: usize) -> f64 {
        self.cdf[cell + 1] - self.cdf[cell]
    }

    /// The cell of a uniform number `u` in 0..1, and the number stretched within the cell to 0..1, for another use.
    pub fn sample_cell(&self, u: f64) -> (usize, f64) {
        let guides = self.guide.len() - 1;
        let i = ((u * guides as f64) as usize).min(guides - 1);
        let cell = cell_of(&self.cdf, u, self.guide[i] as usize, self.guide[i + 1] as usize);
        let rest = (u - self.cdf[cell]) / self.probability(cell).max(f64::MIN_POSITIVE);
        (cell, rest.clamp(0.0, 1.0 - f64::EPSILON / 2.0))
    }

    /// A place in 0..1 and its density.
    pub fn sample(&self, u: f64) -> (f64, f64) {
        let (cell, rest) = self.sample_cell(u);
        (place(cell, rest, self.len()), self.probability(cell) * self.len() as f64)
    }

    /// The density at a place in 0..1; zero outside and for NaN.
    pub fn pdf(&self, x: f64) -> f64 {
        if !(0.0..1.0).contains(&x) {
            return 0.0;
        }
        self.probability(((x * self.len() as f64) as usize).min(self.len() - 1)) * self.len() as f64
    }
}

/// A density over 0..1 x 0..1 in equal cells: rows are chosen first, then columns.
#[derive(Clone, Debug, PartialEq)]
pub struct Distribution2D {
    rows: Distribution1D,
    columns: usize,
    /// For each row `columns + 1` sums, in f32: half the memory of a large map; sample and pdf read the same table.
    cdf: Vec<f32>,
    /// For each row `guides + 1` cells: where the search for u in i / guides .. (i + 1) / guides begins and ends. A search of
    /// the whole row costs a dozen cache misses in a large map.
    guide: Vec<u16>,
    /// A power of two, so that u * guides is exact.
    guides: usize,
}

impl Distribution2D {
    /// The density that is proportional to `weights`, row by row; uniform where all are zero.
    ///
    /// # Errors
    /// Another count than `columns * rows`, none, more than 65536 columns, weights that are negative or not finite, memory that is not there.
    pub fn new(columns: usize, rows: usize, weights: &[f32]) -> Result<Distribution2D, ImageError> {
        if columns == 0 || columns > 1 << 16 || columns.checked_mul(rows) != Some(weights.len()) {
            let what = format!("{} weights for {columns} x {rows} cells", weights.len());
            return Err(ImageError::invalid(what));
        }
        if let Some(i) = weights.iter().position(|w| !(*w >= 0.0 && w.is_finite())) {
            let (x, y) = (i % columns, i / columns);
            let what = format!("weight ({x}, {y}) is {}, but finite and not negative is accepted", weights[i]);
            return Err(ImageError::invalid(what));
        }
        let mut cdf = crate::image::zeros("distribution", (columns + 1) * rows)?;
        let guides = (columns / 8).max(1).next_power_of_two();
        let mut guide = Vec::with_capacity((guides + 1) * rows);
        let mut sums = Vec::with_capacity(rows);
        for (row, out) in weights.chunks_exact(columns).zip(cdf.chunks_exact_mut(columns + 1)) {
            sums.push(fill_row(row, out));
            let last = columns - 1;
            guide.extend((0..=guides).map(|i| cell_of(out, i as f32 / guides as f32, 0, last) as u16));
        }
        Ok(Distribution2D { rows: Distribution1D::new(sums)?, columns, cdf, guide, guides })
    }

    /// Cells per row and rows.
    pub fn size(&self) -> (usize, usize) {
        (self.columns, self.rows.len())
    }

    /// The mean of the weights, which is their integral over 0..1 x 0..1.
    pub fn mean(&self) -> f64 {
        self.rows.mean() / self.columns as f64
    }

    /// A place in 0..1 x 0..1 for two uniform numbers, and its density per unit area.
    pub fn sample(&self, u: [f64; 2]) -> ([f64; 2], f64) {
        let (row, rest) = self.rows.sample_cell(u[1]);
        let cdf = self.row(row);
        let column = self.column(row, u[0] as f32);
        let (low, high) = (f64::from(cdf[column]), f64::from(cdf[column + 1]));
        let within = ((u[0] - low) / (high - low).max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        let at = [place(column, within, self.columns), place(row, rest, self.rows.len())];
        (at, self.cell_pdf(column, row))
    }

    /// The density per unit area at a place; zero outside and for NaN.
    pub fn pdf(&self, [x, y]: [f64; 2]) -> f64 {
        if !((0.0..1.0).contains(&x) && (0.0..1.0).contains(&y)) {
            return 0.0;
        }
        let column = ((x * self.columns as f64) as usize).min(self.columns - 1);
        let row = ((y * self.rows.len() as f64) as usize).min(self.rows.len() - 1);
        self.cell_pdf(column, row)
    }

    fn column(&self, row: usize, u: f32) -> usize {
        let guide = &self.guide[row * (self.guides + 1)..][..self.guides + 1];
        let i = ((u * self.guides as f32) as usize).min(self.guides - 1);
        cell_of(self.row(row), u, guide[i].into(), guide[i + 1].into())
    }

    fn cell_pdf(&self, column: usize, row: usize) -> f64 {
        let cdf = self.row(row);
        let within = f64::from(cdf[column + 1]) - f64::from(cdf[column]);
        self.rows.probability(row) * within * self.rows.len() as f64 * self.columns as f64
    }

    fn row(&self, row: usize) -> &[f32] {
        &self.cdf[row * (self.columns + 1)..(row + 1) * (self.columns + 1)]
    }
}

/// Fills the sums of one row, first 0 and last 1, and returns the sum of its weights.
fn fill_row(weights: &[f32], cdf: &mut [f32]) -> f64 {
    let total: f64 = weights.iter().map(|w| f64::from(*w)).sum();
    let mut sum = 0.0;
    for (i, weight) in weights.iter().enumerate() {
        sum += f64::from(*weight);
        let share = if total > 0.0 { sum / total } else { (i + 1) as f64 / weights.len() as f64 };
        cdf[i + 1] = share as f32;
    }
    total
}

/// The first of the cells `first..=last` that ends above `u`; the last one with any weight if none does.
fn cell_of<T: PartialOrd + Copy>(cdf: &[T], u: T, first: usize, last: usize) -> usize {
    // the ends of the cells follow the first entry
    let mut cell = (first + cdf[first + 1..=last + 1].partition_point(|end| *end <= u)).min(last);
    // u = 1 points behind the last cell that has any weight
    while cell > 0 && cdf[cell] >= cdf[cell + 1] {
        cell -= 1;
    }
    cell
}

/// A place within a cell of `n`: rounding does not bring it to the next cell.
fn place(cell: usize, within: f64, n: usize) -> f64 {
    ((cell as f64 + within) / n as f64).min(((cell + 1) as f64 / n as f64).next_down())
}

#[cfg(test)]
#[path = "distribution_tests.rs"]
mod tests;
