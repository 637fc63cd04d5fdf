//! Strip that shows how long the frames of the window take: the median times of solving the
//! transition, of drawing and of a whole frame. The strip also says whether the transition is
//! solved in each frame or played from a recording.

use bevy_egui::egui::{Panel, Ui};

use crate::app::ui::kit::theme::GRID;
use crate::app::ui::kit::widgets::{panel_frame, secondary_text};
use crate::app::ui::ui_state::UiState;
use crate::transition::Transition;

/// Height of the strip of frame times, in points.
const HEIGHT: f32 = 32.0;

/// Draws the strip of frame times above the stage.
pub fn strip(root: &mut Ui, state: &UiState) {
    let frame = panel_frame(root, [16, 16, 4, 4]);
    Panel::top("times")
        .exact_size(HEIGHT)
        .resizable(false)
        .frame(frame)
        .show(root, |ui| ui.horizontal_centered(|ui| line(ui, state)));
}

fn line(ui: &mut Ui, state: &UiState) {
    ui.label(secondary_text(ui, "Frame time"))
        .on_hover_text("Median of the last frames");
    let total = ("Total", &state.frame_intervals.0);
    let stages = match state.map.is_shown {
        true => vec![("Blend and draw", state.map.draw_times()), total],
        false => vec![
            ("Solve", &state.frame_times.solve),
            ("Draw", &state.frame_times.draw),
            total,
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
    let (label, details) = frame_source(state);
    ui.label(secondary_text(ui, label)).on_hover_text(details);
}

/// Returns how the frames of the film are computed (solved, or played from a recording), as a short
/// label and as a tooltip.
fn frame_source(state: &UiState) -> (String, String) {
    let solved = || "Solved".to_owned();
    match state.session.transition().and_then(Transition::recording) {
        Some(Ok(film)) => {
            let megabytes = film.bytes() as f64 / 1e6;
            let (kind, source) = match state.frame_times.is_gpu_played {
                true => ("GPU recording", "the GPU"),
                false => ("Recording", "memory"),
            };
            let details = format!(
                "Frames are played from {source}: recorded with {} solves, accurate to {:.0e} of \
                the designs' size",
                film.evaluation_count(),
                film.error()
            );
            (format!("{kind} {megabytes:.1} MB"), details)
        }
        Some(Err(error)) => (solved(), error.to_string()),
        None => match (
            state.recording.progress(),
            state.recording.recording_error(),
        ) {
            (Some((stage, fraction)), _) => (
                format!("Solved, {stage} {:.0} %", 100.0 * fraction),
                "Frames are solved until the transition has been recorded".to_owned(),
            ),
            (None, Some(error)) => (solved(), error.to_string()),
            (None, None) => (solved(), "The transition is not recorded yet".to_owned()),
        },
    }
}
