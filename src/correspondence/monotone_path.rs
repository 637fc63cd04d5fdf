//! A path of unit steps made a strictly monotone one with even stretch.
//!
//! Unit steps let one sample stand for many: a stretch of boundary without
//! length in the other design. Here, near the path found, each step goes
//! forward in *both* curves, and stretch is priced by (Δa − Δb)² / (Δa + Δb):
//! as before where all is stretched into one place, cheaper the more evenly
//! it is shared out.

use super::path_grid::PathGrid;

/// Steps in source and target samples that are longer in the target, up to
/// 1 : 8 and without common factors. All are taken the other way round too.
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

/// The cheapest strictly monotone path from the first to the last of `nodes`,
/// no farther than `reach` samples from them. Where no such path exists the
/// unit steps are taken together until they advance in both.
pub(super) fn refine(grid: &PathGrid, nodes: &[[usize; 2]], reach: usize) -> Vec<[usize; 2]> {
    let windows = windows(nodes, reach);
    cheapest(grid, &windows).unwrap_or_else(|| blocks(nodes))
}

/// Unit steps taken together so that each block advances in both. The path
/// as a whole must do so.
pub(super) fn blocks(nodes: &[[usize; 2]]) -> Vec<[usize; 2]> {
    let mut kept = vec![nodes[0]];
    for &node in &nodes[1..] {
        let last = kept[kept.len() - 1];
        if node[0] > last[0] && node[1] > last[1] {
            kept.push(node);
        }
    }
    // What is left over at the end joins the last block.
    let end = nodes.len() - 1;
    let last = kept.len() - 1;
    kept[last] = nodes[end];
    kept
}

/// For each row the columns within `reach` of the path, taken as a square.
fn windows(nodes: &[[usize; 2]], reach: usize) -> Vec<[usize; 2]> {
    let [columns, rows] = nodes[nodes.len() - 1];
    let mut first = vec![columns; rows + 1];
    let mut last = vec![0; rows + 1];
    for &[i, j] in nodes {
        first[j] = first[j].min(i);
        last[j] = last[j].max(i);
    }
    let window = |j: usize| {
        // First and last columns do not fall from row to row, so that the farthest
        // row within reach has the least and the greatest.
        let low = first[j.saturating_sub(reach)].saturating_sub(reach);
        let high = (last[(j + reach).min(rows)] + reach).min(columns);
        [low, high]
    };
    (0..=rows).map(window).collect()
}

fn cheapest(grid: &PathGrid, windows: &[[usize; 2]]) -> Option<Vec<[usize; 2]>> {
    let width = grid.source.len();
    let longer = LONGER.into_iter().flat_map(|[a, b]| [[a, b], [b, a]]);
    // The even step first: of equally cheap ones the first is taken.
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

/// The cheapest way to a node: its cost and the step, none where no step
/// comes from a node reached.
fn best_step(
    grid: &PathGrid,
    steps: &[MonotoneStep],
    cost: &[f64],
    [i, j]: [usize; 2],
) -> Option<(f64, usize)> {
    let mut least = f64::INFINITY;
    let mut best = None;
    let node = j * grid.source.len() + i;
    for (k, step) in steps.iter().enumerate() {
        if i < step.source || j < step.target {
            continue;
        }
        let before = cost[node - step.back];
        if before >= least {
            continue; // a step costs something
        }
        let total = before + step.price(grid, [i, j]);
        if total < least {
            (least, best) = (total, Some(k));
        }
    }
    best.map(|step| (least, step))
}

/// A step, and where between its ends the unlikeness is looked up.
struct MonotoneStep {
    source: usize,
    target: usize,
    /// From the node at its end back to the one it comes from.
    back: usize,
    /// Along the longer side, sample by sample: two nodes, counted from where
    /// the step begins, and the share of the second.
    between: Vec<(usize, usize, f64)>,
}

impl MonotoneStep {
    /// In a grid of so many columns.
    fn new([source, target]: [usize; 2], width: usize) -> Self {
        let pieces = source.max(target);
        let between = (1..pieces).map(|k| {
            let [x, y] = [source * k / pieces, target * k / pieces];
            let [u, v] = [source * k % pieces, target * k % pieces];
            // One of u and v is 0: the longer side goes sample by sample.
            let next = y * width + x + usize::from(u > 0) + width * usize::from(v > 0);
            (y * width + x, next, u.max(v) as f64 / pieces as f64)
        });
        Self {
            source,
            target,
            back: target * width + source,
            between: between.collect(),
        }
    }

    /// Bending along the straight step by the trapezoid rule, and its stretch.
    fn price(&self, grid: &PathGrid, [i, j]: [usize; 2]) -> f64 {
        let walked_source = grid.source[i] - grid.source[i - self.source];
        let walked_target = grid.target[j] - grid.target[j - self.target];
        let walked = walked_source + walked_target;
        let stretch = (walked_source - walked_target).powi(2) / walked;
        let end = j * grid.source.len() + i;
        let unlike = &grid.unlike[end - self.back..=end];
        let mut bend = 0.5 * (unlike[0] + unlike[self.back]);
        for &(node, next, share) in &self.between {
            bend += (1.0 - share) * unlike[node] + share * unlike[next];
        }
        let pieces = (1 + self.between.len()) as f64;
        0.5 * walked * bend / pieces + grid.stretch * stretch
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Even samples and the same unlikeness everywhere.
    fn plain(n: usize, m: usize) -> PathGrid {
        let even = |count: usize| (0..=count).map(|k| k as f64 / count as f64).collect();
        PathGrid {
            source: even(n),
            target: even(m),
            unlike: vec![1.0; (n + 1) * (m + 1)],
            stretch: 1.0,
        }
    }

    #[test]
    fn stretch_is_shared_out_evenly() {
        let nodes: Vec<_> = (0..=12)
            .map(|i| [i, 0])
            .chain((1..=6).map(|j| [12, j]))
            .collect();
        let refined = refine(&plain(12, 6), &nodes, 20);
        let expected: Vec<_> = (0..=6).map(|j| [2 * j, j]).collect();
        assert_eq!(refined, expected);
    }

    #[test]
    fn a_step_costs_what_its_halves_cost_where_nothing_changes() {
        let grid = plain(8, 8);
        let step = MonotoneStep::new([1, 2], 9);
        let whole = step.price(&grid, [1, 2]) + step.price(&grid, [2, 4]);
        let long = 0.5 * (0.25 + 0.5) + (0.25f64 - 0.5).powi(2) / 0.75;
        assert!((whole - long).abs() < 1e-15);
    }

    #[test]
    fn what_no_step_can_reach_is_taken_in_blocks() {
        let nodes: Vec<_> = (0..=40).map(|i| [i, 0]).chain([[40, 1]]).collect();
        assert_eq!(refine(&plain(40, 1), &nodes, 3), vec![[0, 0], [40, 1]]);
        let steps = [[0, 0], [1, 0], [2, 1], [3, 2], [3, 3], [4, 3]];
        assert_eq!(blocks(&steps), vec![[0, 0], [2, 1], [3, 2], [4, 3]]);
    }
}
