//! One triangle of an emissive mesh, sampled by solid angle where it is seen large and by area where it is seen small.

use lesk_geometry::{Mesh, SurfaceSample, Transform};
use lesk_math::Vec3;

/// Solid angles between which a triangle is sampled by solid angle, sr. Below, it is seen edge-on and the area density
/// keeps more digits; above, the triangle nearly holds a hemisphere and the angles of its corners lose digits.
pub(crate) const SEEN_LARGE: std::ops::Range<f64> = 1e-3..6.2;

/// A surface whose area over the square of its least possible distance is smaller, in sr, is sampled by area, without the
/// trigonometric functions of the solid angle. The distance to points of a compact surface then differs by at most two
/// fifths from that to its centre; pictures of the Cornell box gain a hundredth of variance and lose a twentieth of speed
/// where 0.15 sr is the limit.
const SEEN_SMALL: f32 = 0.5;

/// A triangle in the world.
#[derive(Clone, Debug)]
pub(crate) struct Triangle {
    corners: [Vec3<f32>; 3],
    /// Unit, to the outside.
    n: Vec3<f32>,
    area: f32,
    lift: f32,
    far: FarFrom,
}

/// Where a flat surface is seen so small that it is sampled by area.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FarFrom {
    center: Vec3<f32>,
    /// Square of the distance from the centre.
    square: f32,
}

impl FarFrom {
    /// Of a surface of the given area that lies within `radius` of its centre.
    pub fn new(center: Vec3<f64>, radius: f64, area: f32) -> Self {
        let far = radius as f32 + (area / SEEN_SMALL).sqrt();
        FarFrom { center: narrow(center), square: far * far }
    }

    #[inline]
    pub fn is_far(&self, x: Vec3<f32>) -> bool {
        (self.center - x).length_squared() > self.square
    }
}

impl Triangle {
    /// Triangle `prim` of a placed mesh; `None` where its area vanishes in f32.
    pub fn new(mesh: &Mesh, prim: usize, place: &Transform) -> Option<Self> {
        let local = mesh.corners(prim);
        let corners = local.map(|c| place.point(c));
        let [a, b, c] = corners.map(widen);
        let double = (b - a).cross(c - a);
        let length = double.length();
        let n = narrow(double * (place.determinant().signum() / length));
        let area = (0.5 * length) as f32;
        let center = (a + b + c) / 3.0;
        let radius = [a, b, c].map(|v| (v - center).length()).into_iter().fold(0.0, f64::max);
        (area > 0.0 && area.is_finite() && n.to_array().iter().all(|x| x.is_finite())).then(|| Triangle {
            corners,
            n,
            area,
            lift: lift(place, &local, &corners),
            far: FarFrom::new(center, radius, area),
        })
    }

    pub fn corners(&self) -> &[Vec3<f32>] {
        &self.corners
    }

    /// The corner opposite to the longest side, and those that follow it.
    pub fn apex_first(&self) -> [Vec3<f32>; 3] {
        let c = self.corners;
        let opposite = |k: usize| (c[(k + 1) % 3] - c[(k + 2) % 3]).length_squared();
        let apex = (0..3).fold(0, |best, k| if opposite(k) > opposite(best) { k } else { best });
        [c[apex], c[(apex + 1) % 3], c[(apex + 2) % 3]]
    }

    pub fn normal(&self) -> Vec3<f32> {
        self.n
    }

    /// Square metres.
    pub fn area(&self) -> f32 {
        self.area
    }

    /// How far a ray must keep from it, metres.
    pub fn lift(&self) -> f32 {
        self.lift
    }

    /// A point for the receiver at `x`; its `pdf` is per steradian. `uv` holds the weights of the second and third corner.
    pub fn sample_from(&self, x: Vec3<f32>, prim: u32, u: [f32; 2]) -> Option<SurfaceSample> {
        let seen = self.seen(x);
        let weights = match &seen {
            Some(seen) => self.weights_toward(widen(x), seen.sample(u.map(f64::from))?).map(|w| w as f32),
            None => by_area(u),
        };
        let [a, b, c] = self.corners;
        let p = a * weights[0] + b * weights[1] + c * weights[2];
        let pdf = match seen {
            Some(seen) => (1.0 / seen.solid_angle) as f32,
            None => area_pdf(x, p, self.n, self.area),
        };
        let uv = [weights[1], weights[2]];
        (pdf > 0.0 && pdf.is_finite()).then_some(SurfaceSample { p, n: self.n, uv, prim, pdf, lift: self.lift })
    }

    /// The density of [`sample_from`](Self::sample_from) at the point `p` of the triangle, 1/sr.
    pub fn pdf_from(&self, x: Vec3<f32>, p: Vec3<f32>) -> f32 {
        match self.seen(x) {
            Some(seen) => (1.0 / seen.solid_angle) as f32,
            None => area_pdf(x, p, self.n, self.area),
        }
    }

    /// The point at barycentric weights, with the density over solid angle of a point drawn uniformly; `None` edge-on.
    pub fn sample_at(&self, x: Vec3<f32>, prim: u32, weights: [f64; 3]) -> Option<SurfaceSample> {
        let [a, b, c] = self.corners;
        let w = weights.map(|w| w as f32);
        let p = a * w[0] + b * w[1] + c * w[2];
        let pdf = self.uniform_pdf(x, p);
        (pdf > 0.0).then_some(SurfaceSample { p, n: self.n, uv: [w[1], w[2]], prim, pdf, lift: self.lift })
    }

    /// The density over solid angle of a point drawn uniformly; 0 edge-on.
    pub fn uniform_pdf(&self, x: Vec3<f32>, p: Vec3<f32>) -> f32 {
        area_pdf(x, p, self.n, self.area)
    }

    /// Barycentric weights of the corners for a point of the triangle.
    pub fn weights_at(&self, p: Vec3<f32>) -> [f64; 3] {
        let [a, b, c] = self.corners.map(widen);
        let (e1, e2, d) = (b - a, c - a, widen(p) - a);
        let n = e1.cross(e2);
        let nn = n.length_squared();
        let v = (d.cross(e2).dot(n) / nn).clamp(0.0, 1.0);
        let w = (e1.cross(d).dot(n) / nn).clamp(0.0, 1.0 - v);
        [1.0 - v - w, v, w]
    }

    #[inline]
    fn seen(&self, x: Vec3<f32>) -> Option<SphericalTriangle> {
        if self.far.is_far(x) { None } else { self.seen_near(x) }
    }

    #[inline(never)]
    fn seen_near(&self, x: Vec3<f32>) -> Option<SphericalTriangle> {
        let x = widen(x);
        let [a, b, c] = self.corners.map(|v| (widen(v) - x).normalize());
        // Van Oosterom & Strackee, IEEE Trans. Biomed. Eng. 30, 1983
        let solid_angle = 2.0 * a.dot(b.cross(c)).abs().atan2(1.0 + a.dot(b) + b.dot(c) + c.dot(a));
        SEEN_LARGE.contains(&solid_angle).then_some(SphericalTriangle { a, b, c, solid_angle })
    }

    /// Barycentric weights of the point of the plane that lies in the direction `w` from `x`.
    fn weights_toward(&self, x: Vec3<f64>, w: Vec3<f64>) -> [f64; 3] {
        let [a, b, c] = self.corners.map(|v| widen(v) - x);
        // volumes with the ray: the weight of a corner is the volume opposite to it
        let volumes = [w.dot(b.cross(c)), w.dot(c.cross(a)), w.dot(a.cross(b))];
        let sum: f64 = volumes.iter().sum();
        let v = volumes.map(|v| (v / sum).clamp(0.0, 1.0));
        let total: f64 = v.iter().sum();
        v.map(|v| v / total)
    }
}

/// 1/area as a density over solid angle, at the point `p` of a surface with the unit normal `n`; 0 edge-on.
#[inline(always)]
pub(crate) fn area_pdf(x: Vec3<f32>, p: Vec3<f32>, n: Vec3<f32>, area: f32) -> f32 {
    let to = p - x;
    let square = to.length_squared();
    let distance = square.sqrt();
    let height = to.dot(n).abs();
    let pdf = square * distance / (height * area);
    // infinity and NaN fail the comparison
    if (height > 1e-9 * distance) & (pdf <= f32::MAX) { pdf } else { 0.0 }
}

/// A triangle on the unit sphere.
struct SphericalTriangle {
    a: Vec3<f64>,
    b: Vec3<f64>,
    c: Vec3<f64>,
    solid_angle: f64,
}

impl SphericalTriangle {
    /// A direction distributed uniformly (Arvo, *Stratified Sampling of Spherical Triangles*, SIGGRAPH 1995).
    /// `None` where two corners coincide.
    fn sample(&self, u: [f64; 2]) -> Option<Vec3<f64>> {
        let (a, b, c) = (self.a, self.b, self.c);
        let (ab, ca) = (a.cross(b), c.cross(a));
        let alpha = ab.cross(ca).length().atan2(-ab.dot(ca));
        let (sin_alpha, cos_alpha) = alpha.sin_cos();
        if sin_alpha <= 0.0 {
            return None;
        }
        // the cut-off triangle with the area u0 ends at the corner d on the edge from a to c
        let (sin_phi, cos_phi) = (u[0] * self.solid_angle - alpha).sin_cos();
        let cos_ab = a.dot(b);
        let (k1, k2) = (cos_phi - cos_alpha, sin_phi + sin_alpha * cos_ab);
        let below = (k2 * sin_phi + k1 * cos_phi) * sin_alpha;
        let cos_d = (((k2 * cos_phi - k1 * sin_phi) * cos_alpha - k2) / below).clamp(-1.0, 1.0);
        let cos_d = if cos_d.is_finite() { cos_d } else { 1.0 };
        let d = a * cos_d + across(c, a) * (1.0 - cos_d * cos_d).max(0.0).sqrt();
        let cos_theta = 1.0 - u[1] * (1.0 - d.dot(b));
        let w = b * cos_theta + across(d, b) * (1.0 - cos_theta * cos_theta).max(0.0).sqrt();
        (w.length_squared() > 0.5).then_some(w)
    }
}

/// The unit vector along the part of `v` perpendicular to the unit vector `axis`.
fn across(v: Vec3<f64>, axis: Vec3<f64>) -> Vec3<f64> {
    (v - axis * v.dot(axis)).normalize()
}

/// Heitz, *A Low-Distortion Map Between Triangle and Square*, 2019: barycentric weights.
#[inline]
pub(crate) fn by_area(u: [f32; 2]) -> [f32; 3] {
    let (b, c) = if u[1] > u[0] { (0.5 * u[0], u[1] - 0.5 * u[0]) } else { (u[0] - 0.5 * u[1], 0.5 * u[1]) };
    [1.0 - b - c, b, c]
}

/// How far a ray must keep from the triangle: 32 roundings of the coordinates that its points are computed from, the
/// bound that `lesk-geometry` states for hits.
fn lift(place: &Transform, local: &[Vec3<f32>; 3], corners: &[Vec3<f32>; 3]) -> f32 {
    let sum = |v: &Vec3<f32>| v.x.abs() + v.y.abs() + v.z.abs();
    let world = corners.iter().map(sum).fold(0.0, f32::max);
    let size = local.iter().map(sum).fold(0.0, f32::max);
    let linear: f64 = place.rows().iter().map(|r| r[..3].iter().fold(0.0, |m: f64, x| m.max(x.abs()))).sum();
    let moved: f64 = place.rows().iter().map(|r| r[3].abs()).sum();
    16.0 * f32::EPSILON * (world + size * linear as f32 + moved as f32)
}

pub(crate) fn widen(v: Vec3<f32>) -> Vec3<f64> {
    v.map(f64::from)
}

pub(crate) fn narrow(v: Vec3<f64>) -> Vec3<f32> {
    v.map(|x| x as f32)
}
