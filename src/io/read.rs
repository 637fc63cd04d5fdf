//! Bounded reading of whole files.
//!
//! Folders, devices and pipes are refused before they are opened: a device may never end, and a
//! pipe blocks until something writes to it. At most [`MAX_FILE_BYTES`] are read into memory,
//! whatever size the system reports.

use std::fs::{File, Metadata, metadata};
use std::io::{self, Read};
use std::path::Path;

/// Maximum size of a file, in bytes (resource limit: the file is held in memory as a whole, and
/// importing a drawing takes about ten times its size; an OBJ mesh of a million vertices has 75
/// to 130 MiB).
pub const MAX_FILE_BYTES: u64 = 256 << 20;

/// Reason why a file was not read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReadError {
    /// The file does not exist.
    #[error("the file does not exist; check the path, or choose another file")]
    Missing,
    /// The path leads to a folder.
    #[error("this is a folder; choose a file in it")]
    Folder,
    /// The path leads to a device, a pipe or a socket.
    #[error("this is a device or a pipe, not a file; save its output to a file and choose that")]
    NotRegularFile,
    /// The file is larger than [`MAX_FILE_BYTES`].
    #[error(
        "the file is larger than the limit of {} MiB; save a smaller or simpler version",
        MAX_FILE_BYTES >> 20
    )]
    TooLarge,
    /// The operating system reported an error.
    #[error("the file cannot be read ({0}); check its permissions")]
    Io(#[source] io::Error),
}

/// Returns the bytes of a file.
pub(crate) fn read(path: &Path) -> Result<Vec<u8>, ReadError> {
    check_kind(&metadata(path)?)?;
    let file = File::open(path)?;
    // Checked again on the open file, because another file may have taken the path in between.
    check_kind(&file.metadata()?)?;
    let mut bytes = Vec::new();
    // The reported size cannot be trusted: it is 0 for virtual files such as those in /proc.
    file.take(MAX_FILE_BYTES + 1).read_to_end(&mut bytes)?;
    check_size(&bytes)?;
    Ok(bytes)
}

/// Checks that `bytes` is not longer than [`MAX_FILE_BYTES`].
pub(crate) fn check_size(bytes: &[u8]) -> Result<(), ReadError> {
    match bytes.len() as u64 > MAX_FILE_BYTES {
        true => Err(ReadError::TooLarge),
        false => Ok(()),
    }
}

/// Checks that the metadata belongs to a regular file within the size limit.
fn check_kind(metadata: &Metadata) -> Result<(), ReadError> {
    match metadata {
        m if m.is_dir() => Err(ReadError::Folder),
        m if !m.is_file() => Err(ReadError::NotRegularFile),
        m if m.len() > MAX_FILE_BYTES => Err(ReadError::TooLarge),
        _ => Ok(()),
    }
}

impl From<io::Error> for ReadError {
    fn from(error: io::Error) -> Self {
        match error.kind() {
            io::ErrorKind::NotFound => Self::Missing,
            _ => Self::Io(error),
        }
    }
}
