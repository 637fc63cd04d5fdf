//! The designs of a sequence as they lie on the timeline: dragged, they change places.

use bevy_egui::egui::{Rect, Response, Sense, Ui, pos2};

use crate::app::input::intent::Intent;
use crate::app::ui::kit::theme::{GRID, ThemePalette};
use crate::app::ui::timeline::ruler::TimelineRuler;
use crate::app::ui::ui_state::{Intents, UiState};
use crate::io::sanitize::SanitizedLine;
use crate::project::Project;

/// What a hand does with the pictures of designs.
pub struct ThumbnailDrag<'a> {
    whole: &'a Project,
    ruler: TimelineRuler,
    /// Which one is dragged, and to where in the order.
    dragged: Option<(usize, usize)>,
}

impl<'a> ThumbnailDrag<'a> {
    /// Of the open project; none where its designs have no order on the timeline.
    pub fn of(scene: &'a UiState<'a>, ruler: TimelineRuler) -> Option<Self> {
        let whole = scene.session.whole()?;
        (whole.is_sequence() && !whole.follows_path()).then_some(Self {
            whole,
            ruler,
            dragged: None,
        })
    }

    /// Takes hold of the picture at that t. By how much it is to be drawn beside its place.
    pub fn hold(&mut self, ui: &Ui, t: f64, rect: Rect, acts: &mut Intents) -> f32 {
        let k = t.round();
        // Between two designs is nothing to hold, and the one that is led back to is the first.
        if (t - k).abs() > 1e-9 || k < 0.0 || k as usize >= self.whole.designs.len() {
            return 0.0;
        }
        let k = k as usize;
        let id = ui.id().with(("design", k));
        let response = ui.interact(rect, id, Sense::click_and_drag());
        let offset = self.drag(ui, k, &response, acts);
        if response.clicked() {
            acts.push(Intent::Seek(t));
        }
        let name = self.whole.designs[k].shown_name();
        let tip = format!(
            "{}. Drag it to another place, right-click to replace it, repeat it or take it out.",
            SanitizedLine(&name)
        );
        let response = response.on_hover_text(tip);
        response.context_menu(|ui| menu(ui, self.whole, k, acts));
        offset
    }

    fn drag(&mut self, ui: &Ui, k: usize, response: &Response, acts: &mut Intents) -> f32 {
        let from = response.id.with("from");
        let Some(pointer) = response.interact_pointer_pos() else {
            return 0.0;
        };
        if response.drag_started() {
            ui.data_mut(|data| data.insert_temp(from, pointer.x));
        }
        let place = self.place(pointer.x);
        if response.drag_stopped() {
            acts.extend(self.whole.with_moved(k, place).map(Intent::Arrange));
            return 0.0;
        }
        if !response.dragged() {
            return 0.0;
        }
        self.dragged = Some((k, place));
        let start = ui.data(|data| data.get_temp::<f32>(from));
        pointer.x - start.unwrap_or(pointer.x)
    }

    /// Before which design, in the order that there is, something at that x would come.
    fn place(&self, x: f32) -> usize {
        let is_left = |k: &usize| self.ruler.x(*k as f64) < x;
        (0..self.whole.designs.len()).filter(is_left).count()
    }

    /// Shows where the picture that is dragged would come to lie.
    pub fn mark(&self, ui: &Ui, top: f32, height: f32) {
        let Some((k, place)) = self.dragged else {
            return;
        };
        if self.whole.with_moved(k, place).is_none() {
            return;
        }
        let x = self.ruler.x(place as f64 - 0.5);
        let ink = ThemePalette::of(ui).accent;
        let line = [
            pos2(x, top - GRID / 2.0),
            pos2(x, top + height + GRID / 2.0),
        ];
        ui.painter().line_segment(line, (2.0, ink));
    }
}

fn menu(ui: &mut Ui, whole: &Project, k: usize, acts: &mut Intents) {
    ui.set_width(180.0);
    let mut choices: Vec<(&str, Intent)> = vec![
        ("Replace …", Intent::AskReplace(k)),
        ("Insert before …", Intent::AskInsert(k)),
        ("Insert behind …", Intent::AskInsert(k + 1)),
    ];
    let repeated = Intent::Arrange(whole.with_repeated(k));
    choices.push(("Once more behind it", repeated));
    if whole.designs.len() > 2 {
        choices.push(("Take it out", Intent::Arrange(whole.without(k))));
    }
    for (words, intent) in choices {
        if ui.button(words).clicked() {
            acts.push(intent);
            ui.close();
        }
    }
}
