//! Where a project comes from, and its designs.

use std::path::{Path, PathBuf};

use crate::design::DesignSource;

/// Where the open project comes from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ProjectOrigin {
    /// A bundled project, by its name.
    Gallery(String),
    /// A file.
    File(PathBuf),
    /// Designs that were opened together, or a project that was changed beyond its file.
    Unsaved,
}

/// A design's path from the root, whatever within the file it names.
#[must_use]
pub fn absolute(path: &Path) -> PathBuf {
    // Not canonical: a link that is followed later names the file that it then points to.
    let whole = |file: &Path| std::path::absolute(file).unwrap_or_else(|_| file.to_owned());
    DesignSource::of(path).at(whole).to_path()
}
