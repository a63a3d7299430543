//! Edges of polygon meshes: which are real, which only approximate a curved surface.

use super::{NONE, PolygonMesh};
use std::collections::HashSet;

/// The crease angle where a mesh says nothing of its edges, radians: 30 degrees, the default of Blender's `Shade Auto
/// Smooth` (Blender 4.1 manual).
pub const DEFAULT_CREASE: f64 = std::f64::consts::PI / 6.0;

/// Normals of one corner that differ by more than this cosine make a real edge: 0.06 degrees, well above the rounding of
/// normals in files with four decimals.
const COS_SAME: f64 = 1.0 - 5e-7;

/// How real edges are told from auxiliary ones.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum EdgeRule {
    /// As stored: sharp edges, smoothing groups, normals that differ. Where nothing is stored, by [`DEFAULT_CREASE`].
    Stored,
    /// Real where the normals of the two faces differ by more than this angle in radians.
    Crease(f64),
}

/// What an edge is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum EdgeKind {
    /// It belongs to the modelled shape: shading changes abruptly across it.
    Real,
    /// It only approximates a curved surface: shading is smooth across it.
    Auxiliary,
    /// One face only.
    Boundary,
    /// More than two faces, or two that wind against each other.
    NonManifold,
}

impl EdgeKind {
    /// All kinds.
    pub const ALL: [EdgeKind; 4] = [EdgeKind::Real, EdgeKind::Auxiliary, EdgeKind::Boundary, EdgeKind::NonManifold];

    /// Its name in reports.
    pub fn name(self) -> &'static str {
        match self {
            EdgeKind::Real => "real",
            EdgeKind::Auxiliary => "auxiliary",
            EdgeKind::Boundary => "boundary",
            EdgeKind::NonManifold => "non_manifold",
        }
    }
}

/// An edge with the corners of the faces at which it starts, each running to the next corner of its face.
#[derive(Clone, Debug, PartialEq)]
pub struct Edge {
    /// Positions at its ends, the smaller number first; equal coordinates have one number.
    pub ends: [u32; 2],
    /// Corner and face of each use.
    pub uses: Vec<(u32, u32)>,
    /// What it is.
    pub kind: EdgeKind,
    /// Whether exactly two faces use it, in the same direction: one of them winds the wrong way.
    pub twisted: bool,
    /// Angle between the normals of its two faces, radians; 0 without two faces that have an area.
    pub angle: f64,
}

impl PolygonMesh {
    /// All edges, by the numbers of their ends. Sides of a face whose ends coincide are no edges.
    pub fn edges(&self, rule: EdgeRule) -> Vec<Edge> {
        let rule = match rule {
            EdgeRule::Stored if !self.states_edges() => EdgeRule::Crease(DEFAULT_CREASE),
            rule => rule,
        };
        let order = |a: u32, b: u32| if a < b { [a, b] } else { [b, a] };
        let mut uses = Vec::with_capacity(self.data.corners.len());
        for face in 0..self.face_count() {
            for corner in self.face(face) {
                let next = self.neighbours(face, corner)[1];
                let (a, b) = (self.place(corner), self.place(next));
                if a != b {
                    uses.push((order(a, b), corner as u32, face as u32));
                }
            }
        }
        uses.sort_unstable();
        let weld = |&[a, b]: &[u32; 2]| order(self.weld[a as usize], self.weld[b as usize]);
        let sharp: HashSet<[u32; 2]> = self.data.sharp.iter().map(weld).collect();
        let edge = |same: &[([u32; 2], u32, u32)]| {
            let ends = same[0].0;
            let uses: Vec<(u32, u32)> = same.iter().map(|&(_, corner, face)| (corner, face)).collect();
            self.edge(ends, uses, rule, sharp.contains(&ends))
        };
        uses.chunk_by(|a, b| a.0 == b.0).map(edge).collect()
    }

    fn edge(&self, ends: [u32; 2], uses: Vec<(u32, u32)>, rule: EdgeRule, sharp: bool) -> Edge {
        let opposite = |a: u32, b: u32| self.place(a as usize) != self.place(b as usize);
        let mut edge = Edge { ends, uses, kind: EdgeKind::NonManifold, twisted: false, angle: 0.0 };
        match edge.uses[..] {
            [_] => edge.kind = EdgeKind::Boundary,
            [(a, f), (b, g)] => {
                let (n, m) = (self.face_normal(f as usize), self.face_normal(g as usize));
                edge.twisted = !opposite(a, b);
                edge.angle = if edge.twisted { 0.0 } else { n.cross(m).length().atan2(n.dot(m)) };
                if !edge.twisted {
                    let real = match rule {
                        EdgeRule::Crease(angle) => edge.angle > angle,
                        EdgeRule::Stored => sharp || self.stored_apart([(a, f), (b, g)]),
                    };
                    edge.kind = if real { EdgeKind::Real } else { EdgeKind::Auxiliary };
                }
            }
            _ => {}
        }
        edge
    }

    /// Whether smoothing groups or normals of the corners separate two faces along the edge that they share.
    fn stored_apart(&self, [(a, f), (b, g)]: [(u32, u32); 2]) -> bool {
        if let (Some(&s), Some(&t)) = (self.data.smoothing.get(f as usize), self.data.smoothing.get(g as usize))
            && (s != t || s == 0)
        {
            return true;
        }
        let next = |corner: u32, face: u32| self.neighbours(face as usize, corner as usize)[1];
        // each face runs along the edge the other way round
        [(a as usize, next(b, g)), (next(a, f), b as usize)].into_iter().any(|(c, d)| self.normals_differ(c, d))
    }

    fn normals_differ(&self, c: usize, d: usize) -> bool {
        let (i, j) = (self.data.corners[c].normal, self.data.corners[d].normal);
        if i == NONE || j == NONE || i == j {
            return false;
        }
        let normal = |i: u32| crate::transform::widen(self.data.normals[i as usize]);
        normal(i).dot(normal(j)) < COS_SAME
    }
}
