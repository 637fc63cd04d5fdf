//! Summary of `check --pairs`: counts of failures and defects, and statistics of the main measures.

use serde::Serialize;

use super::columns;
use super::columns::{BetterDirection, ReportColumn};
use super::histogram::Histogram;
use super::number::{NumberLines, short};
use super::report::PairReport;

/// Minimum number of values for which a histogram is shown. For fewer values, the median and the
/// worst value say as much (heuristic).
const MIN_HISTOGRAM_VALUES: usize = 10;

/// Width of the labels, in characters (derived: the longest label has 43).
const LABEL_WIDTH: usize = 44;

/// Name of the line with the number of pairs that were not measured.
const NOT_MEASURED: &str = "not measured";

/// Summary of all pairs of a table.
#[derive(Debug, Serialize)]
pub(in crate::cli) struct PairSummary {
    /// Number of pairs; with `--both`, each direction counts.
    pub pairs: usize,
    /// Number of pairs that could not be measured because of an error.
    pub failures: usize,
    /// Number of pairs that were not measured because the work was cancelled.
    pub unfinished: usize,
    /// Number of pairs with folded faces at a sampled t.
    pub with_folds: usize,
    /// Number of pairs whose boundary crosses itself at a sampled t.
    pub with_crossings: usize,
    /// Number of pairs with more connected regions or holes at a sampled t than at t = 0 and t = 1.
    pub with_tears: usize,
    /// Statistics of the main measures, in the order of the columns.
    pub measures: Vec<MeasuredPairs>,
}

/// Statistics of one measure over all pairs that have it.
#[derive(Debug, Serialize)]
pub(in crate::cli) struct MeasuredPairs {
    /// Heading of the measure's column.
    pub column: String,
    /// Label of the measure with its unit, for people.
    #[serde(skip)]
    label: String,
    pub median: f64,
    /// Value that a tenth of the pairs exceed, or fall below where large values are better.
    pub worst_tenth: f64,
    pub worst: f64,
    /// Histogram of the values; only for some measures and if there are enough values.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub spread: Option<Histogram>,
}

impl PairSummary {
    /// Summarises the reports on all measured pairs, with `None` for each pair that failed.
    /// `unfinished` is the number of pairs that were not measured.
    pub fn of<'a>(
        reports: impl IntoIterator<Item = Option<&'a PairReport>>,
        unfinished: usize,
    ) -> Self {
        let rows: Vec<Option<&PairReport>> = reports.into_iter().collect();
        let measured: Vec<&PairReport> = rows.iter().copied().flatten().collect();
        let count = |has: fn(&PairReport) -> bool| measured.iter().filter(|r| has(r)).count();
        let columns = columns::ALL.iter();
        Self {
            pairs: rows.len() + unfinished,
            failures: rows.len() - measured.len(),
            unfinished,
            with_folds: count(|r| r.film.worst_folds > Some(0)),
            with_crossings: count(|r| r.film.worst_crossings > Some(0)),
            with_tears: count(|r| r.film.pieces_excess.max(r.film.holes_excess) > Some(0)),
            measures: columns.filter_map(|c| statistics(&measured, c)).collect(),
        }
    }

    /// Returns the summary as text in aligned columns.
    pub fn text(&self) -> String {
        let mut lines = NumberLines::default();
        let measured = self.pairs - self.unfinished - self.failures;
        let of_measured = |n: usize| format!("{n} of {measured}");
        for (name, value) in [
            ("pairs", self.pairs.to_string()),
            ("failures", self.failures.to_string()),
            (NOT_MEASURED, self.unfinished.to_string()),
            ("with folds", of_measured(self.with_folds)),
            ("with crossings", of_measured(self.with_crossings)),
            ("with extra pieces or holes", of_measured(self.with_tears)),
        ] {
            // Usually all pairs are measured, and the line is left out.
            if name != NOT_MEASURED || self.unfinished > 0 {
                lines.cells((name, LABEL_WIDTH), [value]);
            }
        }
        if !self.measures.is_empty() {
            lines.gap();
            lines.cells(("", LABEL_WIDTH), ["median", "worst tenth", "worst"]);
        }
        for measure in &self.measures {
            let values = [measure.median, measure.worst_tenth, measure.worst];
            lines.cells((&measure.label, LABEL_WIDTH), values.map(short));
        }
        for measure in &self.measures {
            if let Some(histogram) = &measure.spread {
                lines.gap();
                lines.line(&measure.label);
                histogram.text().lines().for_each(|line| lines.line(line));
            }
        }
        lines.0
    }
}

/// Returns the statistics of a column over all reports; `None` if the summary omits the column or
/// no pair has the measure.
fn statistics(reports: &[&PairReport], column: &ReportColumn) -> Option<MeasuredPairs> {
    let (_, better) = column.in_summary?;
    let mut values: Vec<f64> = reports.iter().filter_map(|r| column.number(r)).collect();
    values.sort_unstable_by(f64::total_cmp);
    if matches!(better, BetterDirection::Large) {
        values.reverse();
    }
    let worst = *values.last()?;
    let [median, worst_tenth] = [0.5, 0.9].map(|fraction| quantile(&values, fraction));
    let is_drawn = column.is_drawn && values.len() >= MIN_HISTOGRAM_VALUES;
    Some(MeasuredPairs {
        column: column.heading(),
        label: column.label()?,
        median,
        worst_tenth,
        worst,
        spread: is_drawn.then(|| Histogram::of(&values)).flatten(),
    })
}

/// Returns the quantile of sorted values at `fraction`, in [0, 1]. Interpolates linearly between
/// neighbouring values (Hyndman and Fan 1996, definition 7).
///
/// # Panics
/// If there are no values.
fn quantile(sorted: &[f64], fraction: f64) -> f64 {
    let position = fraction * (sorted.len() - 1) as f64;
    let [below, above] = [position.floor(), position.ceil()].map(|k| sorted[k as usize]);
    if below == above {
        // The difference of two infinite values would be NaN.
        return below;
    }
    below + (position - position.floor()) * (above - below)
}

#[cfg(test)]
mod tests {
    use super::super::clock::StageDurations;
    use super::*;
    use crate::cli::inputs::OpenedPair;
    use crate::project::gallery;
    use crate::transition::Transition;
    use crate::work::progress::Silent;
    use std::time::Duration;

    fn report() -> PairReport {
        let loaded = gallery::load("triangle-polar").expect("bundled");
        let spec = loaded.spec().expect("a spec");
        let opened = OpenedPair {
            transition: Transition::build(&spec, &Silent).expect("built"),
            loaded,
            import_time: Duration::ZERO,
            build_time: Duration::ZERO,
        };
        PairReport::of(&opened, StageDurations::new(), 3, &Silent).expect("measured")
    }

    #[test]
    fn failures_are_counted_and_ignored_in_medians() {
        let with = |excess: f64, angle: f64, folds: usize| {
            let mut report = report();
            report.film.conformal_excess = Some(excess);
            report.film.worst_folds = Some(folds);
            report.mesh.as_mut().expect("a mesh").min_angle_source_deg = angle;
            report
        };
        let [a, b, c] = [with(1.0, 20.0, 0), with(3.0, 10.0, 4), with(2.0, 15.0, 0)];
        let summary = PairSummary::of([Some(&a), None, Some(&b), Some(&c)], 0);
        assert_eq!((summary.pairs, summary.failures), (4, 1));
        assert_eq!((summary.with_folds, summary.with_crossings), (1, 0));
        let measure = |column: &str| {
            let mut measures = summary.measures.iter();
            measures.find(|m| m.column == column).expect("a measure")
        };
        let excess = measure("conformal_excess");
        assert_eq!((excess.median, excess.worst), (2.0, 3.0));
        let angle = measure("min_angle_source_deg");
        assert_eq!((angle.median, angle.worst), (15.0, 10.0));
        assert!((angle.worst_tenth - 11.0).abs() < 1e-12, "{angle:?}");
        let line = |name: &str, value: &str| format!("{name:<44}{value:>12}\n");
        let text = summary.text();
        assert!(text.contains(&line("failures", "1")), "{text}");
        assert!(!text.contains("not measured"), "{text}");
        let text = PairSummary::of([Some(&a), None], 5).text();
        assert!(text.contains(&line("not measured", "5")), "{text}");
        assert!(text.contains(&line("with folds", "0 of 1")), "{text}");
    }

    #[test]
    fn a_tenth_of_the_values_exceeds_the_worst_tenth() {
        let values: Vec<f64> = (0..=20).map(f64::from).collect();
        assert_eq!(quantile(&values, 0.9), 18.0);
        assert_eq!(quantile(&[7.0], 0.9), 7.0);
        assert!((quantile(&[1.0, 2.0], 0.9) - 1.9).abs() < 1e-12);
        // The distortion of folded faces is infinite.
        let infinite = [1.0, f64::INFINITY, f64::INFINITY];
        assert_eq!(quantile(&infinite, 0.9), f64::INFINITY);
        assert_eq!(quantile(&infinite, 0.4), f64::INFINITY);
    }
}
