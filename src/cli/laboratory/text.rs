//! Formats the report on one transition as text for people, in aligned lines.
//!
//! The text is a selection; the JSON contains all measures.

use super::number::{NumberLines, percent, short};
use super::report::{DesignReport, PairReport};
use crate::content::ContentKind;
use crate::measure::{Distribution, FilmSample, MeshReport, MotionReport, Quantity};
use crate::settings::Choice;

/// Width of the names on the left, in characters; the longest name has 9 (heuristic).
const NAME_WIDTH: usize = 12;

/// Maximum number of samples that are listed, including the first and the last (heuristic).
const MAX_ROWS: usize = 9;

/// Columns of the list of samples: the heading and the measure.
const SAMPLE_COLUMNS: [(&str, Quantity); 8] = [
    ("area", Quantity::Area),
    ("perimeter", Quantity::Perimeter),
    ("pieces", Quantity::Pieces),
    ("holes", Quantity::Holes),
    ("crossings", Quantity::Crossings),
    ("folds", Quantity::Folds),
    ("conformal", Quantity::WorstConformal),
    ("min det", Quantity::MinDet),
];

/// Returns the report as text.
pub(in crate::cli) fn text(report: &PairReport) -> String {
    let mut lines = NumberLines::default();
    lines.line(&report.title);
    lines.gap();
    method(report, &mut lines);
    check(report, &mut lines);
    if let Some(mesh) = &report.mesh {
        distortion(report, mesh, &mut lines);
    }
    film(report, &mut lines);
    lines.gap();
    samples(&report.film.samples, &mut lines);
    lines.gap();
    times(report, &mut lines);
    lines.0
}

impl NumberLines {
    /// Adds a line with a name on the left.
    fn row(&mut self, name: &str, text: &str) {
        self.line(&format!("{name:<NAME_WIDTH$} {text}"));
    }
}

/// Adds the method, the designs with their import notes, and the mesh to the text.
fn method(report: &PairReport, lines: &mut NumberLines) {
    let content = match report.content {
        ContentKind::Solid => "",
        ContentKind::Field => "distance fields",
        ContentKind::Colours => "colours",
    };
    let warp = (report.warp.labels().name, report.warp.name().key);
    // Solid content is the usual case and is not named.
    let parts = [warp, (content, report.content.name().key)];
    let named_parts = parts.into_iter().filter(|(label, _)| !label.is_empty());
    let texts: Vec<_> = named_parts
        .map(|(label, key)| format!("{label} ({key})"))
        .collect();
    let method = texts.join(", ");
    let grid = report.grid.map(|[w, h]| format!(", {w} x {h} cells"));
    lines.row("method", &format!("{method}{}", grid.unwrap_or_default()));
    for (role, design) in ["source", "target"].iter().zip(&report.designs) {
        lines.row(role, &describe(design));
        for note in &design.notes {
            lines.row("", note);
        }
    }
    let Some(mesh) = &report.mesh else { return };
    lines.row(
        "mesh",
        &format!(
            "{} faces; {} vertices on the boundary, {} inside ({} per boundary vertex)",
            mesh.faces,
            mesh.boundary_vertices,
            mesh.inner_vertices,
            short(mesh.steiner_per_boundary_point)
        ),
    );
    lines.row(
        "angles",
        &format!(
            "minimum {:.1}° in the source, {:.1}° in the target; {} of faces below 5°",
            mesh.min_angle_source_deg,
            mesh.min_angle_target_deg,
            percent(mesh.thin_faces)
        ),
    );
}

/// Returns the name, kind and size of a design.
fn describe(design: &DesignReport) -> String {
    format!(
        "{}, {} of {} points",
        design.name, design.kind, design.points
    )
}

/// Adds the defects with their causes and fixes, the proof and the notes.
fn check(report: &PairReport, lines: &mut NumberLines) {
    lines.gap();
    let findings = &report.verdict.findings;
    if findings.is_empty() {
        lines.row("check", &report.verdict.words);
    }
    for finding in findings {
        let [x, y] = finding.finding.place.to_array().map(short);
        lines.row("check", &format!("{}, at ({x}, {y})", finding.words));
        lines.row("", &format!("Cause: {}", finding.cause_words));
        lines.row("", &format!("Fix: {}", finding.remedy_words));
    }
    if let Some(proof) = &report.proof {
        lines.row("proof", &proof.words);
    }
    for note in &report.verdict.notes {
        lines.row("note", &note.to_string());
    }
}

/// Adds the distortion at t = 1 to the text, and by how much the distortion at other t exceeds it.
fn distortion(report: &PairReport, mesh: &MeshReport, lines: &mut NumberLines) {
    lines.gap();
    let heads = ["median", "95 %", "worst", "           overshoot"];
    lines.cells(("at t = 1", NAME_WIDTH), heads);
    let film = &report.film;
    let of = &mesh.distortion;
    let rows: [(&str, &Distribution, Option<f64>); 4] = [
        ("conformal", &of.conformal, film.conformal_excess),
        ("isometric", &of.isometric, film.isometric_excess),
        ("area", &of.area, film.area_distortion_excess),
        ("boundary", &mesh.boundary_stretch, None),
    ];
    for (name, d, excess) in rows {
        let excess = format!("{:>20}", excess.map(short).unwrap_or_default());
        let [median, p95, worst] = [d.median, d.p95, d.worst].map(short);
        lines.cells((name, NAME_WIDTH), [median, p95, worst, excess]);
    }
}

/// Adds the measures of the whole film to the text.
fn film(report: &PairReport, lines: &mut NumberLines) {
    let film = &report.film;
    lines.gap();
    let defects = |max_count: Option<usize>, first_t: Option<f64>| {
        max_count.map(|count| match first_t {
            Some(t) => format!("up to {count} at once, first at t = {t:.2}"),
            None => count.to_string(),
        })
    };
    let asymmetry = |distance: f64| {
        format!(
            "vertices differ by up to {} of the diameter if the designs are swapped",
            short(distance)
        )
    };
    let overshoot = format!(
        "area {}, perimeter {}, turning {} beyond steady change",
        percent(film.area_variation_excess),
        percent(film.perimeter_variation_excess),
        percent(film.turning_excess)
    );
    for (name, text) in [
        ("folds", defects(film.worst_folds, film.first_fold_t)),
        (
            "crossings",
            defects(film.worst_crossings, film.first_crossing_t),
        ),
        ("asymmetry", film.asymmetry.map(asymmetry)),
        ("overshoot", Some(overshoot)),
        ("topology", topology(report)),
        ("motion", film.motion.as_ref().map(motion)),
    ] {
        if let Some(text) = text {
            lines.row(name, &text);
        }
    }
}

/// Returns the numbers of extra connected regions and holes of a field blend; `None` for other
/// content, in which these numbers do not change.
fn topology(report: &PairReport) -> Option<String> {
    let (pieces, holes) = report.film.pieces_excess.zip(report.film.holes_excess)?;
    (report.content == ContentKind::Field)
        .then(|| format!("extra pieces {pieces}, extra holes {holes}"))
}

/// Formats the travel and the acceleration of the vertices.
fn motion(motion: &MotionReport) -> String {
    format!(
        "mean travel {}, maximum {}; acceleration up to {} (diameters, without rigid motion)",
        short(motion.mean_travel),
        short(motion.max_travel),
        short(motion.max_acceleration)
    )
}

/// Adds a list of evenly spaced samples, with the measures that this transition has.
fn samples(samples: &[FilmSample], lines: &mut NumberLines) {
    let is_measured = |(_, quantity): &&(&str, Quantity)| {
        samples
            .first()
            .is_some_and(|s| quantity.value_at(s).is_some())
    };
    let columns: Vec<_> = SAMPLE_COLUMNS.iter().filter(is_measured).collect();
    lines.cells(("t", NAME_WIDTH), columns.iter().map(|(name, _)| name));
    // There are at least two samples, because `--samples` requires it.
    let last = samples.len() - 1;
    let step = last.div_ceil(MAX_ROWS - 1).max(1);
    let indexed = samples.iter().enumerate();
    for (_, sample) in indexed.filter(|(i, _)| i % step == 0 || *i == last) {
        let cells = columns
            .iter()
            .map(|(_, quantity)| quantity.value_at(sample));
        let cells = cells.map(|cell| cell.map(short).unwrap_or_default());
        lines.cells((&short(sample.t), NAME_WIDTH), cells);
    }
}

/// Adds two lines with times in milliseconds: of building, and of frames and measuring. Progress
/// stages that took no time are left out.
fn times(report: &PairReport, lines: &mut NumberLines) {
    let seconds = &report.seconds;
    let building = [
        ("import", seconds.import),
        ("match", seconds.matching),
        ("triangulate", seconds.triangulate),
        ("total build", seconds.build),
    ];
    let using = [
        ("frame", seconds.frame),
        ("figure", seconds.figure),
        ("measure", seconds.measure),
    ];
    for (name, times) in [("time", building.as_slice()), ("", using.as_slice())] {
        let measured = times.iter().filter(|(_, s)| *s > 0.0);
        let texts: Vec<_> = measured
            .map(|(name, s)| format!("{name} {} ms", short(1e3 * s)))
            .collect();
        lines.row(name, &texts.join(", "));
    }
}
