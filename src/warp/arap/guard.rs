//! A guard: displacements of vertices that are added to a motion so that its outlines do not
//! collide.
//!
//! Displacements are given at several times and are zero at the first and the last of these. In
//! between, they follow cubic curves with the velocities of Catmull and Rom, so that the motion has
//! no jerks. Outside the time span, the motion is unchanged, bit for bit.

use crate::geometry::DVec2;
use crate::mesh::Subdivision;
use glam::Vec2;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::ops::Range;

/// Displacements of vertices at several times.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Guard {
    /// Times at which the displacements are given, in increasing order, within [0, 1].
    times: Vec<f64>,
    /// Indices, in increasing order, of the vertices that are displaced at one or more of the
    /// times.
    vertices: Vec<u32>,
    /// For each time, the displacement of each vertex in `vertices`. In single precision, as in the
    /// saved document, so that the proof covers the saved values.
    moved: Vec<Vec<Vec2>>,
}

/// The four times around a time t, and the weights of their displacements.
#[derive(Clone, Copy, Debug)]
pub(super) struct GuardMix {
    rows: [usize; 4],
    weights: [f64; 4],
}

impl Guard {
    /// Creates a guard. Each row holds the displacements of all vertices at one time. Returns
    /// `None` if the times do not increase within [0, 1], nothing is displaced, the rows differ in
    /// length, a displacement is not finite, or the first or the last row is not zero.
    pub(crate) fn new(times: Vec<f64>, rows: &[Vec<DVec2>]) -> Option<Self> {
        let count = rows.first()?.len();
        if rows.iter().any(|row| row.len() != count) {
            return None;
        }
        let is_moved = |vertex: &u32| rows.iter().any(|row| row[*vertex as usize] != DVec2::ZERO);
        let vertices: Vec<u32> = (0..count as u32).filter(is_moved).collect();
        let of_moved = |row: &Vec<DVec2>| -> Vec<Vec2> {
            let moved = vertices.iter().map(|&vertex| row[vertex as usize]);
            moved.map(|by| by.as_vec2()).collect()
        };
        let guard = Self {
            times,
            moved: rows.iter().map(of_moved).collect(),
            vertices,
        };
        guard.is_sound(count, f64::MAX).then_some(guard)
    }

    /// Returns whether the guard meets the conditions of [`Self::new`] and fits a mesh with
    /// `vertex_count` vertices, and no displacement is longer than `max_length`.
    pub(crate) fn is_sound(&self, vertex_count: usize, max_length: f64) -> bool {
        let [first, .., last] = self.moved.as_slice() else {
            return false;
        };
        let increase = self.times.windows(2).all(|pair| pair[0] < pair[1]);
        let within = self.times.iter().all(|t| (0.0..=1.0).contains(t));
        let ordered = self.vertices.windows(2).all(|pair| pair[0] < pair[1]);
        let last_vertex = self.vertices.last();
        let alike = self.moved.len() == self.times.len()
            && self
                .moved
                .iter()
                .all(|row| row.len() == self.vertices.len());
        increase
            && within
            && ordered
            && last_vertex.is_some_and(|&last| (last as usize) < vertex_count)
            && alike
            && self
                .moved
                .iter()
                .flatten()
                .all(|by| by.as_dvec2().length() <= max_length) // false for NaN
            && first.iter().chain(last).all(|&by| by == Vec2::ZERO)
    }

    /// Returns the times at which displacements are given.
    pub(crate) fn times(&self) -> &[f64] {
        &self.times
    }

    /// Returns the largest displacement, in units of the plane.
    pub(crate) fn farthest(&self) -> f64 {
        let each = self.moved.iter().flatten();
        each.map(|by| f64::from(by.length())).fold(0.0, f64::max)
    }

    /// Returns the sum of the squared displacements over all times and vertices.
    pub(crate) fn total(&self) -> f64 {
        let each = self.moved.iter().flatten();
        each.map(|by| f64::from(by.length_squared())).sum()
    }

    /// Returns the guard of the reversed motion.
    pub(super) fn backwards(&self) -> Self {
        Self {
            times: self.times.iter().rev().map(|t| 1.0 - t).collect(),
            vertices: self.vertices.clone(),
            moved: self.moved.iter().rev().cloned().collect(),
        }
    }

    /// Returns the guard of the subdivided mesh; `vertex_count` is the number of vertices before
    /// the subdivision. A midpoint gets the mean displacement of the ends of its edge.
    pub(super) fn subdivided(&self, fine: &Subdivision, vertex_count: usize) -> Self {
        let places = self.vertices.iter().enumerate();
        let mut places: BTreeMap<u32, usize> = places.map(|(k, &vertex)| (vertex, k)).collect();
        let mut finer = self.clone();
        for (vertex, ends) in (vertex_count as u32..).zip(&fine.midpoints) {
            let both = ends.map(|end| places.get(&end).copied());
            if both == [None; 2] {
                continue;
            }
            places.insert(vertex, finer.vertices.len());
            finer.vertices.push(vertex);
            for row in &mut finer.moved {
                let [a, b] = both.map(|place| place.map_or(Vec2::ZERO, |place| row[place]));
                row.push(a.midpoint(b));
            }
        }
        finer
    }

    /// Returns the four times around `t` with the weights of their displacements; `None` outside
    /// the time span of the guard.
    pub(super) fn at(&self, t: f64) -> Option<GuardMix> {
        let after = self.times.partition_point(|&time| time <= t);
        if after == 0 || after == self.times.len() {
            return None;
        }
        let (a, b) = (after - 1, after);
        let length = self.times[b] - self.times[a];
        let s = (t - self.times[a]) / length;
        let rows = [a.saturating_sub(1), a, b, (b + 1).min(self.times.len() - 1)];
        let mut weights = [
            0.0,
            (1.0 + 2.0 * s) * (1.0 - s) * (1.0 - s),
            s * s * (3.0 - 2.0 * s),
            0.0,
        ];
        // The velocity at a time is the slope between the displacements at the two neighbouring
        // times; it is zero at the first and at the last time.
        let mut pull = |from: usize, to: usize, by: f64| {
            if rows[to] - rows[from] == 2 {
                let by = by * length / (self.times[rows[to]] - self.times[rows[from]]);
                weights[from] -= by;
                weights[to] += by;
            }
        };
        pull(0, 2, s * (1.0 - s) * (1.0 - s));
        pull(1, 3, s * s * (s - 1.0));
        Some(GuardMix { rows, weights })
    }

    /// Adds the displacements selected by `mix` to `places`, the positions of the vertices with the
    /// indices `run`.
    pub(super) fn add(&self, mix: &GuardMix, run: Range<usize>, places: &mut [DVec2]) {
        let from = self
            .vertices
            .partition_point(|&vertex| (vertex as usize) < run.start);
        let vertices = self.vertices[from..].iter().enumerate();
        for (k, &vertex) in vertices.take_while(|(_, vertex)| (**vertex as usize) < run.end) {
            let each = mix.rows.iter().zip(mix.weights);
            let by: DVec2 = each
                .map(|(&row, weight)| self.moved[row][from + k].as_dvec2() * weight)
                .sum();
            places[vertex as usize - run.start] += by;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn guard() -> Guard {
        let row = |x: f64| vec![DVec2::new(x, -x)];
        let times = vec![0.2, 0.3, 0.5, 0.6];
        Guard::new(times, &[0.0, 1.0, 2.0, 0.0].map(row)).expect("a guard")
    }

    fn at(guard: &Guard, t: f64) -> f64 {
        let mut places = [DVec2::ZERO];
        if let Some(mix) = guard.at(t) {
            guard.add(&mix, 0..1, &mut places);
        }
        places[0].x
    }

    #[test]
    fn it_goes_through_its_rows_without_a_jerk() {
        let guard = guard();
        for (t, by) in [
            (0.0, 0.0),
            (0.2, 0.0),
            (0.3, 1.0),
            (0.5, 2.0),
            (0.6, 0.0),
            (1.0, 0.0),
        ] {
            assert!((at(&guard, t) - by).abs() < 1e-12, "{t}");
        }
        let h = 1e-6;
        for t in [0.2, 0.3, 0.5, 0.6] {
            let before = (at(&guard, t) - at(&guard, t - h)) / h;
            let after = (at(&guard, t + h) - at(&guard, t)) / h;
            assert!((before - after).abs() < 1e-2, "{t}: {before} {after}");
        }
    }

    #[test]
    fn backwards_it_is_the_same() {
        let (guard, back) = (guard(), guard().backwards());
        for t in [0.1, 0.25, 0.4, 0.55, 0.7] {
            assert!((at(&guard, t) - at(&back, 1.0 - t)).abs() < 1e-12, "{t}");
        }
    }

    #[test]
    fn what_is_not_sound_is_none() {
        let row = |x: f64| vec![DVec2::splat(x)];
        let rows = |x: [f64; 3]| x.map(row);
        let of = |times: [f64; 3], rows: [Vec<DVec2>; 3]| Guard::new(times.to_vec(), &rows);
        assert!(of([0.0, 0.5, 1.0], rows([0.0, 1.0, 0.0])).is_some());
        assert!(of([0.0, 0.5, 0.5], rows([0.0, 1.0, 0.0])).is_none());
        assert!(of([0.0, 0.5, 1.5], rows([0.0, 1.0, 0.0])).is_none());
        assert!(of([0.0, 0.5, 1.0], rows([0.0, f64::NAN, 0.0])).is_none());
        assert!(of([0.0, 0.5, 1.0], rows([0.0, 1.0, 0.1])).is_none());
        assert!(Guard::new(vec![], &[]).is_none());
    }
}
