//! Inner distances: how long the shortest path *within* a shape is, between
//! places of its boundary.
//!
//! A limb that bends keeps them (Ling, Jacobs 2007, "Shape classification
//! using the inner-distance"), and the two sides of a stroke are near each
//! other by them, which no walk along the boundary tells. In a triangulated
//! simple polygon a path is a walk through the dual tree; all paths from one
//! place are found in one walk through all of the tree, that carries the
//! funnel of shortest paths to the edge just crossed and splits it at the
//! corner behind (Lee, Preparata 1984; Guibas, Hershberger, Leven, Sharir,
//! Tarjan 1987).
//!
//! Guaranteed: deterministic and finite; shortest to rounding. O(n) for each
//! place, times how many corners a path bends around. Holes are not seen: a
//! ring that was cut open is a polygon along its slits.

use super::curve::BoundaryCurve;
use crate::geometry::{DVec2, twice_signed_area};
use crate::mesh::Connectivity;
use crate::mesh::triangulation::constrained_delaunay;

/// The inner distances between places of a boundary.
#[derive(Clone, Debug)]
pub(super) struct InnerDistances {
    pub count: usize,
    /// Symmetric, a row for each place.
    pub lengths: Vec<f64>,
}

impl InnerDistances {
    /// Between all places of a closed curve; none if it is no simple polygon
    /// that runs counter-clockwise: inside of a hole there is nothing.
    pub fn of(curve: &BoundaryCurve, places: &[f64]) -> Option<Self> {
        let inside = TriangulatedPolygon::of(curve, places)?;
        let count = places.len();
        let mut lengths = vec![0.0; count * count];
        for (place, row) in lengths.chunks_exact_mut(count).enumerate() {
            inside.walk_from(place, row);
        }
        // There and back are sums in another order.
        for i in 0..count {
            for k in 0..i {
                let both = 0.5 * (lengths[i * count + k] + lengths[k * count + i]);
                lengths[i * count + k] = both;
                lengths[k * count + i] = both;
            }
        }
        let is_finite = lengths.iter().all(|length| length.is_finite());
        is_finite.then_some(Self { count, lengths })
    }
}

/// A triangulated simple polygon with places on its boundary.
struct TriangulatedPolygon<'a> {
    points: &'a [DVec2],
    faces: Vec<[u32; 3]>,
    connectivity: Connectivity,
    places: Vec<DVec2>,
    /// The face that each place lies on an edge of.
    face_of: Vec<usize>,
    /// For each face the places on its edges.
    places_of: Vec<Vec<usize>>,
}

/// A corner of a funnel, and how far it is from where all paths begin.
#[derive(Clone, Copy)]
struct FunnelVertex {
    at: DVec2,
    length: f64,
}

/// The shortest paths to both ends of an edge that is crossed: from its left
/// end, seen from where they come, to where they part, to its right end.
struct Funnel {
    bends: Vec<FunnelVertex>,
    apex: usize,
    /// Beyond the edge, and the edge's corner of that face.
    face: usize,
    corner: usize,
}

impl<'a> TriangulatedPolygon<'a> {
    fn of(curve: &'a BoundaryCurve, places: &[f64]) -> Option<Self> {
        let points = curve.points();
        let faces = constrained_delaunay(&[points]).ok()?;
        let connectivity = Connectivity::new(&faces).ok()?;
        let face_at = faces_at(&faces, &connectivity, points.len());
        let mut places_of = vec![Vec::new(); faces.len()];
        let mut face_of = Vec::with_capacity(places.len());
        for (place, &at) in places.iter().enumerate() {
            let face = face_at[curve.edge_at(at)]?;
            places_of[face].push(place);
            face_of.push(face);
        }
        Some(Self {
            places: places.iter().map(|&at| curve.point_at(at)).collect(),
            points,
            faces,
            connectivity,
            face_of,
            places_of,
        })
    }

    /// The lengths of the shortest paths from one place to all.
    fn walk_from(&self, place: usize, lengths: &mut [f64]) {
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
            funnels.extend(self.beyond(face, corner, bends, 1));
        }
        while let Some(funnel) = funnels.pop() {
            for &other in &self.places_of[funnel.face] {
                lengths[other] = funnel.reach(self.places[other]).1.length;
            }
            let Funnel { face, corner, .. } = funnel;
            let (parts, ahead) = funnel.reach(self.point(face, corner + 2));
            let (left, right) = funnel.split(parts, ahead);
            funnels.extend(self.beyond(face, corner + 1, right.0, right.1));
            funnels.extend(self.beyond(face, corner + 2, left.0, left.1));
        }
    }

    fn point(&self, face: usize, corner: usize) -> DVec2 {
        self.points[self.faces[face][corner % 3] as usize]
    }

    /// A funnel to an edge of a face, if there is a face across.
    fn beyond(
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
    /// Where the shortest path to a point beyond the edge leaves the funnel,
    /// and its end there.
    fn reach(&self, to: DVec2) -> (usize, FunnelVertex) {
        let at = |k: usize| self.bends[k].at;
        let mut parts = self.apex;
        while parts > 0 && twice_signed_area(at(parts), at(parts - 1), to) > 0.0 {
            parts -= 1;
        }
        let last = self.bends.len() - 1;
        // On one side only: a path does not bend both ways around its end.
        if parts == self.apex {
            while parts < last && twice_signed_area(at(parts), at(parts + 1), to) < 0.0 {
                parts += 1;
            }
        }
        let length = self.bends[parts].length + at(parts).distance(to);
        (parts, FunnelVertex { at: to, length })
    }

    /// The funnels to the edges left and right of the corner ahead, each with
    /// its apex.
    fn split(
        self,
        parts: usize,
        ahead: FunnelVertex,
    ) -> ((Vec<FunnelVertex>, usize), (Vec<FunnelVertex>, usize)) {
        let mut left = self.bends[..=parts].to_vec();
        left.push(ahead);
        let mut right = vec![ahead];
        right.extend_from_slice(&self.bends[parts..]);
        let apex_right = self.apex.max(parts) - parts + 1;
        // What both ends of the new edge have in common ends where they part.
        if parts < self.apex {
            ((left, parts), (right, apex_right))
        } else {
            ((left, self.apex), (right, 1))
        }
    }
}

/// The face on each edge of the polygon.
fn faces_at(faces: &[[u32; 3]], connectivity: &Connectivity, n: usize) -> Vec<Option<usize>> {
    let mut face_at = vec![None; n];
    for (face, corners) in faces.iter().enumerate() {
        for k in 0..3 {
            if connectivity.neighbour(face, k).is_none() {
                face_at[corners[k] as usize] = Some(face);
            }
        }
    }
    face_at
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Ring;

    fn curve(points: &[(f64, f64)]) -> BoundaryCurve {
        let points = points.iter().map(|&p| DVec2::from(p)).collect();
        BoundaryCurve::closed(&Ring::new(points).expect("a ring")).expect("a size")
    }

    /// A bar along x and then up: its inner corner is at (3, 1).
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
    fn what_crosses_itself_and_what_is_a_hole_have_no_inside() {
        let mut hole = ELBOW;
        hole.reverse();
        assert!(InnerDistances::of(&curve(&hole), &[0.0, 0.5]).is_none());
        let bow = curve(&[(0.0, 0.0), (1.0, 1.0), (1.0, 0.0), (0.0, 1.0)]);
        assert!(InnerDistances::of(&bow, &[0.0, 0.5]).is_none());
    }

    /// Shortest paths by looking: straight between corners that see each other.
    fn slow(points: &[DVec2], ends: [DVec2; 2]) -> f64 {
        let nodes: Vec<DVec2> = ends.into_iter().chain(points.iter().copied()).collect();
        let ring = Ring::new(points.to_vec()).expect("a ring");
        // Looked at closely, and not by crossings: a place lies on its edge to
        // rounding only.
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
    fn paths_are_the_shortest_between_corners_that_see_each_other() {
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
