//! A picture on a sphere, disk, rectangle or cylinder.

use super::{Mean, Picture};
use crate::error::LightError;
use lesk_geometry::{AreaSampler, Geometry, SurfaceSample, Transform};
use lesk_image::distribution::Distribution2D;
use lesk_math::{Color, Vec3};

/// Cells along each side of the texture coordinates: fewer would not see how the area varies over a sphere.
const LEAST_CELLS: usize = 64;
/// More are not needed to choose well.
const MOST_CELLS: usize = 2048;

/// The distribution of light over the texture coordinates; parts lie above one another.
#[derive(Clone, Debug)]
pub(crate) struct ShapeMap {
    distribution: Distribution2D,
    sampler: Box<AreaSampler>,
    pub mean: Color<f32>,
}

impl ShapeMap {
    pub fn new(picture: &Picture, geometry: &Geometry, place: &Transform) -> Result<Self, LightError> {
        let sampler = Box::new(AreaSampler::new(geometry, place)?);
        let parts = sampler.uv_parts() as usize;
        let [columns, rows] = picture.cells().map(|n| {
            // whole numbers of cells per texel, so that their mean is that of the texels
            let n = n.clamp(1, MOST_CELLS);
            n * LEAST_CELLS.div_ceil(n)
        });
        let mut weights = Vec::with_capacity(columns * rows * parts);
        let mut mean = Mean::default();
        for row in 0..rows * parts {
            let v = ((row % rows) as f64 + 0.5) / rows as f64;
            for column in 0..columns {
                let uv = [(column as f64 + 0.5) / columns as f64, v];
                let value = picture.at(uv.map(|x| x as f32));
                let share = sampler.at_uv((row / rows) as u32, uv).map_or(0.0, |s| 1.0 / f64::from(s.pdf));
                mean.add(value, share);
                weights.push((f64::from(value.luminance()) * share) as f32);
            }
        }
        let distribution =
            Distribution2D::new(columns, rows * parts, &weights).map_err(|e| LightError::new(e.to_string()))?;
        Ok(ShapeMap { distribution, sampler, mean: mean.color() })
    }

    fn parts(&self) -> u32 {
        self.sampler.uv_parts()
    }

    /// The part of a hit.
    fn part(&self, prim: u32) -> u32 {
        if self.parts() > 1 { prim } else { 0 }
    }

    pub fn uv(&self, prim: u32, p: Vec3<f32>) -> [f32; 2] {
        self.sampler.uv_of(self.part(prim), p).map(|x| x as f32)
    }

    /// A point of the surface where the picture is bright.
    pub fn sample(&self, u: [f32; 2]) -> Option<SurfaceSample> {
        let ([x, y], _) = self.distribution.sample(u.map(f64::from));
        let stacked = y * f64::from(self.parts());
        let part = (stacked as u32).min(self.parts() - 1);
        self.sampler.at_uv(part, [x, stacked - f64::from(part)])
    }

    /// The density of [`sample`](Self::sample), 1/m².
    pub fn pdf(&self, prim: u32, p: Vec3<f32>) -> f32 {
        let part = self.part(prim);
        let [u, v] = self.sampler.uv_of(part, p).map(|x| x.clamp(0.0, 1.0 - f64::EPSILON));
        let place = (f64::from(part) + v) / f64::from(self.parts());
        let per_uv =
            self.distribution.pdf([u, place]) * self.sampler.at_uv(part, [u, v]).map_or(0.0, |s| f64::from(s.pdf));
        (per_uv / f64::from(self.parts())) as f32
    }
}
