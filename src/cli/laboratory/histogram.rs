//! How the values of a measure are spread, as lines of text.

use serde::Serialize;

use super::number::short;

/// Each edge is about 1.6 times the one before (the R5 series of ISO 3).
const SERIES: [f64; 5] = [1.0, 1.6, 2.5, 4.0, 6.3];

/// Most bars of one step: where values spread wider, one before them and one
/// behind them take the rest.
const MOST: usize = 12;

/// Length of the longest bar, in characters: with what stands before it a line
/// has 66.
const LONGEST: usize = 40;

/// Counts of values between edges.
#[derive(Debug, PartialEq, Serialize)]
pub(in crate::cli) struct Histogram {
    /// One more than there are counts, ascending. The first bar and the last
    /// may be wider than a step, to reach as far as the values do.
    pub edges: Vec<f64>,
    /// How many values lie from one edge to the next, the last included.
    pub counts: Vec<usize>,
}

impl Histogram {
    /// Of positive numbers, infinite ones included; `None` where no finite
    /// one is.
    pub fn of(values: &[f64]) -> Option<Self> {
        let mut sizes: Vec<f64> = values.iter().copied().filter(|v| *v > 0.0).collect();
        // Infinite ones come last.
        sizes.sort_unstable_by(f64::total_cmp);
        let finite = sizes.partition_point(|size| size.is_finite());
        let steps: Vec<i32> = sizes[..finite].iter().copied().map(step_below).collect();
        let (first, last) = fullest(&steps)?;
        let mut edges: Vec<f64> = (first..=last + 1).map(edge).collect();
        let mut counts = vec![0; edges.len() - 1];
        let (below, above) = (
            steps.partition_point(|step| *step < first),
            steps.partition_point(|step| *step <= last),
        );
        for step in &steps[below..above] {
            counts[(step - first) as usize] += 1;
        }
        // Values far off must not press all others into one bar, nor be taken
        // for their neighbours: they have a bar of their own, as wide as it takes.
        if below > 0 {
            edges.insert(0, edge(steps[0]));
            counts.insert(0, below);
        }
        if let Some(most) = sizes[above..].last() {
            edges.push(match most.is_finite() {
                true => edge(step_below(*most) + 1),
                false => *most,
            });
            counts.push(sizes.len() - above);
        }
        Some(Self { edges, counts })
    }

    /// A line for each bar.
    pub fn text(&self) -> String {
        let most = self.counts.iter().copied().max().unwrap_or(0).max(1);
        let line = |(edges, &count): (&[f64], &usize)| {
            let [low, high] = [edges[0], edges[1]].map(short);
            let bar = "\u{2588}".repeat((count * LONGEST).div_ceil(most));
            format!("{low:>9} to {high:<7}{count:>5} {bar}\n")
        };
        self.edges.windows(2).zip(&self.counts).map(line).collect()
    }
}

/// The first and the last of the [`MOST`] steps in a row, or fewer, that hold
/// the most values; of ascending steps.
fn fullest(steps: &[i32]) -> Option<(i32, i32)> {
    let held = |from: usize| {
        let last = steps[from] + MOST as i32 - 1;
        (from, steps.partition_point(|step| *step <= last))
    };
    // Of equals the lowest, which `max_by_key` has last.
    let windows = (0..steps.len()).rev().map(held);
    let (from, end) = windows.max_by_key(|(from, end)| end - from)?;
    Some((steps[from], steps[end - 1]))
}

fn edge(step: i32) -> f64 {
    let (series, power) = (SERIES[step.rem_euclid(5) as usize], step.div_euclid(5));
    // Read as it is written, for products with powers of ten are not exact.
    format!("{series}e{power}").parse().unwrap_or_default()
}

fn step_below(value: f64) -> i32 {
    // Off by one at most: the series is rounded, and so is the logarithm.
    let near = (5.0 * value.log10()).floor() as i32;
    (near - 1..=near + 1)
        .rev()
        .find(|&step| edge(step) <= value)
        .unwrap_or(near - 2)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_value_is_counted_once_and_edges_are_round() {
        let found = Histogram::of(&[1.0, 1.2, 1.6, 3.9, f64::NAN, 0.0]).expect("bars");
        assert_eq!(found.edges, [1.0, 1.6, 2.5, 4.0]);
        assert_eq!(found.counts, [2, 1, 1]);
        assert_eq!(Histogram::of(&[0.0]), None);
        assert_eq!(Histogram::of(&[f64::INFINITY]), None);
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
    fn values_far_off_leave_the_others_apart() {
        let found = Histogram::of(&[1e-30, 1.0, 1.7, 1.8, 9.0, 1e30]).expect("bars");
        assert_eq!(found.counts, [1, 1, 2, 0, 0, 1, 1]);
        assert!(found.edges[0] <= 1e-30 && *found.edges.last().expect("an edge") >= 1e30);
        assert_eq!(found.edges[1..7], [1.0, 1.6, 2.5, 4.0, 6.3, 10.0]);
        let found = Histogram::of(&[1.0, 2.0, f64::INFINITY]).expect("bars");
        assert_eq!(found.counts, [1, 1, 1]);
        assert_eq!(found.edges, [1.0, 1.6, 2.5, f64::INFINITY]);
        // All but one in one step: the one is not among them.
        let found = Histogram::of(&[1.0, 1.1, 1.2, 1e9]).expect("bars");
        assert_eq!(found.counts, [3, 1]);
        assert_eq!(found.edges, [1.0, 1.6, 1.6e9]);
    }
}
