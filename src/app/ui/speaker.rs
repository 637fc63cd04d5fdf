//! What stands in the speaker's window: how long the talk has run, what to say here, what is next.

use std::sync::Arc;
use std::time::Duration;

use bevy::ecs::schedule::ScheduleLabel;
use bevy::prelude::{Add, Commands, On, Query, Res, Without};
use bevy_egui::egui::{self, CentralPanel, Id, Label, Layout, RichText, ScrollArea, Ui, vec2};
use bevy_egui::{EguiContext, EguiSchedule, PrimaryEguiContext};
use image::RgbaImage;

use crate::app::asking::choices::Preferences;
use crate::app::playing::playback::{Playback, SAME_T};
use crate::app::playing::presenting::Presenting;
use crate::app::playing::speaker::{Speaker, SpeakerCamera};
use crate::app::session::state::Session;
use crate::app::ui::kit::texture::texture;
use crate::app::ui::kit::theme::{self, GRID};
use crate::app::ui::kit::widgets::{ground, quiet};
use crate::transition::Stop;

/// When egui draws the speaker's window.
#[derive(ScheduleLabel, Clone, Debug, PartialEq, Eq, Hash)]
pub struct SpeakerPass;

/// Lets egui draw through the camera of the speaker's window.
pub fn join(added: On<Add, SpeakerCamera>, mut commands: Commands) {
    commands
        .entity(added.entity)
        .insert(EguiSchedule::new(SpeakerPass));
}

/// Draws it.
pub fn draw(
    mut contexts: Query<&mut EguiContext, Without<PrimaryEguiContext>>,
    (session, playback): (Res<Session>, Res<Playback>),
    (presenting, speaker, preferences): (Res<Presenting>, Res<Speaker>, Res<Preferences>),
) {
    let Ok(mut context) = contexts.single_mut() else {
        return;
    };
    let ctx = context.get_mut().clone();
    theme::choose(&ctx, preferences.theme);
    let mut root = egui::Ui::new(
        ctx.clone(),
        "speaker".into(),
        egui::UiBuilder::new()
            .layer_id(egui::LayerId::background())
            .max_rect(ctx.viewport_rect()),
    );
    let frame = ground(&root, [24, 24, 24, 24]);
    let stops = session.stops();
    let next = playback.next_stop(session.timing(), stops);
    CentralPanel::default().frame(frame).show(&mut root, |ui| {
        head(ui, presenting.lasts());
        let size = vec2(ui.available_width(), ui.available_height());
        let row = Layout::left_to_right(egui::Align::Min);
        ui.allocate_ui_with_layout(size, row, |ui| {
            let half = (ui.available_width() - 3.0 * GRID) / 2.0;
            ui.vertical(|ui| {
                ui.set_width(half);
                here(ui, near(stops, playback.t()));
            });
            ui.add_space(2.0 * GRID);
            ui.vertical(|ui| {
                ui.set_width(half);
                coming(ui, next.map(|t| (near(stops, t), t)), speaker.picture());
            });
        });
    });
}

/// The stop at a t, if there is one.
fn near(stops: &[Stop], t: f64) -> Option<&Stop> {
    stops.iter().find(|stop| (stop.t - t).abs() < SAME_T)
}

fn head(ui: &mut Ui, lasts: Duration) {
    let secs = lasts.as_secs();
    let (minutes, secs) = (secs / 60, secs % 60);
    ui.label(RichText::new(format!("{minutes}:{secs:02}")).size(44.0))
        .on_hover_text("How long the talk has run.");
    ui.label(quiet(
        ui,
        "Page Down: on · Page Up: back · B: black · T: captions · N: this window · Esc: end",
    ));
    ui.add_space(2.0 * GRID);
}

fn here(ui: &mut Ui, stop: Option<&Stop>) {
    ui.label(quiet(ui, "Now"));
    let Some(stop) = stop else {
        ui.label(RichText::new("on the way").size(22.0));
        return;
    };
    if !stop.name.is_empty() {
        ui.add(Label::new(RichText::new(&stop.name).size(22.0)).wrap());
    }
    ui.add_space(GRID);
    ScrollArea::vertical().show(ui, |ui| {
        if stop.note.is_empty() {
            ui.label(quiet(
                ui,
                "No notes: right-click a stop on the timeline to write some.",
            ));
        } else {
            ui.add(Label::new(RichText::new(&stop.note).size(18.0)).wrap());
        }
    });
}

fn coming(ui: &mut Ui, next: Option<(Option<&Stop>, f64)>, picture: Option<Arc<RgbaImage>>) {
    ui.label(quiet(ui, "Next"));
    let Some((stop, t)) = next else {
        ui.label(RichText::new("the end").size(22.0));
        return;
    };
    let name = stop.filter(|stop| !stop.name.is_empty());
    let name = name.map_or_else(|| format!("t = {t:.3}"), |stop| stop.name.clone());
    ui.add(Label::new(RichText::new(name).size(22.0)).wrap());
    ui.add_space(GRID);
    if let Some(picture) = picture {
        let texture = texture(ui.ctx(), Id::new("next stop"), &picture, u32::MAX);
        let width = ui.available_width();
        let size = texture.size_vec2();
        ui.image((texture.id(), size * (width / size.x)));
    }
}
