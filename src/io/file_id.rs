//! Identity of files: whether two paths lead to the same file.
//!
//! Paths differ for the same file because of links, `./x` for `x`, or another letter case on a file
//! system that ignores it. On systems other than Unix, hard links count as different files.

use std::path::Path;

/// Identity of an existing file or folder: on Unix its device and inode numbers, elsewhere its
/// canonical path.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct FileId(
    #[cfg(unix)] (u64, u64),
    #[cfg(not(unix))] std::path::PathBuf,
);

impl FileId {
    /// Returns the identity of the file to which a path leads; `None` if it leads to no file.
    #[cfg(unix)]
    pub(crate) fn of(path: &Path) -> Option<Self> {
        std::fs::metadata(path).ok().as_ref().map(Self::of_metadata)
    }

    /// Returns the identity of the file to which a path leads; `None` if it leads to no file.
    #[cfg(not(unix))]
    pub(crate) fn of(path: &Path) -> Option<Self> {
        path.canonicalize().ok().map(Self)
    }

    /// Returns the identity of the file with this metadata.
    #[cfg(unix)]
    pub(crate) fn of_metadata(metadata: &std::fs::Metadata) -> Self {
        use std::os::unix::fs::MetadataExt;
        Self((metadata.dev(), metadata.ino()))
    }
}
