//! Checks that hold for every importer.

use morphospace::Design;
use morphospace::design::{Format, ImportError, ImportOptions, import, sniff};

/// Imports the bytes if they are recognised as a wanted format, and checks the result.
pub fn check_import(bytes: &[u8], is_wanted: impl Fn(Format) -> bool) {
    if sniff(bytes).is_ok_and(is_wanted) {
        check_design(import("fuzzed", bytes, &ImportOptions::default()));
    }
}

/// Checks that a design has finite bounds and an outline of positive area, or that its error is one
/// line.
pub fn check_design(imported: Result<Design, ImportError>) {
    match imported {
        Ok(design) => {
            let bounds = design.form.bounds();
            assert!(bounds.min.is_finite() && bounds.max.is_finite());
            // Bars have an outline only if they have a width.
            if let Ok(outline) = design.outline(0.02) {
                assert!(outline.area().is_finite() && outline.area() > 0.0);
            }
        }
        Err(error) => check_message(&error),
    }
}

/// Checks that an error is one line without control characters.
pub fn check_message(error: &dyn std::error::Error) {
    let message = error.to_string();
    assert!(!message.chars().any(char::is_control), "{message:?}");
}
