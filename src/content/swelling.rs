//! Swelling shapes: parts that exist in only one design and enter as thin lines, which swell to the
//! full shape of the part.
//!
//! A swelling shape is an inset of the part's own outline: its boundary is moved inwards. It
//! therefore never leaves that outline and cannot collide with anything outside it.

use crate::geometry::{DVec2, inradius, inset};
use crate::warp::TimeWindow;

/// Part that exists in only one design and swells from thin lines. While it swells, it is drawn
/// instead of the part's boundary loops.
#[derive(Clone, Debug, PartialEq)]
pub struct SwellingShape {
    /// Indices of the part's boundary loops, which are not drawn while the part swells. The first
    /// loop encloses the others.
    loop_indices: Vec<usize>,
    /// Rings of the full shape, relative to the mean of the points of the first ring.
    rings: Vec<Vec<DVec2>>,
    /// Inset depth at which nothing of the shape is left, in units of the design.
    depth: f64,
    /// Time window in which the part swells.
    window: TimeWindow,
}

impl SwellingShape {
    /// Creates a swelling part. While it swells, the boundary loops with the indices `loop_indices`
    /// are not drawn. `rings` contains the same loops as they are in the design that has the part,
    /// the outer one first.
    #[must_use]
    pub fn new(loop_indices: Vec<usize>, rings: &[Vec<DVec2>], window: TimeWindow) -> Self {
        let middle = rings.first().map_or(DVec2::ZERO, |ring| mean_point(ring));
        let relative = |ring: &Vec<DVec2>| ring.iter().map(|&p| p - middle).collect();
        Self {
            loop_indices,
            depth: inradius(rings),
            rings: rings.iter().map(relative).collect(),
            window,
        }
    }

    /// Indices of the part's boundary loops, which are not drawn while the part swells.
    pub(crate) fn loop_indices(&self) -> &[usize] {
        &self.loop_indices
    }

    /// Thickness of the part as a fraction of its full thickness, from 0 to 1. `t` is the part's
    /// own time: the t of the transition, converted by the part's clock if it has one.
    pub(crate) fn thickness_fraction(&self, t: f64) -> f64 {
        self.window.size(t)
    }

    /// Returns the rings of the part; none while the part is absent. `t` is the part's own time:
    /// the t of the transition, converted by the part's clock if it has one. `first_loop` contains
    /// the positions of the part's first boundary loop at the same moment. The shape is placed at
    /// the mean of these positions.
    #[must_use]
    pub fn rings_at(&self, first_loop: &[DVec2], t: f64) -> Vec<Vec<DVec2>> {
        let fraction = self.thickness_fraction(t);
        if fraction <= 0.0 {
            return Vec::new();
        }
        let middle = mean_point(first_loop);
        let mut rings = inset(&self.rings, self.depth * (1.0 - fraction));
        rings.iter_mut().flatten().for_each(|p| *p += middle);
        rings
    }
}

/// Returns the mean of some points; zero if there are none.
pub(crate) fn mean_point(points: &[DVec2]) -> DVec2 {
    // The sum is relative to the first point, so that points far from the origin lose no digits.
    let reference = points.first().copied().unwrap_or_default();
    let sum: DVec2 = points.iter().map(|&p| p - reference).sum();
    reference + sum / points.len().max(1) as f64
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
        let window = TimeWindow {
            from: 0.5,
            ..TimeWindow::whole(Side::Target)
        };
        let frame = SwellingShape::new(vec![3, 4], &[ring(4.0), hole], window);
        let away = DVec2::new(10.0, 0.0);
        // In the design that lacks the part, the boundary loop is a tiny ring. Only the mean of its
        // points matters.
        let tiny_loop: Vec<DVec2> = ring(0.01).into_iter().map(|p| p + away).collect();
        assert!(frame.rings_at(&tiny_loop, 0.5).is_empty());
        let half = frame.rings_at(&tiny_loop, 2.0 / 3.0);
        assert_eq!(half.len(), 2);
        let reach = |p: &DVec2| (*p - away).abs().max_element();
        assert!(
            half.iter()
                .flatten()
                .all(|p| (2.4..3.6).contains(&reach(p)))
        );
        let whole = frame.rings_at(&tiny_loop, 1.0);
        assert!(whole[0].iter().all(|p| (reach(p) - 4.0).abs() < 1e-6));
    }
}
