//! The files of the gallery, held in the binary.

use include_dir::{Dir, File, include_dir};
use std::path::Path;

static FILES: Dir<'static> = include_dir!("$CARGO_MANIFEST_DIR/assets/gallery");

/// The content of a bundled file, by its path in a bundled document.
#[must_use]
pub fn bytes(path: &Path) -> Option<&'static [u8]> {
    FILES.get_file(path).map(File::contents)
}

/// The text of a bundled document.
pub(super) fn text(file: &Path) -> Option<&'static str> {
    FILES.get_file(file).and_then(File::contents_utf8)
}

/// The names of the bundled documents.
pub(super) fn names() -> impl Iterator<Item = &'static str> {
    FILES
        .files()
        .filter_map(|file| file.path().to_str()?.strip_suffix(".morph"))
}
