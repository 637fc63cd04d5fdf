//! Recent files: the projects and designs opened last, which the next start offers for opening with
//! one click, and the folder of the last export.

use crate::project::title::title_of;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use bevy::prelude::{DetectChanges, Local, Res, ResMut, Resource, warn};
use serde::{Deserialize, Serialize};

use crate::app::output_files::CaptureFolder;
use crate::app::session::state::Session;
use crate::design::DesignSource;
use crate::io::atomic_file::AtomicFile;
use crate::io::{path_text, read};

/// Maximum number of entries (heuristic: as many as fit above the gallery).
const MAX_ENTRIES: usize = 5;

/// Files that were opened together.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct RecentEntry {
    /// Path of one project file, or sources of designs opened together; a source may also be an
    /// element of a file, or text.
    #[serde(with = "path_text::list")]
    pub files: Vec<PathBuf>,
}

impl RecentEntry {
    /// Short title of the entry.
    #[must_use]
    pub fn title(&self) -> String {
        let name = |path: &PathBuf| DesignSource::from_path(path).name();
        let names: Vec<String> = self.files.iter().map(name).collect();
        title_of(&names)
    }

    /// Whether both list the same files, in any order: a film and its reverse are listed once.
    fn is_same(&self, other: &Self) -> bool {
        let sorted = |entry: &Self| {
            let mut files = entry.files.clone();
            files.sort();
            files
        };
        sorted(self) == sorted(other)
    }

    /// Whether all files still exist; text in the bundled font needs none.
    fn exists(&self) -> bool {
        let exists = |path: &PathBuf| {
            let source = DesignSource::from_path(path);
            source.file().is_none_or(Path::exists)
        };
        self.files.iter().all(exists)
    }
}

/// List of the files opened last, the newest first.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct RecentFiles {
    /// Folder of the last export.
    #[serde(
        default,
        skip_serializing_if = "Option::is_none",
        with = "path_text::option"
    )]
    export_folder: Option<PathBuf>,
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
        let bytes = read::read(path).unwrap_or_default();
        toml::from_slice(&bytes).unwrap_or_default()
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

    /// Adds an entry as the newest. Another entry with the same files is removed, and so is
    /// `replaced`, if given.
    fn add(&mut self, opened: RecentEntry, replaced: Option<&RecentEntry>) {
        let is_gone = |other: &RecentEntry| {
            other.is_same(&opened) || replaced.is_some_and(|replaced| other.is_same(replaced))
        };
        self.opened.retain(|other| !is_gone(other));
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
    /// Entry of the open project, if it has one; a later entry of the same project replaces it.
    open: Option<RecentEntry>,
}

impl StoredRecentFiles {
    /// Reads the list from a file.
    #[must_use]
    pub fn of_file(path: Option<PathBuf>) -> Self {
        let mut recent = path.as_deref().map(RecentFiles::read).unwrap_or_default();
        // Entries with missing files are dropped; this is checked only at the start, because it
        // reads the disk.
        recent.opened.retain(RecentEntry::exists);
        Self {
            recent,
            path,
            open: None,
        }
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

    /// Folder of the last export; `None` before the first one.
    #[must_use]
    pub fn export_folder(&self) -> Option<&Path> {
        self.recent.export_folder.as_deref()
    }

    /// Stores the folder of the last export.
    fn set_export_folder(&mut self, folder: &Path) -> io::Result<()> {
        self.change(|recent| recent.export_folder = Some(folder.to_owned()))
    }

    /// Changes the list in memory and in its file.
    fn change(&mut self, change: impl Fn(&mut RecentFiles)) -> io::Result<()> {
        change(&mut self.recent);
        let Some(path) = &self.path else {
            return Ok(());
        };
        // Another window may have changed the file meanwhile.
        let mut stored = RecentFiles::read(path);
        change(&mut stored);
        stored.write(path)
    }

    /// Adds the entry of the open project; it replaces an earlier entry of the same project.
    fn add(&mut self, opened: RecentEntry) -> io::Result<()> {
        let replaced = self.open.replace(opened.clone());
        self.change(|recent| recent.add(opened.clone(), replaced.as_ref()))
    }
}

/// Adds the open project to the list. Each project has one entry: designs that are replaced and
/// designs that are saved as a project change it.
pub fn follow(
    session: Res<Session>,
    mut recent: ResMut<StoredRecentFiles>,
    mut opened: Local<Option<u64>>,
) {
    if !session.is_changed() || session.transition().is_none() {
        return;
    }
    if *opened != session.document_number() {
        // Another project has been opened: the entry of the previous one stays.
        *opened = session.document_number();
        recent.open = None;
    }
    let files = match (session.path(), session.gallery_name()) {
        (Some(path), _) => vec![path.to_owned()],
        // Gallery projects are not listed, because the gallery has a card for each of them.
        (None, Some(_)) => return,
        (None, None) => session.design_paths(),
    };
    // A single design, paired with itself, is not a film yet.
    let is_single = session.path().is_none() && files.windows(2).all(|pair| pair[0] == pair[1]);
    let entry = RecentEntry { files };
    if is_single || recent.open.as_ref() == Some(&entry) {
        return;
    }
    if let Err(error) = recent.add(entry) {
        // The error is only logged, because the user loses nothing.
        warn!("cannot write the list of recent files: {error}");
    }
}

/// Stores the folder that the user chose for an export.
pub fn follow_exports(folder: Res<CaptureFolder>, mut recent: ResMut<StoredRecentFiles>) {
    let Some(last) = folder.last().filter(|_| folder.is_changed()) else {
        return;
    };
    if recent.export_folder() != Some(last)
        && let Err(error) = recent.set_export_folder(last)
    {
        warn!("cannot write the folder of the last export: {error}");
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
            recent.add(opened(name), None);
        }
        let titles: Vec<String> = recent.opened.iter().map(RecentEntry::title).collect();
        assert_eq!(titles, ["f", "e", "d", "c", "a"]);
    }

    #[test]
    fn a_pair_and_the_project_made_from_it_are_listed_once() {
        let pair = |a: &str, b: &str| RecentEntry {
            files: [a, b].map(PathBuf::from).into(),
        };
        let mut stored = StoredRecentFiles::default();
        stored.add(opened("other")).expect("nothing is written");
        stored.open = None;
        stored.add(pair("a.svg", "b.svg")).expect("not written");
        stored.add(pair("b.svg", "a.svg")).expect("not written");
        assert_eq!(stored.entries(), [pair("b.svg", "a.svg"), opened("other")]);
        // The design is replaced, and the project is then saved.
        stored.add(pair("b.svg", "c.svg")).expect("not written");
        stored.add(opened("saved")).expect("not written");
        assert_eq!(stored.entries(), [opened("saved"), opened("other")]);
    }

    #[test]
    fn missing_and_broken_files_are_left_out() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("state").join("recent.toml");
        let mut stored = StoredRecentFiles::of_file(Some(path.clone()));
        let existing = RecentEntry {
            files: vec![folder.path().to_owned(), "glyph:D".into()],
        };
        stored.add(opened("gone")).expect("a file");
        stored.open = None;
        stored.add(existing.clone()).expect("a file");
        assert_eq!(stored.entries().len(), 2);
        assert_eq!(
            StoredRecentFiles::of_file(Some(path.clone())).entries(),
            [existing]
        );
        std::fs::write(&path, "opened = 3").expect("a file");
        assert!(StoredRecentFiles::of_file(Some(path)).entries().is_empty());
    }

    #[cfg(unix)]
    #[test]
    fn pipes_are_not_opened_and_any_path_is_stored() {
        use std::os::unix::ffi::OsStrExt;
        let folder = tempfile::tempdir().expect("a folder");
        let pipe = folder.path().join("recent.toml");
        let made = std::process::Command::new("mkfifo").arg(&pipe).status();
        assert!(made.expect("mkfifo").success());
        // Opening the pipe would block for ever.
        assert!(StoredRecentFiles::of_file(Some(pipe)).entries().is_empty());
        let file = folder.path().join(std::ffi::OsStr::from_bytes(b"\xe9.svg"));
        std::fs::write(&file, "").expect("a file");
        let path = folder.path().join("others.toml");
        let mut stored = StoredRecentFiles::of_file(Some(path.clone()));
        let entry = RecentEntry { files: vec![file] };
        stored.set_export_folder(&entry.files[0]).expect("a file");
        stored.add(entry.clone()).expect("a file");
        let again = StoredRecentFiles::of_file(Some(path));
        assert_eq!(again.entries(), std::slice::from_ref(&entry));
        assert_eq!(again.export_folder(), Some(entry.files[0].as_path()));
    }
}
