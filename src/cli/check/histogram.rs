//! How the values of a measure are spread, as lines of text.

use std::fmt::Write;

use serde::Serialize;

use super::text::short;

/// Each edge is about 1.6 times the one before (the R5 series of ISO 3).
const SERIES: [f64; 5] = [1.0, 1.6, 2.5, 4.0, 6.3];

/// Most bars: where values spread wider, the outer ones take the rest.
const MOST: usize = 12;

/// Length of the longest bar, in characters.
const LONGEST: usize = 40;

/// Counts of values between edges.
#[derive(Debug, PartialEq, Serialize)]
pub(super) struct Histogram {
    /// One more than there are counts, ascending.
    pub edges: Vec<f64>,
    /// How many values lie from one edge to the next, the last included.
    pub counts: Vec<usize>,
}

impl Histogram {
    /// Of positive numbers; `None` where there are none.
    pub fn of(values: &[f64]) -> Option<Self> {
        let sizes = values.iter().copied().filter(|v| *v > 0.0 && v.is_finite());
        let sizes: Vec<f64> = sizes.collect();
        let least = sizes.iter().copied().reduce(f64::min)?;
        let most = sizes.iter().copied().fold(least, f64::max);
        let last = step_above(most).max(step_below(least) + 1);
        let first = step_below(least).max(last - MOST as i32);
        let edges: Vec<f64> = (first..=last).map(edge).collect();
        let mut counts = vec![0; edges.len() - 1];
        for size in sizes {
            let bar = edges.partition_point(|edge| *edge <= size);
            counts[bar.clamp(1, edges.len() - 1) - 1] += 1;
        }
        Some(Self { edges, counts })
    }

    /// A line for each bar.
    pub fn text(&self) -> String {
        let most = self.counts.iter().copied().max().unwrap_or(0).max(1);
        let mut text = String::new();
        for (edges, &count) in self.edges.windows(2).zip(&self.counts) {
            let [low, high] = [edges[0], edges[1]].map(short);
            let bar = "\u{2588}".repeat((count * LONGEST).div_ceil(most));
            writeln!(text, "{low:>9} to {high:<7}{count:>5} {bar}").unwrap_or_default();
        }
        text
    }
}

fn edge(step: i32) -> f64 {
    let series = SERIES[step.rem_euclid(5) as usize];
    // Powers of ten below one are exact as quotients only.
    match step.div_euclid(5) {
        power @ 0.. => series * 10f64.powi(power),
        power => series / 10f64.powi(-power),
    }
}

fn step_below(value: f64) -> i32 {
    let near = (5.0 * value.log10()).floor() as i32;
    (near - 1..=near + 1)
        .rev()
        .find(|&step| edge(step) <= value)
        .unwrap_or(near - 2)
}

fn step_above(value: f64) -> i32 {
    let below = step_below(value);
    if edge(below) < value {
        below + 1
    } else {
        below
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_value_is_counted_once_and_edges_are_round() {
        let found = Histogram::of(&[1.0, 1.2, 1.6, 4.0, f64::NAN, 0.0]).expect("bars");
        assert_eq!(found.edges, [1.0, 1.6, 2.5, 4.0]);
        assert_eq!(found.counts, [2, 1, 1]);
        assert_eq!(Histogram::of(&[0.0]), None);
    }

    #[test]
    fn one_value_has_one_bar_wherever_it_is() {
        for value in [0.016, 1.0, 3.0, 1e-9, 7e20] {
            let found = Histogram::of(&[value]).expect("a bar");
            assert_eq!(found.counts, [1], "{value}");
            assert!(found.edges[0] <= value && value <= found.edges[1]);
        }
    }

    #[test]
    fn a_wide_spread_keeps_its_largest_values_apart() {
        let found = Histogram::of(&[1e-30, 1.0, 90.0]).expect("bars");
        assert_eq!(found.counts.len(), MOST);
        assert_eq!(found.counts.iter().sum::<usize>(), 3);
    }
}
