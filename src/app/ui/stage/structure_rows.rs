//! Rows of the strip below the stage about the structure of two trusses: whether it stands at every
//! moment, and its faults, each with a click to its moment.

use bevy_egui::egui::{self, Label, RichText, Sense, Ui};

use crate::app::analysis::film_measures::FilmMeasures;
use crate::app::input::intent::Intent;
use crate::app::ui::kit::text::capitalised;
use crate::app::ui::kit::theme::ThemePalette;
use crate::app::ui::stage::check_row::row;
use crate::app::ui::ui_state::{Intents, UiState};
use crate::structure::{FilmStructure, NodeList, StabilityProof};

/// Hint that every row of the structure shows.
const CONCEPT_CHECK: &str = "A concept check: linear, without partial factors, and not a check by a \
    building code.";

/// Returns the number of rows.
pub fn count(measures: &FilmMeasures) -> usize {
    match &measures.structure {
        None => 0,
        Some(Err(_)) => 1,
        Some(Ok(structure)) => 1 + structure.findings.len(),
    }
}

/// Draws the rows.
pub fn show(ui: &mut Ui, state: &UiState, measures: &FilmMeasures, intents: &mut Intents) {
    match &measures.structure {
        None => {}
        Some(Err(error)) => row(ui, false, |ui| {
            ui.label(RichText::new(capitalised(&error.to_string())).small());
        }),
        Some(Ok(structure)) => {
            summary(ui, state, structure, intents);
            for finding in &structure.findings {
                let text = capitalised(&finding.fault.to_string());
                let tip = format!("{}\n{CONCEPT_CHECK}", capitalised(&finding.to_string()));
                link(ui, state, &text, &tip, finding.t, intents);
            }
        }
    }
}

/// Draws whether the structure stands at every moment.
fn summary(ui: &mut Ui, state: &UiState, structure: &FilmStructure, intents: &mut Intents) {
    let mut tip = format!(
        "Analysed at {} moments under all loads. {CONCEPT_CHECK}",
        structure.samples.len()
    );
    for note in &structure.notes {
        tip.push('\n');
        tip.push_str(&capitalised(note));
        tip.push('.');
    }
    let failure = structure
        .proof
        .as_ref()
        .and_then(|proof| Some((proof, proof.fails_at?)));
    if let Some((proof, t)) = failure {
        link(ui, state, &failure_text(proof), &tip, t, intents);
        return;
    }
    let stands = match &structure.proof {
        Some(_) => "stands at every moment, proved",
        None => "stands at the analysed moments",
    };
    let text = match structure.findings.len() {
        0 => format!("Sound structure: {stands}"),
        _ => format!("Structure: {stands}"),
    };
    row(ui, true, |ui| {
        ui.label(RichText::new(text).small()).on_hover_text(tip);
    });
}

/// Returns the text for a structure that is not proved to stand.
fn failure_text(proof: &StabilityProof) -> String {
    let nodes = NodeList(&proof.moving_nodes);
    match proof.is_mechanism {
        true => format!("Falls over: nothing holds {nodes}"),
        false => format!("May fall over; moves most easily at {nodes}"),
    }
}

/// Draws a row whose text moves the film to `t` when it is clicked.
fn link(ui: &mut Ui, state: &UiState, text: &str, tip: &str, t: f64, intents: &mut Intents) {
    row(ui, false, |ui| {
        let text = RichText::new(text)
            .small()
            .color(ThemePalette::of(ui).amber);
        let response = ui.add(Label::new(text).sense(Sense::click()).truncate());
        if response.hovered() {
            ui.ctx().set_cursor_icon(egui::CursorIcon::PointingHand);
        }
        if response.clicked() {
            intents.push(Intent::Seek(state.session.whole_t(t)));
        }
        response.on_hover_text(format!("{tip}\nClick to go there."));
    });
}
