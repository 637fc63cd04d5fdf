//! Method section of the inspector: the chosen method in words, the button that searches for the
//! best method, and a collapsible table of all methods, with a row per warp and a column per
//! content.
//!
//! Cells of methods that are unavailable are greyed out; their tooltips contain the reason.

use bevy_egui::egui::text::LayoutJob;
use bevy_egui::egui::{
    Align, Align2, Button, CollapsingHeader, Rect, Response, Sense, StrokeKind, Ui, WidgetInfo,
    WidgetType, pos2, vec2,
};

use crate::app::input::intent::Intent;
use crate::app::ui::kit::text::capitalised;
use crate::app::ui::kit::theme::{GRID, RADIUS, SMALL, ThemePalette};
use crate::app::ui::kit::widgets::{hint, section, tooltip_left};
use crate::app::ui::ui_state::{Intents, UiState};
use crate::content::ContentKind;
use crate::project::Project;
use crate::settings::Choice;
use crate::transition::TransitionMethod;
use crate::warp::WarpKind;

/// Width of the labels of the table's rows, in points.
const ROW_LABEL_WIDTH: f32 = 52.0;

/// Height of a cell of the table, in points: enough for two lines of text.
const CELL_HEIGHT: f32 = 40.0;

/// Draws the method section.
pub fn show(ui: &mut Ui, state: &UiState, project: &Project, intents: &mut Intents) {
    section(ui, "Method", |ui| {
        if let (Some(warp), Some(content)) = (project.warp, project.content) {
            ui.label(capitalised(method_name(warp, content)));
            hint(ui, description(warp, content));
            choose(ui, state, content, intents);
        }
        CollapsingHeader::new("Advanced")
            .id_salt("all methods")
            .show_unindented(ui, |ui| table(ui, state, project, intents));
    });
}

/// Draws the table of all methods; a click on a cell chooses its method.
fn table(ui: &mut Ui, state: &UiState, project: &Project, intents: &mut Intents) {
    let width = (ui.available_width() - ROW_LABEL_WIDTH - GRID) / ContentKind::ALL.len() as f32;
    heads(ui, width);
    ui.spacing_mut().item_spacing = vec2(4.0, 4.0);
    for warp in WarpKind::ALL {
        ui.horizontal(|ui| {
            row_head(ui, warp);
            for content in ContentKind::ALL {
                cell(ui, state, project, warp, content, width - 4.0, intents);
            }
        });
    }
}

/// Draws the button that tries several methods and chooses the best one.
fn choose(ui: &mut Ui, state: &UiState, content: ContentKind, intents: &mut Intents) {
    // The search does not apply to pictures, for which only one method is suitable.
    if content == ContentKind::Colours {
        return;
    }
    let is_idle =
        state.method_search.visible_progress().is_none() && state.session.transition().is_some();
    let button = ui.add_enabled(is_idle, Button::new("Choose the best method"));
    let tip = "Tries rigid parts, distance fields carried by them and the plain field blend, and \
               chooses the film with the fewest defects.";
    if button.clicked() {
        intents.push(Intent::ChooseBestMethod);
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

/// Returns the name of a method, as it is written in a sentence.
fn method_name(warp: WarpKind, content: ContentKind) -> &'static str {
    TransitionMethod::new(warp, content).map_or("no method", |cell| cell.labels().name)
}

/// Returns the label of a method's cell in the table.
fn cell_name(warp: WarpKind, content: ContentKind) -> &'static str {
    TransitionMethod::new(warp, content).map_or("–", |cell| cell.labels().button)
}

/// Returns the description of a method, as a sentence.
pub fn description(warp: WarpKind, content: ContentKind) -> &'static str {
    TransitionMethod::new(warp, content).map_or("Nothing moves and nothing blends.", |cell| {
        cell.labels().sentence
    })
}

fn cell(
    ui: &mut Ui,
    state: &UiState,
    project: &Project,
    warp: WarpKind,
    content: ContentKind,
    width: f32,
    intents: &mut Intents,
) {
    let available = state.session.check_method(warp, content);
    let is_chosen = (project.warp, project.content) == (Some(warp), Some(content));
    // An unavailable cell does not react to clicks, but it must still show its tooltip.
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
        intents.push(Intent::SetMethod(warp, content));
    }
    let tip = match available {
        Ok(()) => description(warp, content).to_owned(),
        Err(reason) => format!("Not available: {reason}"),
    };
    tooltip_left(&response, ui.min_rect().left(), &tip);
}

fn paint_cell(
    ui: &Ui,
    rect: Rect,
    name: &str,
    response: &Response,
    is_chosen: bool,
    is_available: bool,
) {
    let palette = ThemePalette::of(ui);
    let (fill, line, text) = match (is_available, is_chosen, response.hovered()) {
        (_, true, _) => (palette.accent_fill, palette.accent, palette.text),
        (false, ..) => (palette.panel, palette.line, palette.disabled_text()),
        (true, false, true) => (palette.hover, palette.line, palette.text),
        (true, false, false) => (palette.raised, palette.raised, palette.text),
    };
    ui.painter()
        .rect(rect, RADIUS, fill, (1.0, line), StrokeKind::Inside);
    // The text is wrapped and centred, because long names such as "Carried by lattice" need two
    // lines.
    let mut job = LayoutJob::simple(name.to_owned(), SMALL, text, rect.width() - GRID);
    job.halign = Align::Center;
    let words = ui.painter().layout_job(job);
    let top = rect.center().y - 0.5 * words.size().y;
    ui.painter().galley(pos2(rect.center().x, top), words, text);
}
