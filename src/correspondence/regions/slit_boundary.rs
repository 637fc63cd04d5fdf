//! Boundaries that are cut open: one closed walk around a part, along the
//! slit to a hole, around that and back.

use super::super::curve::{BoundaryCurve, CurveLengthError};
use crate::geometry::{DVec2, Region, Ring, nearest_segment_parameter, segments_touch};

/// A closed walk, and the slits it runs along there and back.
#[derive(Clone, Debug)]
pub(super) struct SlitBoundary {
    pub(super) ring: Ring,
    /// From the boundary to the hole.
    pub(super) slits: Vec<[DVec2; 2]>,
}

/// A straight cut: where it leaves the walk and where it meets the hole.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Slit {
    /// The walk's edge it leaves from, by its first point.
    outer_edge: usize,
    hole_edge: usize,
    pub(super) ends: [DVec2; 2],
}

/// How far a slit keeps from its own ends where it is tested against edges.
const END_SHARE: f64 = 1e-6;

/// Where along a slit its distance from the boundary is looked at, and what
/// share of the way to its nearer end that has to be: a slit that all but runs
/// along the boundary, as from the leg of an R, would touch it in the digits.
const LOOKED_AT: [f64; 7] = [0.02, 0.1, 0.25, 0.5, 0.75, 0.9, 0.98];
const LEAST_CLEARANCE: f64 = 0.1;

impl SlitBoundary {
    pub(super) fn around(region: &Region) -> Self {
        Self {
            ring: region.outer.clone(),
            slits: Vec::new(),
        }
    }

    pub(super) fn curve(&self) -> Result<BoundaryCurve, CurveLengthError> {
        BoundaryCurve::closed(&self.ring)
    }

    /// The straight cut from the walk's point nearest to `outer` to the
    /// hole's point nearest to `hole`; none if it leaves the part, or starts
    /// where another slit does.
    pub(super) fn slit(
        &self,
        holes: &[&Ring],
        cut: usize,
        outer: DVec2,
        hole: DVec2,
    ) -> Option<Slit> {
        let (outer_edge, a) = nearest(&self.ring, outer, |edge| !self.is_slit(edge))?;
        let (hole_edge, b) = nearest(holes[cut], hole, |_| true)?;
        let slit = Slit {
            outer_edge,
            hole_edge,
            ends: [a, b],
        };
        (!self.touches_slit(a) && self.is_free(holes, &slit)).then_some(slit)
    }

    /// The cut from a place of the walk to the nearest point of the hole.
    pub(super) fn slit_from(&self, holes: &[&Ring], cut: usize, outer: DVec2) -> Option<Slit> {
        self.slit(holes, cut, outer, outer)
    }

    fn is_slit(&self, (a, b): (DVec2, DVec2)) -> bool {
        let along = |s: &[DVec2; 2]| *s == [a, b] || *s == [b, a];
        self.slits.iter().any(along)
    }

    fn touches_slit(&self, p: DVec2) -> bool {
        self.slits.iter().flatten().any(|&end| end == p)
    }

    fn is_free(&self, holes: &[&Ring], slit: &Slit) -> bool {
        let [a, b] = slit.ends;
        let short = [a.lerp(b, END_SHARE), b.lerp(a, END_SHARE)];
        let middle = a.midpoint(b);
        let rings = || std::iter::once(&self.ring).chain(holes.iter().copied());
        // 1 inside: the walk counts 1, and a hole about the place takes 1 away.
        let winding: i32 = rings().map(|ring| ring.winding(middle)).sum();
        let touched = |ring: &Ring| ring.edges().any(|(p, q)| segments_touch(short, [p, q]));
        let length = a.distance(b);
        let is_clear = |&along: &f64| {
            let least = LEAST_CLEARANCE * along.min(1.0 - along) * length;
            rings().all(|ring| ring.distance_squared(a.lerp(b, along)) >= least * least)
        };
        short[0] != short[1]
            && winding == 1
            && !rings().any(touched)
            && LOOKED_AT.iter().all(is_clear)
    }

    /// The walk that goes along the slit and around the hole as well.
    pub(super) fn opened(&self, hole: &Ring, slit: &Slit) -> Option<Self> {
        let [a, b] = slit.ends;
        let mut points = around_from(&self.ring, slit.outer_edge, a);
        points.extend(around_from(hole, slit.hole_edge, b));
        let ring = Ring::new(points).ok()?;
        let mut slits = self.slits.clone();
        slits.push(slit.ends);
        Some(Self { ring, slits })
    }
}

/// Once around from a point on an edge back to it, that point first and last.
fn around_from(ring: &Ring, edge: usize, from: DVec2) -> Vec<DVec2> {
    let points = ring.points();
    let n = points.len();
    let mut walk = vec![from];
    walk.extend((1..=n).map(|k| points[(edge + k) % n]));
    walk.push(from);
    // An end that is a vertex stands twice in a row.
    walk.dedup();
    walk
}

/// The edge nearest to a point, among those allowed, and the point on it.
fn nearest(
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
            // At a vertex that vertex, to the last bit: slits are found again by it.
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
    fn a_frame_cut_open_walks_the_slit_twice() {
        let region = Region {
            outer: square(2.0, true),
            holes: vec![square(1.0, false)],
        };
        let holes: Vec<&Ring> = region.holes.iter().collect();
        let walk = SlitBoundary::around(&region);
        let slit = walk.slit_from(&holes, 0, DVec2::new(0.5, -2.0));
        let slit = slit.expect("free");
        assert_eq!(slit.ends, [DVec2::new(0.5, -2.0), DVec2::new(0.5, -1.0)]);
        let open = walk.opened(holes[0], &slit).expect("a walk");
        assert_eq!(open.ring.points().len(), 12);
        assert!((open.ring.signed_area() - 12.0).abs() < 1e-12);
        let curve = open.curve().expect("length");
        assert_eq!(curve.turning_number(), 1);
    }

    #[test]
    fn a_slit_through_another_hole_is_refused() {
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
        let walk = SlitBoundary::around(&region);
        assert!(walk.slit_from(&holes, 0, DVec2::new(2.0, 0.0)).is_none());
        assert!(walk.slit_from(&holes, 1, DVec2::new(2.0, 0.0)).is_some());
    }

    #[test]
    fn a_slit_along_the_boundary_is_refused_however_it_is_rounded() {
        let leg = [
            (0.0, 0.0),
            (4.0, 0.0),
            (4.0, 9.0),
            (-4.0, 9.0),
            (-4.0, 4.0),
            (0.0, 4.0),
        ];
        let region = Region {
            outer: Ring::new(leg.map(DVec2::from).to_vec()).expect("a ring"),
            holes: vec![],
        };
        let hole = [(1e-15, 6.0), (1e-15, 8.0), (2.0, 8.0), (2.0, 6.0)];
        let hole = Ring::new(hole.map(DVec2::from).to_vec()).expect("a ring");
        let walk = SlitBoundary::around(&region);
        assert!(walk.slit_from(&[&hole], 0, DVec2::new(0.0, 2.0)).is_none());
        assert!(walk.slit_from(&[&hole], 0, DVec2::new(4.0, 7.0)).is_some());
    }
}
