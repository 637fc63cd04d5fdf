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

/// Returns a feature with one polygon of one ring, `members` and these `properties`.
fn feature(ring: &str, members: &str, properties: &str) -> String {
    let polygon = format!("{{\"type\": \"Polygon\", \"coordinates\": [{ring}]}}");
    format!(
        "{{\"type\": \"Feature\", {members} \"properties\": {properties}, \"geometry\": {polygon}}}"
    )
}

fn collection(features: &[String]) -> ImportedOutlines {
    let features = features.join(",");
    let text = format!("{{\"type\": \"FeatureCollection\", \"features\": [{features}]}}");
    read(&text).expect("a map")
}

#[test]
fn features_keep_their_names_without_a_fill_colour() {
    let map = collection(&[
        feature(SQUARE, "", "{\"name\": \"Lake\"}"),
        feature(HOLE, "", "{\"TITLE\": \"Isle\"}"),
        feature("[[5,0],[6,0],[6,1]]", "\"id\": 7,", "null"),
        feature(
            "[[8,0],[9,0],[9,1]]",
            "\"id\": \"x\",",
            "{\"id\": 4, \"name\": \"\"}",
        ),
    ]);
    let layers: Vec<_> = map.paint_layers.iter().collect();
    let names: Vec<&str> = layers.iter().map(|layer| layer.name.as_str()).collect();
    assert_eq!(names, ["Lake", "Isle", "7", "4"]);
    assert!(layers.iter().all(|layer| layer.paint.is_none()));
    // A map without any name has no layers.
    let nameless = collection(&[feature(SQUARE, "", "{}"), feature(HOLE, "", "null")]);
    assert_eq!(nameless.paint_layers, []);
}

/// Imports the polygons of one feature, each given by the rings of its `coordinates`.
fn islands(polygons: &[&str]) -> ImportedOutlines {
    let polygons = polygons.join(",");
    let text = format!("{{\"type\": \"MultiPolygon\", \"coordinates\": [{polygons}]}}");
    read(&text).expect("islands")
}

/// Returns the notes on an imported map, without those on repairs of outlines.
fn words(map: &ImportedOutlines) -> Vec<String> {
    let is_repair = |note: &&ImportNote| matches!(note, ImportNote::RedundantPoints(_));
    let notes = map.notes.iter().filter(|note| !is_repair(note));
    notes.map(ToString::to_string).collect()
}

const CROSSED: &str = "continued across the antimeridian";

#[test]
fn a_ring_that_steps_over_the_antimeridian_is_one_island() {
    // A kite from 178° to −178°, once in each direction, with a hole west and a hole east of 180°.
    let kite = "[[178,0],[180,-1],[-178,0],[180,1],[178,0]]";
    let reversed = "[[178,0],[180,1],[-178,0],[180,-1],[178,0]]";
    let holes = "[[179,-0.1],[179.5,-0.1],[179.2,0.1]], [[-179,-0.1],[-179.5,-0.1],[-179.2,0.1]]";
    for ring in [kite, reversed] {
        let map = islands(&[&format!("[{ring}, {holes}]")]);
        assert_eq!((map.regions.len(), map.regions.rings().count()), (1, 3));
        assert!((map.regions.area() - (4.0 - 2.0 * 0.05)).abs() < 1e-9);
        assert!((map.extent.min.x - 178.0).abs() + (map.extent.max.x - 182.0).abs() < 1e-9);
        assert!(words(&map)[0].contains(CROSSED), "{:?}", words(&map));
    }
}

#[test]
fn pieces_split_at_the_antimeridian_are_joined() {
    let east = "[[[178,0],[180,-1],[180,1],[178,0]]]";
    let west = "[[[-180,-1],[-178,0],[-180,1],[-180,-1]]]";
    let far = "[[[-179,4],[-178,4],[-178,5],[-179,5]]]";
    let map = islands(&[east, west, far]);
    // The island that lies near the line moves along with the piece.
    assert_eq!(map.regions.len(), 2);
    assert!((map.regions.area() - 5.0).abs() < 1e-9);
    // Most points lie in the west.
    assert_eq!((map.extent.min.x, map.extent.max.x), (-182.0, -178.0));
    assert_eq!(
        words(&map)[0],
        format!("1 outline was {CROSSED} (longitude 180°), so that no shape is cut there")
    );
    // Pieces that do not touch each other have no reason to move.
    let apart = islands(&[east, far]);
    assert_eq!((words(&apart).len(), apart.extent.min.x), (0, -179.0));
}

#[test]
fn a_country_with_islands_beyond_the_antimeridian_stays_together() {
    // Most points lie in the west, so the islands in the east move there.
    let main = "[[[-160,60],[-130,55],[-100,50],[-70,45],[-70,25],[-100,25],[-130,30]]]";
    let cut = [
        "[[[170,52],[180,51],[180,53]]]",
        "[[[-180,51],[-175,52],[-180,53]]]",
    ];
    let map = islands(&[main, cut[0], cut[1]]);
    assert_eq!(map.regions.len(), 2);
    assert_eq!((map.extent.min.x, map.extent.max.x), (-190.0, -70.0));
}

#[test]
fn maps_around_the_globe_and_frames_do_not_change() {
    let frame = "[[[-180,-90],[180,-90],[180,90],[-180,90],[-180,-90]]]";
    let box_of_data = "[[[-179.9,-60],[179.9,-60],[179.9,80],[-179.9,80]]]";
    let ice = "[[[-180,-90],[-180,-80],[-60,-70],[60,-75],[180,-80],[180,-90],[-180,-90]]]";
    for (text, area) in [(frame, 360.0 * 180.0), (box_of_data, 359.8 * 140.0)] {
        let map = islands(&[text]);
        assert!((map.regions.area() - area).abs() < 1e-6);
        assert_eq!(words(&map), [] as [&str; 0]);
    }
    let map = islands(&[ice]);
    assert_eq!((map.extent.min.x, map.extent.max.x), (-180.0, 180.0));
    assert_eq!(words(&map), [] as [&str; 0]);
    // Pieces of another land at the line have no other place to cut the map, either.
    let pieces = [
        "[[[170,60],[180,60],[180,70]]]",
        "[[[-180,60],[-170,60],[-180,70]]]",
    ];
    let map = islands(&[ice, pieces[0], pieces[1]]);
    assert_eq!((map.extent.min.x, map.extent.max.x), (-180.0, 180.0));
    assert!(words(&map)[0].contains("reaches around the globe"));
}

#[test]
fn a_ring_around_a_pole_is_closed_along_the_pole() {
    let open = islands(&["[[[-180,-70],[-60,-70],[60,-70],[180,-70],[-180,-70]]]"]);
    assert!((open.regions.area() - 360.0 * 20.0).abs() < 1e-6);
    assert_eq!(
        words(&open),
        ["1 outline around a pole was closed along the pole"]
    );
    let inner = islands(&["[[[-90,80],[0,80],[90,80],[170,80],[-170,80]]]"]);
    assert!((inner.regions.area() - 360.0 * 10.0).abs() < 1e-6);
}

#[test]
fn coordinates_that_are_no_degrees_are_not_joined() {
    let plan = "[[[170,0],[172,-1],[-178,0],[172,100]]]";
    let map = islands(&[plan]);
    assert_eq!((words(&map).len(), map.extent.min.x), (0, -178.0));
    // Plain lists of points are no longitudes and latitudes.
    let plain = read("[[178,0],[180,-1],[-178,0],[180,1]]").expect("a ring");
    assert_eq!(plain.extent.min.x, -178.0);
}
