//! Outlines that meet.
//!
//! Outlines that are apart at first meet first where a vertex comes to lie on an edge.
//! Boxes around the ways of edges tell which are near each other; where too many are,
//! the reel is halved. What is near is apart as long as the vertex is on one side of
//! the edge's line, or ahead of the edge, or behind it.

use super::bernstein::{BernsteinProducts, EndSign};
use super::drawn_loop::DrawnLoop;
use super::folds::{EarliestFailure, MAX_HALVINGS, product, twice_area};
use super::vertex_curve::{IntervalCurves, VertexCurve};
use crate::geometry::{DVec2, EdgeCrossing, crossings, orient2d};
use crate::work::progress::{Cancelled, Progress, still_wanted};
use rayon::prelude::*;
use std::collections::BTreeMap;

/// A part of a reel is halved where so many pairs of edges for each edge are near
/// each other, as long as it is no shorter than a 1024th.
const PAIRS: usize = 12;
const PARTS: u32 = 10;

/// What touches at an end of the film is left out for so long.
const TOUCHING: f64 = 1.0 / 1024.0;

/// Where the pieces of a reel end that are looked at each for itself: what is near an
/// end of the film is one. `length` is how much of the film the reel is.
fn pieces(at_ends: [bool; 2], length: f64) -> Vec<f64> {
    let near = (TOUCHING / length).min(0.25);
    let begin = at_ends[0].then_some(near);
    let end = at_ends[1].then_some(1.0 - near);
    begin.into_iter().chain(end).chain([1.0]).collect()
}

/// The place in the reel, the vertex, the edge, and where that is.
type VertexEdgeMeeting = (f64, u32, [u32; 2], DVec2);

/// What was found in a reel.
#[derive(Default)]
pub(super) struct IntervalMeetings {
    pub first: Option<VertexEdgeMeeting>,
    pub touching: usize,
}

/// An edge, by its vertices' numbers among those of the walks.
#[derive(Clone, Copy)]
struct LoopEdge {
    ends: [usize; 2],
    level: usize,
}

/// A vertex and an edge that it must not meet.
type VertexEdgePair = (usize, [usize; 2]);

pub(super) fn first_meeting(
    ways: &IntervalCurves,
    walks: &[&DrawnLoop],
    at_ends: [bool; 2],
    progress: &dyn Progress,
) -> Result<IntervalMeetings, Cancelled> {
    let search = MeetingSearch::of(walks, ways.degree(), progress);
    let vertices = &search.vertices;
    let mut rest: Vec<VertexCurve> = vertices.par_iter().map(|&v| ways.way(v as usize)).collect();
    let mut found = IntervalMeetings::default();
    let mut from = 0.0;
    for to in pieces(at_ends, ways.length()) {
        let piece = match to < 1.0 {
            true => {
                let cut = |way: &VertexCurve| way.cut((to - from) / (1.0 - from)).into();
                let (piece, after): (Vec<VertexCurve>, Vec<VertexCurve>) =
                    rest.par_iter().map(cut).unzip();
                rest = after;
                piece
            }
            false => std::mem::take(&mut rest),
        };
        let ends = [at_ends[0] && from == 0.0, at_ends[1] && to == 1.0];
        // A cut's sides lie on each other in the designs: that is looked at once they
        // are apart.
        let crossed = (!ends[0]).then(|| search.crossed(&piece, walks, from));
        let next = match crossed.flatten() {
            Some(first) => IntervalMeetings {
                first: Some(first),
                touching: 0,
            },
            None => search.part(&piece, ends, [from, to], PARTS)?,
        };
        found.touching += next.touching;
        found.first = next.first;
        if found.first.is_some() {
            break;
        }
        from = to;
    }
    if let Some((_, vertex, edge, _)) = &mut found.first {
        *vertex = vertices[*vertex as usize];
        *edge = edge.map(|v| vertices[v as usize]);
    }
    Ok(found)
}

struct MeetingSearch<'a> {
    products: BernsteinProducts,
    edges: Vec<LoopEdge>,
    /// The vertices of all walks, and for each of them its number here.
    vertices: Vec<u32>,
    numbers: BTreeMap<u32, usize>,
    progress: &'a dyn Progress,
}

impl<'a> MeetingSearch<'a> {
    fn of(walks: &[&DrawnLoop], degree: usize, progress: &'a dyn Progress) -> Self {
        let mut numbers = BTreeMap::new();
        for walk in walks {
            for &v in &walk.vertices {
                let next = numbers.len();
                numbers.entry(v).or_insert(next);
            }
        }
        let mut vertices = vec![0; numbers.len()];
        numbers.iter().for_each(|(&v, &k)| vertices[k] = v);
        let edges = walks.iter().flat_map(|walk| {
            let next = walk.vertices.iter().cycle().skip(1);
            let ends = walk.vertices.iter().zip(next);
            ends.map(|(a, b)| LoopEdge {
                ends: [numbers[a], numbers[b]],
                level: walk.level,
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

    /// A crossing at the beginning.
    fn crossed(
        &self,
        places: &[VertexCurve],
        walks: &[&DrawnLoop],
        s: f64,
    ) -> Option<VertexEdgeMeeting> {
        let number =
            |walk: &DrawnLoop, k: usize| self.numbers[&walk.vertices[k % walk.vertices.len()]];
        let ring = |walk: &&DrawnLoop| -> Vec<DVec2> {
            let numbers = (0..walk.vertices.len()).map(|k| number(walk, k));
            numbers.map(|v| places[v].at[0]).collect()
        };
        let rings: Vec<Vec<DVec2>> = walks.iter().map(ring).collect();
        let all = crossings(&rings);
        let is_met = |crossing: &&EdgeCrossing| {
            let [a, b] = crossing.edges.map(|edge| walks[edge.ring].level);
            a == b
        };
        let crossing = all.iter().find(is_met)?;
        let [one, other] = crossing.edges;
        let edge = [other.point, other.point + 1].map(|k| number(walks[other.ring], k) as u32);
        let vertex = number(walks[one.ring], one.point) as u32;
        Some((s, vertex, edge, crossing.place))
    }

    /// The first meeting in a part of the reel.
    fn part(
        &self,
        places: &[VertexCurve],
        at_ends: [bool; 2],
        [from, to]: [f64; 2],
        halvings: u32,
    ) -> Result<IntervalMeetings, Cancelled> {
        still_wanted(self.progress)?;
        let most = PAIRS * self.edges.len() + 1000;
        let Some(pairs) = self.near(places, if halvings > 0 { most } else { usize::MAX }) else {
            let middle = from.midpoint(to);
            let (left, right): (Vec<VertexCurve>, Vec<VertexCurve>) =
                places.par_iter().map(|way| way.halves().into()).unzip();
            let mut found = self.part(&left, [at_ends[0], false], [from, middle], halvings - 1)?;
            if found.first.is_none() {
                let right = self.part(&right, [false, at_ends[1]], [middle, to], halvings - 1)?;
                found.first = right.first;
                found.touching += right.touching;
            }
            return Ok(found);
        };
        let earliest = EarliestFailure::default();
        let touches = |pair: &VertexEdgePair| self.touches(places, at_ends, pair);
        let (touching, apart): (Vec<VertexEdgePair>, Vec<VertexEdgePair>) =
            pairs.into_par_iter().partition(touches);
        let meets = |&(v, [a, b]): &VertexEdgePair| {
            let ways = [&places[a], &places[b], &places[v]].map(Clone::clone);
            if self.progress.is_cancelled() {
                return None;
            }
            let s = self.meets(ways, at_ends, [from, to], (MAX_HALVINGS, &earliest))?;
            let edge = [a as u32, b as u32];
            // As good as where it is then: it is for the eye.
            Some((s, v as u32, edge, places[v].at[0]))
        };
        let found = apart.par_iter().filter_map(meets);
        let key = |m: &VertexEdgeMeeting| (m.1, m.2);
        let first = found.min_by(|a, b| a.0.total_cmp(&b.0).then(key(a).cmp(&key(b))));
        still_wanted(self.progress)?;
        Ok(IntervalMeetings {
            first,
            touching: touching.len(),
        })
    }

    /// The vertices and edges whose boxes overlap; none if they are more than so many.
    fn near(&self, places: &[VertexCurve], most: usize) -> Option<Vec<VertexEdgePair>> {
        let boxes: Vec<[DVec2; 2]> = places.par_iter().map(VertexCurve::bounds).collect();
        let around = |edge: &LoopEdge| {
            let [a, b] = edge.ends.map(|v| boxes[v]);
            [a[0].min(b[0]), a[1].max(b[1])]
        };
        let mut sorted: Vec<([DVec2; 2], LoopEdge)> = self
            .edges
            .iter()
            .map(|edge| (around(edge), *edge))
            .collect();
        sorted.sort_by(|(a, _), (b, _)| a[0].x.total_cmp(&b[0].x));
        let mut pairs = Vec::new();
        for (k, (this, edge)) in sorted.iter().enumerate() {
            let ahead = sorted[k + 1..].iter();
            for (that, other) in ahead.take_while(|(that, _)| that[0].x <= this[1].x) {
                let overlap = this[0].y <= that[1].y && that[0].y <= this[1].y;
                if overlap && edge.level == other.level {
                    let of = |a: &LoopEdge, b: &LoopEdge| a.ends.map(|v| (v, b.ends));
                    let both = of(edge, other).into_iter().chain(of(other, edge));
                    pairs.extend(both.filter(|(v, ends)| !ends.contains(v)));
                }
            }
            if pairs.len() > most.saturating_mul(4) {
                return None;
            }
        }
        pairs.sort_unstable();
        pairs.dedup();
        Some(pairs)
    }

    /// Whether the vertex lies on the edge at an end of the film.
    fn touches(
        &self,
        places: &[VertexCurve],
        at_ends: [bool; 2],
        &(v, edge): &VertexEdgePair,
    ) -> bool {
        let last = places[v].at.len() - 1;
        let at = |k: usize| {
            let [a, b, p] = [edge[0], edge[1], v].map(|v| places[v].at[k]);
            let room = places[v].error + places[edge[0]].error + places[edge[1]].error;
            let along = b - a;
            let share = ((p - a).dot(along) / along.length_squared()).clamp(0.0, 1.0);
            // Not where the edge is a point: then it is what is near that point.
            p.distance(a + along * share) <= room || p == a || p == b
        };
        (at_ends[0] && at(0)) || (at_ends[1] && at(last))
    }

    /// The first place at which the third is not proved to be off the edge of the other
    /// two.
    fn meets(
        &self,
        ways: [VertexCurve; 3],
        at_ends: [bool; 2],
        [from, to]: [f64; 2],
        (halvings, earliest): (u32, &EarliestFailure),
    ) -> Option<f64> {
        if earliest.is_before(from) {
            return None;
        }
        let [a, b, p] = ways.each_ref();
        let last = p.at.len() - 1;
        let [low, high] = p.bounds();
        let [of_a, of_b] = [a, b].map(VertexCurve::bounds);
        let (least, most) = (of_a[0].min(of_b[0]), of_a[1].max(of_b[1]));
        if low.cmpgt(most).any() || high.cmplt(least).any() {
            return None;
        }
        let side = twice_area(&self.products, [a, b, p]);
        let exact = [0, last].map(|k| orient2d(a.at[k], b.at[k], p.at[k]));
        let known = |sign: f64| {
            let at = |end: usize| match at_ends[end] {
                true => EndSign::of(sign * exact[end]),
                false => EndSign::No,
            };
            [at(0), at(1)]
        };
        let none = [EndSign::No; 2];
        let behind = || product(&self.products, [a, p], [a, b], DVec2::dot).negated();
        let ahead = || product(&self.products, [b, p], [a, b], DVec2::dot);
        if side.is_positive(known(1.0))
            || side.negated().is_positive(known(-1.0))
            || behind().is_positive(none)
            || ahead().is_positive(none)
        {
            return None;
        }
        if halvings == 0 {
            return Some(earliest.told(from));
        }
        let middle = from.midpoint(to);
        let next = (halvings - 1, earliest);
        let [[a0, a1], [b0, b1], [p0, p1]] = [a, b, p].map(VertexCurve::halves);
        let (left, right) = ([a0, b0, p0], [a1, b1, p1]);
        self.meets(left, [at_ends[0], false], [from, middle], next)
            .or_else(|| self.meets(right, [false, at_ends[1]], [middle, to], next))
    }
}
