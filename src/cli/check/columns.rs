//! The columns of the report on a table of pairs.
//!
//! After the table's own columns come `direction`, `status` and these; units
//! stand in the names. Lengths called `share` are fractions, those called
//! `diameters` fractions of the larger design's diameter.

use super::report::{FindingReport, Report};
use crate::measure::{Distribution, FilmReport, MeshReport, Motion};
use crate::transition::Cell;

/// What stands in a cell.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Value {
    Number(f64),
    Words(String),
}

impl Value {
    /// As many digits as it takes to read the number back.
    pub fn text(&self) -> String {
        match self {
            Self::Number(x) => x.to_string(),
            Self::Words(words) => words.clone(),
        }
    }
}

type Column = (&'static str, fn(&Report) -> Option<Value>);

/// Which way the pair was taken: `forward`, `backward`.
pub(super) const DIRECTION: &str = "direction";

/// `ok`, or what went wrong.
pub(super) const STATUS: &str = "status";

/// Whether a name is one of the report's own.
pub(super) fn is_own(name: &str) -> bool {
    name == DIRECTION || name == STATUS || ALL.iter().any(|(own, _)| *own == name)
}

/// The names of the measures, in order.
pub(super) fn names() -> impl Iterator<Item = &'static str> {
    ALL.iter().map(|(name, _)| *name)
}

/// The measures of a report, in the same order.
pub(super) fn values(report: &Report) -> Vec<Option<Value>> {
    ALL.iter().map(|(_, of)| of(report)).collect()
}

fn number(x: f64) -> Option<Value> {
    Some(Value::Number(x))
}

fn count(n: usize) -> Option<Value> {
    number(n as f64)
}

fn words(text: &str) -> Option<Value> {
    Some(Value::Words(text.to_owned()))
}

fn finding(report: &Report) -> Option<&FindingReport> {
    report.verdict.findings.first()
}

fn mesh(report: &Report, of: fn(&MeshReport) -> f64) -> Option<Value> {
    number(of(report.mesh.as_ref()?))
}

fn at_end(
    report: &Report,
    of: fn(&MeshReport) -> Distribution,
    q: fn(&Distribution) -> f64,
) -> Option<Value> {
    number(q(&of(report.mesh.as_ref()?)))
}

fn film(report: &Report, of: fn(&FilmReport) -> Option<f64>) -> Option<Value> {
    number(of(&report.film)?)
}

fn counted(report: &Report, of: fn(&FilmReport) -> Option<usize>) -> Option<Value> {
    count(of(&report.film)?)
}

fn motion(report: &Report, of: fn(&Motion) -> f64) -> Option<Value> {
    number(of(report.film.motion.as_ref()?))
}

const MEDIAN: fn(&Distribution) -> f64 = |d| d.median;
const P95: fn(&Distribution) -> f64 = |d| d.p95;
const WORST: fn(&Distribution) -> f64 = |d| d.worst;

const ALL: [Column; 53] = [
    ("method", |r| {
        words(Cell::new(r.warp, r.content).ok()?.words().report)
    }),
    ("verdict", |r| words(&r.verdict.words)),
    ("verdict_t", |r| number(finding(r)?.finding.t)),
    ("verdict_cause", |r| words(&finding(r)?.cause_words)),
    ("verdict_remedy", |r| words(&finding(r)?.remedy_words)),
    ("samples", |r| count(r.film.samples.len())),
    ("source_points", |r| count(r.designs.first()?.points)),
    ("target_points", |r| count(r.designs.get(1)?.points)),
    ("vertices", |r| count(r.vertices?)),
    ("faces", |r| count(r.faces?)),
    ("boundary_vertices", |r| {
        mesh(r, |m| m.boundary_vertices as f64)
    }),
    ("steiner_per_boundary_point", |r| {
        mesh(r, |m| m.steiner_per_boundary_point)
    }),
    ("min_angle_source_deg", |r| {
        mesh(r, |m| m.min_angle_source_deg)
    }),
    ("min_angle_target_deg", |r| {
        mesh(r, |m| m.min_angle_target_deg)
    }),
    ("faces_below_5_deg_share", |r| mesh(r, |m| m.thin_faces)),
    ("folds_at_end", |r| mesh(r, |m| m.distortion.folds as f64)),
    ("conformal_median", |r| {
        at_end(r, |m| m.distortion.conformal, MEDIAN)
    }),
    ("conformal_p95", |r| {
        at_end(r, |m| m.distortion.conformal, P95)
    }),
    ("conformal_worst", |r| {
        at_end(r, |m| m.distortion.conformal, WORST)
    }),
    ("isometric_median", |r| {
        at_end(r, |m| m.distortion.isometric, MEDIAN)
    }),
    ("isometric_p95", |r| {
        at_end(r, |m| m.distortion.isometric, P95)
    }),
    ("isometric_worst", |r| {
        at_end(r, |m| m.distortion.isometric, WORST)
    }),
    ("area_median", |r| at_end(r, |m| m.distortion.area, MEDIAN)),
    ("area_p95", |r| at_end(r, |m| m.distortion.area, P95)),
    ("area_worst", |r| at_end(r, |m| m.distortion.area, WORST)),
    ("boundary_stretch_p95", |r| {
        at_end(r, |m| m.boundary_stretch, P95)
    }),
    ("boundary_stretch_worst", |r| {
        at_end(r, |m| m.boundary_stretch, WORST)
    }),
    ("folds_worst", |r| counted(r, |f| f.worst_folds)),
    ("first_fold_t", |r| film(r, |f| f.first_fold_t)),
    ("min_det", |r| film(r, |f| f.min_det)),
    ("crossings_worst", |r| counted(r, |f| f.worst_crossings)),
    ("first_crossing_t", |r| film(r, |f| f.first_crossing_t)),
    ("conformal_excess", |r| film(r, |f| f.conformal_excess)),
    ("isometric_excess", |r| film(r, |f| f.isometric_excess)),
    ("area_distortion_excess", |r| {
        film(r, |f| f.area_distortion_excess)
    }),
    ("asymmetry_diameters", |r| film(r, |f| f.asymmetry)),
    ("area_variation_excess_share", |r| {
        number(r.film.area_variation_excess)
    }),
    ("perimeter_variation_excess_share", |r| {
        number(r.film.perimeter_variation_excess)
    }),
    ("pieces_excess", |r| counted(r, |f| f.pieces_excess)),
    ("holes_excess", |r| counted(r, |f| f.holes_excess)),
    ("mean_travel_diameters", |r| motion(r, |m| m.mean_travel)),
    ("max_travel_diameters", |r| motion(r, |m| m.max_travel)),
    ("max_acceleration_diameters", |r| {
        motion(r, |m| m.max_acceleration)
    }),
    ("grid_width_cells", |r| number(r.grid?[0].into())),
    ("grid_height_cells", |r| number(r.grid?[1].into())),
    ("import_s", |r| number(r.seconds.import)),
    ("match_s", |r| number(r.seconds.matching)),
    ("triangulate_s", |r| number(r.seconds.triangulate)),
    ("match_and_triangulate_s", |r| {
        number(r.seconds.matching + r.seconds.triangulate)
    }),
    ("build_s", |r| number(r.seconds.build)),
    ("frame_s", |r| number(r.seconds.frame)),
    ("figure_s", |r| number(r.seconds.figure)),
    ("measure_s", |r| number(r.seconds.measure)),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_different_and_own() {
        let mut all: Vec<_> = names().collect();
        all.extend([DIRECTION, STATUS]);
        assert!(all.iter().all(|name| is_own(name)));
        all.sort_unstable();
        all.dedup();
        assert_eq!(all.len(), ALL.len() + 2);
        assert!(!is_own("source") && !is_own("kind"));
    }

    #[test]
    fn numbers_are_read_back() {
        for x in [0.1 + 0.2, 1e-300, 7.0, f64::INFINITY] {
            assert_eq!(Value::Number(x).text().parse(), Ok(x));
        }
    }
}
