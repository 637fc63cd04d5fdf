//! Drawings with strokes, dashes, markers and text on a path: they become a design or a one-line
//! error.

use super::design_check::check_design;
use morphospace::design::{ImportOptions, import};

/// Imports a drawing with the path `data` and with `words` along it, both with the style `style`.
pub fn check_strokes(data: &str, style: &str, words: &str) {
    let [data, style, words] = [data, style, words].map(escaped);
    let drawing = format!(
        r##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 100 100">
        <marker id="m" markerWidth="4" markerHeight="4"><rect width="4" height="4"/></marker>
        <path id="p" d="{data}" fill="none" stroke="#000" style="{style}"/>
        <text font-size="9" style="{style}"><textPath href="#p">{words}</textPath></text></svg>"##
    );
    check_design(import(
        "fuzzed.svg",
        drawing.as_bytes(),
        &ImportOptions::default(),
    ));
}

/// Escapes a text for XML. Characters that XML forbids are left out.
fn escaped(text: &str) -> String {
    let is_allowed = |c: &char| !c.is_control() && !matches!(c, '\u{fffe}' | '\u{ffff}');
    let text: String = text.chars().filter(is_allowed).collect();
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('"', "&quot;")
}
