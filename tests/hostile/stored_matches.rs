//! Tests of projects whose stored match was changed: the match is checked, and found anew if it
//! does not fit the designs.

use crate::bounded_run::BoundedFixture;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::read::{ZlibDecoder, ZlibEncoder};
use serde_json::{Value, json};
use std::fs;
use std::io::Read;

/// Writes a project with a stored match of two squares, and returns the match and the text of the
/// file in which it lies.
fn stored_match(fixture: &BoundedFixture) -> (Value, String, String) {
    fixture.write("large.json", "[[0,0],[40,0],[40,40],[0,40]]");
    fixture.write("low.json", "[[0,0],[40,0],[40,30],[0,40]]");
    let new = [
        "new",
        "large.json",
        "low.json",
        "--film",
        "--out",
        "good.morph",
    ];
    assert_eq!(fixture.run_small(&new).code, Some(0));
    let project = fs::read_to_string(fixture.path("good.morph")).expect("written");
    let table: toml::Table = project.parse().expect("TOML");
    let film = table["found"]["film"].as_str().expect("text").to_owned();
    let packed = STANDARD.decode(film.replace('\n', "")).expect("base64");
    let mut bytes = Vec::new();
    let mut decoder = ZlibDecoder::new(packed.as_slice());
    decoder.read_to_end(&mut bytes).expect("compressed bytes");
    let record = rmp_serde::from_slice(&bytes).expect("MessagePack");
    (record, project, film)
}

/// Encodes a match as the program does.
fn encoded(record: &Value) -> String {
    let bytes = rmp_serde::to_vec(record).expect("MessagePack");
    let mut packed = Vec::new();
    let mut encoder = ZlibEncoder::new(bytes.as_slice(), Compression::best());
    encoder.read_to_end(&mut packed).expect("in memory");
    STANDARD.encode(packed)
}

/// Adds a guard to a match, which displaces the first vertex by `by` along x at t = ½.
fn with_guard(record: &Value, by: f64) -> Value {
    let mut record = record.clone();
    record[8] = json!([
        [0.0, 0.5, 1.0],
        [0],
        [[[0.0, 0.0]], [[by, 0.0]], [[0.0, 0.0]]]
    ]);
    record
}

/// Multiplies all coordinates of the mesh of a match, which are in the third field.
fn scaled(record: &Value, by: [f64; 2]) -> Value {
    let mut record = record.clone();
    for design in record[2].as_array_mut().expect("two designs") {
        for point in design.as_array_mut().expect("points") {
            for (axis, by) in by.into_iter().enumerate() {
                point[axis] = json!(point[axis].as_f64().expect("a number") * by);
            }
        }
    }
    record
}

/// Returns the measured frames in the output of `check --json`.
fn samples(output: &str) -> Value {
    let report: Value = serde_json::from_str(output).expect("JSON");
    report["film"]["samples"].clone()
}

#[test]
fn a_stored_match_that_does_not_fit_the_designs_is_found_anew() {
    const NOTICE: &str = "does not belong to its designs";
    let fixture = BoundedFixture::new();
    let (record, project, film) = stored_match(&fixture);
    let report = |name: &str, record: &Value| {
        let text = project.replace(&film, &format!("{}\n", encoded(record)));
        fixture.write(name, text);
        let output = fixture.run_small(&["check", name, "--samples", "3", "--prove", "--json"]);
        assert_eq!(output.code, Some(0), "{name}: {output:?}");
        output.stdout
    };
    let expected = report("good.morph", &record);
    assert!(!expected.contains(NOTICE), "{expected}");
    for (name, record) in [
        ("guard-1e10.morph", with_guard(&record, 1e10)),
        ("guard-1e17.morph", with_guard(&record, 1e17)),
        ("guard-1e30.morph", with_guard(&record, 1e30)),
        ("far.morph", scaled(&record, [1e12, 1e12])),
        ("flat.morph", scaled(&record, [0.5, 0.2])),
    ] {
        let output = report(name, &record);
        assert!(output.contains(NOTICE), "{name}: {output}");
        assert_eq!(samples(&output), samples(&expected), "{name}");
        let picture = format!("{name}.svg");
        let output = fixture.run_small(&["render", name, "--at", "0.5", "--out", &picture]);
        assert_eq!(output.code, Some(0), "{name}: {output:?}");
        assert!(fixture.path(&picture).exists());
    }
}
