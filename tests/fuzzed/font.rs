//! Any bytes as a font: letters become a design or a one-line error.

use super::design_check::check_design;
use morphospace::design::{DesignSource, ImportOptions};

/// Texts that are drawn: a plain letter, one with a hole, and composites with a ligature.
const TEXTS: [&str; 3] = ["A", "e", "fiÅ"];

/// Draws letters of a font.
pub fn check_font(bytes: &[u8]) {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("font.ttf");
    std::fs::write(&path, bytes).expect("written");
    for text in TEXTS {
        let source = DesignSource::Text {
            text: text.to_owned(),
            font: Some(path.clone()),
        };
        check_design(source.import(&ImportOptions::default()));
    }
}
