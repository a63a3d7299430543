//! A surface that shines.

use crate::bounds::LightBounds;
use crate::emission_map::EmissionMap;
use crate::error::{LightError, check_color};
use crate::sample::{LightSample, Receiver, Target, toward};
use crate::triangle::Triangle;
use lesk_geometry::{AreaSampler, Bounds, Geometry, Surface, SurfaceSample, Transform};
use lesk_math::{Color, Vec3};
use std::f64::consts::PI;

/// A diffuse emitter: the same luminance into every direction of its outer side, or of both sides; from every point the
/// same too, unless a mesh has an [`EmissionMap`].
///
/// On a mesh, every triangle is a light of its own for the purpose of choosing.
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
    /// The triangles of a mesh; `None` for one that vanishes.
    Triangles(Vec<Option<Triangle>>),
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
        let form = match geometry {
            Geometry::Mesh(mesh) => {
                let triangle = |i| Triangle::new(mesh, i, world_from_local);
                Form::Triangles((0..mesh.triangles().len()).map(triangle).collect())
            }
            _ => Form::Whole(Box::new(sampler)),
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

    /// The same light with its luminance multiplied by a picture on its mesh.
    ///
    /// # Errors
    /// A light that is no mesh, or not the mesh of the map.
    pub fn with_map(mut self, map: EmissionMap) -> Result<Self, LightError> {
        match &self.form {
            Form::Triangles(triangles) if triangles.len() == map.len() => {
                self.map = Some(map);
                Ok(self)
            }
            _ => Err(LightError::new("an emission map needs the mesh that it lies on")),
        }
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
        let area = match (&self.form, &self.map) {
            (Form::Triangles(triangles), Some(map)) => {
                let lit = |(i, t): (usize, &Option<Triangle>)| {
                    t.as_ref().map_or(0.0, |t| f64::from(t.area() * (self.luminance * map.mean(i)).luminance()))
                };
                return (PI * sides * triangles.iter().enumerate().map(lit).sum::<f64>()) as f32;
            }
            _ => self.area,
        };
        (PI * area * sides) as f32 * self.luminance.luminance()
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
        match &self.form {
            Form::Triangles(triangles) => match triangles.get(prim as usize).and_then(Option::as_ref) {
                Some(triangle) => map.at(prim as usize, triangle.weights_at(p)),
                None => Color::BLACK,
            },
            Form::Whole(_) => Color::WHITE,
        }
    }

    /// How many lights this one is for the purpose of choosing.
    pub(crate) fn part_count(&self) -> usize {
        match &self.form {
            Form::Whole(_) => 1,
            Form::Triangles(triangles) => triangles.len(),
        }
    }

    /// The part that triangle or surface part `prim` of a hit belongs to.
    #[inline]
    pub(crate) fn part_of(&self, prim: u32) -> u32 {
        match self.form {
            Form::Whole(_) => 0,
            Form::Triangles(_) => prim,
        }
    }

    pub(crate) fn sample(&self, part: u32, at: &Receiver, u: [f32; 2]) -> Option<LightSample> {
        let sample = match &self.form {
            Form::Whole(sampler) => sampler.sample_from(at.p, u),
            Form::Triangles(triangles) => triangles[part as usize].as_ref()?.sample_from(at.p, part, u),
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
            Form::Triangles(triangles) => {
                triangles.get(hit.prim as usize).and_then(Option::as_ref).map_or(0.0, |t| t.pdf_from(at.p, hit.p))
            }
        }
    }

    /// Bounds of every part, in order.
    pub(crate) fn bounds(&self) -> Vec<LightBounds> {
        let luminance = self.luminance.luminance();
        match &self.form {
            Form::Whole(sampler) => {
                let (axis, spread, share) = match sampler.flat_normal() {
                    Some(n) => (n, 0.0, 1.0),
                    // a convex body shows a quarter of its surface on average
                    None => (Vec3::Z, PI, 0.25),
                };
                let intensity = luminance * self.area as f32 * share;
                vec![LightBounds::surface(sampler.bounds(), axis, spread, intensity, self.two_sided)]
            }
            Form::Triangles(triangles) => {
                let luminance_of = |i| match &self.map {
                    Some(map) => (self.luminance * map.mean(i)).luminance(),
                    None => luminance,
                };
                let bounds =
                    |(i, t): (usize, &Option<Triangle>)| triangle_bounds(t.as_ref(), luminance_of(i), self.two_sided);
                triangles.iter().enumerate().map(bounds).collect()
            }
        }
    }
}

fn triangle_bounds(triangle: Option<&Triangle>, luminance: f32, two_sided: bool) -> LightBounds {
    let Some(triangle) = triangle else { return LightBounds::everywhere(Vec3::ZERO, 0.0) };
    let mut bounds = Bounds::EMPTY;
    triangle.corners().into_iter().for_each(|c| bounds.add(c));
    LightBounds::surface(bounds, triangle.normal(), 0.0, luminance * triangle.area(), two_sided)
}
