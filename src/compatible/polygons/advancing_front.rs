//! Advancing front that triangulates a piece (a matched connected part) from its boundary inwards,
//! in two designs at once.
//!
//! The front advances in steps. Each step either cuts off a corner of the front, or replaces a
//! stretch of the front by two edges to a new point. In each design, the new point sees the whole
//! stretch.

use super::boundary_rings::BoundaryRings;
use super::edge_grid::EdgeGrid;
use super::face_cost;
use crate::geometry::{DVec2, orient2d, ring_edges, segments_touch};
use crate::work::progress::{Cancelled, Progress, check_cancelled};
use std::collections::HashSet;

/// Lengths, in edges, of the stretches of the front that are tried, longest first (heuristic). A
/// stretch is replaced by two edges, so it needs at least three edges to shorten the front.
const STRETCHES: [usize; 4] = [7, 5, 4, 3];
/// Half sides of the squares in which a new point is sought, in units of the stretch's radius
/// (heuristic). The squares are centred at the mean of the stretch's vertices; the radius is the
/// largest distance of a vertex from this mean. The largest square comes first, because it gives
/// good angles.
const REACHES: [f64; 5] = [0.6, 0.3, 0.12, 0.04, 0.01];
/// A new point is used only if the point this many times as far from the middle of its stretch also
/// sees both ends of the stretch (heuristic: this leaves room where stretches of the front approach
/// each other).
const CLEARANCE: f64 = 1.5;
/// Maximum [`shape`](face_cost::shape) term of a corner triangle that is cut off (heuristic). The
/// term is 1 for an equilateral triangle and 3 for a right triangle with legs 1 and 5.
const MAX_CORNER_SHAPE: f64 = 3.0;

/// Advancing front: the rings that bound the region left to triangulate, and the faces that have
/// already been built between these rings and the piece's boundary.
pub(super) struct AdvancingFront {
    /// Positions of all vertices in both designs. The vertices of the piece's rings come first.
    pub(super) points: [Vec<DVec2>; 2],
    /// Faces behind the front, between it and the piece's boundary.
    pub(super) faces: Vec<[u32; 3]>,
    /// Rings of the front, as vertex indices in order.
    pub(super) rings: Vec<Vec<u32>>,
    /// For each design, a grid that finds the edges of the front near a line segment.
    near: [EdgeGrid; 2],
}

impl AdvancingFront {
    /// Creates a front along the boundary of the piece.
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
            coarse.insert_edge(edge);
        }
        coarse
    }

    /// Positions of the ends of an edge in one design.
    fn ends(&self, design: usize, edge: [u32; 2]) -> [DVec2; 2] {
        edge.map(|v| self.points[design][v as usize])
    }

    /// Adds an edge of the front to the grids of both designs.
    fn insert_edge(&mut self, edge: [u32; 2]) {
        for d in 0..2 {
            let ends = self.ends(d, edge);
            self.near[d].add(edge, ends);
        }
    }

    /// Removes an edge of the front from the grids of both designs.
    fn remove_edge(&mut self, edge: [u32; 2]) {
        for d in 0..2 {
            let ends = self.ends(d, edge);
            self.near[d].remove(edge, ends);
        }
    }

    /// Returns the rings of the front with their positions in one design.
    pub(super) fn front_rings(&self, design: usize) -> BoundaryRings {
        let ring = |ring: &Vec<u32>| -> Vec<DVec2> {
            let at = |&v: &u32| self.points[design][v as usize];
            ring.iter().map(at).collect()
        };
        BoundaryRings::of(&self.rings.iter().map(ring).collect::<Vec<_>>())
    }

    /// Number of points on the front.
    pub(super) fn size(&self) -> usize {
        self.rings.iter().map(Vec::len).sum()
    }
}

/// One ring of the front while it advances. The other rings stay where they are.
pub(super) struct FrontRing<'a> {
    coarse: &'a mut AdvancingFront,
    ring: usize,
    /// Vertices that must stay on the front.
    frozen: &'a HashSet<u32>,
}

impl<'a> FrontRing<'a> {
    /// Selects the ring with the index `ring` as the one that advances.
    pub(super) fn of(
        coarse: &'a mut AdvancingFront,
        ring: usize,
        frozen: &'a HashSet<u32>,
    ) -> Self {
        Self {
            coarse,
            ring,
            frozen,
        }
    }

    /// Makes one pass around the ring. Cuts off corners and replaces stretches wherever that is
    /// possible. `turn` is the number of earlier passes; the pass starts at position `turn` modulo
    /// 3.
    pub(super) fn advance(
        &mut self,
        turn: usize,
        progress: &dyn Progress,
    ) -> Result<(), Cancelled> {
        // The start differs from pass to pass. With the same start, a pass would mostly try
        // stretches that have already failed.
        let len = self.len();
        let mut at = turn % 3;
        let end = at + len;
        while at < end {
            check_cancelled(progress)?;
            at += self.step(at % self.len()).unwrap_or(1);
        }
        Ok(())
    }

    /// Number of vertices of the ring.
    fn len(&self) -> usize {
        self.coarse.rings[self.ring].len()
    }

    /// Vertex at position `at` along the ring; positions wrap around.
    fn vertex(&self, at: usize) -> u32 {
        self.coarse.rings[self.ring][at % self.len()]
    }

    /// Position of a vertex in one design.
    fn place(&self, design: usize, vertex: u32) -> DVec2 {
        self.coarse.points[design][vertex as usize]
    }

    /// Cuts off the corner at position `at + 1`, or else replaces the longest possible stretch that
    /// starts at `at`. Returns how many edges of the ring were replaced; `None` if nothing fits.
    fn step(&mut self, at: usize) -> Option<usize> {
        // Cutting off a corner adds no vertex, so it is tried first.
        if self.cut_corner(at) {
            return Some(2);
        }
        STRETCHES
            .into_iter()
            .find(|&k| self.replace(at, k).is_some())
    }

    /// Cuts off the corner at position `at + 1` if that is valid in both designs. Returns whether
    /// it was cut off.
    fn cut_corner(&mut self, at: usize) -> bool {
        let stretch = [0, 1, 2].map(|k| self.vertex(at + k));
        // The ring needs at least three corners.
        if self.len() < 4 || self.has_frozen(&stretch) {
            return false;
        }
        // In each design the corner triangle must be positive, well shaped and empty. The edge that
        // replaces the corner must, from both of its ends, run into the region left to triangulate.
        let fits = (0..2).all(|d| {
            let corners = stretch.map(|v| self.place(d, v));
            face_cost::is_positive(corners)
                && face_cost::shape(corners) <= MAX_CORNER_SHAPE
                && self.sides(d, at, 2).iter().all(|&[a, b]| {
                    let is_left = |end| orient2d(a, b, end) > 0.0 || a == end || b == end;
                    is_left(corners[0]) && is_left(corners[2])
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

    /// Returns whether a stretch contains a frozen vertex.
    fn has_frozen(&self, stretch: &[u32]) -> bool {
        stretch.iter().any(|v| self.frozen.contains(v))
    }

    /// Replaces the `k` edges that start at position `at` by two edges to a new vertex that sees
    /// all of them in each design. `None` if no such vertex is found.
    fn replace(&mut self, at: usize, k: usize) -> Option<()> {
        let stretch: Vec<u32> = (0..=k).map(|i| self.vertex(at + i)).collect();
        if self.len() < k + 2 || self.has_frozen(&stretch) {
            return None;
        }
        let p = self.common_point(0, at, &stretch)?;
        let q = self.common_point(1, at, &stretch)?;
        let new = self.coarse.points[0].len() as u32;
        self.coarse.points[0].push(p);
        self.coarse.points[1].push(q);
        // The faces between the stretch and the new vertex form a fan; they now lie behind the
        // front.
        let faces = stretch.windows(2).map(|edge| [edge[0], edge[1], new]);
        self.coarse.faces.extend(faces);
        self.splice(at, k, Some(new));
        Some(())
    }

    /// Removes the inner vertices of a stretch of `k` edges from the ring and puts `new`, if any,
    /// in their place.
    fn splice(&mut self, at: usize, k: usize, new: Option<u32>) {
        let len = self.len();
        for i in at..at + k {
            let edge = [self.vertex(i), self.vertex(i + 1)];
            self.coarse.remove_edge(edge);
        }
        let [first, last] = [self.vertex(at), self.vertex(at + k)];
        let middle = new.unwrap_or(last);
        self.coarse.insert_edge([first, middle]);
        if new.is_some() {
            self.coarse.insert_edge([middle, last]);
        }
        let ring = &mut self.coarse.rings[self.ring];
        ring.rotate_left(at);
        // The stretch now starts at index 0, so its inner vertices have the indices 1..k.
        ring.splice(1..k, new);
        // The ring is rotated back, so that positions before the stretch stay valid.
        let now = ring.len();
        ring.rotate_right(at.min(now) % now.max(1));
        debug_assert!(now < len);
    }

    /// Returns directed lines in the design `d`. The new vertex for the stretch of `k` edges from
    /// position `at` must lie to the left of all of them. They are the edges of the stretch and, at
    /// each end of the stretch that is a convex corner, the next edge of the ring beyond that end.
    fn sides(&self, d: usize, at: usize, k: usize) -> Vec<[DVec2; 2]> {
        let n = self.len();
        let place = |i: usize| self.place(d, self.vertex(i));
        // Cutting off a corner (k = 2) adds no vertex, so the edges of the stretch are not needed.
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

    /// Returns a point that sees the whole stretch in the design `d` and satisfies [`CLEARANCE`];
    /// `None` if none is found.
    fn common_point(&self, d: usize, at: usize, stretch: &[u32]) -> Option<DVec2> {
        let places: Vec<DVec2> = stretch.iter().map(|&v| self.place(d, v)).collect();
        let middle = places.iter().sum::<DVec2>() / places.len() as f64;
        let extent = places
            .iter()
            .map(|p| p.distance(middle))
            .fold(0.0, f64::max);
        let sides = self.sides(d, at, stretch.len() - 1);
        let last = places.len() - 1;
        // The kernel (the points that see the whole stretch) is clipped to a square around the
        // stretch. Otherwise it could extend across the whole piece.
        REACHES.into_iter().find_map(|reach| {
            let point = centre_of_kernel(middle, reach * extent, &sides)?;
            // The sight lines from the first and the last vertex of the stretch bound the fan of
            // new faces. If no front edge touches them, the only thing that can still lie inside
            // the fan is a whole ring of the front.
            let sees = |p: DVec2| {
                self.is_free(d, stretch[0], p, &[]) && self.is_free(d, stretch[last], p, &[])
            };
            let fan: Vec<[DVec2; 3]> = places
                .windows(2)
                .map(|edge| [edge[0], edge[1], point])
                .collect();
            // Checked by exact predicates, because the computed point is subject to rounding.
            let fits = sides.iter().all(|&[a, b]| orient2d(a, b, point) > 0.0)
                && sees(point)
                && sees(middle + CLEARANCE * (point - middle))
                && !self.holds_ring(d, &fan);
            fits.then_some(point)
        })
    }

    /// Returns whether the line segment from the front vertex `from` to the point `to` touches no
    /// edge of the front. Edges at `from` or at one of the vertices `others` do not count.
    fn is_free(&self, d: usize, from: u32, to: DVec2, others: &[u32]) -> bool {
        let segment = [self.place(d, from), to];
        !self.coarse.near[d].any_edge_near(segment, |edge| {
            !edge.contains(&from)
                && !others.iter().any(|v| edge.contains(v))
                && segments_touch(segment, self.coarse.ends(d, edge))
        })
    }

    /// Returns whether another ring of the front lies inside one of the triangles.
    fn holds_ring(&self, d: usize, triangles: &[[DVec2; 3]]) -> bool {
        let rings = self.coarse.rings.iter().enumerate();
        let mut others = rings.filter(|(r, _)| *r != self.ring);
        others.any(|(_, ring)| {
            // No ring touches a sight line, so one point decides for the whole ring.
            let p = self.place(d, ring[0]);
            triangles.iter().any(|&[a, b, c]| {
                [[a, b], [b, c], [c, a]]
                    .iter()
                    .all(|&[a, b]| orient2d(a, b, p) >= 0.0)
            })
        })
    }
}

/// Clips a square to the left side of all the lines `sides` and returns the mean of the corners of
/// the remaining polygon; `None` if nothing remains. The square is centred at `middle` and has the
/// half side `half`.
fn centre_of_kernel(middle: DVec2, half: f64, sides: &[[DVec2; 2]]) -> Option<DVec2> {
    let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
    let mut kernel: Vec<DVec2> = corners
        .iter()
        .map(|&(x, y)| middle + half * DVec2::new(x, y))
        .collect();
    // Keeps the part of the polygon to the left of each line (Sutherland, Hodgman 1974).
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
