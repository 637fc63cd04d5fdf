//! Two closed curves on which it is known what is matched with what, and the
//! ring that follows: as long as the curves are kept, the match can be moved.

use super::super::boundary_match::BoundaryMatch;
use super::super::curve::BoundaryCurve;
use super::super::knot_order::{is_pin, ordered_knots};
use super::super::shared_polygons::SharedPolygons;
use super::slit_vertices::mirror_slit_vertices;
use crate::geometry::{DVec2, Side};

/// Two matched curves.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct MatchedCurves {
    curves: [BoundaryCurve; 2],
    matched: BoundaryMatch,
    /// Longest step between vertices, as a share of the mean length.
    spacing: f64,
    /// For each design the slits that its curve runs along twice.
    slits: [Vec<[DVec2; 2]>; 2],
    /// The places of the ring's vertices, `[source, target]`.
    places: Vec<[f64; 2]>,
}

impl MatchedCurves {
    /// Both curves, each with the slits that it runs along, and the vertices
    /// of the ring along them.
    pub(super) fn new(
        curves: [BoundaryCurve; 2],
        matched: BoundaryMatch,
        spacing: f64,
        slits: [Vec<[DVec2; 2]>; 2],
    ) -> (Self, SharedPolygons) {
        let mut shared = matched.polygons(&curves[0], &curves[1], spacing);
        for side in Side::BOTH {
            for &slit in &slits[side] {
                let other = &curves[side.other()];
                mirror_slit_vertices(&mut shared, side, &curves[side], slit, other);
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

    pub(crate) fn curves(&self) -> &[BoundaryCurve; 2] {
        &self.curves
    }

    /// The places of the ring's vertices, `[source, target]`.
    pub(crate) fn places(&self) -> &[[f64; 2]] {
        &self.places
    }

    /// Whether somebody pinned this vertex.
    pub(crate) fn is_pinned(&self, vertex: usize) -> bool {
        is_pin(&self.matched.pins, self.places[vertex])
    }

    /// The same once its vertices belong to other places, as many as it has
    /// and near where they were. What would step back is left out, pins never.
    pub(super) fn moved(&self, places: &[[f64; 2]]) -> (Self, SharedPolygons) {
        let wrapped = |place: &[f64; 2]| [0, 1].map(|side| self.curves[side].wrapped(place[side]));
        let places: Vec<[f64; 2]> = places.iter().map(wrapped).collect();
        let mut matched = self.matched.clone();
        matched.knots = ordered_knots(&self.places, &places, &matched.pins);
        Self::new(
            self.curves.clone(),
            matched,
            self.spacing,
            self.slits.clone(),
        )
    }
}
