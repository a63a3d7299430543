//! Four triangles against one ray, without gaps between neighbours.
//!
//! Woop, Benthin & Wald, *Watertight Ray/Triangle Intersection*, JCGT 2(1), 2013. Names as there.
//! DEPARTS: edge functions that are exactly zero count as inside for both neighbours instead of being evaluated again
//! in f64, which keeps the seam closed and may report a neighbour that the ray misses by a rounding error.

use super::simd::F4;

/// Four triangles, corner by corner, coordinate by coordinate; unused lanes hold NaN.
#[derive(Clone, Debug)]
#[repr(C, align(32))]
pub(super) struct Block {
    /// Rows 0..3: first corner; 3..6 second; 6..9 third.
    pub corners: [[f32; 4]; 9],
    /// What each lane is.
    pub id: [u32; 4],
}

impl Block {
    pub const EMPTY: Self = Block { corners: [[f32::NAN; 4]; 9], id: [u32::MAX; 4] };
}

/// What the test precomputes per ray: the axis along which the direction is longest, and the shear that maps the
/// direction to it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shear {
    /// Shear of x and y, scale of z.
    pub s: [f32; 3],
    /// The origin along kx, ky, kz.
    pub o: [f32; 3],
    /// The axes kx, ky, kz, each below 3.
    k: [u8; 3],
}

impl Shear {
    #[inline(always)]
    pub fn new(o: [f32; 3], d: [f32; 3]) -> Self {
        let axes @ [kx, ky, kz] = AXES[longest(d)].map(usize::from);
        let sz = 1.0 / d[kz];
        Shear { s: [d[kx] * sz, d[ky] * sz, sz], o: axes.map(|k| o[k]), k: axes.map(|k| k as u8) }
    }
}

/// kx, ky, kz by kz; the winding does not matter: both sides are hit. A table, since no processor foresees which.
const AXES: [[u8; 3]; 3] = [[1, 2, 0], [2, 0, 1], [0, 1, 2]];

/// The axis along which a direction is longest.
#[inline(always)]
fn longest(d: [f32; 3]) -> usize {
    let [x, y, z] = d.map(f32::abs);
    let (longest, k) = if x > y { (x, 0) } else { (y, 1) };
    if longest > z { k } else { 2 }
}

/// The lanes that the ray's line meets, with their parameter.
pub(super) struct Lanes {
    pub mask: u32,
    pub t: F4,
}

/// Edge functions U, V, W and sheared z of the three corners, per lane.
struct Edges {
    u: F4,
    v: F4,
    w: F4,
    z: [F4; 3],
}

#[inline(always)]
fn edges(block: &Block, ray: &Shear) -> Edges {
    let (sx, sy, o) = (F4::splat(ray.s[0]), F4::splat(ray.s[1]), ray.o.map(F4::splat));
    let [kx, ky, kz] = ray.k;
    let corner = |i: usize| {
        // SAFETY: axes are below 3
        let row = |k: u8| F4::load(unsafe { block.corners.get_unchecked(3 * i + k as usize) });
        let z = row(kz) - o[2];
        (row(kx) - o[0] - sx * z, row(ky) - o[1] - sy * z, z)
    };
    let ((ax, ay, az), (bx, by, bz), (cx, cy, cz)) = (corner(0), corner(1), corner(2));
    Edges { u: cx * by - cy * bx, v: ax * cy - ay * cx, w: bx * ay - by * ax, z: [az, bz, cz] }
}

/// Tests four triangles; hits have `t_min < t <= t_max`. `FORESEES` is for rays on their own: a processor that foresees a
/// miss goes on before it is certain.
#[inline(always)]
pub(super) fn intersect<const FORESEES: bool>(block: &Block, ray: &Shear, t_min: f32, t_max: f32) -> Lanes {
    let e = edges(block, ray);
    let zero = F4::splat(0.0);
    // all of one sign: the smallest is not negative, or the largest is not positive; NaN lanes fail both
    let lowest = e.u.min(e.v).min(e.w);
    let highest = e.u.max(e.v).max(e.w);
    let mask = zero.le(lowest) | highest.le(zero);
    if FORESEES && mask == 0 {
        return Lanes { mask, t: zero };
    }
    let det = e.u + e.v + e.w;
    let t = (e.u * e.z[0] + e.v * e.z[1] + e.w * e.z[2]) * F4::splat(ray.s[2]) / det;
    let valid = F4::splat(t_min).lt(t) & t.le(F4::splat(t_max));
    Lanes { mask: mask & valid, t }
}

/// Barycentric weights of the second and third corner in one lane.
#[inline(never)]
pub(super) fn barycentric(block: &Block, ray: &Shear, lane: usize) -> [f32; 2] {
    let e = edges(block, ray);
    let det = e.u + e.v + e.w;
    [(e.v / det).to_array()[lane], (e.w / det).to_array()[lane]]
}
