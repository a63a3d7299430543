//! A tree over many lights, so that choosing one costs the logarithm of their number.
//!
//! Conty Estevez & Kulla, *Importance Sampling of Many Lights with Adaptive Tree Splitting*, HPG 2018, without the
//! splitting: one light per sample.

use crate::bounds::{LightBounds, NodeBounds};
use crate::sample::Receiver;

/// Depth below which nodes are halved by count: with at most 2^24 lights no path is longer than 64.
const BALANCED_BELOW: u32 = 40;
/// Most lights in one tree.
pub const MAX_LIGHTS: usize = 1 << 24;
const BUCKETS: usize = 12;
const NO_LEAF: u32 = u32::MAX;

/// Lights to choose from, by their bounds.
#[derive(Clone, Debug, Default)]
pub struct LightTree {
    nodes: Vec<Node>,
    /// For each light the way from the root, lowest bit first, 1 for the second child; and its length.
    ways: Vec<Option<(u64, u8)>>,
}

#[derive(Clone, Copy, Debug)]
struct Node {
    bounds: NodeBounds,
    /// The light of a leaf, else `NO_LEAF`.
    leaf: u32,
    /// The second child; the first one follows its parent.
    second: u32,
}

impl LightTree {
    /// Builds the tree; lights without intensity are left out. Light `i` keeps the number `i`.
    ///
    /// # Panics
    /// If there are more than [`MAX_LIGHTS`].
    pub fn new(lights: &[LightBounds]) -> Self {
        assert!(lights.len() <= MAX_LIGHTS, "a light tree holds at most {MAX_LIGHTS} lights");
        let mut order: Vec<u32> = (0..lights.len() as u32).filter(|&i| lights[i as usize].intensity() > 0.0).collect();
        let mut tree = LightTree { nodes: vec![], ways: vec![None; lights.len()] };
        if !order.is_empty() {
            tree.build(lights, &mut order, 0, 0);
        }
        tree
    }

    /// Whether no light can be chosen.
    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// An estimate of the illuminance by all lights at the receiver, lx; 0 only where none arrives.
    #[inline]
    pub fn illuminance(&self, receiver: &Receiver) -> f32 {
        self.nodes.first().map_or(0.0, |root| root.bounds.importance(receiver))
    }

    fn build(&mut self, lights: &[LightBounds], order: &mut [u32], way: u64, depth: u32) -> LightBounds {
        let at = self.nodes.len();
        if let [single] = *order {
            let bounds = lights[single as usize];
            self.ways[single as usize] = Some((way, depth as u8));
            self.nodes.push(Node { bounds: bounds.node(), leaf: single, second: 0 });
            return bounds;
        }
        self.nodes.push(Node { bounds: lights[order[0] as usize].node(), leaf: NO_LEAF, second: 0 });
        let middle = split(lights, order, depth);
        let (left, right) = order.split_at_mut(middle);
        let first = self.build(lights, left, way, depth + 1);
        self.nodes[at].second = self.nodes.len() as u32;
        let second = self.build(lights, right, way | 1 << depth, depth + 1);
        let bounds = first.union(&second);
        self.nodes[at].bounds = bounds.node();
        bounds
    }

    /// The probability of the first child of the inner node `at`; `None` where both are useless.
    #[inline]
    fn first_share(&self, at: usize, receiver: &Receiver) -> Option<f32> {
        let first = self.nodes[at + 1].bounds.importance(receiver);
        let second = self.nodes[self.nodes[at].second as usize].bounds.importance(receiver);
        let share = first / (first + second);
        // infinite or NaN where both are out of range: equal chances
        if first == 0.0 && second == 0.0 { None } else { Some(if share.is_finite() { share } else { 0.5 }) }
    }

    /// Chooses a light for the receiver with `u` in [0, 1); `None` where none of them contributes.
    pub fn sample(&self, receiver: &Receiver, mut u: f64) -> Option<(u32, f32)> {
        if self.nodes.is_empty() {
            return None;
        }
        let (mut at, mut pmf) = (0, 1.0);
        while self.nodes[at].leaf == NO_LEAF {
            let share = self.first_share(at, receiver)?;
            let wide = f64::from(share);
            if u < wide {
                u /= wide;
                pmf *= share;
                at += 1;
            } else {
                u = (u - wide) / (1.0 - wide);
                pmf *= 1.0 - share;
                at = self.nodes[at].second as usize;
            }
        }
        (pmf > 0.0).then_some((self.nodes[at].leaf, pmf))
    }

    /// The probability with which [`sample`](Self::sample) chooses `light` for the receiver.
    pub fn pmf(&self, receiver: &Receiver, light: u32) -> f32 {
        let Some(Some((mut way, depth))) = self.ways.get(light as usize).copied() else { return 0.0 };
        let (mut at, mut pmf) = (0, 1.0);
        for _ in 0..depth {
            let Some(share) = self.first_share(at, receiver) else { return 0.0 };
            if way & 1 == 0 {
                pmf *= share;
                at += 1;
            } else {
                pmf *= 1.0 - share;
                at = self.nodes[at].second as usize;
            }
            way >>= 1;
        }
        pmf
    }
}

/// Orders the lights into two parts of least cost and returns the size of the first, neither 0 nor all.
fn split(lights: &[LightBounds], order: &mut [u32], depth: u32) -> usize {
    let centers = order.iter().map(|&i| lights[i as usize].center().to_array());
    let (mut lo, mut hi) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
    for c in centers {
        for k in 0..3 {
            (lo[k], hi[k]) = (lo[k].min(c[k]), hi[k].max(c[k]));
        }
    }
    let widest = (0..3).max_by(|&a, &b| (hi[a] - lo[a]).total_cmp(&(hi[b] - lo[b]))).unwrap_or(0);
    if depth < BALANCED_BELOW
        && let Some((axis, bucket)) = best_plane(lights, order, lo, hi)
    {
        let first = partition(order, |i| bucket_of(lights, i, axis, lo, hi) <= bucket);
        if 0 < first && first < order.len() {
            return first;
        }
    }
    let key = |i: &u32| lights[*i as usize].center().to_array()[widest];
    order.sort_by(|a, b| key(a).total_cmp(&key(b)).then(a.cmp(b)));
    order.len() / 2
}

fn bucket_of(lights: &[LightBounds], light: u32, axis: usize, lo: [f32; 3], hi: [f32; 3]) -> usize {
    let c = lights[light as usize].center().to_array()[axis];
    let t = (c - lo[axis]) / (hi[axis] - lo[axis]);
    ((t * BUCKETS as f32) as usize).min(BUCKETS - 1)
}

/// The axis and last bucket of the first part with the least cost; `None` where all centres coincide.
fn best_plane(lights: &[LightBounds], order: &[u32], lo: [f32; 3], hi: [f32; 3]) -> Option<(usize, usize)> {
    let longest = (0..3).map(|k| hi[k] - lo[k]).fold(0.0, f32::max);
    let mut best: Option<(f64, usize, usize)> = None;
    for axis in (0..3).filter(|&k| hi[k] > lo[k]) {
        let mut buckets: [Option<LightBounds>; BUCKETS] = [None; BUCKETS];
        for &i in order {
            let slot = &mut buckets[bucket_of(lights, i, axis, lo, hi)];
            let light = &lights[i as usize];
            *slot = Some(slot.as_ref().map_or(*light, |s| s.union(light)));
        }
        // thin nodes are better than long ones: the regulariser K_r of section 4.4
        let regular = f64::from(longest / (hi[axis] - lo[axis]));
        for (plane, cost) in plane_costs(&buckets).into_iter().enumerate() {
            let cost = cost * regular;
            if cost > 0.0 && best.is_none_or(|(c, ..)| cost < c) {
                best = Some((cost, axis, plane));
            }
        }
    }
    best.map(|(_, axis, plane)| (axis, plane))
}

/// The cost of splitting behind each bucket but the last; 0 where a part would be empty.
fn plane_costs(buckets: &[Option<LightBounds>; BUCKETS]) -> [f64; BUCKETS - 1] {
    let join = |a: Option<LightBounds>, b: &Option<LightBounds>| match (a, b) {
        (Some(a), Some(b)) => Some(a.union(b)),
        (a, b) => a.or(*b),
    };
    let mut costs = [0.0; BUCKETS - 1];
    let mut below = None;
    let mut first = [None; BUCKETS];
    for i in 0..BUCKETS {
        below = join(below, &buckets[i]);
        first[i] = below;
    }
    let mut above = None;
    for i in (0..BUCKETS - 1).rev() {
        above = join(above, &buckets[i + 1]);
        if let (Some(a), Some(b)) = (&first[i], &above) {
            // single lights cost nothing; keep such planes eligible
            costs[i] = (a.cost() + b.cost()).max(f64::MIN_POSITIVE);
        }
    }
    costs
}

/// Moves the entries for which `keep` holds to the front and returns their number.
fn partition(order: &mut [u32], keep: impl Fn(u32) -> bool) -> usize {
    let mut count = 0;
    for i in 0..order.len() {
        if keep(order[i]) {
            order.swap(i, count);
            count += 1;
        }
    }
    count
}
