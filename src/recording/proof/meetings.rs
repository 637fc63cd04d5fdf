//! Finds the earliest time in an interval at which outlines may meet.
//!
//! If outlines are apart at first, their first contact is that of a vertex with an edge. The search
//! takes two steps. Boxes around the moving edges find the vertex–edge pairs that come near each
//! other; if there are too many, the interval is halved. A pair is then proved to be apart by the
//! sign of a polynomial: the vertex stays on one side of the edge's line, or beyond one end of the
//! edge. Loops that cross from the beginning are found directly.

use super::bernstein::{BernsteinProducts, EndSign};
use super::bisection::{Bisection, EarliestFailure, MAX_HALVINGS};
use super::drawn_loop::DrawnLoop;
use super::folds::{product, twice_area};
use super::vertex_curve::{IntervalCurves, VertexCurve, subtract_common_motion};
use crate::geometry::{DVec2, EdgeCrossing, crossings, orient2d};
use crate::work::progress::{Cancelled, Progress, check_cancelled};
use rayon::prelude::*;
use std::collections::BTreeMap;

/// Maximum number of nearby vertex–edge pairs for each edge; an interval with more is halved
/// (resource limit).
const MAX_PAIRS_PER_EDGE: usize = 12;
/// Maximum number of times that an interval is halved to reduce the number of nearby vertex–edge
/// pairs (resource limit: 2¹⁰ parts).
const MAX_INTERVAL_HALVINGS: u32 = 10;

/// Vertex–edge pairs that touch at t = 0 are not tested for t below this length, and pairs that
/// touch at t = 1 are not tested for t above 1 minus this length (tolerance: the two sides of a cut
/// need some time to come apart).
const UNTESTED_LENGTH: f64 = 1.0 / 1024.0;

/// Returns the values of s at which the sections of an interval end. An interval that begins at t =
/// 0 starts with a short section, and one that ends at t = 1 ends with a short section; the rest is
/// one section. `length` is the length of the interval in t.
fn piece_ends(at_ends: [bool; 2], length: f64) -> Vec<f64> {
    let near = (UNTESTED_LENGTH / length).min(0.25);
    let begin = at_ends[0].then_some(near);
    let end = at_ends[1].then_some(1.0 - near);
    begin.into_iter().chain(end).chain([1.0]).collect()
}

/// Meeting of a vertex and an edge: its time as the fraction s of the interval, the vertex, the
/// edge, and the position of the meeting in the plane.
type VertexEdgeMeeting = (f64, u32, [u32; 2], DVec2);

/// Result of the search for meetings in one interval.
#[derive(Default)]
pub(super) struct IntervalMeetings {
    /// The earliest meeting; `None` if all outlines are proved to be apart.
    pub first: Option<VertexEdgeMeeting>,
    /// Number of vertex–edge pairs that touch at t = 0 or t = 1 and were not tested at times close
    /// to that t.
    pub touching: usize,
}

/// Edge of a boundary loop; its ends are indices into [`MeetingSearch::vertices`].
#[derive(Clone, Copy)]
struct LoopEdge {
    ends: [usize; 2],
    layer: usize,
}

/// Vertex and the two ends of an edge that it must not meet, as indices into
/// [`MeetingSearch::vertices`].
type VertexEdgePair = (usize, [usize; 2]);

/// Returns the earliest meeting of the given loops in an interval. `at_ends` marks the ends of the
/// interval that are t = 0 or t = 1, where the positions are those of the designs.
pub(super) fn first_meeting(
    curves: &IntervalCurves,
    loops: &[&DrawnLoop],
    at_ends: [bool; 2],
    progress: &dyn Progress,
) -> Result<IntervalMeetings, Cancelled> {
    let search = MeetingSearch::of(loops, curves.degree(), progress);
    let vertices = &search.vertices;
    let mut remaining: Vec<VertexCurve> = vertices
        .par_iter()
        .map(|&v| curves.curve(v as usize))
        .collect();
    let common_motion = subtract_common_motion(&mut remaining);
    let mut found = IntervalMeetings::default();
    let mut from = 0.0;
    for to in piece_ends(at_ends, curves.length()) {
        let piece = match to < 1.0 {
            true => {
                let split = |curve: &VertexCurve| curve.cut((to - from) / (1.0 - from)).into();
                let (piece, after): (Vec<VertexCurve>, Vec<VertexCurve>) =
                    remaining.par_iter().map(split).unzip();
                remaining = after;
                piece
            }
            false => std::mem::take(&mut remaining),
        };
        let ends = [at_ends[0] && from == 0.0, at_ends[1] && to == 1.0];
        // Crossings of loops at the beginning of a section of the interval are tested directly,
        // except at t = 0, where the two sides of a cut lie on each other.
        let crossed = (!ends[0]).then(|| search.first_crossing(&piece, loops, from));
        let next = match crossed.flatten() {
            Some(first) => IntervalMeetings {
                first: Some(first),
                touching: 0,
            },
            None => search.first_in_part(&piece, ends, [from, to], MAX_INTERVAL_HALVINGS)?,
        };
        found.touching += next.touching;
        found.first = next.first;
        if found.first.is_some() {
            break;
        }
        from = to;
    }
    if let Some((s, vertex, edge, place)) = &mut found.first {
        let [_, after] = common_motion.cut(*s);
        *place += after.control_points[0];
        *vertex = vertices[*vertex as usize];
        *edge = edge.map(|v| vertices[v as usize]);
    }
    Ok(found)
}

/// Search for meetings in one interval, with the edges and vertices of the loops.
struct MeetingSearch<'a> {
    products: BernsteinProducts,
    edges: Vec<LoopEdge>,
    /// Indices of the vertices of all loops in the recording, each once.
    vertices: Vec<u32>,
    /// For each vertex of the recording that is in a loop, its index in `vertices`.
    numbers: BTreeMap<u32, usize>,
    progress: &'a dyn Progress,
}

impl<'a> MeetingSearch<'a> {
    /// Collects the edges and vertices of the loops. `degree` is the polynomial degree of the
    /// vertex curves.
    fn of(loops: &[&DrawnLoop], degree: usize, progress: &'a dyn Progress) -> Self {
        let mut numbers = BTreeMap::new();
        for boundary_loop in loops {
            for &v in &boundary_loop.vertices {
                let next = numbers.len();
                numbers.entry(v).or_insert(next);
            }
        }
        let mut vertices = vec![0; numbers.len()];
        numbers.iter().for_each(|(&v, &k)| vertices[k] = v);
        let edges = loops.iter().flat_map(|boundary_loop| {
            let next = boundary_loop.vertices.iter().cycle().skip(1);
            let ends = boundary_loop.vertices.iter().zip(next);
            ends.map(|(a, b)| LoopEdge {
                ends: [numbers[a], numbers[b]],
                layer: boundary_loop.layer,
            })
        });
        Self {
            products: BernsteinProducts::of_degree(degree),
            edges: edges.collect(),
            vertices,
            numbers,
            progress,
        }
    }

    /// Returns a crossing of two loops of the same layer at the beginning of `curves`; `None` if no
    /// loops cross. `s` is the fraction of the interval at which `curves` begin; the result
    /// contains it as the time of the crossing.
    fn first_crossing(
        &self,
        curves: &[VertexCurve],
        loops: &[&DrawnLoop],
        s: f64,
    ) -> Option<VertexEdgeMeeting> {
        let index_at = |boundary_loop: &DrawnLoop, k: usize| {
            self.numbers[&boundary_loop.vertices[k % boundary_loop.vertices.len()]]
        };
        let ring = |boundary_loop: &&DrawnLoop| -> Vec<DVec2> {
            let indices = (0..boundary_loop.vertices.len()).map(|k| index_at(boundary_loop, k));
            indices.map(|v| curves[v].control_points[0]).collect()
        };
        let rings: Vec<Vec<DVec2>> = loops.iter().map(ring).collect();
        let all = crossings(&rings);
        let is_same_layer = |crossing: &&EdgeCrossing| {
            let [a, b] = crossing.edges.map(|edge| loops[edge.ring].layer);
            a == b
        };
        let crossing = all.iter().find(is_same_layer)?;
        let [one, other] = crossing.edges;
        let edge = [other.point, other.point + 1].map(|k| index_at(loops[other.ring], k) as u32);
        let vertex = index_at(loops[one.ring], one.point) as u32;
        Some((s, vertex, edge, crossing.place))
    }

    /// Returns the earliest meeting in a part of the interval, from the fraction `from` to the
    /// fraction `to`. `curves` are the curves of the vertices during this part. This part may be
    /// halved up to `halvings` times.
    ///
    /// # Errors
    /// [`Cancelled`] if the work is cancelled.
    fn first_in_part(
        &self,
        curves: &[VertexCurve],
        at_ends: [bool; 2],
        [from, to]: [f64; 2],
        halvings: u32,
    ) -> Result<IntervalMeetings, Cancelled> {
        check_cancelled(self.progress)?;
        let max_pairs = MAX_PAIRS_PER_EDGE * self.edges.len() + 1000;
        let max_pairs = if halvings > 0 { max_pairs } else { usize::MAX };
        let Some(pairs) = self.near_pairs(curves, max_pairs) else {
            let middle = from.midpoint(to);
            let (left, right): (Vec<VertexCurve>, Vec<VertexCurve>) =
                curves.par_iter().map(|curve| curve.halves().into()).unzip();
            let mut found =
                self.first_in_part(&left, [at_ends[0], false], [from, middle], halvings - 1)?;
            if found.first.is_none() {
                let right =
                    self.first_in_part(&right, [false, at_ends[1]], [middle, to], halvings - 1)?;
                found.first = right.first;
                found.touching += right.touching;
            }
            return Ok(found);
        };
        let earliest = EarliestFailure::default();
        let touches = |pair: &VertexEdgePair| self.touches(curves, at_ends, pair);
        let (touching, apart): (Vec<VertexEdgePair>, Vec<VertexEdgePair>) =
            pairs.into_par_iter().partition(touches);
        let meets = |&(v, [a, b]): &VertexEdgePair| {
            let triple = [&curves[a], &curves[b], &curves[v]].map(Clone::clone);
            if self.progress.is_cancelled() {
                return None;
            }
            let search = Bisection::new(&earliest);
            let s = self.first_contact(triple, at_ends, [from, to], MAX_HALVINGS, &search)?;
            let edge = [a as u32, b as u32];
            // The position of the vertex at the beginning of this part of the interval is accurate
            // enough for display.
            Some((s, v as u32, edge, curves[v].control_points[0]))
        };
        let found = apart.par_iter().filter_map(meets);
        let key = |m: &VertexEdgeMeeting| (m.1, m.2);
        let first = found.min_by(|a, b| a.0.total_cmp(&b.0).then(key(a).cmp(&key(b))));
        check_cancelled(self.progress)?;
        Ok(IntervalMeetings {
            first,
            touching: touching.len(),
        })
    }

    /// Finds all pairs of edges of the same layer whose boxes overlap, by a sweep along x. For each
    /// of them, pairs both ends of each edge with the other edge. Returns `None` if there are more
    /// than about `max_pairs` vertex–edge pairs.
    fn near_pairs(&self, curves: &[VertexCurve], max_pairs: usize) -> Option<Vec<VertexEdgePair>> {
        let boxes: Vec<[DVec2; 2]> = curves.par_iter().map(VertexCurve::bounds).collect();
        let edge_box = |edge: &LoopEdge| {
            let [a, b] = edge.ends.map(|v| boxes[v]);
            [a[0].min(b[0]), a[1].max(b[1])]
        };
        let mut sorted: Vec<([DVec2; 2], LoopEdge)> = self
            .edges
            .iter()
            .map(|edge| (edge_box(edge), *edge))
            .collect();
        sorted.sort_by(|(a, _), (b, _)| a[0].x.total_cmp(&b[0].x));
        let mut pairs = Vec::new();
        for (k, (this, edge)) in sorted.iter().enumerate() {
            let ahead = sorted[k + 1..].iter();
            for (that, other) in ahead.take_while(|(that, _)| that[0].x <= this[1].x) {
                let overlap = this[0].y <= that[1].y && that[0].y <= this[1].y;
                if overlap && edge.layer == other.layer {
                    let of = |a: &LoopEdge, b: &LoopEdge| a.ends.map(|v| (v, b.ends));
                    let both = of(edge, other).into_iter().chain(of(other, edge));
                    pairs.extend(both.filter(|(v, ends)| !ends.contains(v)));
                }
            }
            // Duplicates, which are removed below, are still counted here: a pair occurs up to
            // about four times.
            if pairs.len() > max_pairs.saturating_mul(4) {
                return None;
            }
        }
        pairs.sort_unstable();
        pairs.dedup();
        Some(pairs)
    }

    /// Returns whether the vertex of a pair lies on its edge at t = 0 or t = 1. `at_ends` marks
    /// whether the curves begin at t = 0 and whether they end at t = 1.
    fn touches(
        &self,
        curves: &[VertexCurve],
        at_ends: [bool; 2],
        &(v, edge): &VertexEdgePair,
    ) -> bool {
        let last = curves[v].control_points.len() - 1;
        let touches_at = |k: usize| {
            let [a, b, p] = [edge[0], edge[1], v].map(|v| curves[v].control_points[k]);
            let tolerance = curves[v].error + curves[edge[0]].error + curves[edge[1]].error;
            let along = b - a;
            let fraction = ((p - a).dot(along) / along.length_squared()).clamp(0.0, 1.0);
            // An edge of length zero gives NaN; only a vertex at the same point touches it.
            p.distance(a + along * fraction) <= tolerance || p == a || p == b
        };
        (at_ends[0] && touches_at(0)) || (at_ends[1] && touches_at(last))
    }

    /// Returns whether the signs of the Bernstein coefficients prove that the point p stays off the
    /// edge a–b throughout: on one side of the line ab, behind a, or beyond b.
    ///
    /// The arguments are the curves of a, b and p. `at_ends` marks the ends of these curves at
    /// which the exact predicate decides on which side of the line p lies.
    fn is_apart(&self, [a, b, p]: [&VertexCurve; 3], at_ends: [bool; 2]) -> bool {
        let last = p.control_points.len() - 1;
        let exact = [0, last].map(|k| {
            let [a, b, p] = [a, b, p].map(|curve| curve.control_points[k]);
            orient2d(a, b, p)
        });
        let known_signs = |sign: f64| {
            let at = |end: usize| match at_ends[end] {
                true => EndSign::of(sign * exact[end]),
                false => EndSign::Unknown,
            };
            [at(0), at(1)]
        };
        let none = [EndSign::Unknown; 2];
        let side = twice_area(&self.products, [a, b, p]);
        let behind = || product(&self.products, [a, p], [a, b], DVec2::dot).negated();
        let ahead = || product(&self.products, [b, p], [a, b], DVec2::dot);
        side.is_positive(known_signs(1.0))
            || side.negated().is_positive(known_signs(-1.0))
            || behind().is_positive(none)
            || ahead().is_positive(none)
    }

    /// Returns the smallest s in `[from, to]` at which the third curve is not proved to be off the
    /// edge between the first two, by bisection. The result is `None` if the third curve is off the
    /// edge throughout, or if a failure before `from` is already known. If too many parts are
    /// undecided, the first of those left counts as a contact.
    fn first_contact(
        &self,
        curves: [VertexCurve; 3],
        at_ends: [bool; 2],
        [from, to]: [f64; 2],
        halvings: u32,
        search: &Bisection,
    ) -> Option<f64> {
        if search.earliest.is_before(from) {
            return None;
        }
        let [a, b, p] = curves.each_ref();
        let [low, high] = p.bounds();
        let [of_a, of_b] = [a, b].map(VertexCurve::bounds);
        let (edge_low, edge_high) = (of_a[0].min(of_b[0]), of_a[1].max(of_b[1]));
        if low.cmpgt(edge_high).any() || high.cmplt(edge_low).any() {
            return None;
        }
        if self.is_apart([a, b, p], at_ends) {
            return None;
        }
        if halvings == 0 || !search.try_use_part() {
            return Some(search.earliest.report(from));
        }
        let middle = from.midpoint(to);
        let halvings = halvings - 1;
        let [[a0, a1], [b0, b1], [p0, p1]] = [a, b, p].map(VertexCurve::halves);
        let (left, right) = ([a0, b0, p0], [a1, b1, p1]);
        self.first_contact(left, [at_ends[0], false], [from, middle], halvings, search)
            .or_else(|| {
                self.first_contact(right, [false, at_ends[1]], [middle, to], halvings, search)
            })
    }
}
