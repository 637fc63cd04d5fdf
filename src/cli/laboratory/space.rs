//! Report of `check --map` on a design space, as data for JSON and as text: defects and distortion
//! of its blends, and times.

use std::time::{Duration, Instant};

use serde::Serialize;

use super::number::{NumberLines, percent, short};
use crate::content::PictureRaster;
use crate::geometry::DVec2;
use crate::measure::{BlendReport, SpaceReport};
use crate::space::DesignSpace;

/// Number of blends that are timed; odd, so that the median is one of the times (heuristic).
const TIMED_BLENDS: usize = 101;

/// Side length of the square picture that is computed when a blend of pictures is timed, in pixels
/// (heuristic).
const PICTURE_PX: u32 = 400;

/// Width of the first column, in characters (heuristic).
const NAME_WIDTH: usize = 28;

/// Measures of a design space, and times in seconds.
#[derive(Debug, Serialize)]
pub(in crate::cli) struct SpaceMeasurement {
    #[serde(flatten)]
    report: SpaceReport,
    /// Measured time to build the space: matching, triangulation and factorisation, or distance
    /// fields.
    build_seconds: f64,
    /// Median time to compute one blend from its weights, as outlines or as a picture.
    blend_seconds: f64,
    /// Whether the space blends pictures. They have no folds, crossings or areas to report.
    are_pictures: bool,
}

impl SpaceMeasurement {
    /// Combines the report on a space with the time to build it, and measures the time of a blend.
    pub fn new(space: &DesignSpace, report: SpaceReport, build_time: Duration) -> Self {
        Self {
            report,
            build_seconds: build_time.as_secs_f64(),
            blend_seconds: median_blend_time(space).as_secs_f64(),
            are_pictures: space.is_of_pictures(),
        }
    }

    /// Returns the report as text for people.
    pub fn text(&self) -> String {
        let report = &self.report;
        let mut lines = NumberLines::default();
        lines.line(&report.designs.join(", "));
        lines.gap();
        let method = match (report.vertices, report.faces) {
            (Some(vertices), Some(faces)) => {
                format!("rigid parts: one mesh of {vertices} vertices and {faces} faces")
            }
            _ if self.are_pictures => "pictures".to_owned(),
            _ => "distance fields".to_owned(),
        };
        lines.line(&method);
        report.notes.iter().for_each(|note| lines.line(note));
        lines.gap();
        if self.are_pictures {
            lines.cells(("", NAME_WIDTH), ["difference"]);
        } else {
            let heads = [
                "difference",
                "folds",
                "crossings",
                "conformal",
                "area error",
            ];
            lines.cells(("worst of nine blends", NAME_WIDTH), heads);
        }
        for edge in &report.edges {
            let [a, b] = edge.designs.map(|k| report.designs[k].as_str());
            let name = format!("{a} – {b}");
            let difference = std::iter::once(short(edge.unlike));
            if self.are_pictures {
                lines.cells((&name, NAME_WIDTH), difference);
            } else {
                lines.cells((&name, NAME_WIDTH), difference.chain(cells(&edge.worst)));
            }
        }
        if !self.are_pictures {
            self.add_blend_statistics(&mut lines);
        }
        lines.gap();
        let blend = match self.are_pictures {
            true => format!("a blend of {PICTURE_PX} x {PICTURE_PX} pixels"),
            false => "a blend".to_owned(),
        };
        lines.line(&format!(
            "built in {} s; {blend} takes {} ms",
            short(self.build_seconds),
            short(1e3 * self.blend_seconds)
        ));
        lines.0
    }

    /// Adds the measures of the blend with equal weights and of the blends spread over all weights.
    fn add_blend_statistics(&self, lines: &mut NumberLines) {
        let report = &self.report;
        // These rows belong to no pair of designs, so the column with the difference between two
        // designs is empty.
        let empty = || std::iter::once(String::new());
        lines.cells(
            ("equal weights", NAME_WIDTH),
            empty().chain(cells(&report.middle)),
        );
        let all = &report.all_over;
        let name = format!("worst over all {} blends", all.blends);
        lines.cells((&name, NAME_WIDTH), empty().chain(cells(&all.worst)));
        lines.gap();
        let [folded, crossed] = [all.folded, all.crossed];
        lines.line(&format!(
            "{} blends spread over all weights: {folded} with folds, {crossed} with crossings",
            all.blends
        ));
    }
}

/// Returns the cells of a blend: folds, crossings, conformal distortion and area error.
fn cells(blend: &BlendReport) -> [String; 4] {
    [
        blend.folds.to_string(),
        blend.crossings.to_string(),
        blend.conformal_p95.map_or_else(|| "–".to_owned(), short),
        percent(blend.area_off),
    ]
}

/// Measures the median time to compute a blend from its weights, as outlines or as a picture.
fn median_blend_time(space: &DesignSpace) -> Duration {
    let count = space.designs().len();
    let mut frame = space.frame();
    let bounds = space.bounds();
    let raster = PictureRaster {
        size: [PICTURE_PX; 2],
        corner: DVec2::new(bounds.min.x, bounds.max.y),
        pixel_size: bounds.size().max_element() / f64::from(PICTURE_PX),
    };
    let mut times: Vec<Duration> = (0..TIMED_BLENDS)
        .map(|k| {
            // Successive blends favour different designs, so no blend equals the previous one.
            let mut weights = vec![0.5 / count as f64; count];
            weights[k % count] += 0.5;
            let start = Instant::now();
            frame.seek(&weights);
            std::hint::black_box((frame.figure(), frame.picture(&raster)));
            start.elapsed()
        })
        .collect();
    times.sort();
    times[TIMED_BLENDS / 2]
}
