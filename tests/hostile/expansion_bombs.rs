//! Tests of small files that expand to huge documents, and of huge JSON files. They are refused
//! before they take much memory or time; drawings that are merely slow are simplified.

use crate::bounded_run::BoundedFixture;

fn svg(head: &str, body: &str) -> String {
    format!("{head}<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 9 9\">{body}</svg>")
}

#[test]
fn svg_files_that_expand_beyond_the_limits_are_refused() {
    let fixture = BoundedFixture::new();
    let long = format!("<!DOCTYPE svg [<!ENTITY a \"{}\">]>", "x".repeat(50_000));
    let text = format!("<text>{}</text>", "&a;".repeat(20_000));
    fixture.write("entity.svg", svg(&long, &text));
    fixture.assert_refused("entity.svg", "save it without entities");
    let attributes: String = (0..200_000).map(|i| format!(" a{i}=\"\"")).collect();
    fixture.write("attributes.svg", svg("", &format!("<g{attributes}/>")));
    fixture.assert_refused("attributes.svg", "has 200000 attributes");
    let names: String = (0..60_000)
        .map(|i| format!("<g xmlns:a{i}=\"b\">"))
        .collect();
    fixture.write("names.svg", svg("", &names));
    fixture.assert_refused("names.svg", "declares 60001 namespaces");
    fixture.write(
        "signs.svg",
        svg("", &format!("<!--{}-->", "<=".repeat(5_000_000))),
    );
    fixture.assert_refused("signs.svg", "more than 2000000 elements");
}

/// SVG elements of `count` overlapping squares in two alternating colours.
fn overlapping_squares(count: usize) -> String {
    let square = |k: usize| {
        let (x, y) = (k * 37 % 901, k * 101 % 907);
        let colour = ["#e63946", "#457b9d"][k % 2];
        format!("<path fill=\"{colour}\" d=\"M{x} {y}h90v90h-90z\"/>")
    };
    (0..count).map(square).collect()
}

#[test]
fn slow_drawings_are_simplified() {
    let fixture = BoundedFixture::new();
    let page = |body: &str| svg("", &format!("<rect width=\"9\" height=\"9\"/>{body}"));
    let marks = "\u{301}".repeat(5000);
    let ideographs: String = (0x4e00..0x5200).filter_map(char::from_u32).collect();
    let spans: String = (0..900)
        .map(|k| format!("<tspan font-family=\"f{k}\">ab</tspan>"))
        .collect();
    for (name, body, note) in [
        (
            "heap.svg",
            format!("<g opacity=\".5\">{}</g>", overlapping_squares(10_000)),
            "painted approximately",
        ),
        (
            "long.svg",
            format!("<text>{}</text>", "word ".repeat(400_000)),
            "too long",
        ),
        ("spans.svg", format!("<text>{spans}</text>"), "too long"),
        ("marks.svg", format!("<text>a{marks}</text>"), ""),
        ("strange.svg", format!("<text>{ideographs}</text>"), ""),
    ] {
        fixture.write(name, page(&body));
        let output = fixture.run_long(&["check", name, "square.json", "--method", "field"]);
        assert_eq!(output.code, Some(0), "{name}: {output:?}");
        assert!(output.stdout.contains(note), "{name}: {output:?}");
    }
}

#[test]
fn huge_and_deep_json_is_refused() {
    let fixture = BoundedFixture::new();
    fixture.write(
        "objects.json",
        format!("[{}0]", "{\"\":0},".repeat(1_200_000)),
    );
    fixture.assert_refused("objects.json", "more than 1000000 objects");
    fixture.write("lists.json", format!("[{}0]", "[],".repeat(3_000_000)));
    fixture.assert_refused("lists.json", "lists.json");
    fixture.write("deep.json", "[".repeat(5_000_000));
    fixture.assert_refused("deep.json", "deep.json: line 1");
}
