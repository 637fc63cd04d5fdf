//! Columns of the report of `check --pairs`: for each column its heading, its unit, how to read it
//! from a [`PairReport`], and its label in the summary.
//!
//! The report starts with the columns of the input table; `direction`, `status` and the columns of
//! [`ALL`] follow. A heading ends with the unit, if there is one: `_share` is a fraction, `_deg`
//! degrees, `_diameters` a fraction of the larger design's diameter, `_cells` grid cells, `_s`
//! seconds.

use super::report::{FindingReport, PairReport};
use crate::measure::{Distribution, FilmReport, MeshReport, MotionReport};
use crate::transition::TransitionMethod;

/// Heading of the column with the direction of the film: `forward` from source to target, or
/// `backward`.
pub(super) const DIRECTION: &str = "direction";

/// Heading of the column that says `ok`, or why the pair failed.
pub(super) const STATUS: &str = "status";

/// Column of the report: one measure of a pair.
pub(super) struct ReportColumn {
    /// Heading without the unit.
    name: &'static str,
    unit: ColumnUnit,
    reader: ColumnReader,
    /// Label of the measure in the summary, without the unit, and which values are better; `None`
    /// if the summary omits the measure.
    pub in_summary: Option<(&'static str, BetterDirection)>,
    /// Whether the summary shows a histogram of the values.
    pub is_drawn: bool,
}

/// Whether small or large values of a measure are better.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum BetterDirection {
    Small,
    Large,
}

/// Unit of a measure.
#[derive(Clone, Copy)]
enum ColumnUnit {
    /// No unit: a count, a ratio, or text.
    Pure,
    /// Fraction of 1.
    Share,
    Degrees,
    /// Diameter of the larger design.
    Diameters,
    /// Cells of the grid of distance fields.
    Cells,
    Seconds,
}

impl ColumnUnit {
    /// Returns the two endings that name the unit: that of the heading, and that of the label in
    /// the summary.
    const fn suffixes(self) -> [&'static str; 2] {
        match self {
            Self::Pure => ["", ""],
            Self::Share => ["_share", ", fraction"],
            Self::Degrees => ["_deg", ", degrees"],
            Self::Diameters => ["_diameters", ", diameters"],
            Self::Cells => ["_cells", ", cells"],
            Self::Seconds => ["_s", ", seconds"],
        }
    }
}

/// Function that reads the value of a column from the report on a pair. It returns `None` if the
/// pair has no such value, for example the number of faces of a blend of fields.
#[derive(Clone, Copy)]
enum ColumnReader {
    Number(fn(&PairReport) -> Option<f64>),
    Text(fn(&PairReport) -> Option<&str>),
}

impl ReportColumn {
    /// Returns the heading of the column, with its unit.
    pub fn heading(&self) -> String {
        format!("{}{}", self.name, self.unit.suffixes()[0])
    }

    /// Returns the label in the summary, with its unit; `None` if the summary omits the measure.
    pub fn label(&self) -> Option<String> {
        let (label, _) = self.in_summary?;
        Some(format!("{label}{}", self.unit.suffixes()[1]))
    }

    /// Returns the value in a report as a number; `None` if it is text or missing.
    pub fn number(&self, report: &PairReport) -> Option<f64> {
        match self.reader {
            ColumnReader::Number(read) => read(report),
            ColumnReader::Text(_) => None,
        }
    }

    /// Returns the text of the column's cell for a pair. A number has as many digits as are needed
    /// to read it back exactly.
    pub fn cell(&self, report: &PairReport) -> String {
        // A missing value is an empty cell, because 0 would look like a measurement.
        let text = match self.reader {
            ColumnReader::Number(read) => read(report).map(|x| x.to_string()),
            ColumnReader::Text(read) => read(report).map(str::to_owned),
        };
        text.unwrap_or_default()
    }

    /// Adds the column to the summary.
    const fn summarised(self, label: &'static str, better: BetterDirection) -> Self {
        Self {
            in_summary: Some((label, better)),
            ..self
        }
    }

    /// Adds the column to the summary, with a histogram of its values. The measure must be one of
    /// which smaller values are better than larger ones; the summary reports its largest value as
    /// the worst.
    const fn with_histogram(self, label: &'static str) -> Self {
        Self {
            is_drawn: true,
            ..self.summarised(label, BetterDirection::Small)
        }
    }
}

/// Returns whether a heading belongs to the report, so that the input table must not use it.
pub(super) fn is_own(heading: &str) -> bool {
    heading == DIRECTION
        || heading == STATUS
        || ALL.iter().any(|column| column.heading() == heading)
}

const fn column(name: &'static str, unit: ColumnUnit, reader: ColumnReader) -> ReportColumn {
    ReportColumn {
        name,
        unit,
        reader,
        in_summary: None,
        is_drawn: false,
    }
}

const fn number(
    name: &'static str,
    unit: ColumnUnit,
    read: fn(&PairReport) -> Option<f64>,
) -> ReportColumn {
    column(name, unit, ColumnReader::Number(read))
}

const fn text(name: &'static str, read: fn(&PairReport) -> Option<&str>) -> ReportColumn {
    column(name, Pure, ColumnReader::Text(read))
}

/// Returns the first defect of the pair, if there is one.
fn finding(report: &PairReport) -> Option<&FindingReport> {
    report.verdict.findings.first()
}

fn count(n: usize) -> Option<f64> {
    Some(n as f64)
}

fn mesh(report: &PairReport, read: fn(&MeshReport) -> f64) -> Option<f64> {
    report.mesh.as_ref().map(read)
}

fn film(report: &PairReport, read: fn(&FilmReport) -> Option<usize>) -> Option<f64> {
    count(read(&report.film)?)
}

fn motion(report: &PairReport, read: fn(&MotionReport) -> f64) -> Option<f64> {
    report.film.motion.as_ref().map(read)
}

fn conformal(report: &PairReport) -> Option<&Distribution> {
    Some(&report.mesh.as_ref()?.distortion.conformal)
}

fn isometric(report: &PairReport) -> Option<&Distribution> {
    Some(&report.mesh.as_ref()?.distortion.isometric)
}

fn area(report: &PairReport) -> Option<&Distribution> {
    Some(&report.mesh.as_ref()?.distortion.area)
}

use BetterDirection::{Large, Small};
use ColumnUnit::{Cells, Degrees, Diameters, Pure, Seconds, Share};

/// All measures, in the order of the report's columns.
pub(super) const ALL: [ReportColumn; 61] = [
    text("method", |r| {
        Some(
            TransitionMethod::new(r.warp, r.content)
                .ok()?
                .labels()
                .report,
        )
    }),
    text("verdict", |r| Some(&r.verdict.words)),
    number("verdict_t", Pure, |r| Some(finding(r)?.finding.t)),
    text("verdict_cause", |r| Some(&finding(r)?.cause_words)),
    text("verdict_remedy", |r| Some(&finding(r)?.remedy_words)),
    number("samples", Pure, |r| count(r.samples)),
    number("source_points", Pure, |r| count(r.designs.first()?.points)),
    number("target_points", Pure, |r| count(r.designs.get(1)?.points)),
    number("vertices", Pure, |r| count(r.vertices?)),
    number("faces", Pure, |r| count(r.faces?)),
    number("boundary_vertices", Pure, |r| {
        mesh(r, |m| m.boundary_vertices as f64)
    }),
    number("steiner_per_boundary_point", Pure, |r| {
        mesh(r, |m| m.steiner_per_boundary_point)
    })
    .summarised("Steiner points per boundary point", Small),
    number("min_angle_source", Degrees, |r| {
        mesh(r, |m| m.min_angle_source_deg)
    })
    .summarised("minimum angle in the source", Large),
    number("min_angle_target", Degrees, |r| {
        mesh(r, |m| m.min_angle_target_deg)
    })
    .summarised("minimum angle in the target", Large),
    number("faces_below_5_deg", Share, |r| mesh(r, |m| m.thin_faces))
        .summarised("faces with an angle below 5\u{b0}", Small),
    number("folds_at_end", Pure, |r| {
        mesh(r, |m| m.distortion.folds as f64)
    }),
    number("conformal_median", Pure, |r| Some(conformal(r)?.median)),
    number("conformal_p95", Pure, |r| Some(conformal(r)?.p95))
        .with_histogram("conformal, 95 % of the area"),
    number("conformal_worst", Pure, |r| Some(conformal(r)?.worst))
        .with_histogram("conformal, worst face"),
    number("isometric_median", Pure, |r| Some(isometric(r)?.median)),
    number("isometric_p95", Pure, |r| Some(isometric(r)?.p95))
        .summarised("isometric, 95 % of the area", Small),
    number("isometric_worst", Pure, |r| Some(isometric(r)?.worst))
        .summarised("isometric, worst face", Small),
    number("area_median", Pure, |r| Some(area(r)?.median)),
    number("area_p95", Pure, |r| Some(area(r)?.p95)),
    number("area_worst", Pure, |r| Some(area(r)?.worst)),
    number("boundary_stretch_p95", Pure, |r| {
        mesh(r, |m| m.boundary_stretch.p95)
    }),
    number("boundary_stretch_worst", Pure, |r| {
        mesh(r, |m| m.boundary_stretch.worst)
    })
    .summarised("boundary stretch, worst", Small),
    number("folds_worst", Pure, |r| film(r, |f| f.worst_folds)),
    number("first_fold_t", Pure, |r| r.film.first_fold_t),
    number("min_det", Pure, |r| r.film.min_det),
    number("crossings_worst", Pure, |r| film(r, |f| f.worst_crossings)),
    number("first_crossing_t", Pure, |r| r.film.first_crossing_t),
    number("conformal_excess", Pure, |r| r.film.conformal_excess)
        .summarised("conformal overshoot, worst face", Small),
    number("isometric_excess", Pure, |r| r.film.isometric_excess),
    number("area_distortion_excess", Pure, |r| {
        r.film.area_distortion_excess
    }),
    number("asymmetry", Diameters, |r| r.film.asymmetry).summarised("asymmetry", Small),
    number("area_variation_excess", Share, |r| {
        Some(r.film.area_variation_excess)
    })
    .summarised("area overshoot", Small),
    number("perimeter_variation_excess", Share, |r| {
        Some(r.film.perimeter_variation_excess)
    })
    .summarised("perimeter overshoot", Small),
    number("pieces_excess", Pure, |r| film(r, |f| f.pieces_excess)),
    number("holes_excess", Pure, |r| film(r, |f| f.holes_excess)),
    number("mean_travel", Diameters, |r| motion(r, |m| m.mean_travel)),
    number("max_travel", Diameters, |r| motion(r, |m| m.max_travel)),
    number("max_acceleration", Diameters, |r| {
        motion(r, |m| m.max_acceleration)
    }),
    number("grid_width", Cells, |r| Some(r.grid?[0].into())),
    number("grid_height", Cells, |r| Some(r.grid?[1].into())),
    number("import", Seconds, |r| Some(r.seconds.import)),
    number("match", Seconds, |r| Some(r.seconds.matching)),
    number("triangulate", Seconds, |r| Some(r.seconds.triangulate)),
    number("match_and_triangulate", Seconds, |r| {
        Some(r.seconds.matching + r.seconds.triangulate)
    })
    .with_histogram("match and triangulation"),
    number("build", Seconds, |r| Some(r.seconds.build)).summarised("total build time", Small),
    number("frame", Seconds, |r| Some(r.seconds.frame)),
    number("figure", Seconds, |r| Some(r.seconds.figure)),
    number("measure", Seconds, |r| Some(r.seconds.measure)),
    number("turning_excess", Share, |r| Some(r.film.turning_excess))
        .with_histogram("turning overshoot"),
    text("proof", |r| Some(&r.proof.as_ref()?.words)),
    number("unproved_t", Pure, |r| r.proof.as_ref()?.first_t()),
    number("prove", Seconds, |r| Some(r.proof.as_ref()?.seconds)),
    number("moved_aside", Diameters, |r| {
        r.proof.as_ref()?.proved.as_ref()?.moved_aside
    }),
    number("conformal_by_end", Pure, |r| r.film.conformal_by_end)
        .summarised("conformal, peak over the worse end", Small),
    number("conformal_p95_by_end", Pure, |r| {
        r.film.conformal_p95_by_end
    }),
    number("turning_of_both_excess", Share, |r| {
        Some(r.film.turning_of_both_excess)
    })
    .summarised("turning overshoot of shared parts", Small),
];

#[cfg(test)]
mod tests {
    use super::*;

    /// Headings of all columns. Scripts read them, so new columns are added at the end.
    const HEADINGS: &str = "method verdict verdict_t verdict_cause verdict_remedy samples \
        source_points target_points vertices faces boundary_vertices steiner_per_boundary_point \
        min_angle_source_deg min_angle_target_deg faces_below_5_deg_share folds_at_end \
        conformal_median conformal_p95 conformal_worst isometric_median isometric_p95 \
        isometric_worst area_median area_p95 area_worst boundary_stretch_p95 \
        boundary_stretch_worst folds_worst first_fold_t min_det crossings_worst \
        first_crossing_t conformal_excess isometric_excess area_distortion_excess \
        asymmetry_diameters area_variation_excess_share perimeter_variation_excess_share \
        pieces_excess holes_excess mean_travel_diameters max_travel_diameters \
        max_acceleration_diameters grid_width_cells grid_height_cells import_s match_s \
        triangulate_s match_and_triangulate_s build_s frame_s figure_s measure_s \
        turning_excess_share proof unproved_t prove_s moved_aside_diameters \
        conformal_by_end conformal_p95_by_end turning_of_both_excess_share";

    #[test]
    fn headings_are_unchanged() {
        let headings: Vec<_> = ALL.iter().map(ReportColumn::heading).collect();
        assert_eq!(headings.join(" "), HEADINGS);
        assert!(headings.iter().all(|heading| is_own(heading)));
        assert!(is_own(DIRECTION) && is_own(STATUS));
        assert!(!is_own("source") && !is_own("kind"));
    }

    #[test]
    fn labels_of_the_summary_name_the_unit() {
        let labels: Vec<_> = ALL.iter().filter_map(ReportColumn::label).collect();
        assert!(labels.contains(&"total build time, seconds".to_owned()));
        assert_eq!(labels.len(), 18);
    }
}
