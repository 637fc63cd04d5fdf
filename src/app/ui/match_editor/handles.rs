//! Draws the handles of the match editor (pins, automatically matched points, cuts and lines), a
//! dashed line between the two positions of a handle in source and target, and the message about a
//! failed match.

use bevy_egui::egui::{Align2, Color32, FontId, Painter, Pos2, Rect, Shape, StrokeKind, vec2};

use crate::app::editing::editor::{CutEnd, EditorGrab, EditorHandle, MatchEditor};
use crate::app::editing::labels;
use crate::app::editing::sheet::MatchSheet;
use crate::app::ui::kit::text::capitalised;
use crate::app::ui::kit::theme::{GRID, SMALL};
use crate::app::ui::kit::widgets::text_card;
use crate::app::ui::match_editor::colours::EditorColours;
use crate::app::ui::match_editor::design_pane::DesignPane;
use crate::app::ui::match_editor::toolbar::{BAR_HEIGHT, INSTRUCTIONS_HEIGHT};
use crate::app::ui::ui_state::UiState;
use crate::geometry::{DVec2, Side};

/// Radius of a pin, in points.
const PIN_RADIUS: f32 = 8.5;

/// Radius of an automatically matched point, in points.
const FEATURE_RADIUS: f32 = 7.0;

/// Draws all handles in both panes, and the dashed line between the two positions of the handle
/// under the pointer.
pub fn draw(painter: &Painter, state: &UiState, panes: &[DesignPane; 2], colours: &EditorColours) {
    let (sheet, editor) = (&state.sheet, &state.editor);
    for pane in panes {
        let clipped = pane.clip(painter);
        features(&clipped, sheet, editor, pane, colours);
        cuts(&clipped, sheet, editor, pane, colours);
        if sheet.has_free_pins() {
            lines(&clipped, sheet, editor, pane, colours);
        }
    }
    // The dashed line crosses both panes, so it is not clipped. Pins are drawn above it, because
    // the user grabs them.
    link(painter, sheet, editor, panes, colours);
    for pane in panes {
        let clipped = pane.clip(painter);
        pins(&clipped, state, pane, colours);
    }
    if let Some(problem) = state.session.problem() {
        problem_card(painter, state, panes, &problem.to_string(), colours);
    }
}

fn features(
    painter: &Painter,
    sheet: &MatchSheet,
    editor: &MatchEditor,
    pane: &DesignPane,
    colours: &EditorColours,
) {
    for (k, pair) in sheet.features.iter().enumerate() {
        let handle = EditorHandle::Feature(k);
        let colour = if editor.is_highlighted(handle) {
            colours.ink
        } else {
            colours.ground.lerp_to_gamma(colours.ink, 0.65)
        };
        let at = pane.px(pair[pane.side]);
        painter.circle(at, FEATURE_RADIUS, colours.ground, (1.0, colour));
        let letter = sheet.letters.get(k).copied().unwrap_or(k);
        disc_label(painter, at, labels::point_label(letter), colour);
    }
}

fn pins(painter: &Painter, state: &UiState, pane: &DesignPane, colours: &EditorColours) {
    let (sheet, editor) = (&state.sheet, &state.editor);
    for (k, pin) in sheet.pins.iter().enumerate() {
        let handle = EditorHandle::Pin(k);
        let is_selected = editor.selected == Some(handle);
        let is_grabbed =
            matches!(editor.grabbed, Some((_, EditorGrab::Pin(grabbed))) if grabbed == k);
        let radius = if is_grabbed || editor.hovered == Some(handle) {
            PIN_RADIUS + 1.5
        } else {
            PIN_RADIUS
        };
        let at = pane.px(pin[pane.side]);
        let is_faulty = sheet.faulty_pins.contains(&k);
        let fill = match (is_faulty, is_selected) {
            (true, _) => colours.problem,
            (false, true) => colours.accent,
            (false, false) => colours.ink,
        };
        painter.circle(at, radius, fill, (1.5, colours.ground));
        disc_label(painter, at, (k + 1).to_string(), colours.ground);
    }
}

/// Draws each matched line with its number at the middle. A filled disc marks the first end of a
/// line, a circle the second end.
fn lines(
    painter: &Painter,
    sheet: &MatchSheet,
    editor: &MatchEditor,
    pane: &DesignPane,
    colours: &EditorColours,
) {
    for (k, line) in sheet.lines.iter().enumerate() {
        let ends = line[pane.side].map(|p| pane.px(p));
        let is_selected = matches!(editor.selected, Some(EditorHandle::Line(of, _)) if of == k);
        let colour = if is_selected {
            colours.accent
        } else {
            colours.ink
        };
        // A wider line in the background colour makes the line visible on any fill.
        painter.line_segment(ends, (5.0, colours.ground));
        painter.line_segment(ends, (2.0, colour));
        for (end, at) in ends.into_iter().enumerate() {
            let is_lit = editor.hovered == Some(EditorHandle::Line(k, end));
            let radius = if is_lit { 6.0 } else { 4.5 };
            let fill = if end == 0 { colour } else { colours.ground };
            painter.circle(at, radius, fill, (2.0, colour));
        }
        let middle = ends[0].lerp(ends[1], 0.5);
        painter.circle(middle, FEATURE_RADIUS, colours.ground, (1.5, colour));
        disc_label(painter, middle, (k + 1).to_string(), colours.ink);
    }
}

fn disc_label(painter: &Painter, at: Pos2, text: String, colour: Color32) {
    // A smaller font lets three digits fit into the disc.
    let size = if text.len() < 3 { 10.5 } else { 8.5 };
    let font = FontId::proportional(size);
    painter.text(at, Align2::CENTER_CENTER, text, font, colour);
}

fn cuts(
    painter: &Painter,
    sheet: &MatchSheet,
    editor: &MatchEditor,
    pane: &DesignPane,
    colours: &EditorColours,
) {
    for (k, shown) in sheet.cuts.iter().enumerate() {
        let cut = sheet.cut_to_draw(shown, editor.grabbed.map(|(_, grab)| grab));
        if cut.side != pane.side {
            continue;
        }
        let ends = [pane.px(cut.outer), pane.px(cut.hole)];
        painter.line_segment(ends, (4.0, colours.ground));
        let stroke = (2.0, colours.accent);
        painter.extend(Shape::dashed_line(&ends, stroke, 6.0, 3.0));
        for (at, end) in ends.into_iter().zip([CutEnd::Outer, CutEnd::Hole]) {
            let is_lit = editor.is_highlighted(EditorHandle::Cut(k, end));
            let size = if is_lit { 13.0 } else { 10.0 };
            let fill = if shown.requested_index.is_some() {
                colours.accent
            } else {
                colours.ground
            };
            let square = Rect::from_center_size(at, vec2(size, size));
            let line = (2.0, colours.accent);
            painter.rect(square, 2, fill, line, StrokeKind::Inside);
        }
    }
}

/// Draws a dashed line between the positions, in source and target, of the handle that the user
/// drags or, without a drag, of the handle or boundary point under the pointer.
fn link(
    painter: &Painter,
    sheet: &MatchSheet,
    editor: &MatchEditor,
    panes: &[DesignPane; 2],
    colours: &EditorColours,
) {
    let highlighted = match editor.grabbed {
        Some((_, EditorGrab::Pin(k))) => Some(EditorHandle::Pin(k)),
        Some((_, EditorGrab::Feature(k))) => Some(EditorHandle::Feature(k)),
        Some((_, EditorGrab::Line(k, end))) => Some(EditorHandle::Line(k, end)),
        Some((_, EditorGrab::NewLineEnd(k))) => Some(EditorHandle::Line(k, 1)),
        _ => editor.hovered,
    };
    let of_handle = |handle: EditorHandle| -> Option<[DVec2; 2]> {
        let [source, target] = Side::BOTH.map(|side| sheet.handle_position(handle, side));
        Some([source?, target?])
    };
    let ends = highlighted.and_then(of_handle);
    let is_trace = ends.is_none();
    let Some(ends) = ends.or(editor.trace) else {
        return;
    };
    let [a, b] = [panes[0].px(ends[0]), panes[1].px(ends[1])];
    let stroke = (1.25, colours.ground.lerp_to_gamma(colours.ink, 0.7));
    painter.extend(Shape::dashed_line(&[a, b], stroke, 5.0, 4.0));
    if is_trace {
        for at in [a, b] {
            painter.circle(at, 5.0, colours.ground, (2.0, colours.ink));
        }
    }
}

/// Draws a card that explains why the match failed. The card is next to the pin that caused the
/// failure, else next to the selected handle, else in a corner.
fn problem_card(
    painter: &Painter,
    state: &UiState,
    panes: &[DesignPane; 2],
    problem: &str,
    colours: &EditorColours,
) {
    /// Maximum width of the card's text, in points.
    const WIDTH: f32 = 240.0;
    let editor = &state.editor;
    // The card is drawn in the pane that the user edits, because the edit caused the problem.
    let side = editor.grabbed.map_or(Side::Source, |(side, _)| side);
    let pane = &panes[side];
    let faulty = state
        .sheet
        .faulty_pins
        .last()
        .map(|k| EditorHandle::Pin(*k));
    let selected_faulty = editor.selected.filter(
        |handle| matches!(handle, EditorHandle::Pin(k) if state.sheet.faulty_pins.contains(k)),
    );
    let at = selected_faulty
        .or(faulty)
        .or(editor.selected)
        .and_then(|handle| state.sheet.handle_position(handle, side))
        .map(|p| pane.px(p) + vec2(2.0 * GRID, GRID));
    let unchanged = if state.session.transition().is_some() {
        " The transition is unchanged."
    } else {
        ""
    };
    let text = format!("{}.{unchanged}", capitalised(problem));
    let width = WIDTH.min(pane.rect.width() - 4.0 * GRID);
    let galley = painter.layout(text, SMALL, colours.ink, width);
    let size = galley.size() + vec2(2.0 * GRID, 1.5 * GRID);
    let area = pane.rect.shrink(GRID);
    let area = Rect::from_min_max(
        area.min + vec2(0.0, BAR_HEIGHT + GRID),
        area.max - vec2(0.0, INSTRUCTIONS_HEIGHT),
    );
    // Without a faulty pin or a selected handle, the card is shown in the lower left corner.
    let corner = at.unwrap_or_else(|| area.left_bottom() - vec2(0.0, size.y));
    // If the card were larger than the area, `clamp` would panic on an inverted range.
    let max_corner = (area.max - size).max(area.min);
    let corner = corner.clamp(area.min, max_corner);
    let card = Rect::from_min_size(corner, size);
    text_card(
        painter,
        card,
        galley,
        colours.ground,
        (1.5, colours.problem),
    );
}
