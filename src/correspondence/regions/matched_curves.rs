//! A pair of matched curves and the places (arc-length positions) of their shared vertices. It is
//! stored with a matched ring, so that the vertices can be moved along the curves later.

use super::super::boundary_match::BoundaryMatch;
use super::super::curve::BoundaryCurve;
use super::super::knot_order::{is_pin, ordered_knots};
use super::super::shared_polygons::SharedPolygons;
use super::slit_vertices::mirror_slit_vertices;
use crate::geometry::{DVec2, Side};

/// A pair of matched curves with the places of the shared vertices.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct MatchedCurves {
    curves: [BoundaryCurve; 2],
    matched: BoundaryMatch,
    /// Maximum edge length of the two polygons that consist of the shared vertices, as a fraction
    /// of the curves' mean length.
    spacing: f64,
    /// For each design: both ends of each slit (a straight cut from a hole to another boundary).
    /// The curve runs along each slit in both directions.
    slits: [Vec<[DVec2; 2]>; 2],
    /// Places `[source, target]` of the ring's vertices on the two curves, as fractions of arc
    /// length.
    places: Vec<[f64; 2]>,
}

impl MatchedCurves {
    /// Stores two matched curves, and creates the two polygons with corresponding vertices along
    /// them.
    pub(super) fn new(
        curves: [BoundaryCurve; 2],
        matched: BoundaryMatch,
        spacing: f64,
        slits: [Vec<[DVec2; 2]>; 2],
    ) -> (Self, SharedPolygons) {
        let mut shared = matched.polygons(&curves[0], &curves[1], spacing);
        for side in Side::BOTH {
            // The curve passes along a slit twice, and both passages need the same vertices.
            for &slit in &slits[side] {
                let other = &curves[side.other()];
                mirror_slit_vertices(&mut shared, side, &curves[side], slit, other);
            }
        }
        let pair = Self {
            curves,
            matched,
            spacing,
            slits,
            places: shared.places.clone(),
        };
        (pair, shared)
    }

    /// Returns the two curves, source and target.
    pub(crate) fn curves(&self) -> &[BoundaryCurve; 2] {
        &self.curves
    }

    /// Returns the places `[source, target]` of the ring's vertices on the two curves, as fractions
    /// of arc length.
    pub(crate) fn places(&self) -> &[[f64; 2]] {
        &self.places
    }

    /// Returns whether the vertex with this index is a pin.
    pub(crate) fn is_pinned(&self, vertex: usize) -> bool {
        is_pin(&self.matched.pins, self.places[vertex])
    }

    /// Returns these curves with the shared vertices moved to other places. `places` holds the new
    /// place of each vertex, which must be close to its old one. Vertices that would break
    /// monotonicity are omitted, except pins.
    pub(super) fn with_places(&self, places: &[[f64; 2]]) -> (Self, SharedPolygons) {
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
