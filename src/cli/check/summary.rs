//! What came out of a table of pairs, in short.

use std::fmt::Write;

use serde::Serialize;

use super::columns::{self, Value};
use super::histogram::Histogram;
use super::text::short;

/// Measures of which the median and the worst are told.
const TOLD: [(&str, &str); 13] = [
    ("conformal_p95", "conformal, 95 % of the area"),
    ("conformal_worst", "conformal, worst face"),
    ("isometric_p95", "isometric, 95 % of the area"),
    ("isometric_worst", "isometric, worst face"),
    (
        "steiner_per_boundary_point",
        "Steiner points per boundary point",
    ),
    ("faces_below_5_deg_share", "share of faces below 5\u{b0}"),
    ("boundary_stretch_worst", "stretch of the boundary, worst"),
    ("conformal_excess", "conformal, worse on the way"),
    ("asymmetry_diameters", "asymmetry, diameters"),
    ("area_variation_excess_share", "area up and down, share"),
    (
        "perimeter_variation_excess_share",
        "perimeter up and down, share",
    ),
    (
        "match_and_triangulate_s",
        "match and triangulation, seconds",
    ),
    ("build_s", "build in all, seconds"),
];

/// Measures whose spread is drawn, where there are enough values for it.
const DRAWN: [&str; 3] = [
    "conformal_p95",
    "conformal_worst",
    "match_and_triangulate_s",
];
const ENOUGH: usize = 10;

/// The whole table in short.
#[derive(Debug, Serialize)]
pub(super) struct Summary {
    /// Rows, each direction of its own.
    pub pairs: usize,
    /// Of them those that could not be built.
    pub failures: usize,
    /// Of them those with a fold at some t.
    pub with_folds: usize,
    /// Of them those whose boundary crosses itself at some t.
    pub with_crossings: usize,
    /// Of them those with more pieces or holes on the way than at the ends.
    pub with_tears: usize,
    /// Medians and worst values of the main measures.
    pub measures: Vec<Told>,
}

#[derive(Debug, Serialize)]
pub(super) struct Told {
    pub column: &'static str,
    #[serde(skip)]
    words: &'static str,
    pub median: f64,
    pub worst: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub spread: Option<Histogram>,
}

impl Summary {
    /// Of the measures of each pair; `None` for those that failed.
    pub fn of(rows: &[Option<&[Option<Value>]>]) -> Self {
        let done: Vec<&[Option<Value>]> = rows.iter().copied().flatten().collect();
        let with = |column: &str| numbers(&done, column).filter(|n| *n > 0.0).count();
        let tears = |row: &&&[Option<Value>]| {
            let one = std::slice::from_ref(*row);
            let columns = ["pieces_excess", "holes_excess"];
            columns.iter().any(|c| numbers(one, c).any(|n| n > 0.0))
        };
        Self {
            pairs: rows.len(),
            failures: rows.len() - done.len(),
            with_folds: with("folds_worst"),
            with_crossings: with("crossings_worst"),
            with_tears: done.iter().filter(tears).count(),
            measures: TOLD
                .iter()
                .filter_map(|told| of_column(&done, told))
                .collect(),
        }
    }

    /// In aligned lines.
    pub fn text(&self) -> String {
        const WIDTH: usize = 36;
        let mut text = String::new();
        let of = |n: usize| format!("{n} of {}", self.pairs - self.failures);
        for (name, value) in [
            ("pairs", self.pairs.to_string()),
            ("failures", self.failures.to_string()),
            ("with a fold at some t", of(self.with_folds)),
            ("with a boundary crossing", of(self.with_crossings)),
            ("with pieces or holes of their own", of(self.with_tears)),
        ] {
            writeln!(text, "{name:<WIDTH$}{value:>12}").unwrap_or_default();
        }
        if !self.measures.is_empty() {
            writeln!(text, "\n{:<WIDTH$}{:>12}{:>12}", "", "median", "worst").unwrap_or_default();
        }
        for told in &self.measures {
            let (median, worst) = (short(told.median), short(told.worst));
            writeln!(text, "{:<WIDTH$}{median:>12}{worst:>12}", told.words).unwrap_or_default();
        }
        for told in &self.measures {
            if let Some(spread) = &told.spread {
                write!(text, "\n{}\n{}", told.words, spread.text()).unwrap_or_default();
            }
        }
        text
    }
}

/// The numbers of a column, where there are any.
fn numbers<'a>(rows: &'a [&[Option<Value>]], column: &str) -> impl Iterator<Item = f64> + 'a {
    let index = columns::names().position(|name| name == column);
    rows.iter().filter_map(move |row| match row.get(index?)? {
        Some(Value::Number(x)) => Some(*x),
        _ => None,
    })
}

fn of_column(rows: &[&[Option<Value>]], told: &(&'static str, &'static str)) -> Option<Told> {
    let (column, words) = *told;
    let mut all: Vec<f64> = numbers(rows, column).collect();
    all.sort_unstable_by(f64::total_cmp);
    let middle = all.len() / 2;
    let upper = *all.get(middle)?;
    let lower = all[(all.len() - 1) / 2];
    Some(Told {
        column,
        words,
        median: 0.5 * (lower + upper),
        worst: *all.last()?,
        spread: (DRAWN.contains(&column) && all.len() >= ENOUGH)
            .then(|| Histogram::of(&all))
            .flatten(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(column: &str, value: f64) -> Vec<Option<Value>> {
        let cell = |name| (name == column).then_some(Value::Number(value));
        columns::names().map(cell).collect()
    }

    #[test]
    fn every_told_column_exists() {
        for (column, _) in TOLD {
            assert!(columns::is_own(column), "{column}");
        }
    }

    #[test]
    fn failures_count_and_do_not_enter_medians() {
        let [a, b, c] = [1.0, 3.0, 2.0].map(|x| row("conformal_p95", x));
        let fold = row("folds_worst", 4.0);
        let summary = Summary::of(&[Some(&a), None, Some(&b), Some(&c), Some(&fold)]);
        assert_eq!((summary.pairs, summary.failures), (5, 1));
        assert_eq!((summary.with_folds, summary.with_crossings), (1, 0));
        let told = &summary.measures[0];
        assert_eq!((told.median, told.worst), (2.0, 3.0));
        assert_eq!(summary.measures.len(), 1);
        assert!(
            summary
                .text()
                .contains("failures                                       1")
        );
    }
}
