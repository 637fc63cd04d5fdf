//! DXF drawings: splines, mirrored blocks, solids and hatches.

use std::f64::consts::PI;

use morphospace::geometry::DVec2;

use super::{assert_close, holes, imported, notes, outline, signed_area};

/// Text of a DXF file; group codes and values are separated by white space.
fn dxf(sections: &[(&str, &str)]) -> String {
    let section = |(name, pairs): &(&str, &str)| {
        let pairs: Vec<&str> = pairs.split_whitespace().collect();
        format!("0\nSECTION\n2\n{name}\n{}\n0\nENDSEC\n", pairs.join("\n"))
    };
    sections.iter().map(section).collect::<String>() + "0\nEOF\n"
}

fn pairs(code: u32, numbers: impl IntoIterator<Item = f64>) -> String {
    let pairs = numbers
        .into_iter()
        .map(|number| format!("{code} {number} "));
    pairs.collect()
}

fn points(code: u32, points: &[DVec2]) -> String {
    let point = |p: &DVec2| pairs(code, [p.x]) + &pairs(code + 10, [p.y]);
    points.iter().map(point).collect()
}

/// Corners of a regular polygon about a centre.
fn regular(count: u32, radius: f64, centre: DVec2) -> Vec<DVec2> {
    let angle = |k: u32| 2.0 * PI * f64::from(k) / f64::from(count) + 0.3;
    (0..count)
        .map(|k| centre + radius * DVec2::from_angle(angle(k)))
        .collect()
}

#[test]
fn a_closed_rational_spline_is_a_circle() {
    let corners = [
        (1, 0),
        (1, 1),
        (0, 1),
        (-1, 1),
        (-1, 0),
        (-1, -1),
        (0, -1),
        (1, -1),
        (1, 0),
    ];
    let control: Vec<DVec2> = (corners.iter())
        .map(|&(x, y)| DVec2::new(40.0 + 7.0 * f64::from(x), 3.0 + 7.0 * f64::from(y)))
        .collect();
    let knots = [0.0, 0.0, 0.0, 1.0, 1.0, 2.0, 2.0, 3.0, 3.0, 4.0, 4.0, 4.0];
    let weights = (0..9).map(|k| if k % 2 == 0 { 1.0 } else { 0.5_f64.sqrt() });
    let spline = format!(
        "0 SPLINE 8 0 70 13 71 2 72 12 73 9 {}{}{}",
        pairs(40, knots),
        pairs(41, weights),
        points(10, &control)
    );
    let circle = outline(&imported(dxf(&[("ENTITIES", &spline)])));
    assert_eq!((circle.len(), holes(&circle)), (1, 0));
    assert!(
        (circle.area() - 49.0 * PI).abs() < 1e-3 * 49.0 * PI,
        "{}",
        circle.area()
    );
}

#[test]
fn a_periodic_spline_encloses_the_area_of_its_cubics() {
    let ring = regular(5, 9.0, DVec2::new(-4.0, 2.0));
    // The first corners again, after the last one; knots at equal distances.
    let control: Vec<DVec2> = ring.iter().chain(&ring[..3]).copied().collect();
    let knots = (0..12).map(|k| f64::from(k) - 3.0);
    let spline = format!(
        "0 SPLINE 8 0 70 11 71 3 72 12 73 8 {}{}",
        pairs(40, knots),
        points(10, &control)
    );
    let found = outline(&imported(dxf(&[("ENTITIES", &spline)])));
    let cubic = |k: usize, u: f64| {
        let weights = [
            (1.0 - u).powi(3),
            3.0 * u.powi(3) - 6.0 * u * u + 4.0,
            -3.0 * u.powi(3) + 3.0 * u * u + 3.0 * u + 1.0,
            u.powi(3),
        ];
        let terms = weights.iter().enumerate();
        terms
            .map(|(i, w)| w / 6.0 * ring[(k + i) % 5])
            .sum::<DVec2>()
    };
    let exact: Vec<DVec2> = (0..5 * 500)
        .map(|k| cubic(k / 500, (k % 500) as f64 / 500.0))
        .collect();
    assert_close(found.area(), signed_area(&exact));
}

#[test]
fn a_broken_spline_is_left_out_and_named() {
    let square = "0 LWPOLYLINE 8 walls 90 4 70 1 10 0 20 0 10 30 20 0 10 30 20 12 10 0 20 12 ";
    let spline = "0 SPLINE 5 B7 8 rails 70 8 71 3 73 4 10 1 20 1 10 2 20 5 10 6 20 2 10 9 20 9 ";
    let design = imported(dxf(&[("ENTITIES", &format!("{square}{spline}"))]));
    assert_close(outline(&design).area(), 360.0);
    let is_named = |note: &String| note.starts_with("1 SPLINE left out") && note.contains("rails");
    assert!(notes(&design).iter().any(is_named), "{:?}", notes(&design));
}

#[test]
fn a_spline_through_fit_points_passes_through_them() {
    let corners = regular(9, 14.0, DVec2::ZERO);
    let closed: Vec<DVec2> = corners.iter().chain(&corners[..1]).copied().collect();
    let spline = format!("0 SPLINE 8 0 70 9 71 3 74 10 {}", points(11, &closed));
    let found = outline(&imported(dxf(&[("ENTITIES", &spline)])));
    assert_close(found.area(), 196.0 * PI);
}

#[test]
fn mirrored_and_nested_blocks_keep_areas_and_counts() {
    // An L of area 16 and a half disc of radius 2.
    let shape =
        "0 LWPOLYLINE 8 0 90 6 70 1 10 0 20 0 10 7 20 0 10 7 20 2 10 1 20 2 10 1 20 4 10 0 20 4
        0 LWPOLYLINE 8 0 90 2 70 1 10 12 20 0 42 1 10 12 20 4 ";
    let pair =
        "0 INSERT 8 0 2 SHAPE 10 0 20 0 0 INSERT 8 0 2 SHAPE 10 40 20 0 41 -1 42 1 43 1 50 30";
    let blocks =
        format!("0 BLOCK 2 SHAPE 10 0 20 0 {shape} 0 ENDBLK 0 BLOCK 2 PAIR {pair} 0 ENDBLK");
    let entities = "0 INSERT 8 0 2 PAIR 10 0 20 0 0 INSERT 8 0 2 PAIR 10 0 20 -30 41 -1 42 1
        0 INSERT 8 0 2 PAIR 10 60 20 60 41 2 42 -2 50 110 0 INSERT 8 0 2 SHAPE 10 -90 20 60 210 0 220 0 230 -1";
    let found = outline(&imported(dxf(&[
        ("BLOCKS", &blocks),
        ("ENTITIES", entities),
    ])));
    assert_eq!((found.len(), holes(&found)), (14, 0));
    let one = 16.0 + 2.0 * PI;
    assert_close(found.area(), one * (2.0 + 2.0 + 8.0 + 1.0));
}

#[test]
fn a_solid_is_no_bow_tie_and_a_hatch_has_its_hole() {
    let circle = |flags: u32, radius: f64| {
        format!("92 {flags} 93 1 72 2 10 30 20 5 40 {radius} 50 0 51 360 73 1 97 0 ")
    };
    let hatch = format!(
        "0 HATCH 8 fills 62 1 2 SOLID 70 1 71 0 91 2 {}{}75 0 76 1 98 0 ",
        circle(1, 8.0),
        circle(16, 3.0)
    );
    let solid = "0 SOLID 8 fills 62 5 10 0 20 0 11 12 21 0 12 0 22 5 13 12 23 5 ";
    let design = imported(dxf(&[("ENTITIES", &format!("{hatch}{solid}"))]));
    let found = outline(&design);
    assert_eq!((found.len(), holes(&found)), (2, 1));
    assert_close(found.area(), 60.0 + 55.0 * PI);
    let mut colours: Vec<[u8; 3]> = (design.paint_layers.iter())
        .filter_map(|layer| Some(layer.paint?.colour.0))
        .collect();
    colours.sort_unstable();
    assert_eq!(colours, [[0, 0, 255], [255, 0, 0]]);
}
