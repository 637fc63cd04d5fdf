//! Contours of a function over a picture, as closed polygons.
//!
//! Marching squares on the lattice of samples (after Lorensen and Cline 1987,
//! in the plane). Two things are done better than by the textbook: crossings
//! are roots of the function itself and not of a straight line between two
//! samples, and a saddle is resolved by the function's value at its centre.
//!
//! Guarantees: polygons are closed, outer ones counter-clockwise and holes
//! clockwise (seen with y up); what reaches the border of the picture is
//! closed along it; the result is the same on any number of threads.
//!
//! Does not guarantee: features thinner than a cell may be missed, and inside
//! a cell the contour is a straight line. Polygons may touch in a point where
//! the function equals the level at a sample; `Regions::from_rings` cleans
//! that.

use rayon::prelude::*;

use super::sampled_field::SampledField;
use crate::geometry::DVec2;

/// How far apart, in cells, the two ends of a crossing's bracket may be at the
/// end: on a lattice of 8192 samples this is near the resolution of `f64`.
const BRACKET: f64 = 1e-11;

/// A crossing ends where the function has come this near to the level, as a
/// fraction of its change along the edge: linear edges end after one step.
const RESIDUAL: f64 = 4e-16;

/// Steps for one crossing. Every third is a bisection, so that `3 · log2(1 /
/// BRACKET)` suffice for the worst function.
const STEPS: u32 = 111;

/// Traces the boundary of `{ value ≥ level }` over a picture of `width` ×
/// `height` samples.
///
/// Sample (x, y) is at (x, y), so that pixel centres are integers; the picture
/// reaches half a sample beyond the outermost ones, from (−½, −½) to
/// (`width` − ½, `height` − ½). `value` is asked for positions in that
/// rectangle, border included, and should be continuous there; where it is NaN
/// is outside. Points come in the same units.
///
/// Polygons are closed (the first point is not repeated) and have at least
/// three points. The inside is on their left where y is up: outer polygons are
/// counter-clockwise, holes clockwise. Points in the middle of a straight run
/// along an axis are left out. Costs one evaluation a sample and a few a
/// crossing, over the threads of the caller's rayon pool.
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
    trace_knowing(width, height, |_, _| None, value, level)
}

/// [`trace`] of a function of which is `known` for many samples, by column and row,
/// whether they are inside: `value` is not asked there.
pub(crate) fn trace_knowing<F>(
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
        .map(cleaned)
        .filter(|points| points.len() >= 3)
        .collect()
}

/// [`trace`] for a picture whose value between samples is bilinear.
pub fn trace_samples(samples: &SampledField, level: f64) -> Vec<Vec<DVec2>> {
    let (width, height) = (samples.width(), samples.height());
    trace(width, height, |x, y| samples.bilinear(x, y), level)
}

/// A lattice edge: twice the index of its lower left node, plus 1 where it
/// points up.
type LatticeEdge = usize;

/// The part of a contour in one square: it enters by the first edge and leaves
/// by the second, the inside on its left.
type ContourSegment = (LatticeEdge, LatticeEdge);

/// The lattice, widened by two nodes on each side: the picture's border, and a
/// ring in the same place that is always outside and closes every contour.
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
    fn position(&self, column: usize, row: usize) -> DVec2 {
        // The last sample is at count − 5, the picture's border half a sample
        // beyond.
        let along = |i: usize, count: usize| (i as f64 - 2.0).clamp(-0.5, count as f64 - 4.5);
        DVec2::new(along(column, self.columns), along(row, self.rows))
    }

    fn inside(&self) -> Vec<bool> {
        let mut inside = vec![false; self.columns * self.rows];
        let rows = inside.par_chunks_mut(self.columns).enumerate();
        // The outermost nodes are not asked: they stay outside.
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

    /// All segments, sorted by the edge that they start from.
    fn segments(&self, inside: &[bool]) -> Vec<ContourSegment> {
        let mut segments: Vec<ContourSegment> = (0..self.rows - 1)
            .into_par_iter()
            .flat_map_iter(|row| self.row_segments(row, inside))
            .collect();
        segments.par_sort_unstable();
        segments
    }

    fn row_segments(&self, row: usize, inside: &[bool]) -> Vec<ContourSegment> {
        let lower = &inside[row * self.columns..][..self.columns];
        let upper = &inside[(row + 1) * self.columns..][..self.columns];
        let mut out = Vec::new();
        for column in 0..self.columns - 1 {
            let (l, u) = (&lower[column..column + 2], &upper[column..column + 2]);
            let corners = [l[0], l[1], u[1], u[0]];
            // Nearly all squares have nothing in them.
            if corners != [corners[0]; 4] {
                self.square(column, row, corners, &mut out);
            }
        }
        out
    }

    /// The one or two segments of a square; corners and edges
    /// counter-clockwise from the lower left.
    fn square(&self, column: usize, row: usize, corners: [bool; 4], out: &mut Vec<ContourSegment>) {
        let node = row * self.columns + column;
        let edges = [
            2 * node,
            2 * (node + 1) + 1,
            2 * (node + self.columns),
            2 * node + 1,
        ];
        let leaves = |k: usize| corners[k % 4] && !corners[(k + 1) % 4];
        let enters = |k: usize| !corners[k % 4] && corners[(k + 1) % 4];
        let saddle = leaves(0) == leaves(2) && leaves(1) == leaves(3);
        // Round the corner that the segment cuts off: an outer one lies ahead,
        // an inner one behind.
        let ahead = !saddle || self.centre_is_inside(column, row);
        for from in (0..4).filter(|&k| leaves(k)) {
            let turn = |step: usize| from + if ahead { step } else { 4 - step };
            if let Some(to) = (1..4).map(turn).find(|&k| enters(k)) {
                out.push((edges[from], edges[to % 4]));
            }
        }
    }

    fn centre_is_inside(&self, column: usize, row: usize) -> bool {
        let p = 0.5 * (self.position(column, row) + self.position(column + 1, row + 1));
        (self.above)(p.x, p.y) >= 0.0
    }

    /// Where the contour crosses an edge.
    fn crossing(&self, edge: LatticeEdge) -> DVec2 {
        let (column, row) = (edge / 2 % self.columns, edge / 2 / self.columns);
        let upright = edge % 2;
        let a = self.position(column, row);
        let b = self.position(column + 1 - upright, row + upright);
        // The outer ring is in the place of the border: what it crosses is
        // there.
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

/// The root in [0, 1] of a continuous function that is ≥ 0 at one end only:
/// the Illinois method, with bisections for the functions that stall it.
fn root(f: impl Fn(f64) -> f64) -> f64 {
    let (mut lo, mut hi) = ((0.0, f(0.0)), (1.0, f(1.0)));
    // From the change along the edge, so that functions of any size end alike.
    let near = RESIDUAL * (lo.1 - hi.1).abs();
    let rising = hi.1 >= 0.0;
    let mut last_was_low = None;
    for step in 0..STEPS {
        if hi.0 - lo.0 <= BRACKET {
            break;
        }
        let s = between(lo, hi, step % 3 == 2);
        let value = f(s);
        if value.abs() <= near {
            return s;
        }
        let low = (value >= 0.0) != rising;
        let (moved, kept) = if low {
            (&mut lo, &mut hi)
        } else {
            (&mut hi, &mut lo)
        };
        *moved = (s, value);
        // The Illinois step: an end that stays twice loses half its weight, or
        // the chord would creep up on the root from one side.
        if last_was_low == Some(low) {
            kept.1 *= 0.5;
        }
        last_was_low = Some(low);
    }
    between(lo, hi, false)
}

/// Where the chord of a bracket is zero, or its middle.
fn between(lo: (f64, f64), hi: (f64, f64), middle: bool) -> f64 {
    let s = lo.0 + (hi.0 - lo.0) * (lo.1 / (lo.1 - hi.1));
    if middle || !(lo.0..=hi.0).contains(&s) {
        0.5 * (lo.0 + hi.0)
    } else {
        s
    }
}

/// Links segments, sorted by start, into closed chains of edges. Every edge
/// that ends a segment starts another, so that following them comes back.
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
            // One segment starts from each edge that ends one: what leaves a
            // square enters the next.
            next = segments.binary_search_by_key(&segments[i].1, |s| s.0);
        }
        if !chain.is_empty() {
            chains.push(chain);
        }
    }
    chains
}

/// Without repeated points and without points inside a straight run along an
/// axis, which the picture's border is full of.
fn cleaned(mut points: Vec<DVec2>) -> Vec<DVec2> {
    points.dedup();
    if points.len() > 1 && points.first() == points.last() {
        points.pop();
    }
    let count = points.len();
    let at = |i: usize| points[i % count];
    (0..count)
        .filter(|&i| !straight(at(i + count - 1), at(i), at(i + 1)))
        .map(at)
        .collect()
}

fn straight(before: DVec2, p: DVec2, after: DVec2) -> bool {
    let along_axis = (before.x == p.x && p.x == after.x) || (before.y == p.y && p.y == after.y);
    // A spike turns back along the axis, and its point is kept.
    along_axis && (p - before).dot(after - p) > 0.0
}

#[cfg(test)]
mod tests;
