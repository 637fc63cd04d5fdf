//! Tests of TEXT, MTEXT, ATTRIB and ATTDEF.

use super::*;

/// Text style in the bundled font.
const STYLE: &str = "0 TABLE 2 STYLE 0 STYLE 2 S 3 Roboto-Bold.ttf 41 1 50 0 0 ENDTAB";

/// Imports entities with the text style `S`.
fn lettered(entities: &str) -> ImportedOutlines {
    found_in(&[("TABLES", STYLE), ("ENTITIES", entities)]).expect(entities)
}

fn bounds(entities: &str) -> Bounds {
    lettered(entities).regions.bounds()
}

#[test]
fn text_is_drawn_in_capitals_of_its_height() {
    let found = lettered("0 TEXT 8 0 7 S 10 5 20 7 40 3 1 HE");
    assert_eq!(words(&found), NONE);
    assert_eq!(found.regions.len(), 2);
    assert!(found.paint_layers.iter().all(|layer| layer.is_text));
    let bounds = found.regions.bounds();
    assert!((bounds.size().y - 3.0).abs() < 1e-6, "{}", bounds.size());
    assert!((bounds.min.y - 7.0).abs() < 1e-6 && (5.0..5.5).contains(&bounds.min.x));
}

#[test]
fn text_is_aligned() {
    let plain = bounds("0 TEXT 8 0 7 S 10 0 20 0 40 3 1 HE");
    let width = plain.size().x;
    let aligned = |codes: &str| {
        bounds(&format!(
            "0 TEXT 8 0 7 S 10 90 20 90 11 0 21 0 40 3 1 HE {codes}"
        ))
    };
    let right = aligned("72 2");
    assert!(right.max.x < 0.0 && right.max.x > -0.5);
    let middle = aligned("72 1 73 2");
    assert!(middle.centre().length() < 0.2, "{}", middle.centre());
    let top = aligned("73 3");
    assert!(top.max.y.abs() < 1e-6);
    // Spanned between two points.
    let fit = bounds("0 TEXT 8 0 7 S 10 0 20 0 11 30 21 0 40 3 72 5 1 HE");
    assert!((fit.size().y - 3.0).abs() < 1e-6 && fit.size().x > 27.0);
    let both = bounds("0 TEXT 8 0 7 S 10 0 20 0 11 30 21 0 40 3 72 3 1 HE");
    assert!((both.size().x / both.size().y - width / 3.0).abs() < 1e-6);
}

#[test]
fn text_is_turned_stretched_slanted_and_mirrored() {
    let plain = bounds("0 TEXT 8 0 7 S 10 0 20 0 40 3 1 H");
    let turned = bounds("0 TEXT 8 0 7 S 10 0 20 0 40 3 50 90 1 H");
    assert!((turned.size().x - 3.0).abs() < 1e-6);
    let wide = bounds("0 TEXT 8 0 7 S 10 0 20 0 40 3 41 2 1 H");
    assert!((wide.size().x - 2.0 * plain.size().x).abs() < 1e-6);
    let slanted = bounds("0 TEXT 8 0 7 S 10 0 20 0 40 3 51 45 1 H");
    assert!((slanted.size().x - plain.size().x - 3.0).abs() < 1e-6);
    let mirrored = bounds("0 TEXT 8 0 7 S 10 0 20 0 40 3 71 2 1 H");
    assert!(mirrored.max.x < 0.0);
    let below = bounds("0 TEXT 8 0 7 S 10 0 20 0 40 3 71 4 1 H");
    assert!(below.max.y.abs() < 1e-6);
    let extruded = bounds("0 TEXT 8 0 7 S 10 5 20 0 40 3 210 0 220 0 230 -1 1 H");
    assert!((extruded.max.x + 5.0 + plain.min.x).abs() < 1e-6);
}

#[test]
fn paragraphs_break_and_attach() {
    let two = "0 MTEXT 8 0 7 S 10 0 20 0 40 3 71 1 1 H\\PH";
    let top = bounds(two);
    // Baselines are 5/3 of the height apart.
    assert!(
        top.max.y.abs() < 1e-6 && (top.min.y + 8.0).abs() < 1e-6,
        "{top:?}"
    );
    let middle = bounds(&two.replace("71 1", "71 5"));
    assert!(middle.centre().x.abs() < 0.2);
    let spaced = bounds(&two.replace("71 1", "71 1 44 2"));
    assert!((spaced.min.y + 13.0).abs() < 1e-6);
    let wrapped = bounds(
        "0 MTEXT 8 0 7 S 10 0 20 0 40 3 41 1 71 1 3 H~H 1 H"
            .replace('~', "\\~")
            .as_str(),
    );
    assert!(wrapped.size().y < 3.1, "a fixed space does not break");
    let turned = bounds(&two.replace("71 1", "71 1 11 0 21 1"));
    assert!((turned.size().x - 8.0).abs() < 1e-6);
}

#[test]
fn formatting_and_other_fonts_are_reported() {
    let found = lettered("0 MTEXT 8 0 7 S 10 0 20 0 40 3 1 {\\H2x;H}");
    assert!(words(&found)[0].starts_with("1 MTEXT drawn without its inline formatting"));
    let found = super::found("0 TEXT 8 0 10 0 20 0 40 3 1 H").expect("a letter");
    assert_eq!(
        words(&found),
        ["text in txt drawn in the bundled font; convert text to outlines to keep its shape"]
    );
    let found = lettered("0 TEXT 8 0 7 S 10 0 20 0 40 3 1 H\\U+2603");
    assert!(
        words(&found)[0].starts_with("1 TEXT drawn without 1 characters"),
        "{:?}",
        words(&found)
    );
}

#[test]
fn attributes_are_drawn_instead_of_their_definitions() {
    let block = format!(
        "0 BLOCK 2 B {SQUARE} 0 ATTDEF 8 0 7 S 10 0 20 0 40 3 1 default 2 TAG 70 0 0 ENDBLK"
    );
    let insert = "0 INSERT 8 0 2 B 66 1 0 ATTRIB 8 0 7 S 10 9 20 0 40 3 1 H 2 TAG 70 0
        0 ATTRIB 8 0 7 S 10 20 20 0 40 3 1 H 2 HID 70 1 0 SEQEND 8 0";
    let found = found_in(&[("TABLES", STYLE), ("BLOCKS", &block), ("ENTITIES", insert)]);
    let found = found.expect("a square and a letter");
    assert_eq!(found.regions.len(), 2);
    assert!(found.regions.bounds().max.x < 15.0);
}

#[test]
fn a_label_in_a_frame_is_seen() {
    let frame = square_on("0", 0.0, 20.0, "");
    let found = lettered(&format!("{frame} 0 TEXT 8 0 7 S 10 5 20 5 40 3 1 H"));
    assert_eq!(found.regions.len(), 2);
    assert!(found.regions.area() < 10.0);
}

#[test]
fn frames_backgrounds_and_columns_of_texts_are_reported() {
    let text = |more: &str| format!("0 MTEXT 8 0 10 0 20 0 40 3 1 H {more}");
    for (more, feature) in [
        ("90 1 63 1 45 1.5", "drawn without its background"),
        ("90 16", "drawn without its frame"),
        (
            "101 Embedded_Object 70 1 71 2 72 3",
            "drawn without its columns",
        ),
    ] {
        let words = words(&found(&text(more)).expect("a letter"));
        assert!(words.iter().any(|note| note.contains(feature)), "{words:?}");
    }
    let plain = words(&found(&text("101 Embedded_Object 70 1 71 0")).expect("a letter"));
    assert!(
        !plain.iter().any(|note| note.contains("MTEXT")),
        "{plain:?}"
    );
}
