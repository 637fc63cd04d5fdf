//! Export presets saved under names of the user's choice; the command line can use them too.

use std::io;
use std::path::{Path, PathBuf};

use bevy::prelude::{MessageReader, Res, ResMut, Resource, warn};

use crate::app::input::intent::Intent;
use crate::app::input::preferences::{FilmFileFormat, Preferences};
use crate::app::notices::{NoticeTopic, Notices};
use crate::app::output_files::CaptureFolder;
use crate::app::session::state::Session;
use crate::content::ContentKind;
use crate::export::{FilmPreset, FilmPresets};

/// The user's export presets, in memory and in their file.
#[derive(Resource, Clone, Debug, Default)]
pub struct StoredPresets {
    presets: FilmPresets,
    /// File of the presets; `None` if nothing is written, as in tests.
    path: Option<PathBuf>,
}

impl StoredPresets {
    /// Reads presets from a file. An unreadable file is left untouched.
    #[must_use]
    pub fn of_file(path: Option<PathBuf>) -> Self {
        let read = path.as_deref().map(FilmPresets::read);
        match read {
            Some(Ok(presets)) => Self { presets, path },
            Some(Err(error)) => {
                warn!("cannot read the export presets: {error}");
                Self {
                    presets: FilmPresets::default(),
                    path,
                }
            }
            None => Self::default(),
        }
    }

    /// Changes the presets in memory and in the file, which is read first because another window
    /// may have changed it.
    fn change(&mut self, change: impl Fn(&mut FilmPresets)) -> io::Result<()> {
        change(&mut self.presets);
        let Some(path) = &self.path else {
            return Ok(());
        };
        let mut stored = FilmPresets::read(path)?;
        change(&mut stored);
        stored.write(path)?;
        self.presets = stored;
        Ok(())
    }

    /// Names of the presets.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.presets.0.keys().map(String::as_str)
    }

    /// Name of the preset that equals the current export settings, if any.
    #[must_use]
    pub fn in_use(
        &self,
        preferences: &Preferences,
        content: Option<ContentKind>,
        export_folder: Option<&Path>,
    ) -> Option<&str> {
        let now = preset(preferences, content, export_folder);
        let is_now = |preset: &FilmPreset| match preset.folder {
            Some(_) => *preset == now,
            // A preset without a folder leaves the folder as it is.
            None => {
                *preset
                    == FilmPreset {
                        folder: None,
                        ..now.clone()
                    }
            }
        };
        let matching = self.presets.0.iter().find(|(_, preset)| is_now(preset));
        matching.map(|(name, _)| name.as_str())
    }
}

/// The current export settings as a preset.
fn preset(
    preferences: &Preferences,
    content: Option<ContentKind>,
    export_folder: Option<&Path>,
) -> FilmPreset {
    let format = preferences.format(content);
    let layout = preferences.film.layout;
    FilmPreset {
        aspect: layout.aspect,
        lines: layout.lines,
        margin: layout.margin,
        captions: layout.has_captions,
        fps: preferences.film.fps,
        file: match format {
            FilmFileFormat::Film(kind) => Some(kind),
            FilmFileFormat::Pngs => None,
        },
        folder: export_folder.map(Path::to_owned),
    }
}

/// Saves, applies and removes presets.
pub fn apply(
    mut intents: MessageReader<Intent>,
    mut stored: ResMut<StoredPresets>,
    mut preferences: ResMut<Preferences>,
    mut capture_folder: ResMut<CaptureFolder>,
    session: Res<Session>,
    mut notices: ResMut<Notices>,
) {
    for intent in intents.read() {
        let changed = match intent {
            Intent::UsePreset(name) => {
                if let Some(preset) = stored.presets.0.get(name) {
                    preferences.film.layout = preset.layout();
                    preferences.film.fps = preset.fps;
                    let file = preset
                        .file
                        .map_or(FilmFileFormat::Pngs, FilmFileFormat::Film);
                    preferences.record_format = Some(file);
                    if let Some(folder) = &preset.folder {
                        capture_folder.choose(folder);
                    }
                }
                continue;
            }
            Intent::SavePreset(name) => {
                let content = session.project().and_then(|project| project.content);
                let now = preset(&preferences, content, capture_folder.last());
                let insert = |all: &mut FilmPresets| {
                    all.0.insert(name.clone(), now.clone());
                };
                stored.change(insert)
            }
            Intent::RemovePreset(name) => stored.change(|all| {
                all.0.remove(name);
            }),
            _ => continue,
        };
        if let Err(error) = changed {
            let text = format!("The preset was not saved: {error}");
            notices.problem(NoticeTopic::Film, text);
        }
    }
}
