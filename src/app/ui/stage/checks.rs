//! Results of the automatic check of the transition. A strip below the stage lists findings
//! (defects such as folds, with cause and remedy), fixes and notes. Marks on the stage show the
//! places of the findings.

use bevy_egui::egui::{
    self, Label, Panel, Rect, RichText, Sense, TextStyle, TextWrapMode, Ui, WidgetText, vec2,
};

use crate::app::analysis::film_measures::FilmMeasures;
use crate::app::analysis::suggestions::is_one_click;
use crate::app::input::intent::Intent;
use crate::app::ui::kit::text::capitalised;
use crate::app::ui::kit::theme::{GRID, ThemePalette};
use crate::app::ui::kit::widgets::{panel_frame, secondary_text};
use crate::app::ui::stage::area::is_light;
use crate::app::ui::stage::check_row::{ROW_HEIGHT, row};
use crate::app::ui::stage::structure_rows;
use crate::app::ui::ui_state::{Intents, UiState};
use crate::measure::{Finding, Verdict};

/// Maximum difference between the current t and the t of a finding whose place is marked on the
/// stage (tolerance: slightly more than 1/64, the step between two samples of the film).
const NEAR_T: f64 = 0.02;

/// Draws the strip with the results of the check below the stage, so that it does not cover the
/// film.
pub fn strip(root: &mut Ui, state: &UiState, intents: &mut Intents) {
    if state.session.transition().is_none() {
        return;
    }
    let measures = state.measures.measures();
    let lines = measures.map_or(1, |measures| {
        let verdict = &measures.verdict;
        // The findings and notes take one line each. One more line offers fixes or, without
        // findings, reports that the check found no defects.
        let structure = structure_rows::count(measures);
        verdict.findings.len() + 1 + verdict.notes.len() + structure
    });
    let frame = panel_frame(root, [8, 8, 4, 4]);
    Panel::bottom("verdict")
        .exact_size(GRID + ROW_HEIGHT * lines as f32)
        .resizable(false)
        .frame(frame)
        .show(root, |ui| match measures {
            Some(measures) => show(ui, state, measures, intents),
            None => pending_row(ui, state, intents),
        });
}

/// Draws the row that replaces the results while the check is running or after it was stopped.
fn pending_row(ui: &mut Ui, state: &UiState, intents: &mut Intents) {
    ui.horizontal(|ui| {
        ui.label(secondary_text(ui, unmeasured_reason(state)));
        let tip = "Check the whole film for folds, crossings and distortion.";
        if state.measures.was_stopped() && ui.small_button("Check").on_hover_text(tip).clicked() {
            intents.push(Intent::MeasureAgain);
        }
    });
}

/// Returns a text that says why the automatic check has no results: there is no transition, or the
/// check is running or was stopped.
pub fn unmeasured_reason(state: &UiState) -> String {
    match state.measures.visible_progress() {
        _ if state.session.transition().is_none() => "Nothing to check yet.".to_owned(),
        _ if state.measures.was_stopped() => "The check was stopped.".to_owned(),
        Some(share) => format!("Checking, {:.0} % … Press Esc to stop.", 100.0 * share),
        None => "Checking …".to_owned(),
    }
}

/// Draws a line for each finding and then a line with the fixes. If there are no findings, draws
/// one line with this result instead. Draws a line for each note below.
fn show(ui: &mut Ui, state: &UiState, measures: &FilmMeasures, intents: &mut Intents) {
    let verdict = &measures.verdict;
    ui.spacing_mut().item_spacing.y = 0.0;
    if verdict.is_clear() {
        row(ui, true, |ui| clear(ui, state, verdict, intents));
    }
    for (index, finding) in verdict.findings.iter().enumerate() {
        row(ui, false, |ui| {
            headline(ui, state, finding, intents);
            fix_button(ui, state, index, finding, intents);
        });
    }
    if !verdict.is_clear() {
        fixes(ui, state, intents);
    }
    structure_rows::show(ui, state, measures, intents);
    for note in &verdict.notes {
        row(ui, false, |ui| {
            let note = capitalised(&note.to_string());
            let text = Label::new(RichText::new(&note).small()).truncate();
            ui.add(text).on_hover_text(note);
        });
    }
}

/// Draws the result of a check without findings. The text says whether the result holds only for
/// the sampled moments, or is proved for every moment.
fn clear(ui: &mut Ui, state: &UiState, verdict: &Verdict, intents: &mut Intents) {
    let sampled = format!("Checked {} moments from source to target.", verdict.steps);
    let clear_text = capitalised(verdict.clear);
    let Some(proof) = state.recording.proof() else {
        ui.label(RichText::new(clear_text).small())
            .on_hover_text(sampled);
        return;
    };
    let tip = format!("{sampled}\nBetween them: {proof}.");
    let Some(first) = proof.first_failure_time() else {
        let exception = match (proof.is_complete(), proof.left_out > 0) {
            (true, _) => "",
            (false, true) => ", except appearing and disappearing parts",
            (false, false) => ", except cuts while they open",
        };
        let text =
            RichText::new(format!("{clear_text}: checked at every moment{exception}")).small();
        ui.label(text).on_hover_text(tip);
        return;
    };
    ui.label(RichText::new(clear_text).small())
        .on_hover_text(&tip);
    let text = format!(
        "checked at {} moments; uncertain at t = {first:.4}",
        verdict.steps
    );
    let label = Label::new(secondary_text(ui, text)).sense(Sense::click());
    if ui.add(label).on_hover_text(tip).clicked() {
        intents.push(Intent::Seek(state.session.whole_t(first)));
    }
}

/// Draws the headline of a finding. A click on it moves t to the moment of the finding.
fn headline(ui: &mut Ui, state: &UiState, finding: &Finding, intents: &mut Intents) {
    let text = RichText::new(capitalised(&finding.headline()))
        .small()
        .color(ThemePalette::of(ui).amber);
    let response = ui.add(Label::new(text).sense(Sense::click()));
    if response.hovered() {
        ui.ctx().set_cursor_icon(egui::CursorIcon::PointingHand);
    }
    if response.clicked() {
        intents.push(Intent::Seek(state.session.whole_t(finding.t)));
    }
    let t = state.session.segment_t(state.playback.t());
    let hint = if (t - finding.t).abs() <= NEAR_T {
        "The place is marked on the stage."
    } else {
        "Click to go there."
    };
    // A remedy that can be tried is named only if it helps.
    let is_named = !is_one_click(&finding.remedy) || state.suggestions.offers(&finding.remedy);
    let fix = match is_named {
        true => format!("Fix: {}.\n", finding.remedy),
        false => String::new(),
    };
    let tip = format!("Cause: {}.\n{fix}{hint}", finding.cause);
    response.on_hover_text(tip);
}

/// Draws a button for each suggestion: a change of the project that was tested and gives fewer
/// defects.
fn fixes(ui: &mut Ui, state: &UiState, intents: &mut Intents) {
    let suggestions = &state.suggestions;
    ui.horizontal(|ui| {
        ui.set_min_height(ROW_HEIGHT);
        ui.spacing_mut().item_spacing.x = 6.0;
        ui.add_space(22.0);
        let current = suggestions
            .current_rating()
            .map(|current| current.to_string())
            .unwrap_or_default();
        let text = match (
            suggestions.suggestions(),
            suggestions.is_busy(),
            suggestions.is_done(),
        ) {
            ([], true, _) => "Looking for fixes: flipping, rotating, other methods …",
            ([], _, true) if suggestions.has_remedies() => "",
            ([], _, true) => "No fix found: tried flipping, rotating and other methods.",
            ([], ..) => "",
            // The text is short, because the buttons follow it in the same line.
            _ => "Try:",
        };
        ui.label(secondary_text(ui, text));
        for (index, suggestion) in suggestions.suggestions().iter().enumerate() {
            let remaining = match suggestion.rating {
                rating if rating.is_flawless() => "no defects".to_owned(),
                rating => rating.to_string(),
            };
            let text = format!("{} ({remaining})", suggestion.change.label());
            // The best suggestions come first; those without room are left out.
            if index > 0 && small_button_width(ui, &text) > ui.available_width() {
                break;
            }
            let tip = format!(
                "Tested: {} instead of {current}. Can be undone.",
                suggestion.rating
            );
            if ui.small_button(text).on_hover_text(tip).clicked() {
                intents.push(Intent::ApplySuggestion(index));
            }
        }
    });
}

/// Returns the width of a small button with `text`, in points.
fn small_button_width(ui: &Ui, text: &str) -> f32 {
    let text = WidgetText::from(text);
    let galley = text.into_galley(
        ui,
        Some(TextWrapMode::Extend),
        f32::INFINITY,
        TextStyle::Body,
    );
    galley.size().x + 2.0 * ui.spacing().button_padding.x
}

/// Draws a button that applies the remedy of a finding, if the remedy was tried and helps.
fn fix_button(
    ui: &mut Ui,
    state: &UiState,
    index: usize,
    finding: &Finding,
    intents: &mut Intents,
) {
    if !state.suggestions.offers(&finding.remedy) {
        return;
    }
    let tip = format!(
        "{}. Can be undone.",
        capitalised(&finding.remedy.to_string())
    );
    if ui.small_button("Fix").on_hover_text(tip).clicked() {
        intents.push(Intent::ApplyRemedy(index));
    }
}

/// Marks on the stage the places of the findings that occur near the current t.
pub fn mark(ui: &Ui, state: &UiState, stage: Rect) {
    let Some(measures) = state.measures.measures() else {
        return;
    };
    let colour = ThemePalette::on(is_light(state.session.style().ground)).amber;
    let painter = ui.painter().with_clip_rect(stage);
    for finding in &measures.verdict.findings {
        if (state.session.segment_t(state.playback.t()) - finding.t).abs() > NEAR_T {
            continue;
        }
        let px = state.view.px_from_world(finding.place);
        let at = stage.min + vec2(px.x, px.y);
        painter.circle_stroke(at, 16.0, (2.0, colour));
        for (dx, dy) in [(-1.0, 0.0), (1.0, 0.0), (0.0, -1.0), (0.0, 1.0)] {
            let ray = vec2(dx, dy);
            painter.line_segment([at + 16.0 * ray, at + 22.0 * ray], (2.0, colour));
        }
    }
}
