//! Interpolation nodes within a time interval of a recording, and the polynomials through the
//! values at these nodes.
//!
//! Within an interval, s runs from 0 to 1. The recorded functions are zero at s = 0 and s = 1, so
//! both ends serve as nodes without an evaluation. The other nodes are Leja points: the next one
//! maximises the product of its distances to both ends and to all earlier nodes. After each node s,
//! its mirror image 1 − s is the next node, so that the reversed motion is evaluated at the same
//! times. The values at a new pair of nodes first serve as a test of the polynomial through the
//! values at the earlier nodes. If the test fails, a polynomial through all values, old and new, is
//! formed and tested at the next pair.
//!
//! A function is written as b(s) Σ c_k T_k(2s − 1), with b(s) = 4s(1 − s) and the Chebyshev
//! polynomials T_k. The smoother the function, the faster the coefficients c_k decrease. An omitted
//! term is never larger than its coefficient.

use crate::numerics::DenseLu;
use std::sync::LazyLock;

/// Maximum number of nodes within an interval, not counting its ends (resource limit: an interval
/// that needs more is halved). The number is odd, because the first node is the middle and the
/// others come in pairs s and 1 − s.
pub(crate) const MAX_NODES: usize = 23;

/// Number of candidate positions for the next node in the first half of an interval (resource
/// limit).
const NODE_CANDIDATES: usize = 1 << 14;

/// Leja points in [0, 1]: the middle, then pairs s and 1 − s.
static NODES: LazyLock<[f64; MAX_NODES]> = LazyLock::new(|| {
    let mut nodes = [0.5; MAX_NODES];
    for first in (1..MAX_NODES).step_by(2) {
        // Logarithm of the product of the distances to the earlier nodes and both ends; the next
        // Leja point maximises it.
        let log_product = |s: f64| -> f64 {
            let product = |from: &[f64]| from.iter().map(|x| (s - x).abs().ln()).sum::<f64>();
            (s * (1.0 - s)).ln() + product(&nodes[..first])
        };
        let candidates = (1..NODE_CANDIDATES).map(|k| 0.5 * k as f64 / NODE_CANDIDATES as f64);
        let farthest = candidates.max_by(|a, b| log_product(*a).total_cmp(&log_product(*b)));
        let next = farthest.unwrap_or(0.5);
        nodes[first] = next;
        nodes[first + 1] = 1.0 - next;
    }
    nodes
});

/// Returns the nodes in the order in which they are evaluated.
pub(super) fn nodes() -> &'static [f64; MAX_NODES] {
    &NODES
}

/// Factor b(s) of the basis functions: 1 in the middle of the interval, 0 at both ends.
fn bubble(s: f64) -> f64 {
    4.0 * s * (1.0 - s)
}

/// Returns a weight for each of the first `n` nodes, followed by zeros. Consider the polynomial
/// that is zero at both ends of the interval and has given values at these nodes. Its value at `s`
/// is the sum of the given values, each multiplied by the weight of its node.
pub(super) fn weights(n: usize, s: f64) -> [f64; MAX_NODES] {
    let nodes = nodes();
    let mut weights = [0.0; MAX_NODES];
    for j in 0..n {
        let others = (0..n).filter(|&k| k != j);
        let ratio = |k: usize| (s - nodes[k]) / (nodes[j] - nodes[k]);
        weights[j] = bubble(s) / bubble(nodes[j]) * others.map(ratio).product::<f64>();
    }
    weights
}

/// Returns the values at `s` of the basis functions b(s) T_k(2s − 1) for k below `n`. All of them
/// are exactly 0 at s = 0 and s = 1.
pub(super) fn basis(n: usize, s: f64) -> [f64; MAX_NODES] {
    let x = 2.0 * s - 1.0;
    let mut values = [0.0; MAX_NODES];
    let [mut previous, mut current] = [x, 1.0]; // T_{-1} = T_1
    for value in values.iter_mut().take(n) {
        *value = bubble(s) * current;
        [previous, current] = [current, 2.0 * x * current - previous];
    }
    values
}

/// Returns the rows of the matrix that converts the values of a function at the first `n` nodes to
/// the coefficients c_k of its series b(s) Σ c_k T_k(2s − 1).
pub(super) fn coefficients_from_values(n: usize) -> Vec<Vec<f64>> {
    // Column k contains the values of basis function k at all nodes.
    let at_nodes: Vec<[f64; MAX_NODES]> = nodes()[..n].iter().map(|&s| basis(n, s)).collect();
    let columns: Vec<f64> = (0..n)
        .flat_map(|k| at_nodes.iter().map(move |values| values[k]))
        .collect();
    let mut lu = DenseLu::new();
    lu.factor(n, &columns);
    let mut rows = vec![vec![0.0; n]; n];
    for j in 0..n {
        let mut unit = vec![0.0; n];
        unit[j] = 1.0;
        lu.solve(&mut unit);
        rows.iter_mut().zip(unit).for_each(|(row, c)| row[j] = c);
    }
    rows
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Deviation from the straight line for a part that turns by 2 radians; zero at both ends.
    fn turning(s: f64) -> f64 {
        (2.0 * s).sin() - s * 2.0_f64.sin()
    }

    #[test]
    fn nodes_are_distinct_and_come_in_pairs() {
        let nodes = nodes();
        for pair in nodes[1..].chunks(2) {
            assert!((pair[0] + pair[1] - 1.0).abs() < 1e-15);
        }
        let mut sorted = nodes.to_vec();
        sorted.sort_by(f64::total_cmp);
        assert!(sorted.windows(2).all(|two| two[1] - two[0] > 1e-3));
        assert!(sorted[0] > 0.0 && sorted[MAX_NODES - 1] < 1.0);
    }

    #[test]
    fn both_forms_interpolate_the_values_at_the_nodes() {
        for n in [1, 5, 9, 15, MAX_NODES] {
            let values: Vec<f64> = nodes()[..n].iter().map(|&s| turning(s)).collect();
            let rows = coefficients_from_values(n);
            let coefficients: Vec<f64> = rows
                .iter()
                .map(|row| row.iter().zip(&values).map(|(a, v)| a * v).sum())
                .collect();
            for k in 0..=64 {
                let s = f64::from(k) / 64.0;
                let sum = |weights: [f64; MAX_NODES], of: &[f64]| -> f64 {
                    weights.iter().zip(of).map(|(w, c)| w * c).sum()
                };
                let through = sum(weights(n, s), &values);
                let summed = sum(basis(n, s), &coefficients);
                assert!((through - summed).abs() < 1e-12, "{n} {s}");
                if n >= 9 {
                    assert!((summed - turning(s)).abs() < 1e-8, "{n} {s}");
                }
            }
        }
    }
}
