//! The two sides of a slit given the same vertices.
//!
//! A walk runs along its slit twice, and the other design's vertices fall on
//! either passage as they will. Both get all of them, in the same points bit
//! by bit: a mesh of the part before it was cut has those points once.

use super::super::boundary_match::interpolated;
use super::super::curve::BoundaryCurve;
use super::super::shared_polygons::SharedPolygons;
use crate::geometry::{DVec2, Side, SourceTarget};

/// Vertices of the two passages nearer than this share of the slit divided by
/// their number become one.
/// Below ½, so that none is near to two of an even row.
const NEAR: f64 = 0.35;

/// A vertex on one passage.
#[derive(Clone, Copy)]
struct PassageVertex {
    /// From the slit's outer end, in (0, 1).
    along: f64,
    /// Its index among the shared vertices.
    vertex: usize,
}

/// One of the points that both passages get.
struct SlitVertex {
    along: f64,
    /// The vertices that are there already: on the way there and back.
    there: [Option<usize>; 2],
}

/// One way along a slit: from its outer end, or back to it.
struct SlitPassage<'a> {
    /// The design that was cut, its walk's curve and the other design's.
    side: Side,
    curve: &'a BoundaryCurve,
    other: &'a BoundaryCurve,
    slit: [DVec2; 2],
    is_back: bool,
    /// The places at which it begins and ends.
    span: [f64; 2],
}

/// Gives both passages of a slit the same vertices. `side` is the design that
/// was cut, with its walk's `curve`; `other` is the other design's curve.
pub(super) fn mirror_slit_vertices(
    shared: &mut SharedPolygons,
    side: Side,
    curve: &BoundaryCurve,
    slit: [DVec2; 2],
    other: &BoundaryCurve,
) {
    let Some(spans) = passages(curve, slit) else {
        return;
    };
    let passages = [false, true].map(|is_back| SlitPassage {
        side,
        curve,
        other,
        slit,
        is_back,
        span: spans[usize::from(is_back)],
    });
    let rungs = spread(paired(&[
        passages[0].stops(shared),
        passages[1].stops(shared),
    ]));
    let mut added = Vec::new();
    for passage in &passages {
        passage.place(shared, &rungs, &mut added);
    }
    insert(shared, side, curve, added);
}

/// Places between which the curve runs along the slit: out, then back.
fn passages(curve: &BoundaryCurve, [a, b]: [DVec2; 2]) -> Option<[[f64; 2]; 2]> {
    let points = curve.points();
    let n = points.len();
    let find = |p: DVec2, q: DVec2| {
        let k = (0..n).find(|&k| points[k] == p && points[(k + 1) % n] == q)?;
        let end = curve.places().get(k + 1).copied().unwrap_or(1.0);
        Some([curve.places()[k], end])
    };
    Some([find(a, b)?, find(b, a)?])
}

/// Both passages' stops in one order, near ones together.
fn paired([there, back]: &[Vec<PassageVertex>; 2]) -> Vec<SlitVertex> {
    let near = NEAR / (there.len().max(back.len()) + 1) as f64;
    let (mut i, mut j) = (0, 0);
    let mut rungs = Vec::new();
    while i < there.len() || j < back.len() {
        let (a, b) = (there.get(i), back.get(j));
        let rung = match (a, b) {
            (Some(a), Some(b)) if (a.along - b.along).abs() <= near => SlitVertex {
                along: a.along.midpoint(b.along),
                there: [Some(a.vertex), Some(b.vertex)],
            },
            (Some(a), b) if b.is_none_or(|b| a.along < b.along) => SlitVertex {
                along: a.along,
                there: [Some(a.vertex), None],
            },
            (_, Some(b)) => SlitVertex {
                along: b.along,
                there: [None, Some(b.vertex)],
            },
            _ => break,
        };
        i += usize::from(rung.there[0].is_some());
        j += usize::from(rung.there[1].is_some());
        rungs.push(rung);
    }
    rungs
}

/// Strictly ascending, with room between neighbours. Where a slit's inner
/// vertices lie is free: no outline runs there.
fn spread(mut rungs: Vec<SlitVertex>) -> Vec<SlitVertex> {
    let count = rungs.len() as f64 + 1.0;
    let mut alongs: Vec<f64> = rungs.iter().map(|rung| rung.along).collect();
    alongs.sort_by(f64::total_cmp);
    let ends = std::iter::once(0.0)
        .chain(alongs.iter().copied())
        .chain(std::iter::once(1.0))
        .collect::<Vec<_>>();
    // Even ones instead: a sliver along a slit has no good triangle.
    let crowded = ends.windows(2).any(|w| w[1] - w[0] < 0.1 / count);
    for (k, rung) in rungs.iter_mut().enumerate() {
        rung.along = if crowded {
            (k + 1) as f64 / count
        } else {
            alongs[k]
        };
    }
    rungs
}

/// A vertex to come: its place on either side and its points.
struct NewVertexPair {
    places: [f64; 2],
    points: [DVec2; 2],
}

impl SlitPassage<'_> {
    /// Its vertices strictly inside, from the slit's outer end on.
    fn stops(&self, shared: &SharedPolygons) -> Vec<PassageVertex> {
        let [from, to] = self.span;
        let places = shared.places.iter().map(|place| place[self.side]);
        let inside = places.enumerate().filter(|(_, at)| from < *at && *at < to);
        let stop = |(vertex, at): (usize, f64)| PassageVertex {
            along: self.outer_share((at - from) / (to - from)),
            vertex,
        };
        let mut stops: Vec<PassageVertex> = inside.map(stop).collect();
        stops.sort_by(|a, b| a.along.total_cmp(&b.along));
        stops
    }

    /// A share of the passage as one of the slit, and back.
    fn outer_share(&self, share: f64) -> f64 {
        if self.is_back { 1.0 - share } else { share }
    }

    /// The vertex of a rung that it has already.
    fn vertex(&self, rung: &SlitVertex) -> Option<usize> {
        rung.there[usize::from(self.is_back)]
    }

    /// Moves the vertices that it has to the rungs, and collects those that
    /// it lacks.
    fn place(
        &self,
        shared: &mut SharedPolygons,
        rungs: &[SlitVertex],
        added: &mut Vec<NewVertexPair>,
    ) {
        let known = self.anchors(shared, rungs);
        let ([a, b], [from, to]) = (self.slit, self.span);
        for rung in rungs {
            let point = a.lerp(b, rung.along);
            let own = from + self.outer_share(rung.along) * (to - from);
            if let Some(vertex) = self.vertex(rung) {
                points_of(shared, self.side)[vertex] = point;
                shared.places[vertex][self.side] = own;
            } else {
                let across = self.other.wrapped(interpolated(&known, rung.along, [0, 1]));
                let here = SourceTarget::on(self.side, own, across);
                let points = SourceTarget::on(self.side, point, self.other.point_at(across));
                added.push(NewVertexPair {
                    places: here.to_array(),
                    points: points.to_array(),
                });
            }
        }
    }

    /// Share of the slit and the other side's place, unwrapped, of all
    /// vertices that it has, its ends among them, by the share.
    fn anchors(&self, shared: &SharedPolygons, rungs: &[SlitVertex]) -> Vec<[f64; 2]> {
        let across = |vertex: usize| shared.places[vertex][self.side.other()];
        let at = |place: f64| {
            let wrapped = self.curve.wrapped(place);
            let apart = |k: &usize| (shared.places[*k][self.side] - wrapped).abs();
            (0..shared.places.len())
                .min_by(|j, k| apart(j).total_cmp(&apart(k)))
                .map_or(0.0, across)
        };
        let inner = |rung: &SlitVertex| Some([rung.along, across(self.vertex(rung)?)]);
        let [from, to] = self.span;
        let mut known = vec![[self.outer_share(0.0), at(from)]];
        if self.is_back {
            known.extend(rungs.iter().rev().filter_map(inner));
        } else {
            known.extend(rungs.iter().filter_map(inner));
        }
        known.push([self.outer_share(1.0), at(to)]);
        // In the walk's order the other side's places ascend.
        for k in 1..known.len() {
            if known[k][1] < known[k - 1][1] {
                known[k][1] += 1.0;
            }
        }
        if self.is_back {
            known.reverse();
        }
        known
    }
}

fn points_of(shared: &mut SharedPolygons, side: Side) -> &mut Vec<DVec2> {
    match side {
        Side::Source => &mut shared.source,
        Side::Target => &mut shared.target,
    }
}

/// Inserts the new vertices in the walk's order.
fn insert(
    shared: &mut SharedPolygons,
    side: Side,
    curve: &BoundaryCurve,
    mut added: Vec<NewVertexPair>,
) {
    let first = shared.places.first().map_or(0.0, |place| place[side]);
    let ahead = |place: f64| curve.wrapped(place - first);
    added.sort_by(|a, b| ahead(a.places[side]).total_cmp(&ahead(b.places[side])));
    // From the last on, so that earlier ones do not move where later ones go.
    for new in added.into_iter().rev() {
        let at = shared
            .places
            .iter()
            .position(|place| ahead(place[side]) > ahead(new.places[side]))
            .unwrap_or(shared.places.len());
        shared.places.insert(at, new.places);
        shared.source.insert(at, new.points[0]);
        shared.target.insert(at, new.points[1]);
    }
}
