//! Tests of the DXF importer: curves, rings, blocks, colours, hidden entities, both binary
//! encodings, notes, errors and limits.

mod fills;
mod lines;
mod silence;
mod texts;

use super::*;
use crate::colour::Rgb;
use crate::design::form::ImportedOutlines;
use crate::design::note::{DxfNote, ImportNote};
use crate::design::paint_layer::PaintLayer;
use crate::geometry::{DVec2, Regions};
use std::f64::consts::PI;

/// Builds a text file from sections, given as names and contents. In the contents, group codes and
/// values are separated by white space.
fn text(sections: &[(&str, &str)]) -> String {
    let section = |(name, pairs): &(&str, &str)| {
        let pairs: String = pairs
            .split_whitespace()
            .map(|word| format!("{word}\n"))
            .collect();
        format!("0\nSECTION\n2\n{name}\n{pairs}0\nENDSEC\n")
    };
    sections.iter().map(section).collect::<String>() + "0\nEOF\n"
}

/// Converts a text file to a binary file with group codes of two bytes (`wide`) or one byte.
fn binary(text: &str, wide: bool) -> Vec<u8> {
    let mut bytes = BINARY.to_vec();
    let mut lines = text.lines();
    while let (Some(code), Some(value)) = (lines.next(), lines.next()) {
        let code: i16 = code.parse().expect("a code");
        match wide {
            true => bytes.extend(code.to_le_bytes()),
            false => bytes.push(u8::try_from(code).expect("a narrow code")),
        }
        match code {
            10..=59 | 210..=239 => {
                let number: f64 = value.parse().expect("a number");
                bytes.extend(number.to_le_bytes());
            }
            60..=79 => bytes.extend(value.parse::<i16>().expect("a number").to_le_bytes()),
            90..=99 => bytes.extend(value.parse::<i32>().expect("a number").to_le_bytes()),
            _ => {
                bytes.extend(value.bytes());
                bytes.push(0);
            }
        }
    }
    bytes
}

/// Imports a file with the maximum deviation `tolerance` of flattened curves.
fn read_with(bytes: &[u8], tolerance: f64) -> Result<ImportedOutlines, DxfError> {
    let options = ImportOptions {
        tolerance,
        ..ImportOptions::default()
    };
    read(bytes, &options).map(|import| import.outlines)
}

/// Imports a file given as sections.
fn found_in(sections: &[(&str, &str)]) -> Result<ImportedOutlines, DxfError> {
    read_with(text(sections).as_bytes(), 1e-5)
}

fn found(entities: &str) -> Result<ImportedOutlines, DxfError> {
    found_in(&[("ENTITIES", entities)])
}

/// Returns the notes of an import as messages, except that outlines are filled.
fn words(outlines: &ImportedOutlines) -> Vec<String> {
    let is_filled =
        |note: &&ImportNote| matches!(note, ImportNote::Dxf(DxfNote::FilledOutlines { .. }));
    let notes = outlines.notes.iter().filter(|note| !is_filled(note));
    notes.map(ToString::to_string).collect()
}

/// No messages.
const NONE: [&str; 0] = [];

fn regions(entities: &str) -> Regions {
    found(entities).expect("an outline").regions
}

fn error(entities: &str) -> String {
    found(entities).err().expect("no outline").to_string()
}

fn assert_near(found: f64, expected: f64) {
    assert!(
        (found - expected).abs() < 1e-3 * expected,
        "{found} for {expected}"
    );
}

const SQUARE: &str = "0 LINE 8 0 10 0 20 0 11 4 21 0 0 LINE 8 0 10 4 20 4 11 4 21 0
    0 LINE 8 0 10 4 20 4 11 0 21 4 0 LINE 8 0 10 0 20 0 11 0 21 4";

#[test]
fn lines_are_joined_into_rings() {
    let square = found(SQUARE).expect("a square");
    assert_near(square.regions.area(), 16.0);
    assert_eq!(words(&square), NONE);
    assert_eq!(square.extent.size(), DVec2::splat(4.0));
}

#[test]
fn every_curve_type_is_imported() {
    let pi = PI;
    for (entities, area) in [
        ("0 CIRCLE 8 0 10 3 20 4 40 2", 4.0 * pi),
        (
            "0 ARC 8 0 10 0 20 0 40 2 50 0 51 180 0 LINE 8 0 10 -2 20 0 11 2 21 0",
            2.0 * pi,
        ),
        (
            "0 ELLIPSE 8 0 10 1 20 1 11 3 21 0 40 0.5 41 0 42 6.283185307179586",
            4.5 * pi,
        ),
        (
            "0 LWPOLYLINE 8 0 90 2 70 1 10 -1 20 0 42 1 10 1 20 0 42 1",
            pi,
        ),
        (
            "0 POLYLINE 8 0 66 1 70 1 0 VERTEX 8 0 10 0 20 0 0 VERTEX 8 0 10 4 20 0
             0 VERTEX 8 0 10 4 20 3 0 SEQEND 8 0",
            6.0,
        ),
        // A quarter circle as a rational spline, closed by two lines.
        (
            "0 SPLINE 8 0 70 8 71 2 72 6 73 3 40 0 40 0 40 0 40 1 40 1 40 1
             41 1 41 0.7071067811865476 41 1 10 2 20 0 10 2 20 2 10 0 20 2
             0 LINE 8 0 10 0 20 0 11 2 21 0 0 LINE 8 0 10 0 20 2 11 0 21 0",
            pi,
        ),
        // An extrusion direction of −z mirrors the arc.
        (
            "0 ARC 8 0 10 0 20 0 40 2 50 0 51 90 210 0 220 0 230 -1
             0 LINE 8 0 10 0 20 0 11 -2 21 0 0 LINE 8 0 10 0 20 0 11 0 21 2",
            pi,
        ),
    ] {
        let found = found(entities).expect(entities);
        assert_near(found.regions.area(), area);
        assert_eq!(words(&found), NONE, "{entities}");
    }
}

#[test]
fn rings_in_rings_are_holes() {
    let circle = "0 CIRCLE 8 0 10 2 20 2 40 1";
    let washer = regions(&format!("{SQUARE} {circle}"));
    assert_eq!(washer.rings().count(), 2);
    assert_near(washer.area(), 16.0 - PI);
    let twice = found(&format!("{SQUARE} {circle} {SQUARE} {circle}")).expect("an outline");
    assert_near(twice.regions.area(), 16.0 - PI);
    assert_eq!(words(&twice), [ImportNote::Duplicates(5).to_string()]);
}

#[test]
fn blocks_are_expanded_at_their_insertions() {
    let blocks = format!(
        "0 BLOCK 8 0 2 PART 10 2 20 2 {SQUARE} 0 ENDBLK
         0 BLOCK 8 0 2 PAIR 10 0 20 0 0 INSERT 8 0 2 PART 10 0 20 0
         0 INSERT 8 0 2 PART 10 20 20 0 41 -2 50 30 0 ENDBLK"
    );
    let entities = "0 INSERT 8 0 2 PAIR 10 100 20 0 42 3 0 INSERT 8 0 2 PART 70 2 71 2 44 10 45 10
        0 INSERT 8 0 2 NONE";
    let file = text(&[("BLOCKS", &blocks), ("ENTITIES", entities)]);
    let found = read_with(file.as_bytes(), 1e-5).expect("copies");
    assert_eq!(found.regions.len(), 6);
    assert_near(found.regions.area(), 3.0 * (16.0 + 32.0) + 4.0 * 16.0);
    assert_eq!(words(&found).len(), 1);
}

#[test]
fn hidden_entities_are_ignored() {
    let tables = "0 TABLE 2 LAYER 0 LAYER 2 off 70 0 62 -7 0 LAYER 2 ice 70 1 62 7 0 ENDTAB";
    let entities = format!(
        "{SQUARE} 0 CIRCLE 8 off 40 9 0 CIRCLE 8 ice 40 9 0 CIRCLE 8 0 60 1 40 9
         0 CIRCLE 8 0 67 1 40 9"
    );
    let file = text(&[("TABLES", tables), ("ENTITIES", &entities)]);
    assert_near(
        read_with(file.as_bytes(), 1e-5)
            .expect("a square")
            .regions
            .area(),
        16.0,
    );
}

#[test]
fn both_binary_encodings_are_imported() {
    let file = text(&[("HEADER", "9 $X 70 4"), ("ENTITIES", SQUARE)]);
    for wide in [true, false] {
        let found = read_with(&binary(&file, wide), 1e-5).expect("a square");
        assert_near(found.regions.area(), 16.0);
    }
    let whole = binary(&file, true);
    for length in BINARY.len() + 20..whole.len() - 20 {
        assert!(read_with(&whole[..length], 1e-5).is_err());
    }
}

#[test]
fn open_lines_are_strokes_and_unsupported_entities_are_reported() {
    let found = found(&format!(
        "{SQUARE} 0 LINE 8 0 10 4 20 4 11 9 21 4 0 REGION 5 2F 8 ribs 0 POINT 8 0 10 1 20 1"
    ))
    .expect("a square");
    // The line is as wide as a hair, 9 times 0.001, with round ends; half of the end at the square
    // and a quarter of the disc lie in the square.
    let width = 0.009;
    let radius = 0.5 * width;
    let stroke = 5.0 * width + PI * radius * radius * 0.75;
    assert!((found.regions.area() - 16.0 - stroke).abs() < 1e-4);
    assert_eq!(
        words(&found),
        [
            "1 open line drawn as strokes, 0.009 drawing units wide; close them to fill their area",
            "1 POINT left out: it has no area (line 72, layer 0)",
            "1 REGION left out: its ACIS data is not read; explode or trace it (line 66, layer ribs, handle 2F)",
        ]
    );
}

/// Broken entities with the notes that report them.
const BROKEN_ENTITIES: [(&str, &str); 12] = [
    (
        "0 LINE 8 0 10 x 20 0",
        "1 LINE left out: a value is not a number from -1e18 to 1e18 (line 58, layer 0)",
    ),
    (
        "0 LINE 8 0 10 nan 20 0",
        "1 LINE left out: a value is not a number",
    ),
    (
        "0 LINE 8 0 10 1e300 20 0",
        "1 LINE left out: a value is not a number",
    ),
    (
        "0 SPLINE 8 0 71 3 10 0 20 0",
        "1 SPLINE left out: it has no knots (line 54, layer 0)",
    ),
    (
        "0 SPLINE 8 0 71 3 40 0 10 0 20 0",
        "1 SPLINE left out: its degree, knots",
    ),
    (
        "0 SPLINE 8 0 71 3",
        "1 SPLINE left out: it has neither control points",
    ),
    (
        "0 CIRCLE 8 0 40 0",
        "1 CIRCLE left out: its radius is not positive",
    ),
    (
        "0 HATCH 8 0 2 SOLID 70 1",
        "1 HATCH left out: it has no boundary",
    ),
    (
        "0 LWPOLYLINE 8 0 10 3 20 3",
        "1 LWPOLYLINE left out: it has fewer than two vertices",
    ),
    (
        "0 TEXT 8 0 1 words 40 0",
        "1 TEXT left out: its text height is not positive",
    ),
    (
        "0 INSERT 8 0 2 gone",
        "1 INSERT left out: its block is not defined",
    ),
    (
        "0 INSERT 8 0 2 A 70 30000 71 30000",
        "1 INSERT left out: it makes too many copies",
    ),
];

#[test]
fn broken_entities_are_left_out_and_the_rest_remains() {
    for (entity, message) in BROKEN_ENTITIES {
        let found = found(&format!("{SQUARE} {entity}")).expect(entity);
        assert_near(found.regions.area(), 16.0);
        let words = words(&found);
        assert_eq!(words.len(), 1, "{words:?}");
        assert!(words[0].starts_with(message), "{words:?}");
    }
}

#[test]
fn a_file_is_refused_if_nothing_remains_or_its_structure_is_broken() {
    assert!(error("0 LINE 8 0 ten 1").contains("line 9: a group code is missing"));
    let nothing = error("0 LINE 8 0 10 x 20 0 0 RAY 8 0 0 RAY 8 0");
    let reasons = ["1 LINE left out: a value", "2 RAY left out: it has no end"];
    assert!(
        reasons.iter().all(|reason| nothing.contains(reason)),
        "{nothing}"
    );
    let whole = text(&[("ENTITIES", SQUARE)]);
    let cut = read_with(&whole.as_bytes()[..100], 1e-5)
        .err()
        .expect("cut");
    assert!(cut.to_string().contains("is incomplete"), "{cut}");
}

#[test]
fn recursive_and_exponential_blocks_are_limited() {
    let block = format!("0 BLOCK 2 A {SQUARE} 0 INSERT 8 0 2 a 0 ENDBLK");
    let own = found_in(&[("BLOCKS", &block), ("ENTITIES", "0 INSERT 8 0 2 A")]).expect("a square");
    assert_near(own.regions.area(), 16.0);
    assert!(words(&own)[0].contains("1 INSERT left out: its block contains itself"));
    let mut blocks = String::from("0 BLOCK 2 B0 0 ENDBLK ");
    for level in 1..15 {
        let copies = format!("0 INSERT 8 0 2 B{} 70 9 71 9 ", level - 1);
        blocks += &format!("0 BLOCK 2 B{level} {copies} 0 ENDBLK ");
    }
    let bomb = text(&[("BLOCKS", &blocks), ("ENTITIES", "0 INSERT 8 0 2 B14")]);
    assert_eq!(
        read_with(bomb.as_bytes(), 1e-5).err(),
        Some(DxfError::TooMany)
    );
}

#[test]
fn a_flattened_circle_uses_its_tolerance() {
    for tolerance in [1e-2, 1e-3, 1e-4] {
        let file = text(&[("ENTITIES", "0 CIRCLE 8 0 10 0 20 0 40 1")]);
        let found = read_with(file.as_bytes(), tolerance).expect("a disc");
        let ring = &found
            .regions
            .rings()
            .next()
            .expect("a ring")
            .points()
            .to_vec();
        let count = ring.len();
        let sagitta = 1.0 - (PI / count as f64).cos();
        assert!(sagitta <= 2.0 * tolerance, "{sagitta}");
        assert!(sagitta > 0.2 * tolerance, "{sagitta}");
    }
}

/// Returns a square as an LWPOLYLINE on a layer. Its left edge is at `x` and its lower edge on the
/// x axis. `more` holds additional pairs of group code and value.
fn square_on(layer: &str, x: f64, side: f64, more: &str) -> String {
    let (right, top) = (x + side, side);
    format!(
        "0 LWPOLYLINE 8 {layer} {more} 90 4 70 1 10 {x} 20 0 10 {right} 20 0
         10 {right} 20 {top} 10 {x} 20 {top} "
    )
}

/// Returns the colour, name and rounded area of each paint layer, lowest first.
fn painted(sections: &[(&str, &str)]) -> Vec<(Option<Rgb>, String, f64)> {
    let file = text(sections);
    let outlines = read_with(file.as_bytes(), 1e-5).expect("an outline");
    let summary = |coat: &PaintLayer| {
        let colour = coat.paint.map(|paint| paint.colour);
        (colour, coat.name.clone(), coat.regions.area().round())
    };
    outlines.paint_layers.iter().map(summary).collect()
}

const LAYERS: &str = "0 TABLE 2 LAYER 0 LAYER 2 walls 70 0 62 1 0 LAYER 2 sea 70 0 62 5 420 255
    0 LAYER 2 plain 70 0 62 7 0 ENDTAB";

#[test]
fn layers_and_entities_colour_the_paint_layers() {
    let red = Some(Rgb([255, 0, 0]));
    let entities = [
        square_on("walls", 0.0, 2.0, ""),
        square_on("sea", 0.0, 8.0, ""),
        square_on("walls", 4.0, 1.0, "62 3"),
        square_on("plain", 6.0, 1.5, ""),
    ];
    let found = painted(&[("TABLES", LAYERS), ("ENTITIES", &entities.concat())]);
    let expected = [
        (Some(Rgb([0, 0, 255])), "sea", 64.0),
        (red, "walls", 4.0),
        (Some(Rgb([0; 3])), "plain", 2.0),
        (Some(Rgb([0, 255, 0])), "walls", 1.0),
    ];
    let expected = expected.map(|(rgb, name, area)| (rgb, name.to_owned(), area));
    assert_eq!(found, expected);
}

#[test]
fn blocks_inherit_colours_from_their_reference() {
    let block = format!(
        "0 BLOCK 8 0 2 tile 10 0 20 0 {} {} 0 ENDBLK",
        square_on("0", 0.0, 4.0, ""),
        square_on("other", 8.0, 2.0, "62 0")
    );
    let insert = "0 INSERT 8 walls 62 3 2 tile 10 0 20 0";
    let found = painted(&[("TABLES", LAYERS), ("BLOCKS", &block), ("ENTITIES", insert)]);
    // The square on layer 0 takes the colour of the layer on which the block reference lies. The
    // square with the colour BYBLOCK takes the colour of the block reference itself.
    let expected = [
        (Some(Rgb([255, 0, 0])), "walls".to_owned(), 16.0),
        (Some(Rgb([0, 255, 0])), "other".to_owned(), 4.0),
    ];
    assert_eq!(found, expected);
}

#[test]
fn a_ring_across_layers_takes_the_colour_of_the_longest_part() {
    let corners = [(0, 0), (6, 0), (6, 4), (0, 4)];
    let line = |k: usize| {
        let ((x, y), (u, v)) = (corners[k], corners[(k + 1) % 4]);
        let layer = ["walls", "sea"][k % 2];
        format!("0 LINE 8 {layer} 10 {x} 20 {y} 11 {u} 21 {v} ")
    };
    let lines: String = (0..4).map(line).collect();
    let entities = lines + &square_on("sea", 9.0, 2.0, "");
    let found = painted(&[("TABLES", LAYERS), ("ENTITIES", &entities)]);
    let expected = [
        (Some(Rgb([255, 0, 0])), "walls".to_owned(), 24.0),
        (Some(Rgb([0, 0, 255])), "sea".to_owned(), 4.0),
    ];
    assert_eq!(found, expected);
}

#[test]
fn colour_index_7_is_black() {
    let black = |layer: &str, area: f64| [(Some(Rgb([0; 3])), layer.to_owned(), area)];
    let entities = square_on("plain", 0.0, 2.0, "");
    let found = painted(&[("TABLES", LAYERS), ("ENTITIES", &entities)]);
    assert_eq!(found, black("plain", 4.0));
    assert_eq!(painted(&[("ENTITIES", SQUARE)]), black("0", 16.0));
}
