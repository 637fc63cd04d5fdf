//! Plugin that draws the whole user interface with egui in each frame, and reports the stage's
//! rectangle, the keyboard focus and the user's intents to the other systems.

use std::time::Duration;

use bevy::asset::AssetEventSystems;
use bevy::ecs::system::SystemParam;
use bevy::prelude::*;
use bevy_egui::{
    EguiContext, EguiContexts, EguiFullOutput, EguiInputSet, EguiPlugin, EguiPostUpdateSet,
    EguiPreUpdateSet, EguiPrimaryContextPass, egui,
};

use crate::app::input::gesture::{KeyboardFocus, TextSelected};
use crate::app::input::intent::Intent;
use crate::app::redraw_pace::PanelRepaint;
use crate::app::stage_area::StageArea;
use crate::app::ui::kit::theme;
use crate::app::ui::overlays::{file_dialog, frame_times, help, notices, progress, questions};
use crate::app::ui::panels::inspector;
use crate::app::ui::stage::{
    area, checks, comparison, film_frame, invitation, map, map_toolbar, onion, presentation,
};
use crate::app::ui::timeline::{panel, plots};
use crate::app::ui::ui_state::{Intents, UiState};
use crate::app::ui::{gallery, match_editor, speaker, toolbar};

/// Bevy plugin that draws the user interface with egui.
#[derive(Debug)]
pub struct UiPlugin;

impl Plugin for UiPlugin {
    fn build(&self, app: &mut App) {
        app.add_plugins(EguiPlugin::default())
            .init_resource::<gallery::GalleryTextures>()
            .init_resource::<file_dialog::FileDialogState>()
            .add_systems(
                PreUpdate,
                keep_keys_from_widgets
                    // Key events must be removed after they are collected, and before the egui pass
                    // that reads them.
                    .after(EguiInputSet::WriteEguiEvents)
                    .before(EguiPreUpdateSet::BeginPass),
            )
            .add_systems(
                PreUpdate,
                silence_repaints.after(EguiPreUpdateSet::InitContexts),
            )
            // egui adds the textures of new glyphs to Bevy's assets. This must happen before Bevy
            // sends the asset events of the frame. Otherwise a new glyph would be missing for one
            // frame.
            .configure_sets(
                PostUpdate,
                EguiPostUpdateSet::PostProcessOutput.before(AssetEventSystems),
            )
            .add_observer(install_theme)
            .add_observer(speaker::join)
            .add_systems(speaker::SpeakerPass, speaker::draw)
            .add_systems(EguiPrimaryContextPass, draw)
            .init_resource::<PanelRepaint>()
            .add_systems(
                PostUpdate,
                record_repaint
                    .after(EguiPostUpdateSet::EndPass)
                    // `ProcessOutput` consumes the output that `record_repaint` reads.
                    .before(EguiPostUpdateSet::ProcessOutput),
            );
    }
}

/// Minimum width of the window, in points, at which the gallery is shown next to the stage
/// (heuristic).
const MIN_WIDTH_WITH_GALLERY: f32 = 880.0;

/// Minimum widths of the window, in points, at which the gallery is shown next to the match editor:
/// without and with the editor's film pane.
const MIN_EDITOR_WIDTH_WITH_GALLERY: [f32; 2] = [1200.0, 1600.0];

/// Installs themes and fonts when an egui context is created. They must be installed before the
/// first frame, because egui panics on a font family that it does not know.
fn install_theme(added: On<Add, EguiContext>, mut contexts: Query<&mut EguiContext>) -> Result {
    theme::install(contexts.get_mut(added.entity)?.get_mut());
    Ok(())
}

/// Stops egui from waking the window by itself. Only the app's redraw pace decides when the next
/// frame is drawn; [`record_repaint`] passes egui's requests on to it.
fn silence_repaints(mut contexts: Query<&mut EguiContext, Added<EguiContext>>) {
    for mut context in &mut contexts {
        context.get_mut().set_request_repaint_callback(|_| {});
    }
}

/// Removes key events from egui's input unless a text field, a menu or the file dialog receives all
/// keys, so that shortcuts do not act on widgets as well.
fn keep_keys_from_widgets(
    mut contexts: Query<&mut bevy_egui::EguiInput>,
    typing: Res<KeyboardFocus>,
    mut modifiers: Local<egui::Modifiers>,
) {
    for mut input in &mut contexts {
        input.events.retain(|event| match event {
            egui::Event::Key { .. } | egui::Event::Text(_) => typing.0,
            // This event arrives in every frame, and egui repaints after each event. Only changes
            // are passed on; otherwise the window would never stop redrawing.
            egui::Event::ModifiersChanged(now) => std::mem::replace(&mut *modifiers, *now) != *now,
            _ => true,
        });
    }
}

/// Records how soon egui wants the panels to be drawn again, for example while a switch slides.
fn record_repaint(outputs: Query<&EguiFullOutput>, mut repaint: ResMut<PanelRepaint>) {
    let outputs = outputs.iter().filter_map(|output| output.0.as_ref());
    let delays = outputs.flat_map(|output| output.viewport_output.values());
    let soonest = delays.map(|viewport| viewport.repaint_delay).min();
    repaint.0 = soonest.unwrap_or(Duration::MAX);
}

/// Resources and messages by which the user interface reports to the other systems.
#[derive(SystemParam)]
struct UiOutputs<'w> {
    /// Set while a text field, a menu or the file dialog receives all keys.
    typing: ResMut<'w, KeyboardFocus>,
    /// Set while text of a notice is selected.
    text_selected: ResMut<'w, TextSelected>,
    /// Set to the rectangle of the stage in the window.
    area: ResMut<'w, StageArea>,
    /// Receives the intents that the user triggered in this frame.
    intents: MessageWriter<'w, Intent>,
}

/// Draws panels, stage overlays and dialogs, and sends the intents that they produce.
fn draw(
    mut contexts: EguiContexts,
    state: UiState,
    mut textures: ResMut<gallery::GalleryTextures>,
    mut files: ResMut<file_dialog::FileDialogState>,
    mut outputs: UiOutputs,
) -> Result {
    let ctx = contexts.ctx_mut()?.clone();
    theme::apply_theme(&ctx, state.preferences.theme);
    let mut intents = Intents::new();
    let mut root = egui::Ui::new(
        ctx.clone(),
        "window".into(),
        egui::UiBuilder::new()
            .layer_id(egui::LayerId::background())
            .max_rect(ctx.viewport_rect()),
    );
    if state.preferences.panels {
        panels(&mut root, &state, &mut textures, &mut intents);
    }
    let stage = root.available_rect_before_wrap();
    let visible = stage_content(&mut root, &state, stage, &mut intents);
    let question = overlays(&ctx, &state, stage, &mut intents);
    let file_dialog = file_dialog::show(&ctx, &state, &mut files, &mut intents);
    if state.preferences.panels {
        // Progress and notices are hidden together with the panels, so that only the drawing is
        // visible. They appear again with the panels.
        messages(&ctx, &state, stage, question.or(file_dialog), &mut intents);
    }
    outputs
        .area
        .set_if_neq(StageArea::from_points(visible.left_top(), visible.size()));
    outputs.typing.set_if_neq(KeyboardFocus(
        // Menus and the file dialog handle arrow keys and Escape themselves.
        ctx.text_edit_focused()
            || egui::Popup::is_any_open(&ctx)
            || state.dialog.purpose().is_some(),
    ));
    let selection = ctx.plugin_or_default::<egui::text_selection::LabelSelectionState>();
    outputs
        .text_selected
        .set_if_neq(TextSelected(selection.lock().has_selection()));
    // The intents are handled in the next frame, because the panels are drawn after the systems
    // have run.
    outputs.intents.write_batch(intents);
    Ok(())
}

/// Draws the content of the space between the panels: the presentation, the match editor, the map,
/// the comparison, or the overlays of the stage.
///
/// Returns the rectangle in which the stage is visible.
fn stage_content(
    root: &mut egui::Ui,
    state: &UiState,
    stage: egui::Rect,
    intents: &mut Intents,
) -> egui::Rect {
    if state.presentation.is_active() {
        return presentation::show(root, state, stage, intents);
    }
    if state.editor.is_open {
        return match_editor::show(root, state, stage, intents);
    }
    if state.map.is_shown {
        return map::show(root, state, stage, intents);
    }
    if state.comparison.is_shown {
        return comparison::show(root, state, stage, intents);
    }
    area::show(root, stage, "stage", intents);
    if state.preferences.panels {
        area::empty_hint(root, state, stage);
        onion::show(root, state, stage);
        checks::mark(root, state, stage);
        film_frame::frame(root, state, stage);
    }
    stage
}

fn panels(
    root: &mut egui::Ui,
    state: &UiState,
    textures: &mut gallery::GalleryTextures,
    intents: &mut Intents,
) {
    toolbar::show(root, state, intents);
    // Each panel takes its space from the remaining rectangle, so the order determines the layout:
    // the timeline is as wide as the window, and the side panels lie between it and the toolbar.
    panel::show(root, state, intents);
    if state.preferences.plots {
        plots::show(root, state, intents);
    }
    // In a small window the gallery would leave too little space for the stage or the match editor.
    let min_width = match state.editor.is_open {
        true => MIN_EDITOR_WIDTH_WITH_GALLERY[usize::from(state.editor.shows_film())],
        false => MIN_WIDTH_WITH_GALLERY,
    };
    if root.available_width() >= min_width {
        gallery::show(root, state, textures, intents);
    }
    inspector::show(root, state, intents);
    if state.preferences.times {
        frame_times::strip(root, state);
    }
    if !state.editor.is_open {
        if state.map.is_shown {
            map_toolbar::strip(root, state, intents);
        } else {
            if state.comparison.is_shown {
                comparison::strip(root, state, intents);
            }
            checks::strip(root, state, intents);
        }
    }
    invitation::show(root, state, textures, intents);
}

/// Draws the overlay of the match editor, the list of keys and the question that waits for an
/// answer. Returns the rectangle of the topmost dialog, if one is open.
fn overlays(
    ctx: &egui::Context,
    state: &UiState,
    stage: egui::Rect,
    intents: &mut Intents,
) -> Option<egui::Rect> {
    if state.editor.is_open {
        match_editor::overlay(ctx, state, stage, intents);
    }
    // Help and questions are shown even if the panels are hidden, because an action of the user has
    // just opened them.
    let help = state
        .preferences
        .help
        .then(|| help::show(ctx, state, intents));
    let question = match state.presentation.is_active() {
        true => None,
        false => questions::show(ctx, state, intents),
    };
    question.or(help)
}

/// Draws the progress of background jobs and the notices. `dialog` is the rectangle of the open
/// dialog, which notices must not cover.
fn messages(
    ctx: &egui::Context,
    state: &UiState,
    stage: egui::Rect,
    dialog: Option<egui::Rect>,
    intents: &mut Intents,
) {
    // Progress cards must not cover the toolbar of the match editor. Notices must cover neither the
    // toolbar nor the instructions of the match editor.
    let mut free = stage;
    if state.editor.is_open {
        free.min.y += match_editor::BAR_HEIGHT;
    }
    progress::show(ctx, state, free, intents);
    if state.editor.is_open {
        free.max.y -= match_editor::INSTRUCTIONS_HEIGHT;
    }
    let place = dialog.map_or_else(
        || notices::NoticePlace::on_stage(free),
        |dialog| notices::NoticePlace::next_to_dialog(dialog, ctx.content_rect()),
    );
    notices::show(ctx, state, &place, intents);
}

impl StageArea {
    /// Converts a rectangle in egui's points, given by its upper left corner and its size.
    fn from_points(corner: egui::Pos2, size: egui::Vec2) -> Self {
        Self {
            corner: Vec2::new(corner.x, corner.y),
            size: Vec2::new(size.x, size.y),
        }
    }
}
