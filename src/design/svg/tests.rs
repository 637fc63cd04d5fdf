//! Tests of the SVG importer: silhouettes, strokes, text, paint layers, selected elements and
//! notes.

use super::*;
use crate::colour::{Paint, Rgb};
use crate::design::paint_layer::PaintLayer;
use crate::geometry::Regions;

const NS: &str = r#"xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink""#;

fn page(body: &str) -> String {
    format!(r#"<svg {NS} viewBox="0 0 100 100" width="100" height="100">{body}</svg>"#)
}

fn read(text: &str, tolerance: f64) -> Result<(Regions, Bounds), SvgError> {
    let options = ImportOptions {
        tolerance,
        ..ImportOptions::default()
    };
    super::read(text, None, &options).map(|found| (found.regions, found.extent))
}

/// Imports a drawing, or one element of it, with strokes as part of the silhouette.
fn stroked(body: &str, element: Option<&str>) -> Result<ImportedOutlines, SvgError> {
    let options = ImportOptions {
        tolerance: 1e-5,
        strokes: true,
        ..ImportOptions::default()
    };
    super::read(&page(body), element, &options)
}

/// Returns the silhouette of a drawing without its strokes.
fn without_strokes(body: &str) -> Result<Regions, SvgError> {
    let options = ImportOptions {
        strokes: false,
        ..ImportOptions::default()
    };
    super::read(&page(body), None, &options).map(|found| found.regions)
}

fn read_body(body: &str) -> Result<Regions, SvgError> {
    read(&page(body), 1e-5).map(|(regions, _)| regions)
}

fn regions(body: &str) -> Regions {
    read_body(body).expect("an outline")
}

fn assert_near(found: f64, expected: f64) {
    assert!(
        (found - expected).abs() < 1e-3 * expected,
        "{found} for {expected}"
    );
}

#[test]
fn y_points_up_and_the_view_box_scales() {
    let text = format!(
        r#"<?xml version="1.0"?><svg {NS} viewBox="10 10 10 10" width="40" height="40">
        <rect x="10" y="10" width="2" height="1"/></svg>"#
    );
    let (regions, page) = read(&text, 1e-3).expect("an outline");
    assert_eq!(page.size(), DVec2::splat(40.0));
    let bounds = regions.bounds();
    assert!((bounds.min - DVec2::new(0.0, 36.0)).length() < 1e-5);
    assert!((bounds.max - DVec2::new(8.0, 40.0)).length() < 1e-5);
}

#[test]
fn circles_are_round() {
    let disc = regions(r#"<circle cx="50" cy="50" r="40"/>"#);
    assert_near(disc.area(), 1600.0 * std::f64::consts::PI);
    assert_eq!(disc.rings().count(), 1);
}

#[test]
fn each_path_uses_its_own_fill_rule() {
    let star = "M0 0h40v40h-40z M10 10h20v20h-20z";
    let body = format!(
        r#"<path d="{star}" fill-rule="evenodd"/><path transform="translate(50 0)" d="{star}"/>"#
    );
    assert_near(regions(&body).area(), 1600.0 - 400.0 + 1600.0);
    assert_eq!(regions(&body).rings().count(), 3);
}

#[test]
fn copies_are_transformed_and_united() {
    let body = r##"<defs><rect id="r" width="10" height="10"/></defs>
        <g transform="scale(2)"><use href="#r" x="5"/><use xlink:href="#r" x="10"/></g>"##;
    assert_near(regions(body).area(), 600.0);
    assert_eq!(regions(body).len(), 1);
}

#[test]
fn white_is_paper_unless_all_shapes_are_white() {
    let sheet = r#"<rect width="100" height="100" fill="white"/>"#;
    let body = format!(
        r##"{sheet}<rect width="60" height="60" fill="red"/><rect width="20" height="60" fill="#fff"/>
        <rect width="10" height="10"/>"##
    );
    assert_near(regions(&body).area(), 60.0 * 60.0 - 20.0 * 60.0 + 100.0);
    assert_near(regions(sheet).area(), 10_000.0);
}

#[test]
fn clip_paths_cut() {
    let body = r##"<clipPath id="c"><rect width="50" height="100" transform="translate(10 0)"/>
        <rect width="10" height="10" x="90" y="90"/></clipPath>
        <g transform="translate(5 0)" clip-path="url(#c)"><rect width="100" height="20"/></g>"##;
    assert_near(regions(body).area(), 50.0 * 20.0);
    assert_near(regions(body).bounds().min.x, 15.0);
}

#[test]
fn invisible_shapes_are_ignored() {
    let nothing = [
        "",
        r#"<rect width="9" height="9" fill="none"/>"#,
        r#"<rect width="9" height="9" fill-opacity="0"/>"#,
        r#"<rect width="9" height="9" visibility="hidden"/>"#,
        r#"<g opacity="0"><rect width="9" height="9"/></g>"#,
        r#"<text y="20"> </text>"#,
        r#"<image href="/etc/passwd" width="9" height="9"/>"#,
    ];
    for body in nothing {
        let error = read_body(body).expect_err(body);
        assert!(
            matches!(error, SvgError::NothingFilled { strokes: false }),
            "{error}"
        );
    }
    let stroke = r#"<path d="M0 0 L50 50" fill="none" stroke="black"/>"#;
    let error = without_strokes(stroke).expect_err("strokes only");
    assert!(matches!(error, SvgError::NothingFilled { strokes: true }));
    assert!(error.to_string().contains("only strokes"));
}

#[test]
fn masks_cut_by_luminance_and_alpha() {
    let shapes = r#"<rect width="40" height="40" fill="white"/>
        <rect width="10" height="10" fill="black"/>"#;
    let masked = |attributes: &str| {
        let body = format!(
            r##"<mask id="m" maskUnits="userSpaceOnUse" x="0" y="0" width="100" height="100"
            {attributes}>{shapes}</mask><rect width="50" height="50" fill="red" mask="url(#m)"/>"##
        );
        let found = stroked(&body, None).expect("an outline");
        assert_eq!(found.notes, []);
        found.regions.area()
    };
    assert_near(masked(""), 1600.0 - 100.0);
    assert_near(masked(r#"style="mask-type: alpha""#), 1600.0);
}

#[test]
fn a_soft_mask_is_replaced_by_its_mean_and_reported() {
    let body = r##"<linearGradient id="g"><stop stop-color="white"/><stop offset="1"/></linearGradient>
        <mask id="m"><rect width="50" height="50" fill="url(#g)"/></mask>
        <rect id="a" width="50" height="50" fill="red" mask="url(#m)"/>"##;
    let found = stroked(body, None).expect("an outline");
    assert_near(found.regions.area(), 2500.0);
    let opacity = found.paint_layers[0].paint.expect("a colour").opacity;
    assert!((0.1..0.7).contains(&opacity), "{opacity}");
    let note = found.notes[0].to_string();
    assert_eq!(
        note,
        "mask with a gradient: replaced by its mean opacity (#a)"
    );
}

#[test]
fn markers_are_drawn_as_shapes() {
    let body = r##"<marker id="m" markerWidth="4" markerHeight="4" refX="2" refY="2" orient="auto">
        <rect width="4" height="4" fill="red"/></marker>
        <path d="M10 50h30" stroke="black" stroke-width="2" marker-end="url(#m)"/>"##;
    let found = stroked(body, None).expect("an outline");
    // The marker is scaled by the width of the stroke and covers the last four units of the line.
    assert_near(found.regions.area(), 2.0 * 26.0 + 64.0);
    assert_eq!(found.paint_layers.len(), 2);
}

#[test]
fn embedded_drawings_are_drawn_and_embedded_pictures_are_reported() {
    let body = r#"<image x="10" y="10" width="9" height="9" href="data:image/svg+xml,%3Csvg xmlns='http://www.w3.org/2000/svg' width='9' height='9'%3E%3Cstyle%3E.a%7Bfill:rebeccapurple%7D%3C/style%3E%3Crect class='a' width='9' height='3'/%3E%3C/svg%3E"/>
        <image id="broken" width="9" height="9" href="data:image/png;base64,AAAA"/>
        <image id="linked" width="9" height="9" href="photo.png"/>"#;
    let found = stroked(body, None).expect("an outline");
    assert_near(found.regions.area(), 27.0);
    let notes: Vec<_> = found.notes.iter().map(ToString::to_string).collect();
    let expected = [
        "embedded image that cannot be read: ignored (#broken)",
        "picture in another file: ignored (#linked)",
    ];
    assert_eq!(notes, expected);
}

#[test]
fn an_embedded_picture_becomes_a_rectangle_in_its_mean_colour() {
    let mut bytes = std::io::Cursor::new(Vec::new());
    let picture = image::RgbaImage::from_fn(4, 2, |x, _| match x {
        0 | 1 => image::Rgba([200, 0, 100, 255]),
        2 => image::Rgba([0, 0, 100, 255]),
        _ => image::Rgba([9, 9, 9, 0]),
    });
    picture
        .write_to(&mut bytes, image::ImageFormat::Png)
        .expect("encodes");
    let escaped: String = bytes
        .into_inner()
        .iter()
        .map(|b| format!("%{b:02x}"))
        .collect();
    let body = format!(
        r#"<image id="photo" x="10" y="20" width="40" height="40" href="data:image/png,{escaped}"/>"#
    );
    let found = stroked(&body, None).expect("an outline");
    // The picture is twice as wide as high and lies in the middle of its square.
    let [layer] = found.paint_layers.as_slice() else {
        panic!("one layer");
    };
    assert_near(layer.regions.area(), 40.0 * 20.0);
    assert_eq!(layer.paint, Some(paint([133, 0, 100], 0.75)));
    let note = found.notes[0].to_string();
    assert_eq!(
        note,
        "picture: replaced by a rectangle in its mean colour (#photo)"
    );
}

#[test]
fn the_colour_of_the_page_lies_below_the_drawing() {
    let text = format!(
        r##"<svg {NS} viewBox="0 0 50 50" width="100" height="80" style="background: no-repeat #0a0b0c">
        <rect width="10" height="10" fill="#ff0000"/></svg>"##
    );
    let found = super::read(&text, None, &ImportOptions::default()).expect("an outline");
    let areas: Vec<_> = found
        .paint_layers
        .iter()
        .map(|l| (l.paint, l.regions.area().round()))
        .collect();
    let expected = [
        (Some(paint([10, 11, 12], 1.0)), 8000.0),
        (Some(paint([255, 0, 0], 1.0)), 256.0),
    ];
    assert_eq!(areas, expected);
}

#[test]
fn the_content_of_a_pattern_is_scaled_to_the_box_of_the_shape() {
    let body = r##"<pattern id="p" patternContentUnits="objectBoundingBox" width="0.5" height="1">
        <rect width="0.25" height="0.5" fill="#00ff00"/></pattern>
        <pattern id="v" width="1" height="1" viewBox="0 0 10 10">
        <g transform="translate(5 0)"><rect width="5" height="10" fill="#0000ff"/></g></pattern>
        <rect width="40" height="20" fill="url(#p)"/>
        <rect y="50" width="40" height="40" fill="url(#v)"/>"##;
    let areas: Vec<_> = layers(body).iter().map(|(_, area)| area.round()).collect();
    assert_eq!(areas, [200.0, 800.0]);
}

#[test]
fn the_view_box_of_a_pattern_is_scaled_to_its_tile() {
    let body = r##"<pattern id="p" patternUnits="userSpaceOnUse" width="20" height="20"
        viewBox="0 0 10 10"><rect width="5" height="10" fill="#00ff00"/></pattern>
        <rect width="40" height="40" fill="url(#p)"/>"##;
    let found = stroked(body, None).expect("an outline");
    assert_near(found.regions.area(), 800.0);
    assert_near(found.regions.bounds().max.x, 30.0);
}

#[test]
fn the_content_of_a_pattern_starts_at_the_corner_of_its_tile() {
    let body = r##"<pattern id="p" patternUnits="userSpaceOnUse" x="5" y="2" width="20" height="20">
        <rect width="10" height="20" fill="#00ff00"/></pattern>
        <rect x="5" width="40" height="40" fill="url(#p)"/>"##;
    let found = stroked(body, None).expect("an outline");
    assert_near(found.regions.area(), 800.0);
    assert_near(found.regions.bounds().min.x, 5.0);
    assert_near(found.regions.bounds().max.x, 35.0);
}

#[test]
fn broken_drawings_are_errors() {
    let truncated = page(r#"<rect width="9" height="9"/>"#);
    assert!(matches!(
        read(&truncated[..truncated.len() - 4], 1e-3),
        Err(SvgError::Xml(_))
    ));
    assert!(matches!(
        read(&format!(r#"<svg {NS} width="0" height="5"/>"#), 1e-3),
        Err(SvgError::Svg(_))
    ));
}

#[test]
fn strokes_are_shapes_unless_disabled() {
    let body = r#"<path d="M10 10 H50" fill="none" stroke="black" stroke-width="4"/>
        <rect x="10" y="50" width="20" height="20" stroke="red" stroke-width="2"/>"#;
    assert_near(without_strokes(body).expect("a square").area(), 400.0);
    let outline = stroked(body, None).expect("an outline");
    assert_near(outline.regions.area(), 160.0 + 22.0 * 22.0);
    assert_eq!(outline.notes, []);
    let round = r#"<g transform="scale(2)"><path d="M10 10 h10" stroke="black" stroke-width="4"
        stroke-linecap="round"/></g>"#;
    let outline = stroked(round, None).expect("an outline");
    assert_near(
        outline.regions.area(),
        4.0 * (40.0 + 4.0 * std::f64::consts::PI),
    );
    let dashed = r#"<path d="M0 50 h100" stroke="black" stroke-width="2" stroke-dasharray="10"/>"#;
    assert_eq!(stroked(dashed, None).expect("an outline").regions.len(), 5);
    // A white stroke cuts a gap into the shape below.
    let gap =
        r#"<rect width="60" height="60"/><path d="M0 30 h60" stroke="white" stroke-width="6"/>"#;
    let outline = stroked(gap, None).expect("an outline").regions;
    assert_eq!(outline.len(), 2);
    assert_near(outline.area(), 60.0 * 54.0);
}

#[test]
fn a_drawing_of_strokes_only_has_an_outline() {
    let body =
        r#"<path d="M50 10 A40 40 0 1 1 49.9 10" fill="none" stroke="black" stroke-width="10"/>"#;
    assert!(without_strokes(body).is_err());
    let ring = stroked(body, None).expect("an outline").regions;
    assert_eq!(ring.rings().count(), 1); // the arc does not quite close
    assert_near(ring.area(), 2.0 * std::f64::consts::PI * 40.0 * 10.0);
}

#[test]
fn one_element_is_selected_by_its_id() {
    let body = r##"<defs><rect id="unit" width="10" height="10"/></defs>
        <rect id="a" width="30" height="30"/>
        <g id="b" transform="translate(40 40)"><use id="c" href="#unit" x="5"/>
        <circle id="d" r="9" fill="white"/></g>"##;
    let area = |id: &str| stroked(body, Some(id)).expect(id).regions.area();
    assert_near(area("a"), 900.0);
    assert_near(area("c"), 100.0);
    assert_near(area("d"), 81.0 * std::f64::consts::PI); // the only shape, so white is not paper
    let c = stroked(body, Some("c")).expect("an element");
    assert!((c.extent.min - DVec2::new(45.0, 50.0)).length() < 1e-4);
    let error = stroked(body, Some("unit")).err().expect("not drawn");
    assert!(matches!(error, SvgError::NotDrawn(id) if id == "unit"));
    let error = stroked(body, Some("e")).err().expect("no such element");
    assert!(
        error.to_string().contains("it has unit, a, b, c, d"),
        "{error}"
    );
}

#[test]
fn an_element_keeps_the_clip_paths_around_it() {
    let body = r##"<clipPath id="k"><rect width="50" height="50"/></clipPath>
        <g clip-path="url(#k)"><rect id="a" width="90" height="10"/></g>"##;
    assert_near(
        stroked(body, Some("a")).expect("a part").regions.area(),
        500.0,
    );
}

#[test]
fn repairs_and_omissions_are_reported() {
    let body = r#"<path d="M0 0 L40 40 L40 0 L0 40z" fill-rule="evenodd"/>
        <path d="M0 0 h9" stroke="red"/><text y="9" font-family="Nonesuch, Neither">words</text><image href="a.png"/>"#;
    let options = ImportOptions::default();
    let found = super::read(&page(body), None, &options).expect("an outline");
    let words: Vec<_> = found.notes.iter().map(ToString::to_string).collect();
    assert_eq!(words.len(), 3, "{words:?}");
    assert_eq!(
        words[0],
        "1 edge crossing was resolved by the even-odd rule"
    );
    assert!(words[1].starts_with("the font Nonesuch is not installed"));
    let clean = super::read(&page(r#"<circle cx="9" cy="9" r="5"/>"#), None, &options);
    assert_eq!(clean.expect("a disc").notes, []);
}

/// Roboto lacks this arrow. Whether another font has it depends on the machine.
#[test]
fn characters_that_their_font_lacks_are_reported() {
    let body = "<text x='10' y='60' font-family='Roboto' font-size='40'>D\u{2b8f}</text>";
    let options = ImportOptions::default();
    let found = super::read(&page(body), None, &options).expect("a letter");
    let words: Vec<_> = found.notes.iter().map(ToString::to_string).collect();
    assert_eq!(words.len(), 1, "{words:?}");
    let is_replaced = words[0].starts_with("1 character is drawn in another font");
    assert!(
        is_replaced || words[0].starts_with("1 character was ignored"),
        "{words:?}"
    );
}

#[test]
fn text_is_drawn_in_its_font_and_its_colour() {
    let body =
        r#"<text id="word" x="10" y="60" font-family="Roboto" font-size="40" fill="red">DI</text>"#;
    let found = stroked(body, None).expect("letters");
    let [word] = found.paint_layers.as_slice() else {
        panic!("{:?}", found.paint_layers);
    };
    assert_eq!((word.name.as_str(), word.regions.len()), ("word", 2));
    assert_eq!(word.paint, Some(Rgb([255, 0, 0]).into()));
    let bounds = word.regions.bounds();
    // Capitals of Roboto are 1456 of 2048 units high and stand on the baseline.
    assert!((bounds.min.y - 40.0).abs() < 0.1, "{bounds:?}");
    assert!(
        (bounds.size().y - 40.0 * 1456.0 / 2048.0).abs() < 0.1,
        "{bounds:?}"
    );
    let notes = found
        .notes
        .iter()
        .map(ToString::to_string)
        .collect::<String>();
    assert_eq!(notes, "");
}

/// Returns the paint and area of each paint layer, lowest first.
fn layers(body: &str) -> Vec<(Paint, f64)> {
    let found = stroked(body, None).expect("a drawing");
    let layers = found.paint_layers.into_iter();
    let summaries = layers.map(|layer| (layer.paint.expect("a paint"), layer.regions.area()));
    summaries.collect()
}

fn paint(rgb: [u8; 3], opacity: f64) -> Paint {
    Paint {
        colour: Rgb(rgb),
        opacity,
    }
}

#[test]
fn shapes_of_one_paint_are_one_layer_if_their_order_allows_it() {
    let square = |x: u32, fill: &str| {
        format!(r#"<rect x="{x}" y="10" width="10" height="10" fill="{fill}"/>"#)
    };
    let [red, blue] = [paint([255, 0, 0], 1.0), paint([0, 0, 255], 1.0)];
    // Disjoint squares of one colour merge; a red square above a blue one does not merge with a red
    // one below.
    let body = [(0, "red"), (20, "blue"), (40, "red"), (60, "blue")].map(|(x, f)| square(x, f));
    let found = layers(&body.concat());
    assert_eq!(found.iter().map(|c| c.0).collect::<Vec<_>>(), [red, blue]);
    assert_near(found[0].1, 200.0);
    let body = [(0, "red"), (5, "blue"), (10, "red")].map(|(x, f)| square(x, f));
    let found = layers(&body.concat());
    assert_eq!(
        found.iter().map(|c| c.0).collect::<Vec<_>>(),
        [red, blue, red]
    );
    // Hidden areas remain, because they may become visible during the transition.
    assert_near(found[1].1, 100.0);
}

#[test]
fn layers_keep_strokes_opacity_and_order() {
    let body = r##"<g opacity="0.5"><rect width="20" height="20" fill="#102030"/>
        <rect x="10" width="20" height="20" fill="#405060" fill-opacity="1"/></g>
        <rect x="50" y="50" width="20" height="20" fill="white" stroke="#ff0000"
        stroke-width="2" stroke-opacity="0.25" stroke-dasharray="20" paint-order="stroke"/>"##;
    let found = layers(body);
    let paints: Vec<Paint> = found.iter().map(|layer| layer.0).collect();
    let expected = [
        paint([0x10, 0x20, 0x30], 0.5),
        paint([0x40, 0x50, 0x60], 0.5),
        paint([255, 0, 0], 0.25),
        paint([255; 3], 1.0),
    ];
    assert_eq!(paints, expected);
    // Shapes of one paint in a translucent group merge, so that no overlap shows.
    let cloud = r##"<g opacity="0.5" fill="#fff"><circle cx="30" cy="30" r="9"/>
        <circle cx="40" cy="30" r="9"/></g>"##;
    let cloud = stroked(cloud, None).expect("a cloud").paint_layers;
    assert_eq!((cloud.len(), cloud[0].regions.len()), (1, 1));
    // Covered areas of shapes in a translucent group are removed.
    assert_near(found[0].1, 200.0);
    assert_near(found[2].1, 2.0 * 20.0 * 2.0);
}

#[test]
fn patterns_and_gradients_stay() {
    let body = r##"<linearGradient id="g"><stop offset="0.5" stop-color="#000"/>
        <stop offset="0.5" stop-color="#fff"/></linearGradient>
        <pattern id="p" width="2" height="2" patternUnits="userSpaceOnUse">
        <rect width="1" height="1" fill="#00ff00"/></pattern>
        <rect width="20" height="20" fill="url(#g)"/>
        <rect x="50" width="20" height="20" fill="url(#p)"/>
        <path d="M0 50h50v9" stroke="url(#g)" fill="none"/>"##;
    let paints: Vec<Paint> = layers(body).iter().map(|layer| layer.0).collect();
    // The mean colour is perceptually halfway between black and white.
    let mean = paint([99; 3], 1.0);
    assert_eq!(paints, [mean, paint([0, 255, 0], 1.0), mean]);
    let found = stroked(body, None).expect("a drawing");
    assert_eq!(found.notes, []);
    // Ten by ten tiles, a quarter of each of which is painted.
    assert_near(found.paint_layers[1].regions.area(), 100.0);
    assert!(found.paint_layers[2].gradient.is_some());
    let gradient = found.paint_layers[0].gradient.as_ref().expect("a gradient");
    assert_eq!(gradient.stops.len(), 2);
    // The gradient runs from the left to the right edge of the square, in page coordinates.
    let [left, right] = [DVec2::ZERO, DVec2::X].map(|p| gradient.frame.transform_point2(p));
    assert!(left.distance(DVec2::new(0.0, 100.0)) < 1e-5, "{left}");
    assert!(right.distance(DVec2::new(20.0, 100.0)) < 1e-5, "{right}");
    assert_eq!(found.paint_layers[1].gradient, None);
}

#[test]
fn a_drawing_without_colours_has_no_layers() {
    for (body, count) in [
        (r#"<path d="M0 0h9v9z"/>"#, 0),
        (
            r#"<path fill="currentColor" stroke="none" d="M0 0h9v9z"/>"#,
            0,
        ),
        (
            r#"<path style="fill: inherit; opacity: .5" d="M0 0h9v9z"/>"#,
            0,
        ),
        (r##"<path fill="#000" d="M0 0h9v9z"/>"##, 1),
        (r#"<g style="fill:teal"><path d="M0 0h9v9z"/></g>"#, 1),
        (
            r#"<style>.a { fill: teal }</style><path class="a" d="M0 0h9v9z"/>"#,
            1,
        ),
    ] {
        assert_eq!(
            stroked(body, None).expect(body).paint_layers.len(),
            count,
            "{body}"
        );
    }
}

mod limits;
mod outlines;
mod silence;
