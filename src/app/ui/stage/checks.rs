//! The verdict on the transition: a line or two below the stage, and where it points to.

use bevy_egui::egui::{self, Label, Panel, Rect, RichText, Sense, Ui, vec2};

use crate::app::analysis::film_measures::{FilmMeasures, is_one_click};
use crate::app::input::intent::Intent;
use crate::app::ui::kit::icons;
use crate::app::ui::kit::theme::{GRID, ThemePalette};
use crate::app::ui::kit::widgets::{panel_frame, secondary_text};
use crate::app::ui::stage::area::is_light;
use crate::app::ui::ui_state::{Intents, UiState};
use crate::measure::{Finding, Verdict};

/// Height of one line.
const ROW_HEIGHT: f32 = 24.0;

/// How near t must be for the place of a finding to be marked: wider than the step of the measures,
/// a 64th, so that playing past it lights it up.
const NEAR_T: f64 = 0.02;

/// Draws the lines below the stage: above it they would cover what they speak of.
pub fn strip(root: &mut Ui, scene: &UiState, acts: &mut Intents) {
    if scene.session.transition().is_none() {
        return;
    }
    let measures = scene.measured.measures();
    let lines = measures.map_or(1, |measures| {
        let verdict = &measures.verdict;
        // Where nothing was found one line says so; else one says what helps.
        verdict.findings.len() + 1 + verdict.notes.len()
    });
    let frame = panel_frame(root, [8, 8, 4, 4]);
    Panel::bottom("verdict")
        .exact_size(GRID + ROW_HEIGHT * lines as f32)
        .resizable(false)
        .frame(frame)
        .show(root, |ui| match measures {
            Some(measures) => show(ui, scene, measures, acts),
            None => waiting(ui, scene, acts),
        });
}

/// There are no measures: they are being taken, or were broken off.
fn waiting(ui: &mut Ui, scene: &UiState, acts: &mut Intents) {
    ui.horizontal(|ui| {
        ui.label(secondary_text(ui, unmeasured_reason(scene)));
        let tip = "Look at the whole film for folds, crossings and distortion.";
        if scene.measured.is_broken_off() && ui.small_button("Measure").on_hover_text(tip).clicked()
        {
            acts.push(Intent::Measure);
        }
    });
}

/// Why there are no measures.
pub fn unmeasured_reason(scene: &UiState) -> String {
    match scene.measured.told() {
        _ if scene.session.transition().is_none() => "Nothing to measure yet.".to_owned(),
        _ if scene.measured.is_broken_off() => "Not measured: it was stopped.".to_owned(),
        Some(share) => format!("Measuring, {:.0} % … Esc stops it.", 100.0 * share),
        None => "Measuring …".to_owned(),
    }
}

/// One line, or one for each kind of trouble, and one for each note.
fn show(ui: &mut Ui, scene: &UiState, measures: &FilmMeasures, acts: &mut Intents) {
    let verdict = &measures.verdict;
    ui.spacing_mut().item_spacing.y = 0.0;
    if verdict.is_clear() {
        row(ui, true, |ui| clear(ui, scene, verdict, acts));
    }
    for (index, finding) in verdict.findings.iter().enumerate() {
        row(ui, false, |ui| {
            headline(ui, scene, finding, acts);
            advice(ui, index, finding, acts);
        });
    }
    if !verdict.is_clear() {
        help(ui, scene, acts);
    }
    for note in &verdict.notes {
        row(ui, false, |ui| {
            let note = capitalised(&note.to_string());
            let text = Label::new(RichText::new(&note).small()).truncate();
            ui.add(text).on_hover_text(note);
        });
    }
}

/// Nothing is seen: at the moments that were looked at, or as it is proved at any.
fn clear(ui: &mut Ui, scene: &UiState, verdict: &Verdict, acts: &mut Intents) {
    let looked = format!(
        "Looked at {} moments from the source to the target.",
        verdict.steps
    );
    let seen = capitalised(verdict.clear);
    let Some(proved) = scene.recording.proved() else {
        ui.label(RichText::new(seen).small()).on_hover_text(looked);
        return;
    };
    let tip = format!("{looked}\nBetween them: {proved}.");
    let Some(first) = proved.first_t() else {
        let but = match (proved.is_whole(), proved.left_out > 0) {
            (true, _) => "",
            (false, true) => ", but for what comes and goes",
            (false, false) => ", but for cuts as they open",
        };
        let text = RichText::new(format!("{seen}: proved for every t{but}")).small();
        ui.label(text).on_hover_text(tip);
        return;
    };
    ui.label(RichText::new(seen).small()).on_hover_text(&tip);
    let text = format!("at {} moments; not proved at t = {first:.4}", verdict.steps);
    let label = Label::new(secondary_text(ui, text)).sense(Sense::click());
    if ui.add(label).on_hover_text(tip).clicked() {
        acts.push(Intent::Seek(scene.session.beyond(first)));
    }
}

fn row(ui: &mut Ui, is_clear: bool, content: impl FnOnce(&mut Ui)) {
    let palette = ThemePalette::of(ui);
    let (icon, colour) = if is_clear {
        (icons::TICK, palette.good)
    } else {
        (icons::WARNING, palette.amber)
    };
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 6.0;
        ui.set_min_height(ROW_HEIGHT);
        let (rect, _) = ui.allocate_exact_size(vec2(16.0, 20.0), Sense::hover());
        icons::paint_icon(ui.painter(), icon, rect, colour);
        content(ui);
    });
}

/// What is seen; a click goes there.
fn headline(ui: &mut Ui, scene: &UiState, finding: &Finding, acts: &mut Intents) {
    let text = RichText::new(capitalised(&finding.headline()))
        .small()
        .color(ThemePalette::of(ui).amber);
    let response = ui.add(Label::new(text).sense(Sense::click()));
    if response.hovered() {
        ui.ctx().set_cursor_icon(egui::CursorIcon::PointingHand);
    }
    if response.clicked() {
        acts.push(Intent::Seek(scene.session.beyond(finding.t)));
    }
    let here = scene.session.within(scene.playback.t());
    let go = if (here - finding.t).abs() <= NEAR_T {
        "The place is marked on the stage."
    } else {
        "Click to go there."
    };
    let tip = format!(
        "Why: {}.\nWhat helps: {}.\n{go}",
        finding.cause, finding.remedy
    );
    response.on_hover_text(tip);
}

/// What was tried and helps: a button for each.
fn help(ui: &mut Ui, scene: &UiState, acts: &mut Intents) {
    let helping = &scene.helping;
    ui.horizontal(|ui| {
        ui.set_min_height(ROW_HEIGHT);
        ui.spacing_mut().item_spacing.x = 6.0;
        ui.add_space(22.0);
        let now = helping.now().map(|now| now.to_string()).unwrap_or_default();
        let words = match (helping.offers(), helping.is_busy(), helping.is_done()) {
            ([], true, _) => "Trying what would help: mirrored, turned, other methods …",
            ([], _, true) => "Nothing that was tried helps: mirrored, turned, other methods.",
            ([], ..) => "",
            // Short: the offers stand behind it.
            _ => "Helps:",
        };
        ui.label(secondary_text(ui, words));
        for (index, offer) in helping.offers().iter().enumerate() {
            let left = match offer.rating {
                rating if rating.is_flawless() => "none left".to_owned(),
                rating => rating.to_string(),
            };
            let text = format!("{}: {left}", offer.what.words());
            let tip = format!("Tried: {} instead of {now}. Can be undone.", offer.rating);
            if ui.small_button(text).on_hover_text(tip).clicked() {
                acts.push(Intent::TakeOffer(index));
            }
        }
    });
}

/// A button for what helps, where a click can do it.
fn advice(ui: &mut Ui, index: usize, finding: &Finding, acts: &mut Intents) {
    if !is_one_click(&finding.remedy) {
        return;
    }
    let tip = format!(
        "{}. Can be undone.",
        capitalised(&finding.remedy.to_string())
    );
    if ui.small_button("Fix").on_hover_text(tip).clicked() {
        acts.push(Intent::TakeAdvice(index));
    }
}

/// A sentence from words that stand within one.
pub fn capitalised(text: &str) -> String {
    let mut chars = text.chars();
    chars
        .next()
        .map(|first| first.to_uppercase().chain(chars).collect())
        .unwrap_or_default()
}

/// Marks the place of each finding on the stage while t is there.
pub fn mark(ui: &Ui, scene: &UiState, stage: Rect) {
    let Some(measures) = scene.measured.measures() else {
        return;
    };
    let colour = ThemePalette::on(is_light(scene.session.style().ground)).amber;
    let painter = ui.painter().with_clip_rect(stage);
    for finding in &measures.verdict.findings {
        if (scene.session.within(scene.playback.t()) - finding.t).abs() > NEAR_T {
            continue;
        }
        let px = scene.view.px_from_world(finding.place);
        let at = stage.min + vec2(px.x, px.y);
        painter.circle_stroke(at, 16.0, (2.0, colour));
        for (dx, dy) in [(-1.0, 0.0), (1.0, 0.0), (0.0, -1.0), (0.0, 1.0)] {
            let ray = vec2(dx, dy);
            painter.line_segment([at + 16.0 * ray, at + 22.0 * ray], (2.0, colour));
        }
    }
}
