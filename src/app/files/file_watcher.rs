//! Reloads designs whose files another program changes while they are open.
//!
//! A thread polls the files: this lets the window stay idle and works on network drives, which send
//! no change events. A file is reloaded once it has stayed the same from one poll to the next,
//! because saving takes a while.

use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, Weak};
use std::time::{Duration, SystemTime};

use bevy::prelude::{DetectChanges, DetectChangesMut, Res, ResMut, Resource};

use crate::app::notices::Notices;
use crate::app::session::state::Session;

/// Time between two polls of the files (heuristic).
const POLL_INTERVAL: Duration = Duration::from_millis(700);

/// Modification time and size of a file; `None` if they cannot be read, as for a missing file.
type FileStamp = Option<(SystemTime, u64)>;

/// Reads the modification time and size of a file.
fn stamp(path: &Path) -> FileStamp {
    let data = std::fs::metadata(path).ok()?;
    Some((data.modified().ok()?, data.len()))
}

/// File of an open design, polled for changes.
#[derive(Debug)]
struct WatchedFile {
    path: PathBuf,
    /// Modification time and size of the file when the program last read it.
    read: FileStamp,
    /// Modification time and size of the file at the last poll.
    last: FileStamp,
}

/// Watches the files of the open designs.
#[derive(Resource, Clone, Debug, Default)]
pub struct FileWatcher(Arc<Mutex<WatchedFiles>>);

#[derive(Debug, Default)]
struct WatchedFiles {
    watched: Vec<WatchedFile>,
    changed: Vec<PathBuf>,
}

impl FileWatcher {
    fn files(&self) -> MutexGuard<'_, WatchedFiles> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Polls all files; returns whether any change waits to be handled by [`follow`].
    pub fn poll(&self) -> bool {
        // The files are polled without holding the lock, because network drives may be slow.
        let paths: Vec<PathBuf> = self
            .files()
            .watched
            .iter()
            .map(|file| file.path.clone())
            .collect();
        let stamps: Vec<FileStamp> = paths.iter().map(|path| stamp(path)).collect();
        let mut files = self.files();
        let mut changed = Vec::new();
        for (path, now) in paths.into_iter().zip(stamps) {
            // The file may no longer be watched, because another project has been opened meanwhile.
            let Some(watched) = files.watched.iter_mut().find(|file| file.path == path) else {
                continue;
            };
            if now != watched.read && now == watched.last {
                watched.read = now;
                changed.push(path);
            }
            watched.last = now;
        }
        files.changed.extend(changed);
        !files.changed.is_empty()
    }

    /// Polls from a thread until the application ends, and calls `wake` on changes.
    pub fn start(&self, wake: impl Fn() + Send + 'static) {
        let files: Weak<_> = Arc::downgrade(&self.0);
        let poll = move || {
            loop {
                std::thread::sleep(POLL_INTERVAL);
                let Some(files) = files.upgrade() else {
                    return;
                };
                if Self(files).poll() {
                    wake();
                }
            }
        };
        // Without the thread, files are not reloaded; everything else works.
        std::thread::Builder::new()
            .name("files".to_owned())
            .spawn(poll)
            .ok();
    }
}

/// Updates the list of watched files, and reloads changed designs.
pub fn follow(mut session: ResMut<Session>, watch: Res<FileWatcher>, mut notices: ResMut<Notices>) {
    let mut files = watch.files();
    if session.is_changed() {
        let paths = session.files();
        files
            .watched
            .retain(|watched| paths.contains(&watched.path));
        for path in paths {
            if files.watched.iter().all(|watched| watched.path != path) {
                let now = stamp(&path);
                files.watched.push(WatchedFile {
                    path,
                    read: now,
                    last: now,
                });
            }
        }
    }
    // A running build uses the old files; changed ones are reloaded after it.
    if files.changed.is_empty() || session.work().is_some() {
        return;
    }
    for path in std::mem::take(&mut files.changed) {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        if path.exists() {
            notices.note(format!("{name} changed on disk and is being reloaded"));
            session.reread();
        } else {
            notices.note(format!(
                "{name} no longer exists on disk. The loaded drawing is kept"
            ));
        }
    }
    session.set_changed();
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_change_counts_once_the_file_is_stable() -> std::io::Result<()> {
        let folder = tempfile::tempdir()?;
        let path = folder.path().join("a.svg");
        std::fs::write(&path, "one")?;
        let watch = FileWatcher::default();
        let now = stamp(&path);
        watch.files().watched.push(WatchedFile {
            path: path.clone(),
            read: now,
            last: now,
        });
        assert!(!watch.poll());
        std::fs::write(&path, "longer")?;
        assert!(!watch.poll(), "it may still be written");
        std::fs::write(&path, "longer still")?;
        assert!(!watch.poll());
        assert!(watch.poll());
        watch.files().changed.clear();
        assert!(!watch.poll(), "once");
        std::fs::remove_file(&path)?;
        watch.poll();
        assert!(watch.poll());
        Ok(())
    }
}
