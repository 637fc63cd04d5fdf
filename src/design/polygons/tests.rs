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
fn every_plain_form_is_read() {
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
fn geojson_polygons_are_found_wherever_they_lie() {
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
            "1 object of the kind Feature without a geometry was left out",
            "2 objects of the kind Point were left out",
        ]
    );
}

#[test]
fn repairs_are_told() {
    let bow = "[[0,0],[2,2],[2,0],[0,2]]";
    let found = read(&format!("[{bow}, {SQUARE}, {SQUARE}, [[1,1],[2,2]]]")).expect("read");
    let words: Vec<_> = found.notes.iter().map(ToString::to_string).collect();
    assert_eq!(
        words[0],
        "1 crossing of edges was resolved by the even-odd rule"
    );
    assert!(
        words
            .iter()
            .any(|w| w == "1 outline drawn again was left out"),
        "{words:?}"
    );
    assert!(
        words.iter().any(|w| w.contains("encloses nothing")),
        "{words:?}"
    );
}

#[test]
fn each_fault_is_named_with_its_path() {
    for (text, words) in [
        ("[]", "$ is an empty list; give a ring"),
        ("[1, 2]", "$ is a list; give a ring"),
        ("[[0,0],[1,0],[1]]", "$[2] is a list; give a point"),
        (
            "[[0,0],[1,\"a\"],[1,1]]",
            "$[1] is a text; give two numbers",
        ),
        (
            "[[0,0],[1,1e70],[1,1]]",
            "$[1] has a coordinate that is no number from -1e18 to 1e18",
        ),
        ("[[0,0],[1,1e999],[1,1]]", "line 1, column"),
        (
            "{\"rings\": 4}",
            "$.rings is a number; give a list of rings",
        ),
        ("{\"type\": \"Polygon\"}", "$ has no \"coordinates\""),
        ("{\"type\": 7}", "$ is of the type \"\""),
        (
            "{\"type\": \"FeatureCollection\", \"features\": [{\"type\": \"Feature\", \"geometry\": {\"type\": \"Polygon\", \"coordinates\": [[[0,0],[1,0],7]]}}]}",
            "$.features[0].geometry.coordinates[0][2] is a number; give a point",
        ),
        (
            "{\"type\": \"LineString\", \"coordinates\": []}",
            "there is no polygon in the file, only 1 LineString",
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
fn features_keep_the_fill_that_they_name() {
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
    let coats = painted.coats.iter().map(|coat| {
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
    let unseen = "{\"fill\": \"#00f\", \"fill-opacity\": 0}";
    let plain = map(&[feature(SQUARE, unseen), feature(HOLE, "{\"fill\": 7}")]);
    assert_eq!(plain.expect("a map").coats, []);
}
