//! From primitives to the eight-wide tree: a binary tree by PLOC with reinsertion (crate `obvhs`), collapsed.

use super::tree::{Child, LANES, MAX_DEPTH, Node, Tree};
use super::triangle::Block;
use crate::bounds::Bounds;
use crate::error::{Error, Result};
use lesk_math::Vec3;
use obvhs::bvh2::Bvh2;
use obvhs::{Boundable, BvhBuildParams, aabb::Aabb};

/// Something to put into a tree.
pub(super) enum Item {
    /// Three corners and the number that a hit reports.
    Triangle([Vec3<f32>; 3], u32),
    /// Anything else: its box and its number.
    Other(Bounds, u32),
}

/// Numbered items.
pub(super) trait Items {
    fn len(&self) -> usize;
    fn item(&self, index: u32) -> Item;
    /// How many of them are no triangles.
    fn other_count(&self) -> usize;
}

fn item_bounds(item: &Item) -> Bounds {
    match item {
        Item::Triangle(corners, _) => {
            let mut b = Bounds::EMPTY;
            corners.iter().for_each(|&p| b.add(p));
            b
        }
        Item::Other(b, _) => *b,
    }
}

/// One item by reference: 16 bytes, where a box would take 32.
struct Reference<'a, I> {
    items: &'a I,
    index: u32,
}

impl<I: Items> Boundable for Reference<'_, I> {
    fn aabb(&self) -> Aabb {
        let b = item_bounds(&self.items.item(self.index));
        Aabb::new(b.min.to_array().into(), b.max.to_array().into())
    }
}

/// Builds the tree.
///
/// # Errors
/// More items than 28 bits number.
pub(super) fn build(items: &impl Items) -> Result<Tree> {
    let count = items.len();
    if count >= Child::LIMIT {
        return Err(Error::new(format!("scene has {count} primitives, fewer than {} are accepted", Child::LIMIT)));
    }
    if count == 0 {
        return Ok(Tree { nodes: vec![], blocks: vec![], bounds: Bounds::EMPTY, reach: 0.0 });
    }
    let binary = binary_tree(items);
    let mut collapse = Collapse::new(&binary, items);
    let root = collapse.nodes_of(0);
    collapse.tree.nodes.push(Node::EMPTY);
    collapse.fill(0, &root, 0);
    Ok(collapse.finish())
}

fn binary_tree(items: &impl Items) -> Bvh2 {
    let references: Vec<_> = (0..items.len() as u32).map(|index| Reference { items, index }).collect();
    // leaves are formed while collapsing, from any subtree that fits a block
    let params = BvhBuildParams { max_prims_per_leaf: 1, ..BvhBuildParams::medium_build() };
    obvhs::bvh2::builder::build_bvh2(&references, params, &mut std::time::Duration::default())
}

struct Collapse<'a, I> {
    binary: &'a Bvh2,
    items: &'a I,
    /// Primitives below each binary node, saturated.
    counts: Vec<u8>,
    tree: Tree,
}

/// A child to be: a binary node, or a list of items where the tree must be cut.
enum Part {
    Binary(u32),
    Items(Vec<u32>),
}

impl<'a, I: Items> Collapse<'a, I> {
    fn new(binary: &'a Bvh2, items: &'a I) -> Self {
        let root = bounds_of(binary, 0);
        let mut c = Collapse {
            counts: count_primitives(binary),
            binary,
            items,
            tree: Tree { nodes: vec![], blocks: vec![], bounds: root, reach: root.reach() },
        };
        // exact, because growing a vector of this size would double the peak of memory
        let blocks = c.count_blocks() + LANES * items.other_count();
        c.tree.blocks.reserve_exact(blocks);
        c.tree.nodes.reserve(blocks / 6 + 1);
        c
    }

    fn finish(mut self) -> Tree {
        self.tree.nodes.shrink_to_fit();
        self.tree
    }

    /// Whether a binary node becomes a leaf.
    fn is_small(&self, node: u32) -> bool {
        self.binary.nodes[node as usize].is_leaf() || self.counts[node as usize] as usize <= LANES
    }

    /// An upper bound of the number of blocks: what the small nodes below the root need.
    fn count_blocks(&self) -> usize {
        let mut blocks = 0;
        let mut stack = vec![0u32];
        while let Some(node) = stack.pop() {
            if self.is_small(node) {
                blocks += (self.counts[node as usize] as usize).div_ceil(LANES);
            } else {
                let first = self.binary.nodes[node as usize].first_index;
                stack.extend([first, first + 1]);
            }
        }
        blocks
    }

    /// Up to eight descendants of a binary node, opening the one of largest area until there are enough.
    fn nodes_of(&self, node: u32) -> Vec<Part> {
        let mut open = vec![node];
        while open.len() < 8 {
            let area = |n: u32| self.binary.nodes[n as usize].aabb().half_area();
            let largest = (0..open.len())
                .filter(|&k| !self.is_small(open[k]))
                .max_by(|&a, &b| area(open[a]).total_cmp(&area(open[b])));
            let Some(k) = largest else { break };
            let first = self.binary.nodes[open[k] as usize].first_index;
            open[k] = first;
            open.push(first + 1);
        }
        open.into_iter().map(Part::Binary).collect()
    }

    /// The items below a binary node.
    fn items_of(&self, node: u32) -> Vec<u32> {
        let mut out = Vec::new();
        let mut stack = vec![node];
        while let Some(k) = stack.pop() {
            let n = &self.binary.nodes[k as usize];
            if n.is_leaf() {
                let range = n.first_index as usize..(n.first_index + n.prim_count) as usize;
                out.extend_from_slice(&self.binary.primitive_indices[range]);
            } else {
                stack.extend([n.first_index, n.first_index + 1]);
            }
        }
        out
    }

    /// Writes the children of `index`.
    fn fill(&mut self, index: usize, parts: &[Part], depth: usize) {
        for (slot, part) in parts.iter().enumerate() {
            let (bounds, child) = match part {
                &Part::Binary(node) => {
                    let bounds = bounds_of(self.binary, node);
                    let child = if self.is_small(node) {
                        self.leaf(&self.items_of(node), depth)
                    } else if depth + 12 < MAX_DEPTH {
                        self.inner(&self.nodes_of(node), depth)
                    } else {
                        self.leaf(&self.items_of(node), depth)
                    };
                    (bounds, child)
                }
                Part::Items(items) => (self.bounds_of_items(items), self.leaf(items, depth)),
            };
            self.tree.nodes[index].set(slot, &bounds, child);
        }
    }

    fn inner(&mut self, parts: &[Part], depth: usize) -> Child {
        let index = self.tree.nodes.len();
        self.tree.nodes.push(Node::EMPTY);
        self.fill(index, parts, depth + 1);
        Child::node(index as u32)
    }

    /// A leaf where the items fit into one, else a node over equal parts of them.
    fn leaf(&mut self, items: &[u32], depth: usize) -> Child {
        let others = items.iter().filter(|&&i| matches!(self.items.item(i), Item::Other(..))).count();
        if others == 0 && items.len() <= 2 * LANES {
            return self.blocks(items);
        }
        if let [only] = *items
            && let Item::Other(_, number) = self.items.item(only)
        {
            return Child::other(number);
        }
        let size = items.len().div_ceil(8);
        let parts: Vec<Part> = items.chunks(size).map(|c| Part::Items(c.to_vec())).collect();
        self.inner(&parts, depth)
    }

    fn blocks(&mut self, items: &[u32]) -> Child {
        let first = self.tree.blocks.len() as u32;
        for chunk in items.chunks(LANES) {
            let mut block = Block::EMPTY;
            for (lane, &i) in chunk.iter().enumerate() {
                if let Item::Triangle(corners, id) = self.items.item(i) {
                    block.id[lane] = id;
                    for (row, x) in corners.iter().flat_map(|c| c.to_array()).enumerate() {
                        block.corners[row][lane] = x;
                    }
                }
            }
            self.tree.blocks.push(block);
        }
        Child::blocks(first, items.len().div_ceil(LANES) as u32)
    }

    fn bounds_of_items(&self, items: &[u32]) -> Bounds {
        items.iter().fold(Bounds::EMPTY, |b, &i| b.union(item_bounds(&self.items.item(i))))
    }
}

fn bounds_of(binary: &Bvh2, node: u32) -> Bounds {
    let b = binary.nodes[node as usize].aabb();
    Bounds { min: b.min.to_array().into(), max: b.max.to_array().into() }
}

/// Primitives below every node, at most 255.
fn count_primitives(binary: &Bvh2) -> Vec<u8> {
    let mut counts = vec![0u8; binary.nodes.len()];
    // a node is visited once on the way down and once, marked, on the way up
    let mut stack = vec![(0u32, false)];
    while let Some((k, summed)) = stack.pop() {
        let n = &binary.nodes[k as usize];
        counts[k as usize] = if n.is_leaf() {
            n.prim_count.min(255) as u8
        } else if summed {
            let [a, b] = [n.first_index, n.first_index + 1].map(|c| counts[c as usize]);
            a.saturating_add(b)
        } else {
            stack.extend([(k, true), (n.first_index, false), (n.first_index + 1, false)]);
            continue;
        };
    }
    counts
}
