//! Views that the user opens in place of the stage or to its right.

use bevy::ecs::system::SystemParam;
use bevy::prelude::ResMut;

use crate::app::compare::comparison::Comparison;
use crate::app::editing::editor::MatchEditor;
use crate::app::map::map_view::MapView;

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
