//! One matched ring (outline or hole) at its positions in both designs.

use crate::app::editing::polyline;
use crate::correspondence::{PointPair, RingKind};
use crate::geometry::DVec2;

/// A ring in both designs; vertex k of the source is matched with vertex k of the target.
#[derive(Clone, Debug, PartialEq)]
pub struct SheetRing {
    /// Index of the piece that the ring belongs to.
    pub piece: usize,
    /// Whether the ring is matched, closes to a point, or opens from one.
    pub kind: RingKind,
    /// Vertices in the source and in the target.
    pub sides: [Vec<DVec2>; 2],
    /// Arc-length position of each vertex, 0 to 1. For a matched ring, this is the mean of both
    /// designs; for a ring that is a single point in one design, the position in the other design.
    pub positions: Vec<f64>,
}

impl SheetRing {
    /// Creates a ring and computes its arc-length positions.
    #[must_use]
    pub fn new(piece: usize, kind: RingKind, sides: [Vec<DVec2>; 2]) -> Self {
        let [(source, _), (target, _)] =
            [0, 1].map(|k: usize| polyline::arc_length_positions(&sides[k]));
        // A ring that closes or opens is a point in one design, where all positions are 0.
        let places = match kind {
            RingKind::Closes => source,
            RingKind::Opens => target,
            RingKind::Matched => {
                let both = source.iter().zip(&target);
                both.map(|(a, b)| 0.5 * (a + b)).collect()
            }
        };
        Self {
            piece,
            kind,
            sides,
            positions: places,
        }
    }

    /// Mean of the ring's lengths in both designs.
    #[must_use]
    pub fn length(&self) -> f64 {
        let [a, b] = [0, 1].map(|k: usize| polyline::arc_length_positions(&self.sides[k]).1);
        0.5 * (a + b)
    }

    /// Arc-length position of the vertex before a pin; `None` if the pin's source point is not on
    /// the ring.
    #[must_use]
    pub fn position_of(&self, pin: &PointPair) -> Option<f64> {
        let foot = polyline::nearest([self.sides[0].as_slice()].into_iter(), pin.source)?;
        // Pins lie on the boundary up to rounding in the design's own coordinates; a thousandth of
        // the ring is far less than a user can aim at (tolerance).
        let is_on = foot.distance <= 1e-3 * self.length();
        is_on.then(|| self.positions[foot.edge])
    }
}
