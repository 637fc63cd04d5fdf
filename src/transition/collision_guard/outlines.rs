//! The vertices and edges of all outlines, and the vertex–edge pairs that are close to each other.

use crate::geometry::{DVec2, nearest_segment_parameter};
use crate::recording::proof::DrawnLoop;
use crate::warp::{Arap, Warp};
use std::collections::BTreeMap;

/// Required clearance between outlines, as a fraction of the mesh diameter (heuristic: one pixel of
/// a picture 1,000 pixels wide).
const APART: f64 = 1e-3;

/// Distance between a vertex and an edge, as a fraction of the mesh diameter, below which the two
/// count as touching, like the two sides of a cut that has not opened yet (tolerance: far above
/// rounding, far below the clearance).
const TOUCHES: f64 = 1e-7;

/// Length of t over which the required clearance between a vertex and an edge rises from 0 to its
/// full value, if the two touch at the time from which both are drawn. The clearance falls to 0 in
/// the same way if they touch at the time until which both are drawn (heuristic).
const OPENS: f64 = 0.05;

/// A vertex and an edge that must not meet: indices in the `points` and `edges` of
/// [`GuardedOutlines`].
pub(super) type GuardedPair = (usize, usize);

/// An edge of an outline. The filled side is on its left.
#[derive(Clone, Copy)]
pub(super) struct GuardedEdge {
    pub ends: [u32; 2],
    walk: usize,
}

/// The vertices and edges of all outlines.
pub(super) struct GuardedOutlines {
    points: Vec<(u32, usize)>,
    edges: Vec<GuardedEdge>,
    walks: Vec<DrawnLoop>,
    /// For each loop, the index of its connected part if that part exists in only one design.
    living: Vec<Option<u32>>,
    /// Positions of all vertices in the original motion at the times at which a loop appears or
    /// disappears. The key is the bit pattern of the time.
    ends: BTreeMap<u64, Vec<DVec2>>,
    diameter: f64,
}

impl GuardedOutlines {
    /// Collects the outlines; `None` if there are none.
    pub(super) fn of(film: &Arap, drawn: &[DrawnLoop]) -> Option<Self> {
        let mut placer = film.placer();
        let mut ends = BTreeMap::new();
        for t in drawn.iter().flat_map(|walk| walk.visible_interval) {
            ends.entry(t.to_bits()).or_insert_with(|| {
                placer.place(t);
                placer.placement().in_frame.clone()
            });
        }
        let (mut points, mut edges) = (Vec::new(), Vec::new());
        for (walk, DrawnLoop { vertices, .. }) in drawn.iter().enumerate() {
            let next = vertices.iter().cycle().skip(1);
            for (&from, &to) in vertices.iter().zip(next) {
                points.push((from, walk));
                let ends = [from, to];
                edges.push(GuardedEdge { ends, walk });
            }
        }
        let parts = film.mesh().components();
        let living = |walk: &DrawnLoop| {
            let part = *parts.get(*walk.vertices.first()? as usize)?;
            let life = film.time_windows().get(part as usize).copied().flatten();
            life.map(|_| part)
        };
        (!drawn.is_empty()).then(|| Self {
            living: drawn.iter().map(living).collect(),
            points,
            edges,
            walks: drawn.to_vec(),
            ends,
            diameter: film.mesh().diameter(),
        })
    }

    /// Returns the required clearance between outlines, in units of the plane.
    pub(super) fn apart(&self) -> f64 {
        APART * self.diameter
    }

    /// Returns the distance below which a vertex touches an edge, in units of the plane.
    pub(super) fn touches(&self) -> f64 {
        TOUCHES * self.diameter
    }

    pub(super) fn vertex(&self, pair: GuardedPair) -> u32 {
        self.points[pair.0].0
    }

    pub(super) fn edge(&self, pair: GuardedPair) -> [u32; 2] {
        self.edges[pair.1].ends
    }

    /// Returns the first and the last time at which the vertex and the edge of a pair are both
    /// drawn. The first is later than the last if they are never drawn together.
    fn drawn(&self, pair: GuardedPair) -> [f64; 2] {
        let [a, b] = [self.points[pair.0].1, self.edges[pair.1].walk];
        let [a, b] = [&self.walks[a], &self.walks[b]];
        [
            a.visible_interval[0].max(b.visible_interval[0]),
            a.visible_interval[1].min(b.visible_interval[1]),
        ]
    }

    fn may_meet(&self, pair: GuardedPair, t: f64) -> bool {
        let ((vertex, a), edge) = (self.points[pair.0], &self.edges[pair.1]);
        let [from, to] = self.drawn(pair);
        let both = [a, edge.walk].map(|walk| &self.walks[walk]);
        let living = self.living[a];
        both[0].layer == both[1].layer
            // A part that exists in only one design keeps its shape and cannot meet itself.
            && (living.is_none() || living != self.living[edge.walk])
            && from < t
            && t < to
            && !edge.ends.contains(&vertex)
    }

    /// Returns the required clearance at `t` between the vertex and the edge of a pair. It is
    /// [`Self::apart`], but at most a quarter of their distance at the first and at the last time
    /// at which both are drawn. If they touch at one of these times, the clearance is 0 there and
    /// changes gradually.
    pub(super) fn gap(&self, pair: GuardedPair, t: f64) -> f64 {
        let [from, to] = self.drawn(pair);
        let apart = self.apart();
        let reach = |end: f64, since: f64| {
            let Some(places) = self.ends.get(&end.to_bits()) else {
                return apart;
            };
            let distance = self.towards(pair, places).length();
            if distance > self.touches() {
                0.25 * distance
            } else {
                apart * since / OPENS
            }
        };
        apart.min(reach(from, t - from)).min(reach(to, to - t))
    }

    /// Returns the vector from the nearest point of the edge to the vertex.
    pub(super) fn towards(&self, pair: GuardedPair, places: &[DVec2]) -> DVec2 {
        let p = places[self.vertex(pair) as usize];
        let [a, b] = self.edge(pair).map(|v| places[v as usize]);
        p - a.lerp(b, nearest_segment_parameter(p, a, b))
    }

    /// Returns all pairs that are drawn at `t` and may come within `reach` of each other while the
    /// vertices move in straight lines from `ways[0]` to `ways[1]`. Also returns some pairs that
    /// stay farther apart.
    pub(super) fn near(&self, ways: [&[DVec2]; 2], reach: f64, t: f64) -> Vec<GuardedPair> {
        let mut spans: Vec<SweepBox> = Vec::with_capacity(2 * self.points.len());
        for (number, &(vertex, _)) in self.points.iter().enumerate() {
            spans.push(SweepBox::of(
                ways,
                &[vertex],
                0.0,
                SweepMember::Point(number),
            ));
        }
        for (number, edge) in self.edges.iter().enumerate() {
            spans.push(SweepBox::of(
                ways,
                &edge.ends,
                reach,
                SweepMember::Edge(number),
            ));
        }
        spans.sort_unstable_by(|a, b| a.low.x.total_cmp(&b.low.x));
        let mut near = Vec::new();
        for (i, span) in spans.iter().enumerate() {
            let later = spans[i + 1..].iter();
            for other in later.take_while(|other| other.low.x <= span.high.x) {
                let pair = match (span.member, other.member) {
                    (SweepMember::Point(point), SweepMember::Edge(edge))
                    | (SweepMember::Edge(edge), SweepMember::Point(point)) => (point, edge),
                    _ => continue,
                };
                let overlap = other.low.y <= span.high.y && span.low.y <= other.high.y;
                if overlap && self.may_meet(pair, t) {
                    near.push(pair);
                }
            }
        }
        near.sort_unstable();
        near
    }
}

#[derive(Clone, Copy)]
enum SweepMember {
    Point(usize),
    Edge(usize),
}

/// Bounding box of the straight paths of a vertex or an edge.
struct SweepBox {
    low: DVec2,
    high: DVec2,
    member: SweepMember,
}

impl SweepBox {
    fn of(ways: [&[DVec2]; 2], vertices: &[u32], reach: f64, member: SweepMember) -> Self {
        let first = ways[0][vertices[0] as usize];
        let (mut low, mut high) = (first, first);
        for places in ways {
            for &v in vertices {
                low = low.min(places[v as usize]);
                high = high.max(places[v as usize]);
            }
        }
        Self {
            low: low - reach,
            high: high + reach,
            member,
        }
    }
}
