//! Asks before saving over a project file that another program or window has changed since it was
//! read or last saved.

use bevy::prelude::{Commands, MessageReader, ResMut};

use crate::app::input::intent::{ConflictAnswer, Intent};
use crate::app::notices::Notices;
use crate::app::session::load::LoadRequest;
use crate::app::session::save_conflict::ConflictQuestion;
use crate::app::session::state::Session;
use crate::app::unsaved_question::{UnsavedKind, UnsavedQuestion};

/// Applies the answer. Closes the question if another document has been opened meanwhile.
pub fn answer(
    mut intents: MessageReader<Intent>,
    mut conflict: ResMut<ConflictQuestion>,
    mut session: ResMut<Session>,
    mut unsaved: ResMut<UnsavedQuestion>,
    mut notices: ResMut<Notices>,
    mut commands: Commands,
) {
    if conflict.close_unless(session.document_number()) {
        unsaved.save_cancelled();
    }
    for intent in intents.read() {
        let answer = match intent {
            Intent::AnswerConflict(answer) => *answer,
            Intent::Escape => ConflictAnswer::Cancel,
            _ => continue,
        };
        if !conflict.close() {
            continue;
        }
        match answer {
            ConflictAnswer::Overwrite => {
                if let Some(path) = session.path() {
                    commands.write_message(Intent::SaveTo(path.to_owned()));
                }
            }
            ConflictAnswer::SaveAs => {
                commands.write_message(Intent::SaveAs);
            }
            ConflictAnswer::Cancel => {
                notices.note("Save cancelled");
                unsaved.save_cancelled();
            }
            ConflictAnswer::Reload => reload(&mut session, &mut unsaved, &mut commands),
        }
    }
}

/// Opens the project file again or, if an intent waits for the changes to be saved, continues
/// without them.
fn reload(session: &mut Session, unsaved: &mut UnsavedQuestion, commands: &mut Commands) {
    if let Some(waiting) = unsaved.take_if_resolved(UnsavedKind::Changes) {
        session.mark_saved();
        commands.write_message(waiting);
    } else if let Some(path) = session.path() {
        let request = LoadRequest::File(path.to_owned());
        session.open(request);
    }
}
