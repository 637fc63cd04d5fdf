//! Two closed curves on which it is known what is matched with what, and the
//! ring that follows: as long as the curves are kept, the match can be moved.

use super::super::boundary_match::BoundaryMatch;
use super::super::curve::Curve;
use super::super::polygons::SharedPolygons;
use super::slits::mirror;
use crate::geometry::{DVec2, Side};

/// The least step between places of a match that was moved, as a share of the
/// curve's length. Far below what is seen, far above rounding.
const LEAST_STEP: f64 = 1e-6;

/// Two matched curves.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Course {
    curves: [Curve; 2],
    matched: BoundaryMatch,
    /// Longest step between vertices, as a share of the mean length.
    spacing: f64,
    /// For each design the slits that its curve runs along twice.
    slits: [Vec<[DVec2; 2]>; 2],
    /// The places of the ring's vertices, `[source, target]`.
    places: Vec<[f64; 2]>,
}

impl Course {
    /// Both curves, each with the slits that it runs along, and the vertices
    /// of the ring along them.
    pub(super) fn new(
        curves: [Curve; 2],
        matched: BoundaryMatch,
        spacing: f64,
        slits: [Vec<[DVec2; 2]>; 2],
    ) -> (Self, SharedPolygons) {
        let mut shared = matched.polygons(&curves[0], &curves[1], spacing);
        for side in Side::BOTH {
            for &slit in &slits[side] {
                let other = &curves[side.other()];
                mirror(&mut shared, side, &curves[side], slit, other);
            }
        }
        let course = Self {
            curves,
            matched,
            spacing,
            slits,
            places: shared.places.clone(),
        };
        (course, shared)
    }

    pub(crate) fn curves(&self) -> &[Curve; 2] {
        &self.curves
    }

    /// The places of the ring's vertices, `[source, target]`.
    pub(crate) fn places(&self) -> &[[f64; 2]] {
        &self.places
    }

    /// Whether somebody pinned this vertex.
    pub(crate) fn is_pinned(&self, vertex: usize) -> bool {
        self.matched.pins.contains(&self.places[vertex])
    }

    /// The same once its vertices belong to other places, as many as it has
    /// and near where they were. What would step back is left out, pins last.
    pub(super) fn moved(&self, places: &[[f64; 2]]) -> (Self, SharedPolygons) {
        let mut matched = self.matched.clone();
        matched.knots = self.in_order(places);
        Self::new(
            self.curves.clone(),
            matched,
            self.spacing,
            self.slits.clone(),
        )
    }

    fn in_order(&self, places: &[[f64; 2]]) -> Vec<[f64; 2]> {
        let n = places.len();
        let start = (0..n).find(|&k| self.is_pinned(k)).unwrap_or(0);
        // Counted on from the start, so that ascending has a meaning.
        let mut last = [0.0; 2];
        let mut kept: Vec<(usize, [f64; 2])> = Vec::with_capacity(n);
        for offset in 0..n {
            let k = (start + offset) % n;
            // The shorter way from the one before: nothing moves by half a round.
            let at = [0, 1].map(|side| {
                let by = places[k][side] - places[start][side] - last[side];
                last[side] + (by - by.round())
            });
            let follows = |before: [f64; 2]| {
                (0..2).all(|s| before[s] + LEAST_STEP < at[s] && at[s] < 1.0 - LEAST_STEP)
            };
            if self.is_pinned(k) {
                while kept.len() > 1
                    && kept
                        .last()
                        .is_some_and(|l| !self.is_pinned(l.0) && !follows(l.1))
                {
                    kept.pop();
                }
            }
            if offset == 0 || kept.last().is_some_and(|before| follows(before.1)) {
                kept.push((k, at));
                last = at;
            }
        }
        let mut kept: Vec<[f64; 2]> = kept
            .into_iter()
            .map(|(k, _)| [0, 1].map(|side| self.curves[side].wrapped(places[k][side])))
            .collect();
        kept.sort_by(|a, b| a[0].total_cmp(&b[0]));
        kept
    }
}
