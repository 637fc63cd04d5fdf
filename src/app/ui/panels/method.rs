//! The table of cells: what moves, and what is seen. Cells that cannot be had are grey and say why.

use bevy_egui::egui::{
    Align2, Button, Rect, Response, Sense, StrokeKind, Ui, WidgetInfo, WidgetType, pos2, vec2,
};

use crate::app::input::intent::Intent;
use crate::app::ui::kit::theme::{GRID, RADIUS, SMALL, ThemePalette};
use crate::app::ui::kit::widgets::{hint, section, tooltip_left};
use crate::app::ui::ui_state::{Intents, UiState};
use crate::content::ContentKind;
use crate::project::Project;
use crate::settings::choice::Choice;
use crate::transition::TransitionMethod;
use crate::warp::WarpKind;

const ROW_LABEL_WIDTH: f32 = 52.0;
const CELL_HEIGHT: f32 = 28.0;

/// Draws the table and what the chosen cell does.
pub fn show(ui: &mut Ui, scene: &UiState, project: &Project, acts: &mut Intents) {
    section(ui, "Method", |ui| {
        let width = (ui.available_width() - ROW_LABEL_WIDTH - GRID) / ContentKind::ALL.len() as f32;
        heads(ui, width);
        ui.spacing_mut().item_spacing = vec2(4.0, 4.0);
        for warp in WarpKind::ALL {
            ui.horizontal(|ui| {
                row_head(ui, warp);
                for content in ContentKind::ALL {
                    cell(ui, scene, project, (warp, content), width - 4.0, acts);
                }
            });
        }
        ui.add_space(4.0);
        if let (Some(warp), Some(content)) = (project.warp, project.content) {
            hint(ui, description(warp, content));
            choose(ui, scene, content, acts);
        }
    });
}

/// A way to have the method chosen, where there are several.
fn choose(ui: &mut Ui, scene: &UiState, content: ContentKind, acts: &mut Intents) {
    // Pictures stay pictures: there is one method that suits them.
    if content == ContentKind::Colours {
        return;
    }
    ui.add_space(4.0);
    let is_idle = scene.choosing.told().is_none() && scene.session.transition().is_some();
    let button = ui.add_enabled(is_idle, Button::new("Take the best"));
    let tip = "Tries rigid parts, the fields that they carry and the plain blend, and takes the \
               film with the least trouble.";
    if button.clicked() {
        acts.push(Intent::ChooseMethod);
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

/// What stands on the button of a cell.
pub fn cell_name(warp: WarpKind, content: ContentKind) -> &'static str {
    TransitionMethod::new(warp, content).map_or("–", |cell| cell.words().button)
}

pub fn description(warp: WarpKind, content: ContentKind) -> &'static str {
    TransitionMethod::new(warp, content).map_or("Nothing moves and nothing blends.", |cell| {
        cell.words().sentence
    })
}

fn cell(
    ui: &mut Ui,
    scene: &UiState,
    project: &Project,
    (warp, content): (WarpKind, ContentKind),
    width: f32,
    acts: &mut Intents,
) {
    let available = scene.session.available(warp, content);
    let is_chosen = (project.warp, project.content) == (Some(warp), Some(content));
    // Not a disabled one: it has to tell why it cannot be had.
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
        acts.push(Intent::UseCell(warp, content));
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
