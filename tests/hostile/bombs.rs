//! Small files that stand for a lot: refused before it is taken.

use crate::child::Folder;

fn svg(head: &str, body: &str) -> String {
    format!("{head}<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 9 9\">{body}</svg>")
}

#[test]
fn drawings_that_unfold_are_refused() {
    let folder = Folder::new();
    let long = format!("<!DOCTYPE svg [<!ENTITY a \"{}\">]>", "x".repeat(50_000));
    let text = format!("<text>{}</text>", "&a;".repeat(20_000));
    folder.put("entity.svg", svg(&long, &text));
    folder.refused("entity.svg", "save it without entities");
    let attributes: String = (0..200_000).map(|i| format!(" a{i}=\"\"")).collect();
    folder.put("attributes.svg", svg("", &format!("<g{attributes}/>")));
    folder.refused("attributes.svg", "has 200000 attributes");
    let names: String = (0..60_000)
        .map(|i| format!("<g xmlns:a{i}=\"b\">"))
        .collect();
    folder.put("names.svg", svg("", &names));
    folder.refused("names.svg", "declares 60001 namespaces");
    folder.put(
        "signs.svg",
        svg("", &format!("<!--{}-->", "<=".repeat(5_000_000))),
    );
    folder.refused("signs.svg", "more than 2000000 elements");
}

/// Squares all over a page, each over a hundred others, in two colours in turns.
fn heap(count: usize) -> String {
    let square = |k: usize| {
        let (x, y) = (k * 37 % 901, k * 101 % 907);
        let colour = ["#e63946", "#457b9d"][k % 2];
        format!("<path fill=\"{colour}\" d=\"M{x} {y}h90v90h-90z\"/>")
    };
    (0..count).map(square).collect()
}

#[test]
fn drawings_that_take_long_are_drawn_more_simply() {
    let folder = Folder::new();
    let page = |body: &str| svg("", &format!("<rect width=\"9\" height=\"9\"/>{body}"));
    let marks = "\u{301}".repeat(5000);
    let strange: String = (0x4e00..0x5200).filter_map(char::from_u32).collect();
    let spans: String = (0..900)
        .map(|k| format!("<tspan font-family=\"f{k}\">ab</tspan>"))
        .collect();
    for (name, body, said) in [
        (
            "heap.svg",
            format!("<g opacity=\".5\">{}</g>", heap(10_000)),
            "not mixed",
        ),
        (
            "long.svg",
            format!("<text>{}</text>", "word ".repeat(400_000)),
            "too long",
        ),
        ("spans.svg", format!("<text>{spans}</text>"), "too long"),
        ("marks.svg", format!("<text>a{marks}</text>"), ""),
        ("strange.svg", format!("<text>{strange}</text>"), ""),
    ] {
        folder.put(name, page(&body));
        let answer = folder.ask_patiently(&["check", name, "square.json", "--method", "field"]);
        assert_eq!(answer.code, Some(0), "{name}: {answer:?}");
        assert!(answer.data.contains(said), "{name}: {answer:?}");
    }
}

#[test]
fn objects_without_end_are_refused() {
    let folder = Folder::new();
    folder.put(
        "objects.json",
        format!("[{}0]", "{\"\":0},".repeat(1_200_000)),
    );
    folder.refused("objects.json", "more than 1000000 objects");
    folder.put("lists.json", format!("[{}0]", "[],".repeat(3_000_000)));
    folder.refused("lists.json", "lists.json");
    folder.put("deep.json", "[".repeat(5_000_000));
    folder.refused("deep.json", "deep.json: line 1");
}
