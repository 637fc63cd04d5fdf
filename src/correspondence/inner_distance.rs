//! Inner distances: lengths of the shortest paths *inside* a shape between places of its boundary.
//!
//! Bending a limb preserves inner distances (Ling, Jacobs 2007, "Shape classification using the
//! inner-distance"). The two sides of a stroke have a small inner distance, although they are far
//! apart along the boundary. In a triangulated simple polygon, a shortest path follows the dual
//! tree of the triangulation. One traversal of the tree finds all paths from one place: it carries
//! the funnel of shortest paths to the edge just crossed and splits it at the opposite corner (Lee,
//! Preparata 1984; Guibas, Hershberger, Leven, Sharir, Tarjan 1987).
//!
//! Guaranteed: lengths are deterministic, finite, and shortest up to rounding. The computation of
//! all paths from one place takes O(n) times the number of bends of a path. Holes are ignored.
//! Where a hole was cut open, the boundary runs along both sides of the slit, and no path passes
//! the slit.

use super::curve::BoundaryCurve;
use crate::geometry::{DVec2, twice_signed_area};
use crate::mesh::Connectivity;
use crate::mesh::triangulation::constrained_delaunay;

/// Inner distances between points of a boundary, given by their places (fractions of arc length).
#[derive(Clone, Debug)]
pub(super) struct InnerDistances {
    pub count: usize,
    /// Symmetric matrix of the inner distances between all places, one row for each place.
    pub lengths: Vec<f64>,
}

impl InnerDistances {
    /// Computes the distances between all places of a closed curve. Returns `None` unless the curve
    /// is a simple polygon that runs counter-clockwise: a hole has no inside.
    pub fn of(curve: &BoundaryCurve, places: &[f64]) -> Option<Self> {
        let polygon = TriangulatedPolygon::of(curve, places)?;
        let count = places.len();
        let mut lengths = vec![0.0; count * count];
        for (place, row) in lengths.chunks_exact_mut(count).enumerate() {
            polygon.distances_from(place, row);
        }
        // The lengths of a path and of its reverse round differently; their mean makes the matrix
        // exactly symmetric.
        for i in 0..count {
            for k in 0..i {
                let mean = 0.5 * (lengths[i * count + k] + lengths[k * count + i]);
                lengths[i * count + k] = mean;
                lengths[k * count + i] = mean;
            }
        }
        let is_finite = lengths.iter().all(|length| length.is_finite());
        is_finite.then_some(Self { count, lengths })
    }
}

/// Triangulated simple polygon with places on its boundary.
struct TriangulatedPolygon<'a> {
    points: &'a [DVec2],
    faces: Vec<[u32; 3]>,
    connectivity: Connectivity,
    places: Vec<DVec2>,
    /// For each place: index of the face whose boundary edge contains the place.
    face_of: Vec<usize>,
    /// For each face: indices of the places on its boundary edges.
    places_of: Vec<Vec<usize>>,
}

/// Vertex of a funnel, with the length of the shortest path to this vertex from the place at which
/// all paths start.
#[derive(Clone, Copy)]
struct FunnelVertex {
    at: DVec2,
    length: f64,
}

/// Funnel: the shortest paths from one place to the two ends of an edge of the triangulation, after
/// they separate. `bends` runs from the edge's left end, as seen along the paths, back to the apex
/// at which they separate, and from there to the edge's right end.
struct Funnel {
    bends: Vec<FunnelVertex>,
    /// Index of the apex in `bends`.
    apex: usize,
    /// Index of the face beyond the funnel's edge.
    face: usize,
    /// Corner of `face` (0, 1 or 2) at which the funnel's edge begins, in the orientation of
    /// `face`.
    corner: usize,
}

impl<'a> TriangulatedPolygon<'a> {
    /// Triangulates a curve and locates the places. Returns `None` if the curve is not a simple
    /// counter-clockwise polygon.
    fn of(curve: &'a BoundaryCurve, places: &[f64]) -> Option<Self> {
        let points = curve.points();
        let faces = constrained_delaunay(&[points]).ok()?;
        let connectivity = Connectivity::new(&faces).ok()?;
        let face_of_edge = faces_of_edges(&faces, &connectivity, points.len());
        let mut places_of = vec![Vec::new(); faces.len()];
        let mut face_of = Vec::with_capacity(places.len());
        for (place, &position) in places.iter().enumerate() {
            let face = face_of_edge[curve.edge_at(position)]?;
            places_of[face].push(place);
            face_of.push(face);
        }
        Some(Self {
            places: places
                .iter()
                .map(|&position| curve.point_at(position))
                .collect(),
            points,
            faces,
            connectivity,
            face_of,
            places_of,
        })
    }

    /// Computes the lengths of the shortest paths from one place to all others.
    fn distances_from(&self, place: usize, lengths: &mut [f64]) {
        let (from, face) = (self.places[place], self.face_of[place]);
        for &other in &self.places_of[face] {
            lengths[other] = from.distance(self.places[other]);
        }
        let bend = |at: DVec2| FunnelVertex {
            at,
            length: from.distance(at),
        };
        let mut funnels = Vec::new();
        for corner in 0..3 {
            let [right, left] = [corner, corner + 1].map(|k| self.point(face, k));
            let bends = vec![bend(left), bend(from), bend(right)];
            funnels.extend(self.funnel_beyond(face, corner, bends, 1));
        }
        while let Some(funnel) = funnels.pop() {
            for &other in &self.places_of[funnel.face] {
                lengths[other] = funnel.reach(self.places[other]).1.length;
            }
            let Funnel { face, corner, .. } = funnel;
            let (exit, ahead) = funnel.reach(self.point(face, corner + 2));
            let (left, right) = funnel.split(exit, ahead);
            funnels.extend(self.funnel_beyond(face, corner + 1, right.0, right.1));
            funnels.extend(self.funnel_beyond(face, corner + 2, left.0, left.1));
        }
    }

    /// Returns the position of a face's corner; corners count modulo 3.
    fn point(&self, face: usize, corner: usize) -> DVec2 {
        self.points[self.faces[face][corner % 3] as usize]
    }

    /// Returns the funnel to the edge that begins at a face's corner. Returns `None` if that edge
    /// lies on the boundary.
    fn funnel_beyond(
        &self,
        face: usize,
        corner: usize,
        bends: Vec<FunnelVertex>,
        apex: usize,
    ) -> Option<Funnel> {
        let across = self.connectivity.neighbour(face, corner % 3)?;
        let end = self.faces[face][(corner + 1) % 3];
        let corner = self.faces[across].iter().position(|&v| v == end)?;
        Some(Funnel {
            bends,
            apex,
            face: across,
            corner,
        })
    }
}

impl Funnel {
    /// Finds the shortest path to a point `to` in the face beyond the funnel's edge. Returns the
    /// index in `bends` of the vertex at which the path leaves the funnel, and the point `to` with
    /// the length of the path.
    fn reach(&self, to: DVec2) -> (usize, FunnelVertex) {
        let at = |k: usize| self.bends[k].at;
        let mut exit = self.apex;
        while exit > 0 && twice_signed_area(at(exit), at(exit - 1), to) > 0.0 {
            exit -= 1;
        }
        let last = self.bends.len() - 1;
        // The path bends around at most one side of the funnel, so the right side is searched only
        // if the path does not bend around the left one.
        if exit == self.apex {
            while exit < last && twice_signed_area(at(exit), at(exit + 1), to) < 0.0 {
                exit += 1;
            }
        }
        let length = self.bends[exit].length + at(exit).distance(to);
        (exit, FunnelVertex { at: to, length })
    }

    /// Splits the funnel at `ahead`, the corner opposite the funnel's edge in the face beyond it.
    /// Returns the bends and the apex of the funnel to that face's left edge, then those of the
    /// funnel to its right edge. `exit` is the index in `bends` at which the path to `ahead` leaves
    /// the funnel.
    fn split(
        self,
        exit: usize,
        ahead: FunnelVertex,
    ) -> ((Vec<FunnelVertex>, usize), (Vec<FunnelVertex>, usize)) {
        let mut left = self.bends[..=exit].to_vec();
        left.push(ahead);
        let mut right = vec![ahead];
        right.extend_from_slice(&self.bends[exit..]);
        let apex_right = self.apex.max(exit) - exit + 1;
        // The apex of each new funnel is the vertex at which the paths to both ends of its edge
        // separate.
        if exit < self.apex {
            ((left, exit), (right, apex_right))
        } else {
            ((left, self.apex), (right, 1))
        }
    }
}

/// Returns the face that contains each of the polygon's `n` edges; `None` for an edge without a
/// face.
fn faces_of_edges(faces: &[[u32; 3]], connectivity: &Connectivity, n: usize) -> Vec<Option<usize>> {
    let mut face_of_edge = vec![None; n];
    for (face, corners) in faces.iter().enumerate() {
        for k in 0..3 {
            if connectivity.neighbour(face, k).is_none() {
                face_of_edge[corners[k] as usize] = Some(face);
            }
        }
    }
    face_of_edge
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Ring;

    fn curve(points: &[(f64, f64)]) -> BoundaryCurve {
        let points = points.iter().map(|&p| DVec2::from(p)).collect();
        BoundaryCurve::closed(&Ring::new(points).expect("a ring")).expect("a size")
    }

    /// A bar along x that turns upwards; its inner corner is at (3, 1).
    const ELBOW: [(f64, f64); 6] = [
        (0.0, 0.0),
        (4.0, 0.0),
        (4.0, 4.0),
        (3.0, 4.0),
        (3.0, 1.0),
        (0.0, 1.0),
    ];

    #[test]
    fn a_path_bends_around_the_inner_corner() {
        let elbow = curve(&ELBOW);
        let ends = [(0.0, 0.5), (3.5, 4.0), (1.0, 0.0), (3.0, 1.0), (0.0, 1.0)];
        let places = ends.map(|p| elbow.nearest(DVec2::from(p)));
        let found = InnerDistances::of(&elbow, &places).expect("simple");
        let half = 9.25f64.sqrt();
        let expected = [0.0, 2.0 * half, 1.25f64.sqrt(), half, 0.5];
        for (found, expected) in found.lengths.iter().zip(expected) {
            assert!((found - expected).abs() < 1e-12, "{found} for {expected}");
        }
    }

    #[test]
    fn self_crossing_curves_and_holes_have_no_inside() {
        let mut hole = ELBOW;
        hole.reverse();
        assert!(InnerDistances::of(&curve(&hole), &[0.0, 0.5]).is_none());
        let bow = curve(&[(0.0, 0.0), (1.0, 1.0), (1.0, 0.0), (0.0, 1.0)]);
        assert!(InnerDistances::of(&bow, &[0.0, 0.5]).is_none());
    }

    /// Returns the length of a shortest path by relaxation over all pairs of corners that see each
    /// other (slow oracle).
    fn slow(points: &[DVec2], ends: [DVec2; 2]) -> f64 {
        let nodes: Vec<DVec2> = ends.into_iter().chain(points.iter().copied()).collect();
        let ring = Ring::new(points.to_vec()).expect("a ring");
        // Visibility is sampled instead of computed from crossings, because a place lies on its
        // edge only up to rounding.
        let sees = |a: DVec2, b: DVec2| {
            (0..200).all(|k| {
                let p = a.lerp(b, (f64::from(k) + 0.5) / 200.0);
                ring.winding(p) != 0 || ring.distance_squared(p) < 1e-14
            })
        };
        let mut best = vec![f64::INFINITY; nodes.len()];
        best[0] = 0.0;
        for _ in 0..nodes.len() {
            for a in 0..nodes.len() {
                for b in 0..nodes.len() {
                    let length = best[a] + nodes[a].distance(nodes[b]);
                    if length < best[b] && sees(nodes[a], nodes[b]) {
                        best[b] = length;
                    }
                }
            }
        }
        best[1]
    }

    #[test]
    fn paths_are_as_short_as_those_of_the_visibility_graph() {
        let spiral = [
            (0.0, 0.0),
            (9.0, 0.0),
            (9.0, 8.0),
            (1.0, 7.0),
            (1.0, 2.0),
            (7.0, 3.0),
            (6.0, 5.0),
            (3.0, 5.0),
            (3.0, 4.0),
            (5.0, 4.2),
            (5.5, 3.6),
            (2.0, 3.0),
            (2.0, 6.0),
            (8.0, 6.5),
            (8.0, 1.0),
            (0.0, 1.5),
        ];
        let spiral = curve(&spiral);
        let places: Vec<f64> = (0..9).map(|k| (f64::from(k) + 0.37) / 9.0).collect();
        let found = InnerDistances::of(&spiral, &places).expect("simple");
        for i in 0..places.len() {
            for k in 0..i {
                let ends = [i, k].map(|p| spiral.point_at(places[p]));
                let slow = slow(spiral.points(), ends);
                let length = found.lengths[i * found.count + k];
                assert!((length - slow).abs() < 1e-9, "{length} for {slow}");
            }
        }
    }
}
