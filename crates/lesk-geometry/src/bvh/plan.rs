//! Which nodes of a binary tree become the nodes and leaves of the eight-wide one: those of least expected cost for a
//! random ray, found by dynamic programming.
//!
//! Ylitie, Karras & Laine, *Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs*, HPG 2017, section 3;
//! names as there. C(n, i) is the least cost of representing the subtree at `n` as a forest of at most `i` wide nodes and
//! leaves. A tree that opens the largest child until there are eight leaves many nodes half empty.

use super::build::{Item, Items};
use super::tree::LANES;
use obvhs::bvh2::Bvh2;

/// Cost of testing a ray against eight boxes, by definition.
const NODE_COST: f32 = 1.0;
/// Cost of testing four triangles in these units (measured: both take about the same time).
const BLOCK_COST: f32 = 1.0;
/// Most blocks of a leaf.
pub(super) const MOST_BLOCKS: usize = 2;

/// What becomes of one binary node. Bits 3 (i - 2) to 3 (i - 2) + 2: how many of `i` roots the first child gets, 0 where
/// one root for the whole node is better. Bits 24 up: the blocks of the leaf that it becomes as one root, or 0.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Plan(u32);

impl Plan {
    fn new(shares: [usize; 9], leaf_blocks: usize) -> Plan {
        let shares = (2..=8).fold(0, |bits, i| bits | (shares[i] as u32) << (3 * (i - 2)));
        Plan(shares | (leaf_blocks as u32) << 24)
    }

    /// How many of `most` roots, 2 to 8, the first child gets; 0: keep the node whole.
    pub fn first_share(self, most: usize) -> usize {
        (self.0 >> (3 * (most - 2)) & 7) as usize
    }

    /// How many blocks the leaf needs that this node becomes; `None` where it becomes an inner node.
    pub fn leaf_blocks(self) -> Option<usize> {
        let blocks = (self.0 >> 24) as usize;
        (blocks > 0).then_some(blocks)
    }
}

/// What a finished subtree costs.
#[derive(Clone, Copy)]
struct Subtree {
    /// C(n, i) at index i; index 0 is not used.
    cost: [f32; 9],
    /// Triangles in it; `usize::MAX` where it holds something else, which no block can.
    triangles: usize,
}

/// The plan of every binary node.
pub(super) fn plans(binary: &Bvh2, items: &impl Items) -> Vec<Plan> {
    let mut plans = vec![Plan::default(); binary.nodes.len()];
    let mut done: Vec<Subtree> = Vec::new();
    // a node is visited once on the way down and once, with its children done, on the way up
    let mut stack = vec![(0u32, false)];
    while let Some((index, children_done)) = stack.pop() {
        let node = &binary.nodes[index as usize];
        let area = node.aabb().half_area();
        if node.is_leaf() {
            let range = node.first_index as usize..(node.first_index + node.prim_count) as usize;
            let is_triangle = |&i: &u32| matches!(items.item(i), Item::Triangle(..));
            let all = items.other_count() == 0 || binary.primitive_indices[range].iter().all(is_triangle);
            let blocks = (node.prim_count as usize).div_ceil(LANES);
            plans[index as usize] = Plan::new([0; 9], blocks);
            let triangles = if all { node.prim_count as usize } else { usize::MAX };
            done.push(Subtree { cost: [area * BLOCK_COST * blocks as f32; 9], triangles });
        } else if children_done {
            // the first child was pushed first and popped last
            let first = done.pop().expect("the first child is done");
            let second = done.pop().expect("the second child is done");
            let (plan, subtree) = join(area, &first, &second);
            plans[index as usize] = plan;
            done.push(subtree);
        } else {
            stack.extend([(index, true), (node.first_index, false), (node.first_index + 1, false)]);
        }
    }
    plans
}

/// The best plan for a node of the given half area, and what it costs.
fn join(area: f32, first: &Subtree, second: &Subtree) -> (Plan, Subtree) {
    // C_distribute(n, i) and the share of the first child
    let (mut split, mut shares) = ([f32::INFINITY; 9], [0; 9]);
    for i in 2..=8 {
        for k in 1..i {
            let cost = first.cost[k] + second.cost[i - k];
            if cost < split[i] {
                (split[i], shares[i]) = (cost, k);
            }
        }
    }
    let triangles = first.triangles.saturating_add(second.triangles);
    let blocks = triangles.div_ceil(LANES);
    let leaf = if blocks <= MOST_BLOCKS { area * BLOCK_COST * blocks as f32 } else { f32::INFINITY };
    let inner = split[8] + area * NODE_COST;
    let one = leaf.min(inner);
    let mut cost = [one; 9];
    for i in 2..=8 {
        if split[i] < one {
            cost[i] = split[i];
        } else if i < 8 {
            shares[i] = 0;
        }
    }
    (Plan::new(shares, if leaf <= inner { blocks } else { 0 }), Subtree { cost, triangles })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn leaf(area: f32) -> Subtree {
        Subtree { cost: [area * BLOCK_COST; 9], triangles: 1 }
    }

    #[test]
    fn few_triangles_become_one_leaf() {
        let (plan, pair) = join(1.0, &leaf(0.9), &leaf(0.9));
        assert_eq!((plan.leaf_blocks(), pair.triangles), (Some(1), 2));
        // one block for both costs 1, two leaves 1.8
        assert_eq!(pair.cost[1..], [1.0; 8]);
        assert_eq!(plan.first_share(2), 0);
    }

    #[test]
    fn a_root_over_two_full_subtrees_gives_each_four_children() {
        // a subtree that is cheaper the more roots it may have, with as many triangles as no leaf holds
        let wide = Subtree { cost: std::array::from_fn(|i| 20.0 - i.min(4) as f32), triangles: 100 };
        let (plan, joined) = join(1.0, &wide, &wide);
        assert_eq!((plan.leaf_blocks(), plan.first_share(8)), (None, 4));
        // C(n, 1) = C_distribute(n, 8) + 1
        assert_eq!(joined.cost[1], 16.0 + 16.0 + 1.0);
        assert_eq!(joined.cost[8], 32.0);
    }

    #[test]
    fn what_is_no_triangle_never_shares_a_leaf() {
        let other = Subtree { cost: [0.1; 9], triangles: usize::MAX };
        assert_eq!(join(1.0, &other, &leaf(0.1)).0.leaf_blocks(), None);
    }
}
