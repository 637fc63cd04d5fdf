//! Files that are there whole or not at all.
//!
//! A temporary file in the same folder is written and renamed at the end.
//! Guarantees: until [`AtomicFile::commit`] the old file, if any, is untouched;
//! after it the new one is on the disk, and not only on its way there; dropping
//! without it removes the temporary file. A killed process can leave the
//! temporary file behind, never a half one under the final name, and the next
//! one that writes into the folder takes it away. A file that takes the place of
//! another is as open as that was. Only files are replaced: never a device, a
//! pipe or a folder.

mod leftovers;
mod refusal;

use std::fs::{self, File};
use std::io::{self, Read, Seek, Write};
use std::path::{Path, PathBuf};

pub(crate) use leftovers::remove_leftovers;
#[cfg(feature = "app")]
pub(crate) use refusal::reason;
pub(crate) use refusal::refusal;

/// A file on its way.
#[derive(Debug)]
pub(crate) struct AtomicFile {
    file: File,
    temporary: PathBuf,
    path: PathBuf,
    is_there: bool,
}

impl AtomicFile {
    /// Opens a temporary file beside `path`, and takes away those that killed
    /// processes left there.
    pub(crate) fn create(path: &Path) -> io::Result<Self> {
        remove_leftovers(folder_of(path));
        Self::create_one_of_many(path)
    }

    /// The same for a folder of many, of which leftovers are taken away once.
    pub(crate) fn create_one_of_many(path: &Path) -> io::Result<Self> {
        let old = fs::metadata(path).ok();
        if let Some(old) = old.as_ref().filter(|old| !old.is_file()) {
            let is_folder = old.is_dir();
            return Err(if is_folder {
                io::ErrorKind::IsADirectory.into()
            } else {
                io::Error::other("it is a device or a pipe")
            });
        }
        let (file, temporary) = leftovers::create_beside(path, folder_of(path))?;
        let created = Self {
            file,
            temporary,
            path: path.to_owned(),
            is_there: false,
        };
        // No old file, no permissions to take over.
        if let Some(old) = old {
            created.file.set_permissions(old.permissions())?;
        }
        Ok(created)
    }

    /// Where the bytes go until [`Self::commit`].
    pub(crate) fn file_mut(&mut self) -> &mut File {
        &mut self.file
    }

    /// What was written, from its beginning.
    pub(crate) fn written(&mut self) -> io::Result<&mut File> {
        self.file.rewind()?;
        Ok(&mut self.file)
    }

    /// The temporary file's path, for another program to write.
    #[cfg(not(target_family = "wasm"))] // no other programs there
    pub(crate) fn temporary_path(&self) -> &Path {
        &self.temporary
    }

    /// Gives the file its name, once it is on the disk: a full one on a network
    /// tells so only then, and a power cut leaves the old file or the new one.
    pub(crate) fn commit(mut self) -> io::Result<()> {
        self.file.sync_all()?;
        fs::rename(&self.temporary, &self.path)?;
        self.is_there = true;
        Ok(())
    }
}

impl Drop for AtomicFile {
    fn drop(&mut self) {
        // After a commit the name is free, and may be another one's by now.
        if !self.is_there {
            fs::remove_file(&self.temporary).unwrap_or_default();
        }
    }
}

/// Writes a whole file at once.
pub(crate) fn write(path: &Path, bytes: &[u8]) -> io::Result<()> {
    write_to(AtomicFile::create(path)?, bytes)
}

/// Writes one file of a folder of many, as [`AtomicFile::create_one_of_many`].
pub(crate) fn write_one_of_many(path: &Path, bytes: &[u8]) -> io::Result<()> {
    write_to(AtomicFile::create_one_of_many(path)?, bytes)
}

fn write_to(mut file: AtomicFile, bytes: &[u8]) -> io::Result<()> {
    file.file_mut().write_all(bytes)?;
    let mut written = Vec::with_capacity(bytes.len());
    file.written()?.read_to_end(&mut written)?;
    if written != bytes {
        return Err(io::Error::other("the disk gives back other bytes"));
    }
    file.commit()
}

fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        // A bare name has a parent without a name, which cannot be opened.
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
    fn others_may_read_what_any_new_file_lets_them() {
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
