//! Loops over arrays of directions, compiled once per model and instruction set, and the list of them.
//!
//! The loops work on blocks of at most [`BLOCK`] directions in structure-of-arrays form; `batch` cuts arrays of any
//! layout into such blocks.

use crate::bsdf::{self, Bsdf};
use crate::model::Domain;
use crate::params::{Params, flat_len};
use lesk_math::{CHANNELS, Isa, Lane, Real, Vec3, vec3};

/// Directions per block. All arrays stay in the first-level cache, and a block is short enough for the processor to fetch
/// the next one meanwhile: 128 is 15 to 25 % faster than 512 from memory, and as fast from the cache.
pub const BLOCK: usize = 128;

/// The longest flat parameter table.
pub const MAX_PARAMS: usize = 32;

/// Outputs of a draw: wi, weight, pdf, delta.
pub const DRAW_OUTPUTS: usize = 3 + CHANNELS + 2;

/// One array of a block; only the first `n` values are used.
pub type Row = [f32; BLOCK];

/// One block: `n` directions, parameters of one value each or of `n` values each.
pub struct Block<'a> {
    pub n: usize,
    /// One entry per flat parameter, of length 1 (`uniform`) or at least `n`.
    pub params: &'a [&'a [f32]],
    pub uniform: bool,
    /// The components of `wi` and `wo` for eval and pdf, of `u` and `wo` for draw.
    pub directions: [&'a [f32]; 6],
}

/// Directions whose squared length differs from 1 by more than this are counted, and give 0 only if they are not finite.
pub const UNIT_TOLERANCE: f32 = 1e-4;

/// A loop over one block, writing one row per output. Returns how many inputs were out of range: directions not of unit
/// length, numbers `u` outside [0, 1).
pub type Kernel = unsafe fn(&Block, &mut [Row]) -> u32;

/// The loops of one instruction set.
#[derive(Clone, Copy)]
pub struct KernelSet {
    pub eval: Kernel,
    pub pdf: Kernel,
    pub draw: Kernel,
}

/// The loops of one model.
pub struct Kernels {
    pub baseline: KernelSet,
    #[cfg(target_arch = "x86_64")]
    pub avx2: KernelSet,
    #[cfg(target_arch = "x86_64")]
    pub avx512: KernelSet,
}

impl Kernels {
    /// The loops for an instruction set that this processor has.
    ///
    /// # Panics
    /// If the processor lacks it.
    pub fn for_isa(&self, isa: Isa) -> &KernelSet {
        assert!(isa.is_available(), "this processor lacks {}", isa.name());
        match isa {
            Isa::Baseline => &self.baseline,
            #[cfg(target_arch = "x86_64")]
            Isa::Avx2 => &self.avx2,
            #[cfg(target_arch = "x86_64")]
            Isa::Avx512 => &self.avx512,
            #[cfg(not(target_arch = "x86_64"))]
            _ => &self.baseline,
        }
    }
}

/// The body that a loop runs for one direction: reads element `i`, writes element `i` of each row.
pub(crate) trait Body<const FMA: bool, B> {
    const OUTPUTS: usize;
    /// Whether the first input is a direction, not numbers in [0, 1).
    const FIRST_IS_DIRECTION: bool;
    fn run(domain: Domain, model: &B, first: Vec3<Lane<FMA>>, second: Vec3<Lane<FMA>>, i: usize, out: &mut [Row]);
}

pub(crate) struct Eval;
impl<const FMA: bool, B: Bsdf<Lane<FMA>>> Body<FMA, B> for Eval {
    const OUTPUTS: usize = CHANNELS;
    const FIRST_IS_DIRECTION: bool = true;
    #[inline(always)]
    fn run(domain: Domain, model: &B, wi: Vec3<Lane<FMA>>, wo: Vec3<Lane<FMA>>, i: usize, out: &mut [Row]) {
        let f = bsdf::eval(domain, model, wi, wo);
        for c in 0..CHANNELS {
            out[c][i] = f.0[c].0;
        }
    }
}

pub(crate) struct Pdf;
impl<const FMA: bool, B: Bsdf<Lane<FMA>>> Body<FMA, B> for Pdf {
    const OUTPUTS: usize = 1;
    const FIRST_IS_DIRECTION: bool = true;
    #[inline(always)]
    fn run(domain: Domain, model: &B, wi: Vec3<Lane<FMA>>, wo: Vec3<Lane<FMA>>, i: usize, out: &mut [Row]) {
        out[0][i] = bsdf::pdf(domain, model, wi, wo).0;
    }
}

pub(crate) struct Draw;
impl<const FMA: bool, B: Bsdf<Lane<FMA>>> Body<FMA, B> for Draw {
    const OUTPUTS: usize = DRAW_OUTPUTS;
    const FIRST_IS_DIRECTION: bool = false;
    #[inline(always)]
    fn run(domain: Domain, model: &B, u: Vec3<Lane<FMA>>, wo: Vec3<Lane<FMA>>, i: usize, out: &mut [Row]) {
        let s = bsdf::draw(domain, model, wo, u.to_array());
        out[0][i] = s.wi.x.0;
        out[1][i] = s.wi.y.0;
        out[2][i] = s.wi.z.0;
        for c in 0..CHANNELS {
            out[3 + c][i] = s.weight.0[c].0;
        }
        out[3 + CHANNELS][i] = s.pdf.0;
        out[4 + CHANNELS][i] = s.delta.0;
    }
}

/// Whether a direction is not of unit length; NaN counts.
#[inline(always)]
fn is_odd<const FMA: bool>(v: Vec3<Lane<FMA>>) -> bool {
    let is_unit = (v.length_squared().0 - 1.0).abs() <= UNIT_TOLERANCE;
    !is_unit
}

/// Whether one of three numbers lies outside [0, 1); NaN does.
#[inline(always)]
fn is_outside<const FMA: bool>(u: Vec3<Lane<FMA>>) -> bool {
    !(u.x.ge(Lane(0.0))
        & u.x.lt(Lane(1.0))
        & u.y.ge(Lane(0.0))
        & u.y.lt(Lane(1.0))
        & u.z.ge(Lane(0.0))
        & u.z.lt(Lane(1.0)))
}

/// The loop. Everything in it is inlined into the caller, whose instruction set it thereby gets.
#[inline(always)]
pub(crate) fn run_block<const FMA: bool, B, F>(domain: Domain, block: &Block, out: &mut [Row]) -> u32
where
    B: Params<Lane<FMA>>,
    F: Body<FMA, B>,
{
    let n = block.n.min(BLOCK);
    let params = block.params;
    let [ax, ay, az, bx, by, bz] = block.directions;
    let [ax, ay, az, bx, by, bz] = [&ax[..n], &ay[..n], &az[..n], &bx[..n], &by[..n], &bz[..n]];
    let out = &mut out[..F::OUTPUTS];
    let lane = |row: &[f32], i: usize| Lane::<FMA>(row[i]);
    let mut odd = 0;
    if block.uniform {
        let model = B::gather(|p| Lane(params[p][0]));
        for i in 0..n {
            let (a, b) = (vec3(lane(ax, i), lane(ay, i), lane(az, i)), vec3(lane(bx, i), lane(by, i), lane(bz, i)));
            odd += u32::from(if F::FIRST_IS_DIRECTION { is_odd(a) } else { is_outside(a) }) + u32::from(is_odd(b));
            F::run(domain, &model, a, b, i, out);
        }
    } else {
        let rows = rows_of::<B, FMA>(params, n);
        for i in 0..n {
            // SAFETY: `rows_of` checked that each row has n values; i < n
            let model = B::gather(|p| Lane(unsafe { *rows[p].add(i) }));
            let (a, b) = (vec3(lane(ax, i), lane(ay, i), lane(az, i)), vec3(lane(bx, i), lane(by, i), lane(bz, i)));
            odd += u32::from(if F::FIRST_IS_DIRECTION { is_odd(a) } else { is_outside(a) }) + u32::from(is_odd(b));
            F::run(domain, &model, a, b, i, out);
        }
    }
    odd
}

/// Pointers to the first `n` values of each parameter: a slice of slices in the loop would keep it from vectorising.
#[inline(always)]
fn rows_of<B: Params<Lane<FMA>>, const FMA: bool>(params: &[&[f32]], n: usize) -> [*const f32; MAX_PARAMS] {
    let mut rows = [std::ptr::null(); MAX_PARAMS];
    for p in 0..const { flat_len(B::SPECS) } {
        rows[p] = params[p][..n].as_ptr();
    }
    rows
}
