//! Tests of filled areas: hatches, solids, polylines with a width, duplicates and opacity.

use super::*;

/// Returns a boundary loop of a hatch: a circle as a polyline of two half circles.
fn circle_loop(flags: u32, x: f64, radius: f64) -> String {
    let (left, right) = (x - radius, x + radius);
    format!("92 {flags} 72 1 73 1 93 2 10 {left} 20 0 42 1 10 {right} 20 0 42 1 97 0 ")
}

/// Returns a solid hatch with the given style and loops.
fn hatch(style: u32, loops: &[String]) -> String {
    let count = loops.len();
    let loops = loops.concat();
    format!(
        "0 HATCH 8 0 10 0 20 0 30 0 210 0 220 0 230 1 2 SOLID 70 1 71 0
         91 {count} {loops} 75 {style} 76 1 98 0 "
    )
}

#[test]
fn a_hatch_has_holes_and_a_solid_is_no_bow_tie() {
    let donut = hatch(0, &[circle_loop(3, 30.0, 14.0), circle_loop(18, 30.0, 6.0)]);
    let solid = "0 SOLID 8 0 10 70 20 10 11 95 21 10 12 70 22 46 13 95 23 46";
    let found = found(&format!("{donut} {solid}")).expect("fills");
    assert_eq!(words(&found), NONE);
    assert_eq!((found.regions.len(), found.regions.rings().count()), (2, 3));
    let areas: Vec<f64> = found.regions.iter().map(|piece| piece.area()).collect();
    let ring = 160.0 * PI;
    assert!(
        areas.iter().any(|area| (area - ring).abs() < 1e-3 * ring),
        "{areas:?}"
    );
    assert!(
        areas.iter().any(|area| (area - 900.0).abs() < 1e-9),
        "{areas:?}"
    );
}

#[test]
fn the_style_of_a_hatch_decides_which_loops_count() {
    let loops = [
        circle_loop(3, 0.0, 9.0),
        circle_loop(18, 0.0, 6.0),
        circle_loop(2, 0.0, 3.0),
    ];
    for (style, area) in [(0, 81.0 - 36.0 + 9.0), (1, 81.0 - 36.0), (2, 81.0)] {
        assert_near(regions(&hatch(style, &loops)).area(), area * PI);
    }
    let text_box = [circle_loop(3, 0.0, 9.0), circle_loop(10, 0.0, 6.0)];
    assert_near(regions(&hatch(0, &text_box)).area(), 81.0 * PI);
    // If no loop is marked, all count.
    let unmarked = [circle_loop(2, 0.0, 9.0)];
    assert_near(regions(&hatch(1, &unmarked)).area(), 81.0 * PI);
}

#[test]
fn all_edges_of_a_hatch_are_read() {
    // A clockwise arc is given by clockwise angles: this one runs from (0, 2) through (2, 0).
    let clockwise = "92 1 93 3 72 2 10 0 20 0 40 2 50 270 51 0 73 0
        72 1 10 2 20 0 11 0 21 0 72 1 10 0 20 0 11 0 21 2 97 0 ";
    let ellipse = "92 1 93 1 72 3 10 0 20 0 11 3 21 0 40 0.5 50 0 51 360 73 1 97 0 ";
    // Angles of an elliptical arc are seen from the centre; 45 degrees on an ellipse of ratio 1/2
    // is not an eighth of the area of the whole.
    let sector = "92 1 93 3 72 3 10 0 20 0 11 2 21 0 40 0.5 50 0 51 45 73 1
        72 1 10 0.894427190999916 20 0.894427190999916 11 0 21 0 72 1 10 0 20 0 11 2 21 0 97 0 ";
    let spline = "92 1 93 2 72 4 94 2 73 0 74 0 95 6 96 3 40 0 40 0 40 0 40 1 40 1 40 1
        10 0 20 0 10 3 20 4 10 6 20 0 97 0 72 1 10 6 20 0 11 0 21 0 97 0 ";
    // Edges in any direction, and two closed edges in one loop.
    let reversed = "92 1 93 4 72 1 10 0 20 0 11 4 21 0 72 1 10 4 20 3 11 4 21 0
        72 1 10 4 20 3 11 0 21 3 72 1 10 0 20 0 11 0 21 3 97 0 ";
    let circles = "92 1 93 2 72 2 10 0 20 0 40 2 50 0 51 360 73 1
        72 2 10 0 20 0 40 1 50 0 51 360 73 1 97 0 ";
    for (edges, area) in [
        (clockwise, PI),
        (ellipse, 4.5 * PI),
        (sector, 2.0_f64.atan()),
        (spline, 8.0),
        (reversed, 12.0),
        (circles, 3.0 * PI),
    ] {
        let found = found(&hatch(0, &[edges.to_owned()])).expect(edges);
        assert_near(found.regions.area(), area);
        assert_eq!(words(&found), NONE, "{edges}");
    }
}

#[test]
fn patterns_and_gradients_are_filled_flat_and_reported() {
    let square = "91 1 92 3 72 0 73 1 93 4 10 0 20 0 10 2 20 0 10 2 20 2 10 0 20 2 97 0 75 0";
    let pattern = format!("0 HATCH 8 0 2 ANSI31 70 0 {square} 76 1 52 0 41 1 78 1");
    let found = found(&pattern).expect("a square");
    assert_near(found.regions.area(), 4.0);
    assert_eq!(
        words(&found),
        ["1 HATCH filled flat instead of with the pattern ANSI31 (line 6, layer 0)"]
    );
    let gradient = format!(
        "0 HATCH 8 0 2 SOLID 70 1 {square} 450 1 453 2 463 0 421 255 463 1 421 16711680 470 LINEAR"
    );
    let found = super::found(&gradient).expect("a square");
    assert!(words(&found)[0].starts_with("1 HATCH filled with the mean colour of the gradient"));
    let paint = found.paint_layers[0].paint.expect("a paint");
    assert_eq!(paint.colour, Rgb([128, 0, 128]));
}

#[test]
fn a_mirrored_hatch_lies_where_its_extrusion_says() {
    let entity = hatch(0, &[circle_loop(3, 5.0, 2.0)]).replace("230 1", "230 -1");
    let bounds = regions(&entity).bounds();
    assert!((bounds.min.x + 7.0).abs() < 1e-9 && (bounds.max.x + 3.0).abs() < 1e-9);
}

#[test]
fn faces_and_flat_solids_are_drawn() {
    let face = "0 3DFACE 8 0 10 0 20 0 30 5 11 4 21 0 31 5 12 4 22 3 32 5 13 0 23 3 33 5";
    assert_near(regions(face).area(), 12.0);
    let triangle = "0 SOLID 8 0 10 0 20 0 11 4 21 0 12 0 22 3";
    assert_near(regions(triangle).area(), 6.0);
    // A face that is seen from its edge is a line.
    let edge = found("0 3DFACE 8 0 10 0 20 0 11 4 21 0 12 4 22 0 32 3 13 0 23 0 33 3");
    assert!(words(&edge.expect("a line"))[0].starts_with("1 open line drawn as strokes"));
}

#[test]
fn polylines_with_a_width_are_bands() {
    let donut = "0 LWPOLYLINE 8 0 90 2 70 1 43 2 10 -5 20 0 42 1 10 5 20 0 42 1";
    let found = regions(donut);
    assert_eq!(found.rings().count(), 2);
    assert_near(found.area(), 20.0 * PI);
    // A corner is pointed, ends are cut off.
    let corner = "0 LWPOLYLINE 8 0 90 3 43 2 10 0 20 0 10 10 20 0 10 10 20 8";
    assert_near(regions(corner).area(), 2.0 * 11.0 + 2.0 * 7.0);
    let taper = "0 LWPOLYLINE 8 0 90 2 10 0 20 0 40 0 41 4 10 10 20 0";
    assert_near(regions(taper).area(), 20.0);
    // An arc of a constant width is a ring sector; one of a changing width has no gaps either.
    let arc = "0 LWPOLYLINE 8 0 90 2 10 -5 20 0 40 1 41 3 42 1 10 5 20 0";
    let found = regions(arc);
    assert_eq!((found.len(), found.rings().count()), (1, 1));
    assert_near(found.area(), 10.0 * PI);
    let old =
        "0 POLYLINE 8 0 66 1 40 2 41 2 0 VERTEX 8 0 10 0 20 0 0 VERTEX 8 0 10 9 20 0 0 SEQEND";
    assert_near(regions(old).area(), 18.0);
}

#[test]
fn a_band_in_a_block_is_scaled_with_the_block() {
    let block = "0 BLOCK 2 W 0 LWPOLYLINE 8 0 90 2 43 1 10 0 20 0 10 4 20 0 0 ENDBLK";
    let insert = "0 INSERT 8 0 2 W 41 -2 42 3";
    let found = found_in(&[("BLOCKS", block), ("ENTITIES", insert)]).expect("a band");
    assert_near(found.regions.area(), 8.0 * 3.0);
}

#[test]
fn an_outline_drawn_twice_keeps_its_paint_layer() {
    let twice = [
        square_on("walls", 0.0, 4.0, ""),
        square_on("walls", 0.0, 4.0, ""),
    ]
    .concat();
    let red = Some(Rgb([255, 0, 0]));
    let found = painted(&[("TABLES", LAYERS), ("ENTITIES", &twice)]);
    assert_eq!(found, [(red, "walls".to_owned(), 16.0)]);
    // A circle, and the same circle as two arcs that are flattened at other points.
    let circles = "0 CIRCLE 8 walls 10 0 20 0 40 4
        0 LWPOLYLINE 8 walls 90 2 70 1 10 2.4 20 3.2 42 1 10 -2.4 20 -3.2 42 1";
    let found = painted(&[("TABLES", LAYERS), ("ENTITIES", circles)]);
    assert_eq!(found, [(red, "walls".to_owned(), (16.0 * PI).round())]);
}

#[test]
fn of_equal_outlines_on_two_layers_the_later_is_seen() {
    // Two circles, once as a circle and once as two arcs, apart from a square.
    let circle = "0 CIRCLE 8 below 62 1 10 0 20 0 40 4 ";
    let arcs = "0 LWPOLYLINE 8 above 62 5 90 2 70 1 10 2.4 20 3.2 42 1 10 -2.4 20 -3.2 42 1 ";
    let square = square_on("0", 20.0, 4.0, "");
    let area = (16.0 * PI).round();
    for (entities, colour, [hidden, seen]) in [
        ([circle, arcs], [0, 0, 255], ["below", "above"]),
        ([arcs, circle], [255, 0, 0], ["above", "below"]),
    ] {
        let entities = format!("{}{square}", entities.concat());
        let layers = painted(&[("ENTITIES", &entities)]);
        let round = layers.iter().filter(|layer| layer.2 != 16.0);
        let round: Vec<_> = round.cloned().collect();
        assert_eq!(round, [(Some(Rgb(colour)), seen.to_owned(), area)]);
        assert_eq!(
            words(&found(&entities).expect("two pieces")),
            [format!(
                "1 closed outline hidden by equal ones drawn later, such as on layer {hidden} by one on layer {seen}"
            )]
        );
    }
    // A translucent outline hides nothing.
    let glass = format!("{circle}{}", arcs.replace("62 5", "62 5 440 33554559"));
    assert_eq!(painted(&[("ENTITIES", &glass)]).len(), 2);
}

#[test]
fn an_outline_does_not_hide_a_hatch_of_another_colour() {
    let outline = "0 LWPOLYLINE 8 walls 90 4 70 1 10 0 20 0 10 30 20 0 10 30 20 20 10 0 20 20 ";
    let hatch = "0 HATCH 8 floor 62 1 2 SOLID 70 1 91 1 92 3 72 0 73 1 93 4
        10 0 20 0 10 30 20 0 10 30 20 20 10 0 20 20 97 0 75 0 ";
    for entities in [[outline, hatch], [hatch, outline]] {
        let found = found(&entities.concat()).expect("a hatch");
        let layers: Vec<(&str, f64)> = found
            .paint_layers
            .iter()
            .map(|layer| (layer.name.as_str(), layer.regions.area()))
            .collect();
        assert_eq!((layers[0].0, layers[1].0), ("floor", "walls"));
        assert_near(layers[0].1, 600.0);
        assert!(layers[1].1 < 10.0, "the outline is a line: {layers:?}");
        assert!(
            words(&found)
                .iter()
                .any(|note| note.starts_with("1 closed outline drawn as a line")),
            "{:?}",
            words(&found)
        );
    }
    // Of the same colour, they are one area.
    let same = format!("{outline}{}", hatch.replace("62 1", ""));
    let found = found(&same).expect("a hatch");
    assert_near(found.regions.area(), 600.0);
    assert_eq!(words(&found), NONE);
}

#[test]
fn filled_outlines_are_reported() {
    let circle = "0 CIRCLE 8 posts 10 0 20 0 40 4 ";
    let filled = |entities: &str| -> Vec<String> {
        let notes = found(entities).expect("a shape").notes;
        notes.iter().map(ToString::to_string).collect()
    };
    assert_eq!(
        filled(circle),
        ["1 closed outline on layer posts filled; DXF programs draw it as a line"]
    );
    assert_eq!(
        filled(&format!("{SQUARE} 0 CIRCLE 8 posts 10 20 20 0 40 4")),
        ["2 closed outlines filled, the first on layer 0; DXF programs draw them as lines"]
    );
    // The outline of a hatch in the same colour is not seen.
    let hatch = hatch(0, &[circle_loop(3, 0.0, 4.0)]).replace("8 0", "8 posts");
    assert_eq!(filled(&format!("{circle}{hatch}")), NONE);
}

#[test]
fn of_equal_hatches_the_later_is_seen() {
    let hatch = |layer: &str, colour: u32| {
        hatch(0, &[circle_loop(3, 0.0, 5.0)]).replace("8 0 ", &format!("8 {layer} 62 {colour} "))
    };
    for [first, second] in [["a", "b"], ["b", "a"]] {
        let entities = format!("{}{}", hatch(first, 1), hatch(second, 5));
        let layers = painted(&[("ENTITIES", &entities)]);
        let names: Vec<&str> = layers.iter().map(|layer| layer.1.as_str()).collect();
        assert_eq!(names, [first, second]);
    }
}

/// Returns a square solid with the lower left corner (x, y).
fn solid(more: &str, [x, y, side]: [f64; 3]) -> String {
    let (right, top) = (x + side, y + side);
    format!(
        "0 SOLID 8 0 {more} 10 {x} 20 {y} 11 {right} 21 {y} 12 {x} 22 {top} 13 {right} 23 {top} "
    )
}

/// Returns for each colour index the visible area of its paint layers, the lowest first.
fn visible(found: &ImportedOutlines) -> Vec<(Rgb, f64)> {
    let layers = found.paint_layers.iter().enumerate().map(|(k, layer)| {
        let above = found.paint_layers[k + 1..].iter();
        let above = above.flat_map(|upper| upper.regions.rings());
        let above = above.map(|ring| ring.points().to_vec()).collect();
        let own = layer.regions.rings().map(|ring| ring.points().to_vec());
        let seen = crate::design::svg::boolean(
            &own.collect(),
            &above,
            i_overlay::core::overlay_rule::OverlayRule::Difference,
        );
        let area = seen.iter().map(|ring| crate::geometry::signed_area(ring));
        let colour = layer.paint.expect("a paint").colour;
        (colour, (area.sum::<f64>().abs() * 100.0).round() / 100.0)
    });
    layers.collect()
}

#[test]
fn later_fills_cover_earlier_ones() {
    let (red, blue) = (Rgb([255, 0, 0]), Rgb([0, 0, 255]));
    let small = |colour: u32| solid(&format!("62 {colour}"), [10.0, 10.0, 6.0]);
    let large = |colour: u32| solid(&format!("62 {colour}"), [0.0, 0.0, 14.0]);
    for (first, second, expected) in [
        (small(1), large(5), [(red, 20.0), (blue, 196.0)]),
        (large(5), small(1), [(blue, 180.0), (red, 36.0)]),
        (small(5), large(1), [(blue, 20.0), (red, 196.0)]),
    ] {
        let found = found(&format!("{first}{second}")).expect("squares");
        assert_eq!(words(&found), NONE);
        let mut layers = visible(&found);
        layers.sort_by(|a, b| a.1.total_cmp(&b.1));
        let mut expected: Vec<(Rgb, f64)> = expected.to_vec();
        expected.sort_by(|a, b| a.1.total_cmp(&b.1));
        assert_eq!(layers, expected);
        assert_near(found.regions.area(), 216.0);
    }
}

#[test]
fn what_fills_hide_is_left_out_and_reported() {
    let cover = solid("62 5", [0.0, 0.0, 9.0]);
    let below = [
        solid("62 1", [2.0, 2.0, 3.0]),
        "0 LINE 8 0 62 1 10 1 20 1 11 4 21 2 ".to_owned(),
        "0 TEXT 8 0 62 1 10 2 20 2 40 3 1 H ".to_owned(),
    ];
    for entity in &below {
        let found = found(&format!("{entity}{cover}")).expect("a square");
        assert_eq!(found.paint_layers.len(), 1);
        let is_reported = words(&found)
            .iter()
            .any(|note| note == "1 fill, line or text hidden by fills drawn later");
        assert!(is_reported, "{:?}", words(&found));
        let found = super::found(&format!("{cover}{entity}")).expect("a square");
        assert_eq!(found.paint_layers.len(), 2, "drawn later, it is seen");
    }
    // A fill that is nested in an earlier one lies on it, which stays whole.
    let nested = format!("{cover}{}", below[0]);
    let found = found(&nested).expect("squares");
    assert_near(found.paint_layers[0].regions.area(), 81.0);
}

#[test]
fn a_table_of_the_order_of_drawing_is_followed() {
    let entities = format!(
        "{}{}",
        solid("5 A1 62 5", [0.0, 0.0, 9.0]),
        solid("5 A2 62 1", [6.0, 0.0, 9.0])
    );
    let table = "0 SORTENTSTABLE 5 C7 330 C6 100 AcDbSortentsTable 330 1F
        331 A1 5 A2 331 A2 5 A1";
    let blue = Rgb([0, 0, 255]);
    let area = |objects: &str| {
        let found = found_in(&[("ENTITIES", &entities), ("OBJECTS", objects)]);
        let layers = visible(&found.expect("squares"));
        layers.iter().find(|layer| layer.0 == blue).expect("blue").1
    };
    assert_eq!([area(""), area(table)], [54.0, 81.0]);
}

#[test]
fn the_fill_of_an_mpolygon_has_a_colour_of_its_own() {
    let boundary = "91 1 92 2 73 1 72 0 93 4 10 0 20 0 10 4 20 0 10 4 20 4 10 0 20 4";
    let polygon = format!(
        "0 MPOLYGON 8 0 62 1 70 1 10 0 20 0 2 SOLID 71 1 {boundary} 76 1 63 3 11 0 21 0 99 0"
    );
    let found = found(&polygon).expect("a square");
    assert_eq!(visible(&found), [(Rgb([0, 255, 0]), 16.0)]);
}

#[test]
fn attributes_inherit_from_their_block_reference() {
    let tables = "0 TABLE 2 LAYER 0 LAYER 2 doors 62 1 0 LAYER 2 notes 62 3 0 ENDTAB";
    let block = format!("0 BLOCK 2 B {} 0 ENDBLK", square_on("0", 0.0, 2.0, ""));
    let reference = "0 INSERT 8 doors 2 B 62 5 66 1 10 0 20 0 ";
    let attribute = |more: &str| format!("0 ATTRIB {more} 10 9 20 0 40 3 1 H 2 NR 70 0 0 SEQEND ");
    for (more, layer, colour) in [
        ("8 0", "doors", [255, 0, 0]),
        ("8 0 62 0", "doors", [0, 0, 255]),
        ("8 notes", "notes", [0, 255, 0]),
        ("8 0 62 4", "doors", [0, 255, 255]),
    ] {
        let entities = format!("{reference}{}", attribute(more));
        let sections = [
            ("TABLES", tables),
            ("BLOCKS", block.as_str()),
            ("ENTITIES", &entities),
        ];
        let layers = found_in(&sections).expect("a letter").paint_layers;
        let letter = layers.iter().find(|layer| layer.is_text).expect("a letter");
        let found = (letter.name.as_str(), letter.paint.expect("a paint").colour);
        assert_eq!(found, (layer, Rgb(colour)), "{more}");
    }
}

#[test]
fn opacity_is_read_and_inherited() {
    // 0x02000040 is an opacity of 64/255, 0x01000000 that of the block reference.
    let block = format!(
        "0 BLOCK 2 B {} 0 ENDBLK",
        square_on("0", 0.0, 2.0, "440 16777216")
    );
    let entities = format!(
        "{} 0 INSERT 8 0 2 B 10 9 440 33554560",
        square_on("0", 0.0, 2.0, "440 33554496")
    );
    let found = found_in(&[("BLOCKS", &block), ("ENTITIES", &entities)]).expect("squares");
    let mut opacities: Vec<f64> = found
        .paint_layers
        .iter()
        .filter_map(|layer| Some(255.0 * layer.paint?.opacity))
        .collect();
    opacities.sort_by(f64::total_cmp);
    assert_eq!(
        opacities.iter().map(|x| x.round()).collect::<Vec<_>>(),
        [64.0, 128.0]
    );
    let tables =
        "0 TABLE 2 LAYER 0 LAYER 2 glass 62 1 1001 AcCmTransparency 1071 33554559 0 ENDTAB";
    let entities = square_on("glass", 0.0, 2.0, "");
    let found = found_in(&[("TABLES", tables), ("ENTITIES", &entities)]).expect("a square");
    let opacity = found.paint_layers[0].paint.expect("a paint").opacity;
    assert!((opacity - 127.0 / 255.0).abs() < 1e-9, "{opacity}");
}

#[test]
fn a_closed_spline_through_fit_points_passes_through_them() {
    let points: Vec<DVec2> = (0..8)
        .map(|k| 12.0 * DVec2::from_angle(2.0 * PI * f64::from(k) / 8.0))
        .collect();
    let pairs: String = points
        .iter()
        .chain(&points[..1])
        .map(|p| format!("11 {} 21 {} ", p.x, p.y))
        .collect();
    let found = found(&format!("0 SPLINE 8 0 70 9 71 3 74 9 {pairs}")).expect("a ring");
    assert_eq!(words(&found), NONE);
    let ring = found.regions.rings().next().expect("a ring").clone();
    for p in points {
        assert!(ring.distance_squared(p).sqrt() < 1e-3, "{p}");
    }
    // By less than half a percent, the curve is the circle through the points.
    assert!((found.regions.area() / (144.0 * PI) - 1.0).abs() < 5e-3);
}
