//! The eight-wide tree in memory.

use super::triangle::Block;
use crate::bounds::Bounds;
use lesk_math::{Vec3, vec3};

/// Levels below which a tree is cut into equal parts instead of following the builder, which bounds the stack.
pub(super) const MAX_DEPTH: usize = 64;

/// Triangles per block.
pub(super) const LANES: usize = 4;

/// Eight children: their boxes by coordinate, and what they are. 256 bytes, four cache lines.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub(super) struct Node {
    /// Smallest and largest x, then y, then z: the opposite bound of row r is row r ^ 1. An empty slot holds +infinity
    /// and -infinity.
    pub bounds: [[f32; 8]; 6],
    pub child: [Child; 8],
}

impl Node {
    pub const EMPTY: Self = {
        let (lo, hi) = ([f32::INFINITY; 8], [f32::NEG_INFINITY; 8]);
        Node { bounds: [lo, hi, lo, hi, lo, hi], child: [Child::END; 8] }
    };

    pub fn set(&mut self, slot: usize, bounds: &Bounds, child: Child) {
        let (lo, hi) = (bounds.min.to_array(), bounds.max.to_array());
        for k in 0..3 {
            self.bounds[2 * k][slot] = lo[k];
            self.bounds[2 * k + 1][slot] = hi[k];
        }
        self.child[slot] = child;
    }
}

/// What a child is, in 32 bits: a node, some blocks of triangles, or something else by its number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(transparent)]
pub(super) struct Child(pub u32);

impl Child {
    const TRIANGLES: u32 = 1 << 31;
    const OTHER: u32 = 3 << 30;
    /// No child, in empty slots and below everything that waits: numbers of other things are smaller.
    pub const END: Self = Child(u32::MAX);
    /// How many numbers of nodes, blocks or other things there are.
    pub const LIMIT: usize = 1 << 28;

    pub const fn node(index: u32) -> Self {
        Child(index)
    }

    /// `count` blocks, 1 to 4.
    pub const fn blocks(first: u32, count: u32) -> Self {
        Child(Self::TRIANGLES | (count - 1) << 28 | first)
    }

    pub const fn other(index: u32) -> Self {
        Child(Self::OTHER | index)
    }

    #[inline(always)]
    pub fn is_node(self) -> bool {
        self.0 < Self::TRIANGLES
    }

    /// Whether it is neither a node nor the end.
    #[cfg(target_arch = "x86_64")]
    #[inline(always)]
    pub fn is_leaf(self) -> bool {
        !self.is_node() & (self != Child::END)
    }

    #[inline(always)]
    pub fn is_other(self) -> bool {
        self.0 >= Self::OTHER
    }

    /// First block and number of blocks.
    #[inline(always)]
    pub fn block_range(self) -> (usize, usize) {
        ((self.0 & 0x0fff_ffff) as usize, (self.0 >> 28 & 3) as usize + 1)
    }

    /// The blocks of a leaf without the first of several.
    #[cfg(target_arch = "x86_64")]
    #[inline(always)]
    pub fn next_block(self) -> Self {
        Child(self.0.wrapping_add(1).wrapping_sub(1 << 28))
    }

    #[inline(always)]
    pub fn other_index(self) -> u32 {
        self.0 & 0x3fff_ffff
    }
}

/// A tree over triangles and other things.
#[derive(Clone, Debug)]
pub(super) struct Tree {
    /// The root is node 0; none where the tree is empty.
    pub nodes: Vec<Node>,
    pub blocks: Vec<Block>,
    pub bounds: Bounds,
    /// Largest absolute coordinate.
    pub reach: f32,
}

impl Tree {
    /// The corners of the triangle at `slot`: its block times [`LANES`], plus its lane.
    #[inline]
    pub fn corners(&self, slot: u32) -> [Vec3<f32>; 3] {
        let (block, lane) = (&self.blocks[slot as usize / LANES], slot as usize % LANES);
        [0, 3, 6].map(|row| vec3(block.corners[row][lane], block.corners[row + 1][lane], block.corners[row + 2][lane]))
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        self.nodes.capacity() * size_of::<Node>() + self.blocks.capacity() * size_of::<Block>()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nodes_and_blocks_have_the_size_that_the_memory_budget_counts_with() {
        assert_eq!((size_of::<Node>(), align_of::<Node>()), (256, 64));
        assert_eq!(size_of::<Block>(), 160);
    }

    #[test]
    fn children_tell_what_they_are() {
        let last = Child::LIMIT as u32 - 1;
        assert!(Child::node(last).is_node());
        let b = Child::blocks(last, 4);
        assert!(!b.is_node() && !b.is_other());
        assert_eq!(b.block_range(), (Child::LIMIT - 1, 4));
        let o = Child::other(last);
        assert!(o.is_other() && !o.is_node());
        assert_eq!(o.other_index(), last);
    }
}
