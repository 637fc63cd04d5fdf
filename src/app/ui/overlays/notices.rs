//! Notices at the lower edge of the stage, as cards with buttons to close them and to act on them.
//! While a dialog is open they lie between the dialog and an edge of the window, so that they cover
//! no part of it.

use std::path::Path;

use bevy_egui::egui::{self, Align2, Context, Label, Order, Rect, ScrollArea, Ui, vec2};

use crate::app::input::intent::Intent;
use crate::app::notices::{Notice, NoticeKind, NoticeTopic};
use crate::app::session::transition_problem::TransitionProblem;
use crate::app::ui::kit::icons;
use crate::app::ui::kit::theme::{GRID, ThemePalette};
use crate::app::ui::kit::widgets::{card, fixed_layer, icon_button};
use crate::app::ui::ui_state::{Intents, UiState};

/// Maximum number of notices that are shown at once; older notices reappear when newer ones are
/// closed (resource limit: room on the stage).
const MAX_SHOWN: usize = 4;

/// Gap between the notices and the edges of the space around them, in points.
const MARGIN: f32 = 2.0 * GRID;

/// Height of a notice with one line of text, in points.
const MIN_HEIGHT: f32 = 40.0;

/// Space for the notices.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NoticePlace {
    /// The rectangle that the notices may cover.
    room: Rect,
    /// Layer of the notices.
    order: Order,
}

impl NoticePlace {
    /// The lower edge of the stage. Notices may be errors, so they lie above the cards that show
    /// the progress of jobs.
    pub const fn on_stage(stage: Rect) -> Self {
        Self {
            room: stage,
            order: Order::Foreground,
        }
    }

    /// The space below the dialog or, if it is larger, above it. The notices lie above the shade
    /// around the dialog, so that they can be read and closed.
    pub fn next_to_dialog(dialog: Rect, window: Rect) -> Self {
        let [mut above, mut below] = [window; 2];
        above.max.y = dialog.top().max(window.top());
        below.min.y = dialog.bottom().min(window.bottom());
        let room = match below.height() >= above.height() {
            true => below,
            false => above,
        };
        Self {
            room,
            order: Order::Tooltip,
        }
    }

    /// Maximum height of the list of notices, in points; `None` if there is no room for one.
    fn max_height(&self) -> Option<f32> {
        let height = self.room.height() - 2.0 * MARGIN;
        (height >= MIN_HEIGHT).then_some(height)
    }
}

/// Draws the newest notices at the lower edge of `place`. Notices for which there is no room are
/// reached by scrolling; if there is no room at all, they wait until the dialog is closed.
pub fn show(ctx: &Context, state: &UiState, place: &NoticePlace, intents: &mut Intents) {
    let list = state.notices.list();
    let Some(max_height) = place.max_height().filter(|_| !list.is_empty()) else {
        return;
    };
    let width = (place.room.width() - 4.0 * GRID).clamp(160.0, 480.0);
    let at = place.room.center_bottom() - vec2(0.0, MARGIN);
    let area = fixed_layer("notices", Align2::CENTER_BOTTOM, at).order(place.order);
    area.show(ctx, |ui| {
        let scroll = ScrollArea::vertical().max_height(max_height);
        scroll.stick_to_bottom(true).show(ui, |ui| {
            for notice in &list[list.len().saturating_sub(MAX_SHOWN)..] {
                let exceeds_limits = exceeds_limits(state, notice);
                message(ui, notice, exceeds_limits, width, intents);
            }
        });
    });
}

/// Returns whether the notice reports that a transition was not built because the build would take
/// too long or too much memory.
fn exceeds_limits(state: &UiState, notice: &Notice) -> bool {
    let problem = state.session.problem();
    notice.kind == NoticeKind::Problem(NoticeTopic::Transition)
        && problem.is_some_and(TransitionProblem::exceeds_limits)
}

fn message(ui: &mut Ui, notice: &Notice, exceeds_limits: bool, width: f32, intents: &mut Intents) {
    let palette = ThemePalette::of(ui);
    let (icon, colour) = match notice.kind {
        NoticeKind::Problem(_) => (icons::WARNING, palette.problem),
        NoticeKind::Confirmation | NoticeKind::FileWritten => (icons::TICK, palette.accent),
        NoticeKind::Note => (icons::WARNING, palette.amber),
    };
    card(ui, egui::Margin::symmetric(12, 8), |ui| {
        ui.set_width(width);
        ui.horizontal_top(|ui| {
            let (rect, _) = ui.allocate_exact_size(vec2(24.0, 24.0), egui::Sense::hover());
            icons::paint_icon(ui.painter(), icon, rect, colour);
            let text_width = width - 24.0 - 24.0 - 2.0 * GRID;
            ui.allocate_ui(vec2(text_width, 0.0), |ui| {
                ui.set_width(text_width);
                ui.spacing_mut().item_spacing.y = 0.0;
                // The first line of the text is centred on the icon.
                let line = ui.text_style_height(&egui::TextStyle::Body);
                ui.add_space((24.0 - line) / 2.0);
                // The text is selectable, so that users can copy an error into a bug report.
                ui.add(Label::new(&notice.text).wrap().selectable(true));
                if let Some(file) = &notice.file {
                    ui.add_space(GRID);
                    file_buttons(ui, file);
                }
                if exceeds_limits {
                    ui.add_space(GRID);
                    let tip = "Builds it no matter how long it takes. You can cancel at any time.";
                    if ui.button("Build anyway").on_hover_text(tip).clicked() {
                        intents.push(Intent::BuildAnyway);
                    }
                }
            });
            if notice.kind.is_dismissible()
                && icon_button(ui, icons::CLOSE, "Close", vec2(24.0, 24.0)).clicked()
            {
                intents.push(Intent::DismissNotice(notice.id));
            }
        });
    });
}

/// Draws the buttons that show the folder of an exported file and that copy its path.
fn file_buttons(ui: &mut Ui, file: &Path) {
    ui.horizontal(|ui| {
        let folder = if file.is_dir() {
            Some(file)
        } else {
            file.parent()
        };
        let tip = "Opens the folder that contains the file.";
        if ui.button("Show folder").on_hover_text(tip).clicked()
            && let Some(folder) = folder
        {
            // If there is no file manager, nothing happens. The notice shows the path in any case.
            open::that_detached(folder).ok();
        }
        let tip = "Copies the path to the clipboard.";
        if ui.button("Copy path").on_hover_text(tip).clicked() {
            ui.copy_text(file.display().to_string());
        }
    });
}

#[cfg(test)]
mod tests {
    use bevy_egui::egui::pos2;

    use super::*;

    #[test]
    fn notices_have_no_room_where_the_dialog_is() {
        let window = Rect::from_min_size(pos2(0.0, 0.0), vec2(1280.0, 720.0));
        let dialogs = [
            Rect::from_center_size(window.center(), vec2(400.0, 140.0)),
            Rect::from_center_size(window.center(), vec2(760.0, 440.0)),
            // A dialog near the lower edge, and one that fills the window.
            Rect::from_min_size(pos2(300.0, 400.0), vec2(400.0, 310.0)),
            window.expand(20.0),
        ];
        for dialog in dialogs {
            let place = NoticePlace::next_to_dialog(dialog, window);
            let is_apart =
                place.room.bottom() <= dialog.top() || place.room.top() >= dialog.bottom();
            assert!(place.max_height().is_none() || is_apart, "{dialog:?}");
        }
        let fills = NoticePlace::next_to_dialog(window, window);
        assert_eq!(fills.max_height(), None);
        assert!(NoticePlace::next_to_dialog(dialogs[1], window).max_height() > Some(MIN_HEIGHT));
    }
}
