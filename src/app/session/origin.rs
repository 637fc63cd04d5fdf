//! Origin of a project, and absolute paths of its designs.

use std::path::{Path, PathBuf};

use crate::design::DesignSource;

/// Origin of the open project.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ProjectOrigin {
    /// A gallery project with this name.
    Gallery(String),
    /// A project file.
    File(PathBuf),
    /// No file yet: designs that were opened together.
    Unsaved,
}

/// Absolute path of a design. If the path also names an element of the file, as in
/// `leaf.svg#stalk`, the element stays the same.
#[must_use]
pub fn absolute(path: &Path) -> PathBuf {
    // The path is not canonicalised, so that a symbolic link leads to its later target if it is
    // changed.
    let absolute_file = |file: &Path| std::path::absolute(file).unwrap_or_else(|_| file.to_owned());
    DesignSource::from_path(path)
        .map_file(absolute_file)
        .to_path()
}
