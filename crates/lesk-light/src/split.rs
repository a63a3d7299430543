//! Which lights go into one group: the surface area and orientation heuristic of Conty Estevez & Kulla, *Importance
//! Sampling of Many Lights with Adaptive Tree Splitting*, HPG 2018, section 4.4.

use crate::bounds::LightBounds;
use crate::groups::WIDTH;
use std::ops::Range;

/// Levels below which groups are halved by count: with at most 2^24 lights no path is longer than `MOST_LEVELS`.
const BALANCED_BELOW: usize = 24;
/// Eight halves of eight halves: 2^24 lights take eight levels more.
pub(crate) const MOST_LEVELS: usize = BALANCED_BELOW + 8;
const BUCKETS: usize = 12;

/// Orders two or more lights into up to eight groups: the costliest group is cut again and again.
pub(crate) fn groups(lights: &[LightBounds], order: &mut [u32], level: usize) -> Vec<(Range<usize>, LightBounds)> {
    let around = |order: &[u32]| bounds_of(lights, order);
    let mut groups = vec![(0..order.len(), around(order))];
    while groups.len() < WIDTH {
        let size = |(range, bounds): &(Range<usize>, LightBounds)| {
            // balanced: the largest; lights at one place cost nothing
            (if level < BALANCED_BELOW { bounds.cost() } else { 0.0 }, range.len())
        };
        let cuttable = (0..groups.len()).filter(|&i| groups[i].0.len() > 1);
        let Some(costliest) = cuttable.max_by(|&a, &b| {
            let (a, b) = (size(&groups[a]), size(&groups[b]));
            a.0.total_cmp(&b.0).then(a.1.cmp(&b.1))
        }) else {
            break;
        };
        let (range, _) = groups.swap_remove(costliest);
        let middle = range.start + split(lights, &mut order[range.clone()], level);
        for part in [range.start..middle, middle..range.end] {
            let bounds = around(&order[part.clone()]);
            groups.push((part, bounds));
        }
    }
    groups
}

/// Bounds of some lights together.
fn bounds_of(lights: &[LightBounds], order: &[u32]) -> LightBounds {
    let first = lights[order[0] as usize];
    order[1..].iter().fold(first, |sum, &i| sum.union(&lights[i as usize]))
}

/// Orders the lights into two parts of least cost and returns the size of the first, neither 0 nor all.
fn split(lights: &[LightBounds], order: &mut [u32], level: usize) -> usize {
    let centers = order.iter().map(|&i| lights[i as usize].center().to_array());
    let (mut lo, mut hi) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
    for c in centers {
        for k in 0..3 {
            (lo[k], hi[k]) = (lo[k].min(c[k]), hi[k].max(c[k]));
        }
    }
    let widest = (0..3).max_by(|&a, &b| (hi[a] - lo[a]).total_cmp(&(hi[b] - lo[b]))).unwrap_or(0);
    if level < BALANCED_BELOW
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
        // thin nodes are better than long ones: the regulariser K_r
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
