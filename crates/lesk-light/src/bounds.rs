//! What a group of lights can do at most: where it is, where it shines, how strong it is.
//!
//! Conty Estevez & Kulla, *Importance Sampling of Many Lights with Adaptive Tree Splitting*, HPG 2018; the form of the
//! estimate follows Pharr, Jakob & Humphreys, *Physically Based Rendering*, 4th ed., section 12.6.3.

use lesk_geometry::{Bounds, Transform};
use lesk_math::Vec3;
use std::f64::consts::{FRAC_PI_2, PI};

/// Bounds of one light, or of several together.
#[derive(Clone, Copy, Debug)]
pub struct LightBounds {
    bounds: Bounds,
    /// Mean position of what shines.
    center: Vec3<f32>,
    /// Mean square of the distance from there, m².
    variance: f32,
    /// Axis of the cone of main directions.
    axis: Vec3<f32>,
    /// Half angle of that cone, radians.
    spread: f64,
    /// How far beyond its main direction a light still shines, radians.
    falloff: f64,
    /// Bound of the luminous intensity, cd.
    intensity: f32,
    two_sided: bool,
}

impl LightBounds {
    /// A point that shines everywhere with the given intensity in cd.
    pub(crate) fn everywhere(p: Vec3<f32>, intensity: f32) -> Self {
        Self::cone(p, Vec3::Z, PI, FRAC_PI_2, intensity)
    }

    /// A point whose main directions lie within `spread` of the axis, and which shines `falloff` further; radians.
    pub(crate) fn cone(p: Vec3<f32>, axis: Vec3<f32>, spread: f64, falloff: f64, intensity: f32) -> Self {
        let bounds = Bounds { min: p, max: p };
        LightBounds { bounds, center: p, variance: 0.0, axis, spread, falloff, intensity, two_sided: false }
    }

    /// A diffuse surface within `bounds` whose normals lie within `spread` (radians) of the axis; `intensity` in cd.
    pub(crate) fn surface(bounds: Bounds, axis: Vec3<f32>, spread: f64, intensity: f32, two_sided: bool) -> Self {
        let (center, radius) = (bounds.center(), bounds.radius());
        // as for a rectangle, which reaches over its box
        let variance = radius * radius / 3.0;
        LightBounds { bounds, center, variance, axis, spread, falloff: FRAC_PI_2, intensity, two_sided }
    }

    /// Bound of the luminous intensity, cd.
    pub fn intensity(&self) -> f32 {
        self.intensity
    }

    pub(crate) fn center(&self) -> Vec3<f32> {
        self.center
    }

    /// Mean square of the distance from the centre, m².
    pub(crate) fn variance(&self) -> f32 {
        self.variance
    }

    /// Of a sphere around the centre that holds everything, metres.
    pub(crate) fn radius(&self) -> f32 {
        let farthest = |lo: f32, hi: f32, c: f32| (c - lo).abs().max((hi - c).abs());
        let (lo, hi, c) = (self.bounds.min, self.bounds.max, self.center);
        let corner = Vec3::from([farthest(lo.x, hi.x, c.x), farthest(lo.y, hi.y, c.y), farthest(lo.z, hi.z, c.z)]);
        corner.length() * (1.0 + 4.0 * f32::EPSILON)
    }

    pub(crate) fn axis(&self) -> Vec3<f32> {
        self.axis
    }

    /// Half angle of the cone of main directions, radians.
    pub(crate) fn spread(&self) -> f64 {
        self.spread
    }

    /// How far beyond its main direction a light still shines, radians.
    pub(crate) fn falloff(&self) -> f64 {
        self.falloff
    }

    pub(crate) fn two_sided(&self) -> bool {
        self.two_sided
    }

    pub(crate) fn extent(&self) -> Vec3<f32> {
        self.bounds.max - self.bounds.min
    }

    /// Bounds of both together.
    pub(crate) fn union(&self, o: &LightBounds) -> LightBounds {
        let (axis, spread) = union_cone((self.axis, self.spread), (o.axis, o.spread));
        // two lights without intensity count alike
        let share = f64::from(o.intensity) / (f64::from(self.intensity) + f64::from(o.intensity));
        let share = if share.is_finite() { share as f32 } else { 0.5 };
        let apart = o.center - self.center;
        LightBounds {
            bounds: self.bounds.union(o.bounds),
            center: self.center + apart * share,
            variance: self.variance * (1.0 - share)
                + o.variance * share
                + apart.length_squared() * share * (1.0 - share),
            axis,
            spread,
            falloff: self.falloff.max(o.falloff),
            intensity: self.intensity + o.intensity,
            two_sided: self.two_sided | o.two_sided,
        }
    }

    /// The cost of having these lights in one node: intensity, size and spread of directions (Eq. 1 of the paper,
    /// with the squared diagonal in place of the area, which is zero for lights in a row).
    pub(crate) fn cost(&self) -> f64 {
        let (o, w) = (self.spread, (self.spread + self.falloff).min(PI));
        let (sin_o, cos_o) = o.sin_cos();
        let measure =
            2.0 * PI * (1.0 - cos_o) + FRAC_PI_2 * (2.0 * w * sin_o - (o - 2.0 * w).cos() - 2.0 * o * sin_o + cos_o);
        let diagonal = self.extent().map(f64::from).length_squared();
        f64::from(self.intensity) * measure.max(1e-6) * diagonal
    }
}

/// The smallest cone around two cones (axis, half angle).
fn union_cone(a: (Vec3<f32>, f64), b: (Vec3<f32>, f64)) -> (Vec3<f32>, f64) {
    let (wa, wb) = (a.0.map(f64::from), b.0.map(f64::from));
    let between = wa.cross(wb).length().atan2(wa.dot(wb));
    if (between + b.1).min(PI) <= a.1 {
        return a;
    }
    if (between + a.1).min(PI) <= b.1 {
        return b;
    }
    let half = 0.5 * (a.1 + between + b.1);
    if half >= PI {
        return (a.0, PI);
    }
    match Transform::rotate(wa.cross(wb), half - a.1) {
        // 1e-6: the axis is rounded to f32
        Ok(turn) => (turn.vector_f64(wa).normalize().map(|x| x as f32), (half + 1e-6).min(PI)),
        Err(_) => (a.0, PI),
    }
}
