//! Traces the contours of a function as closed polygons. The function is defined over a *picture*:
//! a rectangle with a regular lattice of samples.
//!
//! Uses marching squares on the lattice of samples (after Lorensen and Cline 1987, in the plane),
//! with two improvements. Crossings are roots of the function itself, not of a line between two
//! samples. A saddle (a square whose diagonal corners are on the same side) is resolved by the
//! function's value at the centre of the square.
//!
//! Guaranteed: polygons are closed, outer ones counter-clockwise and holes clockwise (with y up); a
//! shape that reaches the border of the picture is closed along this border; the result does not
//! depend on the number of threads.
//!
//! Not guaranteed: features thinner than a cell may be missed, and within a cell the contour is a
//! straight line. Polygons may touch in a sample at which the function equals the level;
//! `Regions::from_rings` separates them.

use rayon::prelude::*;

use super::sampled_field::SampledField;
use crate::geometry::DVec2;

/// Length of the bracket at which the search for a crossing stops, as a fraction of the lattice
/// edge (tolerance: near the resolution of `f64` on a lattice of 8192 samples).
const BRACKET: f64 = 1e-11;

/// Residual at which the search for a crossing stops, as a fraction of the function's change along
/// the lattice edge (tolerance: about twice the rounding error of `f64`, so that the search takes
/// one iteration where the function is linear).
const RESIDUAL: f64 = 4e-16;

/// Maximum number of iterations of the search for one crossing. Derived: every third iteration is a
/// bisection, so 3 · ⌈log2(1 / [`BRACKET`])⌉ iterations suffice for any function.
const MAX_STEPS: u32 = 111;

/// Traces the boundary of `{ value ≥ level }` over a picture of `width` × `height` samples.
///
/// Sample (x, y) lies at (x, y), so pixel centres have integer coordinates. The picture extends
/// half a sample spacing beyond the outermost samples, from (−½, −½) to (`width` − ½, `height` −
/// ½). `value` is evaluated in that rectangle, border included, and should be continuous there; NaN
/// counts as outside. The returned points use the same coordinates.
///
/// Polygons are closed (the first point is not repeated) and have at least three points. With y up,
/// the inside is on their left: outer polygons are counter-clockwise, holes clockwise. Points
/// inside a straight horizontal or vertical run are omitted.
///
/// Costs one evaluation per sample and a few per crossing, on the threads of the current rayon
/// pool.
///
/// ```
/// use morphospace::field::contour::trace;
///
/// // A disc of radius 3 in a picture of 9 × 9.
/// let disc = trace(9, 9, |x: f64, y: f64| 3.0 - (x - 4.0).hypot(y - 4.0), 0.0);
/// assert_eq!(disc.len(), 1);
/// assert!(disc[0].iter().all(|p| ((p.x - 4.0).hypot(p.y - 4.0) - 3.0).abs() < 1e-9));
/// ```
pub fn trace<F>(width: u32, height: u32, value: F, level: f64) -> Vec<Vec<DVec2>>
where
    F: Fn(f64, f64) -> f64 + Sync,
{
    trace_with_known(width, height, |_, _| None, value, level)
}

/// Same as [`trace`], except that `known(column, row)` may return whether a sample is inside, in
/// agreement with `value`. If it returns `None`, `value` is evaluated.
pub(crate) fn trace_with_known<F>(
    width: u32,
    height: u32,
    known: impl Fn(usize, usize) -> Option<bool> + Sync,
    value: F,
    level: f64,
) -> Vec<Vec<DVec2>>
where
    F: Fn(f64, f64) -> f64 + Sync,
{
    if width == 0 || height == 0 {
        return Vec::new();
    }
    let squares = MarchingSquares {
        columns: width as usize + 4,
        rows: height as usize + 4,
        known,
        above: |x: f64, y: f64| value(x, y) - level,
    };
    let segments = squares.segments(&squares.inside());
    chains(&segments)
        .into_iter()
        .map(|edges| edges.par_iter().map(|&e| squares.crossing(e)).collect())
        .map(remove_redundant_points)
        .filter(|points| points.len() >= 3)
        .collect()
}

/// Same as [`trace`], for the function that interpolates `samples` bilinearly.
pub fn trace_samples(samples: &SampledField, level: f64) -> Vec<Vec<DVec2>> {
    let (width, height) = (samples.width(), samples.height());
    trace(width, height, |x, y| samples.bilinear(x, y), level)
}

/// Index of a lattice edge: twice the index of its left or lower end node, plus 1 if the edge is
/// vertical.
type LatticeEdge = usize;

/// Segment of a contour in one square of the lattice: the edge where the contour enters the square
/// and the edge where it leaves. The inside is on the left of the segment.
type ContourSegment = (LatticeEdge, LatticeEdge);

/// Function to trace on the lattice of samples. The lattice is extended by two nodes on each side.
/// Both nodes lie on the border of the picture; the outer one always counts as outside, so that
/// every contour closes.
struct MarchingSquares<K, F> {
    columns: usize,
    rows: usize,
    known: K,
    above: F,
}

impl<K, F> MarchingSquares<K, F>
where
    K: Fn(usize, usize) -> Option<bool> + Sync,
    F: Fn(f64, f64) -> f64 + Sync,
{
    /// Position of a node in sample coordinates.
    fn position(&self, column: usize, row: usize) -> DVec2 {
        // The last sample lies at count − 5, and the border half a sample beyond it.
        let along = |i: usize, count: usize| (i as f64 - 2.0).clamp(-0.5, count as f64 - 4.5);
        DVec2::new(along(column, self.columns), along(row, self.rows))
    }

    /// Returns for each node whether it is inside, row by row.
    fn inside(&self) -> Vec<bool> {
        let mut inside = vec![false; self.columns * self.rows];
        let rows = inside.par_chunks_mut(self.columns).enumerate();
        // The outermost nodes are not evaluated; they stay outside.
        let inner = rows.skip(1).take(self.rows - 2);
        inner.for_each(|(row, out)| {
            for (column, out) in out.iter_mut().enumerate().take(self.columns - 1).skip(1) {
                *out = self.is_inside(column, row);
            }
        });
        inside
    }

    fn is_inside(&self, column: usize, row: usize) -> bool {
        let is_sample =
            (2..self.columns - 2).contains(&column) && (2..self.rows - 2).contains(&row);
        let known = is_sample.then(|| (self.known)(column - 2, row - 2));
        known.flatten().unwrap_or_else(|| {
            let p = self.position(column, row);
            (self.above)(p.x, p.y) >= 0.0
        })
    }

    /// All contour segments, sorted by the edge at which they enter their square.
    fn segments(&self, inside: &[bool]) -> Vec<ContourSegment> {
        let mut segments: Vec<ContourSegment> = (0..self.rows - 1)
            .into_par_iter()
            .flat_map_iter(|row| self.row_segments(row, inside))
            .collect();
        segments.par_sort_unstable();
        segments
    }

    /// Contour segments in the row of squares between node rows `row` and `row + 1`.
    fn row_segments(&self, row: usize, inside: &[bool]) -> Vec<ContourSegment> {
        let lower = &inside[row * self.columns..][..self.columns];
        let upper = &inside[(row + 1) * self.columns..][..self.columns];
        let mut out = Vec::new();
        for column in 0..self.columns - 1 {
            let (l, u) = (&lower[column..column + 2], &upper[column..column + 2]);
            let corners = [l[0], l[1], u[1], u[0]];
            // Fast path: nearly all squares are entirely inside or outside.
            if corners != [corners[0]; 4] {
                self.push_square_segments(column, row, corners, &mut out);
            }
        }
        out
    }

    /// Appends the one or two contour segments of the square whose lower left node is (`column`,
    /// `row`). `corners` says for each corner whether it is inside. Corners and edges are numbered
    /// counter-clockwise, corners from the lower left one and edges from the bottom one.
    fn push_square_segments(
        &self,
        column: usize,
        row: usize,
        corners: [bool; 4],
        out: &mut Vec<ContourSegment>,
    ) {
        let node = row * self.columns + column;
        let edges = [
            2 * node,
            2 * (node + 1) + 1,
            2 * (node + self.columns),
            2 * node + 1,
        ];
        let leaves = |k: usize| corners[k % 4] && !corners[(k + 1) % 4];
        let enters = |k: usize| !corners[k % 4] && corners[(k + 1) % 4];
        let is_saddle = leaves(0) == leaves(2) && leaves(1) == leaves(3);
        // In a saddle, each segment cuts off one corner: an outside corner if the centre is inside,
        // otherwise an inside corner. The search for the segment's end goes counter-clockwise
        // around an outside corner and clockwise around an inside one.
        let counter_clockwise = !is_saddle || self.centre_is_inside(column, row);
        for from in (0..4).filter(|&k| leaves(k)) {
            let turn = |step: usize| from + if counter_clockwise { step } else { 4 - step };
            if let Some(to) = (1..4).map(turn).find(|&k| enters(k)) {
                out.push((edges[from], edges[to % 4]));
            }
        }
    }

    fn centre_is_inside(&self, column: usize, row: usize) -> bool {
        let p = 0.5 * (self.position(column, row) + self.position(column + 1, row + 1));
        (self.above)(p.x, p.y) >= 0.0
    }

    /// Point where the contour crosses a lattice edge.
    fn crossing(&self, edge: LatticeEdge) -> DVec2 {
        let (column, row) = (edge / 2 % self.columns, edge / 2 / self.columns);
        let upright = edge % 2;
        let a = self.position(column, row);
        let b = self.position(column + 1 - upright, row + upright);
        // Edges between the border and the outermost nodes have no length.
        if a == b {
            return a;
        }
        let at = |s: f64| a + (b - a) * s;
        at(root(|s| {
            let p = at(s);
            (self.above)(p.x, p.y)
        }))
    }
}

/// Finds the root in [0, 1] of a continuous function that is non-negative at exactly one end. Uses
/// the Illinois method; every third iteration is a bisection, for functions that stall that method.
fn root(f: impl Fn(f64) -> f64) -> f64 {
    let (mut lo, mut hi) = ((0.0, f(0.0)), (1.0, f(1.0)));
    // The residual is relative to the change of the function, so that its scale does not matter.
    let max_residual = RESIDUAL * (lo.1 - hi.1).abs();
    let is_rising = hi.1 >= 0.0;
    let mut last_was_low = None;
    for step in 0..MAX_STEPS {
        if hi.0 - lo.0 <= BRACKET {
            break;
        }
        let s = next_estimate(lo, hi, step % 3 == 2);
        let value = f(s);
        if value.abs() <= max_residual {
            return s;
        }
        let is_low = (value >= 0.0) != is_rising;
        let (replaced_end, other_end) = if is_low {
            (&mut lo, &mut hi)
        } else {
            (&mut hi, &mut lo)
        };
        *replaced_end = (s, value);
        // Illinois step: if the same end has been replaced twice in a row, the value at the other
        // end is halved. Without this, the chord would approach the root from one side only.
        if last_was_low == Some(is_low) {
            other_end.1 *= 0.5;
        }
        last_was_low = Some(is_low);
    }
    next_estimate(lo, hi, false)
}

/// Returns the zero of the chord between the ends of a bracket, given as (position, value); the
/// midpoint of the bracket if `bisect` is set or the zero is not in the bracket.
fn next_estimate(lo: (f64, f64), hi: (f64, f64), bisect: bool) -> f64 {
    let s = lo.0 + (hi.0 - lo.0) * (lo.1 / (lo.1 - hi.1));
    if bisect || !(lo.0..=hi.0).contains(&s) {
        0.5 * (lo.0 + hi.0)
    } else {
        s
    }
}

/// Links contour segments, sorted by their first edge, into closed chains of edges. At every edge
/// where a segment ends, another one starts, so each chain returns to its start.
fn chains(segments: &[ContourSegment]) -> Vec<Vec<LatticeEdge>> {
    let mut used = vec![false; segments.len()];
    let mut chains = Vec::new();
    for first in 0..segments.len() {
        let mut chain = Vec::new();
        let mut next = Ok(first);
        while let Ok(i) = next
            && !std::mem::replace(&mut used[i], true)
        {
            chain.push(segments[i].0);
            // Exactly one segment starts at each edge where a segment ends: the contour leaves one
            // square and enters the next.
            next = segments.binary_search_by_key(&segments[i].1, |s| s.0);
        }
        if !chain.is_empty() {
            chains.push(chain);
        }
    }
    chains
}

/// Removes repeated points and points inside straight horizontal or vertical runs. Such runs occur
/// where a contour follows the border of the picture.
fn remove_redundant_points(mut points: Vec<DVec2>) -> Vec<DVec2> {
    points.dedup();
    if points.len() > 1 && points.first() == points.last() {
        points.pop();
    }
    let count = points.len();
    let at = |i: usize| points[i % count];
    (0..count)
        .filter(|&i| !is_straight(at(i + count - 1), at(i), at(i + 1)))
        .map(at)
        .collect()
}

/// Returns whether `p` lies inside a straight horizontal or vertical run.
fn is_straight(before: DVec2, p: DVec2, after: DVec2) -> bool {
    let along_axis = (before.x == p.x && p.x == after.x) || (before.y == p.y && p.y == after.y);
    // The tip of a spike, where the run turns back, is kept.
    along_axis && (p - before).dot(after - p) > 0.0
}

#[cfg(test)]
mod tests;
