//! Files as they are read: whole, of a bounded size, and nothing that only
//! looks like one.
//!
//! Guaranteed: what is no file is refused before it is opened, for a device
//! need not end and a pipe waits for its writer; no more than
//! [`MAX_FILE_BYTES`] are ever taken into memory, whatever the system says of
//! the size.

use std::fs::{File, Metadata, metadata};
use std::io::{self, Read};
use std::path::Path;

/// Largest file that is read. A bound on memory and no more: a file is held
/// whole while it is read, a drawing takes some ten times its size on the way,
/// and one that a person made is far smaller. A mesh of a million vertices has
/// 75 to 130 MiB as OBJ.
pub const MAX_FILE_BYTES: u64 = 256 << 20;

/// Why a file was not read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReadError {
    /// There is no such file.
    #[error("there is no such file; check the path, or choose another file")]
    Missing,
    /// It is a folder.
    #[error("this is a folder; choose a file in it")]
    Folder,
    /// It is a device, a pipe or a socket.
    #[error("this is a device or a pipe and no file; save what comes out of it, and choose that")]
    NoFile,
    /// It is larger than any design should be.
    #[error(
        "the file has more than the {} MiB that are read; save a smaller or simpler version",
        MAX_FILE_BYTES >> 20
    )]
    TooLarge,
    /// The system refuses to hand it out.
    #[error("the file cannot be read ({0}); check that it may be opened")]
    Refused(#[source] io::Error),
}

/// The bytes of a file.
pub(crate) fn read(path: &Path) -> Result<Vec<u8>, ReadError> {
    check_kind(&metadata(path)?)?;
    let file = File::open(path)?;
    // Again, for another may have taken its place.
    check_kind(&file.metadata()?)?;
    let mut bytes = Vec::new();
    // Not by the size that the system tells: it says 0 of files that it makes
    // up as they are read.
    file.take(MAX_FILE_BYTES + 1).read_to_end(&mut bytes)?;
    check_size(&bytes)?;
    Ok(bytes)
}

/// That there are no more bytes than are read.
pub(crate) fn check_size(bytes: &[u8]) -> Result<(), ReadError> {
    match bytes.len() as u64 > MAX_FILE_BYTES {
        true => Err(ReadError::TooLarge),
        false => Ok(()),
    }
}

fn check_kind(metadata: &Metadata) -> Result<(), ReadError> {
    match metadata {
        m if m.is_dir() => Err(ReadError::Folder),
        m if !m.is_file() => Err(ReadError::NoFile),
        m if m.len() > MAX_FILE_BYTES => Err(ReadError::TooLarge),
        _ => Ok(()),
    }
}

impl From<io::Error> for ReadError {
    fn from(error: io::Error) -> Self {
        match error.kind() {
            io::ErrorKind::NotFound => Self::Missing,
            _ => Self::Refused(error),
        }
    }
}
