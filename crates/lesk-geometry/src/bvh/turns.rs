//! Many rays that take turns on their way through a tree, with AVX-512.
//!
//! A ray alone mostly waits: for its own last result, for memory, and for branches that no processor foresees (how many
//! boxes are met, whether a triangle is hit). Here every ray does one step, then the next ray does, and hardly a branch
//! depends on what a step finds: stacks are written eight words at once and grow by a count, the nearer of two is selected, and a ray is
//! written into the list of those at nodes and of those at leaves, of which one grows. The hits are the same bits as those of
//! [`walk`](super::traverse::walk).

use super::traverse::avx2::Wide;
use super::traverse::{Best, BoxTest, LocalRay, STACK, Slabs};
use super::tree::{Child, LANES, Node, Tree};
use super::triangle::{Block, Shear, barycentric, intersect};
use core::arch::x86_64::*;
use core::hint::select_unpredictable;

/// How many rays take turns.
pub(super) const TURNS: usize = 64;

/// The end below everything, and room for the eight words that are written at once.
const WORDS: usize = 1 + STACK + 8;

/// Where a ray is: two cache lines.
#[derive(Clone, Copy)]
#[repr(C, align(64))]
struct State {
    slabs: Slabs,
    t_min: f32,
    shear: Shear,
    improved: bool,
    /// The place of the nearest triangle, as in `Best`.
    slot: u32,
    /// The distance of the nearest hit, its bits above the number of the triangle: the smaller word is the one that counts.
    nearest: u64,
    /// What waits; its first word is the end.
    stack: *mut u64,
    len: u32,
    /// What is visited next.
    current: Child,
}

/// Numbers of rays.
struct List {
    rays: [u8; TURNS],
    len: usize,
}

impl List {
    fn new() -> List {
        List { rays: [0; TURNS], len: 0 }
    }

    /// # Safety
    /// `k` is below [`TURNS`].
    #[inline(always)]
    unsafe fn get(&self, k: usize) -> u8 {
        // SAFETY: as above
        unsafe { *self.rays.get_unchecked(k) }
    }

    /// Without a branch: writes the ray in any case.
    ///
    /// # Safety
    /// There is room for it.
    #[inline(always)]
    unsafe fn add_if(&mut self, condition: bool, ray: u8) {
        // SAFETY: as above
        unsafe { *self.rays.get_unchecked_mut(self.len) = ray };
        self.len += usize::from(condition);
    }
}

/// Room for the rays.
pub(super) struct Turns {
    states: Vec<State>,
    stacks: Vec<[u64; WORDS]>,
    /// The hits of rays whose nearest hit is something else than a triangle of the tree.
    others: [Best; TURNS],
}

// SAFETY: the pointers to stacks are used by `walk` only, which first makes the states anew
unsafe impl Send for Turns {}
// SAFETY: as above; `walk` has the only reference
unsafe impl Sync for Turns {}

/// Stands in [`State::nearest`] for what is no triangle of the tree: of several at the same distance, triangles come first.
const OTHER: u32 = u32::MAX;

/// As in [`State::nearest`].
#[inline(always)]
fn nearest(t: f32, id: u32) -> u64 {
    u64::from(t.to_bits()) << 32 | u64::from(id)
}

impl Turns {
    pub fn new() -> Turns {
        Turns {
            states: Vec::with_capacity(TURNS),
            stacks: vec![[Child::END.0.into(); WORDS]; TURNS],
            others: [Best::none(0.0); TURNS],
        }
    }

    /// Finds the nearest hits of up to [`TURNS`] rays, or with `ANY` some hits. Each comes with its `t_max` and with whether
    /// it can meet something; one that cannot may hold any numbers. `visit` improves what a ray, given by its number, met, by
    /// something else than the triangles of the tree, and says whether it did.
    ///
    /// # Safety
    /// [`Isa::Avx512`](lesk_math::Isa::Avx512) is available.
    #[target_feature(enable = "avx2,fma,popcnt,bmi1,bmi2,avx512f,avx512vl,avx512bw,avx512dq")]
    pub unsafe fn walk<const ANY: bool>(
        &mut self,
        tree: &Tree,
        rays: impl Iterator<Item = (LocalRay, f32, bool)>,
        visit: &dyn Fn(usize, u32, &mut Best) -> bool,
    ) {
        self.states.clear();
        let (mut at_nodes, mut at_leaves) = (List::new(), List::new());
        let stacks = self.stacks.as_mut_ptr();
        for (i, (ray, t_max, is_usable)) in rays.take(TURNS).enumerate() {
            // SAFETY: there are as many stacks as rays at most, and every ray is added once
            let stack = unsafe {
                at_nodes.add_if(is_usable & !tree.nodes.is_empty(), i as u8);
                stacks.add(i).cast::<u64>()
            };
            self.states.push(State::new(&ray, t_max, tree.reach, stack));
        }
        // SAFETY: both lists together hold the numbers of states, each at most once, so that each has room for one more while
        // a ray is taken out; the builder wrote only numbers of existing nodes and blocks, and its levels bound the stack
        unsafe {
            while at_nodes.len + at_leaves.len > 0 {
                let waiting = core::mem::take(&mut at_nodes.len);
                for k in 0..waiting {
                    let i = at_nodes.get(k);
                    let state = self.states.get_unchecked_mut(i as usize);
                    let node = tree.nodes.get_unchecked(state.current.0 as usize);
                    state.visit_node::<ANY>(node);
                    fetch(tree, state.current);
                    at_nodes.add_if(state.current.is_node(), i);
                    at_leaves.add_if(state.current.is_leaf(), i);
                }
                let waiting = core::mem::take(&mut at_leaves.len);
                for k in 0..waiting {
                    let i = at_leaves.get(k);
                    let state = self.states.get_unchecked_mut(i as usize);
                    let mut count = 0;
                    if state.current.is_other() {
                        let other = self.others.get_unchecked_mut(i as usize);
                        *other = state.best(other);
                        if visit(i as usize, state.current.other_index(), other) {
                            (state.nearest, state.improved) = (nearest(other.t, OTHER), true);
                        }
                    } else {
                        let first;
                        (first, count) = state.current.block_range();
                        state.visit_block(tree.blocks.get_unchecked(first), first);
                    }
                    state.go_on::<ANY>(count > 1);
                    fetch(tree, state.current);
                    at_nodes.add_if(state.current.is_node(), i);
                    at_leaves.add_if(state.current.is_leaf(), i);
                }
            }
        }
    }

    /// Whether a ray met something.
    #[inline]
    pub fn is_improved(&self, ray: usize) -> bool {
        self.states[ray].improved
    }

    /// The nearest hit of a ray; its `source` is 0 for triangles of the tree.
    #[inline]
    pub fn best(&self, tree: &Tree, ray: usize) -> Option<Best> {
        let state = &self.states[ray];
        let mut best = state.best(&self.others[ray]);
        if state.improved && state.nearest as u32 != OTHER {
            let slot = state.slot as usize;
            best.uv = barycentric(&tree.blocks[slot / LANES], &state.shear, slot % LANES);
        }
        state.improved.then_some(best)
    }
}

impl State {
    #[inline(always)]
    fn new(ray: &LocalRay, t_max: f32, reach: f32, stack: *mut u64) -> State {
        State {
            slabs: Slabs::new(ray, reach),
            t_min: ray.t_min,
            shear: Shear::new(ray.o, ray.d),
            improved: false,
            slot: 0,
            nearest: nearest(t_max, 0),
            stack,
            len: 1,
            current: Child::node(0),
        }
    }

    #[inline(always)]
    fn limit(&self) -> f32 {
        f32::from_bits((self.nearest >> 32) as u32)
    }

    /// The nearest hit: that of a triangle, or the one given.
    #[inline]
    fn best(&self, other: &Best) -> Best {
        match self.nearest as u32 {
            OTHER => *other,
            id => Best { t: self.limit(), source: 0, id, uv: [0.0; 2], slot: self.slot },
        }
    }

    /// Finds the child of a node to be visited next, and puts the others that are met on the stack.
    ///
    /// # Safety
    /// As [`Turns::walk`].
    #[inline(always)]
    unsafe fn visit_node<const ANY: bool>(&mut self, node: &Node) {
        debug_assert!(self.len as usize <= 1 + STACK);
        let (enter, leave) = Wide::new(&self.slabs).spans(node, self.t_min, self.limit());
        // SAFETY: the instruction set is there, nodes are aligned to 64 bytes, and eight words fit above `len` (see `WORDS`)
        unsafe {
            let met = _mm256_cmp_ps_mask::<_CMP_LE_OQ>(enter, leave);
            let enter = _mm256_castps_si256(enter);
            let first = if ANY { met.trailing_zeros() & 7 } else { nearest_lane(enter, met) };
            let next = *node.child.get_unchecked(first as usize);
            let others = (u32::from(met) & !(1 << first)) as u8;
            let words = _mm512_or_epi64(
                _mm512_slli_epi64::<32>(_mm512_cvtepu32_epi64(enter)),
                _mm512_cvtepu32_epi64(_mm256_load_si256(node.child.as_ptr().cast())),
            );
            let top = self.stack.add(self.len as usize);
            let waiting = Child(*top.sub(1) as u32);
            _mm512_storeu_si512(top.cast(), _mm512_maskz_compress_epi64(others, words));
            self.len = self.len + others.count_ones() + u32::from(met != 0) - 1;
            self.current = Child(select_unpredictable(met != 0, next.0, waiting.0));
        }
    }

    /// Tests the triangles of a block.
    #[inline(always)]
    fn visit_block(&mut self, block: &Block, number: usize) {
        let lanes = intersect::<false>(block, &self.shear, self.t_min, self.limit());
        let t = lanes.t.to_array();
        let word = |lane: usize| nearest(t[lane], block.id[lane]);
        let mut lane = (lanes.mask.trailing_zeros() & 3) as usize;
        // seldom so
        if lanes.mask & (lanes.mask - u32::from(lanes.mask != 0)) != 0 {
            lane = (0..LANES).filter(|l| lanes.mask >> l & 1 != 0).min_by_key(|&l| word(l)).unwrap_or(lane);
        }
        let found = select_unpredictable(lanes.mask != 0, word(lane), u64::MAX);
        let improves = found < self.nearest;
        self.nearest = self.nearest.min(found);
        self.slot = select_unpredictable(improves, (LANES * number + lane) as u32, self.slot);
        self.improved |= improves;
    }

    /// Finds what is visited after a leaf: its next block where there are more, else what waits before the nearest hit.
    ///
    /// # Safety
    /// As [`Turns::walk`].
    #[inline(always)]
    unsafe fn go_on<const ANY: bool>(&mut self, has_more: bool) {
        let (last, stack, len) = (self.nearest | 0xffff_ffff, self.stack, self.len as usize);
        let mut kept = 0;
        // SAFETY: words below `len` have been written, and eight words fit above any
        let waiting = unsafe {
            for first in (0..len).step_by(8) {
                let some = _mm512_loadu_si512(stack.add(first).cast());
                let lanes = ((1u32 << (len - first).min(8)) - 1) as u8;
                let near = _mm512_mask_cmple_epu64_mask(lanes, some, _mm512_set1_epi64(last as i64));
                _mm512_storeu_si512(stack.add(kept).cast(), _mm512_maskz_compress_epi64(near, some));
                kept += near.count_ones() as usize;
            }
            // the end is entered at 0 and always kept
            Child(*stack.add(kept - 1) as u32)
        };
        let next = select_unpredictable(has_more, self.current.next_block().0, waiting.0);
        self.current = Child(select_unpredictable(ANY & self.improved, Child::END.0, next));
        self.len = kept as u32 - u32::from(!has_more);
    }
}

/// The lane in the mask with the least number; the numbers are not negative, so that their bits are ordered as they are.
/// The last three bits do not count.
///
/// # Safety
/// AVX-512 VL is there.
#[inline(always)]
unsafe fn nearest_lane(numbers: __m256i, mask: __mmask8) -> u32 {
    // SAFETY: as above
    unsafe {
        let lane = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
        // number & !7 | lane
        let key = _mm256_ternarylogic_epi32::<0xf8>(lane, numbers, _mm256_set1_epi32(!7));
        let key = _mm256_mask_mov_epi32(_mm256_set1_epi32(-1), mask, key);
        let least = _mm_min_epu32(_mm256_castsi256_si128(key), _mm256_extracti128_si256::<1>(key));
        let least = _mm_min_epu32(least, _mm_shuffle_epi32::<0b01_00_11_10>(least));
        let least = _mm_min_epu32(least, _mm_shuffle_epi32::<0b10_11_00_01>(least));
        _mm_cvtsi128_si32(least) as u32 & 7
    }
}

/// Brings a child into the cache, which is visited when the other rays have had their turns.
#[inline(always)]
fn fetch(tree: &Tree, child: Child) {
    let node: *const i8 = tree.nodes.as_ptr().wrapping_add(child.0 as usize).cast();
    let block: *const i8 = tree.blocks.as_ptr().wrapping_add(child.block_range().0).cast();
    let start = select_unpredictable(child.is_node(), node, block);
    for line in 0..4 {
        // SAFETY: every x86-64 has it, and it ignores addresses where nothing is (those of the end)
        unsafe { _mm_prefetch::<_MM_HINT_T0>(start.wrapping_add(64 * line)) };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ray_takes_two_cache_lines() {
        assert_eq!(size_of::<State>(), 128);
    }
}
