//! The cheapest closed path through the torus of pairs of samples, for every
//! starting point at once.
//!
//! Maes 1990, "On a cyclic string-to-string correction problem": the source is
//! unrolled twice; a closed path is one from column k of the first row to
//! column k + n of the last. Cheapest paths of different k need not cross, so
//! that the path of k lies between those of a smaller and a larger one, and
//! halving the interval of k solves all n in O(n m log n). Every closed path
//! of unit steps visits the first row, so none is missed.
//!
//! Guarantees: the cost of each k is the least of all paths that start there.
//! Among equally cheap paths the choice is deterministic, nothing more.

use super::path_grid::{GridPath, PathBuffers, StepCosts};

/// So few starts are solved on one thread.
const FEW: usize = 16;

/// The cheapest path of each starting column 0 ≤ k < n. The grid has
/// 2n columns at least, a row for each target sample and the first one again.
pub(super) fn all_starts(prices: &StepCosts, n: usize) -> Vec<GridPath> {
    let first = prices.shortest([0, n], |_| [0, n], &mut PathBuffers::default());
    let mut between = vec![None; n.saturating_sub(1)];
    // The start n columns on is the first one again, one round later.
    let last = first.shifted(n);
    halve(
        prices,
        n,
        0,
        [&first, &last],
        &mut between,
        &mut PathBuffers::default(),
    );
    let first = std::iter::once(first);
    first.chain(between.into_iter().flatten()).collect()
}

/// Solves the starts after `left`, strictly between two solved ones.
fn halve(
    prices: &StepCosts,
    n: usize,
    left: usize,
    [low, high]: [&GridPath; 2],
    between: &mut [Option<GridPath>],
    scratch: &mut PathBuffers,
) {
    if between.is_empty() {
        return;
    }
    let half = between.len() / 2;
    let middle = left + 1 + half;
    // Paths of other starts need not be crossed: so narrow is the search.
    let window = |j: usize| [low.rows[j][0], high.rows[j][1]];
    let found = prices.shortest([middle, middle + n], window, scratch);
    let (before, after) = between.split_at_mut(half);
    if half > FEW {
        rayon::join(
            || halve(prices, n, left, [low, &found], before, scratch),
            || {
                let scratch = &mut PathBuffers::default();
                halve(prices, n, middle, [&found, high], &mut after[1..], scratch);
            },
        );
    } else {
        halve(prices, n, left, [low, &found], before, scratch);
        halve(prices, n, middle, [&found, high], &mut after[1..], scratch);
    }
    after[0] = Some(found);
}

#[cfg(test)]
mod tests {
    use super::super::path_grid::PathGrid;
    use super::*;
    use proptest::prelude::*;

    /// A torus of random unlikeness with uneven samples.
    fn torus() -> impl Strategy<Value = (PathGrid, usize)> {
        (1usize..14, 1usize..14).prop_flat_map(|(n, m)| {
            let gaps = |k| prop::collection::vec(0.1f64..1.0, k);
            // Few values, so that ties are many.
            let unlike = prop::collection::vec((0u8..5).prop_map(f64::from), n * m);
            (gaps(n), gaps(m), unlike, 0.0f64..2.0)
                .prop_map(move |(a, b, unlike, stretch)| unrolled(&a, &b, &unlike, stretch))
        })
    }

    fn unrolled(a: &[f64], b: &[f64], unlike: &[f64], stretch: f64) -> (PathGrid, usize) {
        let (n, m) = (a.len(), b.len());
        let row = |j: usize| (0..=2 * n).map(move |i| unlike[(j % m) * n + i % n]);
        let grid = PathGrid {
            source: sums(a, 2 * n),
            target: sums(b, m),
            unlike: (0..=m).flat_map(row).collect(),
            stretch,
        };
        (grid, n)
    }

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
        fn every_start_is_as_cheap_as_its_own_plain_program((grid, n) in torus()) {
            let routes = all_starts(&grid.prices(), n);
            prop_assert_eq!(routes.len(), n);
            for (k, route) in routes.iter().enumerate() {
                let plain = grid.prices().shortest([k, k + n], |_| [k, k + n], &mut PathBuffers::default());
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
            let least = |routes: Vec<GridPath>| routes.iter().map(|r| r.cost).fold(f64::INFINITY, f64::min);
            let (c, d) = (least(all_starts(&there.prices(), n)), least(all_starts(&back.prices(), m)));
            prop_assert!((c - d).abs() <= 1e-12 * (1.0 + c));
        }
    }
}
