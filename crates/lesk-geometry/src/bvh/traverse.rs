//! The walk through a tree, nearest box first.

use super::simd::F4;
use super::tree::{Child, LANES, MAX_DEPTH, Node, Tree};
use super::triangle::{Shear, barycentric, intersect};
use crate::mesh::MAX_COORDINATE;
use core::mem::MaybeUninit;

/// Half a unit in the last place of 1.
const ROUNDING: f32 = 5.960_464_5e-8;

/// Seven children wait per level, eight at the last one.
pub(super) const STACK: usize = 7 * MAX_DEPTH + 8;

/// The nearest hit so far. `source` and `id` order hits of equal distance, so that the result does not depend on the
/// order of the walk.
#[derive(Clone, Copy, Debug)]
pub(super) struct Best {
    pub t: f32,
    pub source: u32,
    pub id: u32,
    pub uv: [f32; 2],
    /// The place of a triangle in its tree, for [`Tree::corners`].
    pub slot: u32,
}

impl Best {
    /// Nothing yet; hits at `t_max` itself do not count.
    pub fn none(t_max: f32) -> Self {
        Best { t: t_max, source: 0, id: 0, uv: [0.0; 2], slot: 0 }
    }

    /// Whether a hit comes before this one.
    #[inline(always)]
    pub fn is_beaten_by(&self, t: f32, source: u32, id: u32) -> bool {
        t < self.t || (t == self.t && (source, id) < (self.source, self.id))
    }
}

/// A ray in the space of a tree.
#[derive(Clone, Copy, Debug)]
pub(super) struct LocalRay {
    pub o: [f32; 3],
    pub d: [f32; 3],
    pub t_min: f32,
}

impl LocalRay {
    /// Whether origin and direction are finite, and the way from the origin to anything is at most 1e27 times as long as the
    /// direction, so that no number of [`Slabs`] overflows.
    #[inline(always)]
    pub fn is_usable(&self) -> bool {
        // sums of absolute values: infinity and NaN survive them
        let size = |v: &[f32; 3]| v[0].abs() + v[1].abs() + v[2].abs();
        let d = size(&self.d);
        // the right side is finite, so that infinity fails
        (d <= f32::MAX) & (size(&self.o) + MAX_COORDINATE <= 1e27 * d.min(1e10))
    }
}

/// The larger number, one instruction: neither is NaN where the ray is usable.
#[inline(always)]
fn larger(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

/// The largest absolute value.
#[inline(always)]
fn largest(v: &[f32; 3]) -> f32 {
    larger(larger(v[0].abs(), v[1].abs()), v[2].abs())
}

/// What the box test precomputes per ray: `t = bound * inverse + add`, with `add` moved outward by more than the
/// rounding errors of this test and of the triangle test, so that no box is missed that holds a triangle reported as
/// hit. That costs nothing per box (compare Ize, *Robust BVH Ray Traversal*, JCGT 2013, which scales every distance).
/// The fourth numbers mean nothing.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub(super) struct Slabs {
    inverse: [f32; 4],
    near_add: [f32; 4],
    far_add: [f32; 4],
    /// Rows of the bounds that are met first, below 6; those met last are the same with the last bit flipped.
    near_row: [u32; 3],
}

impl Slabs {
    #[inline(always)]
    pub fn new(ray: &LocalRay, reach: f32) -> Self {
        // (b - o) / d errs by 4 roundings of |b| + |o|, the sheared corner of a triangle by 5: 16 cover their sum
        let pad = 16.0 * ROUNDING * (reach + largest(&ray.o));
        // a component of 0 becomes one that is lost in the rounding of the others
        let least = largest(&ray.d) * 1e-10;
        let mut s = Slabs { inverse: [0.0; 4], near_add: [0.0; 4], far_add: [0.0; 4], near_row: [0; 3] };
        for k in 0..3 {
            let d = larger(ray.d[k].abs(), least).copysign(ray.d[k]);
            let inverse = 1.0 / d;
            let add = -ray.o[k] * inverse;
            s.inverse[k] = inverse;
            s.near_add[k] = add - pad * inverse.abs();
            s.far_add[k] = add + pad * inverse.abs();
            s.near_row[k] = 2 * k as u32 + u32::from(d < 0.0);
        }
        s
    }
}

/// The test of a ray against eight boxes.
pub(super) trait BoxTest {
    /// Prepares for a ray.
    fn new(slabs: &Slabs) -> Self;
    /// Bit i: box i is met between `t_min` and `t_max`; and where each is entered.
    fn boxes(&self, node: &Node, t_min: f32, t_max: f32) -> (u32, [f32; 8]);
}

/// Works everywhere.
pub(super) struct Portable(Slabs);

impl BoxTest for Portable {
    #[inline(always)]
    fn new(slabs: &Slabs) -> Self {
        Portable(*slabs)
    }

    #[inline(always)]
    fn boxes(&self, node: &Node, t_min: f32, t_max: f32) -> (u32, [f32; 8]) {
        let s = &self.0;
        let mut entry = [0.0; 8];
        let mut mask = 0;
        for half in 0..2 {
            let (mut near, mut far) = (F4::splat(t_min), F4::splat(t_max));
            for k in 0..3 {
                let row = |r: u32| {
                    let b = &node.bounds[r as usize];
                    F4::load(&[b[4 * half], b[4 * half + 1], b[4 * half + 2], b[4 * half + 3]])
                };
                let inverse = F4::splat(s.inverse[k]);
                near = (row(s.near_row[k]) * inverse + F4::splat(s.near_add[k])).max(near);
                far = (row(s.near_row[k] ^ 1) * inverse + F4::splat(s.far_add[k])).min(far);
            }
            mask |= near.le(far) << (4 * half);
            entry[4 * half..4 * half + 4].copy_from_slice(&near.to_array());
        }
        (mask, entry)
    }
}

/// AVX2 with FMA.
#[cfg(target_arch = "x86_64")]
pub(super) mod avx2 {
    use super::{BoxTest, Node, Slabs};
    use core::arch::x86_64::*;

    /// Must only be made inside a function that enables AVX2 and FMA.
    pub struct Wide {
        inverse: [__m256; 3],
        near_add: [__m256; 3],
        far_add: [__m256; 3],
        near_row: [u32; 3],
    }

    impl BoxTest for Wide {
        #[inline(always)]
        fn new(s: &Slabs) -> Self {
            // SAFETY: the caller runs with AVX2 (see the type)
            let splat = |v: [f32; 4]| unsafe { [_mm256_set1_ps(v[0]), _mm256_set1_ps(v[1]), _mm256_set1_ps(v[2])] };
            Wide {
                inverse: splat(s.inverse),
                near_add: splat(s.near_add),
                far_add: splat(s.far_add),
                near_row: s.near_row,
            }
        }

        #[inline(always)]
        fn boxes(&self, node: &Node, t_min: f32, t_max: f32) -> (u32, [f32; 8]) {
            let (enter, leave) = self.spans(node, t_min, t_max);
            let mut entry = [0.0f32; 8];
            // SAFETY: the caller runs with AVX2
            let mask = unsafe {
                _mm256_storeu_ps(entry.as_mut_ptr(), enter);
                _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LE_OQ>(enter, leave)) as u32
            };
            (mask, entry)
        }
    }

    impl Wide {
        /// Where each box is entered and left: one that is missed is left before it is entered.
        #[inline(always)]
        pub fn spans(&self, node: &Node, t_min: f32, t_max: f32) -> (__m256, __m256) {
            // SAFETY: rows are below 6 by construction, nodes are aligned to 64 bytes, and the caller runs with AVX2
            unsafe {
                let row = |r: u32| _mm256_load_ps(node.bounds.get_unchecked(r as usize).as_ptr());
                let near = |k: usize| _mm256_fmadd_ps(row(self.near_row[k]), self.inverse[k], self.near_add[k]);
                let far = |k: usize| _mm256_fmadd_ps(row(self.near_row[k] ^ 1), self.inverse[k], self.far_add[k]);
                let enter =
                    _mm256_max_ps(_mm256_max_ps(near(0), near(1)), _mm256_max_ps(near(2), _mm256_set1_ps(t_min)));
                let leave = _mm256_min_ps(_mm256_min_ps(far(0), far(1)), _mm256_min_ps(far(2), _mm256_set1_ps(t_max)));
                (enter, leave)
            }
        }
    }
}

/// What is in a tree besides triangles.
pub(super) trait Others {
    /// Improves `best`; says whether it did.
    fn visit(&self, index: u32, best: &mut Best) -> bool;
}

/// Nothing else.
pub(super) struct NoOthers;

impl Others for NoOthers {
    #[inline(always)]
    fn visit(&self, _: u32, _: &mut Best) -> bool {
        false
    }
}

/// Children still to visit, each as the bits of its entry distance above its number: distances are not negative, so
/// that the larger word is the farther child. The count is kept apart, where it can stay in a register.
type Stack = [MaybeUninit<u64>; STACK];

#[inline(always)]
fn word(entry: f32, child: Child) -> u64 {
    (entry.to_bits() as u64) << 32 | child.0 as u64
}

#[inline(always)]
fn push(stack: &mut Stack, len: &mut usize, word: u64) {
    debug_assert!(*len < STACK);
    // SAFETY: at most 7 words wait per level and 8 at the last (`STACK`); the builder bounds the levels
    unsafe { stack.get_unchecked_mut(*len).write(word) };
    *len += 1;
}

/// Puts a word into its place above `base`, nearest on top.
#[inline(always)]
fn insert(stack: &mut Stack, len: &mut usize, base: usize, word: u64) {
    let mut k = *len;
    push(stack, len, word);
    // SAFETY: words below `len` have been written
    unsafe {
        while k > base && stack.get_unchecked(k - 1).assume_init() < word {
            let moved = stack.get_unchecked(k - 1).assume_init();
            stack.get_unchecked_mut(k).write(moved);
            k -= 1;
        }
        stack.get_unchecked_mut(k).write(word);
    }
}

/// The next child that is entered before `limit`.
#[inline(always)]
fn pop(stack: &Stack, len: &mut usize, limit: f32) -> Option<Child> {
    while *len > 0 {
        *len -= 1;
        // SAFETY: words below the old `len` have been written
        let word = unsafe { stack.get_unchecked(*len).assume_init() };
        if f32::from_bits((word >> 32) as u32) <= limit {
            return Some(Child(word as u32));
        }
    }
    None
}

/// Finds the nearest hit, or with `ANY` some hit; says whether `best` was improved.
#[inline(always)]
pub(super) fn walk<B: BoxTest, O: Others, const ANY: bool>(
    tree: &Tree,
    ray: &LocalRay,
    source: u32,
    others: &O,
    best: &mut Best,
) -> bool {
    if tree.nodes.is_empty() {
        return false;
    }
    let boxes = B::new(&Slabs::new(ray, tree.reach));
    let shear = Shear::new(ray.o, ray.d);
    let (nodes, blocks) = (tree.nodes.as_slice(), tree.blocks.as_slice());
    let mut stack: Stack = [const { MaybeUninit::uninit() }; STACK];
    let mut len = 0;
    let mut current = Child::node(0);
    let mut found = None;
    let mut improved = false;
    // copies that stay in registers
    let (t_min, mut limit) = (ray.t_min, best.t);
    loop {
        if current.is_node() {
            // SAFETY: the builder wrote only numbers of existing nodes and blocks
            let node = unsafe { nodes.get_unchecked(current.0 as usize) };
            let (mask, entry) = boxes.boxes(node, t_min, limit);
            if let Some(next) = choose::<ANY>(node, mask, &entry, &mut stack, &mut len) {
                current = next;
                continue;
            }
        } else if !current.is_other() {
            let (first, count) = current.block_range();
            for index in first..first + count {
                // SAFETY: as above
                let block = unsafe { blocks.get_unchecked(index) };
                let lanes = intersect::<true>(block, &shear, t_min, limit);
                let (mut mask, t) = (lanes.mask, lanes.t.to_array());
                while mask != 0 {
                    let lane = (mask.trailing_zeros() & 3) as usize;
                    mask &= mask - 1;
                    if best.is_beaten_by(t[lane], source, block.id[lane]) {
                        if ANY {
                            return true;
                        }
                        (best.t, best.source, best.id) = (t[lane], source, block.id[lane]);
                        limit = best.t;
                        found = Some((index, lane));
                        improved = true;
                    }
                }
            }
        } else if current != Child::END && others.visit(current.other_index(), best) {
            if ANY {
                return true;
            }
            (limit, improved, found) = (best.t, true, None);
        }
        match pop(&stack, &mut len, limit) {
            Some(next) => current = next,
            None => break,
        }
    }
    if let Some((index, lane)) = found {
        best.uv = barycentric(&blocks[index], &shear, lane);
        best.slot = (LANES * index + lane) as u32;
    }
    improved
}

/// The child to go on with, the nearest; the others are pushed, farthest first. With `ANY`, in no order and without
/// distances: nothing shortens the ray.
#[inline(always)]
fn choose<const ANY: bool>(
    node: &Node,
    mut mask: u32,
    entry: &[f32; 8],
    stack: &mut Stack,
    len: &mut usize,
) -> Option<Child> {
    let take = |mask: &mut u32| {
        let slot = (mask.trailing_zeros() & 7) as usize;
        *mask &= *mask - 1;
        word(if ANY { 0.0 } else { entry[slot] }, node.child[slot])
    };
    if mask == 0 {
        return None;
    }
    let first = take(&mut mask);
    if ANY {
        while mask != 0 {
            let next = take(&mut mask);
            push(stack, len, next);
        }
    }
    if mask == 0 {
        return Some(Child(first as u32));
    }
    let second = take(&mut mask);
    let (near, far) = if first < second { (first, second) } else { (second, first) };
    let base = *len;
    push(stack, len, far);
    if mask == 0 {
        return Some(Child(near as u32));
    }
    push(stack, len, near);
    while mask != 0 {
        let next = take(&mut mask);
        insert(stack, len, base, next);
    }
    *len -= 1;
    // SAFETY: just written
    Some(Child(unsafe { stack.get_unchecked(*len).assume_init() } as u32))
}
