//! File input and output: atomic writes, bounded reads, portable file names, and escaping of text
//! from files so that it is safe to display.

pub(crate) mod atomic_file;
#[cfg(feature = "cli")]
pub(crate) mod file_name;
pub(crate) mod read;
pub(crate) mod sanitize;
