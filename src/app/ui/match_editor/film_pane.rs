//! Film pane of the match editor, next to the designs. The pane is transparent, so that the stage
//! behind it is visible.

use bevy::prelude::Vec2;
use bevy_egui::egui::{Align2, PointerButton, Rect, Sense, Ui, vec2};

use crate::app::input::editor_action::EditorAction;
use crate::app::input::editor_action::EditorPane;
use crate::app::input::intent::Intent;
use crate::app::ui::kit::theme::{GRID, SMALL};
use crate::app::ui::match_editor::colours::EditorColours;
use crate::app::ui::match_editor::toolbar::{BAR_HEIGHT, INSTRUCTIONS_HEIGHT};
use crate::app::ui::stage::area::{self, zoom_factor};
use crate::app::ui::stage::{checks, onion};
use crate::app::ui::ui_state::{Intents, UiState};

/// Paints the background above and below the film, draws the overlays of the film, and handles
/// panning and zooming. Returns the rectangle in which the stage is visible.
pub fn show(
    root: &Ui,
    state: &UiState,
    column: Rect,
    colours: &EditorColours,
    intents: &mut Intents,
) -> Rect {
    let film_rect = Rect::from_min_max(
        column.min + vec2(0.0, BAR_HEIGHT + 4.0 * GRID),
        column.max - vec2(0.0, INSTRUCTIONS_HEIGHT),
    );
    let painter = root.painter().with_clip_rect(column);
    let (above, rest) = column.split_top_bottom_at_y(film_rect.top());
    let (_, below) = rest.split_top_bottom_at_y(film_rect.bottom());
    for around in [above, below] {
        painter.rect_filled(around, 0.0, colours.ground);
    }
    let at = column.left_top() + vec2(2.0 * GRID, BAR_HEIGHT + 2.0 * GRID);
    painter.text(at, Align2::LEFT_TOP, "Film", SMALL, colours.ink);
    area::empty_hint(root, state, film_rect);
    onion::show(root, state, film_rect);
    checks::mark(root, state, film_rect);
    pan_and_zoom(root, film_rect, intents);
    film_rect
}

fn pan_and_zoom(root: &Ui, film_rect: Rect, intents: &mut Intents) {
    let response = root.interact(film_rect, root.id().with("film"), Sense::click_and_drag());
    let delta = response.drag_delta();
    if response.dragged() && delta != vec2(0.0, 0.0) {
        let delta = Vec2::new(delta.x, delta.y);
        intents.push(Intent::Editor(EditorAction::Pan(EditorPane::Film, delta)));
    }
    if response.double_clicked_by(PointerButton::Primary) {
        intents.push(Intent::FitView);
    }
    if let Some(pointer) = response.hover_pos()
        && let Some(factor) = zoom_factor(root)
    {
        let at = pointer - film_rect.center();
        intents.push(Intent::Editor(EditorAction::Zoom {
            pane: EditorPane::Film,
            at: Vec2::new(at.x, at.y),
            factor,
        }));
    }
}
