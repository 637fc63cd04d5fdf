//! GeoJSON, polygons with holes that touch, and OBJ meshes.

use morphospace::design::{Design, DesignForm, ImportOptions, import};

use super::{assert_close, holes, imported, notes, outline, transition};

/// GeoJSON text of features, each with a name and a ring.
fn features(features: &[(&str, &[[f64; 2]])]) -> String {
    let feature = |(name, ring): &(&str, &[[f64; 2]])| {
        let mut ring = ring.to_vec();
        ring.push(ring[0]);
        format!(
            r#"{{"type": "Feature", "properties": {{"name": "{name}"}},
                "geometry": {{"type": "Polygon", "coordinates": [{ring:?}]}}}}"#
        )
    };
    let features: Vec<String> = features.iter().map(feature).collect();
    format!(
        r#"{{"type": "FeatureCollection", "features": [{}]}}"#,
        features.join(", ")
    )
}

/// Names of the paint layers with their areas.
fn named_areas(design: &Design) -> Vec<(&str, f64)> {
    let layers = design.paint_layers.iter();
    layers
        .map(|layer| (layer.name.as_str(), layer.regions.area()))
        .collect()
}

#[test]
fn countries_that_share_borders_keep_their_names_without_colours() {
    let map = features(&[
        (
            "Plain",
            &[[0.0, 0.0], [30.0, 0.0], [25.0, 40.0], [0.0, 40.0]],
        ),
        (
            "Coast",
            &[[30.0, 0.0], [70.0, 0.0], [70.0, 40.0], [25.0, 40.0]],
        ),
    ]);
    let tiles = features(&[
        (
            "Coast",
            &[[40.0, 0.0], [60.0, 0.0], [60.0, 20.0], [40.0, 20.0]],
        ),
        (
            "Plain",
            &[[10.0, 0.0], [30.0, 0.0], [30.0, 20.0], [10.0, 20.0]],
        ),
    ]);
    let [map, tiles] = [map, tiles].map(imported);
    let mut areas = named_areas(&map);
    areas.sort_by(|a, b| a.0.cmp(b.0));
    assert_eq!(areas.len(), 2);
    assert_eq!(areas[0].0, "Coast");
    assert_close(areas[0].1, 1700.0);
    assert_close(areas[1].1, 1100.0);
    // Each country becomes the tile of its name.
    let film = transition(&map, &tiles);
    let frame = film.frame(0.999);
    let figure = frame.figure();
    let mut found: Vec<(String, f64)> = (figure.layers.iter())
        .map(|layer| {
            let points = figure.rings[layer.rings.clone()].iter().flatten();
            let (sum, count) = points.fold((0.0, 0.0), |(sum, n), p| (sum + p.x, n + 1.0));
            (layer.names[0].to_string(), sum / count)
        })
        .collect();
    found.sort_by(|a, b| a.0.cmp(&b.0));
    assert_eq!(found.len(), 2, "{found:?}");
    assert!((found[0].1 - 50.0).abs() < 2.0, "Coast: {found:?}");
    assert!((found[1].1 - 20.0).abs() < 2.0, "Plain: {found:?}");
}

#[test]
fn an_island_on_the_date_line_is_whole_in_both_spellings() {
    // 5 degrees wide and 3 high, with a corner cut off.
    let whole = features(&[(
        "Isle",
        &[
            [178.0, -20.0],
            [-177.0, -20.0],
            [-177.0, -18.0],
            [-178.0, -17.0],
            [178.0, -17.0],
        ],
    )]);
    let split = r#"{"type": "Feature", "properties": {"name": "Isle"}, "geometry": {"type": "MultiPolygon",
        "coordinates": [[[[178, -20], [180, -20], [180, -17], [178, -17], [178, -20]]],
            [[[-180, -20], [-177, -20], [-177, -18], [-178, -17], [-180, -17], [-180, -20]]]]}}"#;
    for text in [whole.as_str(), split] {
        let design = imported(text);
        let found = outline(&design);
        assert_eq!(found.len(), 1);
        assert_close(found.area(), 14.5);
        assert!((found.bounds().size().x - 5.0).abs() < 1e-6);
        let is_reported = |note: &String| note.contains("antimeridian");
        assert!(
            notes(&design).iter().any(is_reported),
            "{:?}",
            notes(&design)
        );
    }
}

#[test]
fn holes_that_touch_in_a_corner_are_holes() {
    // Two holes with a common corner, and a notch with a corner on the side.
    let rings = "[[[0,0],[90,0],[90,60],[0,60]],
        [[10,10],[30,10],[30,25],[10,25]], [[30,25],[50,25],[50,45],[30,45]],
        [[90,30],[70,40],[70,20]]]";
    let found = outline(&imported(rings));
    assert_eq!((found.len(), holes(&found)), (1, 3));
    let exact = 5400.0 - 300.0 - 400.0 - 200.0;
    assert!(
        (found.area() - exact).abs() < 1e-6 * exact,
        "{}",
        found.area()
    );
}

#[test]
fn faces_count_vertices_from_either_end() {
    let vertices = "v 0 0 0\nv 4 0 0\nv 4 1 0\nv 0 1 0\nv 4 3 0\nv 0 3 0\n";
    let forwards = format!("{vertices}f 1 2 3 4\nf 4 3 5\nf 4 5 6\n");
    let backwards = format!("{vertices}f -6 -5 -4 -3\nf -3 -4 -2\nf -3 -2 -1\n");
    let [a, b] = [forwards, backwards].map(imported);
    assert_eq!(a.form, b.form);
    let DesignForm::Mesh(mesh) = &a.form else {
        panic!("a mesh");
    };
    assert_eq!(mesh.positions().len(), 6);
    assert_close(outline(&a).area(), 12.0);
}

#[test]
fn a_concave_face_has_its_area_and_a_crossed_one_is_named() {
    let vertices = "v 0 0 0\nv 6 0 0\nv 6 5 0\nv 4 5 0\nv 4 2 0\nv 0 2 0\n";
    let concave = imported(format!("{vertices}f 1 2 3 4 5 6\n"));
    assert_close(outline(&concave).area(), 18.0);
    let crossed = "v 0 0 0\nv 6 0 0\nv 6 5 0\nv 0 5 0\nf 1 2 3\nf 1 3 2 4\n";
    let error = import("m.obj", crossed.as_bytes(), &ImportOptions::default());
    let message = error.expect_err("a crossed face").to_string();
    assert!(message.contains("line 6"), "{message}");
}
