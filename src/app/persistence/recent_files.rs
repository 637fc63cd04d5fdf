//! Recent files: the projects and designs opened last, which the next start offers for opening with
//! one click.

use crate::project::title::title_of;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use bevy::prelude::{DetectChanges, Res, ResMut, Resource, warn};
use serde::{Deserialize, Serialize};

use crate::app::session::state::Session;
use crate::io::atomic_file::AtomicFile;
use crate::io::sanitize::SanitizedLine;

/// Maximum number of entries (heuristic: as many as fit above the gallery).
const MAX_ENTRIES: usize = 5;

/// Files that were opened together.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct RecentEntry {
    /// Paths of one project file, or of designs opened together.
    pub files: Vec<PathBuf>,
}

impl RecentEntry {
    /// Short title of the entry.
    #[must_use]
    pub fn title(&self) -> String {
        let stem = |path: &PathBuf| {
            let stem = path.file_stem().unwrap_or(path.as_os_str());
            SanitizedLine(&stem.to_string_lossy()).to_string()
        };
        let stems: Vec<String> = self.files.iter().map(stem).collect();
        title_of(&stems)
    }
}

/// List of the files opened last, the newest first.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct RecentFiles {
    #[serde(default)]
    opened: Vec<RecentEntry>,
}

impl RecentFiles {
    /// Path of the list's file; `None` if the system has no folder for it.
    #[must_use]
    pub fn default_path() -> Option<PathBuf> {
        let state = dirs::state_dir().or_else(dirs::data_local_dir);
        state.map(|state| state.join("morphospace").join("recent.toml"))
    }

    /// Reads the list; empty if the file is missing or invalid.
    fn read(path: &Path) -> Self {
        let text = std::fs::read_to_string(path).unwrap_or_default();
        toml::from_str(&text).unwrap_or_default()
    }

    /// Writes the list atomically.
    fn write(&self, path: &Path) -> io::Result<()> {
        if let Some(folder) = path.parent() {
            std::fs::create_dir_all(folder)?;
        }
        let text = toml::to_string(self).map_err(io::Error::other)?;
        let mut file = AtomicFile::create(path)?;
        file.file_mut().write_all(text.as_bytes())?;
        file.commit()
    }

    fn add(&mut self, opened: RecentEntry) {
        self.opened.retain(|other| *other != opened);
        self.opened.insert(0, opened);
        self.opened.truncate(MAX_ENTRIES);
    }
}

/// The list of recent files, in memory and in its file.
#[derive(Resource, Clone, Debug, Default)]
pub struct StoredRecentFiles {
    recent: RecentFiles,
    /// File of the list; `None` if nothing is written, as in tests.
    path: Option<PathBuf>,
}

impl StoredRecentFiles {
    /// Reads the list from a file.
    #[must_use]
    pub fn of_file(path: Option<PathBuf>) -> Self {
        let mut recent = path.as_deref().map(RecentFiles::read).unwrap_or_default();
        // Entries with missing files are dropped; this is checked only at the start, because it
        // reads the disk.
        let exists = |opened: &RecentEntry| opened.files.iter().all(|file| file.exists());
        recent.opened.retain(exists);
        Self { recent, path }
    }

    /// Entries, the newest first.
    #[must_use]
    pub fn entries(&self) -> &[RecentEntry] {
        &self.recent.opened
    }

    /// Folders of all entries, without duplicates.
    #[must_use]
    pub fn folders(&self) -> Vec<&Path> {
        let mut folders: Vec<&Path> = Vec::new();
        let files = self.recent.opened.iter().flat_map(|opened| &opened.files);
        for folder in files.filter_map(|file| file.parent()) {
            if !folders.contains(&folder) {
                folders.push(folder);
            }
        }
        folders
    }

    fn add(&mut self, opened: RecentEntry) -> io::Result<()> {
        self.recent.add(opened.clone());
        let Some(path) = &self.path else {
            return Ok(());
        };
        // Another window may have added entries meanwhile.
        let mut stored = RecentFiles::read(path);
        stored.add(opened);
        stored.write(path)
    }
}

/// Adds the open project to the list.
pub fn follow(session: Res<Session>, mut recent: ResMut<StoredRecentFiles>) {
    if !session.is_changed() || session.transition().is_none() {
        return;
    }
    let files = match (session.path(), session.gallery_name()) {
        (Some(path), _) => vec![path.to_owned()],
        // Gallery projects are not listed, because the gallery has a card for each of them.
        (None, Some(_)) => return,
        (None, None) => session.files(),
    };
    let is_known = recent
        .entries()
        .first()
        .is_some_and(|last| last.files == files);
    if files.is_empty() || is_known {
        return;
    }
    if let Err(error) = recent.add(RecentEntry { files }) {
        // The error is only logged, because the user loses nothing.
        warn!("cannot write the list of recent files: {error}");
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn opened(name: &str) -> RecentEntry {
        RecentEntry {
            files: vec![PathBuf::from(format!("/nowhere/{name}.svg"))],
        }
    }

    #[test]
    fn the_newest_comes_first_without_duplicates() {
        let mut recent = RecentFiles::default();
        for name in ["a", "b", "a", "c", "d", "e", "f"] {
            recent.add(opened(name));
        }
        let titles: Vec<String> = recent.opened.iter().map(RecentEntry::title).collect();
        assert_eq!(titles, ["f", "e", "d", "c", "a"]);
    }

    #[test]
    fn missing_and_broken_files_are_left_out() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("state").join("recent.toml");
        let mut stored = StoredRecentFiles::of_file(Some(path.clone()));
        let existing = RecentEntry {
            files: vec![folder.path().to_owned()],
        };
        stored.add(opened("gone")).expect("a file");
        stored.add(existing.clone()).expect("a file");
        assert_eq!(stored.entries().len(), 2);
        assert_eq!(
            StoredRecentFiles::of_file(Some(path.clone())).entries(),
            [existing]
        );
        std::fs::write(&path, "opened = 3").expect("a file");
        assert!(StoredRecentFiles::of_file(Some(path)).entries().is_empty());
    }
}
