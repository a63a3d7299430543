//! A surface that shines.

use crate::body::Body;
use crate::bounds::LightBounds;
use crate::emission_map::{Carrier, EmissionMap, MeshMap, ShapeMap};
use crate::error::{LightError, check_color};
use crate::parts::{Extent, Parts};
use crate::rectangle::Rectangle;
use crate::sample::{LightSample, Receiver, Target, per_steradian, toward};
use crate::triangle::Triangle;
use lesk_geometry::{AreaSampler, Geometry, Surface, SurfaceSample, Transform};
use lesk_math::{Color, Vec3};
use std::f64::consts::PI;

/// A diffuse emitter: the same luminance into every direction of its outer side, or of both sides; from every point the
/// same too, unless it has an [`EmissionMap`].
///
/// On a mesh, every rectangle of two triangles and every other triangle is a light of its own for the purpose of choosing;
/// with a map, every triangle.
#[derive(Clone, Debug)]
pub struct Area {
    luminance: Color<f32>,
    two_sided: bool,
    area: f64,
    form: Form,
    map: Option<Box<EmissionMap>>,
}

#[derive(Clone, Debug)]
enum Form {
    /// With the body of one that only its outside can see.
    Whole(Box<(AreaSampler, Option<Body>)>),
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
            None => {
                let body = if two_sided { None } else { Body::of_geometry(geometry, world_from_local) };
                Form::Whole(Box::new((sampler, body)))
            }
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

    /// A surface of the given luminance in cd/m², multiplied by a picture on it.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn mapped(map: EmissionMap, luminance: Color<f32>, two_sided: bool) -> Result<Self, LightError> {
        check_color("luminance", "cd/m2", luminance)?;
        let (geometry, place) = map.surface();
        let sampler = AreaSampler::new(geometry, place)?;
        let area = sampler.area();
        let form = match geometry {
            Geometry::Mesh(mesh) => Form::Parts(Parts::triangles(mesh, place)),
            _ => Form::Whole(Box::new((sampler, None))),
        };
        Ok(Area { luminance, two_sided, area, form, map: Some(Box::new(map)) })
    }

    /// The same light, as bright all over as needed for this luminous flux in lm of all sides together.
    ///
    /// # Errors
    /// A flux that is not positive, or so large or small that f32 cannot hold the luminance; a picture that is black.
    pub fn with_flux(mut self, flux: f32) -> Result<Self, LightError> {
        if self.flux() <= 0.0 {
            return Err(LightError::new("the picture on the light is black").hint("remove the light to have it dark"));
        }
        self.luminance = self.luminance * (flux / self.flux());
        check_color("luminance", "cd/m2", self.luminance)?;
        Ok(self)
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
            _ => self.area * f64::from(self.mean(0).luminance()),
        };
        (PI * sides * flux) as f32
    }

    /// Mean luminance of a part, cd/m².
    fn mean(&self, part: usize) -> Color<f32> {
        match (&self.form, self.map.as_deref().map(EmissionMap::carrier)) {
            (Form::Parts(parts), Some(Carrier::Mesh(map))) => {
                parts.triangle(part as u32).map_or(self.luminance, |(_, prim)| self.luminance * map.mean(prim as usize))
            }
            (Form::Whole(_), Some(Carrier::Shape(map))) => self.luminance * map.mean,
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
        match map.carrier() {
            Carrier::Mesh(on) => match self.triangle(prim) {
                Some(triangle) => map.at(on.uv(prim as usize, triangle.weights_at(p))),
                None => Color::BLACK,
            },
            Carrier::Shape(on) => map.at(on.uv(prim, p)),
        }
    }

    /// A triangle that is a part by itself.
    fn triangle(&self, prim: u32) -> Option<&Triangle> {
        let Form::Parts(parts) = &self.form else { return None };
        parts.triangle(parts.part_of(prim)?).map(|(triangle, _)| triangle)
    }

    /// The rectangle that a part is, evenly bright.
    #[inline]
    pub(crate) fn rectangle(&self, part: u32) -> Option<&Rectangle> {
        match &self.form {
            Form::Parts(parts) if self.map.is_none() => parts.rectangle(part),
            _ => None,
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
        let sample = match (&self.form, self.map.as_deref().map(EmissionMap::carrier)) {
            (Form::Whole(whole), Some(Carrier::Shape(map))) => sample_shape(&whole.0, map, at, u),
            (Form::Whole(whole), _) => match &whole.1 {
                Some(body) => sample_body(body, at, u),
                None => whole.0.sample_from(at.p, u),
            },
            (Form::Parts(parts), Some(Carrier::Mesh(map))) => {
                let (triangle, prim) = parts.triangle(part)?;
                sample_triangle(triangle, map, prim, at, u)
            }
            (Form::Parts(parts), _) => parts.sample_from(part, at.p, u),
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
        match (&self.form, self.map.as_deref().map(EmissionMap::carrier)) {
            (Form::Whole(whole), Some(Carrier::Shape(map))) => shape_pdf(&whole.0, map, at, hit.prim, hit.p, hit.ng),
            (Form::Whole(whole), _) => match &whole.1 {
                Some(body) => per_steradian(body.pdf(at.p, hit.p, hit.ng), at.p, hit.p, hit.ng).unwrap_or(0.0),
                None => whole.0.pdf_from(at.p, hit.prim, hit.p, hit.ng),
            },
            (Form::Parts(_), Some(Carrier::Mesh(map))) => {
                self.triangle(hit.prim).map_or(0.0, |triangle| triangle_pdf(triangle, map, at, hit.prim, hit.p))
            }
            (Form::Parts(parts), _) => parts.pdf_from(at.p, hit.prim, hit.p),
        }
    }

    /// Bounds of every part, in order.
    pub(crate) fn bounds(&self) -> Vec<LightBounds> {
        match &self.form {
            Form::Whole(whole) => {
                let sampler = &whole.0;
                let (axis, spread, share) = match sampler.flat_normal() {
                    Some(n) => (n, 0.0, 1.0),
                    // a convex body shows a quarter of its surface on average
                    None => (Vec3::Z, PI, 0.25),
                };
                let intensity = self.mean(0).luminance() * self.area as f32 * share;
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

/// A point of a body that the receiver can see.
fn sample_body(body: &Body, at: &Receiver, u: [f32; 2]) -> Option<SurfaceSample> {
    let mut sample = body.sample(at.p, u)?;
    sample.pdf = per_steradian(sample.pdf, at.p, sample.p, sample.n)?;
    Some(sample)
}

/// A point of a shape with a picture: half of the draws know where the receiver is, half where the picture is bright.
fn sample_shape(sampler: &AreaSampler, map: &ShapeMap, at: &Receiver, u: [f32; 2]) -> Option<SurfaceSample> {
    let mut sample = match halves(u) {
        (true, u) => sampler.sample_from(at.p, u),
        (false, u) => map.sample(u),
    }?;
    sample.pdf = shape_pdf(sampler, map, at, sample.prim, sample.p, sample.n);
    (sample.pdf > 0.0 && sample.pdf.is_finite()).then_some(sample)
}

fn shape_pdf(sampler: &AreaSampler, map: &ShapeMap, at: &Receiver, prim: u32, p: Vec3<f32>, n: Vec3<f32>) -> f32 {
    let by_picture = per_steradian(map.pdf(prim, p), at.p, p, n).unwrap_or(0.0);
    0.5 * (sampler.pdf_from(at.p, prim, p, n) + by_picture)
}

/// The same for a triangle.
fn sample_triangle(t: &Triangle, map: &MeshMap, prim: u32, at: &Receiver, u: [f32; 2]) -> Option<SurfaceSample> {
    if !map.varies(prim as usize) {
        return t.sample_from(at.p, prim, u);
    }
    let mut sample = match halves(u) {
        (true, u) => t.sample_from(at.p, prim, u),
        (false, u) => t.sample_at(at.p, prim, map.sample(prim as usize, u)?),
    }?;
    sample.pdf = triangle_pdf(t, map, at, prim, sample.p);
    (sample.pdf > 0.0 && sample.pdf.is_finite()).then_some(sample)
}

fn triangle_pdf(t: &Triangle, map: &MeshMap, at: &Receiver, prim: u32, p: Vec3<f32>) -> f32 {
    let by_place = t.pdf_from(at.p, p);
    match map.density(prim as usize, t.weights_at(p)) {
        Some(density) => 0.5 * (by_place + density as f32 * t.uniform_pdf(at.p, p)),
        None => by_place,
    }
}

/// Which half of the draws `u` belongs to, and `u` stretched again.
fn halves(u: [f32; 2]) -> (bool, [f32; 2]) {
    if u[0] < 0.5 { (true, [2.0 * u[0], u[1]]) } else { (false, [2.0 * u[0] - 1.0, u[1]]) }
}
