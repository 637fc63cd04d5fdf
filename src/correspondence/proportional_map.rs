//! Mapping between the places of two matched curves that keeps straight sides straight. Also
//! defines the vertices that the two polygons made from the curves will share.

use super::boundary_match::interpolate_knots;
use super::curve::BoundaryCurve;

/// Knot `[source, target, parameter]`: a pair of corresponding places (fractions of arc length) and
/// their common parameter. This parameter measures how far along both curves the pair lies; it
/// increases by 1 with each round.
pub(super) type ParameterKnot = [f64; 3];

/// Column of the common parameter in a [`ParameterKnot`].
pub(super) const BOTH: usize = 2;

/// A vertex that both polygons will have, at one value of the parameter that is common to both
/// curves. It has its own place on each curve of which it is a vertex or a pin.
#[derive(Clone, Copy)]
pub(super) struct SharedVertex {
    /// Parameter of the vertex, common to both curves, in [0, 1).
    pub at: f64,
    /// Places on the source and on the target; `None` where the place follows from the parameter.
    pub places: [Option<f64>; 2],
    /// Whether the vertex is a pin or a point at which one of the outlines bends.
    pub is_bend: bool,
}

impl SharedVertex {
    /// Returns whether the vertex is a knot of the [`ProportionalMap`]: a bend, a pin, or a vertex
    /// of both curves.
    pub fn is_fixed(&self) -> bool {
        self.is_bend || self.places.iter().all(Option::is_some)
    }
}

/// Mapping between corresponding places that keeps straight sides straight: it is linear in arc
/// length between fixed vertices (bends, pins, and vertices of both curves).
pub(super) struct ProportionalMap {
    /// Places and parameters of the fixed vertices, ascending; the last vertex is the first one a
    /// round later. Places and parameters increase by 1 with each round.
    bends: Vec<ParameterKnot>,
}

impl ProportionalMap {
    /// Creates the mapping that connects those of `vertices` that are fixed. `places` returns the
    /// places of a vertex, `[source, target]`.
    pub fn between(vertices: &[SharedVertex], places: impl Fn(&SharedVertex) -> [f64; 2]) -> Self {
        let mut bends: Vec<ParameterKnot> = Vec::with_capacity(vertices.len() + 1);
        for vertex in vertices.iter().filter(|vertex| vertex.is_fixed()) {
            let [mut a, mut b] = places(vertex);
            if let Some(first) = bends.first() {
                a += f64::from(u8::from(a < first[0]));
                b += f64::from(u8::from(b < first[1]));
            }
            // Skip knots that rounding has put out of order.
            if bends.last().is_none_or(|last| last[0] < a && last[1] < b) {
                bends.push([a, b, vertex.at]);
            }
        }
        bends.extend(bends.first().map(|first| first.map(|at| at + 1.0)));
        Self { bends }
    }

    /// Gives each vertex that is not fixed the parameter at which the mapping reaches its place,
    /// and sorts the vertices by parameter.
    pub fn placed_vertices(&self, mut vertices: Vec<SharedVertex>) -> Vec<SharedVertex> {
        for vertex in vertices.iter_mut().filter(|vertex| !vertex.is_fixed()) {
            let own = (0..2).find_map(|side| Some((side, vertex.places[side]?)));
            if let Some((side, place)) = own {
                let round = f64::from(u8::from(place < self.bends[0][side]));
                vertex.at = interpolate_knots(&self.bends, place + round, [side, BOTH]);
            }
        }
        vertices.sort_by(|a, b| a.at.total_cmp(&b.at));
        vertices
    }

    /// Returns the place on a curve at a common parameter. `side` is 0 for the source and 1 for the
    /// target.
    pub fn place(&self, at: f64, side: usize, curve: &BoundaryCurve) -> f64 {
        let at = at + f64::from(u8::from(at < self.bends[0][BOTH]));
        curve.wrapped(interpolate_knots(&self.bends, at, [BOTH, side]))
    }
}
