//! Files that are dropped on the window.

use std::path::{Path, PathBuf};

use bevy::prelude::{MessageReader, MessageWriter, Res, ResMut, Resource, Time};
use bevy::window::FileDragAndDrop;

use crate::app::asking::intent::Intent;
use crate::app::keeping::autosave::Autosave;
use crate::app::opening::closing::Question;
use crate::app::playing::presenting::Presenting;

/// Files that are dropped together arrive one by one; so long is waited for the next.
const GATHER_SECS: f32 = 0.15;

/// Files that were dropped: those still arriving, and one of which nobody knows what it is for.
#[derive(Resource, Clone, Debug, Default, PartialEq)]
pub struct Drop {
    arriving: Vec<PathBuf>,
    quiet_secs: f32,
    undecided: Option<PathBuf>,
    /// More than a pair.
    many: Vec<PathBuf>,
}

impl Drop {
    /// A single design that may become source or target.
    #[must_use]
    pub fn undecided(&self) -> Option<&Path> {
        self.undecided.as_deref()
    }

    /// Files are arriving that are not acted on yet.
    #[must_use]
    pub fn is_arriving(&self) -> bool {
        !self.arriving.is_empty()
    }

    /// More designs than a pair has, of which two are to be chosen.
    #[must_use]
    pub fn many(&self) -> &[PathBuf] {
        &self.many
    }

    /// Something is to be decided.
    #[must_use]
    pub fn asks(&self) -> bool {
        self.undecided.is_some() || !self.many.is_empty()
    }

    /// Asks which two of many designs are a pair.
    pub fn ask_which(&mut self, paths: Vec<PathBuf>) {
        self.many = paths;
    }

    /// Asks what a single design is for.
    pub fn ask(&mut self, path: PathBuf) {
        self.undecided = Some(path);
    }
}

/// Gathers dropped files and opens them together.
pub fn read_drops(
    mut drops: MessageReader<FileDragAndDrop>,
    time: Res<Time>,
    mut state: ResMut<Drop>,
    presenting: Res<Presenting>,
    mut intents: MessageWriter<Intent>,
) {
    if presenting.is_on() {
        // Nothing is opened before an audience, and nothing asked.
        drops.clear();
    }
    for drop in drops.read() {
        if let FileDragAndDrop::DroppedFile { path_buf, .. } = drop {
            state.arriving.push(path_buf.clone());
            state.quiet_secs = 0.0;
        }
    }
    if state.arriving.is_empty() {
        return;
    }
    state.quiet_secs += time.delta_secs();
    if state.quiet_secs >= GATHER_SECS {
        intents.write(Intent::Open(std::mem::take(&mut state.arriving)));
    }
}

/// Forgets the undecided file once it is decided.
pub fn decide(
    mut intents: MessageReader<Intent>,
    mut state: ResMut<Drop>,
    (question, autosave): (Res<Question>, Res<Autosave>),
) {
    // Esc is meant for the question that is seen.
    let is_seen = question.text().is_none() && autosave.lost().is_none();
    let is_decided = |intent: &Intent| match intent {
        Intent::Open(paths) => paths.len() <= 2,
        Intent::Back => is_seen,
        intent => matches!(intent, Intent::ReplaceDesign(..)),
    };
    if intents.read().filter(|intent| is_decided(intent)).count() > 0 && state.asks() {
        state.undecided = None;
        state.many.clear();
    }
}
