//! The samples of one triangle in Phong shading, eight at a time: a loop that is compiled for each instruction set.

use crate::inside::Triangle;
use crate::lanes::{Points, Rows3};
use crate::prepare::Vertex;
use crate::samples::Spot;
use crate::view::View;
use lesk_bsdf::kernels::BLOCK;
use std::array::from_fn;

/// Samples that are done at once.
pub(crate) const LANES: usize = 8;

/// A triangle, with what all of its samples share.
pub(crate) struct Face {
    pub number: u32,
    pub inside: Triangle,
    pub corners: [Vertex; 3],
    /// Unit.
    pub normal: [f32; 3],
    /// Where tangents matter.
    pub tangent: Option<[f32; 3]>,
    /// Whether texture coordinates matter.
    pub textured: bool,
}

/// Where a band of samples lies on the film.
#[derive(Clone, Copy)]
pub(crate) struct Place<'a> {
    pub view: &'a View,
    pub first_row: u32,
    pub width: u32,
}

/// A value at the three corners, as the first one and the ways to the others.
#[inline(always)]
fn ways(a: f32, b: f32, c: f32) -> [f32; 3] {
    [a, b - a, c - a]
}

#[inline(always)]
fn mix([a, ab, ac]: [f32; 3], u: &[f32; LANES], v: &[f32; LANES], out: &mut [f32; LANES]) {
    for l in 0..LANES {
        out[l] = a + ab * u[l] + ac * v[l];
    }
}

#[inline(always)]
fn eight<T>(row: &mut [T; BLOCK], i: usize) -> &mut [T; LANES] {
    row[i..].first_chunk_mut().expect("there is room for eight")
}

#[inline(always)]
fn fill(rows: &mut Rows3, i: usize, value: [f32; 3]) {
    for c in 0..3 {
        *eight(&mut rows[c], i) = [value[c]; LANES];
    }
}

/// Adds the points of samples. There must be room for their number rounded up to whole lanes.
#[inline(always)]
pub(crate) fn body(face: &Face, place: Place, spots: &[Spot], points: &mut Points) {
    let [a, b, c] = &face.corners;
    let [uv_a, uv_b, uv_c] = [a.uv, b.uv, c.uv];
    let p = [ways(a.p.x, b.p.x, c.p.x), ways(a.p.y, b.p.y, c.p.y), ways(a.p.z, b.p.z, c.p.z)];
    let n = [ways(a.n.x, b.n.x, c.n.x), ways(a.n.y, b.n.y, c.n.y), ways(a.n.z, b.n.z, c.n.z)];
    for spots in spots.chunks(LANES) {
        let i = points.n;
        // lanes without a sample repeat the last one; their results are never read
        let spots: [Spot; LANES] = from_fn(|l| spots[l.min(spots.len() - 1)]);
        let x: [f64; LANES] = from_fn(|l| place.view.column(spots[l].column()));
        let y: [f64; LANES] = from_fn(|l| place.view.line(place.first_row + spots[l].row()));
        let (mut u, mut v) = ([0.0; LANES], [0.0; LANES]);
        for l in 0..LANES {
            [u[l], v[l]] = face.inside.row(y[l]).weights(x[l]);
        }
        for c in 0..3 {
            mix(p[c], &u, &v, eight(&mut points.p[c], i));
            mix(n[c], &u, &v, eight(&mut points.ns[c], i));
        }
        fill(&mut points.ng, i, face.normal);
        if face.textured {
            for c in 0..2 {
                mix(ways(uv_a[c], uv_b[c], uv_c[c]), &u, &v, eight(&mut points.uv[c], i));
            }
        }
        if let Some(tangent) = face.tangent {
            fill(&mut points.tangent, i, tangent);
        }
        *eight(&mut points.target, i) = spots.map(|s| s.row() * place.width + s.column());
        *eight(&mut points.face, i) = [face.number; LANES];
        points.n = i + LANES;
    }
    points.n = points.n - spots.len().next_multiple_of(LANES) + spots.len();
}
