//! Rebuilds the match sheet from the open project and the transition on the stage. The match sheet
//! is the data that the match editor shows: both designs in the common frame, with their parts,
//! pins, cuts and matched points.

use bevy::prelude::{DetectChanges, Local, Res, ResMut};

use crate::app::editing::editor::{EditorHandle, MatchEditor};
use crate::app::editing::sheet::MatchSheet;
use crate::app::session::state::Session;
use crate::app::session::transition_problem::TransitionProblem;
use crate::transition::Transition;

/// Rebuilds the sheet when the project or its transition changes, or when the editor opens.
pub fn refresh(
    session: Res<Session>,
    mut editor: ResMut<MatchEditor>,
    mut sheet: ResMut<MatchSheet>,
    mut was_open: Local<bool>,
) {
    // The sheet is rebuilt even while the editor is closed, because a panel lists the parts.
    let is_opened = editor.is_open && !*was_open;
    *was_open = editor.is_open;
    if !(is_opened || session.is_changed()) {
        return;
    }
    let mut rebuilt = MatchSheet::of(&session);
    // Letters are reused only for the same designs: points of other designs are different even if
    // they coincide with earlier ones.
    let before = std::mem::take(&mut *sheet);
    let is_same = !is_opened && before.sides == rebuilt.sides;
    rebuilt.assign_letters(is_same.then_some(&before));
    *sheet = rebuilt;
    if sheet.sides.is_none() {
        editor.is_open = false;
    }
    let exists = |handle: &EditorHandle| sheet.handles().any(|other| other == *handle);
    editor.selected = editor.selected.filter(exists);
    editor.hovered = editor.hovered.filter(exists);
}

impl MatchSheet {
    /// Sheet of the designs on the stage and their match; empty if there are not exactly two
    /// designs.
    #[must_use]
    pub fn of(session: &Session) -> Self {
        Self::try_of(session).unwrap_or_default()
    }

    /// As [`Self::of`], but `None` if there are not exactly two designs.
    fn try_of(session: &Session) -> Option<Self> {
        let (project, staged) = (session.project()?, session.staged_segment()?);
        let [source, target] = staged.designs.as_slice() else {
            return None;
        };
        // The designs are placed as on the stage, even if the settings have changed since then,
        // because the match was computed for this placement.
        let similarities = staged.frame_similarities().ok()?;
        let transition = session.transition();
        let matched = transition.and_then(Transition::matched);
        let mut sheet = Self {
            faulty_pins: session
                .problem()
                .map_or_else(Vec::new, TransitionProblem::pins),
            // The content comes from the newest settings, so that the tools change as soon as the
            // user selects another method.
            content: project.content,
            ..Self::new(
                [source, target],
                similarities,
                staged.project.options.paint,
                &project.options.matching,
                matched,
            )
        };
        if sheet.has_free_pins() {
            // The user's first pin disables the automatic pins, although the transition on the
            // stage may still use them.
            let has_no_pins = sheet.pins.is_empty() && sheet.lines.is_empty();
            let with_automatic_pins = transition.filter(|_| has_no_pins);
            sheet.features =
                with_automatic_pins.map_or_else(Vec::new, |t| t.automatic_pins().to_vec());
        }
        Some(sheet)
    }
}
