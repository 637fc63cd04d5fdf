//! Files that are there whole or not at all.
//!
//! A temporary file in the same folder is written and renamed at the end.
//! Guarantees: until [`AtomicFile::commit`] the old file, if any, is untouched;
//! dropping without it removes the temporary file. A killed process can leave
//! the temporary file behind, never a half one under the final name. A file
//! that takes the place of another is as open as that was. Does not wait for
//! the disk, but where [`AtomicFile::file_mut`] is told to.

use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

/// A file on its way.
#[derive(Debug)]
pub(crate) struct AtomicFile {
    temporary: NamedTempFile,
    path: PathBuf,
}

impl AtomicFile {
    /// Opens a temporary file beside `path`.
    pub(crate) fn create(path: &Path) -> io::Result<Self> {
        let folder = match path.parent() {
            // A bare name has a parent without a name, which cannot be opened.
            Some(parent) if !parent.as_os_str().is_empty() => parent,
            _ => Path::new("."),
        };
        // `make_in` with `create_new` gives the permissions that any new file
        // has; tempfile's own would be readable by the owner alone.
        let temporary = tempfile::Builder::new()
            .prefix(".morphospace-")
            .suffix(".part")
            .make_in(folder, |temporary| File::create_new(temporary))?;
        // No old file, no permissions to take over.
        if let Ok(old) = fs::metadata(path) {
            temporary.as_file().set_permissions(old.permissions())?;
        }
        Ok(Self {
            temporary,
            path: path.to_owned(),
        })
    }

    /// Where the bytes go until [`Self::commit`].
    pub(crate) fn file_mut(&mut self) -> &mut File {
        self.temporary.as_file_mut()
    }

    /// The temporary file's path, for another program to write.
    #[cfg(not(target_family = "wasm"))] // no other programs there
    pub(crate) fn temporary_path(&self) -> &Path {
        self.temporary.path()
    }

    /// Gives the file its name.
    pub(crate) fn commit(self) -> io::Result<()> {
        let persisted = self.temporary.persist(&self.path);
        persisted.map(drop).map_err(|error| error.error)
    }
}

/// Writes a whole file at once.
pub(crate) fn write(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let mut file = AtomicFile::create(path)?;
    file.file_mut().write_all(bytes)?;
    file.commit()
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
