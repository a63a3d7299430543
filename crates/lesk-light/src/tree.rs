//! A tree over many lights, so that choosing one costs the logarithm of their number.
//!
//! Conty Estevez & Kulla, *Importance Sampling of Many Lights with Adaptive Tree Splitting*, HPG 2018, without the
//! splitting: one light per sample.
//! DEPARTS: a node has eight children. Their estimates are made at once and are those of smaller groups than two children
//! would be; a third of the levels adds a third of the error.

use crate::bounds::LightBounds;
use crate::groups::{Groups, WIDTH};
use crate::sample::Receiver;
use crate::split::{MOST_LEVELS, groups};
use lesk_math::Isa;

/// Most lights in one tree.
pub const MAX_LIGHTS: usize = 1 << 24;

/// Lights to choose from, by their bounds.
#[derive(Clone, Debug)]
pub struct LightTree {
    /// The root is node 0; every child follows its parent.
    nodes: Vec<Node>,
    /// The place of each light: its node times [`WIDTH`], plus its number there; `NOWHERE` for one without intensity.
    places: Vec<u32>,
    /// How many lights can be chosen.
    count: usize,
    /// Available on this processor.
    isa: Isa,
}

const NOWHERE: u32 = u32::MAX;

#[derive(Clone, Debug)]
struct Node {
    groups: Groups,
    /// A node, or with `LIGHT` a light.
    children: [u32; WIDTH],
    /// The place of this node among the children of its parent, as in `places`.
    place: u32,
}

/// Marks a child that is a light.
const LIGHT: u32 = 1 << 31;

impl Default for LightTree {
    /// Without a light.
    fn default() -> Self {
        LightTree::new(&[])
    }
}

impl LightTree {
    /// Builds the tree; lights without intensity are left out. Light `i` keeps the number `i`.
    ///
    /// # Panics
    /// If there are more than [`MAX_LIGHTS`].
    pub fn new(lights: &[LightBounds]) -> Self {
        assert!(lights.len() <= MAX_LIGHTS, "a light tree holds at most {MAX_LIGHTS} lights");
        let mut order: Vec<u32> = (0..lights.len() as u32).filter(|&i| lights[i as usize].intensity() > 0.0).collect();
        let mut tree =
            LightTree { nodes: vec![], places: vec![NOWHERE; lights.len()], count: order.len(), isa: Isa::current() };
        if !order.is_empty() {
            tree.build(lights, &mut order, NOWHERE, 0);
        }
        tree
    }

    /// Whether no light can be chosen.
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// An estimate of the illuminance by all lights at the receiver, lx; 0 only where none arrives.
    #[inline]
    pub fn illuminance(&self, receiver: &Receiver) -> f32 {
        self.nodes.first().map_or(0.0, |root| root.groups.estimates(receiver, self.isa).1)
    }

    /// Adds the node for some lights, and all below it.
    fn build(&mut self, lights: &[LightBounds], order: &mut [u32], place: u32, level: usize) {
        let at = self.nodes.len();
        self.nodes.push(Node { groups: Groups::EMPTY, children: [NOWHERE; WIDTH], place });
        for (slot, (range, bounds)) in groups(lights, order, level).into_iter().enumerate() {
            let place = (at * WIDTH + slot) as u32;
            self.nodes[at].groups.set(slot, &bounds);
            if let [single] = order[range.clone()] {
                self.nodes[at].children[slot] = LIGHT | single;
                self.places[single as usize] = place;
            } else {
                self.nodes[at].children[slot] = self.nodes.len() as u32;
                self.build(lights, &mut order[range], place, level + 1);
            }
        }
    }

    /// Chooses a light for the receiver with `u` in [0, 1); `None` where none of them contributes.
    pub fn sample(&self, receiver: &Receiver, mut u: f64) -> Option<(u32, f32)> {
        let (mut node, mut pmf) = (self.nodes.first()?, 1.0);
        if self.count == 1 {
            return Some((node.children[0] & !LIGHT, 1.0));
        }
        loop {
            let (child, chance, within) = choose(&node.shares(receiver, self.isa)?, u);
            pmf *= chance;
            u = within;
            let child = node.children[child];
            if child & LIGHT != 0 {
                return (pmf > 0.0).then_some((child & !LIGHT, pmf));
            }
            node = &self.nodes[child as usize];
        }
    }

    /// The probability with which [`sample`](Self::sample) chooses `light` for the receiver.
    pub fn pmf(&self, receiver: &Receiver, light: u32) -> f32 {
        let Some(mut place) = self.places.get(light as usize).copied().filter(|&place| place != NOWHERE) else {
            return 0.0;
        };
        if self.count == 1 {
            return 1.0;
        }
        // from the light to the root
        let (mut way, mut levels) = ([0; MOST_LEVELS], 0);
        while place != NOWHERE {
            way[levels] = place;
            levels += 1;
            place = self.nodes[place as usize / WIDTH].place;
        }
        let mut pmf = 1.0;
        for &place in way[..levels].iter().rev() {
            let Some(shares) = self.nodes[place as usize / WIDTH].shares(receiver, self.isa) else { return 0.0 };
            pmf *= shares[place as usize % WIDTH];
        }
        pmf
    }
}

impl Node {
    /// The probabilities of the children; `None` where no light of any arrives.
    #[inline]
    fn shares(&self, receiver: &Receiver, isa: Isa) -> Option<[f32; WIDTH]> {
        let (estimates, sum) = self.groups.estimates(receiver, isa);
        if sum > 0.0 && sum <= f32::MAX {
            return Some(estimates.map(|estimate| estimate / sum));
        }
        // infinite or NaN where some are out of range: equal chances
        let count = estimates.iter().filter(|&&estimate| estimate != 0.0).count();
        (count > 0).then(|| estimates.map(|estimate| if estimate != 0.0 { 1.0 / count as f32 } else { 0.0 }))
    }
}

/// The child that `u` in [0, 1) chooses, its probability, and where in its share `u` lies, from 0 to 1.
#[inline]
fn choose(shares: &[f32; WIDTH], u: f64) -> (usize, f32, f64) {
    let mut before = 0.0;
    let mut last = (0, 0.0, 0.0);
    for (child, &share) in shares.iter().enumerate().filter(|(_, share)| **share > 0.0) {
        let wide = f64::from(share);
        last = (child, share, ((u - before) / wide).min(1.0 - f64::EPSILON));
        if u < before + wide {
            break;
        }
        before += wide;
    }
    last
}
