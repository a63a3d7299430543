//! The parts of an emissive mesh: each is one light for the purpose of choosing.

use crate::rectangle::Rectangle;
use crate::triangle::Triangle;
use lesk_geometry::{Bounds, Mesh, SurfaceSample, Transform};
use lesk_math::Vec3;
use std::collections::HashMap;

/// A triangle with its number, or two that are a rectangle.
#[derive(Clone, Debug)]
enum Part {
    Triangle(Triangle, u32),
    Rectangle(Rectangle),
}

/// Where a part is.
pub(crate) struct Extent {
    /// Square metres.
    pub area: f32,
    pub bounds: Bounds,
    /// Unit, to the outside.
    pub normal: Vec3<f32>,
}

/// All parts of a placed mesh.
#[derive(Clone, Debug, Default)]
pub(crate) struct Parts {
    list: Vec<Part>,
    /// The part of each triangle; `NONE` for one that vanishes.
    of: Vec<u32>,
}

const NONE: u32 = u32::MAX;

impl Parts {
    /// Every triangle by itself.
    pub fn triangles(mesh: &Mesh, place: &Transform) -> Self {
        let mut parts = Parts::default();
        for prim in 0..mesh.triangles().len() {
            let part = Triangle::new(mesh, prim, place).map(|triangle| parts.add(triangle, prim));
            parts.of.push(part.unwrap_or(NONE));
        }
        parts
    }

    /// Two triangles that make a rectangle as one part, every other triangle by itself.
    pub fn rectangles(mesh: &Mesh, place: &Transform) -> Self {
        let mut parts = Parts::default();
        // the halves of a rectangle share their longest side
        let mut by_side = HashMap::new();
        for prim in 0..mesh.triangles().len() {
            let Some(triangle) = Triangle::new(mesh, prim, place) else {
                parts.of.push(NONE);
                continue;
            };
            let side = side(&triangle);
            let half = by_side.get(&side).copied().filter(|&other| parts.join(other, &triangle, prim));
            let part = half.unwrap_or_else(|| {
                let part = parts.add(triangle, prim);
                by_side.insert(side, part);
                part
            });
            parts.of.push(part);
        }
        parts
    }

    fn add(&mut self, triangle: Triangle, prim: usize) -> u32 {
        self.list.push(Part::Triangle(triangle, prim as u32));
        self.list.len() as u32 - 1
    }

    /// Makes a rectangle of a part and a triangle, if they are one.
    fn join(&mut self, part: u32, second: &Triangle, prim: usize) -> bool {
        let part = &mut self.list[part as usize];
        let Part::Triangle(first, first_prim) = part else { return false };
        let rectangle = Rectangle::of(first, second, [*first_prim, prim as u32]);
        rectangle.map(|rectangle| *part = Part::Rectangle(rectangle)).is_some()
    }

    pub fn len(&self) -> usize {
        self.list.len()
    }

    /// The part that a triangle belongs to.
    #[inline]
    pub fn part_of(&self, prim: u32) -> Option<u32> {
        self.of.get(prim as usize).copied().filter(|&part| part != NONE)
    }

    /// The triangle of a part that is one.
    pub fn triangle(&self, part: u32) -> Option<(&Triangle, u32)> {
        match self.list.get(part as usize) {
            Some(Part::Triangle(triangle, prim)) => Some((triangle, *prim)),
            _ => None,
        }
    }

    /// A part that is a rectangle.
    #[inline]
    pub fn rectangle(&self, part: u32) -> Option<&Rectangle> {
        match self.list.get(part as usize) {
            Some(Part::Rectangle(rectangle)) => Some(rectangle),
            _ => None,
        }
    }

    /// A point of a part for the receiver at `x`; its `pdf` is per steradian.
    #[inline]
    pub fn sample_from(&self, part: u32, x: Vec3<f32>, u: [f32; 2]) -> Option<SurfaceSample> {
        match self.list.get(part as usize)? {
            Part::Triangle(triangle, prim) => triangle.sample_from(x, *prim, u),
            Part::Rectangle(rectangle) => rectangle.sample_from(x, u),
        }
    }

    /// The density of [`sample_from`](Self::sample_from) at the point `p` of a triangle, 1/sr.
    #[inline]
    pub fn pdf_from(&self, x: Vec3<f32>, prim: u32, p: Vec3<f32>) -> f32 {
        match self.part_of(prim).map(|part| &self.list[part as usize]) {
            Some(Part::Triangle(triangle, _)) => triangle.pdf_from(x, p),
            Some(Part::Rectangle(rectangle)) => rectangle.pdf_from(x, p),
            None => 0.0,
        }
    }

    /// Where each part is.
    pub fn extents(&self) -> impl Iterator<Item = Extent> {
        self.list.iter().map(|part| {
            let (area, corners, normal) = match part {
                Part::Triangle(triangle, _) => (triangle.area(), triangle.corners(), triangle.normal()),
                Part::Rectangle(rectangle) => (rectangle.area(), rectangle.corners(), rectangle.normal()),
            };
            let mut bounds = Bounds::EMPTY;
            corners.iter().for_each(|c| bounds.add(*c));
            Extent { area, bounds, normal }
        })
    }
}

/// The longest side of a triangle by the bits of its ends: corners that coincide need not have the same number.
fn side(triangle: &Triangle) -> [[u32; 3]; 2] {
    // adding 0 turns -0 into 0
    let [_, a, b] = triangle.apex_first().map(|p| p.to_array().map(|x| (x + 0.0).to_bits()));
    [a.min(b), a.max(b)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use lesk_geometry::{MeshData, cube, icosphere};
    use lesk_math::vec3;

    fn mesh(positions: &[[f32; 3]], triangles: &[[u32; 3]]) -> Mesh {
        let positions = positions.iter().map(|p| Vec3::from(*p)).collect();
        Mesh::new(MeshData { positions, triangles: triangles.to_vec(), ..MeshData::default() }).unwrap().0
    }

    const SQUARE: [[f32; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];

    fn part_count(positions: &[[f32; 3]], triangles: &[[u32; 3]]) -> usize {
        Parts::rectangles(&mesh(positions, triangles), &Transform::IDENTITY).len()
    }

    #[test]
    fn two_halves_of_a_rectangle_are_one_part_wherever_they_begin() {
        for first in [[0, 1, 2], [1, 2, 0], [2, 0, 1]] {
            for second in [[0, 2, 3], [2, 3, 0], [3, 0, 2]] {
                assert_eq!(part_count(&SQUARE, &[first, second]), 1);
                assert_eq!(part_count(&SQUARE, &[second, first]), 1);
            }
        }
    }

    #[test]
    fn what_is_no_rectangle_stays_two_triangles() {
        let with = |third: [f32; 3]| [SQUARE[0], SQUARE[1], third, SQUARE[3]];
        // a kite, a parallelogram, a bent square
        assert_eq!(part_count(&with([1.2, 1.2, 0.0]), &[[0, 1, 2], [0, 2, 3]]), 2);
        let sheared = [[0.0; 3], [1.0, 0.0, 0.0], [1.2, 1.0, 0.0], [0.2, 1.0, 0.0]];
        assert_eq!(part_count(&sheared, &[[0, 1, 2], [0, 2, 3]]), 2);
        let bent = [SQUARE[0], SQUARE[1], SQUARE[2], [0.0, 1.0, 0.01]];
        assert_eq!(part_count(&bent, &[[0, 1, 2], [0, 2, 3]]), 2);
        // one face up, one down; and the same triangle twice
        assert_eq!(part_count(&SQUARE, &[[0, 1, 2], [0, 3, 2]]), 2);
        assert_eq!(part_count(&SQUARE, &[[0, 1, 2], [0, 1, 2]]), 2);
    }

    #[test]
    fn a_cube_has_six_parts_and_a_sphere_one_per_triangle() {
        let turn = Transform::rotate(vec3(1.0, 2.0, 3.0), 0.8).unwrap() * Transform::translate(5.0, 0.3, -8.0);
        assert_eq!(Parts::rectangles(&cube(), &turn).len(), 6);
        assert_eq!(Parts::triangles(&cube(), &turn).len(), 12);
        assert_eq!(Parts::rectangles(&icosphere(2), &turn).len(), 320);
    }

    #[test]
    fn squares_of_two_centimetres_far_from_the_origin_are_found() {
        // corners rounded to f32 at 100 m: half a roundings is 4e-6 m
        let corner = |x: f64, y: f64| {
            [(100.3 + 0.01 * (0.8 * x - 0.6 * y)) as f32, (77.7 + 0.01 * (0.6 * x + 0.8 * y)) as f32, 3.1]
        };
        let square = [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
        assert_eq!(part_count(&square, &[[0, 1, 2], [0, 2, 3]]), 1);
    }
}
