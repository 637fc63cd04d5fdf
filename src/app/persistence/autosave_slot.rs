//! A place of its own for each window that is open, and those of windows that ended without
//! saving.
//!
//! A window holds the lock of its place for as long as it lives; the system lets go of it however
//! it ends. What is kept where nobody holds the lock was lost.

use std::fs::{self, File, TryLockError};
use std::io;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use crate::app::session::unsaved_project::UnsavedProject;

/// The most windows that have a place at once.
const MOST: u32 = 64;

/// A place that nobody else writes to.
#[derive(Debug)]
pub struct AutosaveSlot {
    /// What is kept there, if anything is.
    pub path: PathBuf,
    /// Never removed: another window may be about to lock it.
    _lock: File,
}

/// What a window has left that ended without saving.
#[derive(Debug)]
pub struct AbandonedProject {
    /// The project.
    pub kept: UnsavedProject,
    /// When it was kept.
    pub when: Option<SystemTime>,
    /// Where it lies.
    pub slot: AutosaveSlot,
}

impl AutosaveSlot {
    /// The place of that number, where nobody holds it.
    fn take(folder: &Path, number: u32) -> io::Result<Option<Self>> {
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

    /// A free place in a folder, which is made where it is missing, and what was lost there, the
    /// newest first.
    ///
    /// # Errors
    /// The folder cannot be made or written to.
    pub fn enter(folder: &Path) -> io::Result<(Self, Vec<AbandonedProject>)> {
        fs::create_dir_all(folder)?;
        let mut free = None;
        let mut lost = Vec::new();
        for number in 0..MOST {
            let is_there = ["json", "making"]
                .iter()
                .any(|kind| folder.join(format!("{number}.{kind}")).exists());
            if free.is_some() && !is_there {
                continue;
            }
            let Some(slot) = Self::take(folder, number)? else {
                continue;
            };
            // What was being made there will not be finished.
            fs::remove_dir_all(slot.workshop()).ok();
            match UnsavedProject::read(&slot.path) {
                Ok(kept) => lost.push(AbandonedProject {
                    when: fs::metadata(&slot.path).and_then(|m| m.modified()).ok(),
                    kept,
                    slot,
                }),
                // What is no project of ours is overwritten.
                Err(_) => free = free.or(Some(slot)),
            }
        }
        lost.sort_by_key(|lost| std::cmp::Reverse(lost.when));
        let free = free.ok_or_else(|| io::Error::other("too many windows are open"))?;
        Ok((free, lost))
    }

    /// A folder for what is being made.
    #[must_use]
    pub fn workshop(&self) -> PathBuf {
        self.path.with_extension("making")
    }

    /// Nothing is kept there any more.
    pub fn clear(&self) {
        fs::remove_file(&self.path).ok();
    }
}

impl Drop for AutosaveSlot {
    fn drop(&mut self) {
        // Where nothing is being made it is empty.
        fs::remove_dir(self.workshop()).ok();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::session::origin::ProjectOrigin;
    use crate::project::gallery;

    #[test]
    fn only_what_nobody_holds_is_lost() -> Result<(), Box<dyn std::error::Error>> {
        let folder = tempfile::tempdir()?;
        let name = gallery::list()?.remove(0).name;
        let loaded = gallery::load(&name)?;
        let kept = UnsavedProject::new("a".to_owned(), &ProjectOrigin::Gallery(name), &loaded)?;
        let (first, lost) = AutosaveSlot::enter(folder.path())?;
        assert!(lost.is_empty());
        kept.write(&first.path)?;
        let (second, lost) = AutosaveSlot::enter(folder.path())?;
        assert!(lost.is_empty() && first.path != second.path);
        drop((first, second));
        let (third, lost) = AutosaveSlot::enter(folder.path())?;
        assert_eq!(lost.len(), 1);
        assert_eq!(lost[0].kept, kept);
        assert_ne!(third.path, lost[0].slot.path);
        lost[0].slot.clear();
        drop((third, lost));
        assert!(AutosaveSlot::enter(folder.path())?.1.is_empty());
        Ok(())
    }
}
