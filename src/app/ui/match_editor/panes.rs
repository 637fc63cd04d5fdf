//! Layout of the match editor (two design panes and the film pane), the line of instructions below
//! the panes, and pointer input in the design panes.

use bevy::prelude::Vec2;
use bevy_egui::egui::{
    self, Align2, Context, CornerRadius, Painter, PointerButton, Rect, Response, Sense, Ui, vec2,
};

use crate::app::editing::sheet::SheetSide;
use crate::app::input::editor_action::EditorPane;
use crate::app::input::editor_action::{EditorAction, EditorTool};
use crate::app::input::intent::Intent;
use crate::app::ui::kit::theme::{GRID, SMALL};
use crate::app::ui::match_editor::colours::EditorColours;
use crate::app::ui::match_editor::design_pane::DesignPane;
use crate::app::ui::match_editor::film_pane;
use crate::app::ui::match_editor::handles;
use crate::app::ui::match_editor::toolbar;
use crate::app::ui::match_editor::toolbar::{BAR_HEIGHT, INSTRUCTIONS_HEIGHT};
use crate::app::ui::stage::area::zoom_factor;
use crate::app::ui::ui_state::{Intents, UiState};
use crate::design::Picture;
use crate::geometry::Side;

/// Draws both designs and the film pane, and handles pointer input. Returns the rectangle in which
/// the stage is visible.
pub fn show(root: &mut Ui, state: &UiState, full_rect: Rect, intents: &mut Intents) -> Rect {
    let Some(sides) = &state.sheet.sides else {
        return full_rect;
    };
    let colours = EditorColours::of(state);
    let (stage, column) = columns(state, full_rect);
    let shown = column.map(|column| film_pane::show(root, state, column, &colours, intents));
    let painter = root.painter().with_clip_rect(full_rect);
    painter.rect_filled(stage, CornerRadius::ZERO, colours.ground);
    let design_panes = design_panes(state, stage, sides);
    for pane in &design_panes {
        pane.draw(&painter, state, &colours);
    }
    let between = stage.top() + BAR_HEIGHT + GRID..=stage.bottom() - INSTRUCTIONS_HEIGHT;
    let right = column.map(|column| column.left());
    for x in right.into_iter().chain([stage.center().x]) {
        painter.vline(x, between.clone(), (1.0, colours.faint));
    }
    handles::draw(&painter, state, &design_panes, &colours);
    instructions(&painter, state, full_rect, &colours);
    for pane in &design_panes {
        let id = root.id().with(("half", pane.side.index()));
        let response = root.interact(pane.rect, id, Sense::click_and_drag());
        handle_pointer(root, state, pane, &response, intents);
    }
    // Without a film pane the stage keeps its rectangle behind the designs, so that its picture
    // does not move when the editor is closed.
    shown.unwrap_or(full_rect)
}

/// Returns the rectangle of the designs and, if the film is shown, the rectangle of the film pane.
/// The film pane takes a third of the width, in whole points.
fn columns(state: &UiState, full_rect: Rect) -> (Rect, Option<Rect>) {
    if !state.editor.shows_film() {
        return (full_rect, None);
    }
    let third = (full_rect.width() / 3.0).floor();
    let (designs, film) = full_rect.split_left_right_at_x(full_rect.right() - third);
    (designs, Some(film))
}

/// Draws the toolbar of the match editor above the panes.
pub fn overlay(ctx: &Context, state: &UiState, stage: Rect, intents: &mut Intents) {
    toolbar::show(ctx, state, stage, intents);
}

fn design_panes(state: &UiState, stage: Rect, sides: &[SheetSide; 2]) -> [DesignPane; 2] {
    let (left, right) = stage.split_left_right_at_fraction(0.5);
    let pane = |side: Side, rect: Rect| {
        let room = Rect::from_min_max(
            rect.min + vec2(3.0 * GRID, BAR_HEIGHT + 4.0 * GRID),
            rect.max - vec2(3.0 * GRID, INSTRUCTIONS_HEIGHT + GRID),
        );
        let design = &sides[side];
        let picture = design
            .picture
            .as_ref()
            .filter(|_| state.sheet.shows_pictures());
        let bounds = picture.map_or(design.bounds, Picture::bounds);
        let view = state.editor.panes.view(EditorPane::Design(side));
        DesignPane::new(side, rect, room, bounds, view)
    };
    [pane(Side::Source, left), pane(Side::Target, right)]
}

fn handle_pointer(
    ui: &Ui,
    state: &UiState,
    pane: &DesignPane,
    response: &Response,
    intents: &mut Intents,
) {
    let (shift, moved, origin) = ui.input(|input| {
        let pointer = &input.pointer;
        (
            input.modifiers.shift,
            pointer.delta() != egui::Vec2::ZERO,
            pointer.press_origin(),
        )
    });
    let mut send = |action: EditorAction| intents.push(Intent::Editor(action));
    let primary = PointerButton::Primary;
    if response.drag_started_by(primary)
        && let Some(origin) = origin
    {
        // egui reports a drag only after the pointer has moved by some points, so the position at
        // which the button was pressed is sent.
        send(EditorAction::Press(pane.pointer_target(origin, shift)));
    }
    if let Some(pointer) = response.interact_pointer_pos() {
        let delta = response.drag_delta();
        let delta = Vec2::new(delta.x, delta.y);
        if response.dragged_by(primary) && delta != Vec2::ZERO {
            send(EditorAction::Drag(
                pane.pointer_target(pointer, shift),
                delta,
            ));
        } else if response.dragged() && delta != Vec2::ZERO {
            send(EditorAction::Pan(EditorPane::Design(pane.side), delta));
        }
        if response.clicked_by(primary) {
            send(EditorAction::Click(pane.pointer_target(pointer, shift)));
        }
        if response.clicked_by(PointerButton::Secondary) {
            send(EditorAction::Remove(pane.pointer_target(pointer, shift)));
        }
    }
    if response.drag_stopped_by(primary) {
        send(EditorAction::Release);
    }
    if let Some(pointer) = response.hover_pos() {
        // An intent is sent only if the pointer has moved. An intent in every frame would keep the
        // window redrawing.
        if moved && !response.dragged() {
            send(EditorAction::Hover(Some(
                pane.pointer_target(pointer, shift),
            )));
        }
        zoom(ui, pane, pointer - pane.rect.center(), &mut send);
    } else if has_left(state, pane, response) {
        send(EditorAction::Hover(None));
    }
}

/// Returns whether the pointer has left both design panes while a handle, boundary point or part is
/// still highlighted.
fn has_left(state: &UiState, pane: &DesignPane, response: &Response) -> bool {
    let editor = &state.editor;
    let is_highlighted =
        editor.hovered.is_some() || editor.trace.is_some() || editor.part.is_some();
    // If the pointer is over the other pane, that pane updates the highlight.
    let is_elsewhere = response
        .ctx
        .input(|input| input.pointer.hover_pos())
        .is_none_or(|p| !pane.rect.union(pane.opposite_pane()).contains(p));
    // A handle stays highlighted while the user drags it, wherever the pointer is.
    is_highlighted && is_elsewhere && editor.grabbed.is_none()
}

fn zoom(ui: &Ui, pane: &DesignPane, from_middle: egui::Vec2, send: &mut impl FnMut(EditorAction)) {
    if let Some(factor) = zoom_factor(ui) {
        // `at` is relative to the centre of the rectangle into which the design is fitted, whereas
        // `from_middle` is relative to the centre of the pane.
        let at = from_middle - pane.content_offset();
        send(EditorAction::Zoom {
            pane: EditorPane::Design(pane.side),
            at: Vec2::new(at.x, at.y),
            factor,
        });
    }
}

/// Draws instructions for the current tool at the lower edge, or the reason why the last action was
/// refused.
fn instructions(painter: &Painter, state: &UiState, stage: Rect, colours: &EditorColours) {
    let editor = &state.editor;
    let instruction = match (editor.tool, editor.first_part) {
        (EditorTool::Pins, _) if state.sheet.has_free_pins() => {
            "Click anywhere to add a pin on both sides, drag it into place, right-click to delete \
             it."
        }
        (EditorTool::Lines, _) => {
            "Draw a line along an edge; it appears on both sides. Drag its ends into place, \
             right-click an end to delete it."
        }
        (EditorTool::Pins, _) if state.sheet.pieces.len() > 1 => {
            "Click a boundary to add a pin, drag a point to move it (Shift: no snapping), \
             right-click a pin to delete it. Click inside a part to pair it."
        }
        (EditorTool::Pins, _) => {
            "Click a boundary to add a pin, drag a point to move it (Shift: no snapping), \
             right-click a pin to delete it."
        }
        (EditorTool::Parts, None) => {
            "Click a part, then its partner on the other side. Right-click a part to unpair it."
        }
        (EditorTool::Parts, Some((Side::Source, ..))) => {
            "Now click the matching part in the target, or empty space to make this part disappear."
        }
        (EditorTool::Parts, Some((Side::Target, ..))) => {
            "Now click the matching part in the source, or empty space to make this part appear."
        }
    };
    let refusal = editor.refusal.map(|text| (text, colours.problem));
    let (text, colour) = refusal.unwrap_or((instruction, colours.ink));
    let width = stage.width() - 4.0 * GRID;
    let galley = painter.layout(text.to_owned(), SMALL, colour, width);
    let at = Align2::CENTER_BOTTOM
        .anchor_size(stage.center_bottom() - vec2(0.0, GRID), galley.size())
        .min;
    painter.galley(at, galley, colour);
}
