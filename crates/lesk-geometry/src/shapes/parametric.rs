//! Texture coordinates to points and back.

use super::analytic::{LocalSurface, shape_surface};
use super::sampler::{AreaSampler, Form};
use super::{Geometry, SurfaceSample};
use crate::transform::widen;
use lesk_math::{Vec3, vec3};
use std::f64::consts::{PI, TAU};

impl AreaSampler {
    /// How many parts have texture coordinates of their own: three of a closed cylinder (side, bottom, top), else one; none
    /// for a mesh, whose coordinates are its own.
    pub fn uv_parts(&self) -> u32 {
        match &self.form {
            Form::Mesh(..) => 0,
            Form::Shape(Geometry::Cylinder { capped: true }) => 3,
            _ => 1,
        }
    }

    /// The point at texture coordinates in the unit square; its `pdf`, in 1/m², is that of coordinates which are uniform
    /// there. `None` for a mesh and where the density is infinite (a pole).
    pub fn at_uv(&self, part: u32, uv: [f64; 2]) -> Option<SurfaceSample> {
        let sample = match &self.form {
            Form::Mesh(..) => return None,
            Form::Rectangle(corner, _) => self.rectangle_point(corner, uv),
            Form::Sphere(..) => self.parametric(&Geometry::Sphere, 0, uv),
            Form::Shape(shape) => self.parametric(shape, part, uv),
        };
        (sample.pdf > 0.0 && sample.pdf.is_finite()).then_some(sample)
    }

    /// The texture coordinates of the point `p` of a part; zero for a mesh.
    pub fn uv_of(&self, part: u32, p: Vec3<f32>) -> [f64; 2] {
        let local = self.place.inverse().point_f64(widen(p));
        match &self.form {
            Form::Mesh(..) => [0.0; 2],
            Form::Rectangle(..) => [0.5 * (local.x + 1.0), 0.5 * (local.y + 1.0)].map(|v| v.clamp(0.0, 1.0)),
            Form::Sphere(..) => shape_surface(&Geometry::Sphere, 0, local).uv,
            Form::Shape(shape) => shape_surface(shape, part, local).uv,
        }
    }

    fn parametric(&self, shape: &Geometry, part: u32, uv: [f64; 2]) -> SurfaceSample {
        let (local, area) = surface_at_uv(shape, part, uv);
        self.placed(local, part, 1.0 / (area * self.place.area_factor(local.n)))
    }
}

/// The local surface at texture coordinates, and the local area per area of the coordinates.
fn surface_at_uv(shape: &Geometry, part: u32, [u, v]: [f64; 2]) -> (LocalSurface, f64) {
    let around = |r: f64, turn: f64, z: f64| vec3(r * (TAU * turn).cos(), r * (TAU * turn).sin(), z);
    let (p, area) = match (shape, part) {
        (Geometry::Sphere, _) => (around((PI * v).sin(), u, -(PI * v).cos()), TAU * PI * (PI * v).sin()),
        (Geometry::Cylinder { .. }, 0) => (around(1.0, u, v), TAU),
        _ => (around(u, v, 0.0), TAU * u),
    };
    let mut local = shape_surface(shape, part, p);
    // at a pole the point has lost its turn
    local.uv = [u, v];
    (local, area)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Transform;

    #[test]
    fn points_lie_at_their_coordinates_and_cover_the_area() {
        let place =
            Transform::translate(1.0, 2.0, 3.0) * Transform::rotate_x(0.4) * Transform::scale(0.5, 0.5, 2.0).unwrap();
        let sphere = Transform::translate(1.0, 2.0, 3.0) * Transform::scale(0.5, 0.5, 0.5).unwrap();
        // π a b = 0.25 π; 2 π r h = 2 π, with two caps of π r²; 4 π r²
        for (shape, place, expected) in [
            (Geometry::Disk, place, 0.25 * PI),
            (Geometry::Rectangle, place, 1.0),
            (Geometry::Cylinder { capped: false }, place, TAU),
            (Geometry::Cylinder { capped: true }, place, TAU + 0.5 * PI),
            (Geometry::Sphere, sphere, PI),
        ] {
            let sampler = AreaSampler::new(&shape, &place).unwrap();
            let n = 100;
            let mut area = 0.0;
            for part in 0..sampler.uv_parts() {
                for i in 0..n * n {
                    let uv = [i % n, i / n].map(|k| (f64::from(k) + 0.5) / f64::from(n));
                    let sample = sampler.at_uv(part, uv).unwrap();
                    area += 1.0 / f64::from(sample.pdf) / f64::from(n * n);
                    let again = sampler.uv_of(part, sample.p);
                    // f32 points, coordinates that crowd near the middle of a disk
                    assert!((0..2).all(|k| (again[k] - uv[k]).abs() < 2e-4), "{shape:?} {part} {uv:?} {again:?}");
                }
            }
            // 1e-4: midpoint rule for the sine of the sphere
            assert!((area / expected - 1.0).abs() < 1e-4, "{shape:?}: {area} is not {expected}");
        }
    }
}
