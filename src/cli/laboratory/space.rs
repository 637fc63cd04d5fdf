//! A space of many designs, measured, as data and for people.

use std::time::{Duration, Instant};

use serde::Serialize;

use super::number::{NumberLines, percent, short};
use crate::content::PictureRaster;
use crate::geometry::DVec2;
use crate::measure::{BlendReport, SpaceReport};
use crate::space::DesignSpace;

/// Blends whose times are taken: an odd number has a middle.
const TIMED: usize = 101;

/// Pixels along each side of a blend of pictures that is timed.
const PICTURE_PX: u32 = 400;

/// Room for what stands at the left.
const NAMES: usize = 28;

/// Everything that is measured of a space, and how long it took.
#[derive(Debug, Serialize)]
pub(in crate::cli) struct SpaceMeasurement {
    #[serde(flatten)]
    report: SpaceReport,
    /// For matching, triangulating and factoring, or for the fields.
    build_seconds: f64,
    /// For one blend from weights to outlines, or to a picture, the median of many.
    blend_seconds: f64,
    /// Pictures are what is seen: nothing of them folds or has an area.
    are_pictures: bool,
}

impl SpaceMeasurement {
    /// What was measured of a space that took so long to build.
    pub fn new(space: &DesignSpace, report: SpaceReport, build: Duration) -> Self {
        Self {
            report,
            build_seconds: build.as_secs_f64(),
            blend_seconds: timed(space).as_secs_f64(),
            are_pictures: space.is_of_pictures(),
        }
    }

    /// For people.
    pub fn text(&self) -> String {
        let report = &self.report;
        let mut lines = NumberLines::default();
        lines.line(&report.designs.join(", "));
        lines.gap();
        let how = match (report.vertices, report.faces) {
            (Some(vertices), Some(faces)) => {
                format!("rigid parts: one mesh of {vertices} vertices and {faces} faces")
            }
            _ if self.are_pictures => "pictures".to_owned(),
            _ => "distance fields".to_owned(),
        };
        lines.line(&how);
        report.notes.iter().for_each(|note| lines.line(note));
        lines.gap();
        if self.are_pictures {
            lines.cells(("", NAMES), ["unlike"]);
        } else {
            let heads = ["unlike", "folds", "crossings", "conformal", "area off"];
            lines.cells(("worst of nine blends", NAMES), heads);
        }
        for edge in &report.edges {
            let [a, b] = edge.designs.map(|k| report.designs[k].as_str());
            let name = format!("{a} – {b}");
            let unlike = std::iter::once(short(edge.unlike));
            if self.are_pictures {
                lines.cells((&name, NAMES), unlike);
            } else {
                lines.cells((&name, NAMES), unlike.chain(cells(&edge.worst)));
            }
        }
        if !self.are_pictures {
            self.all_over(&mut lines);
        }
        lines.gap();
        let what = match self.are_pictures {
            true => format!("a blend of {PICTURE_PX} pixels"),
            false => "a blend".to_owned(),
        };
        lines.line(&format!(
            "built in {} s; {what} takes {} ms",
            short(self.build_seconds),
            short(1e3 * self.blend_seconds)
        ));
        lines.0
    }

    /// What is wrong with blends in the middle and all over.
    fn all_over(&self, lines: &mut NumberLines) {
        let report = &self.report;
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

/// The median time of a blend, from weights to outlines or to a picture.
fn timed(space: &DesignSpace) -> Duration {
    let count = space.designs().len();
    let mut frame = space.frame();
    let bounds = space.bounds();
    let raster = PictureRaster {
        size: [PICTURE_PX; 2],
        corner: DVec2::new(bounds.min.x, bounds.max.y),
        pixel_size: bounds.size().max_element() / f64::from(PICTURE_PX),
    };
    let mut times: Vec<Duration> = (0..TIMED)
        .map(|k| {
            // From one corner to the next, and never the same twice.
            let mut weights = vec![0.5 / count as f64; count];
            weights[k % count] += 0.5;
            let start = Instant::now();
            frame.seek(&weights);
            std::hint::black_box((frame.figure(), frame.picture(&raster)));
            start.elapsed()
        })
        .collect();
    times.sort();
    times[TIMED / 2]
}
