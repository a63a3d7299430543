//! From primitives to the eight-wide tree: a binary tree by PLOC with reinsertion (crate `obvhs`), collapsed as `plan`
//! finds best.

use super::plan::{MOST_BLOCKS, Plan, plans};
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
    plans: Vec<Plan>,
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
            plans: plans(binary, items),
            binary,
            items,
            tree: Tree { nodes: vec![], blocks: vec![], bounds: root, reach: root.reach() },
        };
        // exact, because growing vectors of this size would double the peak of memory
        let (nodes, blocks) = c.count();
        c.tree.blocks.reserve_exact(blocks);
        c.tree.nodes.reserve_exact(nodes);
        c
    }

    fn finish(mut self) -> Tree {
        self.tree.nodes.shrink_to_fit();
        self.tree
    }

    /// Nodes and blocks that following the plans takes; cutting a deep tree into parts may take more.
    fn count(&self) -> (usize, usize) {
        let (mut nodes, mut blocks) = (0, 0);
        let mut stack = vec![0u32];
        let mut children = Vec::new();
        while let Some(node) = stack.pop() {
            nodes += 1;
            children.clear();
            self.gather(node, 8, &mut children);
            for &child in &children {
                match self.plans[child as usize].leaf_blocks() {
                    Some(count) => blocks += count,
                    None => stack.push(child),
                }
            }
        }
        (nodes, blocks)
    }

    /// Collects the roots of at most `most` subtrees that together are the binary node.
    fn gather(&self, node: u32, most: usize, out: &mut Vec<u32>) {
        let share = if most == 1 { 0 } else { self.plans[node as usize].first_share(most) };
        if share == 0 {
            out.push(node);
            return;
        }
        let first = self.binary.nodes[node as usize].first_index;
        self.gather(first, share, out);
        self.gather(first + 1, most - share, out);
    }

    /// The children of the wide node that a binary node becomes.
    fn nodes_of(&self, node: u32) -> Vec<Part> {
        let mut children = Vec::with_capacity(8);
        self.gather(node, 8, &mut children);
        children.into_iter().map(Part::Binary).collect()
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
                    let is_leaf = self.plans[node as usize].leaf_blocks().is_some();
                    let child = if is_leaf || depth + 12 >= MAX_DEPTH {
                        self.leaf(&self.items_of(node), depth)
                    } else {
                        self.inner(&self.nodes_of(node), depth)
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
        if others == 0 && items.len() <= MOST_BLOCKS * LANES {
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
