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
pub(super) struct SphericalRectangle {
    x0: f64,
    x1: f64,
    y0: f64,
    y1: f64,
    z0: f64,
    b0: f64,
    b1: f64,
    k: f64,
    solid_angle: f64,
}

impl SphericalRectangle {
    /// For a rectangle that reaches from `s` along the orthogonal edges `ex` and `ey`, seen from `o`.
    ///
    /// `None` in its plane, and where it is so small that area sampling is as good and its solid angle loses digits.
    pub fn new(s: Vec3<f64>, ex: Vec3<f64>, ey: Vec3<f64>, o: Vec3<f64>) -> Option<Self> {
        let (exl, eyl) = (ex.length(), ey.length());
        let (x, y) = (ex / exl, ey / eyl);
        let d = s - o;
        let (x0, y0, z0) = (d.dot(x), d.dot(y), -d.dot(x.cross(y)).abs());
        let (x1, y1) = (x0 + exl, y0 + eyl);
        let n0 = vec3(0.0, z0, -y0).normalize();
        let n1 = vec3(-z0, 0.0, x1).normalize();
        let n2 = vec3(0.0, -z0, y1).normalize();
        let n3 = vec3(z0, 0.0, -x0).normalize();
        let angle = |a: Vec3<f64>, b: Vec3<f64>| (-a.dot(b)).clamp(-1.0, 1.0).acos();
        let (g0, g1, g2, g3) = (angle(n0, n1), angle(n1, n2), angle(n2, n3), angle(n3, n0));
        let k = TAU - g2 - g3;
        let solid_angle = g0 + g1 - k;
        (solid_angle > 1e-7 && -z0 > 1e-9 * (exl + eyl)).then_some(SphericalRectangle {
            x0,
            x1,
            y0,
            y1,
            z0,
            b0: n0.z,
            b1: n2.z,
            k,
            solid_angle,
        })
    }

    /// Solid angle, sr.
    pub fn solid_angle(&self) -> f64 {
        self.solid_angle
    }

    /// The point along the two edges, each from 0 to 1, that a uniformly distributed direction meets.
    pub fn sample(&self, u: [f64; 2]) -> [f64; 2] {
        let au = u[0] * self.solid_angle + self.k;
        let fu = (au.cos() * self.b0 - self.b1) / au.sin();
        let cu = (1.0f64.copysign(fu) / (fu * fu + self.b0 * self.b0).sqrt()).clamp(-1.0, 1.0);
        let xu = -(cu * self.z0) / (1.0 - cu * cu).max(1e-20).sqrt();
        let xu = xu.clamp(self.x0, self.x1);
        let d = xu.hypot(self.z0);
        let (h0, h1) = (self.y0 / d.hypot(self.y0), self.y1 / d.hypot(self.y1));
        let hv = h0 + u[1] * (h1 - h0);
        let yv = if hv * hv < 1.0 - 1e-12 { hv * d / (1.0 - hv * hv).sqrt() } else { self.y1 };
        let yv = yv.clamp(self.y0, self.y1);
        [(xu - self.x0) / (self.x1 - self.x0), (yv - self.y0) / (self.y1 - self.y0)]
    }
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
    fn a_rectangle_seen_edge_on_has_no_solid_angle() {
        let e = |x, y| vec3(x, y, 0.0);
        assert!(SphericalRectangle::new(e(1.0, 1.0), e(1.0, 0.0), e(0.0, 1.0), Vec3::ZERO).is_none());
    }
}
