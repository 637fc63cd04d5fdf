//! Method section: a table of methods with one row per warp and one column per content.
//!
//! Unavailable cells are greyed out, and their tooltips say why.

use bevy_egui::egui::{
    Align2, Button, Rect, Response, Sense, StrokeKind, Ui, WidgetInfo, WidgetType, pos2, vec2,
};

use crate::app::input::intent::Intent;
use crate::app::ui::kit::theme::{GRID, RADIUS, SMALL, ThemePalette};
use crate::app::ui::kit::widgets::{hint, section, tooltip_left};
use crate::app::ui::ui_state::{Intents, UiState};
use crate::content::ContentKind;
use crate::project::Project;
use crate::settings::Choice;
use crate::transition::TransitionMethod;
use crate::warp::WarpKind;

/// Width of the row heads, in points.
const ROW_LABEL_WIDTH: f32 = 52.0;

/// Height of a cell, in points.
const CELL_HEIGHT: f32 = 28.0;

/// Draws the table and the description of the chosen cell.
pub fn show(ui: &mut Ui, state: &UiState, project: &Project, intents: &mut Intents) {
    section(ui, "Method", |ui| {
        let width = (ui.available_width() - ROW_LABEL_WIDTH - GRID) / ContentKind::ALL.len() as f32;
        heads(ui, width);
        ui.spacing_mut().item_spacing = vec2(4.0, 4.0);
        for warp in WarpKind::ALL {
            ui.horizontal(|ui| {
                row_head(ui, warp);
                for content in ContentKind::ALL {
                    cell(ui, state, project, (warp, content), width - 4.0, intents);
                }
            });
        }
        ui.add_space(4.0);
        if let (Some(warp), Some(content)) = (project.warp, project.content) {
            hint(ui, description(warp, content));
            choose(ui, state, content, intents);
        }
    });
}

/// Draws the button that chooses the method by trying several.
fn choose(ui: &mut Ui, state: &UiState, content: ContentKind, intents: &mut Intents) {
    // Pictures have only one suitable method.
    if content == ContentKind::Colours {
        return;
    }
    ui.add_space(4.0);
    let is_idle = state.choosing.told().is_none() && state.session.transition().is_some();
    let button = ui.add_enabled(is_idle, Button::new("Choose the best method"));
    let tip = "Tries rigid parts, distance fields carried by them and the plain field blend, and \
               chooses the film with the fewest defects.";
    if button.clicked() {
        intents.push(Intent::ChooseMethod);
    }
    tooltip_left(&button, ui.min_rect().left(), tip);
}

fn heads(ui: &mut Ui, width: f32) {
    let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), 18.0), Sense::hover());
    let weak = ThemePalette::of(ui).weak;
    let mut left = rect.left() + ROW_LABEL_WIDTH + 4.0;
    for content in ContentKind::ALL {
        let at = pos2(left, rect.center().y);
        let title = content.name().title;
        ui.painter()
            .text(at, Align2::LEFT_CENTER, title, SMALL, weak);
        left += width;
    }
}

fn row_head(ui: &mut Ui, warp: WarpKind) {
    let (rect, response) =
        ui.allocate_exact_size(vec2(ROW_LABEL_WIDTH, CELL_HEIGHT), Sense::hover());
    let name = warp.name();
    let weak = ThemePalette::of(ui).weak;
    let at = rect.left_center();
    ui.painter()
        .text(at, Align2::LEFT_CENTER, name.title, SMALL, weak);
    response.on_hover_text(name.sentence);
}

/// Returns the label of a cell.
pub fn cell_name(warp: WarpKind, content: ContentKind) -> &'static str {
    TransitionMethod::new(warp, content).map_or("–", |cell| cell.words().button)
}

/// Returns the description of a cell.
pub fn description(warp: WarpKind, content: ContentKind) -> &'static str {
    TransitionMethod::new(warp, content).map_or("Nothing moves and nothing blends.", |cell| {
        cell.words().sentence
    })
}

fn cell(
    ui: &mut Ui,
    state: &UiState,
    project: &Project,
    (warp, content): (WarpKind, ContentKind),
    width: f32,
    intents: &mut Intents,
) {
    let available = state.session.available(warp, content);
    let is_chosen = (project.warp, project.content) == (Some(warp), Some(content));
    // Not disabled: an unavailable cell must still show its tooltip.
    let sense = if available.is_ok() {
        Sense::click()
    } else {
        Sense::hover()
    };
    let (rect, response) = ui.allocate_exact_size(vec2(width, CELL_HEIGHT), sense);
    let name = cell_name(warp, content);
    response.widget_info(|| {
        WidgetInfo::selected(WidgetType::RadioButton, available.is_ok(), is_chosen, name)
    });
    paint_cell(ui, rect, name, &response, is_chosen, available.is_ok());
    if response.clicked() && !is_chosen {
        intents.push(Intent::UseCell(warp, content));
    }
    let tip = match available {
        Ok(()) => description(warp, content).to_owned(),
        Err(reason) => format!("Not available: {reason}"),
    };
    tooltip_left(&response, ui.min_rect().left(), &tip);
}

fn paint_cell(ui: &Ui, rect: Rect, name: &str, response: &Response, chosen: bool, can: bool) {
    let palette = ThemePalette::of(ui);
    let (fill, line, text) = match (can, chosen, response.hovered()) {
        (_, true, _) => (palette.accent_ground, palette.accent, palette.text),
        (false, ..) => (palette.panel, palette.line, palette.faint()),
        (true, false, true) => (palette.hover, palette.line, palette.text),
        (true, false, false) => (palette.raised, palette.raised, palette.text),
    };
    ui.painter()
        .rect(rect, RADIUS, fill, (1.0, line), StrokeKind::Inside);
    ui.painter()
        .text(rect.center(), Align2::CENTER_CENTER, name, SMALL, text);
}
