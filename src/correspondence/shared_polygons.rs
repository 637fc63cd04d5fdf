//! Two polygons with the same number of corresponding vertices.
//!
//! Every vertex of either curve is a vertex of both. A vertex of one curve and
//! one of the other that lie close to the same place are taken as one,
//! corners first: else each pair of corners, matched to within a fraction of
//! a sample, would leave a tiny edge.
//!
//! Both polygons run on their curves exactly, since all of a curve's own
//! points are kept bit by bit and what is added lies on its edges, to
//! rounding. Whoever wants fewer vertices simplifies the curves first.

use super::boundary_match::{BoundaryMatch, interpolated};
use super::curve::BoundaryCurve;
use super::proportional_map::{BOTH, ParameterKnot, ProportionalMap, SharedVertex};
use super::samples::corners;
use crate::geometry::DVec2;

/// Corners of the two curves nearer than this become one vertex, in fractions
/// of the curves' length.
const SNAP_CORNERS: f64 = 0.008;

/// Other vertices nearer than this become one.
const SNAP: f64 = 0.0025;

/// Corresponding vertices: as many in the source as in the target, no two
/// neighbours in the same point.
#[derive(Clone, Debug, PartialEq)]
pub struct SharedPolygons {
    /// Vertices on the source.
    pub source: Vec<DVec2>,
    /// Vertices on the target.
    pub target: Vec<DVec2>,
    /// Their places, `[source, target]`.
    pub places: Vec<[f64; 2]>,
}

/// Gap of the common parameter below which two vertices are one.
const SAME: f64 = 1e-12;

/// A direction along which no drawing lies.
const ASKEW: DVec2 = DVec2::new(0.754_877_666, 0.569_840_291);

/// Most that spacing may add, whatever it says.
const MOST_ADDED: f64 = 1e5;

impl BoundaryMatch {
    /// Both curves as polygons with corresponding vertices, in order. The
    /// curves must be those that were matched. No two neighbours are farther
    /// apart than `spacing`, as a fraction of the mean length of the two;
    /// infinite to add no vertices.
    #[must_use]
    pub fn polygons(
        &self,
        source: &BoundaryCurve,
        target: &BoundaryCurve,
        spacing: f64,
    ) -> SharedPolygons {
        let curves = [source, target];
        let common = CommonParameter::new(self, curves);
        let all = [0, 1].map(|side| common.own(curves[side].places(), side));
        let sharp = [0, 1].map(|side| {
            let places: Vec<f64> = corners(curves[side]).iter().map(|c| c.0).collect();
            common.own(&places, side)
        });
        let mut joints = vec![[0.0; 3], [1.0; 3]];
        for pin in &self.pins {
            insert(&mut joints, [0, 1].map(|s| common.parameter(pin[s], s)));
        }
        join(&mut joints, &sharp, SNAP_CORNERS);
        join(&mut joints, &all, SNAP);
        let mut vertices: Vec<SharedVertex> = Vec::new();
        for side in 0..2 {
            let curve = curves[side];
            let own = (curve.places().iter().enumerate()).map(|(k, &at)| (at, curve.bends_at(k)));
            let pins = self.pins.iter().map(|pin| (pin[side], true));
            for (place, is_bend) in own.chain(pins) {
                let at = interpolated(&joints, common.parameter(place, side), [side, BOTH]);
                let mut places = [None; 2];
                places[side] = Some(place);
                vertices.push(SharedVertex {
                    at,
                    places,
                    is_bend,
                });
            }
        }
        let mut vertices = merged(vertices);
        if !vertices.iter().any(SharedVertex::is_fixed) {
            // So many points that none bends.
            vertices.iter_mut().for_each(|vertex| vertex.is_bend = true);
        }
        let straight = ProportionalMap::between(&vertices, |vertex| {
            [0, 1].map(|side| {
                let own = interpolated(&joints, vertex.at, [BOTH, side]);
                vertex.places[side].unwrap_or_else(|| common.place(own, side, curves[side]))
            })
        });
        let vertices = spaced(straight.laid(vertices), spacing);
        assembled(&vertices, &straight, curves)
    }
}

/// The common parameter of both curves: the mean of the lengths walked from
/// the first knot on, in [0, 1].
struct CommonParameter {
    knots: Vec<ParameterKnot>,
}

impl CommonParameter {
    /// The seam lies at a knot that is a point of both curves, if there is one.
    fn new(matched: &BoundaryMatch, curves: [&BoundaryCurve; 2]) -> Self {
        let mut knots = matched.knots.clone();
        let is_own = |place: f64, c: &BoundaryCurve| {
            c.places().binary_search_by(|p| p.total_cmp(&place)).is_ok()
        };
        let both = |k: &[f64; 2]| is_own(k[0], curves[0]) && is_own(k[1], curves[1]);
        let along = |k: &[f64; 2]| {
            let [p, q] = [0, 1].map(|side| curves[side].point_at(k[side]));
            (p + q).dot(ASKEW)
        };
        // Of points of both, so that the seam adds no vertex of its own; and
        // the same for the designs exchanged, to the last bit.
        let order = |a: &[f64; 2], b: &[f64; 2]| {
            let is_other = both(b).cmp(&both(a));
            is_other.then(along(a).total_cmp(&along(b)))
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
        let joint = |[a, b]: [f64; 2]| [a, b, 0.5 * ((a - start[0]) + (b - start[1]))];
        Self {
            knots: knots.into_iter().map(joint).collect(),
        }
    }

    fn parameter(&self, place: f64, side: usize) -> f64 {
        let over = f64::from(u8::from(place < self.knots[0][side]));
        interpolated(&self.knots, place + over, [side, BOTH])
    }

    fn place(&self, parameter: f64, side: usize, curve: &BoundaryCurve) -> f64 {
        curve.wrapped(interpolated(&self.knots, parameter, [BOTH, side]))
    }

    /// Parameters of a curve's places, ascending.
    fn own(&self, places: &[f64], side: usize) -> Vec<f64> {
        let mut own: Vec<f64> = places.iter().map(|&p| self.parameter(p, side)).collect();
        own.sort_by(f64::total_cmp);
        own
    }
}

/// Inserts a joint in order, unless it would cross or touch another.
fn insert(joints: &mut Vec<ParameterKnot>, [a, b]: [f64; 2]) {
    let joint = [a, b, a.midpoint(b)];
    let at = joints.partition_point(|j| j[0] < a);
    let fits = |k: usize| (0..2).all(|s| joints[k - 1][s] < joint[s] && joint[s] < joints[k][s]);
    if at > 0 && at < joints.len() && fits(at) {
        joints.insert(at, joint);
    }
}

/// Joins vertices that are each other's nearest, as the joints so far bend
/// the parameter, and within `limit` and the joints on either side.
fn join(joints: &mut Vec<ParameterKnot>, own: &[Vec<f64>; 2], limit: f64) {
    let bent = [0, 1].map(|side| -> Vec<f64> {
        let bent = |&t: &f64| interpolated(joints, t, [side, BOTH]);
        own[side].iter().map(bent).collect()
    });
    let mut found = Vec::new();
    for (k, &at) in bent[0].iter().enumerate() {
        let Some(other) = nearest(&bent[1], at) else {
            continue;
        };
        // Mutual, or two vertices would be joined to one.
        let mutual = nearest(&bent[0], bent[1][other]) == Some(k);
        if mutual && (at - bent[1][other]).abs() <= limit {
            found.push([own[0][k], own[1][other]]);
        }
    }
    for joint in found {
        insert(joints, joint);
    }
}

/// Index of the value nearest to `at` in an ascending list, the first of two.
fn nearest(list: &[f64], at: f64) -> Option<usize> {
    let after = list.partition_point(|&x| x < at);
    let candidates = after.saturating_sub(1)..(after + 1).min(list.len());
    candidates.min_by(|&a, &b| (list[a] - at).abs().total_cmp(&(list[b] - at).abs()))
}

/// In order, with vertices at the same parameter as one.
fn merged(mut vertices: Vec<SharedVertex>) -> Vec<SharedVertex> {
    // The seam is one place.
    for vertex in &mut vertices {
        if vertex.at >= 1.0 - SAME {
            vertex.at = 0.0;
        }
    }
    vertices.sort_by(|a, b| a.at.total_cmp(&b.at));
    let mut merged: Vec<SharedVertex> = Vec::with_capacity(vertices.len());
    for vertex in vertices {
        match merged.last_mut() {
            Some(last) if vertex.at - last.at <= SAME => {
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

/// With even places between neighbours that are too far apart.
fn spaced(vertices: Vec<SharedVertex>, spacing: f64) -> Vec<SharedVertex> {
    let mut spaced = Vec::with_capacity(vertices.len());
    for (k, &vertex) in vertices.iter().enumerate() {
        spaced.push(vertex);
        let next = vertices
            .get(k + 1)
            .map_or(vertices[0].at + 1.0, |next| next.at);
        let gap = next - vertex.at;
        let pieces = (gap / spacing).ceil().clamp(1.0, 1.0 + MOST_ADDED * gap) as u32;
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

fn assembled(
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
            let made = || straight.place(vertex.at, side, curves[side]);
            vertex.places[side].unwrap_or_else(made)
        });
        let (p, q) = (curves[0].point_at(places[0]), curves[1].point_at(places[1]));
        if shared.source.last() != Some(&p) && shared.target.last() != Some(&q) {
            shared.source.push(p);
            shared.target.push(q);
            shared.places.push(places);
        }
    }
    // The last vertex has the first as its neighbour.
    while shared.source.len() > 3 && closes_twice(&shared) {
        shared.source.pop();
        shared.target.pop();
        shared.places.pop();
    }
    shared
}

fn closes_twice(shared: &SharedPolygons) -> bool {
    shared.source.first() == shared.source.last() || shared.target.first() == shared.target.last()
}
