//! Loops over arrays of directions, compiled once per model and instruction set, and the list of them.
//!
//! A loop reads a [`Block`] and writes [`Target`]s, both in one of two layouts, [`GROUP`] directions at a time: it loads
//! them, runs the model on all of them, which the compiler vectorises, and writes the results. So it reads memory, computes
//! and writes at the same time; `batch` cuts arrays of any other layout into blocks.

use crate::bsdf::{self, Bsdf};
use crate::model::Domain;
use crate::params::{Params, flat_len};
use crate::target::Target;
use lesk_math::{CHANNELS, Isa, Lane, Real, Vec3, vec3};
use std::borrow::Borrow;

pub(crate) mod group;
#[cfg(target_arch = "x86_64")]
mod shuffle;

pub(crate) use group::Plain;
use group::{Group, Lines};
#[cfg(target_arch = "x86_64")]
pub(crate) use shuffle::{Avx2, Avx512};

/// Directions that are computed at a time. Their results fill whole cache lines in every layout, and are written while the
/// next ones are read and computed; with 128 the processor does one after the other.
pub const GROUP: usize = 32;

/// The most directions in a block whose arrays are made for it: they stay in the first-level cache.
pub const BLOCK: usize = 128;

/// One array of such a block.
pub type Row = [f32; BLOCK];

/// The longest flat parameter table.
pub const MAX_PARAMS: usize = 32;

/// Outputs of eval and pdf together.
pub const EVAL_PDF_OUTPUTS: usize = CHANNELS + 1;

/// Outputs of a draw: wi, weight, pdf, delta.
pub const DRAW_OUTPUTS: usize = 3 + CHANNELS + 2;

/// Three numbers for each direction of a block.
#[derive(Clone, Copy)]
pub enum Vectors<'a> {
    /// One array per component.
    Planes([&'a [f32]; 3]),
    /// One vector after the other.
    Interleaved(&'a [f32]),
}

/// A run of directions, with parameters of one value each or of one value per direction.
pub struct Block<'a> {
    /// The place of its first direction in the targets.
    pub start: usize,
    /// The number of its directions.
    pub n: usize,
    /// One entry per flat parameter, of length 1 (`uniform`) or at least `n`.
    pub params: &'a [&'a [f32]],
    pub uniform: bool,
    /// `wi` for eval and pdf, `u` for draw.
    pub first: Vectors<'a>,
    pub wo: Vectors<'a>,
}

/// Directions whose squared length differs from 1 by more than this are counted, and give 0 only if they are not finite.
pub const UNIT_TOLERANCE: f32 = 1e-4;

/// A loop over one block, writing its outputs, past the caches if so asked. Returns how many inputs were out of range:
/// directions not of unit length, numbers `u` outside [0, 1).
pub type Kernel = unsafe fn(&Block, &mut [Target], streaming: bool) -> u32;

/// The loops of one instruction set.
#[derive(Clone, Copy)]
pub struct KernelSet {
    pub eval: Kernel,
    pub pdf: Kernel,
    pub eval_pdf: Kernel,
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

/// The body that a loop runs for one direction: writes element `i` of each row.
pub(crate) trait Body<const FMA: bool, B>: Sized {
    const OUTPUTS: usize;
    /// Whether the first input is a direction, not numbers in [0, 1).
    const FIRST_IS_DIRECTION: bool;
    fn run(domain: Domain, model: &B, first: Vec3<Lane<FMA>>, second: Vec3<Lane<FMA>>, i: usize, out: &mut [Group]);

    /// The loop over a group; `model` gives the model of a direction, and `odd` counts inputs that are out of range. It is a
    /// function of its own because the compiler then takes its word that what is written lies in nothing that is read.
    #[inline(always)]
    fn run_group<M: Borrow<B>>(
        domain: Domain,
        model: impl Fn(usize) -> M,
        [ax, ay, az]: [&[f32]; 3],
        [bx, by, bz]: [&[f32]; 3],
        odd: &mut [u32; GROUP],
        out: &mut [Group],
    ) {
        let n = ax.len().min(GROUP);
        let [ax, ay, az, bx, by, bz] = [&ax[..n], &ay[..n], &az[..n], &bx[..n], &by[..n], &bz[..n]];
        for i in 0..n {
            let (a, b) = (vec3(Lane(ax[i]), Lane(ay[i]), Lane(az[i])), vec3(Lane(bx[i]), Lane(by[i]), Lane(bz[i])));
            odd[i] +=
                u32::from(if Self::FIRST_IS_DIRECTION { is_odd(a) } else { is_outside(a) }) + u32::from(is_odd(b));
            Self::run(domain, model(i).borrow(), a, b, i, out);
        }
    }
}

pub(crate) struct Eval;
impl<const FMA: bool, B: Bsdf<Lane<FMA>>> Body<FMA, B> for Eval {
    const OUTPUTS: usize = CHANNELS;
    const FIRST_IS_DIRECTION: bool = true;
    #[inline(always)]
    fn run(domain: Domain, model: &B, wi: Vec3<Lane<FMA>>, wo: Vec3<Lane<FMA>>, i: usize, out: &mut [Group]) {
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
    fn run(domain: Domain, model: &B, wi: Vec3<Lane<FMA>>, wo: Vec3<Lane<FMA>>, i: usize, out: &mut [Group]) {
        out[0][i] = bsdf::pdf(domain, model, wi, wo).0;
    }
}

/// Both at once: what they share is computed once.
pub(crate) struct EvalPdf;
impl<const FMA: bool, B: Bsdf<Lane<FMA>>> Body<FMA, B> for EvalPdf {
    const OUTPUTS: usize = EVAL_PDF_OUTPUTS;
    const FIRST_IS_DIRECTION: bool = true;
    #[inline(always)]
    fn run(domain: Domain, model: &B, wi: Vec3<Lane<FMA>>, wo: Vec3<Lane<FMA>>, i: usize, out: &mut [Group]) {
        Eval::run(domain, model, wi, wo, i, out);
        Pdf::run(domain, model, wi, wo, i, &mut out[CHANNELS..]);
    }
}

pub(crate) struct Draw;
impl<const FMA: bool, B: Bsdf<Lane<FMA>>> Body<FMA, B> for Draw {
    const OUTPUTS: usize = DRAW_OUTPUTS;
    const FIRST_IS_DIRECTION: bool = false;
    #[inline(always)]
    fn run(domain: Domain, model: &B, u: Vec3<Lane<FMA>>, wo: Vec3<Lane<FMA>>, i: usize, out: &mut [Group]) {
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
pub(crate) fn run_block<const FMA: bool, L, B, F>(
    domain: Domain,
    block: &Block,
    targets: &mut [Target],
    streaming: bool,
) -> u32
where
    L: Lines,
    B: Params<Lane<FMA>>,
    F: Body<FMA, B>,
{
    // a count per place: adding up across a vector takes as long as a cheap model
    let mut odd = [0; GROUP];
    let mut out = [[0.0; GROUP]; DRAW_OUTPUTS];
    let (mut first, mut second) = ([[0.0; GROUP]; 3], [[0.0; GROUP]; 3]);
    let uniform = block.uniform.then(|| B::gather(|p| Lane(block.params[p][0])));
    let rows = rows_of::<B, FMA>(block);
    for start in (0..block.n).step_by(GROUP) {
        let n = GROUP.min(block.n - start);
        let a = group::load::<L>(&block.first, start, n, &mut first);
        let b = group::load::<L>(&block.wo, start, n, &mut second);
        if let Some(model) = &uniform {
            F::run_group(domain, |_| model, a, b, &mut odd, &mut out);
        } else {
            // SAFETY: `rows_of` checked that each row has `block.n` values; start + i is less
            let model = |i: usize| B::gather(|p| Lane(unsafe { *rows[p].add(start + i) }));
            F::run_group(domain, model, a, b, &mut odd, &mut out);
        }
        group::store::<L>(&out[..F::OUTPUTS], targets, block.start + start, n, streaming);
    }
    odd.iter().sum()
}

/// Pointers to the values of each parameter: a slice of slices in the loop would keep it from vectorising.
#[inline(always)]
fn rows_of<B: Params<Lane<FMA>>, const FMA: bool>(block: &Block) -> [*const f32; MAX_PARAMS] {
    let mut rows = [std::ptr::null(); MAX_PARAMS];
    let n = if block.uniform { 1 } else { block.n };
    for p in 0..const { flat_len(B::SPECS) } {
        rows[p] = block.params[p][..n].as_ptr();
    }
    rows
}
