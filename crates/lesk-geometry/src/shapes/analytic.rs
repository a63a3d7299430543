//! Sphere, disk and cylinder: intersection and surface in local space, in f64.
//!
//! A ray of f32 meets the exact surface in f64, so that only the rounding of its origin remains.

use super::Geometry;
use crate::bounds::Bounds;
use lesk_math::{Vec3, vec3};
use std::f64::consts::{PI, TAU};

/// Parts of a cylinder, as `prim` of a hit names them.
const SIDE: u32 = 0;
const BOTTOM: u32 = 1;
const TOP: u32 = 2;

/// A point of a surface in local space.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LocalSurface {
    pub p: Vec3<f64>,
    /// Unit, to the outside.
    pub n: Vec3<f64>,
    pub uv: [f64; 2],
    /// Not normalised; zero where the parametrisation has a pole.
    pub dpdu: Vec3<f64>,
}

pub(crate) fn shape_bounds(shape: &Geometry) -> Bounds {
    let (lo, hi) = match shape {
        Geometry::Disk => (0.0, 0.0),
        Geometry::Cylinder { .. } => (0.0, 1.0),
        _ => (-1.0, 1.0),
    };
    Bounds { min: vec3(-1.0, -1.0, lo), max: vec3(1.0, 1.0, hi) }
}

/// The nearest hit strictly between `t_min` and `t_max`: the parameter along the ray and the part.
/// Parameters are rounded to f32 before they are compared, as every other hit is.
pub(crate) fn shape_intersect(
    shape: &Geometry,
    o: Vec3<f64>,
    d: Vec3<f64>,
    t_min: f32,
    t_max: f32,
) -> Option<(f32, u32)> {
    let mut best = None;
    let mut limit = t_max;
    let mut offer = |t: f64, part: u32| {
        let t = t as f32;
        if t > t_min && t < limit {
            limit = t;
            best = Some((t, part));
        }
    };
    match shape {
        Geometry::Sphere => {
            for t in quadric(o, d).into_iter().flatten() {
                offer(t, SIDE);
            }
        }
        Geometry::Disk => {
            if let Some(t) = disk(o, d, 0.0) {
                offer(t, SIDE);
            }
        }
        Geometry::Cylinder { capped } => {
            for t in quadric(vec3(o.x, o.y, 0.0), vec3(d.x, d.y, 0.0)).into_iter().flatten() {
                if (0.0..=1.0).contains(&(o.z + t * d.z)) {
                    offer(t, SIDE);
                }
            }
            for (z, part) in [(0.0, BOTTOM), (1.0, TOP)].into_iter().filter(|_| *capped) {
                if let Some(t) = disk(o, d, z) {
                    offer(t, part);
                }
            }
        }
        Geometry::Mesh(_) | Geometry::Rectangle => {}
    }
    best
}

/// Both parameters at which |o + t d| = 1.
///
/// The discriminant is formed from the point nearest to the origin, which stays exact far away from the sphere
/// (Haines et al., *Precision Improvements for Ray/Sphere Intersection*, Ray Tracing Gems, 2019, Eq. 5), and the roots
/// without cancellation (Eq. 10).
fn quadric(o: Vec3<f64>, d: Vec3<f64>) -> Option<[f64; 2]> {
    let a = d.dot(d);
    if a == 0.0 {
        return None;
    }
    let b = -o.dot(d);
    let nearest = o + d * (b / a);
    let discriminant = 1.0 - nearest.dot(nearest);
    if discriminant.is_nan() || discriminant < 0.0 {
        return None;
    }
    let c = o.dot(o) - 1.0;
    let root = (a * discriminant).sqrt();
    let q = if b < 0.0 { b - root } else { b + root };
    if q == 0.0 {
        return Some([0.0, 0.0]);
    }
    Some([c / q, q / a])
}

fn disk(o: Vec3<f64>, d: Vec3<f64>, z: f64) -> Option<f64> {
    let t = (z - o.z) / d.z;
    let (x, y) = (o.x + t * d.x, o.y + t * d.y);
    (t.is_finite() && x * x + y * y <= 1.0).then_some(t)
}

/// The surface of `part` at the point of it nearest to `p`, which lies on it up to rounding.
pub(crate) fn shape_surface(shape: &Geometry, part: u32, p: Vec3<f64>) -> LocalSurface {
    match (shape, part) {
        (Geometry::Sphere, _) => sphere_surface(p),
        (Geometry::Cylinder { .. }, BOTTOM) => disk_surface(p, 0.0, -1.0),
        (Geometry::Cylinder { .. }, TOP) => disk_surface(p, 1.0, 1.0),
        (Geometry::Cylinder { .. }, _) => cylinder_surface(p),
        _ => disk_surface(p, 0.0, 1.0),
    }
}

/// Azimuth of (x, y) from +x, scaled from 0 to 1.
fn turn(p: Vec3<f64>) -> f64 {
    let phi = p.y.atan2(p.x) / TAU;
    if phi < 0.0 { phi + 1.0 } else { phi }
}

fn sphere_surface(p: Vec3<f64>) -> LocalSurface {
    let n = p.normalize();
    // v from -z to +z: a map of the globe has north up
    LocalSurface { p: n, n, uv: [turn(n), n.x.hypot(n.y).atan2(-n.z) / PI], dpdu: vec3(-n.y, n.x, 0.0) * TAU }
}

fn disk_surface(p: Vec3<f64>, z: f64, side: f64) -> LocalSurface {
    let r = p.x.hypot(p.y);
    LocalSurface {
        p: vec3(p.x, p.y, z),
        n: vec3(0.0, 0.0, side),
        uv: [r, turn(p)],
        dpdu: if r > 0.0 { vec3(p.x / r, p.y / r, 0.0) } else { Vec3::ZERO },
    }
}

fn cylinder_surface(p: Vec3<f64>) -> LocalSurface {
    let n = vec3(p.x, p.y, 0.0).normalize();
    let z = p.z.clamp(0.0, 1.0);
    LocalSurface { p: vec3(n.x, n.y, z), n, uv: [turn(n), z], dpdu: vec3(-n.y, n.x, 0.0) * TAU }
}

/// A point distributed uniformly over the local area of the shape, for `u` in the unit square, with its part.
pub(crate) fn shape_sample(shape: &Geometry, u: [f64; 2]) -> (LocalSurface, u32) {
    let around = |r: f64, phi: f64, z: f64| vec3(r * phi.cos(), r * phi.sin(), z);
    match shape {
        Geometry::Sphere => {
            let z = 1.0 - 2.0 * u[0];
            let r = (4.0 * u[0] * (1.0 - u[0])).max(0.0).sqrt();
            (sphere_surface(around(r, TAU * u[1], z)), SIDE)
        }
        Geometry::Cylinder { capped: true } => {
            // half the area is the side, a quarter each cap
            if u[0] < 0.5 {
                (cylinder_surface(around(1.0, TAU * u[1], 2.0 * u[0])), SIDE)
            } else {
                let (part, side) = if u[0] < 0.75 { (BOTTOM, -1.0) } else { (TOP, 1.0) };
                let v = (4.0 * u[0]).fract();
                let p = around(v.sqrt(), TAU * u[1], 0.0);
                (disk_surface(p, if part == TOP { 1.0 } else { 0.0 }, side), part)
            }
        }
        Geometry::Cylinder { capped: false } => (cylinder_surface(around(1.0, TAU * u[1], u[0])), SIDE),
        _ => (disk_surface(concentric(u), 0.0, 1.0), SIDE),
    }
}

/// Shirley & Chiu, *A Low Distortion Map Between Disk and Square*, 1997.
fn concentric(u: [f64; 2]) -> Vec3<f64> {
    let (a, b) = (2.0 * u[0] - 1.0, 2.0 * u[1] - 1.0);
    if a == 0.0 && b == 0.0 {
        return Vec3::ZERO;
    }
    let (r, phi) = if a.abs() > b.abs() { (a, PI / 4.0 * (b / a)) } else { (b, PI / 2.0 - PI / 4.0 * (a / b)) };
    vec3(r * phi.cos(), r * phi.sin(), 0.0)
}

/// Area of the shape in local space.
pub(crate) fn shape_area(shape: &Geometry) -> f64 {
    match shape {
        Geometry::Sphere => 4.0 * PI,
        Geometry::Cylinder { capped: false } => TAU,
        Geometry::Cylinder { capped: true } => 2.0 * TAU,
        _ => PI,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn hit(shape: &Geometry, o: Vec3<f64>, d: Vec3<f64>) -> Option<(f32, u32)> {
        shape_intersect(shape, o, d, 0.0, f32::INFINITY)
    }

    #[test]
    fn a_ray_meets_the_sphere_where_the_closed_form_says() {
        // offset b from the axis: t = distance - sqrt(1 - b^2)
        for b in [0.0, 0.3, 0.999_999, 1.0] {
            let t = hit(&Geometry::Sphere, vec3(b, 0.0, 5.0), vec3(0.0, 0.0, -1.0)).unwrap().0;
            assert_eq!(t, (5.0 - (1.0 - b * b).sqrt()) as f32, "offset {b}");
        }
        assert!(hit(&Geometry::Sphere, vec3(1.000_000_1, 0.0, 5.0), vec3(0.0, 0.0, -1.0)).is_none());
    }

    #[test]
    fn a_ray_from_inside_meets_the_far_wall_of_the_sphere() {
        let (t, _) = hit(&Geometry::Sphere, vec3(0.5, 0.0, 0.0), vec3(2.0, 0.0, 0.0)).unwrap();
        assert_eq!(t, 0.25);
    }

    #[test]
    fn a_sphere_a_million_radii_away_keeps_its_outline() {
        let o = vec3(0.999_999, 0.0, 1e6);
        assert!(hit(&Geometry::Sphere, o, vec3(0.0, 0.0, -1.0)).is_some());
        let o = vec3(1.000_001, 0.0, 1e6);
        assert!(hit(&Geometry::Sphere, o, vec3(0.0, 0.0, -1.0)).is_none());
    }

    #[test]
    fn the_capped_cylinder_is_closed_and_the_open_one_is_a_tube() {
        let down = vec3(0.0, 0.0, -1.0);
        let capped = Geometry::Cylinder { capped: true };
        assert_eq!(hit(&capped, vec3(0.2, 0.3, 3.0), down), Some((2.0, TOP)));
        assert_eq!(hit(&capped, vec3(0.2, 0.3, -1.0), -down), Some((1.0, BOTTOM)));
        let open = Geometry::Cylinder { capped: false };
        assert_eq!(hit(&open, vec3(0.2, 0.3, 3.0), down), None);
        assert_eq!(hit(&open, vec3(3.0, 0.0, 0.5), vec3(-1.0, 0.0, 0.0)), Some((2.0, SIDE)));
        assert_eq!(hit(&open, vec3(3.0, 0.0, 1.5), vec3(-1.0, 0.0, 0.0)), None);
    }

    #[test]
    fn degenerate_rays_hit_nothing() {
        for shape in [Geometry::Sphere, Geometry::Disk, Geometry::Cylinder { capped: true }] {
            for bad in [0.0, f64::NAN, f64::INFINITY] {
                assert_eq!(hit(&shape, vec3(0.0, 0.0, 3.0), vec3(bad, bad, bad)), None);
                assert_eq!(hit(&shape, vec3(f64::NAN, 0.0, 3.0), vec3(0.0, 0.0, -1.0)), None);
            }
        }
    }

    #[test]
    fn samples_lie_on_the_surface_and_average_to_the_centroid() {
        let shapes = [
            (Geometry::Sphere, 0.0),
            (Geometry::Disk, 0.0),
            (Geometry::Cylinder { capped: true }, 0.5),
            (Geometry::Cylinder { capped: false }, 0.5),
        ];
        for (shape, mean_z) in shapes {
            let n = 64;
            let mut sum = Vec3::<f64>::ZERO;
            for i in 0..n * n {
                let u = [(i % n) as f64 + 0.5, (i / n) as f64 + 0.5].map(|x| x / n as f64);
                let (s, part) = shape_sample(&shape, u);
                let again = shape_surface(&shape, part, s.p);
                assert!((again.p - s.p).length() < 1e-15 && (again.n - s.n).length() < 1e-15);
                sum = sum + s.p;
            }
            let mean = sum * (1.0 / (n * n) as f64);
            // the midpoint rule integrates these linear functions up to rounding
            assert!((mean - vec3(0.0, 0.0, mean_z)).length() < 1e-12, "{shape:?} {mean:?}");
        }
    }
}
