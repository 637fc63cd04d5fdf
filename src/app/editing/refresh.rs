//! Rebuilds the match sheet from the open project and the transition on the stage.

use bevy::prelude::{DetectChanges, Local, Res, ResMut};

use crate::app::editing::editor::{EditorHandle, MatchEditor};
use crate::app::editing::sheet::MatchSheet;
use crate::app::session::load::TransitionProblem;
use crate::app::session::state::Session;
use crate::transition::Transition;

/// Rebuilds the sheet when the project or its transition changes, or when the editor opens.
pub fn refresh(
    session: Res<Session>,
    mut editor: ResMut<MatchEditor>,
    mut sheet: ResMut<MatchSheet>,
    mut was_open: Local<bool>,
) {
    // Also while the editor is closed, because a panel lists the parts.
    let is_opened = editor.is_open && !*was_open;
    *was_open = editor.is_open;
    if !(is_opened || session.is_changed()) {
        return;
    }
    let mut laid_out = MatchSheet::of(&session);
    // Points of other designs are different even if they coincide with earlier ones.
    let before = std::mem::take(&mut *sheet);
    let is_same = !is_opened && before.sides == laid_out.sides;
    laid_out.call(is_same.then_some(&before));
    *sheet = laid_out;
    if sheet.sides.is_none() {
        editor.is_open = false;
    }
    let is_there = |handle: &EditorHandle| sheet.handles().any(|other| other == *handle);
    editor.selected = editor.selected.filter(is_there);
    editor.hovered = editor.hovered.filter(is_there);
}

impl MatchSheet {
    /// Sheet of the designs on the stage and their match.
    #[must_use]
    pub fn of(session: &Session) -> Self {
        Self::laid_out(session).unwrap_or_default()
    }

    /// As [`Self::of`]; `None` if there are not exactly two designs.
    fn laid_out(session: &Session) -> Option<Self> {
        let (project, staged) = (session.project()?, session.staged()?);
        let [source, target] = staged.designs.as_slice() else {
            return None;
        };
        // Placement as on the stage, not as in newer settings: the match belongs to the stage.
        let by = staged.arrangement().ok()?;
        let transition = session.transition();
        let matched = transition.and_then(Transition::matched);
        let mut sheet = Self {
            faulty: session
                .problem()
                .map_or_else(Vec::new, TransitionProblem::pins),
            // The content is that of the newest settings, so that tools change with the method at
            // once.
            content: project.content,
            ..Self::new(
                [source, target],
                by,
                staged.project.options.paint,
                &project.options.matching,
                matched,
            )
        };
        if sheet.is_free() {
            // The user's first pin disables automatic ones, while the stage may still show them.
            let is_bare = sheet.pins.is_empty() && sheet.lines.is_empty();
            let shown = transition.filter(|_| is_bare);
            sheet.features = shown.map_or_else(Vec::new, |t| t.automatic_pins().to_vec());
        }
        Some(sheet)
    }
}
