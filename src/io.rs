//! File input and output: atomic writes, bounded reads, identity of files, portable file names,
//! escaping of text from files so that it is safe to display, and of text for the formats that are written.

pub(crate) mod atomic_file;
pub(crate) mod escape;
#[cfg(any(unix, feature = "cli"))]
pub(crate) mod file_id;
#[cfg(feature = "cli")]
pub(crate) mod file_name;
pub(crate) mod path_text;
pub(crate) mod read;
pub(crate) mod sanitize;
