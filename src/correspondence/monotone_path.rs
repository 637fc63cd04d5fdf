//! Converts a path of unit steps into a strictly monotone path with evenly distributed stretch.
//!
//! With unit steps, one sample may match many, which collapses a section of one boundary to a point
//! of the other. The new path stays near the given one, but each of its steps advances along *both*
//! curves. A step of lengths Δa and Δb along the two curves has the stretching cost (Δa − Δb)² /
//! (Δa + Δb). This equals the cost of unit steps if all stretch is in one place; the more evenly
//! stretch is distributed, the smaller it is.

use super::path_grid::PathGrid;

/// Allowed steps `[source samples, target samples]` that advance farther in the target than in the
/// source, in lowest terms. The same steps with source and target exchanged are allowed too.
/// Further steps would cost time and are rarely cheapest (heuristic).
const LONGER: [[usize; 2]; 10] = [
    [1, 2],
    [1, 3],
    [2, 3],
    [1, 4],
    [3, 4],
    [1, 5],
    [2, 5],
    [1, 6],
    [1, 7],
    [1, 8],
];

/// Returns the cheapest strictly monotone path that has the same ends as the path `nodes` and stays
/// within `reach` samples of it. If no such path exists, merges the unit steps of `nodes` until
/// each step advances along both curves.
pub(super) fn refine(grid: &PathGrid, nodes: &[[usize; 2]], reach: usize) -> Vec<[usize; 2]> {
    let windows = windows(nodes, reach);
    cheapest_path(grid, &windows).unwrap_or_else(|| merged_steps(nodes))
}

/// Merges unit steps into longer steps that each advance along both curves. The path as a whole
/// must advance along both.
pub(super) fn merged_steps(nodes: &[[usize; 2]]) -> Vec<[usize; 2]> {
    let mut blocks = vec![nodes[0]];
    for &node in &nodes[1..] {
        let last = blocks[blocks.len() - 1];
        if node[0] > last[0] && node[1] > last[1] {
            blocks.push(node);
        }
    }
    // The last step also covers the unit steps left over at the end.
    let end = nodes.len() - 1;
    let last = blocks.len() - 1;
    blocks[last] = nodes[end];
    blocks
}

/// Returns, for each row of the grid, the first and the last column that lie within `reach` columns
/// and `reach` rows of a node of the path.
fn windows(nodes: &[[usize; 2]], reach: usize) -> Vec<[usize; 2]> {
    let [columns, rows] = nodes[nodes.len() - 1];
    let mut first = vec![columns; rows + 1];
    let mut last = vec![0; rows + 1];
    for &[i, j] in nodes {
        first[j] = first[j].min(i);
        last[j] = last[j].max(i);
    }
    let window = |j: usize| {
        // From row to row, neither the first column that the path visits nor the last one
        // decreases. Of all rows within `reach` of row j, the one with the smallest index therefore
        // has the smallest first column, and the one with the largest index has the largest last
        // column.
        let low = first[j.saturating_sub(reach)].saturating_sub(reach);
        let high = (last[(j + reach).min(rows)] + reach).min(columns);
        [low, high]
    };
    (0..=rows).map(window).collect()
}

/// Returns the cheapest strictly monotone path that stays between the two columns given for each
/// row by `windows`, or `None` if no path exists.
fn cheapest_path(grid: &PathGrid, windows: &[[usize; 2]]) -> Option<Vec<[usize; 2]>> {
    let width = grid.source.len();
    let longer = LONGER.into_iter().flat_map(|[a, b]| [[a, b], [b, a]]);
    // The step [1, 1] comes first, because the first of several equally cheap steps is chosen.
    let steps = std::iter::once([1, 1]).chain(longer);
    let steps: Vec<MonotoneStep> = steps.map(|step| MonotoneStep::new(step, width)).collect();
    let mut cost = vec![f64::INFINITY; width * windows.len()];
    let mut came = vec![usize::MAX; cost.len()];
    cost[0] = 0.0;
    for (j, &[low, high]) in windows.iter().enumerate() {
        for i in low..=high {
            if let Some((total, step)) = best_step(grid, &steps, &cost, [i, j]) {
                cost[j * width + i] = total;
                came[j * width + i] = step;
            }
        }
    }
    let (mut i, mut j) = (width - 1, windows.len() - 1);
    let mut nodes = vec![[i, j]];
    while (i, j) != (0, 0) {
        let step = steps.get(came[j * width + i])?;
        (i, j) = (i - step.source, j - step.target);
        nodes.push([i, j]);
    }
    nodes.reverse();
    Some(nodes)
}

/// Returns the minimum cost of a path to node (i, j), and the index in `steps` of the last step of
/// this path. Returns `None` if no path reaches the node.
fn best_step(
    grid: &PathGrid,
    steps: &[MonotoneStep],
    cost: &[f64],
    [i, j]: [usize; 2],
) -> Option<(f64, usize)> {
    let mut min_cost = f64::INFINITY;
    let mut best = None;
    let node = j * grid.source.len() + i;
    for (k, step) in steps.iter().enumerate() {
        if i < step.source || j < step.target {
            continue;
        }
        let start_cost = cost[node - step.back];
        if start_cost >= min_cost {
            continue; // step costs are not negative
        }
        let total = start_cost + step.cost(grid, [i, j]);
        if total < min_cost {
            (min_cost, best) = (total, Some(k));
        }
    }
    best.map(|step| (min_cost, step))
}

/// A step that advances along both curves by one or more samples, and the nodes between its ends at
/// which the dissimilarity is interpolated.
struct MonotoneStep {
    source: usize,
    target: usize,
    /// Difference between the indices in the grid, row · width + column, of the step's end and
    /// start.
    back: usize,
    /// One entry for each sample that the step passes on the curve along which it advances farther:
    /// the two nodes between which the dissimilarity is interpolated, as offsets from the step's
    /// start, and the weight of the second node.
    between: Vec<(usize, usize, f64)>,
}

impl MonotoneStep {
    /// Creates a step in a grid of `width` columns.
    fn new([source, target]: [usize; 2], width: usize) -> Self {
        let count = source.max(target);
        let between = (1..count).map(|k| {
            let [i, j] = [source * k / count, target * k / count];
            let [di, dj] = [source * k % count, target * k % count];
            // One of the remainders `di` and `dj` is 0, because k counts the samples of the curve
            // along which the step advances farther.
            let next_node = j * width + i + usize::from(di > 0) + width * usize::from(dj > 0);
            (j * width + i, next_node, di.max(dj) as f64 / count as f64)
        });
        Self {
            source,
            target,
            back: target * width + source,
            between: between.collect(),
        }
    }

    /// Returns the cost of the step that ends at (i, j): the bending cost along the straight step,
    /// by the trapezoidal rule, plus the weighted stretching cost.
    fn cost(&self, grid: &PathGrid, [i, j]: [usize; 2]) -> f64 {
        let source_length = grid.source[i] - grid.source[i - self.source];
        let target_length = grid.target[j] - grid.target[j - self.target];
        let total_length = source_length + target_length;
        let stretch = (source_length - target_length).powi(2) / total_length;
        let end = j * grid.source.len() + i;
        let dissimilarities = &grid.dissimilarity[end - self.back..=end];
        let mut integral = 0.5 * (dissimilarities[0] + dissimilarities[self.back]);
        for &(node, next, share) in &self.between {
            integral += (1.0 - share) * dissimilarities[node] + share * dissimilarities[next];
        }
        let count = (1 + self.between.len()) as f64;
        0.5 * total_length * integral / count + grid.stretch * stretch
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns a grid with evenly spaced samples and constant dissimilarity.
    fn plain(n: usize, m: usize) -> PathGrid {
        let even = |count: usize| (0..=count).map(|k| k as f64 / count as f64).collect();
        PathGrid {
            source: even(n),
            target: even(m),
            dissimilarity: vec![1.0; (n + 1) * (m + 1)],
            stretch: 1.0,
        }
    }

    #[test]
    fn stretch_is_distributed_evenly() {
        let nodes: Vec<_> = (0..=12)
            .map(|i| [i, 0])
            .chain((1..=6).map(|j| [12, j]))
            .collect();
        let refined = refine(&plain(12, 6), &nodes, 20);
        let expected: Vec<_> = (0..=6).map(|j| [2 * j, j]).collect();
        assert_eq!(refined, expected);
    }

    #[test]
    fn a_step_costs_as_much_as_its_halves_if_the_dissimilarity_is_constant() {
        let grid = plain(8, 8);
        let step = MonotoneStep::new([1, 2], 9);
        let whole = step.cost(&grid, [1, 2]) + step.cost(&grid, [2, 4]);
        let long = 0.5 * (0.25 + 0.5) + (0.25f64 - 0.5).powi(2) / 0.75;
        assert!((whole - long).abs() < 1e-15);
    }

    #[test]
    fn a_path_steeper_than_all_steps_is_merged_into_blocks() {
        let nodes: Vec<_> = (0..=40).map(|i| [i, 0]).chain([[40, 1]]).collect();
        assert_eq!(refine(&plain(40, 1), &nodes, 3), vec![[0, 0], [40, 1]]);
        let steps = [[0, 0], [1, 0], [2, 1], [3, 2], [3, 3], [4, 3]];
        assert_eq!(merged_steps(&steps), vec![[0, 0], [2, 1], [3, 2], [4, 3]]);
    }
}
