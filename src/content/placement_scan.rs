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

/// Rows that one thread works on at a time: few enough to go round several
/// threads, and many enough that a face is set up in few of them.
const BAND: usize = 32;

/// How far beyond its edges a face reaches, in samples: rounding must not
/// open gaps. At 8192 a double is exact to 1e-12; nobody sees 1e-7.
const REACH: f64 = 1e-7;

/// What the samples of one face see.
#[derive(Clone, Copy, Debug)]
pub(super) struct SourceFacet {
    /// A sample, by column and row, that no other one of the face lies left of
    /// or above in the rows that are worked on.
    pub first: [usize; 2],
    /// Which points of the source and of the target.
    pub source: AffinePlane,
    pub target: AffinePlane,
}

/// An affine map from the lattice.
#[derive(Clone, Copy, Debug)]
pub(super) struct AffinePlane {
    pub origin: DVec2,
    pub by_x: DVec2,
    pub by_y: DVec2,
}

impl AffinePlane {
    /// What the sample at `x` in row `y` sees.
    #[inline]
    pub fn at(&self, x: usize, y: usize) -> DVec2 {
        self.origin + self.by_x * x as f64 + self.by_y * y as f64
    }

    /// The map that sends the corners to the values.
    fn through(corners: [DVec2; 3], values: [DVec2; 3], det: f64) -> Self {
        let [a, b, c] = corners;
        // Cramer's rule: how much of each edge makes one column, and one row.
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

/// A face on the lattice.
#[derive(Clone, Copy, Debug)]
struct ScanPatch {
    corners: [DVec2; 3],
    edges: [PatchEdge; 3],
    source: AffinePlane,
    target: AffinePlane,
}

/// A side of a counter-clockwise face, which lies to its left.
#[derive(Clone, Copy, Debug)]
struct PatchEdge {
    begin: DVec2,
    along: DVec2,
    /// [`REACH`] times its length.
    reach: f64,
    /// 1 / `along.y`; `None` where it is level.
    per_rise: Option<f64>,
}

impl PatchEdge {
    fn new(begin: DVec2, end: DVec2) -> Self {
        let along = end - begin;
        Self {
            begin,
            along,
            reach: REACH * along.length(),
            per_rise: Some(along.y.recip()).filter(|per| per.is_finite()),
        }
    }

    /// What of a row is left of it, from column to column; none where the
    /// first is larger.
    fn left_of(&self, y: f64) -> [f64; 2] {
        // Left of the edge: along.x (y - begin.y) - along.y (x - begin.x) >= 0.
        let slack = self.along.x * (y - self.begin.y) + self.reach;
        match self.per_rise {
            Some(per) if per > 0.0 => [f64::NEG_INFINITY, self.begin.x + slack * per],
            Some(per) => [self.begin.x + slack * per, f64::INFINITY],
            // A level edge has its face above or below all along the row.
            None if slack < 0.0 => [f64::INFINITY, f64::NEG_INFINITY],
            None => [f64::NEG_INFINITY, f64::INFINITY],
        }
    }
}

/// Has each face write its samples, in the order of the faces: `filler` is
/// asked once for a face and some rows, and what it gives is called with
/// column, row and what is to be written of that row from there on.
/// `to_lattice` sends the plane to the lattice, whose sample (x, y) is at
/// (x, y) and at `out[y * width + x]`.
pub(super) fn scan<T: Send, F: FnMut(usize, usize, &mut [T])>(
    placement: &Placement,
    to_lattice: impl Fn(DVec2) -> DVec2,
    width: usize,
    out: &mut [T],
    filler: impl Fn(SourceFacet) -> F + Sync,
) {
    if width == 0 || out.is_empty() {
        return;
    }
    let places: Vec<DVec2> = placement.in_frame.iter().map(|&p| to_lattice(p)).collect();
    // A band belongs to one thread, which goes through its faces in order: the
    // last of several that cover a sample is the last on any number of threads.
    let bands = sorted(&placement.faces, &places, out.len() / width);
    let rows = out.par_chunks_mut(width * BAND).zip(bands);
    rows.enumerate().for_each(|(band, (rows, here))| {
        for k in here {
            if let Some(patch) = patch(&placement.faces[k as usize], &places, placement) {
                paint(&patch, band * BAND, width, rows, &filler);
            }
        }
    });
}

/// `None` for a face without area.
fn patch(face: &[u32; 3], places: &[DVec2], placement: &Placement) -> Option<ScanPatch> {
    let of = |points: &[DVec2]| face.map(|v| points[v as usize]);
    let corners = of(places);
    let [a, b, c] = corners;
    let det = (b - a).perp_dot(c - a);
    // Below that its inverse overflows.
    if !det.is_normal() {
        return None;
    }
    // Edges want the face on their left: one that is turned over is gone round
    // the other way.
    let [b, c] = if det > 0.0 { [b, c] } else { [c, b] };
    Some(ScanPatch {
        source: AffinePlane::through(corners, of(&placement.in_source), det),
        target: AffinePlane::through(corners, of(&placement.in_target), det),
        edges: [
            PatchEdge::new(a, b),
            PatchEdge::new(b, c),
            PatchEdge::new(c, a),
        ],
        corners,
    })
}

/// For each band of rows the faces that may reach it, in their order; those
/// that are not finite are left out.
fn sorted(faces: &[[u32; 3]], places: &[DVec2], rows: usize) -> Vec<Vec<u32>> {
    let mut bands = vec![Vec::new(); rows.div_ceil(BAND)];
    for (k, face) in faces.iter().enumerate() {
        let corners = face.map(|v| places[v as usize]);
        let [low, high] = extent(corners.map(|p| p.y));
        let is_finite = corners.iter().all(|p| p.is_finite());
        if !is_finite || high + 1.0 < 0.0 || low - 1.0 > rows as f64 {
            continue;
        }
        // A row more than needed on either side: exactly is asked where rows
        // are painted.
        let last = ((high + 1.0) as usize / BAND).min(bands.len() - 1);
        for band in &mut bands[(low - 1.0).max(0.0) as usize / BAND..=last] {
            band.push(k as u32);
        }
    }
    bands
}

/// The least and the greatest.
fn extent([a, b, c]: [f64; 3]) -> [f64; 2] {
    [a.min(b).min(c), a.max(b).max(c)]
}

fn paint<T, F: FnMut(usize, usize, &mut [T])>(
    patch: &ScanPatch,
    first_row: usize,
    width: usize,
    rows: &mut [T],
    filler: &impl Fn(SourceFacet) -> F,
) {
    let [low, high] = extent(patch.corners.map(|p| p.y));
    let last_row = first_row + rows.len() / width;
    let begin = at_or_after(low - REACH).max(first_row);
    let end = after(high + REACH).min(last_row);
    let [left, right] = extent(patch.corners.map(|p| p.x));
    let left = at_or_after(left - REACH);
    if begin >= end || left >= width || right + REACH < 0.0 {
        return;
    }
    let mut fill = filler(SourceFacet {
        first: [left, begin],
        source: patch.source,
        target: patch.target,
    });
    for y in begin..end {
        let [from, to] = span(&patch.edges, y as f64);
        let (x, end) = (at_or_after(from).max(left), after(to).min(width));
        if x < end {
            let row = (y - first_row) * width;
            fill(x, y, &mut rows[row + x..row + end]);
        }
    }
}

/// The first whole number from `x` on that is not negative.
fn at_or_after(x: f64) -> usize {
    // `as` saturates: what is negative, and NaN, begins at 0.
    let below = x as usize;
    below.saturating_add(usize::from((below as f64) < x))
}

/// The first whole number beyond `x` that is not negative.
fn after(x: f64) -> usize {
    if x < 0.0 {
        0
    } else {
        (x as usize).saturating_add(1)
    }
}

/// Where a row lies within the edges: from column to column, nowhere where the
/// first is larger.
fn span(edges: &[PatchEdge; 3], y: f64) -> [f64; 2] {
    let [a, b, c] = edges.map(|edge| edge.left_of(y));
    [a[0].max(b[0]).max(c[0]), a[1].min(b[1]).min(c[1])]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Bounds;
    use crate::warp::{IdentityWarp, Warp};
    use proptest::prelude::*;
    use std::sync::Arc;

    type ScannedSample = Option<(DVec2, DVec2)>;

    fn both(facet: SourceFacet) -> impl FnMut(usize, usize, &mut [ScannedSample]) {
        let SourceFacet { source, target, .. } = facet;
        move |x, y, samples| {
            for (k, sample) in samples.iter_mut().enumerate() {
                *sample = Some((source.at(x + k, y), target.at(x + k, y)));
            }
        }
    }

    #[test]
    fn a_rectangle_that_stands_still_is_itself_everywhere() {
        let frame = Bounds {
            min: DVec2::splat(-0.5),
            max: DVec2::new(69.5, 99.5),
        };
        let still = IdentityWarp::new(frame).placer();
        let mut out = vec![None; 70 * 100];
        scan(still.placement(), |p| p, 70, &mut out, both);
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
            scan(&placement, |p| p, 40, &mut out, both);
            let [a, b, c] = [corners[0], corners[1], corners[2]];
            let det = (b - a).perp_dot(c - a);
            prop_assume!(det.abs() > 1e-3);
            for (k, found) in out.iter().enumerate() {
                let p = DVec2::new((k % 40) as f64, (k / 40) as f64);
                let sides = [(a, b), (b, c), (c, a)]
                    .map(|(u, v)| det.signum() * (v - u).perp_dot(p - u) / u.distance(v));
                let least = sides.into_iter().fold(f64::INFINITY, f64::min);
                if least > 1e-6 {
                    let (found, _) = found.expect("inside");
                    prop_assert!(found.distance(p) < 1e-6);
                } else if least < -1e-3 {
                    prop_assert!(found.is_none());
                }
            }
        }
    }
}
