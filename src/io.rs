//! File input and output: atomic writes, bounded reads, identity of files, portable file names, paths
//! in text files, and escaping of text for display and for each file format.

pub(crate) mod atomic_file;
pub(crate) mod escape;
#[cfg(any(unix, feature = "cli"))]
pub(crate) mod file_id;
#[cfg(feature = "cli")]
pub(crate) mod file_name;
pub(crate) mod path_text;
pub(crate) mod read;
pub(crate) mod sanitize;
