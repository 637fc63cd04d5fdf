//! Boundary rings of a piece (a matched connected part) in one design, and the check that these
//! rings bound exactly one connected region.

use super::error::{PieceEdge, PieceMeshError};
use super::ring_contacts::touching_edges;
use crate::geometry::{DVec2, Side, ring_edges, signed_area};
use crate::mesh::triangulation::{TriangulationError, constrained_delaunay};
use std::ops::Range;

/// Boundary rings of one piece in one design, stored in a single list of points. The outer ring
/// comes first, then the holes.
#[derive(Clone, Debug)]
pub(super) struct BoundaryRings {
    /// Points of all rings, ring after ring.
    pub(super) points: Vec<DVec2>,
    /// For each ring, the index range of its points.
    pub(super) ranges: Vec<Range<usize>>,
}

impl BoundaryRings {
    /// Concatenates rings; the outer ring must come first.
    pub(super) fn of<R: AsRef<[DVec2]>>(rings: &[R]) -> Self {
        let mut end = 0;
        let range = |ring: &R| {
            end += ring.as_ref().len();
            end - ring.as_ref().len()..end
        };
        Self {
            ranges: rings.iter().map(range).collect(),
            points: rings.iter().flat_map(|r| r.as_ref()).copied().collect(),
        }
    }

    /// Returns the rings with all coordinates multiplied by `by`.
    pub(super) fn scaled(&self, by: f64) -> Self {
        Self {
            points: self.points.iter().map(|&p| p * by).collect(),
            ranges: self.ranges.clone(),
        }
    }

    /// Points of each ring.
    pub(super) fn loops(&self) -> Vec<&[DVec2]> {
        let ranges = self.ranges.iter().cloned();
        ranges.map(|range| &self.points[range]).collect()
    }

    /// Returns the edge that starts at the point with the index `point` in the list of all points.
    pub(super) fn edge_at(&self, point: usize) -> PieceEdge {
        let holds = |range: &Range<usize>| range.contains(&point);
        let ring = self.ranges.iter().position(holds).unwrap_or(0);
        let edge = point - self.ranges[ring].start;
        PieceEdge { ring, edge }
    }
}

/// Checks that the rings bound one connected region: a counter-clockwise outer ring with clockwise
/// holes inside, where no edges touch except the two banks of a slit. O(n log n) for valid rings.
pub(super) fn validate_rings(rings: &BoundaryRings, side: Side) -> Result<(), PieceMeshError> {
    let loops = rings.loops();
    if loops.is_empty() {
        return Err(PieceMeshError::NoOutline);
    }
    if let Some(ring) = loops.iter().position(|ring| ring.len() < 3) {
        let points = loops[ring].len();
        return Err(PieceMeshError::TooFewPoints { ring, points });
    }
    if let Some(point) = rings.points.iter().position(|p| !p.is_finite()) {
        return Err(not_finite(rings, point, side));
    }
    // The triangulation detects any fault of the rings quickly. The slow search for the cause runs
    // only if the triangulation has failed.
    match constrained_delaunay(&loops) {
        Ok(_) => Ok(()),
        Err(TriangulationError::OutOfRange) => {
            // The point with the largest coordinate is the likeliest cause.
            let size = |p: &DVec2| p.abs().max_element();
            let farthest = (0..rings.points.len())
                .max_by(|&a, &b| size(&rings.points[a]).total_cmp(&size(&rings.points[b])));
            Err(not_finite(rings, farthest.unwrap_or(0), side))
        }
        Err(error) => Err(find_fault(rings, &loops, side, error)),
    }
}

/// Returns the error for a point whose coordinates are not finite or out of range.
fn not_finite(rings: &BoundaryRings, point: usize, side: Side) -> PieceMeshError {
    let PieceEdge { ring, edge } = rings.edge_at(point);
    PieceMeshError::NotFinite {
        side,
        ring,
        vertex: edge,
    }
}

/// Finds out, by slow tests, why the rings do not bound one connected region. `error` is the error
/// of the triangulation that detected the fault.
fn find_fault(
    rings: &BoundaryRings,
    loops: &[&[DVec2]],
    side: Side,
    error: TriangulationError,
) -> PieceMeshError {
    // Contacts are tested first, because rings that cross have no meaningful orientation.
    if let Some(edges) = touching_edges(loops) {
        return PieceMeshError::NotSimple {
            side,
            place: rings.points[edges[0]],
            edges: edges.map(|edge| rings.edge_at(edge)),
        };
    }
    if signed_area(loops[0]) < 0.0 {
        return PieceMeshError::Clockwise(side);
    }
    match (1..loops.len()).find(|&hole| signed_area(loops[hole]) > 0.0) {
        Some(hole) => PieceMeshError::CounterClockwise { side, hole },
        None if loops.len() > 1 && error == TriangulationError::NotOnePiece => {
            PieceMeshError::HoleOutside(side)
        }
        None => {
            let shortest = shortest_edge(loops);
            PieceMeshError::NotTriangulated {
                side,
                place: rings.points[shortest],
                shortest: rings.edge_at(shortest),
                error,
            }
        }
    }
}

/// Index, in the list of all points, of the point at which the shortest edge starts.
fn shortest_edge(loops: &[&[DVec2]]) -> usize {
    let edges = loops.iter().flat_map(|ring| ring_edges(ring));
    let lengths = edges.map(|(a, b)| a.distance(b)).enumerate();
    let shortest = lengths.min_by(|a, b| a.1.total_cmp(&b.1));
    shortest.map_or(0, |(edge, _)| edge)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check_rings<const N: usize>(rings: [&[(f64, f64)]; N]) -> Result<(), PieceMeshError> {
        let rings = rings.map(|ring| ring.iter().copied().map(DVec2::from).collect::<Vec<_>>());
        validate_rings(&BoundaryRings::of(&rings), Side::Source)
    }

    fn not_simple(edges: [(usize, usize); 2], place: (f64, f64)) -> Result<(), PieceMeshError> {
        Err(PieceMeshError::NotSimple {
            side: Side::Source,
            edges: edges.map(|(ring, edge)| PieceEdge { ring, edge }),
            place: place.into(),
        })
    }

    const SQUARE: [(f64, f64); 4] = [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)];

    #[test]
    fn points_on_a_straight_side_are_allowed() {
        let square = [(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (2.0, 1.0), (0.0, 1.0)];
        assert_eq!(check_rings([&square]), Ok(()));
    }

    #[test]
    fn spikes_touches_and_wrong_direction_are_named() {
        let spike = [(0.0, 0.0), (2.0, 0.0), (1.0, 0.0), (1.0, 1.0)];
        assert_eq!(
            check_rings([&spike]),
            not_simple([(0, 0), (0, 1)], (0.0, 0.0))
        );
        let touch = [(0.0, 0.0), (4.0, 0.0), (4.0, 2.0), (2.0, 0.0), (0.0, 2.0)];
        assert_eq!(
            check_rings([&touch]),
            not_simple([(0, 0), (0, 3)], (0.0, 0.0))
        );
        let twice = [(0.0, 0.0), (4.0, 0.0), (4.0, 0.0), (0.0, 2.0)];
        assert_eq!(
            check_rings([&twice]),
            not_simple([(0, 0), (0, 1)], (0.0, 0.0))
        );
        let clockwise = [(0.0, 0.0), (0.0, 1.0), (1.0, 0.0)];
        assert_eq!(
            check_rings([&clockwise]),
            Err(PieceMeshError::Clockwise(Side::Source))
        );
    }

    #[test]
    fn rings_refused_without_a_known_fault_name_their_shortest_edge() {
        // 1e-200 underflows in the predicates, so two of the points count as one.
        let thin = [(0.0, 0.0), (1.0, 0.0), (1.0, 1e-200), (0.0, 1.0)];
        let refused = PieceMeshError::NotTriangulated {
            side: Side::Source,
            shortest: PieceEdge { ring: 0, edge: 1 },
            place: DVec2::X,
            error: TriangulationError::NotSimple,
        };
        assert_eq!(check_rings([&thin]), Err(refused));
    }

    #[test]
    fn holes_outside_reversed_or_touching_are_named() {
        let inside = [(1.0, 1.0), (1.0, 2.0), (2.0, 1.0)];
        assert_eq!(check_rings([&SQUARE, &inside]), Ok(()));
        let outside = inside.map(|(x, y)| (x + 9.0, y));
        let side = Side::Source;
        assert_eq!(
            check_rings([&SQUARE, &outside]),
            Err(PieceMeshError::HoleOutside(side))
        );
        let reversed = [inside[2], inside[1], inside[0]];
        assert_eq!(
            check_rings([&SQUARE, &reversed]),
            Err(PieceMeshError::CounterClockwise { side, hole: 1 })
        );
        let touching = inside.map(|(x, y)| (x - 1.0, y));
        assert_eq!(
            check_rings([&SQUARE, &touching]),
            not_simple([(0, 3), (1, 0)], (0.0, 4.0))
        );
        let corner = [(0.0, 0.0), (1.0, 2.0), (2.0, 1.0)];
        assert_eq!(
            check_rings([&SQUARE, &corner]),
            not_simple([(0, 0), (1, 0)], (0.0, 0.0))
        );
        let same = [inside; 2];
        assert!(check_rings([&SQUARE, &same[0], &same[1]]).is_err());
    }
}
