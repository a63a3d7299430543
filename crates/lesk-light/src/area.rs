//! A surface that shines.

use crate::bounds::LightBounds;
use crate::emission_map::EmissionMap;
use crate::error::{LightError, check_color};
use crate::parts::{Extent, Parts};
use crate::sample::{LightSample, Receiver, Target, toward};
use lesk_geometry::{AreaSampler, Geometry, Surface, SurfaceSample, Transform};
use lesk_math::{Color, Vec3};
use std::f64::consts::PI;

/// A diffuse emitter: the same luminance into every direction of its outer side, or of both sides; from every point the
/// same too, unless a mesh has an [`EmissionMap`].
///
/// On a mesh, every rectangle of two triangles and every other triangle is a light of its own for the purpose of choosing;
/// with a map, every triangle.
#[derive(Clone, Debug)]
pub struct Area {
    luminance: Color<f32>,
    two_sided: bool,
    area: f64,
    form: Form,
    map: Option<EmissionMap>,
}

#[derive(Clone, Debug)]
enum Form {
    Whole(Box<AreaSampler>),
    Parts(Parts),
}

impl Area {
    /// A placed geometry of the given luminance in cd/m².
    ///
    /// # Errors
    /// A geometry without area, a luminance that is negative, zero or not finite.
    pub fn new(
        geometry: &Geometry,
        world_from_local: &Transform,
        luminance: Color<f32>,
        two_sided: bool,
    ) -> Result<Self, LightError> {
        check_color("luminance", "cd/m2", luminance)?;
        let sampler = AreaSampler::new(geometry, world_from_local)?;
        let area = sampler.area();
        let form = match geometry.mesh() {
            Some(mesh) => Form::Parts(Parts::rectangles(mesh, world_from_local)),
            None => Form::Whole(Box::new(sampler)),
        };
        Ok(Area { luminance, two_sided, area, form, map: None })
    }

    /// A placed geometry that emits the luminous flux in lm, from both sides together if it is two-sided: L = Φ / (π A).
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn from_flux(
        geometry: &Geometry,
        world_from_local: &Transform,
        flux: Color<f32>,
        two_sided: bool,
    ) -> Result<Self, LightError> {
        check_color("flux", "lm", flux)?;
        let mut light = Self::new(geometry, world_from_local, flux, two_sided)?;
        let sides = if two_sided { 2.0 } else { 1.0 };
        light.luminance = flux * (1.0 / (PI * light.area * sides)) as f32;
        check_color("luminance", "cd/m2", light.luminance)?;
        Ok(light)
    }

    /// A placed mesh of the given luminance in cd/m², multiplied by a picture on it.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn mapped(
        map: EmissionMap,
        world_from_local: &Transform,
        luminance: Color<f32>,
        two_sided: bool,
    ) -> Result<Self, LightError> {
        let light = Self::new(&Geometry::Mesh(map.mesh().clone()), world_from_local, luminance, two_sided)?;
        let form = Form::Parts(Parts::triangles(map.mesh(), world_from_local));
        Ok(Area { form, map: Some(map), ..light })
    }

    /// Luminance, cd/m²; where an emission map is, that of a white texel.
    pub fn luminance(&self) -> Color<f32> {
        self.luminance
    }

    /// Surface area of one side, m².
    pub fn area(&self) -> f64 {
        self.area
    }

    /// Whether both sides shine.
    pub fn two_sided(&self) -> bool {
        self.two_sided
    }

    /// Luminous flux of all sides, lm.
    pub fn flux(&self) -> f32 {
        let sides = if self.two_sided { 2.0 } else { 1.0 };
        let flux = match &self.form {
            Form::Parts(parts) if self.map.is_some() => {
                let of = |(part, extent): (usize, Extent)| f64::from(extent.area * self.mean(part).luminance());
                parts.extents().enumerate().map(of).sum::<f64>()
            }
            _ => self.area * f64::from(self.luminance.luminance()),
        };
        (PI * sides * flux) as f32
    }

    /// Mean luminance of a part, cd/m².
    fn mean(&self, part: usize) -> Color<f32> {
        match (&self.form, &self.map) {
            (Form::Parts(parts), Some(map)) => {
                parts.triangle(part as u32).map_or(self.luminance, |(_, prim)| self.luminance * map.mean(prim as usize))
            }
            _ => self.luminance,
        }
    }

    /// Luminance in cd/m² that leaves the point `p` of part `prim`, with the outer geometric normal `ng`, in direction
    /// `w`.
    #[inline]
    pub fn radiance(&self, prim: u32, p: Vec3<f32>, ng: Vec3<f32>, w: Vec3<f32>) -> Color<f32> {
        if !(self.two_sided || ng.dot(w) > 0.0) {
            return Color::BLACK;
        }
        match &self.map {
            None => self.luminance,
            Some(map) => self.luminance * self.texel(map, prim, p),
        }
    }

    fn texel(&self, map: &EmissionMap, prim: u32, p: Vec3<f32>) -> Color<f32> {
        let Form::Parts(parts) = &self.form else { return Color::WHITE };
        match parts.part_of(prim).and_then(|part| parts.triangle(part)) {
            Some((triangle, _)) => map.at(prim as usize, triangle.weights_at(p)),
            None => Color::BLACK,
        }
    }

    /// How many lights this one is for the purpose of choosing.
    pub(crate) fn part_count(&self) -> usize {
        match &self.form {
            Form::Whole(_) => 1,
            Form::Parts(parts) => parts.len(),
        }
    }

    /// The part that triangle or surface part `prim` of a hit belongs to; `None` for a triangle that vanishes.
    #[inline]
    pub(crate) fn part_of(&self, prim: u32) -> Option<u32> {
        match &self.form {
            Form::Whole(_) => Some(0),
            Form::Parts(parts) => parts.part_of(prim),
        }
    }

    pub(crate) fn sample(&self, part: u32, at: &Receiver, u: [f32; 2]) -> Option<LightSample> {
        let sample = match &self.form {
            Form::Whole(sampler) => sampler.sample_from(at.p, u),
            Form::Parts(parts) => parts.sample_from(part, at.p, u),
        }?;
        self.seen(at, &sample)
    }

    fn seen(&self, at: &Receiver, sample: &SurfaceSample) -> Option<LightSample> {
        let (wi, distance) = toward(at.p, sample.p)?;
        let value = self.radiance(sample.prim, sample.p, sample.n, -wi);
        (value.max_component() > 0.0).then_some(LightSample {
            wi,
            distance,
            value,
            pdf: sample.pdf,
            delta: false,
            light: 0,
            target: Target::Surface(*sample),
        })
    }

    /// The density of [`sample`](Self::sample) for the point that a ray from the receiver hit, 1/sr.
    pub(crate) fn pdf(&self, at: &Receiver, hit: &Surface) -> f32 {
        match &self.form {
            Form::Whole(sampler) => sampler.pdf_from(at.p, hit.prim, hit.p, hit.ng),
            Form::Parts(parts) => parts.pdf_from(at.p, hit.prim, hit.p),
        }
    }

    /// Bounds of every part, in order.
    pub(crate) fn bounds(&self) -> Vec<LightBounds> {
        match &self.form {
            Form::Whole(sampler) => {
                let (axis, spread, share) = match sampler.flat_normal() {
                    Some(n) => (n, 0.0, 1.0),
                    // a convex body shows a quarter of its surface on average
                    None => (Vec3::Z, PI, 0.25),
                };
                let intensity = self.luminance.luminance() * self.area as f32 * share;
                vec![LightBounds::surface(sampler.bounds(), axis, spread, intensity, self.two_sided)]
            }
            Form::Parts(parts) => {
                let of = |(part, extent): (usize, Extent)| {
                    let intensity = self.mean(part).luminance() * extent.area;
                    LightBounds::surface(extent.bounds, extent.normal, 0.0, intensity, self.two_sided)
                };
                parts.extents().enumerate().map(of).collect()
            }
        }
    }
}
