//! What came out of a table of pairs, in short.

use serde::Serialize;

use super::columns;
use super::columns::{BetterDirection, ReportColumn};
use super::histogram::Histogram;
use super::number::{NumberLines, short};
use super::report::PairReport;

/// The fewest values whose spread is drawn: of fewer, median and worst say as
/// much.
const ENOUGH: usize = 10;

/// The whole table in short.
#[derive(Debug, Serialize)]
pub(in crate::cli) struct PairSummary {
    /// Rows, each direction of its own.
    pub pairs: usize,
    /// Of them those that could not be built.
    pub failures: usize,
    /// Of them those that were not come to before the work was ended.
    pub unfinished: usize,
    /// Of them those with a fold at some t.
    pub with_folds: usize,
    /// Of them those whose boundary crosses itself at some t.
    pub with_crossings: usize,
    /// Of them those with more pieces or holes on the way than at the ends.
    pub with_tears: usize,
    /// Medians, worst tenths and worst values of the main measures.
    pub measures: Vec<MeasuredPairs>,
}

#[derive(Debug, Serialize)]
pub(in crate::cli) struct MeasuredPairs {
    pub column: String,
    #[serde(skip)]
    words: String,
    pub median: f64,
    /// What a tenth of the pairs are worse than.
    pub worst_tenth: f64,
    pub worst: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub spread: Option<Histogram>,
}

impl PairSummary {
    /// Of the report on each pair, `None` for those that failed, and of the number
    /// of those that there are no reports on.
    pub fn of<'a>(
        reports: impl IntoIterator<Item = Option<&'a PairReport>>,
        unfinished: usize,
    ) -> Self {
        let rows: Vec<Option<&PairReport>> = reports.into_iter().collect();
        let done: Vec<&PairReport> = rows.iter().copied().flatten().collect();
        let with = |is: fn(&PairReport) -> bool| done.iter().filter(|report| is(report)).count();
        let columns = columns::ALL.iter();
        Self {
            pairs: rows.len() + unfinished,
            failures: rows.len() - done.len(),
            unfinished,
            with_folds: with(|r| r.film.worst_folds > Some(0)),
            with_crossings: with(|r| r.film.worst_crossings > Some(0)),
            with_tears: with(|r| r.film.pieces_excess.max(r.film.holes_excess) > Some(0)),
            measures: columns.filter_map(|c| measured(&done, c)).collect(),
        }
    }

    /// In aligned lines.
    pub fn text(&self) -> String {
        const NAMES: usize = 36;
        let mut lines = NumberLines::default();
        let built = self.pairs - self.unfinished - self.failures;
        let of = |n: usize| format!("{n} of {built}");
        for (name, value) in [
            ("pairs", self.pairs.to_string()),
            ("failures", self.failures.to_string()),
            ("not come to", self.unfinished.to_string()),
            ("with a fold at some t", of(self.with_folds)),
            ("with a boundary crossing", of(self.with_crossings)),
            ("with pieces or holes of their own", of(self.with_tears)),
        ] {
            // Goes without saying where all was done.
            if name != "not come to" || self.unfinished > 0 {
                lines.cells((name, NAMES), [value]);
            }
        }
        if !self.measures.is_empty() {
            lines.gap();
            lines.cells(("", NAMES), ["median", "worst tenth", "worst"]);
        }
        for told in &self.measures {
            let values = [told.median, told.worst_tenth, told.worst];
            lines.cells((&told.words, NAMES), values.map(short));
        }
        for told in &self.measures {
            if let Some(spread) = &told.spread {
                lines.gap();
                lines.line(&told.words);
                spread.text().lines().for_each(|line| lines.line(line));
            }
        }
        lines.0
    }
}

fn measured(reports: &[&PairReport], column: &ReportColumn) -> Option<MeasuredPairs> {
    let (_, better) = column.told?;
    let mut all: Vec<f64> = reports.iter().filter_map(|r| column.number(r)).collect();
    all.sort_unstable_by(f64::total_cmp);
    if matches!(better, BetterDirection::Large) {
        all.reverse();
    }
    // None where no pair has the measure, such as faces of a field.
    let worst = *all.last()?;
    let [median, worst_tenth] = [0.5, 0.9].map(|share| quantile(&all, share));
    let is_drawn = column.is_drawn && all.len() >= ENOUGH;
    Some(MeasuredPairs {
        column: column.heading(),
        words: column.words()?,
        median,
        worst_tenth,
        worst,
        spread: is_drawn.then(|| Histogram::of(&all)).flatten(),
    })
}

/// What that share of sorted values, one at least, comes before; between two of them
/// on a straight line (Hyndman and Fan 1996, definition 7).
fn quantile(sorted: &[f64], share: f64) -> f64 {
    let at = share * (sorted.len() - 1) as f64;
    let [below, above] = [at.floor(), at.ceil()].map(|k| sorted[k as usize]);
    if below == above {
        // Two infinities have nothing between them.
        return below;
    }
    below + (at - at.floor()) * (above - below)
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
    fn failures_count_and_do_not_enter_medians() {
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
        let of = |column: &str| {
            let found = summary.measures.iter().find(|m| m.column == column);
            found.map(|measured| (measured.median, measured.worst))
        };
        assert_eq!(of("conformal_excess"), Some((2.0, 3.0)));
        assert_eq!(of("min_angle_source_deg"), Some((15.0, 10.0)));
        let angle = |m: &&MeasuredPairs| m.column == "min_angle_source_deg";
        let angle = summary.measures.iter().find(angle).expect("angles");
        assert!((angle.worst_tenth - 11.0).abs() < 1e-12, "{angle:?}");
        let text = summary.text();
        assert!(text.contains("failures                                       1"));
        assert!(!text.contains("not come to"));
        let text = PairSummary::of([Some(&a), None], 5).text();
        assert!(
            text.contains("not come to                                    5"),
            "{text}"
        );
        assert!(
            text.contains("with a fold at some t                     0 of 1"),
            "{text}"
        );
    }

    #[test]
    fn a_tenth_lies_beyond_the_worst_tenth() {
        let all: Vec<f64> = (0..=20).map(f64::from).collect();
        assert_eq!(quantile(&all, 0.9), 18.0);
        assert_eq!(quantile(&[7.0], 0.9), 7.0);
        assert!((quantile(&[1.0, 2.0], 0.9) - 1.9).abs() < 1e-12);
        // What turns inside out is as bad as can be.
        let infinite = [1.0, f64::INFINITY, f64::INFINITY];
        assert_eq!(quantile(&infinite, 0.9), f64::INFINITY);
        assert_eq!(quantile(&infinite, 0.4), f64::INFINITY);
    }
}
