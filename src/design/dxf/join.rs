//! Joins open curves end to end into closed rings.
//!
//! End points closer than a given distance form one node of a graph. Curves with a free end are
//! removed repeatedly until every node joins at least two curves. Of the remaining curves, a
//! connected set in which an odd number of curves meet at some node is a network, such as the walls
//! of a plan: no set of rings uses each of its curves once, so it forms no rings. The other curves
//! are traversed, and whenever the traversal returns to a node, a ring is closed. Where four or
//! more curves meet, the choice of the next curve is arbitrary; it does not change the area under
//! the even-odd rule.

use crate::geometry::DVec2;
use std::collections::{HashMap, HashSet};

/// Closed rings of joined curves, and the curves that belong to no ring.
#[derive(Debug, Default)]
pub(super) struct JoinedCurves {
    /// Closed rings; the last point of a ring is not its first.
    pub rings: Vec<Vec<DVec2>>,
    /// For each ring, the indices of its curves in the input.
    pub ring_curves: Vec<Vec<usize>>,
    /// Indices of the curves in the input that belong to no ring, in ascending order; duplicates
    /// are not among them.
    pub loose: Vec<usize>,
    /// Number of duplicate curves that were ignored.
    pub duplicates: usize,
}

/// Joins open curves of at least two points each. End points up to the distance `within` apart
/// become one node.
pub(super) fn join_curves(curves: Vec<Vec<DVec2>>, within: f64) -> JoinedCurves {
    let mut result = JoinedCurves::default();
    let (curves, indices) = result.without_duplicates(curves);
    let mut graph = EndpointGraph::of(&curves, within);
    graph.remove_loose();
    graph.remove_networks();
    let is_loose = graph.is_used.clone();
    for start in 0..curves.len() {
        graph.trace(start, &curves, &mut result);
    }
    for curve in result.ring_curves.iter_mut().flatten() {
        *curve = indices[*curve];
    }
    let loose = indices.into_iter().zip(is_loose);
    result.loose = loose
        .filter_map(|(index, is)| is.then_some(index))
        .collect();
    result
}

impl JoinedCurves {
    /// Removes and counts duplicate curves; returns the other curves and their indices in the
    /// input.
    fn without_duplicates(&mut self, curves: Vec<Vec<DVec2>>) -> (Vec<Vec<DVec2>>, Vec<usize>) {
        let bits = |p: &DVec2| [p.x + 0.0, p.y + 0.0].map(f64::to_bits); // turns -0 into 0
        let mut seen = HashSet::new();
        let (mut unique, mut indices) = (Vec::with_capacity(curves.len()), Vec::new());
        for (index, curve) in curves.into_iter().enumerate() {
            // A reversed copy is also a duplicate.
            let forward: Vec<_> = curve.iter().map(bits).collect();
            let backward = forward.iter().rev().copied().collect();
            if seen.insert(forward.min(backward)) {
                unique.push(curve);
                indices.push(index);
            } else {
                self.duplicates += 1;
            }
        }
        (unique, indices)
    }
}

/// Graph whose edges are curves and whose nodes are their end points; end points that are close
/// together are one node.
struct EndpointGraph {
    /// For each curve, the nodes of its first and last point.
    ends: Vec<[usize; 2]>,
    /// For each node, the curves that end there. A curve that starts and ends at the node is listed
    /// twice.
    curves_at: Vec<Vec<usize>>,
    /// For each curve, whether it is done: either traversed, or removed because it has a free end
    /// and so belongs to no ring.
    is_used: Vec<bool>,
}

impl EndpointGraph {
    fn of(curves: &[Vec<DVec2>], within: f64) -> Self {
        let mut places = EndpointIndex::new(curves, within);
        let both = |curve: &Vec<DVec2>| [curve[0], curve[curve.len() - 1]].map(|p| places.of(p));
        let ends: Vec<_> = curves.iter().map(both).collect();
        let mut curves_at = vec![Vec::new(); places.points.len()];
        for (curve, both) in ends.iter().enumerate() {
            for &place in both {
                curves_at[place].push(curve);
            }
        }
        Self {
            is_used: vec![false; ends.len()],
            ends,
            curves_at,
        }
    }

    /// Repeatedly removes curves with a free end until no curve has one.
    fn remove_loose(&mut self) {
        let mut degree: Vec<usize> = self.curves_at.iter().map(Vec::len).collect();
        let mut free_nodes: Vec<usize> = (0..degree.len()).filter(|&p| degree[p] == 1).collect();
        while let Some(place) = free_nodes.pop() {
            let Some(curve) = self.unused_at(place) else {
                continue; // the curve was already removed from its other end
            };
            self.is_used[curve] = true;
            let [first, last] = self.ends[curve];
            let other = if first == place { last } else { first };
            // The removal may leave one more curve with a free end. A closed curve counts twice at
            // its node and so is never removed.
            degree[other] -= 1;
            if degree[other] == 1 {
                free_nodes.push(other);
            }
        }
    }

    /// Removes all curves that are connected to a node at which an odd number of curves meet.
    fn remove_networks(&mut self) {
        let is_used = &self.is_used;
        let degree = |place: usize| {
            let curves = self.curves_at[place].iter();
            curves.filter(|&&curve| !is_used[curve]).count()
        };
        let mut nodes: Vec<usize> = (0..self.curves_at.len())
            .filter(|&place| degree(place) % 2 == 1)
            .collect();
        while let Some(place) = nodes.pop() {
            for &curve in &self.curves_at[place] {
                if !std::mem::replace(&mut self.is_used[curve], true) {
                    nodes.extend(self.ends[curve]);
                }
            }
        }
    }

    /// Returns a curve that ends at the node `place` and has been neither removed nor traversed;
    /// `None` if there is none.
    fn unused_at(&mut self, place: usize) -> Option<usize> {
        let here = &mut self.curves_at[place];
        while here.last().is_some_and(|&curve| self.is_used[curve]) {
            here.pop();
        }
        here.last().copied()
    }

    /// Traverses unused curves, beginning with the curve `start`, and collects the rings that
    /// close.
    fn trace(&mut self, start: usize, curves: &[Vec<DVec2>], result: &mut JoinedCurves) {
        if self.is_used[start] {
            return;
        }
        let mut here = self.ends[start][0];
        let mut trail: Vec<TrailStep> = Vec::new();
        // For each node on the trail, the index in `trail` of the curve that starts there.
        let mut steps_from: HashMap<usize, usize> = HashMap::from([(here, 0)]);
        let mut next = Some(start);
        while let Some(curve) = next {
            self.is_used[curve] = true;
            let [first, last] = self.ends[curve];
            let is_forward = first == here;
            trail.push(TrailStep {
                from: here,
                curve,
                is_forward,
            });
            here = if is_forward { last } else { first };
            match steps_from.get(&here).copied() {
                Some(closed) => {
                    // The nodes of the closed ring, except its start, are no longer on the trail.
                    for step in &trail[closed + 1..] {
                        steps_from.remove(&step.from);
                    }
                    let steps: Vec<TrailStep> = trail.drain(closed..).collect();
                    let of_ring = steps.iter().map(|step| step.curve);
                    result.ring_curves.push(of_ring.collect());
                    let ring = steps.iter().flat_map(|step| step.points(curves));
                    result.rings.push(ring.collect());
                }
                None => {
                    steps_from.insert(here, trail.len());
                }
            }
            next = self.unused_at(here);
        }
    }
}

/// Curve on the way through the graph, traversed forwards or backwards.
struct TrailStep {
    /// Node at which the traversal of the curve starts.
    from: usize,
    curve: usize,
    is_forward: bool,
}

impl TrailStep {
    /// Returns the points of the curve in the order of traversal, without the last, which is
    /// the first point of the next curve.
    fn points<'c>(&self, curves: &'c [Vec<DVec2>]) -> impl Iterator<Item = DVec2> + use<'c> {
        let points = &curves[self.curve];
        let (is_forward, last) = (self.is_forward, points.len() - 1);
        (0..last).map(move |i| points[if is_forward { i } else { last - i }])
    }
}

/// Spatial hash that assigns end points to nodes, so that points close to each other share a node.
struct EndpointIndex {
    /// Lower left corner of the grid cell (0, 0).
    origin: DVec2,
    /// Maximum distance between a node and its points; also the width of a grid cell.
    within: f64,
    /// Position of each node: the first point that was assigned to it.
    points: Vec<DVec2>,
    /// Nodes in each grid cell.
    cells: HashMap<[i64; 2], Vec<usize>>,
}

impl EndpointIndex {
    fn new(curves: &[Vec<DVec2>], within: f64) -> Self {
        Self {
            origin: curves.first().map_or(DVec2::ZERO, |curve| curve[0]),
            within,
            points: Vec::new(),
            cells: HashMap::new(),
        }
    }

    /// Returns the node of a point; creates it if no node is close enough.
    fn of(&mut self, p: DVec2) -> usize {
        let cell = ((p - self.origin) / self.within).floor();
        let [x, y] = [cell.x as i64, cell.y as i64];
        // A cell is as wide as the maximum distance, so the 3 × 3 cells around `p` contain all
        // nodes that are close enough.
        let block = (-1..=1).flat_map(|i| (-1..=1).map(move |j| [i, j]));
        let existing = block
            // Saturating, because the conversion of a distant cell to an integer may have
            // saturated.
            .filter_map(|[i, j]| self.cells.get(&[x.saturating_add(i), y.saturating_add(j)]))
            .flatten()
            .find(|&&place| self.points[place].distance(p) <= self.within);
        if let Some(&place) = existing {
            return place;
        }
        self.points.push(p);
        self.cells
            .entry([x, y])
            .or_default()
            .push(self.points.len() - 1);
        self.points.len() - 1
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn curve(points: &[(i32, i32)]) -> Vec<DVec2> {
        points
            .iter()
            .map(|&(x, y)| DVec2::new(x.into(), y.into()))
            .collect()
    }

    #[test]
    fn lines_in_any_order_and_direction_form_a_ring() {
        let lines = [
            [(0, 0), (4, 0)],
            [(0, 4), (4, 4)],
            [(4, 4), (4, 0)],
            [(0, 4), (0, 0)],
            [(0, 0), (4, 0)],
        ];
        let found = join_curves(lines.iter().map(|l| curve(l)).collect(), 0.1);
        assert_eq!(found.rings.len(), 1);
        assert_eq!(found.rings[0].len(), 4);
        assert_eq!((found.duplicates, found.loose), (1, vec![]));
    }

    #[test]
    fn loose_curves_do_not_break_a_ring() {
        let lines = [
            curve(&[(0, 0), (4, 0), (4, 4)]),
            curve(&[(4, 4), (9, 9)]),
            curve(&[(9, 9), (9, 8)]),
            curve(&[(4, 4), (0, 0)]),
        ];
        let found = join_curves(lines.to_vec(), 0.1);
        assert_eq!((found.rings.len(), found.loose), (1, vec![1, 2]));
    }

    #[test]
    fn rings_that_meet_in_a_point_are_all_found() {
        let leaf = |x: i32, y: i32| curve(&[(0, 0), (x, 0), (x, y), (0, 0)]);
        let lines = vec![
            leaf(3, 1),
            leaf(-3, 1),
            curve(&[(0, 0), (1, 5)]),
            curve(&[(1, 5), (0, 0), (0, 0)]),
        ];
        let found = join_curves(lines, 0.1);
        assert_eq!((found.rings.len(), found.loose), (3, vec![]));
    }

    #[test]
    fn a_gap_is_bridged_within_the_distance_only() {
        let lines = vec![
            curve(&[(0, 0), (40, 0), (40, 40)]),
            curve(&[(0, 1), (41, 40)]),
        ];
        assert_eq!(join_curves(lines.clone(), 2.0).rings.len(), 1);
        let apart = join_curves(lines, 0.5);
        assert_eq!((apart.rings.len(), apart.loose), (0, vec![0, 1]));
    }

    #[test]
    fn a_network_of_lines_forms_no_rings() {
        // A square with a wall across it, and a square apart.
        let square = |x: i32| {
            let corners = [(x, 0), (x + 4, 0), (x + 4, 4), (x, 4)];
            (0..4).map(move |k| curve(&[corners[k], corners[(k + 1) % 4]]))
        };
        let wall = curve(&[(0, 0), (4, 4)]);
        let lines = square(0).chain([wall]).chain(square(9)).collect();
        let found = join_curves(lines, 0.1);
        assert_eq!((found.rings.len(), found.loose), (1, vec![0, 1, 2, 3, 4]));
    }
}
