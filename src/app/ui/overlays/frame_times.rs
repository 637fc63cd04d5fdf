//! Where a frame's time goes.

use bevy_egui::egui::{Panel, Ui};

use crate::app::ui::kit::theme::GRID;
use crate::app::ui::kit::widgets::{panel_frame, secondary_text};
use crate::app::ui::ui_state::UiState;
use crate::transition::Transition;

const HEIGHT: f32 = 32.0;

/// Draws the times in a line above the stage.
pub fn strip(root: &mut Ui, scene: &UiState) {
    let frame = panel_frame(root, [16, 16, 4, 4]);
    Panel::top("times")
        .exact_size(HEIGHT)
        .resizable(false)
        .frame(frame)
        .show(root, |ui| ui.horizontal_centered(|ui| line(ui, scene)));
}

fn line(ui: &mut Ui, scene: &UiState) {
    ui.label(secondary_text(ui, "Median"))
        .on_hover_text("Of the last frames");
    let whole = ("Whole frame", &scene.whole.0);
    let stages = match scene.map.is_shown {
        true => vec![("Blend and picture", scene.map.times()), whole],
        false => vec![
            ("Solve", &scene.times.solve),
            ("Draw", &scene.times.draw),
            whole,
        ],
    };
    for (stage, durations) in stages {
        ui.add_space(GRID);
        ui.label(stage);
        let time = durations.median().map(|time| time.as_secs_f64() * 1e3);
        let text = time.map_or("–".to_owned(), |ms| format!("{ms:7.2} ms"));
        ui.monospace(text);
    }
    ui.add_space(GRID);
    let (word, more) = whence(scene);
    ui.label(secondary_text(ui, word)).on_hover_text(more);
}

/// Where frames come from, in a word and in more.
fn whence(scene: &UiState) -> (String, String) {
    let solved = || "Solved".to_owned();
    match scene.session.transition().and_then(Transition::film) {
        Some(Ok(film)) => {
            let megabytes = film.bytes() as f64 / 1e6;
            let (kind, by) = match scene.times.is_played {
                true => ("GPU film", "the graphics card"),
                false => ("Film", "memory"),
            };
            let more = format!(
                "Frames come from {by}: recorded by {} solves, to {:.0e} of the drawings' size",
                film.solves(),
                film.error()
            );
            (format!("{kind} {megabytes:.1} MB"), more)
        }
        Some(Err(error)) => (solved(), error.to_string()),
        None => match (scene.recording.progress(), scene.recording.refused()) {
            (Some((doing, share)), _) => (
                format!("Solved, {doing} {:.0} %", 100.0 * share),
                "The film is not recorded yet".to_owned(),
            ),
            (None, Some(error)) => (solved(), error.to_string()),
            (None, None) => (solved(), "The film is not recorded yet".to_owned()),
        },
    }
}
