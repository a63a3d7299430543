//! One light of any kind.

use crate::bounds::LightBounds;
use crate::sample::{LightSample, Receiver};
use crate::{Area, Directional, Environment, Luminaire, Point, Projector, Sky, Spot};
use lesk_geometry::Surface;
use lesk_math::{Color, Vec3};

/// A light. All values are photometric: linear Rec.709 RGB whose luminance Y is cd, lx or cd/m².
#[derive(Clone, Debug)]
pub enum Light {
    /// A point.
    Point(Point),
    /// A point that shines into a cone.
    Spot(Spot),
    /// A picture thrown by a lens.
    Projector(Projector),
    /// Parallel light, or that of a disk in the sky.
    Directional(Directional),
    /// A surface.
    Area(Area),
    /// A luminaire from a photometric file.
    Luminaire(Luminaire),
    /// A picture of all directions.
    Environment(Environment),
    /// The same luminance from all directions.
    Sky(Sky),
}

impl Light {
    /// Whether it shines from infinitely far away.
    pub fn is_infinite(&self) -> bool {
        matches!(self, Light::Directional(_) | Light::Environment(_) | Light::Sky(_))
    }

    /// Whether it comes from one direction only, at any receiver.
    pub fn is_delta(&self) -> bool {
        match self {
            Light::Point(_) | Light::Spot(_) | Light::Projector(_) => true,
            Light::Directional(light) => light.is_delta(),
            Light::Luminaire(light) => light.is_delta(),
            Light::Area(_) | Light::Environment(_) | Light::Sky(_) => false,
        }
    }

    /// Luminous flux in lm; of distant light, what enters a sphere of the given radius in metres.
    pub fn flux(&self, scene_radius: f32) -> f32 {
        match self {
            Light::Point(light) => light.flux(),
            Light::Spot(light) => light.flux(),
            Light::Projector(light) => light.flux(),
            Light::Area(light) => light.flux(),
            Light::Luminaire(light) => light.flux(),
            Light::Directional(light) => light.flux(scene_radius),
            Light::Environment(light) => light.flux(scene_radius),
            Light::Sky(light) => light.flux(scene_radius),
        }
    }

    /// Chooses a direction from which the light arrives; the probability of the light itself is not in `pdf`.
    /// `part` is the part of a mesh, else 0. `None` where nothing arrives for this `u`.
    pub fn sample(&self, part: u32, at: &Receiver, u: [f32; 2]) -> Option<LightSample> {
        match self {
            Light::Point(light) => light.sample(at),
            Light::Spot(light) => light.sample(at),
            Light::Projector(light) => light.sample(at),
            Light::Directional(light) => light.sample(u),
            Light::Area(light) => light.sample(part, at, u),
            Light::Luminaire(light) => light.sample(at, u),
            Light::Environment(light) => light.sample(u),
            Light::Sky(light) => light.sample(at, u),
        }
    }

    /// Density in 1/sr with which [`sample`](Self::sample) finds the surface that a ray from the receiver hit; 0 for
    /// all but area lights and luminaires.
    pub fn pdf_surface(&self, at: &Receiver, hit: &Surface) -> f32 {
        match self {
            Light::Area(light) => light.pdf(at, hit),
            Light::Luminaire(light) => light.pdf(at, hit),
            _ => 0.0,
        }
    }

    /// Density in 1/sr with which [`sample`](Self::sample) draws `wi` for a distant light; 0 for all others and for
    /// parallel light.
    pub fn pdf_direction(&self, at: &Receiver, wi: Vec3<f32>) -> f32 {
        match self {
            Light::Environment(light) => light.pdf(wi),
            Light::Directional(light) => light.pdf(wi),
            Light::Sky(light) => light.pdf(at, wi),
            _ => 0.0,
        }
    }

    /// Luminance in cd/m² that a ray in direction `wi` meets at infinity, and [`pdf_direction`](Self::pdf_direction).
    pub(crate) fn seen(&self, at: &Receiver, wi: Vec3<f32>) -> (Color<f32>, f32) {
        match self {
            Light::Environment(light) => light.seen(wi),
            Light::Sky(light) => (light.radiance(wi), light.pdf(at, wi)),
            _ => (Color::BLACK, 0.0),
        }
    }

    /// The most illuminance that a distant light can give, lx, positive: what enters a sphere over its cross-section.
    pub(crate) fn distant_illuminance(&self) -> f32 {
        (self.flux(1.0) / std::f32::consts::PI).clamp(f32::MIN_POSITIVE, f32::MAX)
    }

    /// Luminance in cd/m² that leaves the surface in direction `w`; black for all but area lights.
    pub fn emitted(&self, surface: &Surface, w: Vec3<f32>) -> Color<f32> {
        match self {
            Light::Area(light) => light.radiance(surface.prim, surface.p, surface.ng, w),
            Light::Luminaire(light) => light.radiance(surface.ng, w),
            _ => Color::BLACK,
        }
    }

    /// Luminance in cd/m² that a ray in direction `wi` meets at infinity; black for lights that are not there.
    pub fn background(&self, wi: Vec3<f32>) -> Color<f32> {
        match self {
            Light::Environment(light) => light.radiance(wi),
            Light::Sky(light) => light.radiance(wi),
            Light::Directional(light) => light.radiance(wi),
            _ => Color::BLACK,
        }
    }

    /// Bounds of every part that can be chosen; none for distant light.
    pub(crate) fn bounds(&self) -> Vec<LightBounds> {
        match self {
            Light::Point(light) => vec![light.bounds()],
            Light::Spot(light) => vec![light.bounds()],
            Light::Projector(light) => vec![light.bounds()],
            Light::Area(light) => light.bounds(),
            Light::Luminaire(light) => vec![light.bounds()],
            Light::Directional(_) | Light::Environment(_) | Light::Sky(_) => vec![],
        }
    }
}
