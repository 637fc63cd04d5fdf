//! Vertices of two polygons in correspondence, and what lies straight between
//! them.

use super::boundary_match::interpolated;
use super::curve::BoundaryCurve;

/// Two places that are one: that of the source, that of the target, and the
/// parameter that both have.
pub(super) type ParameterKnot = [f64; 3];

/// The column of the parameter.
pub(super) const BOTH: usize = 2;

/// A vertex to come: its common parameter and, where it is a curve's own
/// point or a pin, its place.
#[derive(Clone, Copy)]
pub(super) struct SharedVertex {
    pub at: f64,
    pub places: [Option<f64>; 2],
    /// Whether an outline bends there, or somebody pinned it.
    pub is_bend: bool,
}

impl SharedVertex {
    /// Whether its partner is where the match has it.
    pub fn is_fixed(&self) -> bool {
        self.is_bend || self.places.iter().all(Option::is_some)
    }
}

/// Straight sides stay straight where both are: between vertices at which one
/// of the outlines bends, or which both have, the match is proportional.
pub(super) struct ProportionalMap {
    /// The places of those vertices, counted on over the seam, and their
    /// parameters; the first again at the end.
    bends: Vec<ParameterKnot>,
}

impl ProportionalMap {
    pub fn between(vertices: &[SharedVertex], places: impl Fn(&SharedVertex) -> [f64; 2]) -> Self {
        let mut bends: Vec<ParameterKnot> = Vec::with_capacity(vertices.len() + 1);
        for vertex in vertices.iter().filter(|vertex| vertex.is_fixed()) {
            let [mut a, mut b] = places(vertex);
            if let Some(first) = bends.first() {
                a += f64::from(u8::from(a < first[0]));
                b += f64::from(u8::from(b < first[1]));
            }
            // Rounding must not make a step back.
            if bends.last().is_none_or(|last| last[0] < a && last[1] < b) {
                bends.push([a, b, vertex.at]);
            }
        }
        bends.extend(bends.first().map(|first| first.map(|at| at + 1.0)));
        Self { bends }
    }

    /// The vertices, those between bends at the parameters of their own places.
    pub fn laid(&self, mut vertices: Vec<SharedVertex>) -> Vec<SharedVertex> {
        for vertex in vertices.iter_mut().filter(|vertex| !vertex.is_fixed()) {
            let own = (0..2).find_map(|side| Some((side, vertex.places[side]?)));
            if let Some((side, place)) = own {
                let over = f64::from(u8::from(place < self.bends[0][side]));
                vertex.at = interpolated(&self.bends, place + over, [side, BOTH]);
            }
        }
        vertices.sort_by(|a, b| a.at.total_cmp(&b.at));
        vertices
    }

    pub fn place(&self, at: f64, side: usize, curve: &BoundaryCurve) -> f64 {
        let at = at + f64::from(u8::from(at < self.bends[0][BOTH]));
        curve.wrapped(interpolated(&self.bends, at, [BOTH, side]))
    }
}
