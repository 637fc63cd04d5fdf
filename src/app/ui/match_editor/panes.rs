//! Both halves, the line of advice below them, and the hand on them.

use bevy::prelude::Vec2;
use bevy_egui::egui::{
    self, Align2, Context, CornerRadius, Painter, PointerButton, Rect, Response, Sense, Ui, vec2,
};

use crate::app::editing::panes::EditorPane;
use crate::app::editing::sheet::SheetSide;
use crate::app::input::editor_action::{EditorAction, EditorTool};
use crate::app::input::intent::Intent;
use crate::app::ui::kit::theme::{GRID, SMALL};
use crate::app::ui::match_editor::colours::EditorColours;
use crate::app::ui::match_editor::design_pane::DesignPane;
use crate::app::ui::match_editor::film_pane;
use crate::app::ui::match_editor::handles;
use crate::app::ui::match_editor::toolbar;
use crate::app::ui::match_editor::toolbar::{ADVICE_HEIGHT, BAR_HEIGHT};
use crate::app::ui::stage::area::zoom_factor;
use crate::app::ui::ui_state::{Intents, UiState};
use crate::design::Picture;
use crate::geometry::Side;

/// Draws both halves and the film beside them, and takes the user's hand. Returns the part that
/// the stage takes.
pub fn show(root: &mut Ui, scene: &UiState, whole: Rect, acts: &mut Intents) -> Rect {
    let Some(sides) = &scene.sheet.sides else {
        return whole;
    };
    let inks = EditorColours::of(scene);
    let (stage, column) = columns(scene, whole);
    let shown = column.map(|column| film_pane::show(root, scene, column, &inks, acts));
    let painter = root.painter().with_clip_rect(whole);
    painter.rect_filled(stage, CornerRadius::ZERO, inks.ground);
    let halves = halves(scene, stage, sides);
    for half in &halves {
        half.draw(&painter, scene, &inks);
    }
    let between = stage.top() + BAR_HEIGHT + GRID..=stage.bottom() - ADVICE_HEIGHT;
    let right = column.map(|column| column.left());
    for x in right.into_iter().chain([stage.center().x]) {
        painter.vline(x, between.clone(), (1.0, inks.faint));
    }
    handles::draw(&painter, scene, &halves, &inks);
    advice(&painter, scene, whole, &inks);
    for half in &halves {
        let id = root.id().with(("half", half.side.index()));
        let response = root.interact(half.rect, id, Sense::click_and_drag());
        hand(root, scene, half, &response, acts);
    }
    // Behind the designs where it has no column: whoever leaves the editor finds it in its place.
    shown.unwrap_or(whole)
}

/// What the designs take, and the film beside them: a third of whole points each.
fn columns(scene: &UiState, whole: Rect) -> (Rect, Option<Rect>) {
    if !scene.editor.shows_film() {
        return (whole, None);
    }
    let third = (whole.width() / 3.0).floor();
    let (designs, film) = whole.split_left_right_at_x(whole.right() - third);
    (designs, Some(film))
}

/// Draws what lies above both halves.
pub fn overlay(ctx: &Context, scene: &UiState, stage: Rect, acts: &mut Intents) {
    toolbar::show(ctx, scene, stage, acts);
}

fn halves(scene: &UiState, stage: Rect, sides: &[SheetSide; 2]) -> [DesignPane; 2] {
    let (left, right) = stage.split_left_right_at_fraction(0.5);
    let half = |side: Side, rect: Rect| {
        let room = Rect::from_min_max(
            rect.min + vec2(3.0 * GRID, BAR_HEIGHT + 4.0 * GRID),
            rect.max - vec2(3.0 * GRID, ADVICE_HEIGHT + GRID),
        );
        let design = &sides[side];
        let picture = design.picture.as_ref().filter(|_| scene.sheet.in_colours());
        let bounds = picture.map_or(design.bounds, Picture::bounds);
        let view = scene.editor.panes.view(EditorPane::Design(side));
        DesignPane::new(side, rect, room, bounds, view)
    };
    [half(Side::Source, left), half(Side::Target, right)]
}

fn hand(ui: &Ui, scene: &UiState, half: &DesignPane, response: &Response, acts: &mut Intents) {
    let (shift, moved, origin) = ui.input(|input| {
        let pointer = &input.pointer;
        (
            input.modifiers.shift,
            pointer.delta() != egui::Vec2::ZERO,
            pointer.press_origin(),
        )
    });
    let mut act = |act: EditorAction| acts.push(Intent::Editor(act));
    let primary = PointerButton::Primary;
    if response.drag_started_by(primary)
        && let Some(origin) = origin
    {
        // Where it went down: a drag is told of only when the hand has moved some points.
        act(EditorAction::Press(half.touch(origin, shift)));
    }
    if let Some(pointer) = response.interact_pointer_pos() {
        let delta = response.drag_delta();
        let delta = Vec2::new(delta.x, delta.y);
        if response.dragged_by(primary) && delta != Vec2::ZERO {
            act(EditorAction::Drag(half.touch(pointer, shift), delta));
        } else if response.dragged() && delta != Vec2::ZERO {
            act(EditorAction::Pan(EditorPane::Design(half.side), delta));
        }
        if response.clicked_by(primary) {
            act(EditorAction::Click(half.touch(pointer, shift)));
        }
        if response.clicked_by(PointerButton::Secondary) {
            act(EditorAction::Remove(half.touch(pointer, shift)));
        }
    }
    if response.drag_stopped_by(primary) {
        act(EditorAction::Release);
    }
    if let Some(pointer) = response.hover_pos() {
        // Only when it moves: an intent in each frame would keep the window from resting.
        if moved && !response.dragged() {
            act(EditorAction::Hover(Some(half.touch(pointer, shift))));
        }
        zoom(ui, half, pointer - half.rect.center(), &mut act);
    } else if is_left(scene, half, response) {
        act(EditorAction::Hover(None));
    }
}

/// The pointer has left this half, and what was under it there is still marked.
fn is_left(scene: &UiState, half: &DesignPane, response: &Response) -> bool {
    let editor = &scene.editor;
    let is_marked = editor.hovered.is_some() || editor.trace.is_some() || editor.part.is_some();
    // The other half says itself what is under the pointer there.
    let is_elsewhere = response
        .ctx
        .input(|input| input.pointer.hover_pos())
        .is_none_or(|p| !half.rect.union(half.across()).contains(p));
    // What is held stays marked wherever the hand goes.
    is_marked && is_elsewhere && editor.grabbed.is_none()
}

fn zoom(ui: &Ui, half: &DesignPane, from_middle: egui::Vec2, act: &mut impl FnMut(EditorAction)) {
    if let Some(factor) = zoom_factor(ui) {
        // The view is enlarged about the middle of the room, which the bar above moves down.
        let at = from_middle - half.room_offset();
        act(EditorAction::Zoom {
            pane: EditorPane::Design(half.side),
            at: Vec2::new(at.x, at.y),
            factor,
        });
    }
}

/// One line on what can be done now.
fn advice(painter: &Painter, scene: &UiState, stage: Rect, inks: &EditorColours) {
    let editor = &scene.editor;
    let usual = match (editor.tool, editor.first_part) {
        (EditorTool::Pins, _) if scene.sheet.is_free() => {
            "Click anywhere to set a pin on both sides, drag it to where it belongs, right-click \
             to delete it."
        }
        (EditorTool::Lines, _) => {
            "Draw a line along an edge; it appears on both sides. Drag its ends to where they \
             belong, right-click an end to delete it."
        }
        (EditorTool::Pins, _) if scene.sheet.pieces.len() > 1 => {
            "Click a boundary to pin it, drag a point to move it (Shift: no snapping), \
             right-click a pin to delete it. Click inside a part to pair it."
        }
        (EditorTool::Pins, _) => {
            "Click a boundary to pin it, drag a point to move it (Shift: no snapping), \
             right-click a pin to delete it."
        }
        (EditorTool::Parts, None) => {
            "Click a part on one side, then its partner on the other. Right-click frees a part."
        }
        (EditorTool::Parts, Some((Side::Source, ..))) => {
            "Now click its partner in the target, or beside all parts there: it vanishes."
        }
        (EditorTool::Parts, Some((Side::Target, ..))) => {
            "Now click its partner in the source, or beside all parts there: it appears."
        }
    };
    let refusal = editor.refusal.map(|words| (words, inks.problem));
    let (words, colour) = refusal.unwrap_or((usual, inks.ink));
    let width = stage.width() - 4.0 * GRID;
    let galley = painter.layout(words.to_owned(), SMALL, colour, width);
    let at = Align2::CENTER_BOTTOM
        .anchor_size(stage.center_bottom() - vec2(0.0, GRID), galley.size())
        .min;
    painter.galley(at, galley, colour);
}
