//! The luminous opening: the simple shape that a photometric file gives to the part that shines.

use lesk_math::Vec3;
use std::f64::consts::FRAC_PI_4;

/// The shape of a luminous opening.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OpeningShape {
    /// Without size.
    Point,
    /// Horizontal, facing down and up.
    Rectangle,
    /// With luminous sides.
    Box,
    /// Horizontal circle or ellipse.
    Ellipse,
    /// Circular or elliptic cylinder along x, y or z (0, 1, 2).
    Cylinder(u8),
    /// Sphere or ellipsoid.
    Ellipsoid,
    /// Upright rectangle, circle or ellipse that faces along x or y (0, 1).
    Upright(u8, Outline),
}

/// The outline of an upright opening.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outline {
    /// Four corners.
    Rectangle,
    /// Circle or ellipse.
    Ellipse,
}

/// The luminous opening of a luminaire: shape and full extents.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Opening {
    /// Its shape.
    pub shape: OpeningShape,
    /// Extents along C0, along C90 and upward, metres.
    pub size: [f64; 3],
}

impl Opening {
    /// No size.
    pub const POINT: Opening = Opening { shape: OpeningShape::Point, size: [0.0; 3] };

    /// The shape by the signs of width, length and height (metres) of an IES file of a generation (its year).
    ///
    /// The length lies along the photometric horizontal, C0; a negative extent is a diameter. The table of the two
    /// generations as Radiance's `ies2rad` gives it (`makeiesshape`), extended by extents of which one is 0.
    /// `None` for signs without a meaning.
    pub fn from_ies(year: u32, [width, length, height]: [f64; 3]) -> Option<Self> {
        use OpeningShape::*;
        let sign = |x: f64| if x == 0.0 { 0 } else { x.signum() as i8 };
        let (w, l, h) = (width.abs(), length.abs(), height.abs());
        let (shape, size) = match (sign(width), sign(length), sign(height)) {
            (0, 0, 0) => (Point, [0.0; 3]),
            (1, 1, 0) => (Rectangle, [l, w, 0.0]),
            (1, 1, 1) => (Box, [l, w, h]),
            (1, 0, 1) => (Upright(0, Outline::Rectangle), [0.0, w, h]),
            (0, 1, 1) => (Upright(1, Outline::Rectangle), [l, 0.0, h]),
            // a diameter alone
            (-1, 0, 0) => (Ellipse, [w, w, 0.0]),
            (-1, 0, 1) => (Cylinder(2), [w, w, h]),
            (-1, 0, -1) if year < 2002 => (Ellipsoid, [w, w, h]),
            (-1, 0, -1) => (Upright(0, Outline::Ellipse), [0.0, w, h]),
            (-1, 1, 0) | (1, -1, 0) if year < 2002 => (Ellipse, [l, w, 0.0]),
            (-1, 1, 1) | (1, -1, 1) if year < 2002 => (Cylinder(2), [l, w, h]),
            (-1, 1, -1) | (1, -1, -1) if year < 2002 => (Ellipsoid, [l, w, h]),
            // 1995: the height is the diameter
            (0, 1, -1) if year < 2002 => (Cylinder(0), [l, h, h]),
            (1, 0, -1) if year < 2002 => (Cylinder(1), [h, w, h]),
            (-1, 1, -1) => (Cylinder(0), [l, w, h]),
            (1, -1, -1) => (Cylinder(1), [l, w, h]),
            (-1, -1, 0) => (Ellipse, [l, w, 0.0]),
            (-1, -1, 1) => (Cylinder(2), [l, w, h]),
            (-1, -1, -1) => (Ellipsoid, [l, w, h]),
            _ => return None,
        };
        Some(Opening { shape, size })
    }

    /// Width, length and height of a file of 2002 or later, the inverse of [`from_ies`](Self::from_ies).
    pub fn to_ies(self) -> [f64; 3] {
        use OpeningShape::*;
        let [x, y, z] = self.size;
        match self.shape {
            Point => [0.0; 3],
            Rectangle | Box | Upright(_, Outline::Rectangle) => [y, x, z],
            Ellipse | Ellipsoid => [-y, -x, -z],
            Cylinder(2) => [-y, -x, z],
            Cylinder(0) => [-y, x, -z],
            Cylinder(_) => [y, -x, -z],
            Upright(_, Outline::Ellipse) => [-y, 0.0, -z],
        }
    }

    /// What it is called.
    pub fn name(&self) -> &'static str {
        let [x, y, z] = self.size;
        let same = |a: f64, b: f64| (a - b).abs() <= 1e-6 * a.max(b);
        match self.shape {
            OpeningShape::Point => "point",
            OpeningShape::Rectangle => "rectangle",
            OpeningShape::Box => "box",
            OpeningShape::Ellipse if same(x, y) => "circle",
            OpeningShape::Ellipse => "ellipse",
            OpeningShape::Cylinder(2) => "vertical cylinder",
            OpeningShape::Cylinder(_) => "horizontal cylinder",
            OpeningShape::Ellipsoid if same(x, y) && same(y, z) => "sphere",
            OpeningShape::Ellipsoid => "ellipsoid",
            OpeningShape::Upright(_, Outline::Rectangle) => "upright rectangle",
            OpeningShape::Upright(_, Outline::Ellipse) if same(y, z) => "upright circle",
            OpeningShape::Upright(_, Outline::Ellipse) => "upright ellipse",
        }
    }

    /// The area of its shadow on a plane perpendicular to the unit direction `w`, m².
    pub fn projected_area(&self, w: Vec3<f64>) -> f64 {
        let [x, y, z] = self.size;
        let a = w.map(f64::abs);
        match self.shape {
            OpeningShape::Point => 0.0,
            OpeningShape::Rectangle => x * y * a.z,
            OpeningShape::Box => y * z * a.x + x * z * a.y + x * y * a.z,
            OpeningShape::Ellipse => FRAC_PI_4 * x * y * a.z,
            OpeningShape::Ellipsoid => {
                FRAC_PI_4 * ((y * z * a.x).powi(2) + (x * z * a.y).powi(2) + (x * y * a.z).powi(2)).sqrt()
            }
            OpeningShape::Cylinder(axis) => match axis {
                0 => FRAC_PI_4 * y * z * a.x + x * (y * a.z).hypot(z * a.y),
                1 => FRAC_PI_4 * x * z * a.y + y * (x * a.z).hypot(z * a.x),
                _ => FRAC_PI_4 * x * y * a.z + z * (x * a.y).hypot(y * a.x),
            },
            OpeningShape::Upright(axis, outline) => {
                let share = if outline == Outline::Ellipse { FRAC_PI_4 } else { 1.0 };
                share * if axis == 0 { y * z * a.x } else { x * z * a.y }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use lesk_math::vec3;

    #[test]
    fn signs_of_2002_are_undone_by_writing() {
        let extents = [-0.2, 0.0, 0.3];
        for w in extents {
            for l in extents {
                for h in extents {
                    let Some(opening) = Opening::from_ies(2002, [w, l, h]) else { continue };
                    let again = Opening::from_ies(2019, opening.to_ies());
                    assert_eq!(again, Some(opening), "{w} {l} {h}");
                }
            }
        }
    }

    #[test]
    fn projected_areas_are_those_of_solid_geometry() {
        use std::f64::consts::PI;
        let slanted = vec3(0.6, 0.0, -0.8);
        let area = |shape, size, w| Opening { shape, size }.projected_area(w);
        let close = |got: f64, expected: f64| assert!((got - expected).abs() < 1e-12, "{got} is not {expected}");
        close(area(OpeningShape::Rectangle, [2.0, 3.0, 0.0], slanted), 6.0 * 0.8);
        close(area(OpeningShape::Box, [2.0, 3.0, 0.5], slanted), 6.0 * 0.8 + 3.0 * 0.5 * 0.6);
        close(area(OpeningShape::Ellipsoid, [2.0; 3], slanted), PI);
        // an upright tube of diameter 2 and height 5 from the side, and from below
        close(area(OpeningShape::Cylinder(2), [2.0, 2.0, 5.0], vec3(0.6, 0.8, 0.0)), 10.0);
        close(area(OpeningShape::Cylinder(2), [2.0, 2.0, 5.0], vec3(0.0, 0.0, 1.0)), PI);
        close(area(OpeningShape::Cylinder(0), [5.0, 2.0, 2.0], vec3(0.0, 0.6, 0.8)), 10.0);
    }
}
