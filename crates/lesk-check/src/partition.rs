//! The sphere cut into cells that are small where given directions lie close together.
//!
//! Cells are rectangles of an angle psi in [0, pi/2] and the azimuth phi of each hemisphere, with |cos theta| = cos^2 psi
//! and dw = sin(2 psi) dpsi dphi. A function that is smooth on the sphere is smooth in them, the pole included;
//! 1 - |cos theta| = sin^2 psi and |cos theta| keep their digits at both ends, and what happens close to the horizon
//! (facets that turn away, masking) is as wide as the root of its cosines.

use lesk_bsdf::model::Domain;
use lesk_math::{Vec3, vec3};
use std::f64::consts::{FRAC_PI_2, TAU};

/// A place in the coordinates of the module.
#[derive(Clone, Copy, Debug)]
pub struct Place {
    /// Below the surface.
    pub below: bool,
    /// psi 0 to pi / 2, azimuth 0 to 2 pi.
    pub at: [f64; 2],
}

impl Place {
    /// The place of a unit direction.
    pub fn of(w: Vec3<f64>) -> Place {
        // sin^2 psi = 1 - |z| = (x^2 + y^2) / (1 + |z|), without cancellation near the pole
        let psi = (w.x.hypot(w.y) / (1.0 + w.z.abs()).sqrt()).atan2(w.z.abs().sqrt()).min(FRAC_PI_2);
        // rounding may carry a tiny negative azimuth to 2 pi
        let phi = w.y.atan2(w.x).rem_euclid(TAU).min(TAU);
        Place { below: w.z < 0.0, at: [psi, phi] }
    }

    /// Its direction.
    pub fn direction(self) -> Vec3<f64> {
        let [psi, phi] = self.at;
        let (s, c) = psi.sin_cos();
        let z = c * c;
        // sin theta, which keeps its digits where 1 - z does not
        let s = s * (1.0 + z).sqrt();
        vec3(s * phi.cos(), s * phi.sin(), if self.below { -z } else { z })
    }
}

/// A rectangle of one hemisphere.
#[derive(Clone, Copy, Debug)]
pub struct Cell {
    /// Below the surface.
    pub below: bool,
    /// Lower ends of psi and azimuth.
    pub lo: [f64; 2],
    /// Upper ends.
    pub hi: [f64; 2],
}

impl Cell {
    /// The halves on both sides of the middle of `axis`.
    pub fn halves(self, axis: usize) -> [Cell; 2] {
        let middle = 0.5 * (self.lo[axis] + self.hi[axis]);
        let (mut a, mut b) = (self, self);
        a.hi[axis] = middle;
        b.lo[axis] = middle;
        [a, b]
    }

    /// Whether it cannot be halved further in floating point.
    pub fn is_tiny(&self, axis: usize) -> bool {
        let middle = 0.5 * (self.lo[axis] + self.hi[axis]);
        middle <= self.lo[axis] || middle >= self.hi[axis]
    }
}

enum Node {
    Leaf(usize),
    Split { axis: usize, at: f64, below_above: [usize; 2] },
}

/// Cells that tile the sphere or one hemisphere, and the way from a direction to its cell.
pub struct Partition {
    /// The cells.
    pub cells: Vec<Cell>,
    nodes: Vec<Node>,
    /// The root nodes of the upper and the lower hemisphere.
    roots: [Option<usize>; 2],
}

/// Halvings along one path; 2^-40 of a range is below every lobe that legal parameters make.
const MAX_DEPTH: usize = 80;

impl Partition {
    /// Halves the cells that hold more than `most` of the directions, or are larger than half the range of psi or a
    /// quarter turn in azimuth.
    pub fn new(domain: Domain, directions: &[Vec3<f64>], most: usize) -> Partition {
        let mut partition = Partition { cells: Vec::new(), nodes: Vec::new(), roots: [None; 2] };
        let sides: &[bool] = if domain == Domain::Upper { &[false] } else { &[false, true] };
        for &below in sides {
            let places = directions.iter().map(|&w| Place::of(w)).filter(|p| p.below == below).map(|p| p.at);
            let cell = Cell { below, lo: [0.0, 0.0], hi: [FRAC_PI_2, TAU] };
            let root = partition.grow(cell, places.collect(), most.max(1), 0);
            partition.roots[usize::from(below)] = Some(root);
        }
        partition
    }

    fn grow(&mut self, cell: Cell, places: Vec<[f64; 2]>, most: usize, depth: usize) -> usize {
        let size = [(cell.hi[0] - cell.lo[0]) / FRAC_PI_2, (cell.hi[1] - cell.lo[1]) / TAU];
        let coarse = size[0] > 0.5 || size[1] > 0.25;
        let axis = if coarse { usize::from(size[1] > 0.25) } else { axis_to_halve(&cell, &places) };
        if depth >= MAX_DEPTH || cell.is_tiny(axis) || !coarse && places.len() <= most {
            self.cells.push(cell);
            self.nodes.push(Node::Leaf(self.cells.len() - 1));
            return self.nodes.len() - 1;
        }
        let [a, b] = cell.halves(axis);
        let at = b.lo[axis];
        let (low, high) = places.into_iter().partition(|p| p[axis] < at);
        let below_above = [self.grow(a, low, most, depth + 1), self.grow(b, high, most, depth + 1)];
        self.nodes.push(Node::Split { axis, at, below_above });
        self.nodes.len() - 1
    }

    /// The index of the cell of a direction; none for the other hemisphere of a one-sided domain.
    pub fn find(&self, w: Vec3<f64>) -> Option<usize> {
        let place = Place::of(w);
        let mut node = self.roots[usize::from(place.below)]?;
        loop {
            match &self.nodes[node] {
                Node::Leaf(cell) => return Some(*cell),
                Node::Split { axis, at, below_above } => {
                    node = below_above[usize::from(place.at[*axis] >= *at)];
                }
            }
        }
    }
}

/// The directions and, around them, each one's mirror image about the one before: a halo a lobe's width wide, so that
/// its flanks lie in small cells as well.
pub fn with_halo(mut directions: Vec<Vec3<f64>>) -> Vec<Vec3<f64>> {
    let halo: Vec<Vec3<f64>> = directions.windows(2).map(|pair| pair[1].reflect(pair[0])).collect();
    directions.extend(halo);
    directions
}

/// The axis along which to halve: that along which the middle half of the places is narrower by far, compared with the
/// cell, or else the longer one on the sphere.
fn axis_to_halve(cell: &Cell, places: &[[f64; 2]]) -> usize {
    let spread = |axis: usize| {
        let mut at: Vec<f64> = places.iter().map(|p| p[axis]).collect();
        at.sort_by(f64::total_cmp);
        let quartile = |q: usize| at.get(at.len() * q / 4).copied().unwrap_or(0.0);
        (quartile(3) - quartile(1)) / (cell.hi[axis] - cell.lo[axis])
    };
    let (psi, phi) = (spread(0), spread(1));
    let middle = 0.5 * (cell.lo[0] + cell.hi[0]);
    let longer = usize::from((cell.hi[1] - cell.lo[1]) * middle.sin() > cell.hi[0] - cell.lo[0]);
    if psi.max(phi) > 2.0 * psi.min(phi) { usize::from(phi < psi) } else { longer }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::directions::from_cosine;
    use crate::random::Random;

    #[test]
    fn a_place_gives_back_its_direction() {
        let mut rng = Random::new("place", 0);
        for _ in 0..1000 {
            let z = 10f64.powf(rng.within(-6.0, 0.0)) * if rng.chance(0.5) { -1.0 } else { 1.0 };
            let w = from_cosine(z, rng.within(0.0, TAU));
            // both ways lose a few ulp
            assert!((Place::of(w).direction() - w).length() < 8.0 * f64::EPSILON);
        }
    }

    #[test]
    fn every_direction_lies_in_the_cell_that_is_found() {
        let mut rng = Random::new("cells", 0);
        let mut draw = || from_cosine(rng.within(0.999, 1.0), rng.within(0.0, TAU));
        let directions: Vec<_> = (0..500).map(|_| draw()).collect();
        let partition = Partition::new(Domain::Upper, &directions, 4);
        for w in directions {
            let cell = &partition.cells[partition.find(w).unwrap()];
            let at = Place::of(w).at;
            assert!((0..2).all(|axis| cell.lo[axis] <= at[axis] && at[axis] <= cell.hi[axis]));
        }
    }
}
