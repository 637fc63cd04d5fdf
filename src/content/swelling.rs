//! Parts that one design has alone, and that come in their own shape: as lines
//! at first, which swell to what was drawn.
//!
//! Such a part keeps within its own outline all the time, so that it is in
//! nobody's way who keeps out of that.

use crate::geometry::{DVec2, inradius, inset};
use crate::warp::TimeWindow;

/// A part of one design that swells, in the stead of some boundary walks.
#[derive(Clone, Debug, PartialEq)]
pub struct SwellingShape {
    /// The walks in whose stead it is drawn, by their numbers; the first goes
    /// around the others.
    walks: Vec<usize>,
    /// As it is drawn, about the middle of the first walk.
    rings: Vec<Vec<DVec2>>,
    /// How far a boundary moves inwards until nothing is left.
    depth: f64,
    /// When it swells.
    life: TimeWindow,
}

impl SwellingShape {
    /// A part of walks with these numbers that are these rings in the design that has it,
    /// the outer one first.
    #[must_use]
    pub fn new(walks: Vec<usize>, rings: &[Vec<DVec2>], life: TimeWindow) -> Self {
        let middle = rings.first().map_or(DVec2::ZERO, |ring| middle(ring));
        let about = |ring: &Vec<DVec2>| ring.iter().map(|&p| p - middle).collect();
        Self {
            walks,
            depth: inradius(rings),
            rings: rings.iter().map(about).collect(),
            life,
        }
    }

    /// The walks in whose stead it is drawn.
    pub(crate) fn walks(&self) -> &[usize] {
        &self.walks
    }

    /// How much of its thickness it has at `t`.
    pub(crate) fn share(&self, t: f64) -> f64 {
        self.life.size(t)
    }

    /// Its rings at `t`, when the first of its walks is at these places; none
    /// where it is gone.
    #[must_use]
    pub fn at(&self, first_walk: &[DVec2], t: f64) -> Vec<Vec<DVec2>> {
        let share = self.share(t);
        if share <= 0.0 {
            return Vec::new();
        }
        let middle = middle(first_walk);
        let mut rings = inset(&self.rings, self.depth * (1.0 - share));
        rings.iter_mut().flatten().for_each(|p| *p += middle);
        rings
    }
}

/// The mean of some points.
pub(crate) fn middle(points: &[DVec2]) -> DVec2 {
    let about = points.first().copied().unwrap_or_default();
    let sum: DVec2 = points.iter().map(|&p| p - about).sum();
    about + sum / points.len().max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Side;

    #[test]
    fn a_part_swells_within_its_outline() {
        let ring = |r: f64| {
            [(-r, -r), (r, -r), (r, r), (-r, r)]
                .map(DVec2::from)
                .to_vec()
        };
        let hole: Vec<DVec2> = ring(2.0).into_iter().rev().collect();
        let life = TimeWindow {
            from: 0.5,
            ..TimeWindow::whole(Side::Target)
        };
        let frame = SwellingShape::new(vec![3, 4], &[ring(4.0), hole], life);
        let away = DVec2::new(10.0, 0.0);
        // As small as it may be where it is not there: its middle counts.
        let walk: Vec<DVec2> = ring(0.01).into_iter().map(|p| p + away).collect();
        assert!(frame.at(&walk, 0.5).is_empty());
        let half = frame.at(&walk, 2.0 / 3.0);
        assert_eq!(half.len(), 2);
        let reach = |p: &DVec2| (*p - away).abs().max_element();
        assert!(
            half.iter()
                .flatten()
                .all(|p| (2.4..3.6).contains(&reach(p)))
        );
        let whole = frame.at(&walk, 1.0);
        assert!(whole[0].iter().all(|p| (reach(p) - 4.0).abs() < 1e-6));
    }
}
