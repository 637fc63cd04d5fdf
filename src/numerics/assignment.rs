//! The assignment problem by shortest augmenting paths with potentials
//! (Kuhn 1955; Jonker and Volgenant 1987). O(rows² · columns).

/// For each row the column it is given, all different, so that the sum of the
/// costs is least. Rows must not outnumber columns; costs are finite.
pub(crate) fn assign(
    rows: usize,
    columns: usize,
    cost: impl Fn(usize, usize) -> f64,
) -> Vec<usize> {
    // One row and column 0 stand before the first: "none".
    let mut row_price = vec![0.0; rows + 1];
    let mut column_price = vec![0.0; columns + 1];
    let mut row_of = vec![0; columns + 1];
    for row in 1..=rows {
        row_of[0] = row;
        let mut free = 0;
        let mut least = vec![f64::INFINITY; columns + 1];
        let mut via = vec![0; columns + 1];
        let mut done = vec![false; columns + 1];
        // Dijkstra over reduced costs, which the prices keep from being negative.
        while row_of[free] != 0 {
            done[free] = true;
            let here = row_of[free];
            let (mut step, mut next) = (f64::INFINITY, 0);
            for column in (1..=columns).filter(|&c| !done[c]) {
                let reduced = cost(here - 1, column - 1) - row_price[here] - column_price[column];
                if reduced < least[column] {
                    least[column] = reduced;
                    via[column] = free;
                }
                if least[column] < step {
                    (step, next) = (least[column], column);
                }
            }
            for column in 0..=columns {
                if done[column] {
                    row_price[row_of[column]] += step;
                    column_price[column] -= step;
                } else {
                    least[column] -= step;
                }
            }
            free = next;
        }
        // Each column along the path goes to the row that reached it.
        while free != 0 {
            row_of[free] = row_of[via[free]];
            free = via[free];
        }
    }
    let mut given = vec![0; rows];
    for column in 1..=columns {
        if row_of[column] != 0 {
            given[row_of[column] - 1] = column - 1;
        }
    }
    given
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// All assignments, one by one.
    fn least(rows: usize, cost: &dyn Fn(usize, usize) -> f64, free: &mut Vec<usize>) -> f64 {
        if rows == 0 {
            return 0.0;
        }
        let mut best = f64::INFINITY;
        for k in 0..free.len() {
            let column = free.remove(k);
            best = best.min(cost(rows - 1, column) + least(rows - 1, cost, free));
            free.insert(k, column);
        }
        best
    }

    proptest! {
        #[test]
        fn no_assignment_is_cheaper(
            rows in 0usize..6, more in 0usize..2,
            costs in prop::collection::vec(-3.0f64..9.0, 42),
        ) {
            let cost = |r: usize, c: usize| costs[7 * r + c];
            let given = assign(rows, rows + more, cost);
            let mut distinct = given.clone();
            distinct.sort_unstable();
            distinct.dedup();
            prop_assert_eq!(distinct.len(), rows);
            let sum: f64 = given.iter().enumerate().map(|(r, &c)| cost(r, c)).sum();
            let oracle = least(rows, &cost, &mut (0..rows + more).collect());
            prop_assert!((sum - oracle).abs() < 1e-9);
        }
    }
}
