//! Axis-aligned boxes.

use crate::transform::Transform;
use lesk_math::{Vec3, vec3};

/// An axis-aligned box, metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Smallest coordinates; +infinity where the box is empty.
    pub min: Vec3<f32>,
    /// Largest coordinates; -infinity where the box is empty.
    pub max: Vec3<f32>,
}

impl Bounds {
    /// Holds nothing.
    pub const EMPTY: Self = Bounds {
        min: vec3(f32::INFINITY, f32::INFINITY, f32::INFINITY),
        max: vec3(f32::NEG_INFINITY, f32::NEG_INFINITY, f32::NEG_INFINITY),
    };

    /// Grows to hold the point.
    #[inline]
    pub fn add(&mut self, p: Vec3<f32>) {
        self.min = vec3(self.min.x.min(p.x), self.min.y.min(p.y), self.min.z.min(p.z));
        self.max = vec3(self.max.x.max(p.x), self.max.y.max(p.y), self.max.z.max(p.z));
    }

    /// The smallest box around both.
    #[must_use]
    pub fn union(mut self, o: Bounds) -> Bounds {
        if !o.is_empty() {
            self.add(o.min);
            self.add(o.max);
        }
        self
    }

    /// Whether it holds no point.
    pub fn is_empty(&self) -> bool {
        self.min.x > self.max.x
    }

    /// The middle; zero for an empty box.
    pub fn center(&self) -> Vec3<f32> {
        if self.is_empty() { Vec3::ZERO } else { (self.min + self.max) * 0.5 }
    }

    /// Half the length of the diagonal, metres; zero for an empty box.
    pub fn radius(&self) -> f32 {
        if self.is_empty() { 0.0 } else { (self.max - self.min).length() * 0.5 }
    }

    /// The eight corners.
    pub fn corners(&self) -> [Vec3<f32>; 8] {
        let pick = |bit: usize, lo: f32, hi: f32| if bit != 0 { hi } else { lo };
        std::array::from_fn(|i| {
            vec3(
                pick(i & 1, self.min.x, self.max.x),
                pick(i & 2, self.min.y, self.max.y),
                pick(i & 4, self.min.z, self.max.z),
            )
        })
    }

    /// A box around the transformed box.
    #[must_use]
    pub fn transformed(&self, t: &Transform) -> Bounds {
        let mut out = Bounds::EMPTY;
        if !self.is_empty() {
            self.corners().iter().for_each(|&c| out.add(t.point(c)));
        }
        out
    }

    /// The largest absolute coordinate; 0 for an empty box.
    pub(crate) fn reach(&self) -> f32 {
        let all = [self.min.to_array(), self.max.to_array()];
        if self.is_empty() { 0.0 } else { all.iter().flatten().fold(0.0, |m, x| x.abs().max(m)) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_box_of_a_turned_cube_is_wider_by_root_two() {
        let unit = Bounds { min: vec3(-1.0, -1.0, -1.0), max: vec3(1.0, 1.0, 1.0) };
        let turned = unit.transformed(&Transform::rotate_z(std::f64::consts::FRAC_PI_4));
        assert!((turned.max.x - 2f32.sqrt()).abs() < 4.0 * f32::EPSILON);
        assert_eq!(turned.max.z, 1.0);
    }

    #[test]
    fn the_empty_box_is_neutral() {
        let unit = Bounds { min: vec3(0.0, 0.0, 0.0), max: vec3(1.0, 2.0, 3.0) };
        assert_eq!(Bounds::EMPTY.union(unit), unit);
        assert_eq!(unit.union(Bounds::EMPTY), unit);
        assert_eq!((Bounds::EMPTY.radius(), Bounds::EMPTY.reach()), (0.0, 0.0));
    }
}
