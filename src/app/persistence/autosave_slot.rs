//! Autosave slots: one numbered file for each open window.
//!
//! A window locks its slot for its lifetime, and the system releases the lock however the window
//! ends. So an autosave in an unlocked slot was left behind by a window that ended without saving.

use std::fs::{self, File, TryLockError};
use std::io;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

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

impl AutosaveSlot {
    /// Locks slot `number`; `None` if another window has locked it.
    fn try_lock(folder: &Path, number: u32) -> io::Result<Option<Self>> {
        let file = File::create(folder.join(format!("{number}.lock")))?;
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
    /// behind, newest first.
    ///
    /// # Errors
    /// The folder cannot be created or written to, or all slots are in use.
    pub fn lock_free_slot(folder: &Path) -> io::Result<(Self, Vec<AbandonedProject>)> {
        fs::create_dir_all(folder)?;
        let mut free = None;
        let mut abandoned = Vec::new();
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
                Ok(project) => abandoned.push(AbandonedProject {
                    written_at: fs::metadata(&slot.path).and_then(|m| m.modified()).ok(),
                    project,
                    slot,
                }),
                // A file that is no valid autosave is overwritten.
                Err(_) => free = free.or(Some(slot)),
            }
        }
        abandoned.sort_by_key(|abandoned| std::cmp::Reverse(abandoned.written_at));
        let free = free.ok_or_else(|| io::Error::other("too many windows are open"))?;
        Ok((free, abandoned))
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
        let (first, abandoned) = AutosaveSlot::lock_free_slot(folder.path())?;
        assert!(abandoned.is_empty());
        unsaved.write(&first.path)?;
        let (second, abandoned) = AutosaveSlot::lock_free_slot(folder.path())?;
        assert!(abandoned.is_empty() && first.path != second.path);
        drop((first, second));
        let (third, abandoned) = AutosaveSlot::lock_free_slot(folder.path())?;
        assert_eq!(abandoned.len(), 1);
        assert_eq!(abandoned[0].project, unsaved);
        assert_ne!(third.path, abandoned[0].slot.path);
        abandoned[0].slot.clear();
        drop((third, abandoned));
        assert!(AutosaveSlot::lock_free_slot(folder.path())?.1.is_empty());
        Ok(())
    }
}
