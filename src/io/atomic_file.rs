//! Atomic writing: a file appears complete under its name, or not at all.
//!
//! The bytes go into a temporary file in the same folder. [`AtomicFile::commit`] flushes it to the
//! disk and renames it to the final name; until then, an existing file of that name is untouched.
//! Dropping an uncommitted [`AtomicFile`] removes the temporary file. A killed process may leave
//! its temporary file behind; the next write into that folder removes it. The new file gets the
//! permissions of the file that it replaces. Devices, pipes and folders are never replaced.

mod leftovers;
mod refusal;

use std::fs::{self, File};
use std::io::{self, Read, Seek, Write};
use std::path::{Path, PathBuf};

pub(crate) use leftovers::remove_leftovers;
pub(crate) use refusal::write_error_message;
#[cfg(feature = "app")]
pub(crate) use refusal::write_error_reason;

/// A temporary file that [`Self::commit`] renames to its final path.
#[derive(Debug)]
pub(crate) struct AtomicFile {
    file: File,
    temporary: PathBuf,
    path: PathBuf,
    is_committed: bool,
}

impl AtomicFile {
    /// Creates a temporary file next to `path`, and removes the temporary files that killed
    /// processes left in that folder.
    pub(crate) fn create(path: &Path) -> io::Result<Self> {
        remove_leftovers(folder_of(path));
        Self::create_without_cleanup(path)
    }

    /// Like [`Self::create`], but does not remove the temporary files of killed processes.
    ///
    /// For writing many files into one folder: the caller removes them once with
    /// [`remove_leftovers`].
    pub(crate) fn create_without_cleanup(path: &Path) -> io::Result<Self> {
        let old = fs::metadata(path).ok();
        if let Some(old) = old.as_ref().filter(|old| !old.is_file()) {
            let is_folder = old.is_dir();
            return Err(if is_folder {
                io::ErrorKind::IsADirectory.into()
            } else {
                io::Error::other("it is a device or a pipe")
            });
        }
        let (file, temporary) = leftovers::create_temporary(path, folder_of(path))?;
        let created = Self {
            file,
            temporary,
            path: path.to_owned(),
            is_committed: false,
        };
        if let Some(old) = old {
            created.file.set_permissions(old.permissions())?;
        }
        Ok(created)
    }

    /// Returns the temporary file, for writing.
    pub(crate) fn file_mut(&mut self) -> &mut File {
        &mut self.file
    }

    /// Rewinds the temporary file and returns it, for reading back its contents.
    pub(crate) fn reread(&mut self) -> io::Result<&mut File> {
        self.file.rewind()?;
        Ok(&mut self.file)
    }

    /// Returns the path of the temporary file, for another program to write to.
    #[cfg(not(target_family = "wasm"))] // cannot start other programs
    pub(crate) fn temporary_path(&self) -> &Path {
        &self.temporary
    }

    /// Flushes the temporary file to the disk and gives it its final name.
    ///
    /// A full network disk reports its error only on flushing. After a power cut, either the old
    /// or the new file exists, complete.
    pub(crate) fn commit(mut self) -> io::Result<()> {
        self.file.sync_all()?;
        fs::rename(&self.temporary, &self.path)?;
        self.is_committed = true;
        Ok(())
    }
}

impl Drop for AtomicFile {
    fn drop(&mut self) {
        // After a commit, another process may have created a file with the temporary name.
        if !self.is_committed {
            fs::remove_file(&self.temporary).unwrap_or_default();
        }
    }
}

/// Writes `bytes` atomically as the file `path`.
pub(crate) fn write(path: &Path, bytes: &[u8]) -> io::Result<()> {
    write_to(AtomicFile::create(path)?, bytes)
}

/// Like [`write`], but does not remove the temporary files of killed processes; see
/// [`AtomicFile::create_without_cleanup`].
pub(crate) fn write_without_cleanup(path: &Path, bytes: &[u8]) -> io::Result<()> {
    write_to(AtomicFile::create_without_cleanup(path)?, bytes)
}

/// Writes `bytes` to the temporary file, reads them back to detect a faulty disk, and commits.
fn write_to(mut file: AtomicFile, bytes: &[u8]) -> io::Result<()> {
    file.file_mut().write_all(bytes)?;
    let mut written = Vec::with_capacity(bytes.len());
    file.reread()?.read_to_end(&mut written)?;
    if written != bytes {
        return Err(io::Error::other("reading back gave different bytes"));
    }
    file.commit()
}

/// Returns the folder that contains `path`.
fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        // The parent of a bare file name is the empty path, which cannot be opened.
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_dropped_file_leaves_the_old_one_and_nothing_else() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("x.png");
        write(&path, b"old").expect("written");
        let mut file = AtomicFile::create(&path).expect("created");
        file.file_mut().write_all(b"ne").expect("written");
        drop(file);
        assert_eq!(fs::read(&path).expect("read"), b"old");
        assert_eq!(fs::read_dir(&folder).expect("listed").count(), 1);
        write(&path, b"new").expect("written");
        assert_eq!(fs::read(&path).expect("read"), b"new");
    }

    #[test]
    fn only_files_are_replaced() {
        let folder = tempfile::tempdir().expect("a folder");
        let error = write(folder.path(), b"x").expect_err("a folder");
        assert_eq!(error.kind(), io::ErrorKind::IsADirectory);
        #[cfg(unix)]
        assert!(write(Path::new("/dev/null"), b"x").is_err());
    }

    #[cfg(unix)]
    #[test]
    fn permissions_are_those_of_a_new_file_or_of_the_replaced_one() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().expect("a folder");
        let mode = |name: &str| {
            let data = fs::metadata(folder.path().join(name)).expect("metadata");
            data.permissions().mode()
        };
        fs::write(folder.path().join("plain"), b"").expect("written");
        write(&folder.path().join("atomic"), b"").expect("written");
        assert_eq!(mode("plain"), mode("atomic"));
        let private = fs::Permissions::from_mode(0o600);
        fs::set_permissions(folder.path().join("atomic"), private).expect("set");
        write(&folder.path().join("atomic"), b"").expect("written");
        assert_eq!(mode("atomic") & 0o777, 0o600);
    }
}
