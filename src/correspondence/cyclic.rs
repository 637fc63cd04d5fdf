//! Finds the cheapest closed path on the torus of sample pairs for every starting sample.
//!
//! Follows Maes 1990, "On a cyclic string-to-string correction problem". Columns are the n source
//! samples, rows the m target samples. The columns run twice around the source, so a closed path
//! that starts at source sample k runs from column k of the first row to column k + n of the last
//! row. The cheapest paths of different k can be chosen so that they do not cross: the path of k
//! lies between those of a smaller and a larger k. Bisecting the range of k therefore solves all n
//! starts in O(n m log n). Every closed path of unit steps visits the first row, so none is missed.
//!
//! Guarantees: the path of each k has minimum cost among all closed paths that start there. Ties
//! between equally cheap paths are broken deterministically but arbitrarily.

use super::path_grid::{GridPath, PathBuffers, StepCosts};

/// The bisection solves the two halves of a range of starting columns in parallel if each half has
/// more columns than this, and otherwise one after the other (heuristic).
const MAX_SEQUENTIAL_STARTS: usize = 16;

/// Returns the cheapest path of each starting column 0 ≤ k < n. The grid has at least 2n columns.
/// It has one row for each target sample, and the first row again at the end.
pub(super) fn cheapest_path_per_start(costs: &StepCosts, n: usize) -> Vec<GridPath> {
    let first = costs.cheapest_path([0, n], |_| [0, n], &mut PathBuffers::default());
    let mut between = vec![None; n.saturating_sub(1)];
    // The path from column n is the path from column 0, moved by one round (n columns).
    let last = first.shifted(n);
    bisect(
        costs,
        n,
        0,
        [&first, &last],
        &mut between,
        &mut PathBuffers::default(),
    );
    let first = std::iter::once(first);
    first.chain(between.into_iter().flatten()).collect()
}

/// Stores in `between` the cheapest paths from the starting columns after `left`, one for each
/// entry. `lower` and `upper` are the paths from the starting columns just before and just after
/// these.
fn bisect(
    costs: &StepCosts,
    n: usize,
    left: usize,
    [lower, upper]: [&GridPath; 2],
    between: &mut [Option<GridPath>],
    scratch: &mut PathBuffers,
) {
    if between.is_empty() {
        return;
    }
    let half = between.len() / 2;
    let middle = left + 1 + half;
    // There are cheapest paths that do not cross each other, so the search is limited to the strip
    // between `lower` and `upper`.
    let window = |j: usize| [lower.rows[j][0], upper.rows[j][1]];
    let route = costs.cheapest_path([middle, middle + n], window, scratch);
    let (left_starts, right_starts) = between.split_at_mut(half);
    if half > MAX_SEQUENTIAL_STARTS {
        rayon::join(
            || bisect(costs, n, left, [lower, &route], left_starts, scratch),
            || {
                let scratch = &mut PathBuffers::default();
                bisect(
                    costs,
                    n,
                    middle,
                    [&route, upper],
                    &mut right_starts[1..],
                    scratch,
                );
            },
        );
    } else {
        bisect(costs, n, left, [lower, &route], left_starts, scratch);
        bisect(
            costs,
            n,
            middle,
            [&route, upper],
            &mut right_starts[1..],
            scratch,
        );
    }
    right_starts[0] = Some(route);
}

#[cfg(test)]
mod tests {
    use super::super::path_grid::PathGrid;
    use super::*;
    use proptest::prelude::*;

    /// Generates the grid of sample pairs of two closed curves, unrolled so that the source occurs
    /// twice, and the number of source samples. The samples are unevenly spaced; dissimilarities
    /// are random.
    fn torus() -> impl Strategy<Value = (PathGrid, usize)> {
        (1usize..14, 1usize..14).prop_flat_map(|(n, m)| {
            let gaps = |k| prop::collection::vec(0.1f64..1.0, k);
            // Few distinct values, so that ties are common.
            let dissimilarities = prop::collection::vec((0u8..5).prop_map(f64::from), n * m);
            (gaps(n), gaps(m), dissimilarities, 0.0f64..2.0).prop_map(
                move |(a, b, dissimilarities, stretch)| unrolled(&a, &b, &dissimilarities, stretch),
            )
        })
    }

    /// Unrolls the torus of sample pairs to a grid in which the source occurs twice. `a` and `b`
    /// are the distances between consecutive samples. Also returns the number of source samples.
    fn unrolled(a: &[f64], b: &[f64], dissimilarities: &[f64], stretch: f64) -> (PathGrid, usize) {
        let (n, m) = (a.len(), b.len());
        let row = |j: usize| (0..=2 * n).map(move |i| dissimilarities[(j % m) * n + i % n]);
        let grid = PathGrid {
            source: sums(a, 2 * n),
            target: sums(b, m),
            dissimilarity: (0..=m).flat_map(row).collect(),
            stretch,
        };
        (grid, n)
    }

    /// Returns 0 and the first `count` partial sums of the gaps, which are repeated cyclically.
    fn sums(gaps: &[f64], count: usize) -> Vec<f64> {
        let mut sum = 0.0;
        let mut places = vec![0.0];
        for gap in gaps.iter().cycle().take(count) {
            sum += gap;
            places.push(sum);
        }
        places
    }

    proptest! {
        #[test]
        fn every_start_costs_as_much_as_when_solved_separately((grid, n) in torus()) {
            let routes = cheapest_path_per_start(&grid.step_costs(), n);
            prop_assert_eq!(routes.len(), n);
            for (k, route) in routes.iter().enumerate() {
                let plain = grid.step_costs().cheapest_path([k, k + n], |_| [k, k + n], &mut PathBuffers::default());
                prop_assert!((route.cost - plain.cost).abs() <= 1e-12 * (1.0 + plain.cost));
                prop_assert_eq!(route.rows[0][0], k);
                prop_assert_eq!(route.rows.last().map(|row| row[1]), Some(k + n));
            }
        }

        #[test]
        fn exchanging_the_curves_costs_the_same(
            a in prop::collection::vec(0.1f64..1.0, 1..9),
            b in prop::collection::vec(0.1f64..1.0, 1..9),
            seed in prop::collection::vec(0.0f64..3.0, 64),
        ) {
            let (n, m) = (a.len(), b.len());
            let at = |i: usize, j: usize| seed[8 * i + j];
            let (there, _) = unrolled(&a, &b, &(0..n * m).map(|k| at(k % n, k / n)).collect::<Vec<_>>(), 0.5);
            let (back, _) = unrolled(&b, &a, &(0..n * m).map(|k| at(k / m, k % m)).collect::<Vec<_>>(), 0.5);
            let min_cost = |routes: Vec<GridPath>| routes.iter().map(|r| r.cost).fold(f64::INFINITY, f64::min);
            let (c, d) = (min_cost(cheapest_path_per_start(&there.step_costs(), n)), min_cost(cheapest_path_per_start(&back.step_costs(), m)));
            prop_assert!((c - d).abs() <= 1e-12 * (1.0 + c));
        }
    }
}
