//! Loops over blocks of points, compiled for each instruction set. Products and sums do not fuse, so every instruction set
//! gives the same bits.

use crate::run::{self, Face, Place};
use crate::samples::Spot;
use lesk_bsdf::kernels::{BLOCK, Row};
use lesk_math::{CHANNELS, Isa};

/// Three rows: vectors.
pub(crate) type Rows3 = [Row; 3];

/// Points of one kind of surface, waiting to be shaded.
pub(crate) struct Points {
    pub n: usize,
    /// World position, metres.
    pub p: Rows3,
    /// Interpolated normal; unit length after [`Lanes::orient`].
    pub ns: Rows3,
    /// Normal of the face, unit.
    pub ng: Rows3,
    /// Tells from which side light comes: the interpolated normal, or that of the face; after [`Lanes::orient`].
    pub side: Rows3,
    /// Where rays to lights start; kept by those who trace them.
    pub origin: Rows3,
    pub tangent: Rows3,
    /// What a normal map goes along, of any length, and its hand: -1 where it lies mirrored, else 1.
    pub along: Rows3,
    pub hand: Row,
    pub uv: [Row; 2],
    /// Where the result goes.
    pub target: [u32; BLOCK],
    /// The face of each point.
    pub face: [u32; BLOCK],
}

impl Points {
    pub fn new() -> Box<Points> {
        let zero = [[0.0; BLOCK]; 3];
        let (uv, none) = ([[0.0; BLOCK]; 2], [0; BLOCK]);
        Box::new(Points {
            n: 0,
            p: zero,
            ns: zero,
            ng: zero,
            side: zero,
            origin: zero,
            tangent: zero,
            along: zero,
            hand: [1.0; BLOCK],
            uv,
            target: none,
            face: none,
        })
    }
}

/// What is computed for a block of points.
pub(crate) struct Work {
    /// Towards the viewer, world space.
    pub wo: Rows3,
    /// 1 where the point scatters towards the viewer, else 0.
    pub alive: Row,
    /// Length of the interpolated normal; 1 where it is renormalised.
    pub length: Row,
    /// Tangent and bitangent.
    pub t: Rows3,
    pub b: Rows3,
    pub wo_local: Rows3,
    /// Towards the light, world space.
    pub wi: Rows3,
    pub wi_local: Rows3,
    /// What arrives from there, per channel: illuminance of a plane perpendicular to `wi`.
    pub value: [Row; CHANNELS],
    /// f, per channel.
    pub f: [Row; CHANNELS],
    /// The sum of light, per channel.
    pub sum: [Row; CHANNELS],
}

impl Work {
    pub fn new() -> Box<Work> {
        let (zero, color) = ([[0.0; BLOCK]; 3], [[0.0; BLOCK]; CHANNELS]);
        Box::new(Work {
            wo: zero,
            alive: [0.0; BLOCK],
            length: [1.0; BLOCK],
            t: zero,
            b: zero,
            wo_local: zero,
            wi: zero,
            wi_local: zero,
            value: color,
            f: color,
            sum: color,
        })
    }
}

/// How a surface meets the viewer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Sides {
    /// Light may pass: nothing is turned.
    pub transmits: bool,
    pub two_sided: bool,
    pub renormalize: bool,
    /// Tangents matter.
    pub anisotropic: bool,
    /// The classic local model: it knows the interpolated normal only, wherever that points.
    pub classic: bool,
    /// Interpolated normals tell from which side light comes.
    pub smooth: bool,
    /// Normals were bent by a map; `side` holds those before.
    pub mapped: bool,
    /// Of vertices, whether the face shows its back; other points have a face of their own to tell.
    pub back: Option<bool>,
}

impl Sides {
    const USUAL: Sides = Sides {
        transmits: false,
        two_sided: true,
        renormalize: true,
        anisotropic: false,
        classic: false,
        smooth: true,
        mapped: false,
        back: None,
    };
}

/// Least cosine between the normal of a vertex and the viewer, as a model sees it: vertices just behind the silhouette
/// count as on it, 0.6 degrees above the horizon.
const GRAZING: f32 = 0.01;

#[inline(always)]
fn dot(a: &Rows3, b: &Rows3, i: usize) -> f32 {
    a[0][i] * b[0][i] + a[1][i] * b[1][i] + a[2][i] * b[2][i]
}

#[inline(always)]
fn vector(rows: &Rows3, i: usize) -> [f32; 3] {
    [rows[0][i], rows[1][i], rows[2][i]]
}

#[inline(always)]
fn product(a: [f32; 3], b: [f32; 3]) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline(always)]
fn scaled(a: [f32; 3], s: f32) -> [f32; 3] {
    [a[0] * s, a[1] * s, a[2] * s]
}

#[inline(always)]
fn choose(first: bool, a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    [if first { a[0] } else { b[0] }, if first { a[1] } else { b[1] }, if first { a[2] } else { b[2] }]
}

/// Directions to the viewer, normals on its side, and frames around them; the same decisions as the path tracer makes.
#[inline(always)]
fn orient_body(points: &mut Points, work: &mut Work, eye: [f32; 3], sides: Sides) {
    let n = points.n.min(BLOCK);
    for i in 0..n {
        // values, not places: a choice between two places would keep the loop from being vectorised
        let d = [eye[0] - points.p[0][i], eye[1] - points.p[1][i], eye[2] - points.p[2][i]];
        let inverse = 1.0 / product(d, d).sqrt();
        let wo = scaled(d, inverse);
        let (given, face) = (vector(&points.ns, i), vector(&points.ng, i));
        let length = product(given, given).sqrt();
        let usable = length > 1e-12;
        work.length[i] = if sides.renormalize | !usable { 1.0 } else { length.min(1.0) };
        let ns = choose(usable, scaled(given, 1.0 / if usable { length } else { 1.0 }), face);
        // normals that a coarse mesh bends beyond the horizon are no use
        let bent = (product(ns, face) <= 1e-4) & !sides.classic;
        let ns = choose(bent, face, ns);
        let behind = match sides.back {
            Some(back) => back,
            None => product(face, wo) < 0.0,
        };
        let turned = behind & !sides.transmits & sides.two_sided;
        work.alive[i] = if behind & !sides.transmits & !sides.two_sided { 0.0 } else { 1.0 };
        let sign = if turned { -1.0 } else { 1.0 };
        let (mut ng, mut ns) = (scaled(face, sign), scaled(ns, sign));
        if sides.back.is_some() {
            // the face decides for all of its corners; light from behind must not reach them by a turned normal
            let side = if behind & !turned { -1.0 } else { 1.0 };
            let cosine = product(ns, wo);
            let missing = if sides.classic { 0.0 } else { (side * GRAZING - cosine) * side };
            let add = if missing > 0.0 { missing * side } else { 0.0 };
            let n = [ns[0] + wo[0] * add, ns[1] + wo[1] * add, ns[2] + wo[2] * add];
            ns = scaled(n, 1.0 / product(n, n).sqrt());
            ng = ns;
        }
        let agree = (product(ns, wo) > 0.0) == (product(ng, wo) > 0.0);
        let ns = choose(agree | sides.classic, ns, ng);
        let plain = if sides.mapped { choose(agree, scaled(vector(&points.side, i), sign), ng) } else { ns };
        for c in 0..3 {
            work.wo[c][i] = wo[c];
            points.ns[c][i] = ns[c];
            points.ng[c][i] = ng[c];
            points.side[c][i] = if sides.smooth { plain[c] } else { ng[c] };
        }
    }
    for i in 0..n {
        // Duff et al., Building an Orthonormal Basis, Revisited, JCGT 2017
        let [x, y, z] = [points.ns[0][i], points.ns[1][i], points.ns[2][i]];
        let sign = if z < 0.0 { -1.0 } else { 1.0 };
        let a = -1.0 / (sign + z);
        let b = x * y * a;
        let any = [1.0 + sign * x * x * a, sign * b, -sign * x];
        let across = [b, sign + y * y * a, -y];
        if sides.anisotropic {
            let along = points.tangent[0][i] * x + points.tangent[1][i] * y + points.tangent[2][i] * z;
            let t =
                [points.tangent[0][i] - x * along, points.tangent[1][i] - y * along, points.tangent[2][i] - z * along];
            let squared = t[0] * t[0] + t[1] * t[1] + t[2] * t[2];
            let ok = squared > 1e-20;
            let scale = if ok { 1.0 / squared.sqrt() } else { 0.0 };
            let t = [0, 1, 2].map(|c| if ok { t[c] * scale } else { any[c] });
            for c in 0..3 {
                work.t[c][i] = t[c];
            }
            work.b[0][i] = y * t[2] - z * t[1];
            work.b[1][i] = z * t[0] - x * t[2];
            work.b[2][i] = x * t[1] - y * t[0];
        } else {
            for c in 0..3 {
                work.t[c][i] = any[c];
                work.b[c][i] = across[c];
            }
        }
    }
    for i in 0..n {
        let local = [dot(&work.t, &work.wo, i), dot(&work.b, &work.wo, i), dot(&points.ns, &work.wo, i)];
        let local = shorten(local, work.length[i]);
        for c in 0..3 {
            work.wo_local[c][i] = local[c];
        }
    }
}

/// The unit vector of the same azimuth whose z is `length` times that of `v`: the cosine that a normal which was not
/// brought to unit length gives.
#[inline(always)]
fn shorten(v: [f32; 3], length: f32) -> [f32; 3] {
    let z = v[2] * length;
    let before = v[0] * v[0] + v[1] * v[1];
    let scale = if length == 1.0 { 1.0 } else { ((1.0 - z * z).max(0.0) / before.max(1e-20)).sqrt() };
    // a vector along the normal has no azimuth
    let x = if length != 1.0 && before <= 1e-20 { (1.0 - z * z).max(0.0).sqrt() } else { v[0] * scale };
    [x, v[1] * scale, z]
}

/// Directions to a point and what arrives from it.
#[inline(always)]
fn point_body(points: &Points, work: &mut Work, at: [f32; 3], intensity: [f32; CHANNELS]) {
    let n = points.n.min(BLOCK);
    for i in 0..n {
        let d = [at[0] - points.p[0][i], at[1] - points.p[1][i], at[2] - points.p[2][i]];
        let squared = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
        let length = squared.sqrt();
        let usable = length > 1e-18;
        let inverse = if usable { 1.0 / length } else { 0.0 };
        for c in 0..3 {
            work.wi[c][i] = d[c] * inverse;
        }
        let falloff = if usable { 1.0 / (length * length) } else { 0.0 };
        for c in 0..CHANNELS {
            work.value[c][i] = intensity[c] * falloff;
        }
    }
}

/// The direction to the light in the frames of the points; what arrives from the wrong side counts as nothing.
#[inline(always)]
fn local_body(points: &Points, work: &mut Work) {
    let n = points.n.min(BLOCK);
    for i in 0..n {
        let local = [dot(&work.t, &work.wi, i), dot(&work.b, &work.wi, i), dot(&points.ns, &work.wi, i)];
        let agree = (dot(&points.side, &work.wi, i) > 0.0) == (local[2] > 0.0);
        let local = shorten(local, work.length[i]);
        for c in 0..3 {
            work.wi_local[c][i] = local[c];
        }
        let weight = if agree { local[2].abs() * work.alive[i] } else { 0.0 };
        for c in 0..CHANNELS {
            work.value[c][i] *= weight;
        }
    }
}

#[inline(always)]
fn add_body(n: usize, work: &mut Work) {
    let n = n.min(BLOCK);
    for c in 0..CHANNELS {
        let (sum, f, value) = (&mut work.sum[c], &work.f[c], &work.value[c]);
        for i in 0..n {
            sum[i] += f[i] * value[i];
        }
    }
}

/// The loops of one instruction set.
pub(crate) struct Lanes {
    orient: unsafe fn(&mut Points, &mut Work, [f32; 3], Sides),
    point: unsafe fn(&Points, &mut Work, [f32; 3], [f32; CHANNELS]),
    local: unsafe fn(&Points, &mut Work),
    add: unsafe fn(usize, &mut Work),
    run: unsafe fn(&Face, Place, &[Spot], &mut Points),
}

macro_rules! lanes {
    ($($feature:literal)?) => {{
        $(#[target_feature(enable = $feature)])?
        unsafe fn orient(points: &mut Points, work: &mut Work, eye: [f32; 3], sides: Sides) {
            // constants fold into the common case
            if sides == Sides::USUAL {
                orient_body(points, work, eye, Sides::USUAL)
            } else {
                orient_body(points, work, eye, sides)
            }
        }
        $(#[target_feature(enable = $feature)])?
        unsafe fn point(points: &Points, work: &mut Work, at: [f32; 3], intensity: [f32; CHANNELS]) {
            point_body(points, work, at, intensity)
        }
        $(#[target_feature(enable = $feature)])?
        unsafe fn local(points: &Points, work: &mut Work) {
            local_body(points, work)
        }
        $(#[target_feature(enable = $feature)])?
        unsafe fn add(n: usize, work: &mut Work) {
            add_body(n, work)
        }
        $(#[target_feature(enable = $feature)])?
        unsafe fn run(face: &Face, place: Place, spots: &[Spot], points: &mut Points) {
            run::body(face, place, spots, points)
        }
        Lanes { orient, point, local, add, run }
    }};
}

impl Lanes {
    /// The loops for an instruction set that this processor has.
    ///
    /// # Panics
    /// If the processor lacks it.
    pub fn for_isa(isa: Isa) -> Lanes {
        assert!(isa.is_available(), "this processor lacks {}", isa.name());
        match isa {
            #[cfg(target_arch = "x86_64")]
            Isa::Avx2 => lanes!("avx2,fma"),
            #[cfg(target_arch = "x86_64")]
            Isa::Avx512 => lanes!("avx512f,avx512vl,avx512bw,avx512dq,avx2,fma"),
            _ => lanes!(),
        }
    }

    pub fn orient(&self, points: &mut Points, work: &mut Work, eye: [f32; 3], sides: Sides) {
        // SAFETY: `for_isa` checked the processor; the same holds below
        unsafe { (self.orient)(points, work, eye, sides) }
    }

    pub fn point(&self, points: &Points, work: &mut Work, at: [f32; 3], intensity: [f32; CHANNELS]) {
        // SAFETY: see `orient`
        unsafe { (self.point)(points, work, at, intensity) }
    }

    pub fn local(&self, points: &Points, work: &mut Work) {
        // SAFETY: see `orient`
        unsafe { (self.local)(points, work) }
    }

    pub fn add(&self, n: usize, work: &mut Work) {
        // SAFETY: see `orient`
        unsafe { (self.add)(n, work) }
    }

    pub fn run(&self, face: &Face, place: Place, spots: &[Spot], points: &mut Points) {
        // SAFETY: see `orient`
        unsafe { (self.run)(face, place, spots, points) }
    }
}
