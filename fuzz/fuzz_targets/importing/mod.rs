//! What holds of every importer.

use morphospace::design::{Format, ImportOptions, import, sniff};

/// Reads what is of the wanted format. A design can be outlined; an error is
/// one line without control characters.
pub fn import_if(bytes: &[u8], is_wanted: impl Fn(Format) -> bool) {
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
