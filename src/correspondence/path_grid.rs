//! The grid of sample pairs, and the cheapest monotone path through it.
//!
//! Node (i, j) pairs sample i of the source with sample j of the target. A path takes unit steps
//! along the source, along the target, or along both. Its cost has two terms, as in Sebastian,
//! Klein and Kimia 2003, "On aligning curves": the bending cost (dissimilarity times arc length)
//! and the stretching cost (absolute difference of the two arc lengths). Both terms are symmetric
//! in the two curves.

/// Places (fractions of arc length) of consecutive samples of two curves, and the dissimilarities
/// of all their pairs. If the grid runs around a curve twice, the places of the second round are
/// larger by 1.
#[derive(Clone, Debug)]
pub(super) struct PathGrid {
    /// Places of the source's samples, ascending.
    pub source: Vec<f64>,
    /// Places of the target's samples, ascending.
    pub target: Vec<f64>,
    /// Dissimilarities of all pairs: one row for each sample of the target.
    pub dissimilarity: Vec<f64>,
    /// Weight of the stretching cost relative to the bending cost.
    pub stretch: f64,
}

/// Cost of each step of a grid, stored at the node where the step ends, one row for each sample of
/// the target. Steps that would come from outside the grid have infinite cost.
#[derive(Debug)]
pub(super) struct StepCosts {
    width: usize,
    rows: usize,
    /// For each node, the cost of the step that ends there and advances along both curves.
    both: Vec<f64>,
    /// For each node, the cost of the step that ends there and advances only along the source.
    source: Vec<f64>,
    /// For each node, the cost of the step that ends there and advances only along the target.
    target: Vec<f64>,
}

/// A path through the grid: the first and the last column that it visits in each row.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct GridPath {
    pub cost: f64,
    pub rows: Vec<[usize; 2]>,
}

/// Buffers of the search for the cheapest path, reused from one search to the next.
#[derive(Debug, Default)]
pub(super) struct PathBuffers {
    /// Minimum costs of the nodes in the previous row; the cost of column i has index 1 + i.
    previous: Vec<f64>,
    /// Minimum costs of the nodes in the current row; the cost of column i has index 1 + i.
    current: Vec<f64>,
    /// For each node that was searched, row after row: code of the last step of the cheapest path
    /// to this node.
    steps: Vec<u8>,
    /// Index in `steps` at which each row begins.
    starts: Vec<usize>,
}

/// Code of a step along both curves.
const ALONG_BOTH: u8 = 0;
/// Code of a step along the source alone.
const ALONG_SOURCE: u8 = 1;
/// Code of a step along the target alone.
const ALONG_TARGET: u8 = 2;

impl PathGrid {
    /// Returns the dissimilarity of source sample `i` and target sample `j`.
    pub fn at(&self, i: usize, j: usize) -> f64 {
        self.dissimilarity[j * self.source.len() + i]
    }

    /// Returns the cost of the step from `(i − di, j − dj)` to `(i, j)`, where di, dj ≤ 1.
    #[inline]
    pub fn step(&self, i: usize, j: usize, di: usize, dj: usize) -> f64 {
        let source_length = self.source[i] - self.source[i - di];
        let target_length = self.target[j] - self.target[j - dj];
        let bend = 0.5 * (self.at(i, j) + self.at(i - di, j - dj));
        0.5 * (source_length + target_length) * bend
            + self.stretch * (source_length - target_length).abs()
    }

    /// Returns the costs of all steps, for searches that use each of them many times.
    pub fn step_costs(&self) -> StepCosts {
        let (width, rows) = (self.source.len(), self.target.len());
        let mut costs = StepCosts {
            width,
            rows,
            both: vec![f64::INFINITY; width * rows],
            source: vec![f64::INFINITY; width * rows],
            target: vec![f64::INFINITY; width * rows],
        };
        for j in 0..rows {
            let row = j * width..(j + 1) * width;
            let [both, source, target] = [
                &mut costs.both[row.clone()],
                &mut costs.source[row.clone()],
                &mut costs.target[row],
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
        costs
    }
}

impl StepCosts {
    /// Returns the cheapest path from column `start` of the first row to column `end` of the last
    /// row. `window` returns the first and the last column that the path may visit in a row;
    /// neither may decrease from row to row. The search takes time proportional to the number of
    /// nodes that the path may visit.
    pub fn cheapest_path(
        &self,
        [start, end]: [usize; 2],
        window: impl Fn(usize) -> [usize; 2],
        scratch: &mut PathBuffers,
    ) -> GridPath {
        let window = |j: usize| [window(j)[0].max(start), window(j)[1].min(end)];
        scratch.reset(self.width);
        // Begin as if a row preceded the first one, and only column `start` could be reached from
        // it.
        scratch.previous[1 + start] = 0.0;
        for j in 0..self.rows {
            let columns = window(j);
            scratch.starts.push(scratch.steps.len());
            self.row(j, columns, scratch);
            std::mem::swap(&mut scratch.previous, &mut scratch.current);
        }
        let cost = scratch.previous[1 + end];
        let rows = trace(scratch, self.rows, start, end, |j| window(j)[0]);
        GridPath { cost, rows }
    }

    /// Computes the minimum costs of the nodes in row `j`, columns `low` to `high`, from those of
    /// the previous row.
    fn row(&self, j: usize, [low, high]: [usize; 2], scratch: &mut PathBuffers) {
        let (first, count) = (j * self.width + low, high + 1 - low);
        let PathBuffers {
            previous,
            current,
            steps,
            ..
        } = scratch;
        // The node to the left of column `low` is unreachable. Nodes to the right of column `high`
        // still hold infinity from the reset.
        current[low] = f64::INFINITY;
        let current = &mut current[1 + low..][..count];
        let row_start = steps.len();
        steps.resize(row_start + count, ALONG_BOTH);
        let steps = &mut steps[row_start..];
        // First take the steps from the previous row. In this loop, the nodes of the row do not
        // depend on each other.
        let (left, straight) = (&previous[low..][..count], &previous[1 + low..][..count]);
        let (both, target) = (&self.both[first..][..count], &self.target[first..][..count]);
        for i in 0..count {
            let (along_both, along_target) = if j == 0 {
                (straight[i], f64::INFINITY)
            } else {
                (left[i] + both[i], straight[i] + target[i])
            };
            let is_target = along_target < along_both;
            current[i] = if is_target { along_target } else { along_both };
            steps[i] = if is_target { ALONG_TARGET } else { ALONG_BOTH };
        }
        // Then take the steps along the row. In this loop, each node depends on the node to its
        // left.
        let source = &self.source[first..][..count];
        let mut left_cost = f64::INFINITY;
        for i in 0..count {
            let cost = left_cost + source[i];
            let wins_tie = cost == current[i] && steps[i] == ALONG_TARGET;
            if cost < current[i] || wins_tie {
                current[i] = cost;
                steps[i] = ALONG_SOURCE;
            }
            left_cost = current[i];
        }
    }
}

impl PathBuffers {
    /// Prepares the buffers for a search in a grid of `width` columns: sets all costs to infinity
    /// and removes the steps of the previous search.
    fn reset(&mut self, width: usize) {
        for row in [&mut self.previous, &mut self.current] {
            row.clear();
            row.resize(1 + width, f64::INFINITY);
        }
        self.steps.clear();
        self.starts.clear();
    }
}

/// Traces the cheapest path back from its end. Returns the first and the last column that the path
/// visits in each row.
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
        match scratch.steps[scratch.starts[j] + i - low(j)] {
            ALONG_SOURCE => i -= 1,
            step => {
                j -= 1;
                i -= usize::from(step == ALONG_BOTH);
                rows[j] = [i, i];
            }
        }
        rows[j][0] = i;
    }
    rows
}

impl GridPath {
    /// Returns the nodes `[column, row]` of the path in order.
    pub fn nodes(&self) -> Vec<[usize; 2]> {
        let row = |(j, &[first, last]): (usize, &[usize; 2])| (first..=last).map(move |i| [i, j]);
        self.rows.iter().enumerate().flat_map(row).collect()
    }

    /// Returns the same path, moved by `by` columns.
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
    fn the_cheapest_path_of_a_small_grid_agrees_with_brute_force() {
        let grid = PathGrid {
            source: vec![0.0, 0.3, 0.5, 1.0],
            target: vec![0.0, 0.2, 1.0],
            dissimilarity: vec![1.0, 2.0, 0.1, 4.0, 3.0, 0.5, 0.2, 7.0, 1.0, 0.3, 9.0, 0.4],
            stretch: 0.2,
        };
        let costs = grid.step_costs();
        let route = costs.cheapest_path([0, 3], |_| [0, 3], &mut PathBuffers::default());
        assert!((route.cost - brute_force_cost(&grid, 3, 2)).abs() < 1e-15);
        let nodes = route.nodes();
        let cost = |w: &[[usize; 2]]| {
            let [[a, b], [i, j]] = [w[0], w[1]];
            grid.step(i, j, i - a, j - b)
        };
        let sum: f64 = nodes.windows(2).map(cost).sum();
        assert!((route.cost - sum).abs() < 1e-15);
    }

    /// Returns the minimum cost of a path from (0, 0) to (i, j), by enumerating all paths.
    fn brute_force_cost(grid: &PathGrid, i: usize, j: usize) -> f64 {
        let mut best = if i + j == 0 { 0.0 } else { f64::INFINITY };
        for (di, dj) in [(1, 1), (1, 0), (0, 1)] {
            if i >= di && j >= dj {
                best = best.min(brute_force_cost(grid, i - di, j - dj) + grid.step(i, j, di, dj));
            }
        }
        best
    }
}
