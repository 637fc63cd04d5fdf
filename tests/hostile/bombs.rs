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
