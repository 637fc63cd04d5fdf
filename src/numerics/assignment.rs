//! Solves the assignment problem by shortest augmenting paths with potentials (Kuhn 1955; Jonker
//! and Volgenant 1987) in O(rows² · columns).

/// Assigns each row a different column so that the sum of the costs `cost(row, column)` is minimal,
/// and returns the column of each row. Rows must not outnumber columns, and costs must be finite.
pub(crate) fn assign(
    rows: usize,
    columns: usize,
    cost: impl Fn(usize, usize) -> f64,
) -> Vec<usize> {
    // Index 0 of each array is a dummy row or column, which stands for "unassigned"; real rows and
    // columns start at 1.
    let mut row_potential = vec![0.0; rows + 1];
    let mut column_potential = vec![0.0; columns + 1];
    let mut row_of = vec![0; columns + 1];
    for row in 1..=rows {
        row_of[0] = row;
        let mut current_column = 0;
        let mut distance = vec![f64::INFINITY; columns + 1];
        let mut predecessor = vec![0; columns + 1];
        let mut is_visited = vec![false; columns + 1];
        // Dijkstra's algorithm on reduced costs, which the potentials keep non-negative.
        while row_of[current_column] != 0 {
            is_visited[current_column] = true;
            let current_row = row_of[current_column];
            let (mut step, mut next) = (f64::INFINITY, 0);
            for column in (1..=columns).filter(|&c| !is_visited[c]) {
                let reduced = cost(current_row - 1, column - 1)
                    - row_potential[current_row]
                    - column_potential[column];
                if reduced < distance[column] {
                    distance[column] = reduced;
                    predecessor[column] = current_column;
                }
                if distance[column] < step {
                    (step, next) = (distance[column], column);
                }
            }
            for column in 0..=columns {
                if is_visited[column] {
                    row_potential[row_of[column]] += step;
                    column_potential[column] -= step;
                } else {
                    distance[column] -= step;
                }
            }
            current_column = next;
        }
        // Augment: each column along the shortest path is reassigned to the row that reached it.
        while current_column != 0 {
            row_of[current_column] = row_of[predecessor[current_column]];
            current_column = predecessor[current_column];
        }
    }
    let mut assigned = vec![0; rows];
    for column in 1..=columns {
        if row_of[column] != 0 {
            assigned[row_of[column] - 1] = column - 1;
        }
    }
    assigned
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Returns the minimum cost by enumerating all assignments.
    fn brute_force_cost(
        rows: usize,
        cost: &dyn Fn(usize, usize) -> f64,
        free: &mut Vec<usize>,
    ) -> f64 {
        if rows == 0 {
            return 0.0;
        }
        let mut best = f64::INFINITY;
        for k in 0..free.len() {
            let column = free.remove(k);
            best = best.min(cost(rows - 1, column) + brute_force_cost(rows - 1, cost, free));
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
            let oracle = brute_force_cost(rows, &cost, &mut (0..rows + more).collect());
            prop_assert!((sum - oracle).abs() < 1e-9);
        }
    }
}
