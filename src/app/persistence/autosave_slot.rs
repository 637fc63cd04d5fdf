//! Autosave slots: one numbered file for each open window.
//!
//! A window locks its slot for its lifetime, and the system releases the lock however the window
//! ends. So an autosave in an unlocked slot was left behind by a window that ended without saving.
//!
//! Only regular files are opened, because a pipe would block the start. A file that is no valid
//! autosave is renamed and never overwritten.

use std::fs::{self, File, TryLockError};
use std::io;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use crate::app::output_files::free_name;
use crate::app::session::unsaved_project::UnsavedProject;

/// Maximum number of slots (resource limit: one for each open window and for each autosave that
/// waits to be recovered).
const MAX_SLOTS: u32 = 64;

/// A slot that this process has locked.
#[derive(Debug)]
pub struct AutosaveSlot {
    /// Path of the autosave, which may not exist.
    pub path: PathBuf,
    /// The locked file, unlocked on drop. It is never deleted, because another window may be about
    /// to lock it.
    _lock: File,
}

/// An autosave left behind by a window that ended without saving.
#[derive(Debug)]
pub struct AbandonedProject {
    /// The project with its unsaved changes.
    pub project: UnsavedProject,
    /// Time at which the autosave was written; `None` if unknown.
    pub written_at: Option<SystemTime>,
    /// Slot that contains the autosave, now locked by this process.
    pub slot: AutosaveSlot,
}

/// Result of [`AutosaveSlot::lock_free_slot`].
#[derive(Debug)]
pub struct LockedSlots {
    /// A slot without an autosave.
    pub free: AutosaveSlot,
    /// Autosaves left behind, newest first.
    pub abandoned: Vec<AbandonedProject>,
    /// New paths of files that were in the place of an autosave but are not valid.
    pub set_aside: Vec<PathBuf>,
}

impl AutosaveSlot {
    /// Locks slot `number`; `None` if another window has locked it, or if its lock is not a file.
    fn try_lock(folder: &Path, number: u32) -> io::Result<Option<Self>> {
        let lock_path = folder.join(format!("{number}.lock"));
        if fs::metadata(&lock_path).is_ok_and(|data| !data.is_file()) {
            return Ok(None);
        }
        let mut options = File::options();
        let file = options.write(true).create(true).truncate(false);
        let file = file.open(lock_path)?;
        match file.try_lock() {
            Ok(()) => Ok(Some(Self {
                path: folder.join(format!("{number}.json")),
                _lock: file,
            })),
            Err(TryLockError::WouldBlock) => Ok(None),
            Err(TryLockError::Error(error)) => Err(error),
        }
    }

    /// Locks a free slot in a folder, which is created if missing, and collects the autosaves left
    /// behind.
    ///
    /// # Errors
    /// The folder cannot be created or written to, belongs to another user, or all slots are in
    /// use.
    pub fn lock_free_slot(folder: &Path) -> io::Result<LockedSlots> {
        create_private(folder)?;
        let mut free = None;
        let (mut abandoned, mut set_aside) = (Vec::new(), Vec::new());
        for number in 0..MAX_SLOTS {
            let is_occupied = ["json", "making"]
                .iter()
                .any(|kind| folder.join(format!("{number}.{kind}")).exists());
            // One free slot is enough; further slots matter only if they contain an autosave or
            // unfinished exports.
            if free.is_some() && !is_occupied {
                continue;
            }
            let Some(slot) = Self::try_lock(folder, number)? else {
                continue;
            };
            // The slot's former window has ended and will not finish its exports.
            fs::remove_dir_all(slot.scratch_folder()).ok();
            match UnsavedProject::read(&slot.path) {
                Ok(Some(project)) => abandoned.push(AbandonedProject {
                    written_at: fs::metadata(&slot.path).and_then(|m| m.modified()).ok(),
                    project,
                    slot,
                }),
                Ok(None) => free = free.or(Some(slot)),
                // If a file that is no valid autosave cannot be renamed, its slot stays unused.
                Err(_) => {
                    if let Ok(path) = slot.set_aside() {
                        set_aside.push(path);
                        free = free.or(Some(slot));
                    }
                }
            }
        }
        abandoned.sort_by_key(|abandoned| std::cmp::Reverse(abandoned.written_at));
        Ok(LockedSlots {
            free: free.ok_or_else(|| io::Error::other("too many windows are open"))?,
            abandoned,
            set_aside,
        })
    }

    /// Renames whatever is in the place of the autosave; returns its new path.
    fn set_aside(&self) -> io::Result<PathBuf> {
        let folder = self.path.parent().unwrap_or(Path::new(""));
        let stem = self.path.file_stem().unwrap_or_default();
        let name = free_name(folder, &stem.to_string_lossy(), ".damaged");
        let path = folder.join(name);
        fs::rename(&self.path, &path)?;
        Ok(path)
    }

    /// Folder for unfinished exports of the window.
    #[must_use]
    pub fn scratch_folder(&self) -> PathBuf {
        self.path.with_extension("making")
    }

    /// Deletes the autosave.
    pub fn clear(&self) {
        fs::remove_file(&self.path).ok();
    }
}

impl Drop for AutosaveSlot {
    fn drop(&mut self) {
        // The folder is removed only if it is empty, that is, if no export is in progress.
        fs::remove_dir(self.scratch_folder()).ok();
    }
}

/// Creates a folder for autosaves, which only the user can read.
///
/// # Errors
/// The folder cannot be created; or everybody can write to its parent, as to the folder for
/// temporary files, and another user created it or can write to it.
#[cfg(unix)]
fn create_private(folder: &Path) -> io::Result<()> {
    use std::os::unix::fs::{DirBuilderExt, MetadataExt};
    let mut builder = fs::DirBuilder::new();
    builder.recursive(true).mode(0o700).create(folder)?;
    let parent = fs::metadata(folder.parent().unwrap_or(Path::new("/")))?;
    if parent.mode() & 0o002 != 0 {
        let data = fs::symlink_metadata(folder)?;
        let user = tempfile::tempfile_in(folder)?.metadata()?.uid();
        if !data.is_dir() || data.uid() != user || data.mode() & 0o002 != 0 {
            return Err(io::Error::other("other users can write to this folder"));
        }
    }
    Ok(())
}

#[cfg(not(unix))]
fn create_private(folder: &Path) -> io::Result<()> {
    fs::create_dir_all(folder)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::session::origin::ProjectOrigin;
    use crate::project::gallery;

    #[test]
    fn only_autosaves_in_unlocked_slots_are_recovered() -> Result<(), Box<dyn std::error::Error>> {
        let folder = tempfile::tempdir()?;
        let name = gallery::list()?.remove(0).name;
        let loaded = gallery::load(&name)?;
        let unsaved = UnsavedProject::new("a".to_owned(), &ProjectOrigin::Gallery(name), &loaded)?;
        let first = AutosaveSlot::lock_free_slot(folder.path())?;
        assert!(first.abandoned.is_empty());
        unsaved.write(&first.free.path)?;
        let second = AutosaveSlot::lock_free_slot(folder.path())?;
        assert!(second.abandoned.is_empty() && first.free.path != second.free.path);
        drop((first, second));
        let third = AutosaveSlot::lock_free_slot(folder.path())?;
        assert_eq!(third.abandoned.len(), 1);
        assert_eq!(third.abandoned[0].project, unsaved);
        assert_ne!(third.free.path, third.abandoned[0].slot.path);
        third.abandoned[0].slot.clear();
        drop(third);
        let fourth = AutosaveSlot::lock_free_slot(folder.path())?;
        assert!(fourth.abandoned.is_empty());
        Ok(())
    }

    #[test]
    fn a_damaged_autosave_is_renamed_and_never_overwritten() -> io::Result<()> {
        let folder = tempfile::tempdir()?;
        for text in ["first", "second"] {
            fs::write(folder.path().join("0.json"), text)?;
            let locked = AutosaveSlot::lock_free_slot(folder.path())?;
            assert_eq!(locked.set_aside.len(), 1);
            assert_eq!(fs::read_to_string(&locked.set_aside[0])?, text);
            assert!(!locked.free.path.exists());
        }
        Ok(())
    }

    #[cfg(unix)]
    #[test]
    fn a_folder_that_other_users_can_write_to_is_not_used() -> io::Result<()> {
        use std::os::unix::fs::PermissionsExt;
        let parent = tempfile::tempdir()?;
        let set_mode =
            |path: &Path, mode| fs::set_permissions(path, PermissionsExt::from_mode(mode));
        set_mode(parent.path(), 0o1777)?;
        let folder = parent.path().join("autosave");
        assert!(AutosaveSlot::lock_free_slot(&folder).is_ok());
        set_mode(&folder, 0o777)?;
        assert!(AutosaveSlot::lock_free_slot(&folder).is_err());
        Ok(())
    }
}
