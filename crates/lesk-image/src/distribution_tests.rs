use super::*;
use proptest::prelude::*;

/// A weight table with zeros, at the ends too.
const WEIGHTS: [f64; 8] = [0.0, 3.0, 1.0, 0.0, 0.0, 4.0, 2.0, 0.0];

#[test]
fn probabilities_are_the_weights_over_their_sum() {
    let d = Distribution1D::new(WEIGHTS).unwrap();
    for (i, w) in WEIGHTS.iter().enumerate() {
        assert!((d.probability(i) - w / 10.0).abs() < 1e-15);
    }
    assert!((d.mean() - 1.25).abs() < 1e-15);
}

#[test]
fn samples_invert_the_distribution_and_never_fall_into_an_empty_cell() {
    let d = Distribution1D::new(WEIGHTS).unwrap();
    for i in 0..=10_000 {
        let u = f64::from(i) / 10_000.0;
        let (x, pdf) = d.sample(u);
        assert!(pdf > 0.0 && pdf == d.pdf(x), "{u}");
        // closed form: the integral of the density below x is u
        let cell = (x * 8.0) as usize;
        let below = WEIGHTS[..cell].iter().sum::<f64>() / 10.0 + (x * 8.0 - cell as f64) * WEIGHTS[cell] / 10.0;
        assert!((below - u).abs() < 1e-12, "{u}: {x}");
    }
}

#[test]
fn numbers_at_the_border_of_two_cells_go_to_the_right_one() {
    let d = Distribution1D::new([1.0, 1.0]).unwrap();
    assert_eq!(d.sample_cell(0.0), (0, 0.0));
    assert_eq!(d.sample_cell(0.5), (1, 0.0));
    assert_eq!(d.sample_cell(1.0).0, 1);
}

#[test]
fn weights_that_are_all_zero_give_the_uniform_density() {
    let d = Distribution1D::new([0.0; 4]).unwrap();
    assert_eq!((d.pdf(0.9), d.mean()), (1.0, 0.0));
    let d = Distribution2D::new(3, 2, &[0.0; 6]).unwrap();
    assert!((d.pdf([0.9, 0.1]) - 1.0).abs() < 1e-6); // f32 thirds
}

#[test]
fn illegal_weights_are_refused() {
    for bad in [-1.0, f64::NAN, f64::INFINITY] {
        assert!(Distribution1D::new([1.0, bad]).is_err());
        assert!(Distribution2D::new(2, 1, &[1.0, bad as f32]).is_err());
    }
    assert!(Distribution1D::new([]).is_err());
    assert!(Distribution1D::new([f64::MAX, f64::MAX]).is_err());
    assert!(Distribution2D::new(2, 2, &[1.0; 3]).is_err() && Distribution2D::new(0, 0, &[]).is_err());
}

/// A smooth map with one bright cell, as a sky with a sun.
fn sky(columns: usize, rows: usize) -> Vec<f32> {
    let mut weights: Vec<f32> =
        (0..columns * rows).map(|i| (i % columns) as f32 * 0.01 + (i / columns) as f32).collect();
    weights[columns * (rows / 2) + columns / 3] = 1e4;
    weights[3] = 0.0;
    weights
}

#[test]
fn density_in_two_dimensions_integrates_to_one() {
    let (columns, rows) = (37, 19);
    let d = Distribution2D::new(columns, rows, &sky(columns, rows)).unwrap();
    let mut sum = 0.0;
    for i in 0..columns * rows {
        let at = [((i % columns) as f64 + 0.5) / columns as f64, ((i / columns) as f64 + 0.5) / rows as f64];
        sum += d.pdf(at) / (columns * rows) as f64;
    }
    assert!((sum - 1.0).abs() < 1e-12);
}

#[test]
fn cell_counts_in_two_dimensions_agree_with_the_weights() {
    let (columns, rows) = (16, 8);
    let weights = sky(columns, rows);
    let sum = |weights: &[f32]| weights.iter().map(|w| f64::from(*w)).sum::<f64>();
    let total = sum(&weights);
    let d = Distribution2D::new(columns, rows, &weights).unwrap();
    assert!((d.mean() - total / 128.0).abs() < 1e-6 * d.mean());
    let n = 1024;
    let mut counts = vec![0u32; columns * rows];
    for i in 0..n * n {
        let u = [(f64::from(i % n) + 0.5) / f64::from(n), (f64::from(i / n) + 0.5) / f64::from(n)];
        let ([x, y], pdf) = d.sample(u);
        assert!(pdf > 0.0 && pdf == d.pdf([x, y]));
        counts[(y * rows as f64) as usize * columns + (x * columns as f64) as usize] += 1;
    }
    let n = f64::from(n);
    for (i, (count, weight)) in counts.iter().zip(&weights).enumerate() {
        let row = sum(&weights[i / columns * columns..][..columns]);
        let (p_row, p_column) = (row / total, f64::from(*weight) / row);
        // of n evenly spread numbers a share p meets p n, give or take one, in rows and in columns
        let bound = (p_row + p_column) / n + 1.0 / (n * n);
        assert!((f64::from(*count) / (n * n) - p_row * p_column).abs() <= bound, "{i}: {count} {weight}");
    }
}

proptest! {
    #[test]
    fn sample_and_pdf_agree_for_any_weights(
        weights in prop::collection::vec(prop_oneof![Just(0.0f32), 0.0f32..1.0, 1e20f32..1e30, 1e-38f32..1e-30], 12),
        u in prop::array::uniform2(0.0f64..=1.0),
    ) {
        let d = Distribution2D::new(4, 3, &weights).unwrap();
        let (at, pdf) = d.sample(u);
        prop_assert!(pdf > 0.0 && pdf.is_finite() && at.iter().all(|v| (0.0..1.0).contains(v)));
        // a place at the very border of a cell may round into its neighbour
        let border = at.iter().zip([4.0, 3.0]).any(|(v, n)| { let f = (v * n).fract(); !(1e-9..=1.0 - 1e-9).contains(&f) });
        prop_assert!(border || d.pdf(at) == pdf);
    }
}
