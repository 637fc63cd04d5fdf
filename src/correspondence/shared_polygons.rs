//! Converts a boundary match to two polygons with the same number of corresponding vertices.
//!
//! Every vertex of either curve becomes a vertex of both polygons. A vertex of one curve and a
//! vertex of the other are merged if the match puts them almost at the same place; corners are
//! merged first. Corners are matched only up to a fraction of the sample spacing, so a pair of
//! corners that is not merged would leave a tiny edge.
//!
//! Both polygons follow their curves exactly: all vertices of a curve are preserved without
//! rounding, and added vertices lie on its edges up to rounding. To get fewer vertices, simplify
//! the curves first.

use super::boundary_match::{BoundaryMatch, interpolate_knots};
use super::curve::BoundaryCurve;
use super::proportional_map::{BOTH, ParameterKnot, ProportionalMap, SharedVertex};
use super::samples::corners;
use crate::geometry::DVec2;

/// A corner of one curve is merged with a corner of the other if their positions, measured by the
/// parameter common to both curves, differ by at most this fraction of the curves' mean length
/// (heuristic).
const SNAP_CORNERS: f64 = 0.008;

/// A vertex of one curve is merged with a vertex of the other if their positions, measured by the
/// parameter common to both curves, differ by at most this fraction of the curves' mean length
/// (heuristic). Corners have the larger limit [`SNAP_CORNERS`].
const SNAP: f64 = 0.0025;

/// Two polygons with corresponding vertices: vertex k of the source corresponds to vertex k of the
/// target. No two neighbouring vertices coincide in either polygon.
#[derive(Clone, Debug, PartialEq)]
pub struct SharedPolygons {
    /// Vertices on the source curve.
    pub source: Vec<DVec2>,
    /// Vertices on the target curve.
    pub target: Vec<DVec2>,
    /// Places `[source, target]` of each vertex on the two curves, as fractions of arc length.
    pub places: Vec<[f64; 2]>,
}

/// Maximum difference between the common parameters of vertices that count as one vertex
/// (tolerance: above rounding, far below any edge).
const SAME_PARAMETER: f64 = 1e-12;

/// Direction along which the candidates for the seam (the start of the common parameter) are
/// ordered. The first one becomes the seam (heuristic: an irrational slope, so that points of a
/// drawing rarely tie).
const SEAM_DIRECTION: DVec2 = DVec2::new(0.754_877_666, 0.569_840_291);

/// Maximum number of vertices added to a polygon to make its edges as short as requested (resource
/// limit).
const MAX_ADDED: f64 = 1e5;

impl BoundaryMatch {
    /// Converts both curves to polygons with corresponding vertices, in order. The curves must be
    /// those that were matched.
    ///
    /// Neighbouring vertices are at most `spacing` apart, as a fraction of the two curves' mean
    /// length; infinity adds no vertices.
    #[must_use]
    pub fn polygons(
        &self,
        source: &BoundaryCurve,
        target: &BoundaryCurve,
        spacing: f64,
    ) -> SharedPolygons {
        let curves = [source, target];
        let common = CommonParameter::new(self, curves);
        let all_parameters =
            [0, 1].map(|side| common.sorted_parameters(curves[side].places(), side));
        let corner_parameters = [0, 1].map(|side| {
            let places: Vec<f64> = corners(curves[side]).iter().map(|c| c.0).collect();
            common.sorted_parameters(&places, side)
        });
        let mut knots = vec![[0.0; 3], [1.0; 3]];
        for pin in &self.pins {
            insert(&mut knots, [0, 1].map(|s| common.parameter(pin[s], s)));
        }
        merge_nearest(&mut knots, &corner_parameters, SNAP_CORNERS);
        merge_nearest(&mut knots, &all_parameters, SNAP);
        let mut vertices: Vec<SharedVertex> = Vec::new();
        for side in 0..2 {
            let curve = curves[side];
            let own = (curve.places().iter().enumerate()).map(|(k, &at)| (at, curve.bends_at(k)));
            let pins = self.pins.iter().map(|pin| (pin[side], true));
            for (place, is_bend) in own.chain(pins) {
                let at = interpolate_knots(&knots, common.parameter(place, side), [side, BOTH]);
                let mut places = [None; 2];
                places[side] = Some(place);
                vertices.push(SharedVertex {
                    at,
                    places,
                    is_bend,
                });
            }
        }
        let mut vertices = merge_equal(vertices);
        if !vertices.iter().any(SharedVertex::is_fixed) {
            // On an outline with very many points, it may be that the outline bends at none of them
            // by more than the tolerance. Then treat all vertices as bends.
            vertices.iter_mut().for_each(|vertex| vertex.is_bend = true);
        }
        let straight = ProportionalMap::between(&vertices, |vertex| {
            [0, 1].map(|side| {
                let own = interpolate_knots(&knots, vertex.at, [BOTH, side]);
                vertex.places[side].unwrap_or_else(|| common.place(own, side, curves[side]))
            })
        });
        let vertices = subdivide_gaps(straight.placed_vertices(vertices), spacing);
        evaluate_polygons(&vertices, &straight, curves)
    }
}

/// Common parameter of both matched curves: the mean of the two arc lengths from the first knot,
/// each a fraction of its curve's length; in [0, 1].
struct CommonParameter {
    /// Knots, ascending; the last one is the first one a round later. Places and parameters
    /// increase by 1 with each round.
    knots: Vec<ParameterKnot>,
}

impl CommonParameter {
    /// Creates the common parameter of a match. It starts from 0 at a knot that is a vertex of both
    /// curves, if there is one.
    fn new(matched: &BoundaryMatch, curves: [&BoundaryCurve; 2]) -> Self {
        let mut knots = matched.knots.clone();
        let is_vertex = |place: f64, c: &BoundaryCurve| {
            c.places().binary_search_by(|p| p.total_cmp(&place)).is_ok()
        };
        let is_shared = |k: &[f64; 2]| is_vertex(k[0], curves[0]) && is_vertex(k[1], curves[1]);
        let projection = |k: &[f64; 2]| {
            let [p, q] = [0, 1].map(|side| curves[side].point_at(k[side]));
            (p + q).dot(SEAM_DIRECTION)
        };
        // Prefer a knot that is a vertex of both curves, so that the start adds no vertex. The
        // order is symmetric in the designs, so exchanging them gives exactly the same start.
        let order = |a: &[f64; 2], b: &[f64; 2]| {
            let by_sharing = is_shared(b).cmp(&is_shared(a));
            by_sharing.then(projection(a).total_cmp(&projection(b)))
        };
        let seam = (0..knots.len()).min_by(|&a, &b| order(&knots[a], &knots[b]));
        let seam = seam.unwrap_or(0);
        knots.rotate_left(seam);
        knots.push(knots[0].map(|place| place + 1.0));
        let start = knots[0];
        let last = knots.len() - 1;
        for (k, knot) in knots.iter_mut().enumerate() {
            for side in 0..2 {
                if k < last && knot[side] < start[side] {
                    knot[side] += 1.0;
                }
            }
        }
        let with_parameter = |[a, b]: [f64; 2]| [a, b, 0.5 * ((a - start[0]) + (b - start[1]))];
        Self {
            knots: knots.into_iter().map(with_parameter).collect(),
        }
    }

    /// Converts a place on one curve to the parameter that is common to both curves.
    fn parameter(&self, place: f64, side: usize) -> f64 {
        let round = f64::from(u8::from(place < self.knots[0][side]));
        interpolate_knots(&self.knots, place + round, [side, BOTH])
    }

    /// Converts a value of the parameter that is common to both curves to a place on one of them.
    fn place(&self, parameter: f64, side: usize, curve: &BoundaryCurve) -> f64 {
        curve.wrapped(interpolate_knots(&self.knots, parameter, [BOTH, side]))
    }

    /// Converts places on one curve to values of the parameter that is common to both curves. The
    /// result ascends.
    fn sorted_parameters(&self, places: &[f64], side: usize) -> Vec<f64> {
        let mut parameters: Vec<f64> = places.iter().map(|&p| self.parameter(p, side)).collect();
        parameters.sort_by(f64::total_cmp);
        parameters
    }
}

/// Inserts a pair of parameters, `[source, target]`, as a knot in order, unless it would cross or
/// touch another knot.
fn insert(knots: &mut Vec<ParameterKnot>, [a, b]: [f64; 2]) {
    let knot = [a, b, a.midpoint(b)];
    let index = knots.partition_point(|j| j[0] < a);
    let fits = |k: usize| (0..2).all(|s| knots[k - 1][s] < knot[s] && knot[s] < knots[k][s]);
    if index > 0 && index < knots.len() && fits(index) {
        knots.insert(index, knot);
    }
}

/// Adds knots that merge pairs of vertices, one vertex of each curve. Two vertices are merged on
/// three conditions: under the current knots, each is the vertex of its curve that is nearest to
/// the other one; their parameters differ by at most `limit`; and both lie between the same two
/// knots.
fn merge_nearest(knots: &mut Vec<ParameterKnot>, parameters: &[Vec<f64>; 2], limit: f64) {
    let warped = [0, 1].map(|side| -> Vec<f64> {
        let warped = |&t: &f64| interpolate_knots(knots, t, [side, BOTH]);
        parameters[side].iter().map(warped).collect()
    });
    let mut pairs = Vec::new();
    for (k, &parameter) in warped[0].iter().enumerate() {
        let Some(other) = nearest_index(&warped[1], parameter) else {
            continue;
        };
        // Require that each is the other's nearest: otherwise two vertices could merge with the
        // same one.
        let is_mutual = nearest_index(&warped[0], warped[1][other]) == Some(k);
        if is_mutual && (parameter - warped[1][other]).abs() <= limit {
            pairs.push([parameters[0][k], parameters[1][other]]);
        }
    }
    for pair in pairs {
        insert(knots, pair);
    }
}

/// Returns the index of the value nearest to `at` in an ascending list; ties go to the smaller
/// value.
fn nearest_index(list: &[f64], at: f64) -> Option<usize> {
    let after = list.partition_point(|&x| x < at);
    let candidates = after.saturating_sub(1)..(after + 1).min(list.len());
    candidates.min_by(|&a, &b| (list[a] - at).abs().total_cmp(&(list[b] - at).abs()))
}

/// Sorts the vertices by the parameter that is common to both curves, and merges those with equal
/// parameters.
fn merge_equal(mut vertices: Vec<SharedVertex>) -> Vec<SharedVertex> {
    // Parameters 0 and 1 are the same place.
    for vertex in &mut vertices {
        if vertex.at >= 1.0 - SAME_PARAMETER {
            vertex.at = 0.0;
        }
    }
    vertices.sort_by(|a, b| a.at.total_cmp(&b.at));
    let mut merged: Vec<SharedVertex> = Vec::with_capacity(vertices.len());
    for vertex in vertices {
        match merged.last_mut() {
            Some(last) if vertex.at - last.at <= SAME_PARAMETER => {
                for side in 0..2 {
                    last.places[side] = last.places[side].or(vertex.places[side]);
                }
                last.is_bend |= vertex.is_bend;
            }
            _ => merged.push(vertex),
        }
    }
    merged
}

/// Adds evenly spaced vertices between neighbours whose common parameters differ by more than
/// `spacing`.
fn subdivide_gaps(vertices: Vec<SharedVertex>, spacing: f64) -> Vec<SharedVertex> {
    let mut spaced = Vec::with_capacity(vertices.len());
    for (k, &vertex) in vertices.iter().enumerate() {
        spaced.push(vertex);
        let next = vertices
            .get(k + 1)
            .map_or(vertices[0].at + 1.0, |next| next.at);
        let gap = next - vertex.at;
        let pieces = (gap / spacing).ceil().clamp(1.0, 1.0 + MAX_ADDED * gap) as u32;
        let at = |k: u32| vertex.at + gap * f64::from(k) / f64::from(pieces);
        let places = [None; 2];
        spaced.extend((1..pieces).map(|k| SharedVertex {
            at: at(k),
            places,
            is_bend: false,
        }));
    }
    spaced
}

/// Computes the position of each vertex on both curves. A vertex that coincides with the previous
/// one on either curve is omitted.
fn evaluate_polygons(
    vertices: &[SharedVertex],
    straight: &ProportionalMap,
    curves: [&BoundaryCurve; 2],
) -> SharedPolygons {
    let mut shared = SharedPolygons {
        source: Vec::with_capacity(vertices.len()),
        target: Vec::with_capacity(vertices.len()),
        places: Vec::with_capacity(vertices.len()),
    };
    for vertex in vertices {
        let places = [0, 1].map(|side| {
            let interpolated_place = || straight.place(vertex.at, side, curves[side]);
            vertex.places[side].unwrap_or_else(interpolated_place)
        });
        let (p, q) = (curves[0].point_at(places[0]), curves[1].point_at(places[1]));
        if shared.source.last() != Some(&p) && shared.target.last() != Some(&q) {
            shared.source.push(p);
            shared.target.push(q);
            shared.places.push(places);
        }
    }
    // The polygons are closed, so the last vertex must differ from the first one too.
    while shared.source.len() > 3 && closes_twice(&shared) {
        shared.source.pop();
        shared.target.pop();
        shared.places.pop();
    }
    shared
}

/// Returns whether the last vertex coincides with the first one in either polygon.
fn closes_twice(shared: &SharedPolygons) -> bool {
    shared.source.first() == shared.source.last() || shared.target.first() == shared.target.last()
}
