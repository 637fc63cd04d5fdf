//! The grid of pairs of samples, and the cheapest monotone path through it.
//!
//! A node (i, j) says that sample i of the source is sample j of the target. A
//! path takes unit steps: along the source, along the target, or along both.
//! It pays for bending (how unlike the samples are, times the length walked)
//! and for stretching (the absolute difference of the lengths walked), as in
//! Sebastian, Klein and Kimia 2003, "On aligning curves". Both exchange with
//! the roles of the two curves.

/// Places and unlikeness of a window of samples, counted on over the seam.
#[derive(Clone, Debug)]
pub(super) struct PathGrid {
    /// Places of the source's samples, ascending.
    pub source: Vec<f64>,
    /// Places of the target's samples, ascending.
    pub target: Vec<f64>,
    /// How unlike: a row for each sample of the target.
    pub unlike: Vec<f64>,
    /// Price of a unit of stretch.
    pub stretch: f64,
}

/// What each step of a grid costs, a row for each sample of the target:
/// infinite where the step would come from outside.
#[derive(Debug)]
pub(super) struct StepCosts {
    width: usize,
    rows: usize,
    both: Vec<f64>,
    source: Vec<f64>,
    target: Vec<f64>,
}

/// A path: for each row the first and the last column it visits.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct GridPath {
    pub cost: f64,
    pub rows: Vec<[usize; 2]>,
}

/// Buffers of the dynamic program, kept between solves.
#[derive(Debug, Default)]
pub(super) struct PathBuffers {
    above: Vec<f64>,
    here: Vec<f64>,
    came: Vec<u8>,
    starts: Vec<usize>,
}

const ALONG_BOTH: u8 = 0;
const ALONG_SOURCE: u8 = 1;
const ALONG_TARGET: u8 = 2;

impl PathGrid {
    /// How unlike source sample `i` and target sample `j` are.
    pub fn at(&self, i: usize, j: usize) -> f64 {
        self.unlike[j * self.source.len() + i]
    }

    /// Price of the step from `(i − di, j − dj)` to `(i, j)`, di, dj ≤ 1.
    #[inline]
    pub fn step(&self, i: usize, j: usize, di: usize, dj: usize) -> f64 {
        let walked_source = self.source[i] - self.source[i - di];
        let walked_target = self.target[j] - self.target[j - dj];
        let bend = 0.5 * (self.at(i, j) + self.at(i - di, j - dj));
        0.5 * (walked_source + walked_target) * bend
            + self.stretch * (walked_source - walked_target).abs()
    }

    /// The price of each step, for a search that visits them many times.
    pub fn prices(&self) -> StepCosts {
        let (width, rows) = (self.source.len(), self.target.len());
        let mut prices = StepCosts {
            width,
            rows,
            both: vec![f64::INFINITY; width * rows],
            source: vec![f64::INFINITY; width * rows],
            target: vec![f64::INFINITY; width * rows],
        };
        for j in 0..rows {
            let row = j * width..(j + 1) * width;
            let [both, source, target] = [
                &mut prices.both[row.clone()],
                &mut prices.source[row.clone()],
                &mut prices.target[row],
            ];
            for i in 0..width {
                if i > 0 {
                    source[i] = self.step(i, j, 1, 0);
                }
                if j > 0 {
                    target[i] = self.step(i, j, 0, 1);
                }
                if i > 0 && j > 0 {
                    both[i] = self.step(i, j, 1, 1);
                }
            }
        }
        prices
    }
}

impl StepCosts {
    /// The cheapest path from `start` in row 0 to `end` in the last row that
    /// keeps to the windows of columns, both ends included and nondecreasing
    /// from row to row. O(cells in the windows).
    pub fn shortest(
        &self,
        [start, end]: [usize; 2],
        window: impl Fn(usize) -> [usize; 2],
        scratch: &mut PathBuffers,
    ) -> GridPath {
        let window = |j: usize| [window(j)[0].max(start), window(j)[1].min(end)];
        scratch.reset(self.width);
        // As if a row above the first led to the start, and nowhere else.
        scratch.above[1 + start] = 0.0;
        for j in 0..self.rows {
            let here = window(j);
            scratch.starts.push(scratch.came.len());
            self.row(j, here, scratch);
            std::mem::swap(&mut scratch.above, &mut scratch.here);
        }
        let cost = scratch.above[1 + end];
        let rows = trace(scratch, self.rows, start, end, |j| window(j)[0]);
        GridPath { cost, rows }
    }

    /// The costs of one row from those of the row above.
    fn row(&self, j: usize, [low, high]: [usize; 2], scratch: &mut PathBuffers) {
        let (cells, count) = (j * self.width + low, high + 1 - low);
        let PathBuffers {
            above, here, came, ..
        } = scratch;
        // Column i is kept at 1 + i; what lies left of the window is not
        // reached, and right of it nothing was yet.
        here[low] = f64::INFINITY;
        let here = &mut here[1 + low..][..count];
        let first = came.len();
        came.resize(first + count, ALONG_BOTH);
        let came = &mut came[first..];
        // From the row above: no cell waits for another.
        let (left, straight) = (&above[low..][..count], &above[1 + low..][..count]);
        let (both, target) = (&self.both[cells..][..count], &self.target[cells..][..count]);
        for i in 0..count {
            let (along_both, along_target) = if j == 0 {
                (straight[i], f64::INFINITY)
            } else {
                (left[i] + both[i], straight[i] + target[i])
            };
            let is_target = along_target < along_both;
            here[i] = if is_target { along_target } else { along_both };
            came[i] = if is_target { ALONG_TARGET } else { ALONG_BOTH };
        }
        // Along the row: each cell waits for the one before.
        let source = &self.source[cells..][..count];
        let mut before = f64::INFINITY;
        for i in 0..count {
            let cost = before + source[i];
            let ties = cost == here[i] && came[i] == ALONG_TARGET;
            if cost < here[i] || ties {
                here[i] = cost;
                came[i] = ALONG_SOURCE;
            }
            before = here[i];
        }
    }
}

impl PathBuffers {
    fn reset(&mut self, width: usize) {
        for row in [&mut self.above, &mut self.here] {
            row.clear();
            row.resize(1 + width, f64::INFINITY);
        }
        self.came.clear();
        self.starts.clear();
    }
}

/// The path walked back from its end.
fn trace(
    scratch: &PathBuffers,
    count: usize,
    start: usize,
    end: usize,
    low: impl Fn(usize) -> usize,
) -> Vec<[usize; 2]> {
    let mut rows = vec![[end, end]; count];
    let (mut i, mut j) = (end, count - 1);
    while (i, j) != (start, 0) {
        match scratch.came[scratch.starts[j] + i - low(j)] {
            ALONG_SOURCE => i -= 1,
            came => {
                j -= 1;
                i -= usize::from(came == ALONG_BOTH);
                rows[j] = [i, i];
            }
        }
        rows[j][0] = i;
    }
    rows
}

impl GridPath {
    /// The nodes in order, from the start to the end.
    pub fn nodes(&self) -> Vec<[usize; 2]> {
        let row = |(j, &[first, last]): (usize, &[usize; 2])| (first..=last).map(move |i| [i, j]);
        self.rows.iter().enumerate().flat_map(row).collect()
    }

    /// The same path `by` columns on.
    pub fn shifted(&self, by: usize) -> Self {
        let rows = self.rows.iter().map(|&[a, b]| [a + by, b + by]).collect();
        Self {
            cost: self.cost,
            rows,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_cheapest_of_all_paths_of_a_small_grid_is_found() {
        let grid = PathGrid {
            source: vec![0.0, 0.3, 0.5, 1.0],
            target: vec![0.0, 0.2, 1.0],
            unlike: vec![1.0, 2.0, 0.1, 4.0, 3.0, 0.5, 0.2, 7.0, 1.0, 0.3, 9.0, 0.4],
            stretch: 0.2,
        };
        let prices = grid.prices();
        let route = prices.shortest([0, 3], |_| [0, 3], &mut PathBuffers::default());
        assert!((route.cost - cheapest(&grid, 3, 2)).abs() < 1e-15);
        let nodes = route.nodes();
        let price = |w: &[[usize; 2]]| {
            let [[a, b], [i, j]] = [w[0], w[1]];
            grid.step(i, j, i - a, j - b)
        };
        let sum: f64 = nodes.windows(2).map(price).sum();
        assert!((route.cost - sum).abs() < 1e-15);
    }

    /// All paths, one by one.
    fn cheapest(grid: &PathGrid, i: usize, j: usize) -> f64 {
        let mut best = if i + j == 0 { 0.0 } else { f64::INFINITY };
        for (di, dj) in [(1, 1), (1, 0), (0, 1)] {
            if i >= di && j >= dj {
                best = best.min(cheapest(grid, i - di, j - dj) + grid.step(i, j, di, dj));
            }
        }
        best
    }
}
