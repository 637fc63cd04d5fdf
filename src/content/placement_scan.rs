//! Rasterises a placement: for each sample of a lattice in the frame, computes the corresponding
//! points of source and target.
//!
//! Guaranteed: where several faces cover a sample, the last one counts; a sample on an edge belongs
//! to an adjacent face, so no gap opens between neighbours; the result does not depend on the
//! number of threads. Samples that no face covers are left unchanged.

use crate::geometry::DVec2;
use crate::warp::Placement;
use rayon::prelude::*;

/// Number of rows in a band, which one thread fills at a time (resource limit: with fewer rows,
/// each face would be prepared for more bands; with more rows, some threads would have no work).
const BAND: usize = 32;

/// Distance, in samples, by which a face is extended beyond its edges, so that rounding opens no
/// gaps (tolerance: far above the 1e-12 to which doubles are exact at 8192 samples, and invisible).
const REACH: f64 = 1e-7;

/// Affine maps from lattice coordinates to points of source and target, valid within one face.
#[derive(Clone, Copy, Debug)]
pub(super) struct SourceFacet {
    /// Leftmost column and uppermost row of the face's samples within the band that is being
    /// filled.
    pub first_sample: [usize; 2],
    /// Affine map from lattice coordinates to points of the source.
    pub source: AffinePlane,
    /// Affine map from lattice coordinates to points of the target.
    pub target: AffinePlane,
}

/// Affine map from lattice coordinates to the plane.
#[derive(Clone, Copy, Debug)]
pub(super) struct AffinePlane {
    /// Point to which sample (0, 0) is mapped.
    pub origin: DVec2,
    /// Difference between the points of two neighbouring samples: the one in the next column minus
    /// the one in this column.
    pub by_x: DVec2,
    /// Difference between the points of two neighbouring samples: the one in the next row minus the
    /// one in this row.
    pub by_y: DVec2,
}

impl AffinePlane {
    /// Returns the point to which the sample in column `x` and row `y` is mapped.
    #[inline]
    pub fn at(&self, x: usize, y: usize) -> DVec2 {
        self.origin + self.by_x * x as f64 + self.by_y * y as f64
    }

    /// Returns the affine map that sends `corners` to `values`. `det` is twice the signed area of
    /// the triangle of the corners.
    fn through(corners: [DVec2; 3], values: [DVec2; 3], det: f64) -> Self {
        let [a, b, c] = corners;
        // Cramer's rule: expresses a step to the next column and a step to the next row by the two
        // edges that leave the first corner.
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

/// Face in lattice coordinates, ready to be rasterised.
#[derive(Clone, Copy, Debug)]
struct ScanPatch {
    corners: [DVec2; 3],
    edges: [PatchEdge; 3],
    source: AffinePlane,
    target: AffinePlane,
}

/// Directed edge of a face. The face lies to its left.
#[derive(Clone, Copy, Debug)]
struct PatchEdge {
    begin: DVec2,
    along: DVec2,
    /// The extension [`REACH`], multiplied by the length of the edge.
    reach: f64,
    /// 1 / `along.y`, where `along` is the vector along the edge; `None` for a horizontal edge.
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

    /// Returns the interval of the columns of row `y` that lie to the left of the edge. If there
    /// are none, the start of the interval exceeds its end.
    fn columns_left_of(&self, y: f64) -> [f64; 2] {
        // A sample (x, y) is to the left of the edge if along.x (y - begin.y) - along.y (x -
        // begin.x) >= 0.
        let slack = self.along.x * (y - self.begin.y) + self.reach;
        match self.per_rise {
            Some(per) if per > 0.0 => [f64::NEG_INFINITY, self.begin.x + slack * per],
            Some(per) => [self.begin.x + slack * per, f64::INFINITY],
            // A horizontal edge has the whole row on one side.
            None if slack < 0.0 => [f64::INFINITY, f64::NEG_INFINITY],
            None => [f64::NEG_INFINITY, f64::INFINITY],
        }
    }
}

/// Fills `out` with the samples of all faces, in the order of the faces.
///
/// `to_lattice` maps the plane to lattice coordinates. The sample in column x and row y is stored
/// at `out[y * width + x]`. `filler` is called once for each face and each band of rows; it returns
/// a closure that fills samples. The closure is called for each row with the first column, the row,
/// and the slice of `out` to fill from there on.
///
/// # Panics
/// Panics if a face has a vertex without a position.
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
    // Each band is filled by a single thread, which takes the faces in order. The last face that
    // covers a sample is therefore the same for any number of threads.
    let bands = faces_by_band(&placement.faces, &places, out.len() / width);
    let rows = out.par_chunks_mut(width * BAND).zip(bands);
    rows.enumerate().for_each(|(band, (rows, here))| {
        for k in here {
            if let Some(patch) = scan_patch(&placement.faces[k as usize], &places, placement) {
                fill_face(&patch, band * BAND, width, rows, &filler);
            }
        }
    });
}

/// Prepares a face for rasterisation; `None` if its area is zero, subnormal or not finite.
fn scan_patch(face: &[u32; 3], places: &[DVec2], placement: &Placement) -> Option<ScanPatch> {
    let at_corners = |points: &[DVec2]| face.map(|v| points[v as usize]);
    let corners = at_corners(places);
    let [a, b, c] = corners;
    let det = (b - a).perp_dot(c - a);
    // `is_normal` rejects zero, infinity and NaN. It also rejects subnormal numbers, whose inverse
    // may overflow.
    if !det.is_normal() {
        return None;
    }
    // Edges need the face on their left, so a clockwise face is traversed in reverse.
    let [b, c] = if det > 0.0 { [b, c] } else { [c, b] };
    Some(ScanPatch {
        source: AffinePlane::through(corners, at_corners(&placement.in_source), det),
        target: AffinePlane::through(corners, at_corners(&placement.in_target), det),
        edges: [
            PatchEdge::new(a, b),
            PatchEdge::new(b, c),
            PatchEdge::new(c, a),
        ],
        corners,
    })
}

/// For each band of rows, returns the indices of the faces that may reach it, in ascending order.
/// Faces with a vertex that is not finite are skipped.
fn faces_by_band(faces: &[[u32; 3]], places: &[DVec2], rows: usize) -> Vec<Vec<u32>> {
    let mut bands = vec![Vec::new(); rows.div_ceil(BAND)];
    for (k, face) in faces.iter().enumerate() {
        let corners = face.map(|v| places[v as usize]);
        let [low, high] = extent(corners.map(|p| p.y));
        let is_finite = corners.iter().all(|p| p.is_finite());
        if !is_finite || high + 1.0 < 0.0 || low - 1.0 > rows as f64 {
            continue;
        }
        // The bands cover one row more than the face on either side. The exact test follows when
        // rows are filled.
        let last = ((high + 1.0) as usize / BAND).min(bands.len() - 1);
        for band in &mut bands[(low - 1.0).max(0.0) as usize / BAND..=last] {
            band.push(k as u32);
        }
    }
    bands
}

/// Returns the minimum and the maximum of three numbers.
fn extent([a, b, c]: [f64; 3]) -> [f64; 2] {
    [a.min(b).min(c), a.max(b).max(c)]
}

/// Fills the samples of one face in one band of rows, which starts at row `first_row`.
fn fill_face<T, F: FnMut(usize, usize, &mut [T])>(
    patch: &ScanPatch,
    first_row: usize,
    width: usize,
    rows: &mut [T],
    filler: &impl Fn(SourceFacet) -> F,
) {
    let [low, high] = extent(patch.corners.map(|p| p.y));
    let last_row = first_row + rows.len() / width;
    let begin = ceil_non_negative(low - REACH).max(first_row);
    let end = next_above(high + REACH).min(last_row);
    let [left, right] = extent(patch.corners.map(|p| p.x));
    let left = ceil_non_negative(left - REACH);
    if begin >= end || left >= width || right + REACH < 0.0 {
        return;
    }
    let mut fill = filler(SourceFacet {
        first_sample: [left, begin],
        source: patch.source,
        target: patch.target,
    });
    for y in begin..end {
        let [from, to] = covered_columns(&patch.edges, y as f64);
        let (x, end) = (ceil_non_negative(from).max(left), next_above(to).min(width));
        if x < end {
            let row = (y - first_row) * width;
            fill(x, y, &mut rows[row + x..row + end]);
        }
    }
}

/// Returns the smallest non-negative integer that is at least `x`.
fn ceil_non_negative(x: f64) -> usize {
    // The cast saturates, so negative numbers and NaN become 0.
    let below = x as usize;
    below.saturating_add(usize::from((below as f64) < x))
}

/// Returns the smallest non-negative integer greater than `x`.
fn next_above(x: f64) -> usize {
    if x < 0.0 {
        0
    } else {
        (x as usize).saturating_add(1)
    }
}

/// Returns the interval of the columns of row `y` that lie inside all three edges. If there are
/// none, the start of the interval exceeds its end.
fn covered_columns(edges: &[PatchEdge; 3], y: f64) -> [f64; 2] {
    let [a, b, c] = edges.map(|edge| edge.columns_left_of(y));
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
    fn an_identity_placement_maps_each_sample_to_itself() {
        let frame = Bounds {
            min: DVec2::splat(-0.5),
            max: DVec2::new(69.5, 99.5),
        };
        let still = IdentityWarp::new(frame).placer();
        let mut out = vec![None; 70 * 100];
        scan(still.placement(), |p| p, 70, &mut out, both);
        for (k, sample) in out.iter().enumerate() {
            let here = DVec2::new((k % 70) as f64, (k / 70) as f64);
            let (source, target) = sample.expect("covered");
            assert!(source.distance(here) < 1e-12 && target.distance(here) < 1e-12);
        }
    }

    proptest! {
        /// For random triangles, exactly the samples inside are filled.
        #[test]
        fn exactly_the_samples_inside_are_covered(points in prop::collection::vec((-5.0f64..45.0, -5.0f64..45.0), 3)) {
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
            for (k, sample) in out.iter().enumerate() {
                let p = DVec2::new((k % 40) as f64, (k / 40) as f64);
                let sides = [(a, b), (b, c), (c, a)]
                    .map(|(u, v)| det.signum() * (v - u).perp_dot(p - u) / u.distance(v));
                let min_side = sides.into_iter().fold(f64::INFINITY, f64::min);
                if min_side > 1e-6 {
                    let (source, _) = sample.expect("inside");
                    prop_assert!(source.distance(p) < 1e-6);
                } else if min_side < -1e-3 {
                    prop_assert!(sample.is_none());
                }
            }
        }
    }
}
