//! Autosave slots: one numbered file for each open window.
//!
//! A window locks its slot for its lifetime, and the system releases the lock however the window
//! ends. So an autosave in an unlocked slot was left behind by a window that ended without saving.
//!
//! Only regular files are opened, because opening a pipe would block the program. Invalid autosaves
//! are renamed, never overwritten; those that cannot be read stay in their slots.

use std::fs::{self, File, TryLockError};
use std::io;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use crate::app::output_files::free_name;
use crate::app::session::unsaved_project::{UnsavedProject, UnsavedReadError};
use crate::io::atomic_file::is_at;

/// Maximum number of slots (resource limit: one for each open window and for each autosave that
/// waits to be recovered).
const MAX_SLOTS: u32 = 64;

/// Permission of all users to write (POSIX).
#[cfg(unix)]
const S_IWOTH: u32 = 0o002;

/// Permission of the group and of other users to write (POSIX: `S_IWGRP` and `S_IWOTH`).
#[cfg(unix)]
const OTHERS_MAY_WRITE: u32 = 0o022;

/// Permissions of the group and of other users (POSIX: `S_IRWXG` and `S_IRWXO`).
#[cfg(unix)]
const OTHERS_MAY_ACCESS: u32 = 0o077;

/// A slot that this process has locked.
#[derive(Debug)]
pub struct AutosaveSlot {
    /// Path of the autosave, which may not exist.
    pub path: PathBuf,
    /// The locked file, unlocked on drop. It is never deleted, because another window may be about
    /// to lock it.
    lock: File,
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
pub struct SlotScan {
    /// A slot without an autosave, or the reason why there is none.
    pub free: io::Result<AutosaveSlot>,
    /// Autosaves left behind, newest first.
    pub abandoned: Vec<AbandonedProject>,
    /// New paths of invalid autosaves.
    pub damaged_files: Vec<PathBuf>,
    /// Paths of autosaves that cannot be read, each with the reason.
    pub unreadable_files: Vec<String>,
}

impl AutosaveSlot {
    /// Locks slot `number`; `None` if another window has locked it, or if the path of its lock is not
    /// a regular file.
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
                lock: file,
            })),
            Err(TryLockError::WouldBlock) => Ok(None),
            Err(TryLockError::Error(error)) => Err(error),
        }
    }

    /// Locks a free slot in a folder, which is created if missing, and collects the autosaves left
    /// behind.
    ///
    /// # Errors
    /// The folder cannot be created or belongs to another user.
    pub fn lock_free_slot(folder: &Path) -> io::Result<SlotScan> {
        create_private(folder)?;
        let mut scan = SlotScan {
            free: Err(io::Error::other(format!(
                "all {MAX_SLOTS} autosave slots are in use; close windows, or recover or discard \
                 autosaves"
            ))),
            abandoned: Vec::new(),
            damaged_files: Vec::new(),
            unreadable_files: Vec::new(),
        };
        for number in 0..MAX_SLOTS {
            let is_occupied = ["json", "making"]
                .iter()
                .any(|kind| folder.join(format!("{number}.{kind}")).exists());
            // One free slot is enough; further slots matter only if they contain an autosave or
            // unfinished exports.
            if scan.free.is_ok() && !is_occupied {
                continue;
            }
            match Self::try_lock(folder, number) {
                Ok(Some(slot)) => scan.add(slot),
                Ok(None) => {}
                Err(error) if scan.free.is_err() => scan.free = Err(error),
                Err(_) => {}
            }
        }
        scan.abandoned
            .sort_by_key(|abandoned| std::cmp::Reverse(abandoned.written_at));
        Ok(scan)
    }

    /// Whether the file of the lock was deleted or replaced, so that another window can lock the
    /// same slot.
    #[must_use]
    pub fn has_lost_lock(&self) -> bool {
        let path = self.path.with_extension("lock");
        match fs::metadata(&path) {
            Ok(_) => !is_at(&self.lock, &path),
            // Other errors may pass, as on a network disk.
            Err(error) => error.kind() == io::ErrorKind::NotFound,
        }
    }

    /// Renames the invalid autosave; returns its new path.
    fn rename_damaged(&self) -> io::Result<PathBuf> {
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

impl SlotScan {
    /// Adds a slot that has just been locked.
    fn add(&mut self, slot: AutosaveSlot) {
        // The slot's former window has ended and will not finish its exports.
        fs::remove_dir_all(slot.scratch_folder()).ok();
        match UnsavedProject::read(&slot.path) {
            Ok(Some(project)) => self.abandoned.push(AbandonedProject {
                written_at: fs::metadata(&slot.path).and_then(|m| m.modified()).ok(),
                project,
                slot,
            }),
            Ok(None) => self.free = Ok(slot),
            // If an invalid autosave cannot be renamed, its slot stays unused.
            Err(UnsavedReadError::Invalid) => {
                if let Ok(path) = slot.rename_damaged() {
                    self.damaged_files.push(path);
                    self.free = Ok(slot);
                }
            }
            Err(UnsavedReadError::Unreadable(reason)) => {
                let path = slot.path.display();
                self.unreadable_files.push(format!("{path} ({reason})"));
            }
        }
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
/// The folder cannot be created; or all users can write to its parent, as to the folder for
/// temporary files, and the folder belongs to another user or others may write to it.
#[cfg(unix)]
fn create_private(folder: &Path) -> io::Result<()> {
    use std::os::unix::fs::{DirBuilderExt, MetadataExt, PermissionsExt};
    let mut builder = fs::DirBuilder::new();
    builder.recursive(true).mode(0o700).create(folder)?;
    let parent = fs::metadata(folder.parent().unwrap_or(Path::new("/")))?;
    if parent.mode() & S_IWOTH != 0 {
        let data = fs::symlink_metadata(folder)?;
        let is_own = data.is_dir()
            && data.uid() == nix::unistd::Uid::effective().as_raw()
            && data.mode() & OTHERS_MAY_WRITE == 0;
        if !is_own {
            return Err(io::Error::other("other users can write to this folder"));
        }
        if data.mode() & OTHERS_MAY_ACCESS != 0 {
            fs::set_permissions(folder, PermissionsExt::from_mode(0o700))?;
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
        let first_slot = first.free?;
        unsaved.write(&first_slot.path)?;
        let second = AutosaveSlot::lock_free_slot(folder.path())?;
        let second_slot = second.free?;
        assert!(second.abandoned.is_empty() && first_slot.path != second_slot.path);
        drop((first_slot, second_slot));
        let third = AutosaveSlot::lock_free_slot(folder.path())?;
        assert_eq!(third.abandoned.len(), 1);
        assert_eq!(third.abandoned[0].project, unsaved);
        assert_ne!(third.free?.path, third.abandoned[0].slot.path);
        third.abandoned[0].slot.clear();
        drop(third.abandoned);
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
            assert_eq!(locked.damaged_files.len(), 1);
            assert_eq!(fs::read_to_string(&locked.damaged_files[0])?, text);
            assert!(!locked.free?.path.exists());
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
        for mode in [0o777, 0o770] {
            set_mode(&folder, mode)?;
            assert!(AutosaveSlot::lock_free_slot(&folder).is_err(), "{mode:o}");
        }
        set_mode(&folder, 0o750)?;
        assert!(AutosaveSlot::lock_free_slot(&folder).is_ok());
        assert_eq!(fs::metadata(&folder)?.permissions().mode() & 0o777, 0o700);
        let link = parent.path().join("link");
        std::os::unix::fs::symlink(tempfile::tempdir()?.path(), &link)?;
        assert!(AutosaveSlot::lock_free_slot(&link).is_err());
        Ok(())
    }

    #[cfg(unix)]
    #[test]
    fn a_slot_whose_lock_was_deleted_or_replaced_is_lost() -> io::Result<()> {
        let folder = tempfile::tempdir()?;
        let slot = AutosaveSlot::lock_free_slot(folder.path())?.free?;
        assert!(!slot.has_lost_lock());
        fs::remove_file(folder.path().join("0.lock"))?;
        assert!(slot.has_lost_lock());
        fs::write(folder.path().join("0.lock"), "")?;
        assert!(slot.has_lost_lock());
        Ok(())
    }

    #[test]
    fn an_autosave_that_is_too_large_to_be_read_keeps_its_name() -> io::Result<()> {
        let folder = tempfile::tempdir()?;
        let path = folder.path().join("0.json");
        File::create(&path)?.set_len(1 << 40)?;
        let scan = AutosaveSlot::lock_free_slot(folder.path())?;
        assert!(path.exists() && scan.damaged_files.is_empty());
        assert_eq!(scan.unreadable_files.len(), 1);
        assert!(scan.free?.path != path);
        Ok(())
    }
}
