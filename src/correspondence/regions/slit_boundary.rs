//! The boundary loop of a part whose holes were cut open: a single closed loop around the part,
//! along the slit to a hole, around the hole and back along the slit.

use super::super::curve::{BoundaryCurve, CurveLengthError};
use crate::geometry::{DVec2, Region, Ring, nearest_segment_parameter, segments_touch};

/// A closed boundary loop, with the slits that it follows in both directions.
#[derive(Clone, Debug)]
pub(super) struct SlitBoundary {
    pub(super) ring: Ring,
    /// Ends of each slit, from the boundary to the hole.
    pub(super) slits: Vec<[DVec2; 2]>,
}

/// A straight cut from the boundary loop to a hole.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Slit {
    /// Index of the loop's edge on which the slit starts; an edge has the index of its first
    /// vertex.
    outer_edge: usize,
    /// Index of the hole's edge on which the slit ends.
    hole_edge: usize,
    /// Ends of the slit: first the end on the loop, then the end on the hole.
    pub(super) ends: [DVec2; 2],
}

/// Fraction of a slit omitted at both ends when it is tested against edges, because the ends lie on
/// edges (tolerance: above rounding, far below any edge).
const END_SHARE: f64 = 1e-6;

/// Positions along a slit, as fractions of its length, at which its clearance from the boundary is
/// checked (heuristic).
const CLEARANCE_CHECKS: [f64; 7] = [0.02, 0.1, 0.25, 0.5, 0.75, 0.9, 0.98];
/// Minimum distance of a point of the slit from all boundaries, as a fraction of the point's
/// distance from the nearer end of the slit. It rejects slits that almost run along a boundary,
/// such as along the stem of an R, because rounding could make them touch it (heuristic).
const MIN_CLEARANCE: f64 = 0.1;

impl SlitBoundary {
    /// Returns the outer boundary of a region, without slits.
    pub(super) fn of_region(region: &Region) -> Self {
        Self {
            ring: region.outer.clone(),
            slits: Vec::new(),
        }
    }

    /// Returns the curve along the boundary loop.
    ///
    /// # Errors
    /// [`CurveLengthError`] if the loop's length overflows or underflows.
    pub(super) fn curve(&self) -> Result<BoundaryCurve, CurveLengthError> {
        BoundaryCurve::closed(&self.ring)
    }

    /// Returns the straight cut from the loop's point nearest to `outer` to the point of
    /// `holes[cut]` nearest to `hole`. Returns `None` if the cut leaves the part, or starts at the
    /// end of another slit.
    pub(super) fn slit(
        &self,
        holes: &[&Ring],
        cut: usize,
        outer: DVec2,
        hole: DVec2,
    ) -> Option<Slit> {
        let (outer_edge, a) = nearest_edge(&self.ring, outer, |(p, q)| !self.is_slit([p, q]))?;
        let (hole_edge, b) = nearest_edge(holes[cut], hole, |_| true)?;
        let slit = Slit {
            outer_edge,
            hole_edge,
            ends: [a, b],
        };
        (!self.touches_slit(a) && self.is_free(holes, &slit)).then_some(slit)
    }

    /// Returns the straight cut from a point of the loop to the nearest point of `holes[cut]`.
    pub(super) fn slit_from(&self, holes: &[&Ring], cut: usize, outer: DVec2) -> Option<Slit> {
        self.slit(holes, cut, outer, outer)
    }

    /// Returns whether an edge of the loop runs along a slit.
    fn is_slit(&self, [a, b]: [DVec2; 2]) -> bool {
        let along = |s: &[DVec2; 2]| *s == [a, b] || *s == [b, a];
        self.slits.iter().any(along)
    }

    /// Returns whether a point is the end of a slit.
    fn touches_slit(&self, p: DVec2) -> bool {
        self.slits.iter().flatten().any(|&end| end == p)
    }

    /// Returns whether a slit runs inside the part and keeps clear of all boundaries.
    fn is_free(&self, holes: &[&Ring], slit: &Slit) -> bool {
        let [a, b] = slit.ends;
        let short = [a.lerp(b, END_SHARE), b.lerp(a, END_SHARE)];
        let middle = a.midpoint(b);
        let rings = || std::iter::once(&self.ring).chain(holes.iter().copied());
        // The winding number is 1 inside the part: the loop adds 1, and a hole around the point
        // subtracts 1.
        let winding: i32 = rings().map(|ring| ring.winding(middle)).sum();
        let touched = |ring: &Ring| ring.edges().any(|(p, q)| segments_touch(short, [p, q]));
        let length = a.distance(b);
        let is_clear = |&along: &f64| {
            let least = MIN_CLEARANCE * along.min(1.0 - along) * length;
            rings().all(|ring| ring.distance_squared(a.lerp(b, along)) >= least * least)
        };
        short[0] != short[1]
            && winding == 1
            && !rings().any(touched)
            && CLEARANCE_CHECKS.iter().all(is_clear)
    }

    /// Returns this loop extended along the slit, around the hole and back along the slit. Returns
    /// `None` if the resulting points form no [`Ring`].
    pub(super) fn cut_open(&self, hole: &Ring, slit: &Slit) -> Option<Self> {
        let [a, b] = slit.ends;
        let mut points = ring_from(&self.ring, slit.outer_edge, a);
        points.extend(ring_from(hole, slit.hole_edge, b));
        let ring = Ring::new(points).ok()?;
        let mut slits = self.slits.clone();
        slits.push(slit.ends);
        Some(Self { ring, slits })
    }
}

/// Returns the points once around a ring, starting and ending at the point `from` on the given
/// edge.
fn ring_from(ring: &Ring, edge: usize, from: DVec2) -> Vec<DVec2> {
    let points = ring.points();
    let n = points.len();
    let mut loop_points = vec![from];
    loop_points.extend((1..=n).map(|k| points[(edge + k) % n]));
    loop_points.push(from);
    // If `from` is a vertex of the ring, it occurs twice in a row; one of the two is removed.
    loop_points.dedup();
    loop_points
}

/// Finds the edge nearest to `p` among the edges for which `allowed` is true. Returns its index and
/// its point nearest to `p`; `None` if there is no such edge.
fn nearest_edge(
    ring: &Ring,
    p: DVec2,
    allowed: impl Fn((DVec2, DVec2)) -> bool,
) -> Option<(usize, DVec2)> {
    let mut best = None;
    let mut least = f64::INFINITY;
    for (k, (a, b)) in ring.edges().enumerate() {
        if !allowed((a, b)) {
            continue;
        }
        let q = match nearest_segment_parameter(p, a, b) {
            // Return vertices without rounding, because slits are later identified by their ends.
            0.0 => a,
            1.0 => b,
            along => a.lerp(b, along),
        };
        if p.distance_squared(q) < least {
            least = p.distance_squared(q);
            best = Some((k, q));
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(size: f64, ccw: bool) -> Ring {
        let s = size;
        let points = [(-s, -s), (s, -s), (s, s), (-s, s)].map(DVec2::from);
        let ring = Ring::new(points.to_vec()).expect("a ring");
        if ccw { ring } else { ring.reversed() }
    }

    #[test]
    fn the_loop_of_a_cut_open_frame_follows_the_slit_twice() {
        let region = Region {
            outer: square(2.0, true),
            holes: vec![square(1.0, false)],
        };
        let holes: Vec<&Ring> = region.holes.iter().collect();
        let boundary = SlitBoundary::of_region(&region);
        let slit = boundary.slit_from(&holes, 0, DVec2::new(0.5, -2.0));
        let slit = slit.expect("free");
        assert_eq!(slit.ends, [DVec2::new(0.5, -2.0), DVec2::new(0.5, -1.0)]);
        let open = boundary.cut_open(holes[0], &slit).expect("a loop");
        assert_eq!(open.ring.points().len(), 12);
        assert!((open.ring.signed_area() - 12.0).abs() < 1e-12);
        let curve = open.curve().expect("length");
        assert_eq!(curve.turning_number(), 1);
    }

    #[test]
    fn a_slit_through_another_hole_is_rejected() {
        let moved = |by: f64| {
            let points = square(0.3, false).points().to_vec();
            let moved = points.iter().map(|p| *p + DVec2::new(by, 0.0));
            Ring::new(moved.collect()).expect("a ring")
        };
        let region = Region {
            outer: square(2.0, true),
            holes: vec![moved(-0.5), moved(0.5)],
        };
        let holes: Vec<&Ring> = region.holes.iter().collect();
        let boundary = SlitBoundary::of_region(&region);
        assert!(
            boundary
                .slit_from(&holes, 0, DVec2::new(2.0, 0.0))
                .is_none()
        );
        assert!(
            boundary
                .slit_from(&holes, 1, DVec2::new(2.0, 0.0))
                .is_some()
        );
    }

    #[test]
    fn a_slit_along_the_boundary_is_rejected_despite_rounding() {
        let stem = [
            (0.0, 0.0),
            (4.0, 0.0),
            (4.0, 9.0),
            (-4.0, 9.0),
            (-4.0, 4.0),
            (0.0, 4.0),
        ];
        let region = Region {
            outer: Ring::new(stem.map(DVec2::from).to_vec()).expect("a ring"),
            holes: vec![],
        };
        let hole = [(1e-15, 6.0), (1e-15, 8.0), (2.0, 8.0), (2.0, 6.0)];
        let hole = Ring::new(hole.map(DVec2::from).to_vec()).expect("a ring");
        let boundary = SlitBoundary::of_region(&region);
        assert!(
            boundary
                .slit_from(&[&hole], 0, DVec2::new(0.0, 2.0))
                .is_none()
        );
        assert!(
            boundary
                .slit_from(&[&hole], 0, DVec2::new(4.0, 7.0))
                .is_some()
        );
    }
}
