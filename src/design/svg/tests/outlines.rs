//! Tests of fills with their own outlines, which move as one part.

use super::*;

/// Returns the paint layers of a drawing.
fn layers(body: &str) -> Vec<PaintLayer> {
    stroked(body, None).expect("a drawing").paint_layers
}

#[test]
fn a_stroke_below_its_fill_belongs_to_the_fill() {
    let square =
        r##"<path d="M20 20h40v40h-40z" fill="#e07a5f" stroke="#3d405b" stroke-width="6""##;
    for (order, is_below) in [
        ("stroke", true),
        ("normal", false),
        ("stroke markers", true),
    ] {
        let found = layers(&format!("{square} paint-order=\"{order}\"/>"));
        assert_eq!(found.len(), 1, "{order}");
        assert_near(found[0].regions.area(), 1600.0);
        let line = found[0].line.expect("a stroke");
        assert_eq!((line.width, line.is_below_fill), (6.0, is_below), "{order}");
    }
}

/// A head with two eyes, and then its outline, as in illustrations with a group for the colours and
/// a group for the lines.
fn head(between: &str) -> String {
    format!(
        r##"<g id="color"><circle cx="50" cy="50" r="30" fill="#fcea2b"/>
        <circle cx="40" cy="45" r="4" fill="#222"/>{between}</g>
        <g id="line"><circle cx="50" cy="50" r="30" fill="none" stroke="#000" stroke-width="2"/>
        <path d="M40 60h20" fill="none" stroke="#000" stroke-width="2"/></g>"##
    )
}

#[test]
fn an_outline_drawn_later_is_attached_to_its_fill() {
    let found = layers(&head(""));
    let [face, eye, mouth] = found.as_slice() else {
        panic!("{} layers", found.len());
    };
    assert_near(face.regions.area(), 900.0 * std::f64::consts::PI);
    assert_eq!(face.line.map(|line| line.width), Some(2.0));
    assert_eq!(face.name, "color");
    assert!(eye.line.is_none() && mouth.line.is_none());
}

#[test]
fn an_outline_stays_on_top_of_what_covers_part_of_the_fill_s_edge() {
    let hat = r##"<rect x="30" y="10" width="40" height="20" fill="#06d6a0"/>"##;
    let found = layers(&head(hat));
    let outlined: Vec<usize> = (0..found.len())
        .filter(|&k| found[k].line.is_some())
        .collect();
    let hat = found
        .iter()
        .position(|layer| layer.paint == Some(Rgb([6, 214, 160]).into()));
    assert!(outlined == [3] && hat == Some(2), "{outlined:?}, {hat:?}");
}

#[test]
fn an_outline_of_another_shape_is_not_attached() {
    let body = r##"<circle cx="50" cy="50" r="30" fill="#fcea2b"/>
        <rect x="20" y="20" width="60" height="60" fill="none" stroke="#000"/>"##;
    let found = layers(body);
    assert!(found.len() == 2 && found[0].line.is_none());
}
