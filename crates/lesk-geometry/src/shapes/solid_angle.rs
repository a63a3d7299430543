//! Directions distributed uniformly over the solid angle of a sphere or a rectangle, in f64.

use lesk_math::{Frame, Vec3, vec3};
use std::f64::consts::TAU;

/// The cone of directions from a point to a sphere.
#[derive(Clone, Copy, Debug)]
pub(super) struct SphereCone {
    axis: Vec3<f64>,
    distance: f64,
    radius: f64,
    sin2_max: f64,
    /// 1 - cos of the half angle, without cancellation.
    one_minus_cos_max: f64,
}

impl SphereCone {
    /// `None` inside the sphere and so near to it that the cone is a half space.
    pub fn new(center: Vec3<f64>, radius: f64, x: Vec3<f64>) -> Option<Self> {
        let to = center - x;
        let distance = to.length();
        let sin2_max = (radius / distance).powi(2);
        (sin2_max < 0.9999).then(|| SphereCone {
            axis: to / distance,
            distance,
            radius,
            sin2_max,
            one_minus_cos_max: sin2_max / (1.0 + (1.0 - sin2_max).sqrt()),
        })
    }

    /// Solid angle, sr.
    pub fn solid_angle(&self) -> f64 {
        TAU * self.one_minus_cos_max
    }

    /// The unit normal of the sphere where a uniformly distributed direction first meets it
    /// (Pharr, Jakob & Humphreys, *Physically Based Rendering*, 4th ed., section 6.2.4).
    pub fn sample_normal(&self, u: [f64; 2]) -> Vec3<f64> {
        let one_minus_cos = u[0] * self.one_minus_cos_max;
        let cos_theta = 1.0 - one_minus_cos;
        let sin2_theta = one_minus_cos * (2.0 - one_minus_cos);
        // along the direction, the near wall is at d cos - sqrt(r^2 - d^2 sin^2)
        let half_chord = self.radius * (1.0 - sin2_theta / self.sin2_max).max(0.0).sqrt();
        let t = self.distance * cos_theta - half_chord;
        let (sin_phi, cos_phi) = (TAU * u[1]).sin_cos();
        let frame = Frame::from_normal(self.axis);
        let sin_theta = sin2_theta.sqrt();
        let along = frame.world_from_local(vec3(sin_theta * cos_phi, sin_theta * sin_phi, cos_theta));
        (along * t - self.axis * self.distance).normalize()
    }
}

/// The spherical rectangle under which a point sees a rectangle.
///
/// Ureña, Fajardo & King, *An Area-Preserving Parametrization for Spherical Rectangles*, EGSR 2013; names as there.
#[derive(Clone, Copy, Debug)]
pub struct SphericalRectangle {
    x0: f64,
    x1: f64,
    y0: f64,
    y1: f64,
    z0: f64,
    b0: f64,
    b1: f64,
    sin_k: f64,
    cos_k: f64,
    solid_angle: f64,
}

impl SphericalRectangle {
    /// For a rectangle that reaches from `s` along the orthogonal edges `ex` and `ey`, seen from `o`; metres.
    ///
    /// `None` in its plane, and where it is so small that area sampling is as good and its solid angle loses digits.
    pub fn new(s: Vec3<f64>, ex: Vec3<f64>, ey: Vec3<f64>, o: Vec3<f64>) -> Option<Self> {
        let (exl, eyl) = (ex.length(), ey.length());
        let (x, y) = (ex / exl, ey / eyl);
        let d = s - o;
        let (x0, y0, z0) = (d.dot(x), d.dot(y), -d.dot(x.cross(y)).abs());
        let (x1, y1) = (x0 + exl, y0 + eyl);
        let solid_angle = solid_angle([x0, x1], [y0, y1], -z0);
        if !(solid_angle > 1e-7 && -z0 > 1e-9 * (exl + eyl)) {
            return None;
        }
        // z of the unit normals n0, n1, n2, n3 of the planes through the edges
        let along = |a: f64| a / (a * a + z0 * z0).sqrt();
        let (b0, b1, b3) = (-along(y0), along(y1), -along(x0));
        // k = 2 pi - gamma2 - gamma3
        let (cos2, cos3) = (-b1 * b3, -b3 * b0);
        let sine = |cos: f64| (1.0 - cos * cos).max(0.0).sqrt();
        let (sin2, sin3) = (sine(cos2), sine(cos3));
        let (sin_k, cos_k) = (-(sin2 * cos3 + cos2 * sin3), cos2 * cos3 - sin2 * sin3);
        Some(SphericalRectangle { x0, x1, y0, y1, z0, b0, b1, sin_k, cos_k, solid_angle })
    }

    /// Solid angle, sr.
    #[inline]
    pub fn solid_angle(&self) -> f64 {
        self.solid_angle
    }

    /// The point along the two edges, each from 0 to 1, that a uniformly distributed direction meets.
    pub fn sample(&self, u: [f64; 2]) -> [f64; 2] {
        // au = u0 S + k
        let (sin_s, cos_s) = (u[0] * self.solid_angle).sin_cos();
        let (sin_au, cos_au) = (sin_s * self.cos_k + cos_s * self.sin_k, cos_s * self.cos_k - sin_s * self.sin_k);
        let fu = (cos_au * self.b0 - self.b1) / sin_au;
        let cu = (1.0f64.copysign(fu) / (fu * fu + self.b0 * self.b0).sqrt()).clamp(-1.0, 1.0);
        let xu = -(cu * self.z0) / (1.0 - cu * cu).max(1e-20).sqrt();
        let xu = xu.clamp(self.x0, self.x1);
        let d2 = xu * xu + self.z0 * self.z0;
        let (h0, h1) = (self.y0 / (d2 + self.y0 * self.y0).sqrt(), self.y1 / (d2 + self.y1 * self.y1).sqrt());
        let hv = h0 + u[1] * (h1 - h0);
        let yv = if hv * hv < 1.0 - 1e-12 { hv * (d2 / (1.0 - hv * hv)).sqrt() } else { self.y1 };
        let yv = yv.clamp(self.y0, self.y1);
        [(xu - self.x0) / (self.x1 - self.x0), (yv - self.y0) / (self.y1 - self.y0)]
    }
}

/// Solid angle of a rectangle that reaches over `x` and `y` in a plane at the distance `z` > 0, sr.
///
/// A corner (x, y) and the foot of the point span atan(x y / (z r)), where r is the distance of the corner (Mathar, *Solid
/// Angle of a Rectangular Plate*, 2015). The four angles are added as arguments of complex numbers, with one arctangent.
fn solid_angle(x: [f64; 2], y: [f64; 2], z: f64) -> f64 {
    let corner = |x: f64, y: f64| (z * (x * x + y * y + z * z).sqrt(), x * y);
    let times = |(a, b): (f64, f64), (c, d): (f64, f64)| (a * c - b * d, a * d + b * c);
    let conjugate = |(a, b): (f64, f64)| (a, -b);
    let high = times(corner(x[1], y[1]), conjugate(corner(x[0], y[1])));
    let low = times(corner(x[1], y[0]), conjugate(corner(x[0], y[0])));
    let (re, im) = times(high, conjugate(low));
    let angle = im.atan2(re);
    // of 0 to 2 pi
    if angle < 0.0 { angle + TAU } else { angle }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn the_cone_of_a_far_sphere_is_its_area_over_the_square_of_the_distance() {
        let cone = SphereCone::new(vec3(0.0, 0.0, 1e5), 1.0, Vec3::ZERO).unwrap();
        // next term of the series: 1/4 sin^2 = 2.5e-11
        assert!((cone.solid_angle() / (PI * 1e-10) - 1.0).abs() < 1e-10);
    }

    #[test]
    fn sampled_normals_of_a_sphere_face_the_point() {
        let (c, r, x) = (vec3(1.0, 2.0, 3.0), 0.7, vec3(-1.0, 0.5, 2.0));
        let cone = SphereCone::new(c, r, x).unwrap();
        for i in 0..100 {
            let n = cone.sample_normal([(i as f64 + 0.5) / 100.0, (i as f64 * 0.618).fract()]);
            assert!((x - (c + n * r)).dot(n) > -1e-12);
        }
        assert!(SphereCone::new(c, r, c).is_none());
    }

    #[test]
    fn a_face_of_a_cube_seen_from_its_centre_is_a_sixth_of_all_directions() {
        let s = vec3(-1.0, -1.0, 1.0);
        let r = SphericalRectangle::new(s, vec3(2.0, 0.0, 0.0), vec3(0.0, 2.0, 0.0), Vec3::ZERO).unwrap();
        assert!((r.solid_angle() - 4.0 * PI / 6.0).abs() < 1e-14);
    }

    #[test]
    fn sampled_directions_of_a_rectangle_are_uniform_over_its_solid_angle() {
        // the mean of cos(theta) over the solid angle is the form factor times pi over it; form factor of a rectangle
        // above a corner (Howell, configuration C-1): a = b = 1, c = 1, element parallel to the plane
        let r = SphericalRectangle::new(Vec3::Z, vec3(1.0, 0.0, 0.0), vec3(0.0, 1.0, 0.0), Vec3::ZERO).unwrap();
        let half = 0.5f64.sqrt();
        let f = 2.0 * half * half.atan() / TAU;
        let n = 256;
        let mut mean = 0.0;
        for i in 0..n * n {
            let [a, b] = r.sample([(i % n) as f64 + 0.5, (i / n) as f64 + 0.5].map(|v| v / n as f64));
            mean += 1.0 / (1.0 + a * a + b * b).sqrt() / (n * n) as f64;
        }
        // 1e-5: midpoint rule with 256 x 256 points
        assert!((mean * r.solid_angle() - PI * f).abs() < 1e-5, "{mean} {f}");
    }

    #[test]
    fn corners_of_the_square_map_to_corners_of_the_rectangle() {
        let s = vec3(-0.3, 0.2, -2.0);
        let r = SphericalRectangle::new(s, vec3(1.0, 0.0, 0.0), vec3(0.0, 2.0, 0.0), Vec3::ZERO).unwrap();
        for (u, expected) in [([0.0, 0.0], [0.0, 0.0]), ([1.0, 1.0], [1.0, 1.0]), ([0.0, 1.0], [0.0, 1.0])] {
            let got = r.sample(u);
            assert!((got[0] - expected[0]).abs() < 1e-9 && (got[1] - expected[1]).abs() < 1e-9, "{got:?}");
        }
    }

    #[test]
    fn solid_angles_of_rectangles_have_their_closed_forms() {
        // on the axis: 4 asin(sin(a) sin(b)) with the half angles a and b under which the sides are seen
        for (w, h, z) in [(1.0, 1.0, 1.0), (0.1, 2.0, 3.0), (50.0, 40.0, 0.01), (1e-3, 2e-3, 1.0)] {
            let s = vec3(-w, -h, z);
            let r = SphericalRectangle::new(s, vec3(2.0 * w, 0.0, 0.0), vec3(0.0, 2.0 * h, 0.0), Vec3::ZERO).unwrap();
            let half = |x: f64| x / x.hypot(z);
            let expected = 4.0 * (half(w) * half(h)).asin();
            // the arcsine near 1 magnifies rounding by 3000
            assert!((r.solid_angle() - expected).abs() < 2e-12, "{w} {h} {z}: {} {expected}", r.solid_angle());
        }
        // the parts of a rectangle add up to it, whichever side of the foot of the point they lie on
        let of = |x0: f64, x1: f64, y0: f64, y1: f64| solid_angle([x0, x1], [y0, y1], 0.3);
        let parts = of(-1.0, 0.4, -2.0, 0.7) + of(0.4, 1.5, -2.0, 0.7) + of(-1.0, 1.5, 0.7, 0.9);
        assert!((parts - of(-1.0, 1.5, -2.0, 0.9)).abs() < 1e-14);
    }

    #[test]
    fn a_rectangle_seen_edge_on_has_no_solid_angle() {
        let e = |x, y| vec3(x, y, 0.0);
        assert!(SphericalRectangle::new(e(1.0, 1.0), e(1.0, 0.0), e(0.0, 1.0), Vec3::ZERO).is_none());
    }
}
