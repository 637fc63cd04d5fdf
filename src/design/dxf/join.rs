//! Curves joined end to end into rings.
//!
//! Ends closer than the given distance count as one place. Curves that hang
//! loose are taken away, one after the other, until every place joins two
//! curves or more; what is left is walked, and each time the walk comes back
//! to a place where it was, a ring is closed. Where more than two curves meet
//! the walk takes any: under the even-odd rule the area is the same whenever
//! an even number meets.

use crate::geometry::DVec2;
use std::collections::{HashMap, HashSet};

/// What joining gives.
#[derive(Debug, Default)]
pub(super) struct JoinedCurves {
    pub rings: Vec<Vec<DVec2>>,
    /// For each ring the numbers of its curves.
    pub of_rings: Vec<Vec<usize>>,
    /// A loose end of each curve that belongs to no ring.
    pub loose: Vec<DVec2>,
    /// Curves that are there more than once.
    pub duplicates: usize,
}

/// Joins open curves, each of two points at least.
pub(super) fn join_curves(curves: Vec<Vec<DVec2>>, within: f64) -> JoinedCurves {
    let mut result = JoinedCurves::default();
    let (curves, numbers) = result.without_duplicates(curves);
    let mut graph = EndpointGraph::of(&curves, within);
    result.loose = graph.without_loose(&curves);
    for start in 0..curves.len() {
        graph.walk(start, &curves, &mut result);
    }
    for curve in result.of_rings.iter_mut().flatten() {
        *curve = numbers[*curve];
    }
    result
}

impl JoinedCurves {
    /// The others, and their numbers.
    fn without_duplicates(&mut self, curves: Vec<Vec<DVec2>>) -> (Vec<Vec<DVec2>>, Vec<usize>) {
        let bits = |p: &DVec2| [p.x + 0.0, p.y + 0.0].map(f64::to_bits); // -0 is 0
        let mut seen = HashSet::new();
        let (mut kept, mut numbers) = (Vec::with_capacity(curves.len()), Vec::new());
        for (number, curve) in curves.into_iter().enumerate() {
            // The same curve drawn the other way is the same.
            let forward: Vec<_> = curve.iter().map(bits).collect();
            let backward = forward.iter().rev().copied().collect();
            if seen.insert(forward.min(backward)) {
                kept.push(curve);
                numbers.push(number);
            } else {
                self.duplicates += 1;
            }
        }
        (kept, numbers)
    }
}

/// Which curves meet where.
struct EndpointGraph {
    /// The places of each curve's first and last point.
    ends: Vec<[usize; 2]>,
    /// The curves at each place; one that begins and ends there twice.
    at: Vec<Vec<usize>>,
    is_used: Vec<bool>,
}

impl EndpointGraph {
    fn of(curves: &[Vec<DVec2>], within: f64) -> Self {
        let mut places = EndpointIndex::new(curves, within);
        let both = |curve: &Vec<DVec2>| [curve[0], curve[curve.len() - 1]].map(|p| places.of(p));
        let ends: Vec<_> = curves.iter().map(both).collect();
        let mut at = vec![Vec::new(); places.points.len()];
        for (curve, both) in ends.iter().enumerate() {
            for &place in both {
                at[place].push(curve);
            }
        }
        Self {
            is_used: vec![false; ends.len()],
            ends,
            at,
        }
    }

    /// Takes curves that hang loose, and returns a loose end of each.
    fn without_loose(&mut self, curves: &[Vec<DVec2>]) -> Vec<DVec2> {
        let mut degree: Vec<usize> = self.at.iter().map(Vec::len).collect();
        let mut ripe: Vec<usize> = (0..degree.len()).filter(|&p| degree[p] == 1).collect();
        let mut loose = Vec::new();
        while let Some(place) = ripe.pop() {
            let Some(curve) = self.unused_at(place) else {
                continue; // taken from its other end
            };
            self.is_used[curve] = true;
            let [first, last] = self.ends[curve];
            let points = &curves[curve];
            loose.push(points[if first == place { 0 } else { points.len() - 1 }]);
            let other = if first == place { last } else { first };
            // What hung on it alone now hangs loose in turn. A curve that comes back to
            // its own place counts twice there and is never loose.
            degree[other] -= 1;
            if degree[other] == 1 {
                ripe.push(other);
            }
        }
        loose
    }

    fn unused_at(&mut self, place: usize) -> Option<usize> {
        let here = &mut self.at[place];
        while here.last().is_some_and(|&curve| self.is_used[curve]) {
            here.pop();
        }
        here.last().copied()
    }

    /// Walks from a curve as far as there are curves.
    fn walk(&mut self, start: usize, curves: &[Vec<DVec2>], result: &mut JoinedCurves) {
        if self.is_used[start] {
            return;
        }
        let mut here = self.ends[start][0];
        let mut trail: Vec<TrailStep> = Vec::new();
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
                    // What the ring took with it may be passed again.
                    for step in &trail[closed + 1..] {
                        steps_from.remove(&step.from);
                    }
                    let steps: Vec<TrailStep> = trail.drain(closed..).collect();
                    let of_ring = steps.iter().map(|step| step.curve);
                    result.of_rings.push(of_ring.collect());
                    let ring = steps.iter().flat_map(|step| step.points(curves));
                    result.rings.push(ring.collect());
                }
                None => {
                    steps_from.insert(here, trail.len());
                }
            }
            next = self.unused_at(here);
        }
        let left = trail.iter().flat_map(|step| step.points(curves).next());
        result.loose.extend(left);
    }
}

struct TrailStep {
    from: usize,
    curve: usize,
    is_forward: bool,
}

impl TrailStep {
    /// The curve's points in the order of the walk, without the last, which is
    /// the first of the next.
    fn points<'c>(&self, curves: &'c [Vec<DVec2>]) -> impl Iterator<Item = DVec2> + use<'c> {
        let points = &curves[self.curve];
        let (is_forward, last) = (self.is_forward, points.len() - 1);
        (0..last).map(move |i| points[if is_forward { i } else { last - i }])
    }
}

/// Points further apart than a distance, with what is nearer to one of them
/// counted as it.
struct EndpointIndex {
    origin: DVec2,
    within: f64,
    points: Vec<DVec2>,
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

    fn of(&mut self, p: DVec2) -> usize {
        let cell = ((p - self.origin) / self.within).floor();
        let [x, y] = [cell.x as i64, cell.y as i64];
        // Cells are as wide as the distance, so that nothing nearer lies further out.
        let near = (-1..=1).flat_map(|i| (-1..=1).map(move |j| [i, j]));
        let known = near
            // Cells too far away for whole numbers keep the last one, and so does this.
            .filter_map(|[i, j]| self.cells.get(&[x.saturating_add(i), y.saturating_add(j)]))
            .flatten()
            .find(|&&place| self.points[place].distance(p) <= self.within);
        if let Some(&place) = known {
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
    fn lines_in_any_order_and_direction_make_a_ring() {
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
        assert_eq!((found.duplicates, found.loose.len()), (1, 0));
    }

    #[test]
    fn what_hangs_loose_does_not_break_the_ring() {
        let lines = [
            curve(&[(0, 0), (4, 0), (4, 4)]),
            curve(&[(4, 4), (9, 9)]),
            curve(&[(9, 9), (9, 8)]),
            curve(&[(4, 4), (0, 0)]),
        ];
        let found = join_curves(lines.to_vec(), 0.1);
        assert_eq!((found.rings.len(), found.loose.len()), (1, 2));
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
        assert_eq!((found.rings.len(), found.loose.len()), (3, 0));
    }

    #[test]
    fn a_gap_is_bridged_within_the_distance_only() {
        let lines = vec![
            curve(&[(0, 0), (40, 0), (40, 40)]),
            curve(&[(0, 1), (41, 40)]),
        ];
        assert_eq!(join_curves(lines.clone(), 2.0).rings.len(), 1);
        let apart = join_curves(lines, 0.5);
        assert_eq!((apart.rings.len(), apart.loose.len()), (0, 2));
    }
}
