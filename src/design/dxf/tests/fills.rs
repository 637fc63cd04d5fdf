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
    let donut = hatch(
        0,
        &[circle_loop(3, 30.0, 20.0), circle_loop(18, 30.0, 10.0)],
    );
    let solid = "0 SOLID 8 0 10 70 20 10 11 100 21 10 12 70 22 50 13 100 23 50";
    let found = found(&format!("{donut} {solid}")).expect("fills");
    assert_eq!(found.notes, []);
    assert_eq!((found.regions.len(), found.regions.rings().count()), (2, 3));
    let areas: Vec<f64> = found.regions.iter().map(|piece| piece.area()).collect();
    let ring = 300.0 * PI;
    assert!(
        areas.iter().any(|area| (area - ring).abs() < 1e-3 * ring),
        "{areas:?}"
    );
    assert!(
        areas.iter().any(|area| (area - 1200.0).abs() < 1e-9),
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
        assert_eq!(found.notes, [], "{edges}");
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
    assert_eq!(found.notes, []);
    let ring = found.regions.rings().next().expect("a ring").clone();
    for p in points {
        assert!(ring.distance_squared(p).sqrt() < 1e-3, "{p}");
    }
    // By less than half a percent, the curve is the circle through the points.
    assert!((found.regions.area() / (144.0 * PI) - 1.0).abs() < 5e-3);
}
