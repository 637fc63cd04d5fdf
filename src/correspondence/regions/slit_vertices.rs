//! Gives both passages of a boundary loop along a slit the same vertices.
//!
//! A boundary loop follows a slit twice, there and back. Vertices that come from the other design
//! lie on one passage or the other arbitrarily. This module gives both passages all of these
//! vertices, at exactly the same points, so that a mesh of the uncut part needs each of the points
//! only once.

use super::super::boundary_match::interpolate_knots;
use super::super::curve::BoundaryCurve;
use super::super::shared_polygons::SharedPolygons;
use crate::geometry::{DVec2, Side, SourceTarget};

/// Maximum distance at which a vertex of one passage is merged with a vertex of the other. The unit
/// is the spacing that the vertices of the passage with more vertices would have if they were
/// evenly spaced. Below ½, so that no vertex is within this distance of two evenly spaced ones
/// (heuristic).
const MERGE_DISTANCE: f64 = 0.35;

/// A vertex on one of the two passages along a slit: a boundary loop follows the slit there and
/// back.
#[derive(Clone, Copy)]
struct PassageVertex {
    /// Position along the slit as a fraction of its length from its outer end, in (0, 1).
    along: f64,
    /// Index of the vertex in [`SharedPolygons`].
    vertex: usize,
}

/// A point of the slit at which both passages get a vertex.
struct SlitVertex {
    /// Position along the slit as a fraction of its length from its outer end, in (0, 1).
    along: f64,
    /// Indices of the vertices that the outward and the return passage already have at this point;
    /// `None` where one is missing.
    existing: [Option<usize>; 2],
}

/// One passage along a slit: the outward passage from the slit's outer end, or the return passage
/// to it.
struct SlitPassage<'a> {
    /// Design that was cut.
    side: Side,
    /// Curve along the cut boundary loop.
    curve: &'a BoundaryCurve,
    /// Matched curve of the other design.
    other: &'a BoundaryCurve,
    /// Outer end and inner end of the slit.
    slit: [DVec2; 2],
    /// Whether this is the return passage.
    is_back: bool,
    /// Places on `curve` at which the passage begins and ends.
    span: [f64; 2],
}

/// Gives both passages of a slit the same vertices. `side` is the design that was cut, `curve` its
/// boundary loop, and `other` the curve of the other design.
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
    let vertices = separate_positions(merge_passages(&[
        passages[0].existing_vertices(shared),
        passages[1].existing_vertices(shared),
    ]));
    let mut added = Vec::new();
    for passage in &passages {
        passage.place(shared, &vertices, &mut added);
    }
    insert(shared, side, curve, added);
}

/// Returns the two intervals of places in which the curve runs along the slit: first outward, then
/// back.
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

/// Merges the vertices of both passages into one ascending list. A close pair, one of each passage,
/// becomes one vertex.
fn merge_passages([outward, back]: &[Vec<PassageVertex>; 2]) -> Vec<SlitVertex> {
    let near = MERGE_DISTANCE / (outward.len().max(back.len()) + 1) as f64;
    let (mut i, mut j) = (0, 0);
    let mut vertices = Vec::new();
    while i < outward.len() || j < back.len() {
        let (a, b) = (outward.get(i), back.get(j));
        let vertex = match (a, b) {
            (Some(a), Some(b)) if (a.along - b.along).abs() <= near => SlitVertex {
                along: a.along.midpoint(b.along),
                existing: [Some(a.vertex), Some(b.vertex)],
            },
            (Some(a), b) if b.is_none_or(|b| a.along < b.along) => SlitVertex {
                along: a.along,
                existing: [Some(a.vertex), None],
            },
            (_, Some(b)) => SlitVertex {
                along: b.along,
                existing: [None, Some(b.vertex)],
            },
            _ => break,
        };
        i += usize::from(vertex.existing[0].is_some());
        j += usize::from(vertex.existing[1].is_some());
        vertices.push(vertex);
    }
    vertices
}

/// Makes the positions strictly ascending, with space between neighbours. Vertices may move along a
/// slit, because a slit is no part of the drawn outline.
fn separate_positions(mut vertices: Vec<SlitVertex>) -> Vec<SlitVertex> {
    let count = vertices.len() as f64 + 1.0;
    let mut positions: Vec<f64> = vertices.iter().map(|vertex| vertex.along).collect();
    positions.sort_by(f64::total_cmp);
    let bounds = std::iter::once(0.0)
        .chain(positions.iter().copied())
        .chain(std::iter::once(1.0))
        .collect::<Vec<_>>();
    // If any two vertices are too close, space all vertices evenly: tiny edges along a slit would
    // force thin triangles.
    let is_crowded = bounds.windows(2).any(|w| w[1] - w[0] < 0.1 / count);
    for (k, vertex) in vertices.iter_mut().enumerate() {
        vertex.along = if is_crowded {
            (k + 1) as f64 / count
        } else {
            positions[k]
        };
    }
    vertices
}

/// A pair of corresponding vertices to be inserted into the two polygons.
struct NewVertexPair {
    /// Places on the source and on the target curve.
    places: [f64; 2],
    /// Points on the source and on the target curve.
    points: [DVec2; 2],
}

impl SlitPassage<'_> {
    /// Returns the vertices strictly inside the passage, sorted from the slit's outer end.
    fn existing_vertices(&self, shared: &SharedPolygons) -> Vec<PassageVertex> {
        let [from, to] = self.span;
        let places = shared.places.iter().map(|place| place[self.side]);
        let inside = places.enumerate().filter(|(_, at)| from < *at && *at < to);
        let passage_vertex = |(vertex, at): (usize, f64)| PassageVertex {
            along: self.outer_fraction((at - from) / (to - from)),
            vertex,
        };
        let mut vertices: Vec<PassageVertex> = inside.map(passage_vertex).collect();
        vertices.sort_by(|a, b| a.along.total_cmp(&b.along));
        vertices
    }

    /// Converts a fraction of the passage to a fraction of the slit from its outer end, and vice
    /// versa.
    fn outer_fraction(&self, fraction: f64) -> f64 {
        if self.is_back {
            1.0 - fraction
        } else {
            fraction
        }
    }

    /// Returns the index of the vertex that this passage already has at the given point of the
    /// slit.
    fn existing_index(&self, vertex: &SlitVertex) -> Option<usize> {
        vertex.existing[usize::from(self.is_back)]
    }

    /// Moves the passage's existing vertices to their points in `vertices`, and adds the vertices
    /// that the passage lacks to `missing`.
    fn place(
        &self,
        shared: &mut SharedPolygons,
        vertices: &[SlitVertex],
        missing: &mut Vec<NewVertexPair>,
    ) {
        let anchors = self.anchors(shared, vertices);
        let ([a, b], [from, to]) = (self.slit, self.span);
        for vertex in vertices {
            let point = a.lerp(b, vertex.along);
            let own = from + self.outer_fraction(vertex.along) * (to - from);
            if let Some(index) = self.existing_index(vertex) {
                points_mut(shared, self.side)[index] = point;
                shared.places[index][self.side] = own;
            } else {
                let across = self
                    .other
                    .wrapped(interpolate_knots(&anchors, vertex.along, [0, 1]));
                let here = SourceTarget::with_side(self.side, own, across);
                let points = SourceTarget::with_side(self.side, point, self.other.point_at(across));
                missing.push(NewVertexPair {
                    places: here.to_array(),
                    points: points.to_array(),
                });
            }
        }
    }

    /// Returns the passage's ends and existing vertices, each as a pair: position along the slit,
    /// and place on the other design's curve. Both ascend; places continue beyond 1.
    fn anchors(&self, shared: &SharedPolygons, vertices: &[SlitVertex]) -> Vec<[f64; 2]> {
        let across = |vertex: usize| shared.places[vertex][self.side.other()];
        let across_at = |place: f64| {
            let wrapped = self.curve.wrapped(place);
            let distance = |k: &usize| (shared.places[*k][self.side] - wrapped).abs();
            (0..shared.places.len())
                .min_by(|j, k| distance(j).total_cmp(&distance(k)))
                .map_or(0.0, across)
        };
        let inner =
            |vertex: &SlitVertex| Some([vertex.along, across(self.existing_index(vertex)?)]);
        let [from, to] = self.span;
        let mut anchors = vec![[self.outer_fraction(0.0), across_at(from)]];
        if self.is_back {
            anchors.extend(vertices.iter().rev().filter_map(inner));
        } else {
            anchors.extend(vertices.iter().filter_map(inner));
        }
        anchors.push([self.outer_fraction(1.0), across_at(to)]);
        // Along the boundary loop, the places on the other curve ascend, so add 1 where they start
        // again at 0.
        for k in 1..anchors.len() {
            if anchors[k][1] < anchors[k - 1][1] {
                anchors[k][1] += 1.0;
            }
        }
        if self.is_back {
            anchors.reverse();
        }
        anchors
    }
}

/// Returns the shared vertices of one design.
fn points_mut(shared: &mut SharedPolygons, side: Side) -> &mut Vec<DVec2> {
    match side {
        Side::Source => &mut shared.source,
        Side::Target => &mut shared.target,
    }
}

/// Inserts the new vertices in the order of the boundary loop.
fn insert(
    shared: &mut SharedPolygons,
    side: Side,
    curve: &BoundaryCurve,
    mut added: Vec<NewVertexPair>,
) {
    let first = shared.places.first().map_or(0.0, |place| place[side]);
    let ahead = |place: f64| curve.wrapped(place - first);
    added.sort_by(|a, b| ahead(a.places[side]).total_cmp(&ahead(b.places[side])));
    // Insert from the last to the first, so that the insertion points of the others stay valid.
    for new in added.into_iter().rev() {
        let index = shared
            .places
            .iter()
            .position(|place| ahead(place[side]) > ahead(new.places[side]))
            .unwrap_or(shared.places.len());
        shared.places.insert(index, new.places);
        shared.source.insert(index, new.points[0]);
        shared.target.insert(index, new.points[1]);
    }
}
