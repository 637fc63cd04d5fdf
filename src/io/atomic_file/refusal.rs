//! Messages for files that could not be written: the reason and what to do.

use std::io::{self, ErrorKind};

/// Returns why a file could not be written and what to do about it, in one line. The caller adds
/// the path.
pub(crate) fn write_error_message(error: &io::Error) -> String {
    match reason_and_remedy(error.kind()) {
        Some((reason, remedy)) => format!("{reason}; {remedy}"),
        None => format!("{error}; choose another folder or name"),
    }
}

/// Returns only why a file could not be written, for files whose location the user cannot choose.
#[cfg(feature = "app")]
pub(crate) fn write_error_reason(error: &io::Error) -> String {
    reason_and_remedy(error.kind())
        .map_or_else(|| error.to_string(), |(reason, _)| reason.to_owned())
}

/// Returns the reason and the remedy; `None` for kinds of error that a user cannot act on.
fn reason_and_remedy(kind: ErrorKind) -> Option<(&'static str, &'static str)> {
    Some(match kind {
        ErrorKind::StorageFull => (
            "the disk is full",
            "free some space, or choose a folder on another disk",
        ),
        ErrorKind::QuotaExceeded => (
            "your disk quota is used up",
            "free some space, or choose a folder on another disk",
        ),
        ErrorKind::FileTooLarge => (
            "the file is larger than the system allows",
            "choose a folder on another disk, or fewer or smaller images",
        ),
        ErrorKind::ReadOnlyFilesystem => {
            ("the disk is read-only", "choose a folder on another disk")
        }
        ErrorKind::PermissionDenied => (
            "you do not have permission to write there",
            "choose another folder, or change its permissions",
        ),
        ErrorKind::NotFound => (
            "its folder does not exist",
            "create the folder, or choose an existing one",
        ),
        ErrorKind::NotADirectory => (
            "a part of its path is not a folder",
            "choose an existing folder",
        ),
        // Occurs when the program creates a folder and a file already has its name.
        ErrorKind::AlreadyExists => ("the name is already in use", "choose another name"),
        ErrorKind::IsADirectory => ("it is a folder", "choose another name"),
        _ => return None,
    })
}
