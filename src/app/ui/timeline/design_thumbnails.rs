//! Pointer input on the thumbnails of designs in the film strip: a click moves t to the design, a
//! drag reorders the designs, and a right-click opens a menu.

use bevy_egui::egui::{Rect, Response, Sense, Ui, pos2};

use crate::app::input::intent::Intent;
use crate::app::ui::kit::theme::{GRID, ThemePalette};
use crate::app::ui::timeline::ruler::TimelineRuler;
use crate::app::ui::ui_state::{Intents, UiState};
use crate::io::sanitize::SanitizedName;
use crate::project::Project;

/// Handler of pointer input on the thumbnails of designs.
pub struct ThumbnailDrag<'a> {
    project: &'a Project,
    ruler: TimelineRuler,
    /// Index of the dragged design, and the index in the current order before which it would be
    /// inserted; `None` if no design is dragged.
    dragged: Option<(usize, usize)>,
}

impl<'a> ThumbnailDrag<'a> {
    /// Creates the handler for the open project; `None` if the project has only two designs or
    /// follows a path, so that the order of its designs cannot be changed on the timeline.
    pub fn new(state: &'a UiState<'a>, ruler: TimelineRuler) -> Option<Self> {
        let project = state.session.whole_project()?;
        (project.is_sequence() && !project.follows_path()).then_some(Self {
            project,
            ruler,
            dragged: None,
        })
    }

    /// Handles the pointer on the thumbnail at `t`. Returns the horizontal offset of the thumbnail
    /// in points, which is 0 unless it is being dragged.
    pub fn interact(&mut self, ui: &Ui, t: f64, rect: Rect, intents: &mut Intents) -> f32 {
        let k = t.round();
        // Thumbnails between designs cannot be dragged. Neither can the last thumbnail of a closed
        // loop, which repeats the first design.
        if (t - k).abs() > 1e-9 || k < 0.0 || k as usize >= self.project.designs.len() {
            return 0.0;
        }
        let k = k as usize;
        let id = ui.id().with(("design", k));
        let response = ui.interact(rect, id, Sense::click_and_drag());
        let offset = self.drag(ui, k, &response, intents);
        if response.clicked() {
            intents.push(Intent::Seek(t));
        }
        let name = self.project.designs[k].display_name();
        let tip = format!(
            "{}. Drag to reorder, right-click to replace, duplicate or remove.",
            SanitizedName(&name)
        );
        let response = response.on_hover_text(tip);
        response.context_menu(|ui| menu(ui, self.project, k, intents));
        offset
    }

    fn drag(&mut self, ui: &Ui, k: usize, response: &Response, intents: &mut Intents) -> f32 {
        let from = response.id.with("from");
        let Some(pointer) = response.interact_pointer_pos() else {
            return 0.0;
        };
        if response.drag_started() {
            ui.data_mut(|data| data.insert_temp(from, pointer.x));
        }
        let drop_index = self.drop_index(pointer.x);
        if response.drag_stopped() {
            intents.extend(
                self.project
                    .with_moved(k, drop_index)
                    .map(Intent::ReorderDesigns),
            );
            return 0.0;
        }
        if !response.dragged() {
            return 0.0;
        }
        self.dragged = Some((k, drop_index));
        let start = ui.data(|data| data.get_temp::<f32>(from));
        pointer.x - start.unwrap_or(pointer.x)
    }

    /// Returns the index in the current order before which a design is inserted if its thumbnail is
    /// dropped at `x`.
    fn drop_index(&self, x: f32) -> usize {
        let is_left = |k: &usize| self.ruler.x(*k as f64) < x;
        (0..self.project.designs.len()).filter(is_left).count()
    }

    /// Draws a line where the dragged design would be inserted.
    pub fn draw_drop_marker(&self, ui: &Ui, top: f32, height: f32) {
        let Some((k, drop_index)) = self.dragged else {
            return;
        };
        if self.project.with_moved(k, drop_index).is_none() {
            return;
        }
        let x = self.ruler.x(drop_index as f64 - 0.5);
        let ink = ThemePalette::of(ui).accent;
        let line = [
            pos2(x, top - GRID / 2.0),
            pos2(x, top + height + GRID / 2.0),
        ];
        ui.painter().line_segment(line, (2.0, ink));
    }
}

fn menu(ui: &mut Ui, project: &Project, k: usize, intents: &mut Intents) {
    ui.set_width(180.0);
    let mut choices: Vec<(&str, Intent)> = vec![
        ("Replace …", Intent::AskReplace(k)),
        ("Insert before …", Intent::AskInsert(k)),
        ("Insert after …", Intent::AskInsert(k + 1)),
    ];
    let duplicated = Intent::ReorderDesigns(project.with_duplicated(k));
    choices.push(("Duplicate", duplicated));
    if project.designs.len() > 2 {
        choices.push(("Remove", Intent::ReorderDesigns(project.without(k))));
    }
    for (label, intent) in choices {
        if ui.button(label).clicked() {
            intents.push(intent);
            ui.close();
        }
    }
}
