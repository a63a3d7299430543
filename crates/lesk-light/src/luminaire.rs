//! A luminaire from a photometric file.

use crate::body::Body;
use crate::bounds::LightBounds;
use crate::error::{LightError, check_color, check_direction};
use crate::photometry::{Counted, Opening, OpeningShape, Outline, Photometry};
use crate::sample::{LightSample, Receiver, Target, per_steradian, toward};
use lesk_geometry::{AreaSampler, Geometry, Surface, Transform};
use lesk_math::{Color, Vec3, vec3};
use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::Arc;

/// The smallest projected area that the luminance counts with, of the largest one: a flat opening seen from its edge has
/// none, but a measured intensity there.
const LEAST_SEEN: f64 = 1e-3;

const AXES: [Vec3<f64>; 3] =
    [Vec3 { x: 1.0, y: 0.0, z: 0.0 }, Vec3 { x: 0.0, y: 1.0, z: 0.0 }, Vec3 { x: 0.0, y: 0.0, z: 1.0 }];

/// A luminaire: the measured intensities far away, and a visible luminous opening whose luminance is the intensity over
/// the projected area of the opening, L(w) = I(w) / A(w), the same at every point.
///
/// So the opening is right from every side: far away it gives the measured intensities, near by their spread over its
/// surface. An opening without size is a point.
#[derive(Clone, Debug)]
pub struct Luminaire {
    photometry: Arc<Photometry>,
    position: Vec3<f32>,
    /// The directions of C0, of C90 and up in the world.
    axes: [Vec3<f64>; 3],
    /// The colour for 1 cd of the file.
    scale: Color<f32>,
    opening: Option<Box<Placed>>,
    peak: f64,
}

/// The luminous opening in the world.
#[derive(Clone, Debug)]
struct Placed {
    geometry: Geometry,
    transform: Transform,
    sampler: AreaSampler,
    /// `None` of flat openings, which shine to both sides.
    body: Option<Body>,
    /// Smallest projected area that counts, m².
    least: f64,
}

/// Where a luminaire hangs: the position of its photometric centre in metres, the direction of its nadir, and the turn
/// about that direction in radians, counter-clockwise seen against it from above. A luminaire that looks down has C0 along
/// +x and C90 along +y for a turn of 0; any other is tilted from there the shortest way.
#[derive(Clone, Copy, Debug)]
pub struct Mounting {
    /// Metres.
    pub position: [f64; 3],
    /// Of nadir.
    pub direction: [f64; 3],
    /// Radians.
    pub rotation: f64,
}

impl Luminaire {
    /// A luminaire of the given colour, whose luminance is 1: intensities are those of the file times `factor`.
    ///
    /// # Errors
    /// A file that counts watts or is dark, a factor or colour that is not positive and finite, a direction without length.
    pub fn new(
        photometry: Arc<Photometry>,
        mounting: Mounting,
        color: Color<f32>,
        factor: f64,
    ) -> Result<Self, LightError> {
        if photometry.counted == Counted::Power {
            return Err(LightError::new("luminaire's file counts watts, lumens are accepted")
                .hint("`Photometry::in_lumens` counts them by the efficacy of a spectrum"));
        }
        let (peak, _) = photometry.peak();
        if photometry.flux() <= 0.0 {
            return Err(LightError::new("luminaire emits nothing"));
        }
        let scale = color * factor as f32;
        check_color("factor", "", scale)?;
        if !(mounting.position.iter().all(|x| x.abs() <= 1e12) && mounting.rotation.is_finite()) {
            return Err(LightError::new(format!(
                "luminaire is at {:?}, turned by {} rad; coordinates up to 1e12 m and a finite angle are accepted",
                mounting.position, mounting.rotation
            )));
        }
        let place = placement(&mounting)?;
        let axes = AXES.map(|axis| place.vector_f64(axis));
        let opening = placed(&photometry.opening, &place)?.map(Box::new);
        let position = Vec3::from(mounting.position.map(|x| x as f32));
        Ok(Luminaire { photometry, position, axes, scale, opening, peak })
    }

    /// The photometric data.
    pub fn photometry(&self) -> &Photometry {
        &self.photometry
    }

    /// Luminous flux, lm.
    pub fn flux(&self) -> f32 {
        self.photometry.flux() as f32 * self.scale.luminance()
    }

    /// Position of the photometric centre, metres.
    pub fn position(&self) -> Vec3<f32> {
        self.position
    }

    /// The opening as a geometry with its placement; `None` for a point.
    pub fn opening(&self) -> Option<(&Geometry, &Transform)> {
        self.opening.as_ref().map(|o| (&o.geometry, &o.transform))
    }

    /// The unit direction `w` of the world in the frame of the luminaire.
    fn local(&self, w: Vec3<f32>) -> Vec3<f64> {
        let w = w.map(f64::from);
        vec3(w.dot(self.axes[0]), w.dot(self.axes[1]), w.dot(self.axes[2]))
    }

    /// Luminous intensity in cd in the unit direction `w` away from the luminaire.
    pub fn intensity(&self, w: Vec3<f32>) -> Color<f32> {
        self.scale * self.photometry.toward(self.local(w)) as f32
    }

    /// Luminance in cd/m² that leaves a point of the opening with the outer normal `ng` in the unit direction `w`.
    pub fn radiance(&self, ng: Vec3<f32>, w: Vec3<f32>) -> Color<f32> {
        let Some(opening) = &self.opening else { return Color::BLACK };
        if opening.body.is_some() && ng.dot(w) <= 0.0 {
            return Color::BLACK;
        }
        let local = self.local(w);
        let area = self.photometry.opening.projected_area(local).max(opening.least);
        self.scale * (self.photometry.toward(local) / area) as f32
    }

    /// Whether it is a point.
    pub fn is_delta(&self) -> bool {
        self.opening.is_none()
    }

    pub(crate) fn sample(&self, at: &Receiver, u: [f32; 2]) -> Option<LightSample> {
        let Some(opening) = &self.opening else { return self.sample_point(at) };
        // over the area, not the solid angle: near its edge a flat opening is bright and thin, and only the product counts
        let mut sample = match &opening.body {
            Some(body) => body.sample(at.p, u)?,
            None => opening.sampler.sample(u),
        };
        sample.pdf = per_steradian(sample.pdf, at.p, sample.p, sample.n)?;
        let (wi, distance) = toward(at.p, sample.p)?;
        let value = self.radiance(sample.n, -wi);
        (value.max_component() > 0.0).then_some(LightSample {
            wi,
            distance,
            value,
            pdf: sample.pdf,
            delta: false,
            light: 0,
            target: Target::Surface(sample),
        })
    }

    fn sample_point(&self, at: &Receiver) -> Option<LightSample> {
        let (wi, distance) = toward(at.p, self.position)?;
        let value = self.intensity(-wi) * (1.0 / (distance * distance));
        (value.max_component() > 0.0).then_some(LightSample {
            wi,
            distance,
            value,
            pdf: 1.0,
            delta: true,
            light: 0,
            target: Target::Point(self.position),
        })
    }

    /// The density of [`sample`](Self::sample) for the point of the opening that a ray from the receiver hit, 1/sr.
    pub(crate) fn pdf(&self, at: &Receiver, hit: &Surface) -> f32 {
        let Some(opening) = &self.opening else { return 0.0 };
        let density = match &opening.body {
            Some(body) => body.pdf(at.p, hit.p, hit.ng),
            None => opening.sampler.pdf(hit.prim, hit.p),
        };
        per_steradian(density, at.p, hit.p, hit.ng).unwrap_or(0.0)
    }

    pub(crate) fn bounds(&self) -> LightBounds {
        let intensity = self.peak as f32 * self.scale.luminance();
        let down = -self.axes[2].map(|x| x as f32);
        let web = &self.photometry.web;
        let only_down = web.flux_down() >= web.flux() * (1.0 - 1e-9);
        let spread = if only_down { 0.0 } else { PI };
        match &self.opening {
            Some(opening) => LightBounds::surface(opening.sampler.bounds(), down, spread, intensity, false),
            None => LightBounds::cone(self.position, down, spread, FRAC_PI_2, intensity),
        }
    }
}

/// World from the luminaire's frame.
fn placement(mounting: &Mounting) -> Result<Transform, LightError> {
    let aim =
        check_direction("direction", Vec3::from(mounting.direction.map(|x| x as f32)))?.map(f64::from).normalize();
    let down = vec3(0.0, 0.0, -1.0);
    let axis = down.cross(aim);
    let angle = axis.length().atan2(down.dot(aim));
    // looking up is a turn about x
    let tilt = if axis.length() > 1e-9 { Transform::rotate(axis, angle)? } else { Transform::rotate_x(angle) };
    let [x, y, z] = mounting.position;
    Ok(Transform::translate(x, y, z) * tilt * Transform::rotate_z(mounting.rotation))
}

/// The geometry of an opening in the world; `None` without size.
fn placed(opening: &Opening, place: &Transform) -> Result<Option<Placed>, LightError> {
    let [x, y, z] = opening.size.map(|extent| 0.5 * extent);
    let scale = |x: f64, y: f64, z: f64| Transform::scale(x, y, z);
    // a cylinder of the geometry stands on z = 0 with height 1
    let tube = |x: f64, y: f64, z: f64| -> Result<Transform, LightError> {
        Ok(Transform::translate(0.0, 0.0, -z) * scale(x, y, 2.0 * z)?)
    };
    // z to x and z to y, so that the second axis of the shape is up
    let (to_x, to_y) = (Transform::rotate_y(FRAC_PI_2), Transform::rotate_x(-FRAC_PI_2));
    let flat = |outline| match outline {
        Outline::Rectangle => Geometry::Rectangle,
        Outline::Ellipse => Geometry::Disk,
    };
    let (geometry, own) = match opening.shape {
        OpeningShape::Point => return Ok(None),
        OpeningShape::Rectangle => (Geometry::Rectangle, scale(x, y, 1.0)?),
        OpeningShape::Box => (Geometry::cube(), scale(x, y, z)?),
        OpeningShape::Ellipse => (Geometry::Disk, scale(x, y, 1.0)?),
        OpeningShape::Ellipsoid => (Geometry::Sphere, scale(x, y, z)?),
        OpeningShape::Cylinder(2) => (Geometry::Cylinder { capped: true }, tube(x, y, z)?),
        OpeningShape::Cylinder(0) => (Geometry::Cylinder { capped: true }, to_x * tube(z, y, x)?),
        OpeningShape::Cylinder(_) => (Geometry::Cylinder { capped: true }, to_y * tube(x, z, y)?),
        OpeningShape::Upright(0, outline) => (flat(outline), to_x * scale(z, y, 1.0)?),
        OpeningShape::Upright(_, outline) => (flat(outline), to_y * scale(x, z, 1.0)?),
    };
    let transform = *place * own;
    let sampler = AreaSampler::new(&geometry, &transform)?;
    let largest = AXES.map(|axis| opening.projected_area(axis)).into_iter().sum::<f64>();
    let axes = AXES.map(|axis| place.vector_f64(axis));
    let body = Body::of_opening(opening, axes, place.point_f64(Vec3::ZERO));
    Ok(Some(Placed { geometry, transform, sampler, body, least: LEAST_SEEN * largest }))
}
