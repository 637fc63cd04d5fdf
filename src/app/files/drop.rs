//! Handles files dropped on the window, and holds a single design for which the user is asked where
//! it goes.

use std::path::{Path, PathBuf};

use bevy::prelude::{MessageReader, MessageWriter, Res, ResMut, Resource};
use bevy::window::FileDragAndDrop;

use crate::app::input::intent::Intent;
use crate::app::persistence::autosave::Autosave;
use crate::app::presentation::presenter::Presentation;
use crate::app::session::save_conflict::ConflictQuestion;
use crate::app::unsaved_question::UnsavedQuestion;

/// A single dropped or opened design, while the user is asked for the second design of its film, or
/// whether it is added to the open project.
#[derive(Resource, Clone, Debug, Default, PartialEq)]
pub struct DroppedDesign {
    undecided: Option<PathBuf>,
}

impl DroppedDesign {
    /// The dropped or opened design, while the user is asked where it should go.
    #[must_use]
    pub fn undecided(&self) -> Option<&Path> {
        self.undecided.as_deref()
    }

    /// Whether the user is being asked where a dropped or opened design should go.
    #[must_use]
    pub fn is_pending(&self) -> bool {
        self.undecided.is_some()
    }

    /// Asks the user where this single design goes.
    pub fn ask(&mut self, path: PathBuf) {
        self.undecided = Some(path);
    }

    /// Closes the question, if it is open.
    pub fn close(&mut self) {
        self.undecided = None;
    }
}

/// Whether the window system delivers files that are dropped on the window.
#[derive(Resource, Clone, Copy, Debug, PartialEq, Eq)]
pub struct DropSupport(pub bool);

impl Default for DropSupport {
    fn default() -> Self {
        Self(true)
    }
}

/// Sort key of a file name, in which numbers compare by value: 2 comes before 10.
fn natural_sort_key(name: &str) -> Vec<(String, u64)> {
    let digits = |c: &char| c.is_ascii_digit();
    let mut chars = name.chars().peekable();
    let mut words_and_numbers = Vec::new();
    while chars.peek().is_some() {
        let mut word = String::new();
        while let Some(c) = chars.next_if(|c| !digits(c)) {
            word.extend(c.to_lowercase());
        }
        let mut number: u64 = 0;
        while let Some(digit) = chars.next_if(digits).and_then(|c| c.to_digit(10)) {
            number = number.saturating_mul(10).saturating_add(digit.into());
        }
        words_and_numbers.push((word, number));
    }
    words_and_numbers
}

/// Opens all files that were dropped together. The system sends one event per file, but all events
/// arrive before the next screen update (`winit` on X11, Windows and macOS).
pub fn read_drops(
    mut drops: MessageReader<FileDragAndDrop>,
    presentation: Res<Presentation>,
    mut intents: MessageWriter<Intent>,
) {
    if presentation.is_active() {
        // Nothing is opened or asked during a talk.
        drops.clear();
    }
    let files = drops.read().filter_map(|drop| match drop {
        FileDragAndDrop::DroppedFile { path_buf, .. } => Some(path_buf.clone()),
        _ => None,
    });
    let mut files: Vec<PathBuf> = files.collect();
    if files.is_empty() {
        return;
    }
    // More than two files arrive in arbitrary order; sort them as file managers do.
    if files.len() > 2 {
        files.sort_by_cached_key(|path| natural_sort_key(&path.to_string_lossy()));
    }
    intents.write(Intent::Open(files));
}

/// Closes the question about a single design once it is answered. The system that opens designs
/// closes it as well, because it knows which of them are asked about.
pub fn close_drop_question(
    mut intents: MessageReader<Intent>,
    mut dropped: ResMut<DroppedDesign>,
    question: Res<UnsavedQuestion>,
    conflict: Res<ConflictQuestion>,
    autosave: Res<Autosave>,
) {
    // Esc closes only the topmost question.
    let is_topmost =
        question.text().is_none() && !conflict.is_open() && autosave.recoverable().is_none();
    let is_decided = |intent: &Intent| match intent {
        Intent::Escape => is_topmost,
        intent => matches!(
            intent,
            Intent::ReplaceDesign(..) | Intent::InsertDesigns(..) | Intent::AskSecond(_)
        ),
    };
    if intents.read().filter(|intent| is_decided(intent)).count() > 0 && dropped.is_pending() {
        dropped.close();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_sort_as_in_file_managers() {
        let mut names = ["b10.svg", "B2.svg", "a.svg", "b2x.svg", "3.svg"];
        names.sort_by_cached_key(|name| natural_sort_key(name));
        assert_eq!(names, ["3.svg", "a.svg", "B2.svg", "b2x.svg", "b10.svg"]);
    }
}
