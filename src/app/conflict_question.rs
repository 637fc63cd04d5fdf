//! Asks before saving over a project file that another program or window has changed since it was
//! read or last saved.

use bevy::prelude::{Commands, MessageReader, ResMut};

use crate::app::input::intent::{ConflictAnswer, Intent};
use crate::app::notices::Notices;
use crate::app::session::load::LoadRequest;
use crate::app::session::save_conflict::ConflictQuestion;
use crate::app::session::state::Session;
use crate::app::unsaved_question::{UnsavedKind, UnsavedQuestion};

/// Applies the answers that do not save the project; the system that saves applies
/// [`ConflictAnswer::KeepMine`].
pub fn answer(
    mut intents: MessageReader<Intent>,
    mut conflict: ResMut<ConflictQuestion>,
    mut session: ResMut<Session>,
    mut unsaved: ResMut<UnsavedQuestion>,
    mut notices: ResMut<Notices>,
    mut commands: Commands,
) {
    for intent in intents.read() {
        let answer = match intent {
            Intent::AnswerConflict(answer) => *answer,
            Intent::Escape => ConflictAnswer::Cancel,
            _ => continue,
        };
        if !conflict.is_open {
            continue;
        }
        conflict.is_open = false;
        match answer {
            ConflictAnswer::KeepMine => {}
            ConflictAnswer::SaveAs => {
                commands.write_message(Intent::SaveAs);
            }
            ConflictAnswer::Cancel => {
                notices.note("Save cancelled");
                unsaved.save_cancelled();
            }
            ConflictAnswer::TakeTheirs => take_theirs(&mut session, &mut unsaved, &mut commands),
        }
    }
}

/// Opens the project file again or, if an intent waits for the changes to be saved, continues
/// without them.
fn take_theirs(session: &mut Session, unsaved: &mut UnsavedQuestion, commands: &mut Commands) {
    if let Some(waiting) = unsaved.take_if_resolved(UnsavedKind::Changes) {
        session.mark_saved();
        commands.write_message(waiting);
    } else if let Some(path) = session.path() {
        let request = LoadRequest::File(path.to_owned());
        session.open(request);
    }
}
