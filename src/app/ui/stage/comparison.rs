//! Comparison of two methods at the same t: the stage on the left, a second method on the right,
//! and a strip with their names.

use bevy_egui::egui::{Align2, ComboBox, FontId, Label, Panel, Rect, RichText, Ui, vec2};

use crate::app::input::intent::Intent;
use crate::app::input::preferences::ComparisonMethod;
use crate::app::ui::kit::text::capitalised;
use crate::app::ui::kit::theme::{CONTROL_HEIGHT, GRID, ThemePalette};
use crate::app::ui::kit::widgets::{panel_frame, secondary_text};
use crate::app::ui::panels::method;
use crate::app::ui::stage::area::{self, ink_on};
use crate::app::ui::stage::checks;
use crate::app::ui::ui_state::{Intents, UiState};

/// Width of the space for the name of a method, in points.
const NAME_WIDTH: f32 = 168.0;

/// Handles the pointer in both halves and draws their overlays. Returns the left half, which is the
/// rectangle of the stage.
pub fn show(root: &mut Ui, state: &UiState, stage: Rect, intents: &mut Intents) -> Rect {
    // The width is in whole points, so that both halves begin on a pixel boundary.
    let half = vec2((stage.width() / 2.0).floor(), stage.height());
    let left = Rect::from_min_size(stage.min, half);
    let right = left.translate(vec2(half.x, 0.0));
    area::show(root, left, "stage", intents);
    area::show(root, right, "comparison", intents);
    if state.preferences.panels {
        overlays(root, state, [left, right]);
    }
    left
}

/// Draws the overlays of both halves. On the left (the stage): a hint if the stage is empty, and
/// marks at the findings of the automatic check. On the right: if this half is empty, the reason.
/// Also draws the line between the halves.
fn overlays(root: &mut Ui, state: &UiState, [left, right]: [Rect; 2]) {
    area::empty_hint(root, state, left);
    checks::mark(root, state, left);
    let ink = ink_on(state.session.style().ground);
    let line = (1.0, ink.gamma_multiply(0.5));
    root.painter().vline(right.left(), right.y_range(), line);
    comparison_status(root, state, right);
}

/// Draws a strip above the stage with the name of the project's method and the choice of the second
/// method.
pub fn strip(root: &mut Ui, state: &UiState, intents: &mut Intents) {
    let frame = panel_frame(root, [8, 8, 4, 4]);
    Panel::top("methods")
        .exact_size(CONTROL_HEIGHT + GRID)
        .resizable(false)
        .frame(frame)
        .show(root, |ui| {
            ui.columns(2, |halves| {
                halves[0].vertical_centered(|ui| first_name(ui, state));
                halves[1].vertical_centered(|ui| second_name(ui, state, intents));
            });
        });
}

/// Draws in the right half (`rect`) why it is empty: the second transition is being built or could
/// not be built. Draws nothing if the right half shows a transition.
fn comparison_status(ui: &Ui, state: &UiState, rect: Rect) {
    let comparison = &state.comparison;
    let text = match (comparison.transition(), comparison.problem()) {
        (Some(_), _) => return,
        (None, Some(problem)) => problem.to_string(),
        (None, None) if comparison.is_busy() => "Building …".to_owned(),
        // The build of the second transition has not started yet; the next frame shows its state.
        (None, None) => return,
    };
    let ink = ink_on(state.session.style().ground);
    let width = rect.width() - 4.0 * GRID;
    let font = FontId::proportional(14.0);
    let galley = ui.painter().layout(text, font, ink, width);
    let at = Align2::CENTER_CENTER.anchor_size(rect.center(), galley.size());
    ui.painter().galley(at.min, galley, ink);
}

fn first_name(ui: &mut Ui, state: &UiState) {
    let Some(transition) = state.session.transition() else {
        return;
    };
    let name = Label::new(secondary_text(ui, capitalised(transition.method().name())));
    ui.add_sized([NAME_WIDTH, CONTROL_HEIGHT], name)
        .on_hover_text("Method of the project, chosen in the panel on the right");
}

fn second_name(ui: &mut Ui, state: &UiState, intents: &mut Intents) {
    let Some(project) = state.session.project() else {
        return;
    };
    let chosen = state.comparison.method_for(project);
    ComboBox::from_id_salt("second method")
        .width(NAME_WIDTH)
        .selected_text(capitalised(chosen.name()))
        .height(400.0)
        .show_ui(ui, |ui| {
            for method in ComparisonMethod::all() {
                let cell = method.method();
                let available = state.session.check_method(cell.warp(), cell.content());
                let mut name = RichText::new(capitalised(method.name()));
                if available.is_err() {
                    name = name.color(ThemePalette::of(ui).disabled_text());
                }
                ui.add_enabled_ui(available.is_ok(), |ui| {
                    let response = ui.selectable_label(chosen == method, name);
                    if let Err(reason) = &available {
                        response.on_disabled_hover_text(format!("Not available: {reason}"));
                    } else if response.on_hover_text(tip(method)).clicked() {
                        intents.push(Intent::SetComparisonMethod(method));
                    }
                });
            }
        })
        .response
        .on_hover_text("Method to compare with the project's method");
}

fn tip(method: ComparisonMethod) -> &'static str {
    match method {
        ComparisonMethod::Straight => {
            "Each point moves straight to its target. Rotating parts shrink on the way."
        }
        ComparisonMethod::Method(cell) => method::description(cell.warp(), cell.content()),
    }
}
