//! Files: atomic writes, bounded reads, file names, and text from files made safe to show.

pub(crate) mod atomic_file;
#[cfg(feature = "cli")]
pub(crate) mod file_name;
pub(crate) mod read;
pub(crate) mod sanitize;
