//! A space of many designs, measured, as data and for people.

use std::time::{Duration, Instant};

use serde::Serialize;

use super::number::{Lines, percent, short};
use crate::measure::{BlendReport, SpaceReport};
use crate::space::Space;

/// Blends whose times are taken: an odd number has a middle.
const TIMED: usize = 101;

/// Room for what stands at the left.
const NAMES: usize = 28;

/// Everything that is measured of a space, and how long it took.
#[derive(Debug, Serialize)]
pub(in crate::cli) struct MeasuredSpace {
    #[serde(flatten)]
    report: SpaceReport,
    /// For matching, triangulating and factoring, or for the fields.
    build_seconds: f64,
    /// For one blend from weights to outlines, the median of many.
    blend_seconds: f64,
}

impl MeasuredSpace {
    /// What was measured of a space that took so long to build.
    pub fn new(space: &Space, report: SpaceReport, build: Duration) -> Self {
        Self {
            report,
            build_seconds: build.as_secs_f64(),
            blend_seconds: timed(space).as_secs_f64(),
        }
    }

    /// For people.
    pub fn text(&self) -> String {
        let report = &self.report;
        let mut lines = Lines::default();
        lines.line(&report.designs.join(", "));
        lines.gap();
        let how = match (report.vertices, report.faces) {
            (Some(vertices), Some(faces)) => {
                format!("rigid parts: one mesh of {vertices} vertices and {faces} faces")
            }
            _ => "distance fields".to_owned(),
        };
        lines.line(&how);
        report.notes.iter().for_each(|note| lines.line(note));
        lines.gap();
        let heads = ["unlike", "folds", "crossings", "conformal", "area off"];
        lines.cells(("worst of nine blends", NAMES), heads);
        for edge in &report.edges {
            let [a, b] = edge.designs.map(|k| report.designs[k].as_str());
            let unlike = short(edge.unlike);
            let cells = std::iter::once(unlike).chain(cells(&edge.worst));
            lines.cells((&format!("{a} – {b}"), NAMES), cells);
        }
        let none = || std::iter::once(String::new());
        lines.cells(("the middle", NAMES), none().chain(cells(&report.middle)));
        let all = &report.all_over;
        let name = format!("worst of {} all over", all.blends);
        lines.cells((&name, NAMES), none().chain(cells(&all.worst)));
        lines.gap();
        let [folded, crossed] = [all.folded, all.crossed];
        lines.line(&format!(
            "of {} blends all over, {folded} fold and {crossed} cross themselves",
            all.blends
        ));
        lines.line(&format!(
            "built in {} s; a blend takes {} ms",
            short(self.build_seconds),
            short(1e3 * self.blend_seconds)
        ));
        lines.0
    }
}

fn cells(blend: &BlendReport) -> [String; 4] {
    [
        blend.folds.to_string(),
        blend.crossings.to_string(),
        blend.conformal_p95.map_or_else(|| "–".to_owned(), short),
        percent(blend.area_off),
    ]
}

/// The median time of a blend, from weights to outlines.
fn timed(space: &Space) -> Duration {
    let count = space.designs().len();
    let mut frame = space.frame();
    let mut times: Vec<Duration> = (0..TIMED)
        .map(|k| {
            // From one corner to the next, and never the same twice.
            let mut weights = vec![0.5 / count as f64; count];
            weights[k % count] += 0.5;
            let start = Instant::now();
            frame.seek(&weights);
            std::hint::black_box(frame.figure());
            start.elapsed()
        })
        .collect();
    times.sort();
    times[TIMED / 2]
}
