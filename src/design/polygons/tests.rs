//! Tests of the polygon importer: plain JSON, GeoJSON, repairs, errors and fill colours.

use super::*;

const SQUARE: &str = "[[0,0],[4,0],[4,4],[0,4],[0,0]]";
const HOLE: &str = "[[1,1],[3,1],[3,3],[1,3]]";

fn area(text: &str) -> f64 {
    read(text).expect(text).regions.area()
}

fn error(text: &str) -> String {
    read(text).err().expect(text).to_string()
}

#[test]
fn every_plain_structure_is_imported() {
    for (text, expected) in [
        (SQUARE.to_owned(), 16.0),
        (format!("[{SQUARE}, {HOLE}]"), 12.0),
        (format!("[[{SQUARE}, {HOLE}], [{HOLE}]]"), 16.0),
        (
            format!("{{\"name\": \"a\", \"rings\": [{SQUARE}, {HOLE}]}}"),
            12.0,
        ),
        (format!("{{\"polygons\": [[{SQUARE}], [{HOLE}]]}}"), 16.0),
    ] {
        assert!((area(&text) - expected).abs() < 1e-9, "{text}");
        assert_eq!(read(&text).expect("read").notes, [], "{text}");
    }
}

#[test]
fn geojson_polygons_are_imported_at_any_depth() {
    let polygon = format!("{{\"type\": \"Polygon\", \"coordinates\": [{SQUARE}, {HOLE}]}}");
    let multi = format!("{{\"type\": \"MultiPolygon\", \"coordinates\": [[{SQUARE}],[{HOLE}]]}}");
    let point = "{\"type\": \"Point\", \"coordinates\": [1, 2, 3]}";
    let both =
        format!("{{\"type\": \"GeometryCollection\", \"geometries\": [{polygon}, {point}]}}");
    let feature = |geometry: &str| {
        format!("{{\"type\": \"Feature\", \"properties\": {{}}, \"geometry\": {geometry}}}")
    };
    let all = [feature(&both), feature("null"), feature(point)].join(",");
    let collection = format!("{{\"type\": \"FeatureCollection\", \"features\": [{all}]}}");
    assert!((area(&polygon) - 12.0).abs() < 1e-9);
    assert!((area(&multi) - 16.0).abs() < 1e-9);
    assert!((area(&both) - 12.0).abs() < 1e-9);
    assert!((area(&collection) - 12.0).abs() < 1e-9);
    let notes = read(&collection).expect("read").notes;
    let words: Vec<_> = notes.iter().map(ToString::to_string).collect();
    assert_eq!(
        words,
        [
            "1 object of type Feature without a geometry was ignored",
            "2 objects of type Point were ignored",
        ]
    );
}

#[test]
fn repairs_are_reported() {
    let bow = "[[0,0],[2,2],[2,0],[0,2]]";
    let found = read(&format!("[{bow}, {SQUARE}, {SQUARE}, [[1,1],[2,2]]]")).expect("read");
    let words: Vec<_> = found.notes.iter().map(ToString::to_string).collect();
    assert_eq!(
        words[0],
        "1 edge crossing was resolved by the even-odd rule"
    );
    assert!(
        words.iter().any(|w| w == "1 duplicate outline was ignored"),
        "{words:?}"
    );
    assert!(
        words.iter().any(|w| w.contains("encloses no area")),
        "{words:?}"
    );
}

#[test]
fn each_fault_is_reported_with_its_path() {
    for (text, words) in [
        ("[]", "$ is an empty list; give a ring"),
        ("[1, 2]", "$ is a list; give a ring"),
        ("[[0,0],[1,0],[1]]", "$[2] is a list; give a point"),
        (
            "[[0,0],[1,\"a\"],[1,1]]",
            "$[1] is a string; give two numbers",
        ),
        (
            "[[0,0],[1,1e70],[1,1]]",
            "$[1] has a coordinate that is not a number between -1e18 and 1e18",
        ),
        ("[[0,0],[1,1e999],[1,1]]", "line 1, column"),
        (
            "{\"rings\": 4}",
            "$.rings is a number; give a list of rings",
        ),
        ("{\"type\": \"Polygon\"}", "$ has no \"coordinates\""),
        ("{\"type\": 7}", "$ has the type \"\""),
        (
            "{\"type\": \"FeatureCollection\", \"features\": [{\"type\": \"Feature\", \"geometry\": {\"type\": \"Polygon\", \"coordinates\": [[[0,0],[1,0],7]]}}]}",
            "$.features[0].geometry.coordinates[0][2] is a number; give a point",
        ),
        (
            "{\"type\": \"LineString\", \"coordinates\": []}",
            "the file has no polygons, only 1 LineString",
        ),
        ("[[0,0],[1,1],[2,2]]", "enclose no area"),
        (
            &"[".repeat(5000),
            "line 1, column 128: recursion limit exceeded",
        ),
    ] {
        assert!(error(text).contains(words), "{text:.40}: {}", error(text));
    }
}

#[test]
fn features_keep_their_fill_colour() {
    let feature = |ring: &str, properties: &str| {
        let polygon = format!("{{\"type\": \"Polygon\", \"coordinates\": [{ring}]}}");
        format!("{{\"type\": \"Feature\", \"properties\": {properties}, \"geometry\": {polygon}}}")
    };
    let map = |features: &[String]| {
        let features = features.join(",");
        read(&format!(
            "{{\"type\": \"FeatureCollection\", \"features\": [{features}]}}"
        ))
    };
    let painted = map(&[
        feature(SQUARE, "{\"fill\": \"#00f\", \"name\": \"sea\"}"),
        feature(HOLE, "{\"fill\": \"ff0000\", \"fill-opacity\": 0.5}"),
    ])
    .expect("a map");
    let coats = painted.paint_layers.iter().map(|coat| {
        let paint = coat.paint.expect("a paint");
        (
            paint.colour.0,
            paint.opacity,
            coat.name.as_str(),
            coat.regions.area(),
        )
    });
    let expected = [([0, 0, 255], 1.0, "sea", 16.0), ([255, 0, 0], 0.5, "", 4.0)];
    assert!(coats.eq(expected));
    let transparent = "{\"fill\": \"#00f\", \"fill-opacity\": 0}";
    let plain = map(&[feature(SQUARE, transparent), feature(HOLE, "{\"fill\": 7}")]);
    assert_eq!(plain.expect("a map").paint_layers, []);
}
