//! Tests of lines: which curves are lines and which are outlines, their widths, units, layer
//! states and dimensions.

use super::*;
use crate::design::unit::LengthUnit;

/// Returns lines through the given points on layer 0.
fn lines(points: &[(i32, i32)]) -> String {
    let line = |ends: &[(i32, i32)]| {
        let [(a, b), (c, d)] = [ends[0], ends[1]];
        format!("0 LINE 8 0 10 {a} 20 {b} 11 {c} 21 {d} ")
    };
    points.windows(2).map(line).collect()
}

const FRAME: [(i32, i32); 5] = [(0, 0), (100, 0), (100, 60), (0, 60), (0, 0)];

#[test]
fn a_plan_drawn_in_lines_stays_lines() {
    // Walls that end between the corners of others, at their corners, and not at all.
    for walls in [
        lines(&[(40, 0), (40, 60)]),
        lines(&[(0, 0), (100, 60)]),
        lines(&[(20, 20), (50, 30), (70, 20)]),
    ] {
        for frame in [
            lines(&FRAME),
            "0 LWPOLYLINE 8 0 90 4 70 1 10 0 20 0 10 100 20 0 10 100 20 60 10 0 20 60 ".to_owned(),
        ] {
            let found = found(&format!("{frame}{walls}")).expect("lines");
            let length = 320.0 + 120.0;
            assert!(
                found.regions.area() < 0.1 * length,
                "{}",
                found.regions.area()
            );
            assert!(
                found
                    .regions
                    .bounds()
                    .size()
                    .distance(DVec2::new(100.1, 60.1))
                    < 1e-3
            );
        }
    }
}

#[test]
fn outlines_that_hide_nothing_stay_filled() {
    // An open line outside, one that only touches the outline, and one in a hole of it.
    for line in [
        lines(&[(120, 0), (130, 10)]),
        lines(&[(100, 30), (150, 30)]),
        lines(&[(30, 25), (40, 35)]),
    ] {
        let hole = lines(&[(20, 20), (50, 20), (50, 40), (20, 40), (20, 20)]);
        let found = found(&format!("{}{hole}{line}", lines(&FRAME))).expect("a frame");
        let area = found.regions.area();
        assert!((5400.0..5420.0).contains(&area), "{area}");
    }
    // The hatch of an outline covers it; a hatch in a part of it would be hidden.
    let hatch = |right: i32| {
        format!(
            "0 HATCH 8 0 2 SOLID 70 1 91 1 92 3 72 0 73 1 93 4
             10 0 20 0 10 {right} 20 0 10 {right} 20 60 10 0 20 60 97 0 75 0 "
        )
    };
    let whole = found(&format!("{}{}", lines(&FRAME), hatch(100))).expect("a frame");
    assert_near(whole.regions.area(), 6000.0);
    let half = found(&format!("{}{}", lines(&FRAME), hatch(50))).expect("a frame");
    assert!((3000.0..3050.0).contains(&half.regions.area()));
    assert!(
        words(&half)[0].starts_with("1 closed outline drawn as a line"),
        "{:?}",
        words(&half)
    );
}

#[test]
fn only_outlines_around_lines_become_lines() {
    let square = lines(&[(200, 0), (220, 0), (220, 20), (200, 20), (200, 0)]);
    let entities = format!("{}{}{square}", lines(&FRAME), lines(&[(40, 10), (40, 50)]));
    let found = found(&entities).expect("lines and a square");
    assert!((400.0..550.0).contains(&found.regions.area()));
    assert_eq!(
        words(&found),
        [
            "1 open line drawn as strokes, 0.22 drawing units wide; close them to fill their area",
            "1 closed outline drawn as a line, because a fill would hide what is drawn inside it",
        ]
    );
}

#[test]
fn lines_can_be_left_out_of_the_silhouette() {
    let file = text(&[(
        "ENTITIES",
        &format!("{SQUARE} {}", lines(&[(9, 0), (9, 9)])),
    )]);
    let options = ImportOptions {
        strokes: false,
        ..ImportOptions::default()
    };
    let found = read(file.as_bytes(), &options).expect("a square").outlines;
    assert_near(found.regions.area(), 16.0);
    assert_eq!(words(&found), [ImportNote::Strokes(1).to_string()]);
    assert_eq!(found.paint_layers.len(), 2);
}

/// Imports a drawing of one horizontal line of the length 100 on the layer `pen`, whose line weight
/// is 1.4 mm, with the code `unit` of the drawing unit and more pairs for the line. Returns the
/// unit and the height of the drawing.
fn line_in(unit: u32, more: &str) -> (Option<LengthUnit>, f64) {
    let file = text(&[
        (
            "HEADER",
            &format!("9 $ACADVER 1 AC1015 9 $INSUNITS 70 {unit}"),
        ),
        (
            "TABLES",
            "0 TABLE 2 LAYER 0 LAYER 2 pen 62 7 370 140 0 ENDTAB",
        ),
        (
            "ENTITIES",
            &format!("0 LINE 8 pen {more} 10 0 20 0 11 100 21 0"),
        ),
    ]);
    let import = read(file.as_bytes(), &ImportOptions::default()).expect("a line");
    (import.unit, import.outlines.regions.bounds().size().y)
}

#[test]
fn lines_are_as_wide_as_their_line_weight() {
    let assert_width = |unit, more, expected: f64| {
        let (_, width) = line_in(unit, more);
        assert!(
            (width - expected).abs() < 1e-3 * expected,
            "{unit} {more}: {width}"
        );
    };
    assert_eq!(line_in(4, "").0, Some(LengthUnit::Millimetre));
    assert_eq!(line_in(0, "").0, None);
    assert_width(4, "370 200", 2.0);
    assert_width(4, "370 -1", 1.4);
    assert_width(4, "370 -3", 0.25);
    assert_width(5, "", 0.14);
    // In metres, a line weight is less than a hair, so all line weights are scaled.
    assert_width(6, "370 -3", 0.1);
    assert_width(6, "370 50", 0.2);
    assert_width(6, "370 5", 0.1);
    assert_width(0, "370 50", 0.2);
}

#[test]
fn dashes_are_drawn_solid_and_reported() {
    let entities = format!(
        "{SQUARE} 0 LINE 8 0 6 Hidden 10 9 20 0 11 9 21 9 0 LINE 8 0 6 Continuous 10 8 20 0 11 8 21 9"
    );
    let found = found(&entities).expect("lines");
    assert_eq!(
        words(&found)[1],
        "1 line drawn solid instead of with the line type HIDDEN"
    );
}

/// Table of layers that are off, frozen, locked and on.
const STATES: &str = "0 TABLE 2 LAYER 0 LAYER 2 OFF 70 0 62 -7 0 LAYER 2 ICE 70 1 62 7
    0 LAYER 2 LOCK 70 4 62 1 0 LAYER 2 ON 70 0 62 1 0 ENDTAB";

#[test]
fn block_references_on_hidden_layers_hide_what_inherits_the_layer() {
    let block =
        "0 BLOCK 2 B 0 CIRCLE 8 0 40 1 0 CIRCLE 8 on 10 9 40 2 0 CIRCLE 8 OFF 10 20 40 3 0 ENDBLK";
    // A layer that is off hides the entities that inherit it; a frozen one hides the whole block.
    for (layer, area) in [("ON", 5.0), ("Lock", 5.0), ("off", 4.0), ("new", 5.0)] {
        let insert = format!("0 INSERT 8 {layer} 2 b");
        let found = found_in(&[("TABLES", STATES), ("BLOCKS", block), ("ENTITIES", &insert)]);
        assert_near(found.expect(layer).regions.area(), area * PI);
    }
    let frozen = found_in(&[
        ("TABLES", STATES),
        ("BLOCKS", block),
        ("ENTITIES", "0 INSERT 8 ICE 2 B"),
    ]);
    assert!(frozen.is_err());
}

#[test]
fn names_of_layers_are_read_in_any_case_and_encoding() {
    let tables = "0 TABLE 2 LAYER 0 LAYER 2 W\\U+00E4nde 62 1 0 ENDTAB";
    let entities = square_on("W\\U+00E4NDE", 0.0, 2.0, "").replace("NDE", "nde");
    let found = painted(&[("TABLES", tables), ("ENTITIES", &entities)]);
    assert_eq!(found, [(Some(Rgb([255, 0, 0])), "Wände".to_owned(), 4.0)]);
    let mut file = text(&[
        ("HEADER", "9 $DWGCODEPAGE 3 ANSI_1251"),
        ("ENTITIES", &square_on("X", 0.0, 2.0, "")),
    ])
    .into_bytes();
    let at = file
        .iter()
        .position(|&byte| byte == b'X')
        .expect("the layer");
    file[at] = 0xd1;
    let found = read_with(&file, 1e-5).expect("a square");
    assert!(words(&found)[0].starts_with("the code page ANSI_1251 is read as Western European"));
}

#[test]
fn mirrored_blocks_lie_where_their_extrusion_says() {
    let block = format!("0 BLOCK 2 B 10 1 20 0 {SQUARE} 0 ENDBLK");
    let insert = "0 INSERT 8 0 2 B 10 10 20 0 41 2 210 0 220 0 230 -1";
    let found = found_in(&[("BLOCKS", &block), ("ENTITIES", insert)]).expect("a square");
    let bounds = found.regions.bounds();
    // In mirrored coordinates, the square reaches from 10 - 2 to 10 + 6.
    assert!((bounds.min.x + 16.0).abs() < 1e-9 && (bounds.max.x + 8.0).abs() < 1e-9);
}

#[test]
fn dimensions_and_tables_draw_their_blocks() {
    let block = "0 BLOCK 2 *D1 0 LINE 8 0 10 0 20 0 11 9 21 0 0 SOLID 8 0 10 0 20 0 11 3 21 1 12 3 22 -1 0 ENDBLK";
    for entity in [
        "0 DIMENSION 8 0 2 *D1 70 32",
        "0 ACAD_TABLE 8 0 2 *D1 10 5 20 5",
    ] {
        let found = found_in(&[("BLOCKS", block), ("ENTITIES", entity)]).expect(entity);
        assert!(found.regions.area() > 3.0);
        assert_eq!(words(&found).len(), 1, "{:?}", words(&found));
    }
    let missing = found(&format!("{SQUARE} 0 DIMENSION 8 0 70 32")).expect("a square");
    assert!(words(&missing)[0].starts_with("1 DIMENSION left out: it has no block"));
}

#[test]
fn leaders_and_multilines_are_lines() {
    let leader = "0 LEADER 8 0 71 1 72 0 76 3 10 0 20 0 10 5 20 5 10 9 20 5";
    let found = found(leader).expect("a line");
    assert!(words(&found)[1].starts_with("1 LEADER drawn without its arrow"));
    let multiline = "0 MLINE 8 0 2 STANDARD 70 1 71 1 72 2 73 2
        11 0 21 0 12 1 22 0 13 0 23 1 74 2 41 0 41 0 75 0 74 2 41 -2 41 0 75 0
        11 9 21 0 12 1 22 0 13 0 23 1 74 2 41 0 41 0 75 0 74 2 41 -2 41 0 75 0";
    let found = super::found(multiline).expect("two lines");
    assert_eq!(found.regions.len(), 2);
    assert!((found.regions.bounds().size().y - 2.009).abs() < 1e-9);
    assert_eq!(words(&found).len(), 1, "{:?}", words(&found));
}
