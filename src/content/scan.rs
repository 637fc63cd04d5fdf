//! A placement read at the samples of a lattice: for each, which point of the
//! source and which of the target is there.
//!
//! Guarantees: each sample is given the face that covers it, the last one of
//! several; samples on an edge belong to a face beside it, so that no gap
//! opens between neighbours; the result does not depend on the number of
//! threads. Samples that no face covers are left as they are.

use crate::geometry::DVec2;
use crate::warp::Placement;
use rayon::prelude::*;

/// Rows that one thread works on at a time.
const BAND: usize = 32;

/// How far beyond its edges a face reaches, in samples: rounding must not
/// open gaps.
const REACH: f64 = 1e-7;

/// A face on the lattice.
#[derive(Clone, Copy, Debug)]
struct Patch {
    corners: [DVec2; 3],
    source: Plane,
    target: Plane,
}

/// An affine map from the lattice.
#[derive(Clone, Copy, Debug)]
struct Plane {
    origin: DVec2,
    by_x: DVec2,
    by_y: DVec2,
}

impl Plane {
    fn at(&self, x: f64, y: f64) -> DVec2 {
        self.origin + self.by_x * x + self.by_y * y
    }

    /// The map that sends the corners to the values.
    fn through(corners: [DVec2; 3], values: [DVec2; 3], det: f64) -> Self {
        let [a, b, c] = corners;
        let (u, v) = ((b - a) / det, (c - a) / det);
        let (du, dv) = (values[1] - values[0], values[2] - values[0]);
        let by_x = du * v.y - dv * u.y;
        let by_y = dv * u.x - du * v.x;
        Self {
            origin: values[0] - by_x * a.x - by_y * a.y,
            by_x,
            by_y,
        }
    }
}

/// Writes `value(in source, in target)` to each sample that is covered.
/// `to_lattice` sends the plane to the lattice, whose sample (x, y) is at
/// (x, y) and at `out[y * width + x]`.
pub(super) fn scan<T: Send>(
    placement: &Placement,
    to_lattice: impl Fn(DVec2) -> DVec2,
    width: usize,
    out: &mut [T],
    value: impl Fn(DVec2, DVec2) -> T + Sync,
) {
    if width == 0 || out.is_empty() {
        return;
    }
    let places: Vec<DVec2> = placement.in_frame.iter().map(|&p| to_lattice(p)).collect();
    let patches: Vec<Patch> = (placement.faces.iter())
        .filter_map(|face| patch(face, &places, placement))
        .collect();
    let bands = sorted(&patches, out.len() / width);
    let rows = out.par_chunks_mut(width * BAND).zip(bands);
    rows.enumerate().for_each(|(band, (rows, here))| {
        for patch in here {
            paint(&patches[patch as usize], band * BAND, width, rows, &value);
        }
    });
}

fn patch(face: &[u32; 3], places: &[DVec2], placement: &Placement) -> Option<Patch> {
    let of = |points: &[DVec2]| face.map(|v| points[v as usize]);
    let corners = of(places);
    let [a, b, c] = corners;
    let det = (b - a).perp_dot(c - a);
    (det.is_normal() && corners.iter().all(|p| p.is_finite())).then(|| Patch {
        source: Plane::through(corners, of(&placement.in_source), det),
        target: Plane::through(corners, of(&placement.in_target), det),
        corners: if det > 0.0 { corners } else { [a, c, b] },
    })
}

/// For each band of rows the faces that may reach it, in their order.
fn sorted(patches: &[Patch], rows: usize) -> Vec<Vec<u32>> {
    let mut bands = vec![Vec::new(); rows.div_ceil(BAND)];
    for (k, patch) in patches.iter().enumerate() {
        let ys = patch.corners.map(|p| p.y);
        let low = ys.into_iter().fold(f64::INFINITY, f64::min) - 1.0;
        let high = ys.into_iter().fold(f64::NEG_INFINITY, f64::max) + 1.0;
        if high < 0.0 || low > rows as f64 {
            continue;
        }
        let last = (high.min(rows as f64) as usize / BAND).min(bands.len() - 1);
        for band in &mut bands[low.max(0.0) as usize / BAND..=last] {
            band.push(k as u32);
        }
    }
    bands
}

fn paint<T>(
    patch: &Patch,
    first_row: usize,
    width: usize,
    rows: &mut [T],
    value: &impl Fn(DVec2, DVec2) -> T,
) {
    let ys = patch.corners.map(|p| p.y);
    let low = ys.into_iter().fold(f64::INFINITY, f64::min) - REACH;
    let high = ys.into_iter().fold(f64::NEG_INFINITY, f64::max) + REACH;
    let count = rows.len() / width;
    let begin = (low.ceil() - first_row as f64).max(0.0) as usize;
    let end = (high.floor() - first_row as f64 + 1.0).clamp(0.0, count as f64) as usize;
    for row in begin..end {
        let y = (first_row + row) as f64;
        let Some([from, to]) = span(&patch.corners, y) else {
            continue;
        };
        let from = from.ceil().max(0.0);
        let to = to.floor().min((width - 1) as f64);
        if from > to {
            continue;
        }
        for x in from as usize..=to as usize {
            let at = x as f64;
            rows[row * width + x] = value(patch.source.at(at, y), patch.target.at(at, y));
        }
    }
}

/// Where a row lies in a counter-clockwise triangle.
fn span(corners: &[DVec2; 3], y: f64) -> Option<[f64; 2]> {
    let (mut from, mut to) = (f64::NEG_INFINITY, f64::INFINITY);
    for k in 0..3 {
        let (a, b) = (corners[k], corners[(k + 1) % 3]);
        let edge = b - a;
        // Left of the edge: edge.x (y - a.y) - edge.y (x - a.x) >= 0.
        let slack = edge.x * (y - a.y) + REACH * edge.length();
        if edge.y == 0.0 {
            if slack < 0.0 {
                return None;
            }
        } else {
            let x = a.x + slack / edge.y;
            if edge.y > 0.0 {
                to = to.min(x);
            } else {
                from = from.max(x);
            }
        }
    }
    (from <= to).then_some([from, to])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Bounds;
    use crate::warp::{Still, Warp};
    use proptest::prelude::*;
    use std::sync::Arc;

    #[test]
    fn a_rectangle_that_stands_still_is_itself_everywhere() {
        let frame = Bounds {
            min: DVec2::splat(-0.5),
            max: DVec2::new(69.5, 99.5),
        };
        let still = Still::new(frame).placer();
        let mut out = vec![None; 70 * 100];
        scan(still.placement(), |p| p, 70, &mut out, |s, t| Some((s, t)));
        for (k, found) in out.iter().enumerate() {
            let here = DVec2::new((k % 70) as f64, (k / 70) as f64);
            let (source, target) = found.expect("covered");
            assert!(source.distance(here) < 1e-12 && target.distance(here) < 1e-12);
        }
    }

    proptest! {
        /// Whatever the triangle, samples inside are covered and others not.
        #[test]
        fn what_lies_inside_is_covered(points in prop::collection::vec((-5.0f64..45.0, -5.0f64..45.0), 3)) {
            let corners: Vec<DVec2> = points.into_iter().map(DVec2::from).collect();
            let placement = Placement {
                faces: Arc::new([[0, 1, 2]]),
                in_frame: corners.clone(),
                in_source: corners.clone(),
                in_target: corners.clone(),
            };
            let mut out = vec![None; 40 * 40];
            scan(&placement, |p| p, 40, &mut out, |s, _| Some(s));
            let [a, b, c] = [corners[0], corners[1], corners[2]];
            let det = (b - a).perp_dot(c - a);
            prop_assume!(det.abs() > 1e-3);
            for (k, found) in out.iter().enumerate() {
                let p = DVec2::new((k % 40) as f64, (k / 40) as f64);
                let sides = [(a, b), (b, c), (c, a)]
                    .map(|(u, v)| det.signum() * (v - u).perp_dot(p - u) / u.distance(v));
                let least = sides.into_iter().fold(f64::INFINITY, f64::min);
                if least > 1e-6 {
                    let found = found.expect("inside");
                    prop_assert!(found.distance(p) < 1e-6);
                } else if least < -1e-3 {
                    prop_assert!(found.is_none());
                }
            }
        }
    }
}
