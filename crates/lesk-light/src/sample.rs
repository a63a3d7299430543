//! What a light answers to a point that asks for light.

use lesk_geometry::{Ray, Surface, SurfaceSample};
use lesk_math::{Color, Vec3};

/// A point that receives light.
#[derive(Clone, Copy, Debug)]
pub struct Receiver {
    /// Position, metres.
    pub p: Vec3<f32>,
    /// Unit normal on the viewer's side of an opaque surface: no light counts that comes from below it.
    /// `None` for surfaces that transmit: light counts from everywhere.
    pub n: Option<Vec3<f32>>,
}

impl Receiver {
    /// A point of an opaque surface; `n` is the unit normal on the side of the viewer.
    pub fn opaque(p: Vec3<f32>, n: Vec3<f32>) -> Self {
        Receiver { p, n: Some(n) }
    }

    /// A point that receives light from all directions.
    pub fn anywhere(p: Vec3<f32>) -> Self {
        Receiver { p, n: None }
    }
}

/// Where the way to a light ends.
#[derive(Clone, Copy, Debug)]
pub enum Target {
    /// On the surface of an area light.
    Surface(SurfaceSample),
    /// At a point light.
    Point(Vec3<f32>),
    /// Infinitely far away.
    Infinity,
}

/// Light chosen for a receiver.
#[derive(Clone, Copy, Debug)]
pub struct LightSample {
    /// Unit direction to the light.
    pub wi: Vec3<f32>,
    /// Distance to the light, metres; infinite for distant light.
    pub distance: f32,
    /// Radiance from `wi` in cd/m²; for a delta light the illuminance of a plane perpendicular to `wi`, in lx.
    pub value: Color<f32>,
    /// Density of `wi` in 1/sr, times the probability of the light where one was chosen of many; for a delta light
    /// the probability alone.
    pub pdf: f32,
    /// Whether the light comes from one direction only, so that no other way of sampling finds it.
    pub delta: bool,
    /// Number of the light.
    pub light: u32,
    /// What must be in sight for the light to arrive.
    pub target: Target,
}

impl LightSample {
    /// The ray that must be free of obstacles for the light to arrive at `from`.
    #[inline]
    pub fn shadow_ray(&self, from: &Surface) -> Ray {
        match &self.target {
            Target::Surface(sample) => Ray::to_sample(from, sample),
            Target::Point(p) => Ray::to_point(from, *p),
            Target::Infinity => Ray::leaving(from, self.wi),
        }
    }
}

/// A direction from `from` to `to` and the distance; `None` where both coincide.
#[inline]
pub(crate) fn toward(from: Vec3<f32>, to: Vec3<f32>) -> Option<(Vec3<f32>, f32)> {
    let d = to - from;
    let distance = d.length();
    (distance > 1e-18 && distance.is_finite()).then(|| (d * (1.0 / distance), distance))
}

/// A density over area as one over solid angle seen from `x`; `None` edge-on.
pub(crate) fn per_steradian(pdf: f32, x: Vec3<f32>, p: Vec3<f32>, n: Vec3<f32>) -> Option<f32> {
    let to = p.map(f64::from) - x.map(f64::from);
    let square = to.length_squared();
    let cosine = to.dot(n.map(f64::from)).abs() / square.sqrt();
    let out = (f64::from(pdf) * square / cosine) as f32;
    (cosine > 1e-9 && out.is_finite() && out > 0.0).then_some(out)
}
