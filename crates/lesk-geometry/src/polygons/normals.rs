//! Vertex normals from faces, and vertices split where they differ.

use super::{Edge, EdgeKind, EdgeRule, NONE, PolygonMesh};
use crate::error::{Error, Result};
use crate::mesh::{Mesh, MeshData};
use crate::transform::narrow;
use lesk_math::Vec3;
use std::collections::HashMap;
use std::f64::consts::TAU;
use std::str::FromStr;

/// How the normal of a vertex comes from its surroundings.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum NormalRule {
    /// What the mesh states, analytic or from a file; angle-weighted where it states none.
    #[default]
    Given,
    /// That of the surface which the mesh approximates: only for meshes that know their surface.
    Analytic,
    /// The unweighted mean of the unit normals of the faces (Gouraud, *Continuous Shading of Curved Surfaces*, 1971).
    Mean,
    /// Weighted by the areas of the faces.
    Area,
    /// Weighted by the angles of the faces at the vertex (Thürmer & Wüthrich, *Computing Vertex Normals from Polygonal
    /// Facets*, Journal of Graphics Tools 3(1), 1998).
    Angle,
    /// Cross products of the two edges over their squared lengths: exact for polyhedra inscribed in a sphere (Max,
    /// *Weights for Computing Vertex Normals from Facet Normals*, Journal of Graphics Tools 4(2), 1999).
    Max1999,
}

impl NormalRule {
    /// All rules, the default first.
    pub const ALL: [Self; 6] = [Self::Given, Self::Analytic, Self::Mean, Self::Area, Self::Angle, Self::Max1999];

    /// Their names in commands and files, in the same order.
    pub const NAMES: [&str; 6] = ["given", "analytic", "mean", "area", "angle", "max1999"];

    /// Its name in commands and files.
    pub fn name(self) -> &'static str {
        Self::NAMES[self as usize]
    }
}

impl FromStr for NormalRule {
    type Err = Error;

    fn from_str(name: &str) -> Result<Self> {
        Self::ALL.into_iter().find(|rule| rule.name() == name).ok_or_else(|| {
            let known = Self::NAMES.join(", ");
            Error::new(format!("there is no rule `{name}` for normals, but {known} are accepted"))
        })
    }
}

/// Normals for shading.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Shading {
    /// Unit normals.
    pub normals: Vec<Vec3<f32>>,
    /// For each corner of the mesh, the number of its normal.
    pub corners: Vec<u32>,
}

/// Vertices, each with one position, one normal and one pair of texture coordinates.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Vertices {
    /// Positions, metres.
    pub positions: Vec<Vec3<f32>>,
    /// Unit normals, one per position.
    pub normals: Vec<Vec3<f32>>,
    /// Texture coordinates, one per position, or none at all.
    pub uvs: Vec<[f32; 2]>,
    /// For each corner of the mesh, the number of its vertex.
    pub corners: Vec<u32>,
}

/// Sets of corners that share a normal.
struct Fans {
    parent: Vec<u32>,
}

impl Fans {
    fn find(&mut self, mut c: u32) -> u32 {
        while self.parent[c as usize] != c {
            self.parent[c as usize] = self.parent[self.parent[c as usize] as usize];
            c = self.parent[c as usize];
        }
        c
    }

    fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.find(a), self.find(b));
        self.parent[a.max(b) as usize] = a.min(b);
    }
}

impl PolygonMesh {
    /// Normals of all corners. Around a vertex, the faces between real edges form a fan that has one normal; open
    /// borders and edges of more than two faces end a fan too.
    ///
    /// # Errors
    /// [`NormalRule::Analytic`] for a mesh that does not know its surface.
    pub fn shading(&self, rule: NormalRule, edges: EdgeRule) -> Result<Shading> {
        match rule {
            NormalRule::Analytic if !self.data.analytic => {
                let hint = "`given` takes those of the file, `mean`, `area`, `angle` and `max1999` make some";
                Err(Error::new("mesh knows no surface, so it has no analytic normals").hint(hint))
            }
            NormalRule::Analytic => Ok(self.given(edges)),
            NormalRule::Given if self.has_normals() => Ok(self.given(edges)),
            NormalRule::Given => Ok(self.computed(NormalRule::Angle, &self.edges(edges))),
            rule => Ok(self.computed(rule, &self.edges(edges))),
        }
    }

    fn given(&self, edges: EdgeRule) -> Shading {
        let corners: Vec<u32> = self.data.corners.iter().map(|c| c.normal).collect();
        if !corners.contains(&NONE) {
            return Shading { normals: self.data.normals.clone(), corners };
        }
        let made = self.computed(NormalRule::Angle, &self.edges(edges));
        let offset = self.data.normals.len() as u32;
        let pick = |(&own, &other): (&u32, &u32)| if own == NONE { offset + other } else { own };
        let corners = corners.iter().zip(&made.corners).map(pick).collect();
        Shading { normals: [&self.data.normals[..], &made.normals].concat(), corners }
    }

    fn computed(&self, rule: NormalRule, edges: &[Edge]) -> Shading {
        let count = self.data.corners.len();
        let mut fans = Fans { parent: (0..count as u32).collect() };
        for edge in edges.iter().filter(|e| e.kind == EdgeKind::Auxiliary) {
            let [(a, f), (b, g)] = edge.uses[..] else { continue };
            let next = |c: u32, f: u32| self.neighbours(f as usize, c as usize)[1] as u32;
            fans.join(a, next(b, g));
            fans.join(next(a, f), b);
        }
        let mut sums = vec![Vec3::<f64>::ZERO; count];
        for face in 0..self.face_count() {
            let area = self.area_vector(face);
            let normal = self.face_normal(face);
            for corner in self.face(face) {
                let fan = fans.find(corner as u32) as usize;
                sums[fan] = sums[fan] + self.contribution(rule, face, corner, area, normal);
            }
        }
        self.collect(&mut fans, &sums)
    }

    /// What a face adds to the normal of the fan at one of its corners.
    fn contribution(
        &self,
        rule: NormalRule,
        face: usize,
        corner: usize,
        area: Vec3<f64>,
        normal: Vec3<f64>,
    ) -> Vec3<f64> {
        let [previous, next] = self.neighbours(face, corner);
        let p = self.point(corner);
        let (a, b) = (self.point(next) - p, self.point(previous) - p);
        match rule {
            NormalRule::Mean => normal,
            NormalRule::Area => area,
            NormalRule::Max1999 => {
                let scale = a.length_squared() * b.length_squared();
                if scale > 0.0 { a.cross(b) * (1.0 / scale) } else { Vec3::ZERO }
            }
            _ => {
                // beyond pi where the polygon has a notch
                let angle = a.cross(b).dot(normal).atan2(a.dot(b));
                normal * if angle < 0.0 { angle + TAU } else { angle }
            }
        }
    }

    /// Numbers the fans in the order of their first corners.
    fn collect(&self, fans: &mut Fans, sums: &[Vec3<f64>]) -> Shading {
        let mut number = vec![NONE; sums.len()];
        let mut out = Shading::default();
        for face in 0..self.face_count() {
            for corner in self.face(face) {
                let fan = fans.find(corner as u32) as usize;
                if number[fan] == NONE {
                    number[fan] = out.normals.len() as u32;
                    out.normals.push(narrow(self.unit_or_face(sums[fan], face)));
                }
                out.corners.push(number[fan]);
            }
        }
        out
    }

    /// The direction of a sum; where its terms cancel, the normal of the face, or +z.
    fn unit_or_face(&self, sum: Vec3<f64>, face: usize) -> Vec3<f64> {
        let length = sum.length();
        if length > 0.0 && length.is_finite() {
            let unit = sum * (1.0 / length);
            return unit * (1.0 / unit.length());
        }
        let normal = self.face_normal(face);
        if normal == Vec3::ZERO { Vec3::Z } else { normal }
    }

    /// One vertex per distinct position, normal and texture coordinates.
    pub fn vertices(&self, shading: &Shading) -> Vertices {
        let mut out = Vertices::default();
        let has_uvs = self.data.corners.iter().any(|c| c.uv != NONE);
        let mut known: HashMap<[u32; 3], u32> = HashMap::with_capacity(self.data.positions.len());
        for (corner, &normal) in self.data.corners.iter().zip(&shading.corners) {
            let next = out.positions.len() as u32;
            let vertex = *known.entry([corner.position, normal, corner.uv]).or_insert(next);
            out.corners.push(vertex);
            if vertex != next {
                continue;
            }
            out.positions.push(self.data.positions[corner.position as usize]);
            out.normals.push(shading.normals[normal as usize]);
            if has_uvs {
                out.uvs.push(self.data.uvs.get(corner.uv as usize).copied().unwrap_or([0.0; 2]));
            }
        }
        out
    }

    /// The mesh cut into triangles, with the given normals; it keeps the polygons.
    ///
    /// # Errors
    /// More than 2^30 triangles.
    pub fn triangulated(&self, shading: &Shading) -> Result<Mesh> {
        let vertices = self.vertices(shading);
        let mut triangles = Vec::with_capacity(self.face_count());
        for face in 0..self.face_count() {
            let polygon = &vertices.corners[self.face(face)];
            super::triangulate(&vertices.positions, polygon, &mut triangles);
        }
        let (positions, normals, uvs) = (vertices.positions, vertices.normals, vertices.uvs);
        let data = MeshData { positions, normals, uvs, triangles, ..MeshData::default() };
        Ok(Mesh::new(data)?.0)
    }
}
