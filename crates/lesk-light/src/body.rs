//! Points on the part of a luminous body that a receiver can see.

use crate::photometry::{Opening, OpeningShape};
use lesk_geometry::{Geometry, Surface, SurfaceSample, Transform};
use lesk_math::{Frame, Vec3, vec3};
use std::f64::consts::{PI, TAU};

/// A box, cylinder, open tube or ellipsoid in the world, which shines outward only.
#[derive(Clone, Debug)]
pub(crate) struct Body {
    form: Form,
    /// Half extents along the axes, metres; the axis of a cylinder is the last one.
    half: [f64; 3],
    /// Unit, perpendicular to one another.
    axes: [Vec3<f64>; 3],
    center: Vec3<f64>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Form {
    Box,
    Cylinder,
    Tube,
    Ellipsoid,
}

impl Body {
    /// An opening around `center` whose extents lie along the axes; `None` of flat ones, which both sides see whole.
    pub fn of_opening(opening: &Opening, axes: [Vec3<f64>; 3], center: Vec3<f64>) -> Option<Body> {
        let (form, last) = match opening.shape {
            OpeningShape::Box => (Form::Box, 2),
            OpeningShape::Cylinder(axis) => (Form::Cylinder, axis.min(2) as usize),
            OpeningShape::Ellipsoid => (Form::Ellipsoid, 2),
            OpeningShape::Point | OpeningShape::Rectangle | OpeningShape::Ellipse | OpeningShape::Upright(..) => {
                return None;
            }
        };
        let order = [1, 2, 3].map(|k| (last + k) % 3);
        Some(Body { form, half: order.map(|k| 0.5 * opening.size[k]), axes: order.map(|k| axes[k]), center })
    }

    /// A cylinder or stretched sphere; `None` of other geometries and where the transform leaves its axes oblique.
    pub fn of_geometry(geometry: &Geometry, place: &Transform) -> Option<Body> {
        let columns = [vec3(1.0, 0.0, 0.0), vec3(0.0, 1.0, 0.0), Vec3::Z].map(|e| place.vector_f64(e));
        let lengths = columns.map(|c| c.length());
        let oblique = |i: usize, j: usize| columns[i].dot(columns[j]).abs() > 1e-9 * lengths[i] * lengths[j];
        if oblique(0, 1) || oblique(1, 2) || oblique(2, 0) {
            return None;
        }
        let [x, y, z] = lengths;
        let (form, half, center) = match geometry {
            // a round sphere is drawn over its solid angle
            Geometry::Sphere if place.uniform_scale().is_none() => (Form::Ellipsoid, lengths, Vec3::ZERO),
            // the cylinder stands on z = 0 with height 1
            Geometry::Cylinder { capped: true } => (Form::Cylinder, [x, y, 0.5 * z], vec3(0.0, 0.0, 0.5)),
            Geometry::Cylinder { capped: false } => (Form::Tube, [x, y, 0.5 * z], vec3(0.0, 0.0, 0.5)),
            _ => return None,
        };
        let axes = [0, 1, 2].map(|k| columns[k] / lengths[k]);
        Some(Body { form, half, axes, center: place.point_f64(center) })
    }

    /// A point for the receiver at `x`; its `pdf` is per square metre. `None` where nothing of it is seen.
    pub fn sample(&self, x: Vec3<f32>, u: [f32; 2]) -> Option<SurfaceSample> {
        let spot = self.view(x)?.sample(u.map(f64::from))?;
        let world = |v: Vec3<f64>| self.axes[0] * v.x + self.axes[1] * v.y + self.axes[2] * v.z;
        let (p, n) = ((world(spot.p) + self.center).map(|x| x as f32), world(spot.n).map(|x| x as f32));
        // a box is triangles, which round as far as their corners are from the origin
        let size = if self.form == Form::Box { self.half.iter().sum::<f64>() as f32 } else { 0.0 };
        let reach = if self.form == Form::Box { p.map(|x| 3.0 * (x.abs() + 2.0 * size)) } else { p };
        let lift = Surface::at(reach, n).lift;
        Some(SurfaceSample { p, n, uv: [0.0; 2], prim: 0, pdf: spot.density as f32, lift })
    }

    /// The density of [`sample`](Self::sample), 1/m², at a point with its outer normal; 0 on parts that are not seen.
    pub fn pdf(&self, x: Vec3<f32>, p: Vec3<f32>, n: Vec3<f32>) -> f32 {
        let (p, n) = (self.frame(p.map(f64::from) - self.center), self.frame(n.map(f64::from)));
        self.view(x).map_or(0.0, |view| view.density(p, n) as f32)
    }

    fn frame(&self, v: Vec3<f64>) -> Vec3<f64> {
        vec3(v.dot(self.axes[0]), v.dot(self.axes[1]), v.dot(self.axes[2]))
    }

    /// `None` from inside.
    fn view(&self, x: Vec3<f32>) -> Option<View> {
        let from = self.frame(x.map(f64::from) - self.center);
        let mut view = View { form: self.form, half: self.half, from, parts: [None; 3] };
        view.parts = view.visible();
        view.parts.iter().any(Option::is_some).then_some(view)
    }
}

/// A body around the origin as a receiver sees it.
///
/// One of its visible parts is chosen by projected area over the square of the distance, and a point of it by projected
/// area (curved parts) or evenly (flat ones).
struct View {
    form: Form,
    half: [f64; 3],
    from: Vec3<f64>,
    parts: [Option<(Part, f64)>; 3],
}

/// A part of the surface.
#[derive(Clone, Copy, PartialEq)]
enum Part {
    /// Flat, perpendicular to an axis, on its positive or negative side.
    Flat(usize, bool),
    Curved,
}

/// A point of a body, metres.
struct Spot {
    p: Vec3<f64>,
    /// Unit, to the outside.
    n: Vec3<f64>,
    /// Density, 1/m².
    density: f64,
}

impl View {
    fn visible(&self) -> [Option<(Part, f64)>; 3] {
        match self.form {
            Form::Box => [0, 1, 2].map(|k| self.flat(k)),
            Form::Cylinder => [self.flat(2), self.side(), None],
            Form::Tube => [None, self.side(), None],
            Form::Ellipsoid => [(self.scaled().length() > 1.0).then_some((Part::Curved, 1.0)), None, None],
        }
    }

    /// The receiver where the half extents are 1.
    fn scaled(&self) -> Vec3<f64> {
        let [a, b, c] = self.half;
        vec3(self.from.x / a, self.from.y / b, self.from.z / c)
    }

    /// The face across an axis on the side of the receiver.
    fn flat(&self, axis: usize) -> Option<(Part, f64)> {
        let mut to = self.from.to_array();
        let positive = to[axis] > 0.0;
        let height = to[axis].abs() - self.half[axis];
        to[axis] = height;
        let distance = Vec3::from(to).length();
        (height > 0.0).then(|| (Part::Flat(axis, positive), self.flat_area(axis) * height / distance.powi(3)))
    }

    fn flat_area(&self, axis: usize) -> f64 {
        let across = 4.0 * self.half[(axis + 1) % 3] * self.half[(axis + 2) % 3];
        if self.form == Form::Cylinder { 0.25 * PI * across } else { across }
    }

    /// The side of a cylinder.
    fn side(&self) -> Option<(Part, f64)> {
        let [a, b, half] = self.half;
        let (r, outside) = (self.from.x.hypot(self.from.y), self.scaled().x.hypot(self.scaled().y));
        if outside <= 1.0 {
            return None;
        }
        let width = 2.0 * (a * self.from.y / r).hypot(b * self.from.x / r);
        let gap = r - r / outside;
        let beyond = (self.from.z.abs() - half).max(0.0);
        Some((Part::Curved, width * 2.0 * half * gap / gap.hypot(beyond).powi(3)))
    }

    fn sum(&self) -> f64 {
        self.parts.iter().flatten().map(|(_, weight)| weight).sum()
    }

    /// A visible point for `u` in the unit square.
    fn sample(&self, u: [f64; 2]) -> Option<Spot> {
        let mut left = u[0] * self.sum();
        let mut chosen = None;
        for &(part, weight) in self.parts.iter().flatten() {
            chosen = Some((part, (left / weight).clamp(0.0, 1.0 - f64::EPSILON)));
            if left < weight {
                break;
            }
            left -= weight;
        }
        let (part, stretched) = chosen?;
        let p = match part {
            Part::Flat(axis, positive) => self.on_flat(axis, positive, [stretched, u[1]]),
            Part::Curved if self.form != Form::Ellipsoid => self.on_side([stretched, u[1]]),
            Part::Curved => self.on_ellipsoid([stretched, u[1]]),
        };
        let n = self.normal(part, p);
        let density = self.density_on(part, p);
        Some(Spot { p, n, density })
    }

    fn density(&self, p: Vec3<f64>, n: Vec3<f64>) -> f64 {
        let n = n.to_array();
        let flat = |k: usize| Part::Flat(k, n[k] > 0.0);
        let part = match self.form {
            Form::Box if n[0].abs() > n[1].abs().max(n[2].abs()) => flat(0),
            Form::Box if n[1].abs() > n[2].abs() => flat(1),
            Form::Box => flat(2),
            // the normal of the side has no part along the axis
            Form::Cylinder if n[2].abs() > 0.5 => flat(2),
            Form::Cylinder | Form::Tube | Form::Ellipsoid => Part::Curved,
        };
        if self.parts.iter().flatten().any(|(known, _)| *known == part) { self.density_on(part, p) } else { 0.0 }
    }

    fn density_on(&self, part: Part, p: Vec3<f64>) -> f64 {
        let weight: f64 = self.parts.iter().flatten().filter(|(known, _)| *known == part).map(|(_, w)| w).sum();
        let within = match part {
            Part::Flat(axis, _) => 1.0 / self.flat_area(axis),
            Part::Curved if self.form != Form::Ellipsoid => self.density_on_side(p),
            Part::Curved => self.density_on_ellipsoid(p),
        };
        weight / self.sum() * within
    }

    fn on_flat(&self, axis: usize, positive: bool, u: [f64; 2]) -> Vec3<f64> {
        let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
        let [s, t] = if self.form == Form::Cylinder {
            let (r, (sin, cos)) = (u[0].sqrt(), (TAU * u[1]).sin_cos());
            [r * cos, r * sin]
        } else {
            u.map(|x| 2.0 * x - 1.0)
        };
        let mut p = [0.0; 3];
        p[axis] = if positive { self.half[axis] } else { -self.half[axis] };
        (p[i], p[j]) = (s * self.half[i], t * self.half[j]);
        Vec3::from(p)
    }

    /// The azimuth of the receiver around a cylinder whose half extents are 1, and the sine of the largest visible angle
    /// from there.
    fn arc(&self) -> (f64, f64) {
        let q = self.scaled();
        (q.y.atan2(q.x), (1.0 - 1.0 / (q.x * q.x + q.y * q.y)).max(0.0).sqrt())
    }

    fn on_side(&self, u: [f64; 2]) -> Vec3<f64> {
        let (toward, sine) = self.arc();
        let (s, c) = (toward + (sine * (2.0 * u[0] - 1.0)).asin()).sin_cos();
        vec3(self.half[0] * c, self.half[1] * s, self.half[2] * (2.0 * u[1] - 1.0))
    }

    fn density_on_side(&self, p: Vec3<f64>) -> f64 {
        let (toward, sine) = self.arc();
        let around = (p.y / self.half[1]).atan2(p.x / self.half[0]);
        // beyond the visible arc nothing shines to the receiver: any density will do, and rounding brings points there
        let (cos, (s, c)) = ((around - toward).cos().max(0.0), around.sin_cos());
        let per_turn = (self.half[0] * s).hypot(self.half[1] * c);
        cos / (2.0 * sine * 2.0 * self.half[2] * per_turn)
    }

    /// The direction to the receiver of a unit sphere, and the square of the sine of the largest visible angle from there.
    fn cap(&self) -> (Vec3<f64>, f64) {
        let q = self.scaled();
        (q.normalize(), 1.0 - 1.0 / q.length_squared())
    }

    fn on_ellipsoid(&self, u: [f64; 2]) -> Vec3<f64> {
        let (toward, square) = self.cap();
        let (sine_square, (s, c)) = (u[0] * square, (TAU * u[1]).sin_cos());
        let sine = sine_square.sqrt();
        let n = Frame::from_normal(toward).world_from_local(vec3(sine * c, sine * s, (1.0 - sine_square).sqrt()));
        vec3(n.x * self.half[0], n.y * self.half[1], n.z * self.half[2])
    }

    fn density_on_ellipsoid(&self, p: Vec3<f64>) -> f64 {
        let (toward, square) = self.cap();
        let [a, b, c] = self.half;
        let n = vec3(p.x / a, p.y / b, p.z / c);
        let cos = n.dot(toward).max(0.0);
        let area = vec3(b * c * n.x, a * c * n.y, a * b * n.z).length();
        cos / (PI * square * area)
    }

    fn normal(&self, part: Part, p: Vec3<f64>) -> Vec3<f64> {
        let [a, b, c] = self.half;
        match part {
            Part::Flat(axis, positive) => {
                let mut n = [0.0; 3];
                n[axis] = if positive { 1.0 } else { -1.0 };
                Vec3::from(n)
            }
            Part::Curved if self.form != Form::Ellipsoid => vec3(p.x / (a * a), p.y / (b * b), 0.0).normalize(),
            Part::Curved => vec3(p.x / (a * a), p.y / (b * b), p.z / (c * c)).normalize(),
        }
    }
}
