//! Why a file could not be written, in words that end in a way out.

use std::io::{self, ErrorKind};

/// What the system refused, and what to do; no path, which the caller knows
/// better.
pub(crate) fn refusal(error: &io::Error) -> String {
    match words(error.kind()) {
        Some((reason, way_out)) => format!("{reason}; {way_out}"),
        None => format!("{error}; choose another folder or name"),
    }
}

/// What the system refused alone, where nobody is asked for another place.
#[cfg(feature = "app")]
pub(crate) fn reason(error: &io::Error) -> String {
    words(error.kind()).map_or_else(|| error.to_string(), |(reason, _)| reason.to_owned())
}

/// Why, and what to do.
fn words(kind: ErrorKind) -> Option<(&'static str, &'static str)> {
    Some(match kind {
        ErrorKind::StorageFull => (
            "the disk is full",
            "make room on it, or choose a folder on another one",
        ),
        ErrorKind::QuotaExceeded => (
            "your share of the disk is full",
            "make room in it, or choose a folder on another disk",
        ),
        ErrorKind::FileTooLarge => (
            "the file is larger than the system allows",
            "choose a folder on another disk, or fewer or smaller pictures",
        ),
        ErrorKind::ReadOnlyFilesystem => (
            "the disk can only be read",
            "choose a folder on another one",
        ),
        ErrorKind::PermissionDenied => (
            "the system does not let you write there",
            "choose another folder, or change its permissions",
        ),
        ErrorKind::NotFound => (
            "its folder does not exist",
            "make the folder, or choose one that exists",
        ),
        ErrorKind::NotADirectory => (
            "a part of its path is no folder",
            "choose a folder that exists",
        ),
        // Of a folder that was to be made.
        ErrorKind::AlreadyExists => ("something of that name is there", "choose another name"),
        ErrorKind::IsADirectory => ("it is a folder", "choose another name"),
        _ => return None,
    })
}
