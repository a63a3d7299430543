//! Faces cut at the near plane and at the guard band around the screen.

use crate::prepare::Prepared;
use crate::view::{GUARD, Homogeneous, Screen, View};

/// A corner of a clipped face.
#[derive(Clone, Debug)]
pub(crate) struct ClippedCorner {
    pub screen: Screen,
    /// How much each corner of the whole face counts.
    pub weights: Vec<f64>,
}

/// What is left of a face.
#[derive(Clone, Debug)]
pub(crate) struct Clipped {
    pub face: u32,
    pub corners: Vec<ClippedCorner>,
}

#[derive(Clone)]
struct Corner {
    at: Homogeneous,
    weights: Vec<f64>,
}

/// Cuts a face (Sutherland & Hodgman, *Reentrant Polygon Clipping*, Communications of the ACM 17(1), 1974); `None` where
/// nothing is left. Sides of the screen do not cut: spans end there, so that the inside of a face stays as it is.
pub(crate) fn clip(prepared: &Prepared, view: &View, face: u32) -> Option<Clipped> {
    let whole = prepared.face(face as usize);
    let mut corners: Vec<Corner> = whole
        .iter()
        .enumerate()
        .map(|(k, &v)| Corner {
            at: view.project(prepared.vertices[v as usize].p),
            weights: (0..whole.len()).map(|j| f64::from(u8::from(j == k))).collect(),
        })
        .collect();
    // a little inside, so that rounding does not lead out again
    let guard = GUARD * (1.0 - 1e-9);
    let near = view.near * (1.0 + 1e-9);
    let planes: [&dyn Fn(Homogeneous) -> f64; 5] =
        [&|h| h.w - near, &|h| guard * h.w - h.x, &|h| guard * h.w + h.x, &|h| guard * h.w - h.y, &|h| {
            guard * h.w + h.y
        }];
    for plane in planes {
        corners = cut(&corners, plane);
        if corners.len() < 3 {
            return None;
        }
    }
    let done: Vec<ClippedCorner> =
        corners.into_iter().map(|c| ClippedCorner { screen: view.snap(c.at), weights: c.weights }).collect();
    // coordinates that are no numbers have no place
    done.iter().all(|c| c.screen.x != Screen::CLIP).then_some(Clipped { face, corners: done })
}

fn cut(corners: &[Corner], distance: &dyn Fn(Homogeneous) -> f64) -> Vec<Corner> {
    let mut out = Vec::with_capacity(corners.len() + 1);
    for (k, a) in corners.iter().enumerate() {
        let b = &corners[(k + 1) % corners.len()];
        let (da, db) = (distance(a.at), distance(b.at));
        if da >= 0.0 {
            out.push(a.clone());
        }
        if (da >= 0.0) != (db >= 0.0) {
            // from the inner end, so that both faces at an edge cut it at the same point
            let (inner, outer, t) = if da >= 0.0 { (a, b, da / (da - db)) } else { (b, a, db / (db - da)) };
            let mix = |x: f64, y: f64| x + (y - x) * t;
            let at = Homogeneous {
                x: mix(inner.at.x, outer.at.x),
                y: mix(inner.at.y, outer.at.y),
                w: mix(inner.at.w, outer.at.w),
            };
            out.push(Corner {
                at,
                weights: inner.weights.iter().zip(&outer.weights).map(|(x, y)| mix(*x, *y)).collect(),
            });
        }
    }
    out
}
