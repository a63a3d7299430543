//! Values inside a face from those at its corners.
//!
//! The weights of the corners at a sample: f_X = (1-γ)[(1-α) f_A + α f_C] + γ[(1-β) f_B + β f_D] with α along the left edge,
//! β along the right one and γ along the span; or barycentric coordinates. With perspective correction f/w and 1/w are
//! interpolated, and divided.

use crate::Correction;
use crate::clip::Clipped;
use crate::scan::{Crossing, cross, gamma};
use crate::view::{Screen, View};
use lesk_math::Vec3;

/// Barycentric weights in a triangle: linear functions of the ray, divided by their sum.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Triangle {
    /// Weight k is `sides[k] * ray`, before the division.
    sides: [Vec3<f64>; 3],
}

/// The weights along a row.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Line {
    slope: [f64; 3],
    start: [f64; 3],
}

impl Triangle {
    /// From the vertices themselves, not from their places on the grid: the ray of a sample meets the plane of the
    /// triangle at P_0 b_0 + P_1 b_1 + P_2 b_2 with b_k proportional to ray · (P_k+1 × P_k+2) (Olano & Greer, *Triangle
    /// Scan Conversion using 2D Homogeneous Coordinates*, Graphics Hardware 1997).
    #[inline]
    pub fn new(view: &View, corners: [Vec3<f32>; 3], correction: Correction) -> Triangle {
        let p = [view.relative(corners[0]), view.relative(corners[1]), view.relative(corners[2])];
        let sides = [p[1].cross(p[2]), p[2].cross(p[0]), p[0].cross(p[1])];
        let sign = if p[0].dot(sides[0]) < 0.0 { -1.0 } else { 1.0 };
        let scale = match correction {
            Correction::Perspective => [sign; 3],
            Correction::Screen => [-p[0].z * sign, -p[1].z * sign, -p[2].z * sign],
        };
        Triangle { sides: [sides[0] * scale[0], sides[1] * scale[1], sides[2] * scale[2]] }
    }

    /// The weights in a row whose rays have the given y.
    #[inline(always)]
    pub fn row(&self, y: f64) -> Line {
        let [a, b, c] = self.sides;
        Line { slope: [a.x, b.x, c.x], start: [a.y * y - a.z, b.y * y - b.z, c.y * y - c.z] }
    }
}

impl Line {
    /// Weights of the second and third corner at the ray with the given x; clamped to the triangle, which the grid may
    /// leave by half a step.
    #[inline(always)]
    pub fn weights(&self, x: f64) -> [f32; 2] {
        let b = [0, 1, 2].map(|k| (self.slope[k] * x + self.start[k]).max(0.0));
        let sum = b[0] + b[1] + b[2];
        let inverse = 1.0 / sum;
        if sum > 0.0 { [(b[1] * inverse) as f32, (b[2] * inverse) as f32] } else { [1.0 / 3.0; 2] }
    }
}

/// Corners with their weights; weights add up to 1.
pub(crate) type Weighted = Vec<(u32, f64)>;

/// A polygon in one row.
#[derive(Default)]
pub(crate) struct Row {
    corners: Vec<Screen>,
    crossings: Vec<Crossing>,
}

impl Row {
    /// A whole face.
    pub fn face(&mut self, corners: &[u32], screen: &[Screen], y: u32) {
        self.corners.clear();
        self.corners.extend(corners.iter().map(|&v| screen[v as usize]));
        cross(&self.corners, y, &mut self.crossings);
    }

    #[cfg(test)]
    pub fn of(&mut self, corners: &[Screen], y: u32) {
        self.corners = corners.to_vec();
        cross(&self.corners, y, &mut self.crossings);
    }

    /// What clipping left.
    pub fn clipped(&mut self, clipped: &Clipped, y: u32) {
        self.corners.clear();
        self.corners.extend(clipped.corners.iter().map(|c| c.screen));
        cross(&self.corners, y, &mut self.crossings);
    }

    /// Numbers of corners with their weights at a column; nothing where no span holds it.
    pub fn weights(&self, x: u32, correction: Correction, out: &mut Weighted) {
        out.clear();
        let holds = |pair: &&[Crossing; 2]| pair[0].column <= f64::from(x) && f64::from(x) < pair[1].column;
        let Some([left, right]) = self.crossings.as_chunks::<2>().0.iter().find(holds) else { return };
        let gamma = gamma(left.x, right.x, x);
        let mut sum = 0.0;
        for (crossing, share) in [(left, 1.0 - gamma), (right, gamma)] {
            for (end, part) in [(0, 1.0 - crossing.share), (1, crossing.share)] {
                let corner = crossing.ends[end];
                let inverse_w = f64::from(self.corners[corner].inverse_w);
                let weight = share * part * if correction == Correction::Perspective { inverse_w } else { 1.0 };
                sum += weight;
                out.push((corner as u32, weight));
            }
        }
        out.iter_mut().for_each(|(_, w)| *w /= sum);
    }
}

/// Weights of clipped corners as weights of the vertices of the whole face.
pub(crate) fn unclip(clipped: &Clipped, face: &[u32], weights: &Weighted, out: &mut Weighted) {
    out.clear();
    out.extend(face.iter().map(|&v| (v, 0.0)));
    for &(corner, weight) in weights {
        for (total, part) in out.iter_mut().zip(&clipped.corners[corner as usize].weights) {
            total.1 += weight * part;
        }
    }
}
