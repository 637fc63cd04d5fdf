//! Chebyshev series of points over an interval of time.
//!
//! A smooth function is approximated by few terms of decreasing size (Trefethen 2013, chapters 3
//! and 8). The nodes are Chebyshev–Lobatto points, which include both ends, and the nodes for 2n
//! intervals contain those for n.

use crate::geometry::DVec2;
use std::f64::consts::PI;

/// Returns the `n` + 1 Chebyshev–Lobatto nodes, ascending from 0 to 1.
pub(super) fn chebyshev_nodes(n: usize) -> impl Iterator<Item = f64> {
    (0..=n).map(move |k| match k {
        // Both ends are set exactly, since the cosine would be off by rounding.
        0 => 0.0,
        k if k == n => 1.0,
        k => 0.5 - 0.5 * (PI * k as f64 / n as f64).cos(),
    })
}

/// Returns the Chebyshev series of the points as functions of s in [0, 1]. The series interpolate
/// the given positions: `at_nodes[k]` holds all points at the `k`-th of the [`chebyshev_nodes`].
/// Element `j` of the result holds, for each point, the coefficient of the Chebyshev polynomial
/// T_j(2s − 1).
pub(super) fn interpolate(at_nodes: &[&[DVec2]]) -> Vec<Vec<DVec2>> {
    let n = at_nodes.len() - 1;
    if n == 0 {
        return vec![at_nodes[0].to_vec()];
    }
    // Each coefficient is a weighted sum of the positions at the nodes. The first and the last node
    // have half the weight in it, and the first and the last coefficient are halved.
    let half = |k: usize| if k == 0 || k == n { 0.5 } else { 1.0 };
    let term = |j: usize| {
        let mut term = vec![DVec2::ZERO; at_nodes[0].len()];
        for (k, points) in at_nodes.iter().enumerate() {
            // The cosine of k π / n descends with k, but the nodes ascend; hence n − k.
            let angle = PI * (j * (n - k)) as f64 / n as f64;
            let weight = 2.0 / n as f64 * half(j) * half(k) * angle.cos();
            for (sum, &p) in term.iter_mut().zip(*points) {
                *sum += weight * p;
            }
        }
        term
    };
    (0..=n).map(term).collect()
}

/// Drops as many of the last terms of the points' Chebyshev series as possible. All dropped terms
/// together move no point by more than `tolerance`.
pub(super) fn truncate_series(terms: &mut Vec<Vec<DVec2>>, tolerance: f64) {
    let mut dropped = vec![0.0; terms.first().map_or(0, Vec::len)];
    while terms.len() > 1 {
        let Some(last) = terms.last() else { break };
        for (sum, p) in dropped.iter_mut().zip(last) {
            *sum += p.length();
        }
        if dropped.iter().any(|sum| *sum > tolerance) {
            break;
        }
        terms.pop();
    }
}

/// Returns the points at `s` in [0, 1] from their Chebyshev series. The Chebyshev polynomials are
/// computed by their three-term recurrence.
pub(super) fn evaluate(terms: &[Vec<DVec2>], s: f64) -> Vec<DVec2> {
    let x = 2.0 * s - 1.0;
    let mut sum = terms.first().cloned().unwrap_or_default();
    let (mut previous, mut polynomial) = (1.0, x);
    for term in terms.iter().skip(1) {
        for (sum, &c) in sum.iter_mut().zip(term) {
            *sum += polynomial * c;
        }
        (previous, polynomial) = (polynomial, 2.0 * x * polynomial - previous);
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rotation_needs_few_terms() {
        let at = |s: f64| vec![DVec2::from_angle(2.0 * s), DVec2::new(s, s * s)];
        let samples: Vec<_> = chebyshev_nodes(8).map(at).collect();
        let samples: Vec<&[DVec2]> = samples.iter().map(Vec::as_slice).collect();
        let mut terms = interpolate(&samples);
        for k in 0..=100 {
            let s = f64::from(k) / 100.0;
            for (found, expected) in evaluate(&terms, s).into_iter().zip(at(s)) {
                assert!(found.distance(expected) < 1e-7, "{s}: {found} {expected}");
            }
        }
        truncate_series(&mut terms, 1e-3);
        assert!((3..=6).contains(&terms.len()), "{}", terms.len());
        let off = evaluate(&terms, 0.3)[0].distance(at(0.3)[0]);
        assert!(off < 1e-3, "{off}");
    }

    #[test]
    fn nodes_for_n_intervals_are_among_those_for_twice_as_many() {
        let [few, many]: [Vec<f64>; 2] = [8, 16].map(|n| chebyshev_nodes(n).collect());
        assert!(
            few.iter()
                .zip(many.iter().step_by(2))
                .all(|(a, b)| (a - b).abs() < 1e-15)
        );
        assert_eq!((few[0], few[8]), (0.0, 1.0));
    }
}
