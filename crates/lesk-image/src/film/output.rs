//! Means, variances and layers of a film.

use super::{ALBEDO, COUNT, DEPTH, Film, HITS, MATERIAL, NORMAL, OBJECT, SQUARES, SUM};
use crate::image::{Image, Transfer};
use crate::{ImageError, Planes, Samples};
use rayon::prelude::*;

impl Film {
    /// Samples that a pixel holds.
    ///
    /// # Panics
    /// Outside the film.
    pub fn sample_count(&self, x: u32, y: u32) -> u64 {
        self.record(x, y)[COUNT] as u64
    }

    /// Mean light of a pixel: linear Rec.709 whose Y is cd/m²; black without samples.
    ///
    /// # Panics
    /// Outside the film.
    pub fn mean(&self, x: u32, y: u32) -> [f64; 3] {
        mean(self.record(x, y), SUM)
    }

    /// Variance of that mean, per channel: the sample variance over the number of samples, (cd/m²)²; zero with fewer than
    /// two samples.
    ///
    /// # Panics
    /// Outside the film.
    pub fn variance(&self, x: u32, y: u32) -> [f64; 3] {
        variance(self.record(x, y))
    }

    /// Mean of one split layer in a pixel, cd/m².
    ///
    /// # Panics
    /// Outside the film or its split layers.
    pub fn split(&self, layer: usize, x: u32, y: u32) -> [f64; 3] {
        assert!(layer < self.layout.splits, "no split layer {layer}");
        mean(self.record(x, y), self.layout.split(layer))
    }

    /// Means of all pixels: linear Rec.709 whose Y is cd/m².
    pub fn image(&self) -> Image {
        let data = self.records().flat_map(|r| mean(r, SUM)).map(|v| v as f32).collect();
        Image::new(self.width(), self.height(), 3, Transfer::Linear, data).expect("a film has a legal size")
    }

    /// Relative standard error of the picture: the root of the mean variance over the mean luminance of all pixels, from
    /// the green channel; `None` while the picture is black or a pixel has fewer than two samples.
    pub fn relative_error(&self) -> Option<f64> {
        let (mut sum, mut variances) = (0.0, 0.0);
        for record in self.records() {
            if record[COUNT] < 2.0 {
                return None;
            }
            sum += mean(record, SUM)[1];
            variances += variance(record)[1];
        }
        let pixels = self.data.len() as f64 / self.layout.stride() as f64;
        (sum > 0.0).then(|| (variances / pixels).sqrt() / (sum / pixels))
    }

    /// All layers, for an EXR file: `R G B`, `variance.*`, `samples.Y`, with AOVs `albedo.*`, `normal.*`, `depth.Z` and
    /// `id.object`, `id.material`, and one layer per split.
    ///
    /// The text attributes say unit and meaning; `settings` follow them. Neither clock nor host is among them.
    ///
    /// # Errors
    /// Memory that is not there.
    pub fn planes(&self, settings: &[(&str, &str)]) -> Result<Planes, ImageError> {
        let mut planes = Planes::new(self.width(), self.height())?;
        planes.white_luminance = Some(1.0);
        let own = [
            ("unit", "cd/m2"),
            ("colorspace", "linear Rec.709, luminance Y in cd/m2"),
            ("variance", "variance of the mean, (cd/m2)^2"),
        ];
        planes.attributes = own.iter().chain(settings).map(|(n, v)| ((*n).to_string(), (*v).to_string())).collect();
        self.push_color(&mut planes, "", |r| mean(r, SUM))?;
        self.push_color(&mut planes, "variance", variance)?;
        self.push_float(&mut planes, "samples.Y", |r| r[COUNT])?;
        for (i, name) in self.spec.splits.iter().enumerate() {
            self.push_color(&mut planes, name, |r| mean(r, self.layout.split(i)))?;
        }
        if self.layout.aovs {
            self.push_aovs(&mut planes)?;
        }
        Ok(planes)
    }

    fn push_aovs(&self, planes: &mut Planes) -> Result<(), ImageError> {
        self.push_color(planes, "albedo", |r| mean(r, ALBEDO))?;
        for (c, name) in ["normal.X", "normal.Y", "normal.Z"].into_iter().enumerate() {
            self.push_float(planes, name, |r| normal(r)[c])?;
        }
        self.push_float(planes, "depth.Z", |r| if r[HITS] > 0.0 { r[DEPTH] / r[HITS] } else { 0.0 })?;
        for (name, at) in [("id.object", OBJECT), ("id.material", MATERIAL)] {
            planes.push(name, Samples::Uint(self.records().map(|r| r[at] as u32).collect()))?;
        }
        Ok(())
    }

    fn push_color(
        &self,
        planes: &mut Planes,
        layer: &str,
        color: impl Fn(&[f64]) -> [f64; 3] + Sync,
    ) -> Result<(), ImageError> {
        for (c, channel) in ["R", "G", "B"].into_iter().enumerate() {
            let name = if layer.is_empty() { channel.to_string() } else { format!("{layer}.{channel}") };
            self.push_float(planes, &name, |r| color(r)[c])?;
        }
        Ok(())
    }

    fn push_float(
        &self,
        planes: &mut Planes,
        name: &str,
        value: impl Fn(&[f64]) -> f64 + Sync,
    ) -> Result<(), ImageError> {
        let records = self.data.par_chunks_exact(self.layout.stride());
        planes.push(name, Samples::Float(records.map(|r| value(r) as f32).collect()))
    }

    fn record(&self, x: u32, y: u32) -> &[f64] {
        let at = self.at(x, y);
        &self.data[at..at + self.layout.stride()]
    }

    fn records(&self) -> impl Iterator<Item = &[f64]> {
        self.data.chunks_exact(self.layout.stride())
    }
}

fn mean(record: &[f64], at: usize) -> [f64; 3] {
    let n = record[COUNT];
    if n == 0.0 { [0.0; 3] } else { [0, 1, 2].map(|c| record[at + c] / n) }
}

fn variance(record: &[f64]) -> [f64; 3] {
    let n = record[COUNT];
    if n < 2.0 {
        return [0.0; 3];
    }
    // the difference cancels for a constant pixel: never negative
    [0, 1, 2].map(|c| {
        let spread = record[SQUARES + c] - record[SUM + c] * record[SUM + c] / n;
        spread.max(0.0) / (n - 1.0) / n
    })
}

/// The direction of the summed normals, zero where nothing was hit or they cancel.
fn normal(record: &[f64]) -> [f64; 3] {
    let sum = [0, 1, 2].map(|c| record[NORMAL + c]);
    let length = (sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]).sqrt();
    if length > 0.0 { sum.map(|v| v / length) } else { [0.0; 3] }
}
