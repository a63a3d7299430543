//! What is to be said about a mesh.

use super::{Edge, EdgeKind, EdgeRule, PolygonMesh};
use std::collections::{BTreeMap, HashMap};

/// Places that a report lists of each kind; all are counted.
pub const MAX_LISTED: usize = 20;

/// Normals that point to the other side of their face by more than rounding.
const COS_BEYOND: f64 = -1e-6;

/// Facts about a polygon mesh.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MeshReport {
    /// Positions that differ.
    pub positions: usize,
    /// Faces by their number of corners.
    pub faces: BTreeMap<u32, usize>,
    /// Triangles that they make.
    pub triangles: usize,
    /// Surface area, m².
    pub area: f64,
    /// Faces without an area.
    pub degenerate_faces: usize,
    /// Faces whose corners leave the plane of the face by more than 1 % of its size.
    pub bent_faces: usize,
    /// Edges by kind, in the order of [`EdgeKind::ALL`].
    pub edges: [usize; 4],
    /// Edges that two faces run along in the same direction: one of them winds the wrong way.
    pub twisted_edges: usize,
    /// The first edges that are not manifold, as pairs of positions.
    pub non_manifold: Vec<[[f32; 3]; 2]>,
    /// Vertices at which separate fans of faces touch.
    pub pinched_vertices: usize,
    /// The first of them.
    pub pinched: Vec<[f32; 3]>,
    /// Corners that state a normal.
    pub stated_normals: usize,
    /// Of these, how many point to the back of their face.
    pub opposed_normals: usize,
    /// The largest angle between a stated normal and its face, radians.
    pub largest_deviation: f64,
    /// Whether the faces close a volume: no border, every edge manifold.
    pub closed: bool,
}

impl PolygonMesh {
    /// Facts about faces, edges and normals.
    pub fn report(&self, rule: EdgeRule) -> MeshReport {
        let edges = self.edges(rule);
        let mut out = MeshReport { positions: self.distinct_positions(), ..MeshReport::default() };
        for face in 0..self.face_count() {
            self.add_face(face, &mut out);
        }
        self.add_edges(&edges, &mut out);
        self.add_pinched(&edges, &mut out);
        out
    }

    fn distinct_positions(&self) -> usize {
        let mut used = vec![false; self.data.positions.len()];
        (0..self.data.corners.len()).for_each(|c| used[self.place(c) as usize] = true);
        used.iter().filter(|u| **u).count()
    }

    fn add_face(&self, face: usize, out: &mut MeshReport) {
        let range = self.face(face);
        *out.faces.entry(range.len() as u32).or_default() += 1;
        out.triangles += range.len() - 2;
        let area = self.area_vector(face).length();
        out.area += area;
        if area == 0.0 {
            out.degenerate_faces += 1;
            return;
        }
        let normal = self.face_normal(face);
        let origin = self.point(range.start);
        let height = range.clone().map(|c| (self.point(c) - origin).dot(normal).abs()).fold(0.0, f64::max);
        out.bent_faces += usize::from(height > 0.01 * area.sqrt());
        for own in range.filter_map(|c| self.normal_of(c)) {
            out.stated_normals += 1;
            out.opposed_normals += usize::from(own.dot(normal) < COS_BEYOND);
            let angle = own.cross(normal).length().atan2(own.dot(normal));
            out.largest_deviation = out.largest_deviation.max(angle);
        }
    }

    fn add_edges(&self, edges: &[Edge], out: &mut MeshReport) {
        for edge in edges {
            let kind = EdgeKind::ALL.iter().position(|k| *k == edge.kind).expect("the list holds every kind");
            out.edges[kind] += 1;
            out.twisted_edges += usize::from(edge.twisted);
            if edge.kind == EdgeKind::NonManifold && out.non_manifold.len() < MAX_LISTED {
                out.non_manifold.push(edge.ends.map(|p| self.data.positions[p as usize].to_array()));
            }
        }
        out.closed = !edges.is_empty() && out.edges[2] == 0 && out.edges[3] == 0;
    }

    /// A vertex is pinched where its corners, joined across all edges, fall into several groups.
    fn add_pinched(&self, edges: &[Edge], out: &mut MeshReport) {
        let mut parent: Vec<u32> = (0..self.data.corners.len() as u32).collect();
        fn find(parent: &mut [u32], mut c: u32) -> u32 {
            while parent[c as usize] != c {
                parent[c as usize] = parent[parent[c as usize] as usize];
                c = parent[c as usize];
            }
            c
        }
        for edge in edges {
            let at = |end: u32, (corner, face): (u32, u32)| {
                let next = self.neighbours(face as usize, corner as usize)[1];
                if self.place(corner as usize) == end { corner } else { next as u32 }
            };
            for pair in edge.uses.windows(2) {
                for end in edge.ends {
                    let (a, b) = (find(&mut parent, at(end, pair[0])), find(&mut parent, at(end, pair[1])));
                    parent[a.max(b) as usize] = a.min(b);
                }
            }
        }
        let mut root_of: HashMap<u32, u32> = HashMap::new();
        let mut pinched = std::collections::BTreeSet::new();
        for corner in 0..self.data.corners.len() {
            let root = find(&mut parent, corner as u32);
            let place = self.place(corner);
            if *root_of.entry(place).or_insert(root) != root {
                pinched.insert(place);
            }
        }
        out.pinched_vertices = pinched.len();
        let position = |&p: &u32| self.data.positions[p as usize].to_array();
        out.pinched = pinched.iter().take(MAX_LISTED).map(position).collect();
    }
}
