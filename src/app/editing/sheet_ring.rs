//! One ring of the match, as it lies in both designs.

use crate::app::editing::polyline;
use crate::correspondence::{PointPair, RingKind};
use crate::geometry::DVec2;

/// One ring in both designs, vertex by vertex.
#[derive(Clone, Debug, PartialEq)]
pub struct SheetRing {
    /// The piece that it belongs to.
    pub piece: usize,
    /// What becomes of it.
    pub kind: RingKind,
    /// In the source and in the target.
    pub sides: [Vec<DVec2>; 2],
    /// How far along it each vertex lies, 0 to 1; the same for both sides.
    pub places: Vec<f64>,
}

impl SheetRing {
    /// A ring with its places.
    #[must_use]
    pub fn new(piece: usize, kind: RingKind, sides: [Vec<DVec2>; 2]) -> Self {
        let [(source, _), (target, _)] = [0, 1].map(|k: usize| polyline::places(&sides[k]));
        // A ring that comes or goes is a point on one side, where all its places are 0.
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
            places,
        }
    }

    /// How long it is, the mean of both sides.
    #[must_use]
    pub fn length(&self) -> f64 {
        let [a, b] = [0, 1].map(|k: usize| polyline::places(&self.sides[k]).1);
        0.5 * (a + b)
    }

    /// How far along it a pin lies, where it lies on it.
    #[must_use]
    pub fn place_of(&self, pin: &PointPair) -> Option<f64> {
        let foot = polyline::nearest([self.sides[0].as_slice()].into_iter(), pin.source)?;
        // Pins were put onto the boundary, but were rounded on the way through the design's own
        // coordinates; a thousandth of the ring is far below what a hand can aim at.
        let is_on = foot.distance <= 1e-3 * self.length();
        is_on.then(|| self.places[foot.edge])
    }
}
