//! Drawings that another program changes while they are open are read again.
//!
//! A thread looks at their files now and then: so the window can rest meanwhile, and so it works on
//! network folders too, whose systems tell nobody of changes. A file is read again when it has
//! stayed the same from one look to the next: a program that saves writes for a while.

use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, Weak};
use std::time::{Duration, SystemTime};

use bevy::prelude::{DetectChanges, DetectChangesMut, Res, ResMut, Resource};

use crate::app::notices::Notices;
use crate::app::session::state::Session;

/// How often the files are looked at.
const EVERY: Duration = Duration::from_millis(700);

/// When a file was written, and how long it is; none where it is not there.
type FileStamp = Option<(SystemTime, u64)>;

fn stamp(path: &Path) -> FileStamp {
    let data = std::fs::metadata(path).ok()?;
    Some((data.modified().ok()?, data.len()))
}

/// One file.
#[derive(Debug)]
struct WatchedFile {
    path: PathBuf,
    /// As it was read.
    read: FileStamp,
    /// As it was at the last look.
    last: FileStamp,
}

/// The files of the open designs.
#[derive(Resource, Clone, Debug, Default)]
pub struct FileWatcher(Arc<Mutex<WatchedFiles>>);

#[derive(Debug, Default)]
struct WatchedFiles {
    looked: Vec<WatchedFile>,
    changed: Vec<PathBuf>,
}

impl FileWatcher {
    fn files(&self) -> MutexGuard<'_, WatchedFiles> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Looks at all files; whether one has changed since it was read.
    pub fn look(&self) -> bool {
        // Looked at without holding the lock: a folder on a network may take its time.
        let paths: Vec<PathBuf> = self.files().looked.iter().map(|l| l.path.clone()).collect();
        let stamps: Vec<FileStamp> = paths.iter().map(|path| stamp(path)).collect();
        let mut files = self.files();
        let mut changed = Vec::new();
        for (path, now) in paths.into_iter().zip(stamps) {
            // Another project may have been opened meanwhile.
            let Some(looked) = files.looked.iter_mut().find(|l| l.path == path) else {
                continue;
            };
            if now != looked.read && now == looked.last {
                looked.read = now;
                changed.push(path);
            }
            looked.last = now;
        }
        files.changed.extend(changed);
        !files.changed.is_empty()
    }

    /// Looks at them from a thread for as long as the window is there, and wakes it.
    pub fn start(&self, wake: impl Fn() + Send + 'static) {
        let files: Weak<_> = Arc::downgrade(&self.0);
        let look = move || {
            loop {
                std::thread::sleep(EVERY);
                let Some(files) = files.upgrade() else {
                    return;
                };
                if Self(files).look() {
                    wake();
                }
            }
        };
        // Without it drawings are not read again, and everything else works.
        std::thread::Builder::new()
            .name("files".to_owned())
            .spawn(look)
            .ok();
    }
}

/// Looks at the files of what is open now, and reads those again that have changed.
pub fn follow(mut session: ResMut<Session>, watch: Res<FileWatcher>, mut notices: ResMut<Notices>) {
    let mut files = watch.files();
    if session.is_changed() {
        let paths = session.files();
        files.looked.retain(|looked| paths.contains(&looked.path));
        for path in paths {
            if files.looked.iter().all(|looked| looked.path != path) {
                let now = stamp(&path);
                files.looked.push(WatchedFile {
                    path,
                    read: now,
                    last: now,
                });
            }
        }
    }
    // What is being built now is of what was read before.
    if files.changed.is_empty() || session.work().is_some() {
        return;
    }
    for path in std::mem::take(&mut files.changed) {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        if path.exists() {
            notices.note(format!(
                "{name} was changed by another program and is read again."
            ));
            session.reread();
        } else {
            notices.note(format!("{name} is gone; the drawing stays as it was read."));
        }
    }
    session.set_changed();
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_has_changed_once_it_has_settled() -> std::io::Result<()> {
        let folder = tempfile::tempdir()?;
        let path = folder.path().join("a.svg");
        std::fs::write(&path, "one")?;
        let watch = FileWatcher::default();
        let now = stamp(&path);
        watch.files().looked.push(WatchedFile {
            path: path.clone(),
            read: now,
            last: now,
        });
        assert!(!watch.look());
        std::fs::write(&path, "longer")?;
        assert!(!watch.look(), "it may still be written");
        std::fs::write(&path, "longer still")?;
        assert!(!watch.look());
        assert!(watch.look());
        watch.files().changed.clear();
        assert!(!watch.look(), "once");
        std::fs::remove_file(&path)?;
        watch.look();
        assert!(watch.look());
        Ok(())
    }
}
