//! Atomic writing: a file appears complete under its name, or not at all.
//!
//! The bytes go into a temporary file in the same folder. [`AtomicFile::commit`] flushes it to the
//! disk and renames it to the final name; until then, an existing file of that name is untouched.
//! Dropping an uncommitted [`AtomicFile`] removes the temporary file. A killed process may leave
//! its temporary file behind; the next write into that folder removes it. The new file gets the
//! permissions of the file that it replaces. Devices, pipes and folders are never replaced. A
//! symbolic link stays, and the file to which it leads is replaced or created. Exception: without
//! hard links, as on FAT, a file that must be new is first created empty to reserve its name; a
//! process killed at that moment leaves the empty file.

mod leftovers;
mod refusal;

use std::fs::{self, File, Metadata};
use std::io::{self, Read, Seek, Write};
use std::path::{Path, PathBuf};

#[cfg(feature = "app")]
pub(crate) use leftovers::is_at;
pub(crate) use leftovers::remove_leftovers;
#[cfg(feature = "cli")]
pub(crate) use leftovers::{remove_unowned, try_lock};
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
        let destination = Destination::of(path)?;
        remove_leftovers(folder_of(&destination.path));
        Self::create_at(destination)
    }

    /// Like [`Self::create`], but does not remove the temporary files of killed processes.
    ///
    /// For writing many files into one folder: the caller removes them once with
    /// [`remove_leftovers`].
    pub(crate) fn create_without_cleanup(path: &Path) -> io::Result<Self> {
        Self::create_at(Destination::of(path)?)
    }

    fn create_at(destination: Destination) -> io::Result<Self> {
        let Destination { path, old } = destination;
        let (file, temporary) = leftovers::create_temporary(&path, folder_of(&path))?;
        let created = Self {
            file,
            temporary,
            path,
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

    /// Like [`Self::commit`], but never replaces a file.
    ///
    /// # Errors
    /// [`io::ErrorKind::AlreadyExists`] if the final name is in use, also if another process takes
    /// it at the same moment.
    pub(crate) fn commit_new(self) -> io::Result<()> {
        self.file.sync_all()?;
        // A hard link never overwrites. Dropping `self` removes the temporary name.
        match fs::hard_link(&self.temporary, &self.path) {
            Err(error) if error.kind() != io::ErrorKind::AlreadyExists => {
                drop(File::create_new(&self.path)?); // reserves the name
                self.commit()
            }
            linked => linked,
        }
    }
}

/// File that a path leads to, which is to be replaced or created.
struct Destination {
    path: PathBuf,
    /// Metadata of the file that is replaced; `None` if it does not exist yet.
    old: Option<Metadata>,
}

impl Destination {
    /// Follows the symbolic links of `path`, also to a file that does not exist.
    ///
    /// # Errors
    /// The path leads to something other than a file, to links in a circle, or to a missing folder.
    fn of(path: &Path) -> io::Result<Self> {
        let mut path = path.to_owned();
        let mut is_linked = false;
        // Ends because the system returns an error for links in a circle.
        loop {
            let old = match fs::metadata(&path) {
                Ok(old) if old.is_dir() => return Err(io::ErrorKind::IsADirectory.into()),
                Ok(old) if !old.is_file() => {
                    return Err(io::Error::other("it is a device or a pipe"));
                }
                Ok(old) => Some(old),
                Err(error) if error.kind() == io::ErrorKind::NotFound => None,
                Err(error) => return Err(error),
            };
            match fs::read_link(&path) {
                // A relative target starts at the folder of the link.
                Ok(target) => path = path.with_file_name(target),
                Err(_) if is_linked && !folder_of(&path).is_dir() => {
                    let target = path.display();
                    let reason = format!("it is a link to `{target}`, whose folder does not exist");
                    return Err(io::Error::other(reason));
                }
                Err(_) => return Ok(Self { path, old }),
            }
            is_linked = true;
        }
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
    filled(AtomicFile::create(path)?, bytes)?.commit()
}

/// Like [`write`], but never replaces a file; see [`AtomicFile::commit_new`].
pub(crate) fn write_new(path: &Path, bytes: &[u8]) -> io::Result<()> {
    filled(AtomicFile::create(path)?, bytes)?.commit_new()
}

/// Like [`write`], but does not remove the temporary files of killed processes; see
/// [`AtomicFile::create_without_cleanup`].
pub(crate) fn write_without_cleanup(path: &Path, bytes: &[u8]) -> io::Result<()> {
    filled(AtomicFile::create_without_cleanup(path)?, bytes)?.commit()
}

/// Writes `bytes` to the temporary file, and reads them back to detect a faulty disk.
fn filled(mut file: AtomicFile, bytes: &[u8]) -> io::Result<AtomicFile> {
    file.file_mut().write_all(bytes)?;
    let mut written = Vec::with_capacity(bytes.len());
    file.reread()?.read_to_end(&mut written)?;
    if written != bytes {
        return Err(io::Error::other("reading back gave different bytes"));
    }
    Ok(file)
}

/// Gives a finished file a second name, or copies it where that is impossible, as between two
/// disks. Never replaces a file.
#[cfg(feature = "app")]
pub(crate) fn place_new(source: &Path, path: &Path) -> io::Result<()> {
    // A hard link never overwrites, and the file is complete from its first moment.
    match fs::hard_link(source, path) {
        Err(error) if error.kind() != io::ErrorKind::AlreadyExists => copy_new(source, path),
        linked => linked,
    }
}

/// Copies a file to a new path, for other disks and for file systems without hard links.
#[cfg(feature = "app")]
pub(crate) fn copy_new(source: &Path, path: &Path) -> io::Result<()> {
    // Reserves the name; the content then replaces the empty file in one step.
    drop(File::create_new(path)?);
    copy_over(source, path).inspect_err(|_| {
        fs::remove_file(path).unwrap_or_default();
    })
}

/// Copies a file to a path in one step; an existing file there is replaced.
#[cfg(feature = "app")]
pub(crate) fn copy_over(source: &Path, path: &Path) -> io::Result<()> {
    let mut file = AtomicFile::create(path)?;
    io::copy(&mut File::open(source)?, file.file_mut())?;
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

    #[test]
    fn a_new_file_never_replaces_one_that_appeared_in_between() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("x.morph");
        let mut files = [(); 2].map(|()| AtomicFile::create(&path).expect("created"));
        files[0].file_mut().write_all(b"first").expect("written");
        let [first, second] = files.map(AtomicFile::commit_new);
        first.expect("committed");
        let error = second.expect_err("the name is in use");
        assert_eq!(error.kind(), io::ErrorKind::AlreadyExists);
        assert_eq!(fs::read(&path).expect("read"), b"first");
        #[cfg(feature = "app")]
        assert!(copy_new(&path, &path).is_err());
        assert_eq!(fs::read_dir(&folder).expect("listed").count(), 1);
    }

    #[cfg(unix)]
    #[test]
    fn a_symbolic_link_stays_and_its_target_is_written() {
        use std::os::unix::fs::symlink;
        let folder = tempfile::tempdir().expect("a folder");
        let at = |name: &str| folder.path().join(name);
        fs::create_dir(at("deep")).expect("created");
        fs::write(at("deep/old"), b"old").expect("written");
        // Relative targets start at the folder of the link, not at the working folder.
        for (target, link) in [("deep/link", "to-old"), ("old", "deep/link")] {
            symlink(target, at(link)).expect("linked");
        }
        symlink("deep/new", at("to-new")).expect("linked");
        for (link, target) in [("to-old", "deep/old"), ("to-new", "deep/new")] {
            write(&at(link), b"written").expect("written");
            assert!(at(link).is_symlink(), "{link}");
            assert_eq!(fs::read(at(target)).expect("read"), b"written", "{link}");
        }
        for (target, link) in [("nowhere/x", "lost"), ("circle", "circle")] {
            symlink(target, at(link)).expect("linked");
            let error = write(&at(link), b"x").expect_err(link).to_string();
            assert!(link == "circle" || error.contains("nowhere/x"), "{error}");
        }
        assert_eq!(fs::read_dir(at("deep")).expect("listed").count(), 3);
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
