//! Hostile drawings are refused quickly, and nothing outside of the file is opened.

use super::*;
use std::time::{Duration, Instant};

/// Time after which an import counts as endless. The slowest test takes four seconds.
const ENDLESS: Duration = Duration::from_secs(60);

/// Builds a drawing of `levels` groups. Each group has `copies` references to the previous group.
/// `link` returns the text of a reference to the group with a given number.
fn bomb(levels: usize, copies: usize, link: impl Fn(usize) -> String) -> String {
    let mut body = String::from(r#"<defs><g id="g0"><rect width="1" height="1"/></g>"#);
    for level in 1..=levels {
        let copied = link(level - 1).repeat(copies);
        body += &format!(r#"<g id="g{level}">{copied}</g>"#);
    }
    body + &format!(r##"</defs><use href="#g{levels}"/>"##)
}

/// Imports a drawing that would expand exponentially; asserts that it fails quickly and returns the
/// error.
fn refused_quickly(body: &str) -> SvgError {
    let start = Instant::now();
    let error = read_body(body).expect_err("a bomb");
    assert!(start.elapsed() < ENDLESS);
    error
}

#[test]
fn nested_use_does_not_hang() {
    let body = bomb(12, 10, |level| {
        format!(r##"<use xlink:href="#g{level}"/>"##)
    });
    assert!(matches!(
        refused_quickly(&body),
        SvgError::TooManyElements { .. }
    ));
    let few = bomb(3, 10, |level| format!(r##"<use xlink:href="#g{level}"/>"##));
    assert_near(regions(&few).area(), 1.0);
}

#[test]
fn nested_patterns_clips_masks_and_styles_do_not_hang() {
    let fill = |style: bool| {
        let mut body = String::from(
            r#"<pattern id="p0" width="1" height="1"><path d="M0 0h1v1z"/></pattern>"#,
        );
        let mut sheet = String::new();
        for level in 1..14 {
            let inner = level - 1;
            let paint = if style {
                sheet += &format!("svg rect.c{inner} {{ fill : url( '#p{inner}' ) }}");
                format!(r#"class="a c{inner}""#)
            } else {
                format!(r#"style="fill:url(#p{inner})""#)
            };
            let rect = format!(r#"<rect width="1" height="1" {paint}/>"#).repeat(10);
            body += &format!(r#"<pattern id="p{level}" width="1" height="1">{rect}</pattern>"#);
        }
        format!(r##"<style>{sheet}</style>{body}<rect width="9" height="9" fill="url(#p13)"/>"##)
    };
    assert!(matches!(
        refused_quickly(&fill(false)),
        SvgError::TooManyElements { .. }
    ));
    assert!(matches!(
        refused_quickly(&fill(true)),
        SvgError::TooManyElements { .. }
    ));
    for (element, attribute) in [("clipPath", "clip-path"), ("mask", "mask")] {
        let mut body = format!(r#"<{element} id="e0"><path d="M0 0h1v1z"/></{element}>"#);
        for level in 1..14 {
            let inner = level - 1;
            let rect = format!(r##"<rect width="9" height="9" {attribute}="url(#e{inner})"/>"##);
            body += &format!(
                r#"<{element} id="e{level}">{}</{element}>"#,
                rect.repeat(10)
            );
        }
        body += &format!(r##"<rect width="9" height="9" {attribute}="url(#e13)"/>"##);
        assert!(matches!(
            refused_quickly(&body),
            SvgError::TooManyElements { .. }
        ));
    }
}

#[test]
fn nested_markers_do_not_hang() {
    let mut body = String::from(
        r#"<marker id="m0" markerWidth="3" markerHeight="3"><path d="M0 0h9v9z"/></marker>"#,
    );
    for level in 1..14 {
        let inner = level - 1;
        body += &format!(
            r##"<marker id="m{level}" markerWidth="3" markerHeight="3"><path d="M0 0h9v9h9z{}" marker-mid="url(#m{inner})"/></marker>"##,
            " l1 1".repeat(20)
        );
    }
    for attribute in [
        r##"marker-mid="url(#m13)""##,
        r##"style="marker:url(#m13) !important""##,
        r#"class="m""#,
    ] {
        let shape = format!(
            r##"{body}<style>.m {{ marker: url(#m13) !important }}</style>
        <g {attribute}><path stroke="red" d="M0 0h10v10h-10z"/></g>"##
        );
        let error = refused_quickly(&shape);
        assert!(matches!(error, SvgError::TooManyElements(_)), "{error}");
    }
}

#[test]
fn nested_entities_are_refused() {
    let mut entities = String::from("<!ENTITY e0 'x'>");
    for level in 1..12 {
        entities += &format!(
            "<!ENTITY e{level} '{}'>",
            format!("&e{};", level - 1).repeat(10)
        );
    }
    let text = format!("<!DOCTYPE svg [{entities}]><svg {NS}><title>&e11;</title></svg>");
    assert!(matches!(read(&text, 1e-3), Err(SvgError::Xml(_))));
}

#[test]
fn the_depth_limit_prevents_stack_overflow() {
    let nested = |levels: usize| {
        page(&format!(
            r#"{}<rect width="10" height="10"/>{}"#,
            "<g transform=\"scale(1)\" opacity=\"0.5\">".repeat(levels),
            "</g>".repeat(levels)
        ))
    };
    assert!(matches!(
        read(&nested(20_000), 1e-3),
        Err(SvgError::TooDeep { .. })
    ));
    let chain = bomb(200, 1, |level| format!(r##"<use href="#g{level}"/>"##));
    assert!(matches!(read_body(&chain), Err(SvgError::TooDeep { .. })));
    // The deepest allowed drawing must fit into half the default stack of a thread.
    let text = nested(error::MAX_DEPTH as usize - 1);
    let thread = std::thread::Builder::new().stack_size(1 << 20);
    let handle = thread
        .spawn(move || read(&text, 1e-3).is_ok())
        .expect("a thread");
    assert!(handle.join().expect("no overflow"));
}

#[test]
fn circular_references_are_ignored_and_reported() {
    let body = r##"<g id="a"><use id="u" href="#b"/><rect width="5" height="5"/></g>
        <g id="b"><use id="v" href="#a"/></g>
        <pattern id="p" width="9" height="9"><rect id="q" width="9" height="9" fill="url(#p)"/></pattern>
        <rect x="50" width="9" height="9" fill="url(#p)"/>"##;
    let found = stroked(body, None).expect("an outline");
    assert_near(found.regions.area(), 25.0);
    let notes: Vec<_> = found.notes.iter().map(ToString::to_string).collect();
    assert_eq!(
        notes,
        [
            "fill that refers to itself: ignored (#q)",
            "use of itself: ignored (#v)"
        ]
    );
    // The `href` of a link makes no copies, so it may refer to its own group.
    assert_near(
        regions(r##"<g id="a"><a href="#a"><rect width="9" height="9"/></a></g>"##).area(),
        81.0,
    );
}

#[test]
fn a_style_sheet_of_many_rules_does_not_hang() {
    let sheet = |selector: &str| {
        let rules = (0..20_000).map(|k| format!("{selector}.c{k}{{fill:red}}"));
        let rules = rules.collect::<String>();
        format!("<style>{rules}</style>{}", "<g/>".repeat(20_000))
    };
    assert!(matches!(
        refused_quickly(&sheet("")),
        SvgError::NothingFilled { .. }
    ));
    assert!(matches!(
        refused_quickly(&sheet("g:not(.a) ")),
        SvgError::NothingFilled { .. }
    ));
    assert!(matches!(
        refused_quickly(&sheet("g, g:not(.a)")),
        SvgError::TooMuchStyle { .. }
    ));
}

#[test]
fn a_stroke_of_countless_dashes_becomes_solid() {
    for (data, dashes) in [
        ("M0 50 h100", "1e-7"),
        // Found by fuzzing: the overlaps of these dashes took minutes.
        (
            "M10 50 L90 20 q1e-9 -3 1 20 M1e-9 -3 L20 1 1e9 90 v20 20 50",
            "2e-4",
        ),
    ] {
        let path = |dashes: &str| {
            format!(r#"<path d="{data}" stroke="black" stroke-dasharray="{dashes}"/>"#)
        };
        let start = Instant::now();
        let drawing = stroked(&path(dashes).repeat(3), None).expect("a drawing");
        assert!(start.elapsed() < ENDLESS);
        let notes: Vec<String> = drawing.notes.iter().map(ToString::to_string).collect();
        assert!(
            notes.iter().any(|note| note.contains("dashes")),
            "{notes:?}"
        );
        let solid = stroked(&path("none"), None).expect("a drawing");
        let areas = [&drawing, &solid].map(|drawing| drawing.regions.area());
        assert!((areas[0] - areas[1]).abs() < 1e-6 * areas[1], "{areas:?}");
    }
}

/// Tries all ways in which a drawing could refer to another file.
#[test]
fn nothing_outside_the_file_is_opened() {
    let folder = tempfile::tempdir().expect("a folder");
    let bait = folder.path().join("bait.svg");
    let shape = page(r#"<rect id="r" width="90" height="90"/>"#);
    std::fs::write(&bait, shape).expect("written");
    let bait = bait.display();
    for body in [
        format!(r##"<use href="{bait}#r"/>"##),
        format!(r##"<use href="file://{bait}#r"/>"##),
        format!(r#"<image href="{bait}" width="90" height="90"/>"#),
        format!(r#"<style>@import url("{bait}");</style>"#),
        format!(r##"<rect id="own" width="9" height="9" clip-path="url({bait}#r)" fill="none"/>"##),
    ] {
        assert!(stroked(&body, None).is_err(), "{body}");
    }
    let entity = format!(
        r#"<!DOCTYPE svg [<!ENTITY e SYSTEM "{bait}">]><svg {NS} width="9" height="9">&e;</svg>"#
    );
    assert!(read(&entity, 1e-3).is_err());
}
