//! Writes a [`Drawing`] as a DXF document (release 12, ASCII), which practically every CAD program
//! reads.
//!
//! Guarantees: outlines become closed polylines, bars become lines, discs become circles; y points
//! up; coordinates are in the units of the designs if the drawing is a single frame, otherwise in
//! pixels; each colour has its own layer, named after the colour (`PAINT_2F6FB3`), because
//! release 12 has only 255 colours. Curves of letters become polylines. Fills, opacity and
//! gradients are lost, because the format does not have them.

use std::collections::BTreeSet;

use crate::colour::Rgb;
use crate::geometry::DVec2;
use crate::io::escape::DxfName;

use super::drawing::{Drawing, DrawingItem};
use super::outline::{OutlinePath, PathCommand};
use super::view::PlaneView;

/// Number of line segments that replace each Bézier curve (heuristic).
const CURVE_SEGMENTS: usize = 12;

/// Returns a drawing as a DXF document, or `None` if it contains a raster image, which has no
/// outlines.
pub(super) fn to_dxf(drawing: &Drawing) -> Option<String> {
    let paper = DxfCoordinates {
        view: drawing.view,
        height_px: f64::from(drawing.size.height()),
    };
    let mut layers = BTreeSet::new();
    let mut entities = String::new();
    for item in &drawing.items {
        let colour = match item {
            DrawingItem::Fill { outline, paint, .. } => {
                entities += &paper.polylines(outline, paint.colour, None);
                paint.colour
            }
            DrawingItem::Stroke { outline, line } => {
                entities += &paper.polylines(outline, line.paint.colour, Some(line.width));
                line.paint.colour
            }
            DrawingItem::Bars {
                segments, colour, ..
            } => {
                let line = |[a, b]: &[DVec2; 2]| {
                    let (a, b) = (paper.at(*a, 10), paper.at(*b, 11));
                    format!("0\nLINE\n8\n{}\n{a}{b}", layer(*colour))
                };
                entities.extend(segments.iter().map(line));
                *colour
            }
            DrawingItem::Discs {
                centres,
                radius_px,
                colour,
            } => {
                let radius = number(paper.length(*radius_px));
                let circle = |c: &DVec2| {
                    let (layer, c) = (layer(*colour), paper.at(*c, 10));
                    format!("0\nCIRCLE\n8\n{layer}\n{c}40\n{radius}\n")
                };
                entities.extend(centres.iter().map(circle));
                *colour
            }
            DrawingItem::Picture { .. } => return None,
        };
        layers.insert(colour.0);
    }
    let table: String = layers.iter().map(|&rgb| layer_entry(Rgb(rgb))).collect();
    let count = layers.len();
    Some(format!(
        "0\nSECTION\n2\nHEADER\n9\n$ACADVER\n1\nAC1009\n0\nENDSEC\n\
         0\nSECTION\n2\nTABLES\n0\nTABLE\n2\nLAYER\n70\n{count}\n{table}0\nENDTAB\n0\nENDSEC\n\
         0\nSECTION\n2\nENTITIES\n{entities}0\nENDSEC\n0\nEOF\n"
    ))
}

/// Conversion from pixels (y down) to the coordinates of the document (y up).
struct DxfCoordinates {
    /// Mapping between the plane and pixels; if `None`, coordinates stay in pixels.
    view: Option<PlaneView>,
    height_px: f64,
}

impl DxfCoordinates {
    fn place(&self, px: DVec2) -> DVec2 {
        match &self.view {
            Some(view) => view.to_plane(px),
            None => DVec2::new(px.x, self.height_px - px.y),
        }
    }

    fn length(&self, px: f64) -> f64 {
        px / self.view.map_or(1.0, |view| view.px_per_unit())
    }

    /// Formats a point. `code` is the DXF group code of its x coordinate; that of its y coordinate
    /// is ten higher.
    fn at(&self, px: DVec2, code: usize) -> String {
        let DVec2 { x, y } = self.place(px);
        let (x, y, next) = (number(x), number(y), code + 10);
        format!("{code}\n{x}\n{next}\n{y}\n")
    }

    /// Formats the contours of an outline as closed polylines, with a width if they are strokes.
    fn polylines(&self, outline: &OutlinePath, colour: Rgb, width_px: Option<f64>) -> String {
        let layer = layer(colour);
        let width = width_px.map_or_else(String::new, |width| {
            let width = number(self.length(width));
            format!("40\n{width}\n41\n{width}\n")
        });
        let polyline = |ring: Vec<DVec2>| {
            let vertex = |p: &DVec2| format!("0\nVERTEX\n8\n{layer}\n{}", self.at(*p, 10));
            let vertices: String = ring.iter().map(vertex).collect();
            format!(
                "0\nPOLYLINE\n8\n{layer}\n66\n1\n70\n1\n{width}{vertices}0\nSEQEND\n8\n{layer}\n"
            )
        };
        rings(outline).into_iter().map(polyline).collect()
    }
}

/// Returns the contours of an outline as polygons, with flattened curves.
fn rings(outline: &OutlinePath) -> Vec<Vec<DVec2>> {
    let mut rings: Vec<Vec<DVec2>> = Vec::new();
    for step in &outline.commands {
        if let PathCommand::Move(p) = *step {
            rings.push(vec![p]);
            continue;
        }
        let Some(ring) = rings.last_mut() else {
            continue;
        };
        let from = ring[ring.len() - 1];
        match *step {
            PathCommand::Line(p) => ring.push(p),
            PathCommand::Quad(c, p) => ring.extend(shares().map(|s| {
                let (a, b) = (from.lerp(c, s), c.lerp(p, s));
                a.lerp(b, s)
            })),
            PathCommand::Cubic(c, d, p) => ring.extend(shares().map(|s| {
                let (a, b, e) = (from.lerp(c, s), c.lerp(d, s), d.lerp(p, s));
                a.lerp(b, s).lerp(b.lerp(e, s), s)
            })),
            PathCommand::Move(_) | PathCommand::Close => {}
        }
    }
    rings
}

/// Returns the curve parameters in (0, 1] at which the line segments of a flattened curve end.
fn shares() -> impl Iterator<Item = f64> {
    (1..=CURVE_SEGMENTS).map(|k| k as f64 / CURVE_SEGMENTS as f64)
}

/// Returns the name of the DXF layer for a colour.
fn layer(Rgb([r, g, b]): Rgb) -> String {
    DxfName(&format!("PAINT_{r:02X}{g:02X}{b:02X}")).to_string()
}

/// Returns the entry of the DXF layer table for a colour.
fn layer_entry(colour: Rgb) -> String {
    let (name, nearest) = (layer(colour), nearest_index(colour));
    format!("0\nLAYER\n2\n{name}\n70\n0\n62\n{nearest}\n6\nCONTINUOUS\n")
}

/// Returns the AutoCAD colour index (1 to 9) closest to a colour.
fn nearest_index(Rgb(rgb): Rgb) -> usize {
    /// Colours of the AutoCAD indices 1 to 9 (AutoCAD Color Index).
    const INDEX_COLOURS: [[u8; 3]; 9] = [
        [255, 0, 0],
        [255, 255, 0],
        [0, 255, 0],
        [0, 255, 255],
        [0, 0, 255],
        [255, 0, 255],
        // Index 7 is drawn white on a black background and black on a white one.
        [0, 0, 0],
        [128, 128, 128],
        [192, 192, 192],
    ];
    let squared_distance = |other: &[u8; 3]| -> u32 {
        let channels = rgb.iter().zip(other);
        channels
            .map(|(a, b)| u32::from(a.abs_diff(*b)).pow(2))
            .sum()
    };
    let all = INDEX_COLOURS.iter().enumerate();
    let closest = all.min_by_key(|(_, other)| squared_distance(other));
    closest.map_or(7, |(k, _)| k + 1)
}

/// Formats a number with at most six decimals, without trailing zeros or negative zero.
fn number(x: f64) -> String {
    let fixed = format!("{x:.6}");
    let short = fixed.trim_end_matches('0').trim_end_matches('.');
    if short == "-0" { "0" } else { short }.to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::{DesignForm, ImportOptions, import};
    use crate::export::test_camera::camera;

    #[test]
    fn a_frame_read_back_has_the_same_area() {
        let camera = camera(300, 200, None);
        let text = to_dxf(&camera.draw(0.5)).expect("outlines");
        let read = import("half.dxf", text.as_bytes(), &ImportOptions::default());
        let read = read.expect("a design");
        let DesignForm::Outline(regions) = &read.form else {
            panic!("outlines: {:?}", read.form);
        };
        let figure = camera.sequence.frame(0.5).frame().figure();
        let area = |ring: &[DVec2]| -> f64 {
            let next = ring.iter().cycle().skip(1);
            let twice: f64 = ring.iter().zip(next).map(|(a, b)| a.perp_dot(*b)).sum();
            0.5 * twice
        };
        let expected: f64 = figure.rings.iter().map(|ring| area(ring)).sum();
        let actual: f64 = regions.rings().map(|ring| area(ring.points())).sum();
        assert!(
            (expected - actual).abs() < 1e-4 * expected,
            "{actual} instead of {expected}"
        );
    }

    #[test]
    fn layers_are_named_after_their_colours() {
        assert_eq!(layer(Rgb([0x2f, 0x6f, 0xb3])), "PAINT_2F6FB3");
        assert_eq!(nearest_index(Rgb([250, 4, 9])), 1);
        assert_eq!(nearest_index(Rgb([20, 20, 20])), 7);
        assert_eq!(number(-0.0000001), "0");
        assert_eq!(number(12.5), "12.5");
    }
}
