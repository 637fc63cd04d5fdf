//! Histogram of a measure over all pairs of a table, on a logarithmic scale, as data and as text.

use serde::Serialize;

use super::number::short;

/// Bin edges of one power of ten (the R5 series of preferred numbers, ISO 3). Each is about 1.6
/// times the previous one.
const SERIES: [f64; 5] = [1.0, 1.6, 2.5, 4.0, 6.3];

/// Maximum number of bins of the usual width, from one number of [`SERIES`] to the next. If the
/// values range further, one wider bin below and one above contain the rest (heuristic).
const MAX_STEPS: usize = 12;

/// Length of the longest bar, in characters (heuristic). The edges and the count of the bin, which
/// precede the bar on its line, take 26 characters more.
const MAX_BAR_LENGTH: usize = 40;

/// Number of values in each bin.
#[derive(Debug, PartialEq, Serialize)]
pub(in crate::cli) struct Histogram {
    /// Edges of the bins, ascending; one more than there are bins. The first and the last bin may
    /// be wider than the others, so that they contain all values. The last edge may be infinite.
    pub edges: Vec<f64>,
    /// Number of values in each bin. A bin includes its lower edge but not its upper edge, unless
    /// that edge is infinite.
    pub counts: Vec<usize>,
}

impl Histogram {
    /// Creates a histogram of the positive values, including infinite ones; `None` if no positive
    /// value is finite. Other values are ignored.
    pub fn of(values: &[f64]) -> Option<Self> {
        let mut sorted: Vec<f64> = values.iter().copied().filter(|v| *v > 0.0).collect();
        // Infinite values are last.
        sorted.sort_unstable_by(f64::total_cmp);
        let finite = sorted.partition_point(|value| value.is_finite());
        let steps: Vec<i32> = sorted[..finite].iter().copied().map(step_below).collect();
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
        // Outliers have a separate bin, as wide as necessary. Otherwise all other values would
        // share a single bin.
        if below > 0 {
            edges.insert(0, edge(steps[0]));
            counts.insert(0, below);
        }
        if let Some(largest) = sorted[above..].last() {
            edges.push(match largest.is_finite() {
                true => edge(step_below(*largest) + 1),
                false => *largest,
            });
            counts.push(sorted.len() - above);
        }
        Some(Self { edges, counts })
    }

    /// Returns one line per bin: its edges, its count and a bar.
    pub fn text(&self) -> String {
        let max_count = self.counts.iter().copied().max().unwrap_or(0).max(1);
        let line = |(edges, &count): (&[f64], &usize)| {
            let [low, high] = [edges[0], edges[1]].map(short);
            let bar = "\u{2588}".repeat((count * MAX_BAR_LENGTH).div_ceil(max_count));
            format!("{low:>9} to {high:<7}{count:>5} {bar}\n")
        };
        self.edges.windows(2).zip(&self.counts).map(line).collect()
    }
}

/// Returns the range of at most [`MAX_STEPS`] consecutive bins that contains the most values: the
/// index of its first and of its last bin with a value. `steps` holds the index of each value's
/// bin, in ascending order.
fn fullest(steps: &[i32]) -> Option<(i32, i32)> {
    let range_from = |start: usize| {
        let last = steps[start] + MAX_STEPS as i32 - 1;
        (start, steps.partition_point(|step| *step <= last))
    };
    // `max_by_key` returns the last maximum; reversed, this is the range with the smallest values.
    let ranges = (0..steps.len()).rev().map(range_from);
    let (start, end) = ranges.max_by_key(|(start, end)| end - start)?;
    Some((steps[start], steps[end - 1]))
}

/// Returns the lower edge of the bin with the index `step`. Bin 0 starts at 1, bin 5 at 10, bin -5
/// at 0.1.
fn edge(step: i32) -> f64 {
    let (series, power) = (SERIES[step.rem_euclid(5) as usize], step.div_euclid(5));
    // Parsed from text, because a product with a power of ten would be rounded.
    format!("{series}e{power}").parse().unwrap_or_default()
}

/// Returns the index of the bin that contains a value: the last bin whose lower edge is at most
/// `value`.
fn step_below(value: f64) -> i32 {
    // The estimate is wrong by at most one bin, because the series is rounded.
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
        let histogram = Histogram::of(&[1.0, 1.2, 1.6, 3.9, f64::NAN, 0.0]).expect("bins");
        assert_eq!(histogram.edges, [1.0, 1.6, 2.5, 4.0]);
        assert_eq!(histogram.counts, [2, 1, 1]);
        assert_eq!(Histogram::of(&[0.0]), None);
        assert_eq!(Histogram::of(&[f64::INFINITY]), None);
    }

    #[test]
    fn a_single_value_has_a_single_bin() {
        for value in [0.016, 1.0, 3.0, 1e-9, 7e20] {
            let histogram = Histogram::of(&[value]).expect("a bin");
            assert_eq!(histogram.counts, [1], "{value}");
            assert!(histogram.edges[0] <= value && value <= histogram.edges[1]);
        }
    }

    #[test]
    fn outliers_have_bins_of_their_own() {
        let with_outliers = Histogram::of(&[1e-30, 1.0, 1.7, 1.8, 9.0, 1e30]).expect("bins");
        let edges = &with_outliers.edges;
        assert_eq!(with_outliers.counts, [1, 1, 2, 0, 0, 1, 1]);
        assert!(edges[0] <= 1e-30 && *edges.last().expect("an edge") >= 1e30);
        assert_eq!(edges[1..7], [1.0, 1.6, 2.5, 4.0, 6.3, 10.0]);
        let with_infinity = Histogram::of(&[1.0, 2.0, f64::INFINITY]).expect("bins");
        assert_eq!(with_infinity.counts, [1, 1, 1]);
        assert_eq!(with_infinity.edges, [1.0, 1.6, 2.5, f64::INFINITY]);
        // Three values share a bin of the usual width; the fourth has a wide bin.
        let with_gap = Histogram::of(&[1.0, 1.1, 1.2, 1e9]).expect("bins");
        assert_eq!(with_gap.counts, [3, 1]);
        assert_eq!(with_gap.edges, [1.0, 1.6, 1.6e9]);
    }
}
