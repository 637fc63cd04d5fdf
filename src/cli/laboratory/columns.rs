//! The report on a transition as a row of a table: every column once, with its
//! unit, how it is read, and whether the summary tells of it.
//!
//! After a table's own columns come `direction`, `status` and these. Units
//! stand in the headings: lengths called `share` are fractions, those called
//! `diameters` fractions of the larger design's diameter.

use super::report::{FindingReport, PairReport};
use crate::measure::{Distribution, FilmReport, MeshReport, MotionReport};
use crate::transition::TransitionMethod;

/// Which way the pair was taken: `forward`, `backward`.
pub(super) const DIRECTION: &str = "direction";

/// `ok`, or what went wrong.
pub(super) const STATUS: &str = "status";

/// One measure of a report.
pub(super) struct ReportColumn {
    name: &'static str,
    unit: ColumnUnit,
    read: ColumnReader,
    /// What the summary calls it and which of its values are the good ones, if
    /// it tells of them.
    pub told: Option<(&'static str, BetterDirection)>,
    /// Whether the summary draws its values as bars.
    pub is_drawn: bool,
}

/// Which values are the good ones.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum BetterDirection {
    Small,
    Large,
}

#[derive(Clone, Copy)]
enum ColumnUnit {
    Pure,
    Share,
    Degrees,
    Diameters,
    Cells,
    Seconds,
}

impl ColumnUnit {
    /// At the end of a heading, and of words.
    const fn suffixes(self) -> [&'static str; 2] {
        match self {
            Self::Pure => ["", ""],
            Self::Share => ["_share", ", share"],
            Self::Degrees => ["_deg", ", degrees"],
            Self::Diameters => ["_diameters", ", diameters"],
            Self::Cells => ["_cells", ", cells"],
            Self::Seconds => ["_s", ", seconds"],
        }
    }
}

/// How a report is read.
#[derive(Clone, Copy)]
enum ColumnReader {
    Number(fn(&PairReport) -> Option<f64>),
    Words(fn(&PairReport) -> Option<&str>),
}

impl ReportColumn {
    /// What it is called in the table.
    pub fn heading(&self) -> String {
        format!("{}{}", self.name, self.unit.suffixes()[0])
    }

    /// What it is called in the summary, if that tells of it.
    pub fn words(&self) -> Option<String> {
        let (words, _) = self.told?;
        Some(format!("{words}{}", self.unit.suffixes()[1]))
    }

    /// Its number in a report, where it is one and there is one.
    pub fn number(&self, report: &PairReport) -> Option<f64> {
        match self.read {
            ColumnReader::Number(of) => of(report),
            ColumnReader::Words(_) => None,
        }
    }

    /// Its cell: of a number as many digits as it takes to read it back.
    pub fn cell(&self, report: &PairReport) -> String {
        // Without a number the cell is empty: 0 would be a measurement.
        let text = match self.read {
            ColumnReader::Number(of) => of(report).map(|x| x.to_string()),
            ColumnReader::Words(of) => of(report).map(str::to_owned),
        };
        text.unwrap_or_default()
    }

    const fn told(self, words: &'static str, better: BetterDirection) -> Self {
        Self {
            told: Some((words, better)),
            ..self
        }
    }

    const fn drawn(self, words: &'static str) -> Self {
        Self {
            is_drawn: true,
            ..self.told(words, BetterDirection::Small)
        }
    }
}

/// Whether a heading is one of the report's own.
pub(super) fn is_own(heading: &str) -> bool {
    heading == DIRECTION || heading == STATUS || ALL.iter().any(|own| own.heading() == heading)
}

const fn column(name: &'static str, unit: ColumnUnit, read: ColumnReader) -> ReportColumn {
    ReportColumn {
        name,
        unit,
        read,
        told: None,
        is_drawn: false,
    }
}

const fn number(
    name: &'static str,
    unit: ColumnUnit,
    of: fn(&PairReport) -> Option<f64>,
) -> ReportColumn {
    column(name, unit, ColumnReader::Number(of))
}

const fn words(name: &'static str, of: fn(&PairReport) -> Option<&str>) -> ReportColumn {
    column(name, Pure, ColumnReader::Words(of))
}

fn finding(report: &PairReport) -> Option<&FindingReport> {
    report.verdict.findings.first()
}

fn count(n: usize) -> Option<f64> {
    Some(n as f64)
}

fn mesh(report: &PairReport, of: fn(&MeshReport) -> f64) -> Option<f64> {
    report.mesh.as_ref().map(of)
}

fn film(report: &PairReport, of: fn(&FilmReport) -> Option<usize>) -> Option<f64> {
    count(of(&report.film)?)
}

fn motion(report: &PairReport, of: fn(&MotionReport) -> f64) -> Option<f64> {
    report.film.motion.as_ref().map(of)
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

/// All of them, in the order of the table.
pub(super) const ALL: [ReportColumn; 61] = [
    words("method", |r| {
        Some(
            TransitionMethod::new(r.warp, r.content)
                .ok()?
                .labels()
                .report,
        )
    }),
    words("verdict", |r| Some(&r.verdict.words)),
    number("verdict_t", Pure, |r| Some(finding(r)?.finding.t)),
    words("verdict_cause", |r| Some(&finding(r)?.cause_words)),
    words("verdict_remedy", |r| Some(&finding(r)?.remedy_words)),
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
    .told("Steiner points per boundary point", Small),
    number("min_angle_source", Degrees, |r| {
        mesh(r, |m| m.min_angle_source_deg)
    })
    .told("least angle in the source", Large),
    number("min_angle_target", Degrees, |r| {
        mesh(r, |m| m.min_angle_target_deg)
    })
    .told("least angle in the target", Large),
    number("faces_below_5_deg", Share, |r| mesh(r, |m| m.thin_faces))
        .told("faces below 5\u{b0}", Small),
    number("folds_at_end", Pure, |r| {
        mesh(r, |m| m.distortion.folds as f64)
    }),
    number("conformal_median", Pure, |r| Some(conformal(r)?.median)),
    number("conformal_p95", Pure, |r| Some(conformal(r)?.p95)).drawn("conformal, 95 % of the area"),
    number("conformal_worst", Pure, |r| Some(conformal(r)?.worst)).drawn("conformal, worst face"),
    number("isometric_median", Pure, |r| Some(isometric(r)?.median)),
    number("isometric_p95", Pure, |r| Some(isometric(r)?.p95))
        .told("isometric, 95 % of the area", Small),
    number("isometric_worst", Pure, |r| Some(isometric(r)?.worst))
        .told("isometric, worst face", Small),
    number("area_median", Pure, |r| Some(area(r)?.median)),
    number("area_p95", Pure, |r| Some(area(r)?.p95)),
    number("area_worst", Pure, |r| Some(area(r)?.worst)),
    number("boundary_stretch_p95", Pure, |r| {
        mesh(r, |m| m.boundary_stretch.p95)
    }),
    number("boundary_stretch_worst", Pure, |r| {
        mesh(r, |m| m.boundary_stretch.worst)
    })
    .told("stretch of the boundary, worst", Small),
    number("folds_worst", Pure, |r| film(r, |f| f.worst_folds)),
    number("first_fold_t", Pure, |r| r.film.first_fold_t),
    number("min_det", Pure, |r| r.film.min_det),
    number("crossings_worst", Pure, |r| film(r, |f| f.worst_crossings)),
    number("first_crossing_t", Pure, |r| r.film.first_crossing_t),
    number("conformal_excess", Pure, |r| r.film.conformal_excess)
        .told("conformal, worse on the way", Small),
    number("isometric_excess", Pure, |r| r.film.isometric_excess),
    number("area_distortion_excess", Pure, |r| {
        r.film.area_distortion_excess
    }),
    number("asymmetry", Diameters, |r| r.film.asymmetry).told("asymmetry", Small),
    number("area_variation_excess", Share, |r| {
        Some(r.film.area_variation_excess)
    })
    .told("area up and down", Small),
    number("perimeter_variation_excess", Share, |r| {
        Some(r.film.perimeter_variation_excess)
    })
    .told("perimeter up and down", Small),
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
    .drawn("match and triangulation"),
    number("build", Seconds, |r| Some(r.seconds.build)).told("build in all", Small),
    number("frame", Seconds, |r| Some(r.seconds.frame)),
    number("figure", Seconds, |r| Some(r.seconds.figure)),
    number("measure", Seconds, |r| Some(r.seconds.measure)),
    number("turning_excess", Share, |r| Some(r.film.turning_excess)).drawn("turning"),
    words("proof", |r| Some(&r.proof.as_ref()?.words)),
    number("unproved_t", Pure, |r| r.proof.as_ref()?.first_t()),
    number("prove", Seconds, |r| Some(r.proof.as_ref()?.seconds)),
    number("moved_aside", Diameters, |r| {
        r.proof.as_ref()?.proved.as_ref()?.moved_aside
    }),
    number("conformal_by_end", Pure, |r| r.film.conformal_by_end)
        .told("conformal, worst on the way by worst end", Small),
    number("conformal_p95_by_end", Pure, |r| {
        r.film.conformal_p95_by_end
    }),
    number("turning_of_both_excess", Share, |r| {
        Some(r.film.turning_of_both_excess)
    })
    .told("turning of parts that both have", Small),
];

#[cfg(test)]
mod tests {
    use super::*;

    /// Programs read these: new ones go to the end.
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
    fn headings_are_what_they_were() {
        let found: Vec<_> = ALL.iter().map(ReportColumn::heading).collect();
        assert_eq!(found.join(" "), HEADINGS);
        assert!(found.iter().all(|heading| is_own(heading)));
        assert!(is_own(DIRECTION) && is_own(STATUS));
        assert!(!is_own("source") && !is_own("kind"));
    }

    #[test]
    fn words_say_the_unit() {
        let words: Vec<_> = ALL.iter().filter_map(ReportColumn::words).collect();
        assert!(words.contains(&"build in all, seconds".to_owned()));
        assert_eq!(words.len(), 18);
    }
}
