//! A [`Drawing`] as a DXF document: release 12 in text, which every program of its
//! kind reads.
//!
//! Guarantees: closed outlines as closed polylines, bars as lines, discs as circles; y
//! up, and the units of the designs where the drawing is one frame, else pixels; a
//! layer for each colour, called by it (`PAINT_2F6FB3`), since the release knows but
//! 255 colours. Curves of letters become polylines. What it does not keep: fills,
//! opacity and gradients, which the format does not have.

use std::collections::BTreeSet;

use crate::colour::Rgb;
use crate::geometry::DVec2;

use super::drawing::{Drawing, DrawingItem};
use super::outline::{OutlinePath, PathCommand};
use super::view::PlaneView;

/// Straight steps that a curve becomes.
const STEPS: usize = 12;

/// A drawing as a document; `None` where it holds a picture, which has no outlines.
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
            DrawingItem::Line { outline, line } => {
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

/// From pixels, y down, to what is written.
struct DxfCoordinates {
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

    /// A place by a group code and that ten higher.
    fn at(&self, px: DVec2, code: usize) -> String {
        let DVec2 { x, y } = self.place(px);
        let (x, y, next) = (number(x), number(y), code + 10);
        format!("{code}\n{x}\n{next}\n{y}\n")
    }

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

/// The contours as polygons.
fn rings(outline: &OutlinePath) -> Vec<Vec<DVec2>> {
    let mut rings: Vec<Vec<DVec2>> = Vec::new();
    for step in &outline.steps {
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

fn shares() -> impl Iterator<Item = f64> {
    (1..=STEPS).map(|k| k as f64 / STEPS as f64)
}

fn layer(Rgb([r, g, b]): Rgb) -> String {
    format!("PAINT_{r:02X}{g:02X}{b:02X}")
}

fn layer_entry(colour: Rgb) -> String {
    let (name, nearest) = (layer(colour), nearest(colour));
    format!("0\nLAYER\n2\n{name}\n70\n0\n62\n{nearest}\n6\nCONTINUOUS\n")
}

/// The number of the most like of the first colours that all such programs share.
fn nearest(Rgb(rgb): Rgb) -> usize {
    const FIRST: [[u8; 3]; 9] = [
        [255, 0, 0],
        [255, 255, 0],
        [0, 255, 0],
        [0, 255, 255],
        [0, 0, 255],
        [255, 0, 255],
        // White on black paper, black on white.
        [0, 0, 0],
        [128, 128, 128],
        [192, 192, 192],
    ];
    let off = |other: &[u8; 3]| -> u32 {
        let channels = rgb.iter().zip(other);
        channels
            .map(|(a, b)| u32::from(a.abs_diff(*b)).pow(2))
            .sum()
    };
    let all = FIRST.iter().enumerate();
    let found = all.min_by_key(|(_, other)| off(other));
    found.map_or(7, |(k, _)| k + 1)
}

/// At most six decimals.
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
    fn a_frame_comes_back_as_large_as_it_is() {
        let camera = camera(300, 200, None);
        let text = to_dxf(&camera.shoot(0.5)).expect("outlines");
        let read = import("half.dxf", text.as_bytes(), &ImportOptions::default());
        let read = read.expect("a design");
        let DesignForm::Outline(regions) = &read.form else {
            panic!("outlines: {:?}", read.form);
        };
        let figure = camera.sequence.frame(0.5).now().figure();
        let area = |ring: &[DVec2]| -> f64 {
            let next = ring.iter().cycle().skip(1);
            let twice: f64 = ring.iter().zip(next).map(|(a, b)| a.perp_dot(*b)).sum();
            0.5 * twice
        };
        let wanted: f64 = figure.rings.iter().map(|ring| area(ring)).sum();
        let found: f64 = regions.rings().map(|ring| area(ring.points())).sum();
        assert!(
            (wanted - found).abs() < 1e-4 * wanted,
            "{found} for {wanted}"
        );
    }

    #[test]
    fn colours_name_their_layers() {
        assert_eq!(layer(Rgb([0x2f, 0x6f, 0xb3])), "PAINT_2F6FB3");
        assert_eq!(nearest(Rgb([250, 4, 9])), 1);
        assert_eq!(nearest(Rgb([20, 20, 20])), 7);
        assert_eq!(number(-0.0000001), "0");
        assert_eq!(number(12.5), "12.5");
    }
}
