//! How films are made, kept under names of the user's own; the command line knows them too.

use std::io;
use std::path::PathBuf;

use bevy::prelude::{MessageReader, Res, ResMut, Resource, warn};

use crate::app::input::intent::Intent;
use crate::app::input::preferences::{FilmFileFormat, Preferences};
use crate::app::notices::{NoticeTopic, Notices};
use crate::app::session::state::Session;
use crate::content::ContentKind;
use crate::export::{FilmPreset, FilmPresets};

/// All that are kept.
#[derive(Resource, Clone, Debug, Default)]
pub struct StoredPresets {
    presets: FilmPresets,
    /// None where nothing is to be kept, as in tests.
    path: Option<PathBuf>,
}

impl StoredPresets {
    /// Those of a file. One that cannot be read stays as it is.
    #[must_use]
    pub fn of_file(path: Option<PathBuf>) -> Self {
        let read = path.as_deref().map(FilmPresets::read);
        match read {
            Some(Ok(presets)) => Self { presets, path },
            Some(Err(error)) => {
                warn!("kept looks of films: {error}");
                Self {
                    presets: FilmPresets::default(),
                    path,
                }
            }
            None => Self::default(),
        }
    }

    /// Makes a change, also in the file: in what is there now, for another window may have changed
    /// it, too.
    fn change(&mut self, change: impl Fn(&mut FilmPresets)) -> io::Result<()> {
        change(&mut self.presets);
        let Some(path) = &self.path else {
            return Ok(());
        };
        let mut there = FilmPresets::read(path)?;
        change(&mut there);
        there.write(path)?;
        self.presets = there;
        Ok(())
    }

    /// Their names.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.presets.0.keys().map(String::as_str)
    }

    /// The one that is in use, by its name.
    #[must_use]
    pub fn in_use(&self, preferences: &Preferences, content: Option<ContentKind>) -> Option<&str> {
        let now = preset(preferences, content);
        let same = self.presets.0.iter().find(|(_, preset)| **preset == now);
        same.map(|(name, _)| name.as_str())
    }
}

fn preset(preferences: &Preferences, content: Option<ContentKind>) -> FilmPreset {
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
    }
}

/// Keeps, takes and forgets them.
pub fn apply(
    mut intents: MessageReader<Intent>,
    mut kept: ResMut<StoredPresets>,
    mut preferences: ResMut<Preferences>,
    (session, mut notices): (Res<Session>, ResMut<Notices>),
) {
    for intent in intents.read() {
        let changed = match intent {
            Intent::UsePreset(name) => {
                if let Some(preset) = kept.presets.0.get(name) {
                    preferences.film.layout = preset.layout();
                    preferences.film.fps = preset.fps;
                    let file = preset
                        .file
                        .map_or(FilmFileFormat::Pngs, FilmFileFormat::Film);
                    preferences.record_format = Some(file);
                }
                continue;
            }
            Intent::KeepPreset(name) => {
                let content = session.project().and_then(|project| project.content);
                let now = preset(&preferences, content);
                let keep = |all: &mut FilmPresets| {
                    all.0.insert(name.clone(), now);
                };
                kept.change(keep)
            }
            Intent::ForgetPreset(name) => kept.change(|all| {
                all.0.remove(name);
            }),
            _ => continue,
        };
        if let Err(error) = changed {
            let words = format!("It is not kept for the next start: {error}.");
            notices.problem(NoticeTopic::Film, words);
        }
    }
}
