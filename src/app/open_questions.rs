//! Questions that the window may be asking the user.

use bevy::ecs::system::SystemParam;
use bevy::prelude::Res;

use crate::app::files::drop::DroppedDesign;
use crate::app::persistence::autosave::Autosave;
use crate::app::session::save_conflict::ConflictQuestion;
use crate::app::unsaved_question::UnsavedQuestion;

/// The questions that may be open: whether to save, whether to replace a file that was changed
/// elsewhere, where to put a dropped design, and whether to recover unsaved work.
#[derive(SystemParam)]
pub struct OpenQuestions<'w> {
    unsaved: Res<'w, UnsavedQuestion>,
    conflict: Res<'w, ConflictQuestion>,
    drop: Res<'w, DroppedDesign>,
    autosave: Res<'w, Autosave>,
}

impl OpenQuestions<'_> {
    /// Whether a question waits for an answer.
    #[must_use]
    pub fn any(&self) -> bool {
        self.unsaved.text().is_some()
            || self.conflict.is_open()
            || self.drop.is_pending()
            || self.autosave.recoverable().is_some()
    }
}
