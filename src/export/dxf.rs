//! Writes a [`Drawing`] as a DXF document (release 12, ASCII), which practically every CAD program
//! reads.
//!
//! Guarantees: outlines become closed polylines, bars become lines, discs become circles; y points
//! up; coordinates are in the units of the designs if the drawing is a single frame, otherwise in
//! pixels. A frame declares the unit of its designs (`$INSUNITS`), if they have one: that of the
//! source before t = ½, that of the target from there on.
//!
//! Each outline lies on a layer with the name of its paint layer: in a transition, the name in the
//! source before t = ½ and that in the target from there on. What has no name lies on a layer named
//! after its colour (`PAINT_2F6FB3`). Names are escaped; different names that become equal get a
//! number. A layer has the colour of its first outline; outlines of other colours have their own.
//! Colours are the nearest of the nine basic ones, because release 12 has only 255 colours. Curves
//! of letters become polylines. Fills, opacity and gradients are lost, because the format does not
//! have them.

use std::collections::HashMap;

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
    let mut layers = LayerNames::default();
    let mut entities = String::new();
    for item in &drawing.items {
        match item {
            DrawingItem::Fill { outline, paint, .. } => {
                entities += &paper.polylines(outline, paint.colour, None, &mut layers);
            }
            DrawingItem::Stroke { outline, line } => {
                let (colour, width) = (line.paint.colour, Some(line.width));
                entities += &paper.polylines(outline, colour, width, &mut layers);
            }
            DrawingItem::Bars {
                segments, colour, ..
            } => {
                let layer = layers.of("", *colour);
                let line = |[a, b]: &[DVec2; 2]| {
                    let (a, b) = (paper.at(*a, 10), paper.at(*b, 11));
                    format!("0\nLINE\n{layer}{a}{b}")
                };
                entities.extend(segments.iter().map(line));
            }
            DrawingItem::Discs {
                centres,
                radius_px,
                colour,
            } => {
                let (radius, layer) = (number(paper.length(*radius_px)), layers.of("", *colour));
                let circle = |c: &DVec2| {
                    let c = paper.at(*c, 10);
                    format!("0\nCIRCLE\n{layer}{c}40\n{radius}\n")
                };
                entities.extend(centres.iter().map(circle));
            }
            DrawingItem::Picture { .. } => return None,
        }
    }
    let (count, table) = (layers.entries.len(), layers.table());
    let unit = drawing.unit.map_or_else(String::new, |unit| {
        format!("9\n$INSUNITS\n70\n{}\n", unit.dxf_code())
    });
    Some(format!(
        "0\nSECTION\n2\nHEADER\n9\n$ACADVER\n1\nAC1009\n{unit}0\nENDSEC\n\
         0\nSECTION\n2\nTABLES\n0\nTABLE\n2\nLAYER\n70\n{count}\n{table}0\nENDTAB\n0\nENDSEC\n\
         0\nSECTION\n2\nENTITIES\n{entities}0\nENDSEC\n0\nEOF\n"
    ))
}

/// Layers of a document, in the order of their first use.
#[derive(Default)]
struct LayerNames {
    /// Escaped name and colour index of each layer.
    entries: Vec<(String, usize)>,
    /// Index of the layer of each name that is not escaped.
    of_names: HashMap<String, usize>,
    /// Number of names that became equal, for each escaped name in capitals.
    counts: HashMap<String, usize>,
}

impl LayerNames {
    /// Returns the pairs (group codes and values) of an entity's layer and colour. If `name` is
    /// empty, the layer is named after the colour.
    fn of(&mut self, name: &str, colour: Rgb) -> String {
        let Rgb([r, g, b]) = colour;
        let name = match name.trim().is_empty() {
            true => format!("PAINT_{r:02X}{g:02X}{b:02X}"),
            false => name.to_owned(),
        };
        let own = nearest_index(colour);
        let index = match self.of_names.get(&name) {
            Some(&index) => index,
            None => {
                let entry = (self.unused_name(&name), own);
                self.entries.push(entry);
                self.of_names.insert(name, self.entries.len() - 1);
                self.entries.len() - 1
            }
        };
        let (name, of_layer) = &self.entries[index];
        let colour = match own == *of_layer {
            true => String::new(),
            false => format!("62\n{own}\n"),
        };
        format!("8\n{name}\n{colour}")
    }

    /// Escapes a name and appends a number if another name has become equal; DXF does not
    /// distinguish capitals.
    fn unused_name(&mut self, name: &str) -> String {
        let escaped = DxfName(name).to_string();
        let mut unused = escaped.clone();
        loop {
            let count = self.counts.entry(unused.to_ascii_uppercase()).or_default();
            *count += 1;
            if *count == 1 {
                return unused;
            }
            let number = self.counts[&escaped.to_ascii_uppercase()];
            unused = format!("{escaped}_{number}");
        }
    }

    /// Returns the entries of the layer table.
    fn table(&self) -> String {
        let entries = self.entries.iter();
        entries
            .map(|(name, index)| {
                format!("0\nLAYER\n2\n{name}\n70\n0\n62\n{index}\n6\nCONTINUOUS\n")
            })
            .collect()
    }
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
    fn polylines(
        &self,
        outline: &OutlinePath,
        colour: Rgb,
        width_px: Option<f64>,
        layers: &mut LayerNames,
    ) -> String {
        let width = width_px.map_or_else(String::new, |width| {
            let width = number(self.length(width));
            format!("40\n{width}\n41\n{width}\n")
        });
        let polyline = |ring: &Vec<DVec2>, layer: &str| {
            let vertex = |p: &DVec2| format!("0\nVERTEX\n{layer}{}", self.at(*p, 10));
            let vertices: String = ring.iter().map(vertex).collect();
            format!("0\nPOLYLINE\n{layer}66\n1\n70\n1\n{width}{vertices}0\nSEQEND\n{layer}")
        };
        let rings = rings(outline);
        let mut rings = rings.iter();
        let mut text = String::new();
        for contours in &outline.names {
            let layer = layers.of(&contours.name, colour);
            text.extend(
                rings
                    .by_ref()
                    .take(contours.count)
                    .map(|ring| polyline(ring, &layer)),
            );
        }
        // Outlines without paint layers, such as text, have no names.
        if rings.len() > 0 {
            let layer = layers.of("", colour);
            text.extend(rings.map(|ring| polyline(ring, &layer)));
        }
        text
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
    use crate::transition::{Transition, TransitionStyle};

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

    /// Returns a DXF drawing in inches with a red square on each of the given layers.
    fn squares(layers: &[&str]) -> String {
        let square = |(k, layer): (usize, &&str)| {
            let x = 4 * k;
            let corners = [(x, 0), (x + 2, 0), (x + 2, 2), (x, 2)];
            let corners = corners.map(|(x, y)| format!("10\n{x}\n20\n{y}\n")).concat();
            format!("0\nLWPOLYLINE\n8\n{layer}\n62\n1\n90\n4\n70\n1\n{corners}")
        };
        let squares: String = layers.iter().enumerate().map(square).collect();
        format!(
            "0\nSECTION\n2\nHEADER\n9\n$INSUNITS\n70\n1\n0\nENDSEC\n\
             0\nSECTION\n2\nENTITIES\n{squares}0\nENDSEC\n0\nEOF\n"
        )
    }

    /// Returns the transition between two DXF drawings, as DXF at `t`.
    fn at(source: &str, target: &str, t: f64) -> String {
        let [source, target] = [source, target].map(|text| {
            import("squares", text.as_bytes(), &ImportOptions::default()).expect("a design")
        });
        let transition = Transition::between(source, target).expect("a transition");
        let frame = transition.frame(t);
        let bounds = frame.transition().designs()[0].extent;
        let size = crate::export::PixelSize::new(200, 100).expect("a legal size");
        let view = PlaneView::fit(bounds, size);
        let style = TransitionStyle::default();
        to_dxf(&Drawing::of_frame(&frame, &style, &view, None)).expect("outlines")
    }

    /// Returns the values of all pairs with a group code that follow an entity or entry of a kind.
    fn values(text: &str, kind: &str, code: &str) -> Vec<String> {
        let lines: Vec<&str> = text.lines().collect();
        let mut inside = false;
        let mut found = Vec::new();
        for pair in lines.chunks_exact(2) {
            match pair {
                ["0", name] => inside = *name == kind,
                [name, value] if inside && *name == code => found.push((*value).to_owned()),
                _ => {}
            }
        }
        found
    }

    #[test]
    fn layers_and_units_of_a_drawing_survive() {
        let source = squares(&["WALL", "Fenster groß", "a<b"]);
        let target = squares(&["WALL", "Dach", "a>b"]);
        let start = at(&source, &target, 0.0);
        assert_eq!(
            values(&start, "LAYER", "2"),
            ["WALL", "Fenster gro\\U+00DF", "a_b"]
        );
        let end = at(&source, &target, 1.0);
        assert_eq!(values(&end, "LAYER", "2"), ["WALL", "Dach", "a_b"]);
        for text in [start, end] {
            assert!(text.contains("9\n$INSUNITS\n70\n1\n"), "{text}");
            let layers = values(&text, "POLYLINE", "8");
            assert_eq!(layers.len(), 3);
            let back = import("back", text.as_bytes(), &ImportOptions::default());
            let back = back.expect("a design");
            assert_eq!(back.unit, Some(crate::design::LengthUnit::Inch));
        }
    }

    #[test]
    fn different_names_that_become_equal_are_numbered() {
        let mut layers = LayerNames::default();
        let red = Rgb([255, 0, 0]);
        let names = ["a/b", "a:b", "A_B", "a/b", "", "a_b_2"];
        let found: Vec<String> = names.iter().map(|name| layers.of(name, red)).collect();
        let expected = ["a_b", "a_b_2", "A_B_3", "a_b", "PAINT_FF0000", "a_b_2_2"];
        assert_eq!(found, expected.map(|name| format!("8\n{name}\n")));
        assert_eq!(layers.of("a/b", Rgb([0, 0, 255])), "8\na_b\n62\n5\n");
    }

    #[test]
    fn colours_and_numbers_are_written_in_short() {
        assert_eq!(nearest_index(Rgb([250, 4, 9])), 1);
        assert_eq!(nearest_index(Rgb([20, 20, 20])), 7);
        assert_eq!(number(-0.0000001), "0");
        assert_eq!(number(12.5), "12.5");
    }
}
