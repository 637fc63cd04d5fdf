//! Checks that hold for every importer.

use morphospace::design::{Format, ImportOptions, import, sniff};

/// Imports the bytes if they are recognised as a wanted format.
///
/// A design must have finite bounds and an outline of positive area; an error must be one line
/// without control characters.
pub fn check_import(bytes: &[u8], is_wanted: impl Fn(Format) -> bool) {
    if !sniff(bytes).is_ok_and(is_wanted) {
        return;
    }
    match import("fuzzed", bytes, &ImportOptions::default()) {
        Ok(design) => {
            let bounds = design.form.bounds();
            assert!(bounds.min.is_finite() && bounds.max.is_finite());
            // Bars have an outline only if they have a width.
            if let Ok(outline) = design.outline(0.02) {
                assert!(outline.area().is_finite() && outline.area() > 0.0);
            }
        }
        Err(error) => assert!(is_one_line(&error.to_string()), "{error:?}"),
    }
}

fn is_one_line(message: &str) -> bool {
    !message.chars().any(char::is_control)
}
