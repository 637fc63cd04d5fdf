//! Views that the user opens in place of the stage or to its right.

use bevy::ecs::system::SystemParam;
use bevy::prelude::{DetectChanges, Res, ResMut};

use crate::app::compare::comparison::Comparison;
use crate::app::editing::editor::MatchEditor;
use crate::app::map::map_view::MapView;
use crate::app::playback::player::Playback;
use crate::app::session::state::Session;

/// All views that the user opens in place of the stage or to its right.
#[derive(SystemParam)]
pub struct ToolViews<'w> {
    /// The match editor.
    pub editor: ResMut<'w, MatchEditor>,
    /// The comparison with another method.
    pub comparison: ResMut<'w, Comparison>,
    /// The map of all designs.
    pub map: ResMut<'w, MapView>,
}

impl ToolViews<'_> {
    /// Whether the match editor, the comparison or the map is open.
    #[must_use]
    pub fn is_any_open(&self) -> bool {
        is_any_open(&self.editor, &self.comparison, &self.map)
    }
}

/// Whether the match editor, the comparison or the map is open.
#[must_use]
pub const fn is_any_open(editor: &MatchEditor, comparison: &Comparison, map: &MapView) -> bool {
    editor.is_open || comparison.is_shown || map.is_shown
}

/// Closes all views and ends playback once the project has been closed, because there is nothing
/// for them to show.
pub fn close_without_project(
    session: Res<Session>,
    mut playback: ResMut<Playback>,
    mut views: ToolViews,
) {
    if !session.is_changed() || session.project().is_some() || session.is_opening() {
        return;
    }
    playback.rewind(session.timing());
    if views.is_any_open() {
        (views.editor.is_open, views.comparison.is_shown) = (false, false);
        views.map.hide();
    }
}
