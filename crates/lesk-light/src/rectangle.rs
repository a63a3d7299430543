//! Two triangles of an emissive mesh that are one rectangle, sampled by solid angle where it is seen large and by area where
//! it is seen small.

use crate::triangle::{FarFrom, SEEN_LARGE, Triangle, area_pdf, narrow, widen};
use lesk_geometry::{SphericalRectangle, SurfaceSample};
use lesk_math::Vec3;

/// A rectangle may differ from two triangles by this share of its shorter edge, besides the rounding of its corners.
const MOST_SKEW: f64 = 1e-3;

/// A rectangle in the world.
#[derive(Clone, Debug)]
pub(crate) struct Rectangle {
    /// The corner of the first triangle that the second has not, those that follow it, and the one opposite.
    corners: [Vec3<f32>; 4],
    /// Unit, to the outside.
    n: Vec3<f32>,
    area: f32,
    lift: f32,
    far: FarFrom,
    /// The triangles of the mesh.
    prims: [u32; 2],
}

impl Rectangle {
    /// Of two triangles that share their longest sides; `None` if they are no rectangle up to the rounding of their
    /// corners. `own` are the numbers of the triangles.
    pub fn of(first: &Triangle, second: &Triangle, own: [u32; 2]) -> Option<Self> {
        let [c, a, b] = first.apex_first();
        let [d, ..] = second.apex_first();
        let [wc, wa, wb, wd] = [c, a, b, d].map(widen);
        let (ex, ey) = (wa - wc, wb - wc);
        let (w, h) = (ex.length(), ey.length());
        let lift = first.lift().max(second.lift());
        // corners are known up to the lift of a ray
        let slack = f64::from(lift).min(MOST_SKEW * w.min(h));
        let closes = (wa + wb - wc - wd).length() <= slack;
        let is_right = ex.dot(ey).abs() <= slack * w.max(h);
        let alike = first.normal().dot(second.normal()) > 0.0;
        let area = first.area() + second.area();
        (closes && is_right && alike && area.is_finite()).then(|| Rectangle {
            corners: [c, a, b, d],
            n: narrow((widen(first.normal()) + widen(second.normal())).normalize()),
            area,
            lift,
            far: FarFrom::new((wa + wb) * 0.5, 0.5 * (wa - wb).length(), area),
            prims: own,
        })
    }

    pub fn corners(&self) -> &[Vec3<f32>] {
        &self.corners
    }

    pub fn normal(&self) -> Vec3<f32> {
        self.n
    }

    /// Square metres.
    pub fn area(&self) -> f32 {
        self.area
    }

    /// A point for the receiver at `x`; its `pdf` is per steradian. `uv` runs along the edges.
    pub fn sample_from(&self, x: Vec3<f32>, u: [f32; 2]) -> Option<SurfaceSample> {
        let seen = self.seen(x);
        let uv = match &seen {
            Some(seen) => seen.sample(u.map(f64::from)).map(|v| v as f32),
            None => u,
        };
        let (p, prim) = self.point(uv);
        let pdf = match seen {
            Some(seen) => (1.0 / seen.solid_angle()) as f32,
            None => area_pdf(x, p, self.n, self.area),
        };
        (pdf > 0.0 && pdf.is_finite()).then_some(SurfaceSample { p, n: self.n, uv, prim, pdf, lift: self.lift })
    }

    /// The density of [`sample_from`](Self::sample_from) at the point `p` of the rectangle, 1/sr.
    pub fn pdf_from(&self, x: Vec3<f32>, p: Vec3<f32>) -> f32 {
        match self.seen(x) {
            Some(seen) => (1.0 / seen.solid_angle()) as f32,
            None => area_pdf(x, p, self.n, self.area),
        }
    }

    /// Whether it is sampled by area for the receiver at `x`, because it is seen small from there.
    #[inline]
    pub fn is_far(&self, x: Vec3<f32>) -> bool {
        self.far.is_far(x)
    }

    /// How far a ray must keep from it, metres.
    pub fn lift(&self) -> f32 {
        self.lift
    }

    /// The point on one of the two triangles, and which.
    #[inline]
    fn point(&self, uv: [f32; 2]) -> (Vec3<f32>, u32) {
        let (p, is_first) = point(self.corners, uv);
        (p, self.prims[usize::from(!is_first)])
    }

    #[inline]
    fn seen(&self, x: Vec3<f32>) -> Option<SphericalRectangle> {
        if self.far.is_far(x) { None } else { self.seen_near(x) }
    }

    #[inline(never)]
    fn seen_near(&self, x: Vec3<f32>) -> Option<SphericalRectangle> {
        let [c, a, b, _] = self.corners.map(widen);
        let seen = SphericalRectangle::new(c, a - c, b - c, widen(x))?;
        SEEN_LARGE.contains(&seen.solid_angle()).then_some(seen)
    }
}

/// The point `uv` along the edges of a rectangle with the corners of [`Rectangle`], and whether it lies on the triangle of
/// the first three.
#[inline(always)]
pub(crate) fn point([c, a, b, d]: [Vec3<f32>; 4], [u, v]: [f32; 2]) -> (Vec3<f32>, bool) {
    let is_first = u + v <= 1.0;
    let (corner, along_u, along_v) =
        (Vec3::select(is_first, c, d), Vec3::select(is_first, a, b), Vec3::select(is_first, b, a));
    let (u, v) = if is_first { (u, v) } else { (1.0 - u, 1.0 - v) };
    (corner + (along_u - corner) * u + (along_v - corner) * v, is_first)
}
