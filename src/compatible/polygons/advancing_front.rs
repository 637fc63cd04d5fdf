//! The front that moves inwards, and what it leaves behind: points that see a
//! stretch of it in either design, corners cut off.

use super::boundary_rings::BoundaryRings;
use super::edge_grid::EdgeGrid;
use super::face_cost;
use crate::geometry::{DVec2, orient2d, ring_edges, segments_touch};
use crate::work::progress::{Cancelled, Progress, still_wanted};
use std::collections::HashSet;

/// Edges of the stretches that are tried, longest first. Any number becomes
/// two, so that three are the least that gain.
const STRETCHES: [usize; 4] = [7, 5, 4, 3];
/// How far from its stretch a point is sought, in units of its extent: as far
/// in as there is room, for good angles.
const REACHES: [f64; 5] = [0.6, 0.3, 0.12, 0.04, 0.01];
/// So much farther in it has to be free, too, so that fronts that meet
/// leave room.
const ROOM: f64 = 1.5;
/// Corners are cut off where both faces are at most so far from equilateral
/// (1): a triangle with a right angle and sides of 1 and 5 is at 3.
const SHAPELY: f64 = 3.0;

/// What is left to triangulate, and what has been.
pub(super) struct AdvancingFront {
    /// All vertices, those of the rings first.
    pub(super) points: [Vec<DVec2>; 2],
    pub(super) faces: Vec<[u32; 3]>,
    /// The front's rings, by vertices.
    pub(super) rings: Vec<Vec<u32>>,
    /// The front's edges in either design.
    near: [EdgeGrid; 2],
}

impl AdvancingFront {
    /// A front on the boundary.
    pub(super) fn of(source: &BoundaryRings, target: &BoundaryRings) -> Self {
        let rings = source.ranges.iter().cloned();
        let points = [source, target].map(|rings| rings.points.clone());
        let near = points.each_ref().map(|p| EdgeGrid::around(p, p.len()));
        let mut coarse = Self {
            points,
            faces: Vec::new(),
            rings: rings.map(|ring| ring.map(|v| v as u32).collect()).collect(),
            near,
        };
        let edges = coarse.rings.iter().flat_map(|ring| ring_edges(ring));
        for edge in edges.map(<[u32; 2]>::from).collect::<Vec<_>>() {
            coarse.list(edge);
        }
        coarse
    }

    fn ends(&self, design: usize, edge: [u32; 2]) -> [DVec2; 2] {
        edge.map(|v| self.points[design][v as usize])
    }

    fn list(&mut self, edge: [u32; 2]) {
        for d in 0..2 {
            let ends = self.ends(d, edge);
            self.near[d].add(edge, ends);
        }
    }

    fn strike(&mut self, edge: [u32; 2]) {
        for d in 0..2 {
            let ends = self.ends(d, edge);
            self.near[d].remove(edge, ends);
        }
    }

    /// The front in one design.
    pub(super) fn core(&self, design: usize) -> BoundaryRings {
        let ring = |ring: &Vec<u32>| -> Vec<DVec2> {
            let at = |&v: &u32| self.points[design][v as usize];
            ring.iter().map(at).collect()
        };
        BoundaryRings::of(&self.rings.iter().map(ring).collect::<Vec<_>>())
    }

    pub(super) fn size(&self) -> usize {
        self.rings.iter().map(Vec::len).sum()
    }
}

/// One ring of the front on its turn; the others stand still.
pub(super) struct FrontRing<'a> {
    coarse: &'a mut AdvancingFront,
    ring: usize,
    kept: &'a HashSet<u32>,
}

impl<'a> FrontRing<'a> {
    pub(super) fn of(coarse: &'a mut AdvancingFront, ring: usize, kept: &'a HashSet<u32>) -> Self {
        Self { coarse, ring, kept }
    }

    /// Once around, from another place at each turn.
    pub(super) fn advance(
        &mut self,
        turn: usize,
        progress: &dyn Progress,
    ) -> Result<(), Cancelled> {
        // The same start would try the same stretches, which have not fitted.
        let len = self.len();
        let mut at = turn % 3;
        let end = at + len;
        while at < end {
            still_wanted(progress)?;
            at += self.step(at % self.len()).unwrap_or(1);
        }
        Ok(())
    }

    fn len(&self) -> usize {
        self.coarse.rings[self.ring].len()
    }

    /// The vertex so many places along the ring.
    fn vertex(&self, at: usize) -> u32 {
        self.coarse.rings[self.ring][at % self.len()]
    }

    fn place(&self, design: usize, vertex: u32) -> DVec2 {
        self.coarse.points[design][vertex as usize]
    }

    /// Replaces a stretch that starts at `at`, and says how many old points
    /// that passes.
    fn step(&mut self, at: usize) -> Option<usize> {
        // A cut makes no new point, so it is the better of the two.
        if self.cut_corner(at) {
            return Some(2);
        }
        STRETCHES
            .into_iter()
            .find(|&k| self.replace(at, k).is_some())
    }

    fn cut_corner(&mut self, at: usize) -> bool {
        let stretch = [0, 1, 2].map(|k| self.vertex(at + k));
        // Three corners have to be left for the ring.
        if self.len() < 4 || self.is_kept(&stretch) {
            return false;
        }
        let fits = (0..2).all(|d| {
            let corners = stretch.map(|v| self.place(d, v));
            face_cost::is_positive(corners)
                && face_cost::shape(corners) <= SHAPELY
                && self.sides(d, at, 2).iter().all(|&[a, b]| {
                    let tip = |end| orient2d(a, b, end) > 0.0 || a == end || b == end;
                    tip(corners[0]) && tip(corners[2])
                })
                && self.is_free(d, stretch[0], corners[2], &[stretch[2]])
                && !self.holds_ring(d, &[corners])
        });
        if fits {
            self.coarse.faces.push(stretch);
            self.splice(at, 2, None);
        }
        fits
    }

    fn is_kept(&self, stretch: &[u32]) -> bool {
        stretch.iter().any(|v| self.kept.contains(v))
    }

    /// The stretch of `k` edges replaced by two to a point seen from all.
    /// None where it does not fit.
    fn replace(&mut self, at: usize, k: usize) -> Option<()> {
        let stretch: Vec<u32> = (0..=k).map(|i| self.vertex(at + i)).collect();
        if self.len() < k + 2 || self.is_kept(&stretch) {
            return None;
        }
        let p = self.common_point(0, at, &stretch)?;
        let q = self.common_point(1, at, &stretch)?;
        let new = self.coarse.points[0].len() as u32;
        self.coarse.points[0].push(p);
        self.coarse.points[1].push(q);
        let faces = stretch.windows(2).map(|edge| [edge[0], edge[1], new]);
        self.coarse.faces.extend(faces);
        self.splice(at, k, Some(new));
        Some(())
    }

    /// Takes the inner vertices of a stretch out of the ring.
    fn splice(&mut self, at: usize, k: usize, new: Option<u32>) {
        let len = self.len();
        for i in at..at + k {
            let edge = [self.vertex(i), self.vertex(i + 1)];
            self.coarse.strike(edge);
        }
        let [first, last] = [self.vertex(at), self.vertex(at + k)];
        let middle = new.unwrap_or(last);
        self.coarse.list([first, middle]);
        if new.is_some() {
            self.coarse.list([middle, last]);
        }
        let ring = &mut self.coarse.rings[self.ring];
        ring.rotate_left(at);
        ring.splice(1..k, new);
        // Back, so that places before the stretch keep their numbers.
        let now = ring.len();
        ring.rotate_right(at.min(now) % now.max(1));
        debug_assert!(now < len);
    }

    /// The lines that a new vertex has to be left of: the stretch's edges and
    /// those beside it at corners less than straight.
    fn sides(&self, d: usize, at: usize, k: usize) -> Vec<[DVec2; 2]> {
        let n = self.len();
        let place = |i: usize| self.place(d, self.vertex(i));
        // A corner that is cut off gets no vertex that would have to see it.
        let mut sides: Vec<[DVec2; 2]> = (0..k)
            .filter(|_| k > 2)
            .map(|i| [place(at + i), place(at + i + 1)])
            .collect();
        let before = [place(at + n - 1), place(at), place(at + 1)];
        let after = [place(at + k - 1), place(at + k), place(at + k + 1)];
        if orient2d(before[0], before[1], before[2]) > 0.0 {
            sides.push([before[0], before[1]]);
        }
        if orient2d(after[0], after[1], after[2]) > 0.0 {
            sides.push([after[1], after[2]]);
        }
        sides
    }

    /// A point in one design that sees the whole stretch, with room around.
    fn common_point(&self, d: usize, at: usize, stretch: &[u32]) -> Option<DVec2> {
        let places: Vec<DVec2> = stretch.iter().map(|&v| self.place(d, v)).collect();
        let middle = places.iter().sum::<DVec2>() / places.len() as f64;
        let extent = places
            .iter()
            .map(|p| p.distance(middle))
            .fold(0.0, f64::max);
        let sides = self.sides(d, at, stretch.len() - 1);
        let last = places.len() - 1;
        // The square about the middle keeps the kernel near its stretch: an
        // open one would reach across the piece.
        REACHES.into_iter().find_map(|reach| {
            let point = centre_of_kernel(middle, reach * extent, &sides)?;
            let sees = |p: DVec2| {
                self.is_free(d, stretch[0], p, &[]) && self.is_free(d, stretch[last], p, &[])
            };
            let fan: Vec<[DVec2; 3]> = places
                .windows(2)
                .map(|edge| [edge[0], edge[1], point])
                .collect();
            // Exactly: the clipping was not.
            let fits = sides.iter().all(|&[a, b]| orient2d(a, b, point) > 0.0)
                && sees(point)
                && sees(middle + ROOM * (point - middle))
                && !self.holds_ring(d, &fan);
            fits.then_some(point)
        })
    }

    /// Whether the straight way from a vertex of the front to a point
    /// touches no edge of the front but those at the vertex and at `others`.
    fn is_free(&self, d: usize, from: u32, to: DVec2, others: &[u32]) -> bool {
        let way = [self.place(d, from), to];
        !self.coarse.near[d].any(way, |edge| {
            !edge.contains(&from)
                && !others.iter().any(|v| edge.contains(v))
                && segments_touch(way, self.coarse.ends(d, edge))
        })
    }

    /// Whether another ring lies in one of the triangles.
    fn holds_ring(&self, d: usize, triangles: &[[DVec2; 3]]) -> bool {
        let rings = self.coarse.rings.iter().enumerate();
        let mut others = rings.filter(|(r, _)| *r != self.ring);
        others.any(|(_, ring)| {
            // Rings touch no sight line, so that one point tells for all.
            let p = self.place(d, ring[0]);
            triangles.iter().any(|&[a, b, c]| {
                [[a, b], [b, c], [c, a]]
                    .iter()
                    .all(|&[a, b]| orient2d(a, b, p) >= 0.0)
            })
        })
    }
}

/// The mean corner of what is left of all lines within a square.
fn centre_of_kernel(middle: DVec2, half: f64, sides: &[[DVec2; 2]]) -> Option<DVec2> {
    let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
    let mut kernel: Vec<DVec2> = corners
        .iter()
        .map(|&(x, y)| middle + half * DVec2::new(x, y))
        .collect();
    for &[a, b] in sides {
        let height = |p: DVec2| (b - a).perp_dot(p - a);
        let mut cut = Vec::with_capacity(kernel.len() + 1);
        for (p, q) in ring_edges(&kernel) {
            let (h, g) = (height(p), height(q));
            if h > 0.0 {
                cut.push(p);
            }
            if (h > 0.0) != (g > 0.0) {
                cut.push(p.lerp(q, h / (h - g)));
            }
        }
        kernel = cut;
        if kernel.len() < 3 {
            return None;
        }
    }
    Some(kernel.iter().sum::<DVec2>() / kernel.len() as f64)
}
