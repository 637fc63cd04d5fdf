//! Dialog that lists the keyboard shortcuts of the key map in use.

use bevy_egui::egui::{self, Align2, Context, Id, Modal, Rect, ScrollArea, Ui, vec2};

use crate::app::input::intent::Intent;
use crate::app::input::key_map::KeyTableRow;
use crate::app::ui::kit::theme::{GRID, SMALL, ThemePalette};
use crate::app::ui::kit::widgets::{from_right, hint, secondary_text, text_card};
use crate::app::ui::ui_state::{Intents, UiState};

/// Width of the space for the keys of a shortcut, in points.
const KEYS_WIDTH: f32 = 136.0;

/// Width of each of the two columns of the list, in points.
const COLUMN_WIDTH: f32 = 440.0;

/// Height of a shortcut's row, in points.
const ROW_HEIGHT: f32 = 20.0;

/// Height of the dialog without the list, in points: heading, hint and margins.
const HEIGHT_WITHOUT_LIST: f32 = 96.0;

/// Draws the dialog with the keyboard shortcuts, above everything else; returns its rectangle.
pub fn show(ctx: &Context, state: &UiState, intents: &mut Intents) -> Rect {
    let response = Modal::new(Id::new("help")).show(ctx, |ui| {
        ui.set_width(2.0 * COLUMN_WIDTH + 2.0 * GRID);
        ui.horizontal(|ui| {
            ui.heading("Keyboard shortcuts");
            from_right(ui, |ui| {
                if ui.button("Close").clicked() {
                    intents.push(Intent::ToggleHelp);
                }
            });
        });
        ui.add_space(GRID);
        // In a small window the list scrolls.
        let height = (ctx.content_rect().height() - HEIGHT_WITHOUT_LIST).max(ROW_HEIGHT);
        ScrollArea::vertical()
            .max_height(height)
            .show(ui, |ui| list(ui, state.keys.rows()));
        let files = match state.drop_support.0 {
            true => "Drop files anywhere to open them.",
            false => "Open files with Ctrl O: Wayland delivers no dropped files.",
        };
        let view = "Drag the stage to pan, scroll to zoom, double-click to fit to view.";
        hint(ui, &format!("{view} {files}"));
    });
    if response.backdrop_response.clicked() {
        intents.push(Intent::ToggleHelp);
    }
    response.response.rect
}

/// Draws all shortcuts in two columns; a single one would be taller than most windows.
fn list(ui: &mut Ui, rows: &[KeyTableRow]) {
    let groups = groups(rows);
    let (left, right) = groups.split_at(column_split(&groups));
    ui.horizontal_top(|ui| {
        for column in [left, right] {
            ui.vertical(|ui| {
                ui.set_width(COLUMN_WIDTH);
                for rows in column {
                    group(ui, rows);
                }
            });
        }
    });
}

fn groups(rows: &[KeyTableRow]) -> Vec<&[KeyTableRow]> {
    rows.chunk_by(|a, b| a.group == b.group).collect()
}

/// Returns the number of groups that go into the first of two columns, so that the taller column is
/// as short as possible.
fn column_split(groups: &[&[KeyTableRow]]) -> usize {
    // The heading of a group and the gap below the group are together as tall as two rows.
    let height =
        |groups: &[&[KeyTableRow]]| groups.iter().map(|rows| rows.len() + 2).sum::<usize>();
    let taller = |&k: &usize| height(&groups[..k]).max(height(&groups[k..]));
    (0..=groups.len()).min_by_key(taller).unwrap_or(0)
}

fn group(ui: &mut Ui, rows: &[KeyTableRow]) {
    ui.spacing_mut().item_spacing.y = 2.0;
    ui.spacing_mut().interact_size.y = ROW_HEIGHT;
    let name = rows.first().map_or("", |row| row.group);
    ui.label(secondary_text(ui, name).strong());
    for row in rows {
        ui.horizontal(|ui| {
            let size = vec2(KEYS_WIDTH, ROW_HEIGHT);
            let (rect, _) = ui.allocate_exact_size(size, egui::Sense::hover());
            key_cap(ui, rect, &row.keys());
            ui.label(row.help);
        });
    }
    ui.add_space(GRID);
}

fn key_cap(ui: &Ui, rect: egui::Rect, keys: &str) {
    let palette = ThemePalette::of(ui);
    let painter = ui.painter();
    let text = painter.layout_no_wrap(keys.to_owned(), SMALL, palette.text);
    let cap = Align2::LEFT_CENTER.anchor_size(rect.left_center(), text.size() + vec2(12.0, 2.0));
    text_card(painter, cap, text, palette.raised, (1.0, palette.line));
}
