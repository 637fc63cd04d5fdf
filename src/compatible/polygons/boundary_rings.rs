//! The boundary rings of one connected piece in one design, and whether they
//! bound one.

use super::error::{PieceEdge, PieceMeshError};
use super::ring_contacts::touching_edges;
use crate::geometry::{DVec2, Side, ring_edges, signed_area};
use crate::mesh::triangulation::{TriangulationError, constrained_delaunay};
use std::ops::Range;

/// Boundary rings, one after the other.
#[derive(Clone, Debug)]
pub(super) struct BoundaryRings {
    pub(super) points: Vec<DVec2>,
    /// Which of the points each ring has.
    pub(super) ranges: Vec<Range<usize>>,
}

impl BoundaryRings {
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

    pub(super) fn scaled(&self, by: f64) -> Self {
        Self {
            points: self.points.iter().map(|&p| p * by).collect(),
            ranges: self.ranges.clone(),
        }
    }

    /// The rings, each by its points.
    pub(super) fn walks(&self) -> Vec<&[DVec2]> {
        let ranges = self.ranges.iter().cloned();
        ranges.map(|range| &self.points[range]).collect()
    }

    /// Where in its ring a point is.
    pub(super) fn place(&self, point: usize) -> PieceEdge {
        let holds = |range: &Range<usize>| range.contains(&point);
        let ring = self.ranges.iter().position(holds).unwrap_or(0);
        let edge = point - self.ranges[ring].start;
        PieceEdge { ring, edge }
    }
}

/// Whether the rings bound one piece: an outer one, counter-clockwise, and
/// holes in it, clockwise, that touch nothing but their own slits. O(n log n)
/// where they do.
pub(super) fn check(rings: &BoundaryRings, side: Side) -> Result<(), PieceMeshError> {
    let walks = rings.walks();
    if walks.is_empty() {
        return Err(PieceMeshError::NoOutline);
    }
    if let Some(ring) = walks.iter().position(|walk| walk.len() < 3) {
        let points = walks[ring].len();
        return Err(PieceMeshError::TooFewPoints { ring, points });
    }
    if let Some(point) = rings.points.iter().position(|p| !p.is_finite()) {
        return Err(not_finite(rings, point, side));
    }
    // It refuses all that is wrong, quickly; only then is it asked what.
    match constrained_delaunay(&walks) {
        Ok(_) => Ok(()),
        Err(TriangulationError::OutOfRange) => {
            let size = |p: &DVec2| p.abs().max_element();
            let far = (0..rings.points.len())
                .max_by(|&a, &b| size(&rings.points[a]).total_cmp(&size(&rings.points[b])));
            Err(not_finite(rings, far.unwrap_or(0), side))
        }
        Err(error) => Err(reason(rings, &walks, side, error)),
    }
}

fn not_finite(rings: &BoundaryRings, point: usize, side: Side) -> PieceMeshError {
    let PieceEdge { ring, edge } = rings.place(point);
    PieceMeshError::NotFinite {
        side,
        ring,
        vertex: edge,
    }
}

/// Why rings bound no piece, found the slow way.
fn reason(
    rings: &BoundaryRings,
    walks: &[&[DVec2]],
    side: Side,
    error: TriangulationError,
) -> PieceMeshError {
    // First: which way round crossing rings run says nothing.
    if let Some(edges) = touching_edges(walks) {
        return PieceMeshError::NotSimple {
            side,
            place: rings.points[edges[0]],
            edges: edges.map(|edge| rings.place(edge)),
        };
    }
    if signed_area(walks[0]) < 0.0 {
        return PieceMeshError::Clockwise(side);
    }
    match (1..walks.len()).find(|&hole| signed_area(walks[hole]) > 0.0) {
        Some(hole) => PieceMeshError::CounterClockwise { side, hole },
        None if walks.len() > 1 && error == TriangulationError::NotOnePiece => {
            PieceMeshError::HoleOutside(side)
        }
        None => {
            let shortest = shortest(walks);
            PieceMeshError::Refused {
                side,
                place: rings.points[shortest],
                shortest: rings.place(shortest),
                error,
            }
        }
    }
}

/// The point that the shortest edge begins at.
fn shortest(walks: &[&[DVec2]]) -> usize {
    let edges = walks.iter().flat_map(|walk| ring_edges(walk));
    let lengths = edges.map(|(a, b)| a.distance(b)).enumerate();
    let least = lengths.min_by(|a, b| a.1.total_cmp(&b.1));
    least.map_or(0, |(edge, _)| edge)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn verdict<const N: usize>(rings: [&[(f64, f64)]; N]) -> Result<(), PieceMeshError> {
        let rings = rings.map(|ring| ring.iter().copied().map(DVec2::from).collect::<Vec<_>>());
        check(&BoundaryRings::of(&rings), Side::Source)
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
    fn points_on_a_straight_side_are_welcome() {
        let square = [(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (2.0, 1.0), (0.0, 1.0)];
        assert_eq!(verdict([&square]), Ok(()));
    }

    #[test]
    fn spikes_touches_and_wrong_direction_are_named() {
        let spike = [(0.0, 0.0), (2.0, 0.0), (1.0, 0.0), (1.0, 1.0)];
        assert_eq!(verdict([&spike]), not_simple([(0, 0), (0, 1)], (0.0, 0.0)));
        let touch = [(0.0, 0.0), (4.0, 0.0), (4.0, 2.0), (2.0, 0.0), (0.0, 2.0)];
        assert_eq!(verdict([&touch]), not_simple([(0, 0), (0, 3)], (0.0, 0.0)));
        let twice = [(0.0, 0.0), (4.0, 0.0), (4.0, 0.0), (0.0, 2.0)];
        assert_eq!(verdict([&twice]), not_simple([(0, 0), (0, 1)], (0.0, 0.0)));
        let clockwise = [(0.0, 0.0), (0.0, 1.0), (1.0, 0.0)];
        assert_eq!(
            verdict([&clockwise]),
            Err(PieceMeshError::Clockwise(Side::Source))
        );
    }

    #[test]
    fn what_is_refused_without_a_fault_names_its_shortest_edge() {
        // Below the arithmetic's range two points are one.
        let thin = [(0.0, 0.0), (1.0, 0.0), (1.0, 1e-200), (0.0, 1.0)];
        let refused = PieceMeshError::Refused {
            side: Side::Source,
            shortest: PieceEdge { ring: 0, edge: 1 },
            place: DVec2::X,
            error: TriangulationError::NotSimple,
        };
        assert_eq!(verdict([&thin]), Err(refused));
    }

    #[test]
    fn holes_outside_reversed_or_touching_are_named() {
        let inside = [(1.0, 1.0), (1.0, 2.0), (2.0, 1.0)];
        assert_eq!(verdict([&SQUARE, &inside]), Ok(()));
        let outside = inside.map(|(x, y)| (x + 9.0, y));
        let side = Side::Source;
        assert_eq!(
            verdict([&SQUARE, &outside]),
            Err(PieceMeshError::HoleOutside(side))
        );
        let reversed = [inside[2], inside[1], inside[0]];
        assert_eq!(
            verdict([&SQUARE, &reversed]),
            Err(PieceMeshError::CounterClockwise { side, hole: 1 })
        );
        let touching = inside.map(|(x, y)| (x - 1.0, y));
        assert_eq!(
            verdict([&SQUARE, &touching]),
            not_simple([(0, 3), (1, 0)], (0.0, 4.0))
        );
        let corner = [(0.0, 0.0), (1.0, 2.0), (2.0, 1.0)];
        assert_eq!(
            verdict([&SQUARE, &corner]),
            not_simple([(0, 0), (1, 0)], (0.0, 0.0))
        );
        let same = [inside; 2];
        assert!(verdict([&SQUARE, &same[0], &same[1]]).is_err());
    }
}
