//! Decides when the invitation is shown, which gallery projects it offers, and which one plays next
//! to it when the program starts without files. The panel itself is drawn in
//! `app::ui::stage::invitation`.

use bevy::prelude::{MessageReader, Res, ResMut, Resource};

use crate::app::input::intent::{Intent, RecoveryAnswer};
use crate::app::session::state::Session;
use crate::project::Project;
use crate::project::gallery::GalleryEntry;

/// Gallery project that plays when the program starts without files: it is ready within a second,
/// and every part of it moves.
pub const START_PROJECT: &str = "gecko";

/// Names of the gallery projects that the invitation offers, in this order. The list begins with
/// one project for each kind of design.
pub const EXAMPLES: [&str; 10] = [
    "day-to-night",
    "three-portraits",
    "girder-to-arch",
    "letters-in-turn",
    "fern",
    "words",
    "bridges",
    "vessels",
    "spectacles",
    "bracket-to-davit",
];

/// Whether the invitation is shown.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Invitation {
    is_shown: bool,
}

impl Invitation {
    /// Whether the invitation is shown.
    #[must_use]
    pub fn is_shown(&self) -> bool {
        self.is_shown
    }

    /// Closes the invitation.
    pub fn close(&mut self) {
        self.is_shown = false;
    }
}

/// Entries of the gallery projects that the invitation offers, in the order of [`EXAMPLES`].
#[must_use]
pub fn examples(gallery: &[GalleryEntry]) -> Vec<&GalleryEntry> {
    let entry = |name: &&str| gallery.iter().find(|entry| entry.name == **name);
    EXAMPLES.iter().filter_map(entry).collect()
}

/// Shows the invitation at the start and after the project was closed, and closes it as soon as the
/// user opens anything.
pub fn apply(
    mut intents: MessageReader<Intent>,
    session: Res<Session>,
    mut invitation: ResMut<Invitation>,
) {
    for intent in intents.read() {
        match intent {
            Intent::Welcome => invitation.is_shown = true,
            Intent::New if session.project().is_none() => invitation.is_shown = true,
            Intent::CloseInvitation
            | Intent::OpenAlone(_)
            | Intent::OpenGallery(_)
            | Intent::PlayGallery(_)
            | Intent::InsertDesigns(..)
            | Intent::ReplaceDesign(..)
            | Intent::AnswerRecovery(RecoveryAnswer::Restore) => invitation.is_shown = false,
            // A single design opens nothing yet: the user is asked for a second one.
            Intent::Open(files) => match files.as_slice() {
                [] => {}
                [design] if !Project::has_document_extension(design) => {}
                _ => invitation.is_shown = false,
            },
            _ => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::project::gallery;

    #[test]
    fn every_offered_project_is_in_the_gallery() -> Result<(), Box<dyn std::error::Error>> {
        let gallery = gallery::list()?;
        let offered = examples(&gallery);
        let names: Vec<&str> = offered.iter().map(|entry| entry.name.as_str()).collect();
        assert_eq!(names, EXAMPLES);
        assert!(gallery.iter().any(|entry| entry.name == START_PROJECT));
        Ok(())
    }
}
