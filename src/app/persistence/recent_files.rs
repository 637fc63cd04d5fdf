//! What was opened last, so that it is a click away at the next start.

use crate::project::title::title_of;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use bevy::prelude::{DetectChanges, Res, ResMut, Resource, warn};
use serde::{Deserialize, Serialize};

use crate::app::session::state::Session;
use crate::io::atomic_file::AtomicFile;
use crate::io::sanitize::SanitizedLine;

/// The most that is kept: what fits above the gallery without hiding it.
const MOST: usize = 5;

/// What was opened together.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct RecentEntry {
    /// A project, or one or two designs.
    pub files: Vec<PathBuf>,
}

impl RecentEntry {
    /// In a few words.
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

/// What was opened, the last first.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct RecentFiles {
    #[serde(default)]
    opened: Vec<RecentEntry>,
}

impl RecentFiles {
    /// Where it is kept; none where the system has no such place.
    #[must_use]
    pub fn usual_path() -> Option<PathBuf> {
        let state = dirs::state_dir().or_else(dirs::data_local_dir);
        state.map(|state| state.join("morphospace").join("recent.toml"))
    }

    /// Reads it; empty where there is none, or none that can be read: it is no loss.
    fn read(path: &Path) -> Self {
        let text = std::fs::read_to_string(path).unwrap_or_default();
        toml::from_str(&text).unwrap_or_default()
    }

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
        self.opened.truncate(MOST);
    }
}

/// What was opened last, in memory and in its file.
#[derive(Resource, Clone, Debug, Default)]
pub struct StoredRecentFiles {
    recent: RecentFiles,
    /// None where nothing is to be kept, as in tests.
    path: Option<PathBuf>,
}

impl StoredRecentFiles {
    /// That of a file.
    #[must_use]
    pub fn of_file(path: Option<PathBuf>) -> Self {
        let mut recent = path.as_deref().map(RecentFiles::read).unwrap_or_default();
        // What is gone cannot be opened; looked at once, and not in each frame.
        let is_there = |opened: &RecentEntry| opened.files.iter().all(|file| file.exists());
        recent.opened.retain(is_there);
        Self { recent, path }
    }

    /// What was opened, the last first.
    #[must_use]
    pub fn opened(&self) -> &[RecentEntry] {
        &self.recent.opened
    }

    /// The folders that it lies in, each once.
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
        // Another window may have opened something meanwhile.
        let mut there = RecentFiles::read(path);
        there.add(opened);
        there.write(path)
    }
}

/// Notes what is open, once it is.
pub fn follow(session: Res<Session>, mut recent: ResMut<StoredRecentFiles>) {
    if !session.is_changed() || session.transition().is_none() {
        return;
    }
    let files = match (session.path(), session.gallery_name()) {
        (Some(path), _) => vec![path.to_owned()],
        // These have cards of their own.
        (None, Some(_)) => return,
        (None, None) => session.files(),
    };
    let is_known = recent
        .opened()
        .first()
        .is_some_and(|last| last.files == files);
    if files.is_empty() || is_known {
        return;
    }
    if let Err(error) = recent.add(RecentEntry { files }) {
        // Not told in the window: nothing is lost by it.
        warn!("what was opened is not kept: {error}");
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
    fn the_last_comes_first_and_once() {
        let mut recent = RecentFiles::default();
        for name in ["a", "b", "a", "c", "d", "e", "f"] {
            recent.add(opened(name));
        }
        let titles: Vec<String> = recent.opened.iter().map(RecentEntry::title).collect();
        assert_eq!(titles, ["f", "e", "d", "c", "a"]);
    }

    #[test]
    fn what_is_gone_or_broken_is_left_out() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("state").join("recent.toml");
        let mut kept = StoredRecentFiles::of_file(Some(path.clone()));
        let here = RecentEntry {
            files: vec![folder.path().to_owned()],
        };
        kept.add(opened("gone")).expect("a file");
        kept.add(here.clone()).expect("a file");
        assert_eq!(kept.opened().len(), 2);
        assert_eq!(
            StoredRecentFiles::of_file(Some(path.clone())).opened(),
            [here]
        );
        std::fs::write(&path, "opened = 3").expect("a file");
        assert!(StoredRecentFiles::of_file(Some(path)).opened().is_empty());
    }
}
