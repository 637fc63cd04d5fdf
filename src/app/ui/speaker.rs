//! Contents of the speaker window, the second window of a talk: elapsed time, current stop with its
//! notes, and name and picture of the next stop.

use std::sync::Arc;
use std::time::Duration;

use bevy::ecs::schedule::ScheduleLabel;
use bevy::prelude::{Add, Commands, On, Query, Res, Without};
use bevy_egui::egui::{self, CentralPanel, Id, Label, Layout, RichText, ScrollArea, Ui, vec2};
use bevy_egui::{EguiContext, EguiSchedule, PrimaryEguiContext};
use image::RgbaImage;

use crate::app::input::preferences::Preferences;
use crate::app::playback::player::{Playback, STOP_TOLERANCE_T};
use crate::app::presentation::presenter::Presentation;
use crate::app::presentation::speaker_window::{SpeakerCamera, SpeakerWindow};
use crate::app::session::state::Session;
use crate::app::ui::kit::texture::texture;
use crate::app::ui::kit::theme::{self, GRID};
use crate::app::ui::kit::widgets::{panel_frame, secondary_text};
use crate::transition::TransitionStop;

/// Schedule in which egui draws the speaker window.
#[derive(ScheduleLabel, Clone, Debug, PartialEq, Eq, Hash)]
pub struct SpeakerPass;

/// Observer that assigns the schedule [`SpeakerPass`] to the camera of the speaker window, so that
/// egui draws with this camera.
pub fn join(added: On<Add, SpeakerCamera>, mut commands: Commands) {
    commands
        .entity(added.entity)
        .insert(EguiSchedule::new(SpeakerPass));
}

/// Draws the contents of the speaker window, if it is open.
pub fn draw(
    mut contexts: Query<&mut EguiContext, Without<PrimaryEguiContext>>,
    session: Res<Session>,
    playback: Res<Playback>,
    presenting: Res<Presentation>,
    speaker: Res<SpeakerWindow>,
    preferences: Res<Preferences>,
) {
    let Ok(mut context) = contexts.single_mut() else {
        return;
    };
    let ctx = context.get_mut().clone();
    theme::apply_theme(&ctx, preferences.theme);
    let mut root = egui::Ui::new(
        ctx.clone(),
        "speaker".into(),
        egui::UiBuilder::new()
            .layer_id(egui::LayerId::background())
            .max_rect(ctx.viewport_rect()),
    );
    let frame = panel_frame(&root, [24, 24, 24, 24]);
    let stops = session.stops();
    let names = session.names_along_path();
    let next = playback.next_stop(session.timing(), stops);
    CentralPanel::default().frame(frame).show(&mut root, |ui| {
        head(ui, presenting.elapsed());
        let size = vec2(ui.available_width(), ui.available_height());
        let row = Layout::left_to_right(egui::Align::Min);
        ui.allocate_ui_with_layout(size, row, |ui| {
            let half = (ui.available_width() - 3.0 * GRID) / 2.0;
            ui.vertical(|ui| {
                ui.set_width(half);
                show_current(ui, SpeakerMoment::new(playback.t(), stops, &names));
            });
            ui.add_space(2.0 * GRID);
            ui.vertical(|ui| {
                ui.set_width(half);
                show_next(
                    ui,
                    next.map(|t| SpeakerMoment::new(t, stops, &names)),
                    speaker.picture(),
                );
            });
        });
    });
}

/// A moment of the film with its stop and its design, as the speaker window shows it.
struct SpeakerMoment<'a> {
    t: f64,
    stop: Option<&'a TransitionStop>,
    /// Name of the design at exactly this t; `None` between designs.
    design: Option<&'a str>,
}

impl<'a> SpeakerMoment<'a> {
    /// Looks up the stop and the design at `t`. `names[k]` is the name of the design at t = k.
    fn new(t: f64, stops: &'a [TransitionStop], names: &'a [String]) -> Self {
        let is_here = |other_t: f64| (other_t - t).abs() < STOP_TOLERANCE_T;
        let design = names.iter().enumerate().find(|(k, _)| is_here(*k as f64));
        Self {
            t,
            stop: stops.iter().find(|stop| is_here(stop.t)),
            design: design.map(|(_, name)| name.as_str()),
        }
    }

    /// Returns the name of the stop or, if it has none, that of the design.
    fn name(&self) -> Option<&'a str> {
        let stop = self.stop.map(|stop| stop.name.as_str());
        stop.filter(|name| !name.is_empty()).or(self.design)
    }
}

fn head(ui: &mut Ui, elapsed: Duration) {
    let secs = elapsed.as_secs();
    let (minutes, secs) = (secs / 60, secs % 60);
    ui.label(RichText::new(format!("{minutes}:{secs:02}")).size(44.0))
        .on_hover_text("Elapsed time of the talk");
    ui.label(secondary_text(
        ui,
        "Page Down: next · Page Up: back · B: black · T: captions · N: this window · Esc: end",
    ));
    ui.add_space(2.0 * GRID);
}

fn show_current(ui: &mut Ui, moment: SpeakerMoment<'_>) {
    ui.label(secondary_text(ui, "Now"));
    match (moment.name(), moment.stop) {
        (Some(name), _) => large_text(ui, name),
        (None, Some(_)) => {}
        (None, None) => large_text(ui, "between stops"),
    }
    let Some(stop) = moment.stop else {
        return;
    };
    ui.add_space(GRID);
    ScrollArea::vertical().show(ui, |ui| {
        if stop.note.is_empty() {
            ui.label(secondary_text(
                ui,
                "No notes. Right-click a stop on the timeline to add some.",
            ));
        } else {
            ui.add(Label::new(RichText::new(&stop.note).size(18.0)).wrap());
        }
    });
}

fn large_text(ui: &mut Ui, text: &str) {
    ui.add(Label::new(RichText::new(text).size(22.0)).wrap());
}

fn show_next(ui: &mut Ui, next: Option<SpeakerMoment<'_>>, picture: Option<Arc<RgbaImage>>) {
    ui.label(secondary_text(ui, "Next"));
    let Some(moment) = next else {
        large_text(ui, "End");
        return;
    };
    let t = || format!("t = {:.3}", moment.t);
    large_text(ui, &moment.name().map_or_else(t, str::to_owned));
    ui.add_space(GRID);
    if let Some(picture) = picture {
        let texture = texture(ui.ctx(), Id::new("next stop"), &picture, u32::MAX);
        let width = ui.available_width();
        let size = texture.size_vec2();
        ui.image((texture.id(), size * (width / size.x)));
    }
}
