//! The report of one transition for people: short, in aligned lines.
//! Everything else is in the JSON.

use super::number::{NumberLines, percent, short};
use super::report::{DesignReport, PairReport};
use crate::content::ContentKind;
use crate::measure::{Distribution, FilmSample, MeshReport, MotionReport, Quantity};
use crate::settings::Choice;

/// Room for what stands at the left.
const NAMES: usize = 12;

/// The most samples that are listed.
const MOST_ROWS: usize = 9;

/// Columns of the list of samples.
const LISTED: [(&str, Quantity); 8] = [
    ("area", Quantity::Area),
    ("perimeter", Quantity::Perimeter),
    ("pieces", Quantity::Pieces),
    ("holes", Quantity::Holes),
    ("crossings", Quantity::Crossings),
    ("folds", Quantity::Folds),
    ("conformal", Quantity::WorstConformal),
    ("least det", Quantity::MinDet),
];

/// The whole report.
pub(in crate::cli) fn text(report: &PairReport) -> String {
    let mut lines = NumberLines::default();
    lines.line(&report.title);
    lines.gap();
    method(report, &mut lines);
    verdict(report, &mut lines);
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
    fn row(&mut self, name: &str, text: &str) {
        self.line(&format!("{name:<NAMES$} {text}"));
    }
}

fn method(report: &PairReport, lines: &mut NumberLines) {
    let content = match report.content {
        ContentKind::Solid => "",
        ContentKind::Field => "distance fields",
        ContentKind::Colours => "colours",
    };
    let warp = (report.warp.labels().name, report.warp.name().key);
    // Solids go without saying.
    let said = [warp, (content, report.content.name().key)];
    let said = said.into_iter().filter(|(words, _)| !words.is_empty());
    let said: Vec<_> = said
        .map(|(words, key)| format!("{words} ({key})"))
        .collect();
    let method = said.join(", ");
    let grid = report.grid.map(|[w, h]| format!(", {w} x {h} cells"));
    lines.row("method", &format!("{method}{}", grid.unwrap_or_default()));
    for (role, design) in ["source", "target"].iter().zip(&report.designs) {
        lines.row(role, &of_design(design));
        for note in &design.notes {
            lines.row("", note);
        }
    }
    let Some(mesh) = &report.mesh else { return };
    lines.row(
        "mesh",
        &format!(
            "{} faces; {} vertices on the boundary, {} inside ({} for one)",
            mesh.faces,
            mesh.boundary_vertices,
            mesh.inner_vertices,
            short(mesh.steiner_per_boundary_point)
        ),
    );
    lines.row(
        "angles",
        &format!(
            "{:.1}\u{b0} least in the source, {:.1}\u{b0} in the target; {} of faces below 5\u{b0}",
            mesh.min_angle_source_deg,
            mesh.min_angle_target_deg,
            percent(mesh.thin_faces)
        ),
    );
}

fn of_design(design: &DesignReport) -> String {
    format!(
        "{}, {} of {} points",
        design.name, design.kind, design.points
    )
}

fn verdict(report: &PairReport, lines: &mut NumberLines) {
    lines.gap();
    let findings = &report.verdict.findings;
    if findings.is_empty() {
        lines.row("verdict", &report.verdict.words);
    }
    for finding in findings {
        let [x, y] = finding.finding.place.to_array().map(short);
        lines.row("verdict", &format!("{}, about ({x}, {y})", finding.words));
        lines.row("", &format!("cause: {}", finding.cause_words));
        lines.row("", &format!("to do: {}", finding.remedy_words));
    }
    if let Some(proof) = &report.proof {
        lines.row("proof", &proof.words);
    }
    for note in &report.verdict.notes {
        lines.row("note", &note.to_string());
    }
}

fn distortion(report: &PairReport, mesh: &MeshReport, lines: &mut NumberLines) {
    lines.gap();
    let heads = ["median", "95 %", "worst", "    worse on the way"];
    lines.cells(("at t = 1", NAMES), heads);
    let film = &report.film;
    let of = &mesh.distortion;
    let rows: [(&str, &Distribution, Option<f64>); 4] = [
        ("conformal", &of.conformal, film.conformal_excess),
        ("isometric", &of.isometric, film.isometric_excess),
        ("area", &of.area, film.area_distortion_excess),
        ("stretch", &mesh.boundary_stretch, None),
    ];
    for (name, d, excess) in rows {
        let excess = format!("{:>20}", excess.map(short).unwrap_or_default());
        let [median, p95, worst] = [d.median, d.p95, d.worst].map(short);
        lines.cells((name, NAMES), [median, p95, worst, excess]);
    }
}

fn film(report: &PairReport, lines: &mut NumberLines) {
    let film = &report.film;
    lines.gap();
    let seen = |count: Option<usize>, first: Option<f64>| {
        let first = first.map(|t| format!(", the first at t = {t:.2}"));
        count.map(|n| format!("{n}{}", first.unwrap_or_default()))
    };
    let off = |share: f64| format!("{} of the diameter off", short(share));
    let up_and_down = format!(
        "area {}, perimeter {}, turning {} beyond what the ends need",
        percent(film.area_variation_excess),
        percent(film.perimeter_variation_excess),
        percent(film.turning_excess)
    );
    for (name, text) in [
        ("folds", seen(film.worst_folds, film.first_fold_t)),
        (
            "crossings",
            seen(film.worst_crossings, film.first_crossing_t),
        ),
        ("symmetry", film.asymmetry.map(off)),
        ("up and down", Some(up_and_down)),
        ("topology", topology(report)),
        ("motion", film.motion.as_ref().map(motion)),
    ] {
        if let Some(text) = text {
            lines.row(name, &text);
        }
    }
}

/// Solids keep theirs, so that it is told of fields only.
fn topology(report: &PairReport) -> Option<String> {
    let (pieces, holes) = report.film.pieces_excess.zip(report.film.holes_excess)?;
    (report.content == ContentKind::Field)
        .then(|| format!("{pieces} pieces and {holes} holes more than at the ends"))
}

fn motion(motion: &MotionReport) -> String {
    format!(
        "travel {} mean, {} most; acceleration {} (diameters, rigid motion taken out)",
        short(motion.mean_travel),
        short(motion.max_travel),
        short(motion.max_acceleration)
    )
}

fn samples(samples: &[FilmSample], lines: &mut NumberLines) {
    let known = |(_, quantity): &&(&str, Quantity)| {
        samples
            .first()
            .is_some_and(|s| quantity.value_at(s).is_some())
    };
    let columns: Vec<_> = LISTED.iter().filter(known).collect();
    lines.cells(("t", NAMES), columns.iter().map(|(name, _)| name));
    // Two at least, as the parser has it. The ends and about eight steps.
    let step = (samples.len() - 1).div_ceil(MOST_ROWS - 1).max(1);
    let last = samples.len() - 1;
    let listed = samples.iter().enumerate();
    for (_, sample) in listed.filter(|(i, _)| i % step == 0 || *i == last) {
        let cells = columns
            .iter()
            .map(|(_, quantity)| quantity.value_at(sample));
        let cells = cells.map(|cell| cell.map(short).unwrap_or_default());
        lines.cells((&short(sample.t), NAMES), cells);
    }
}

fn times(report: &PairReport, lines: &mut NumberLines) {
    let seconds = &report.seconds;
    let once = [
        ("import", seconds.import),
        ("match", seconds.matching),
        ("triangulate", seconds.triangulate),
        ("build in all", seconds.build),
    ];
    let often = [
        ("frame", seconds.frame),
        ("figure", seconds.figure),
        ("measure", seconds.measure),
    ];
    for (name, times) in [("time", once.as_slice()), ("", often.as_slice())] {
        let taken = times.iter().filter(|(_, s)| *s > 0.0);
        let words: Vec<_> = taken
            .map(|(name, s)| format!("{name} {} ms", short(1e3 * s)))
            .collect();
        lines.row(name, &words.join(", "));
    }
}
