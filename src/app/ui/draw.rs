//! Draws everything around the stage, once a frame.

use std::time::Duration;

use bevy::asset::AssetEventSystems;
use bevy::prelude::*;
use bevy_egui::{
    EguiContext, EguiContexts, EguiFullOutput, EguiInputSet, EguiPlugin, EguiPostUpdateSet,
    EguiPreUpdateSet, EguiPrimaryContextPass, egui,
};

use crate::app::input::gesture::{KeyboardFocus, TextSelected};
use crate::app::input::intent::Intent;
use crate::app::redraw_pace::PanelRepaint;
use crate::app::ui::kit::theme;
use crate::app::ui::overlays::{file_dialog, frame_times, help, notices, progress, questions};
use crate::app::ui::panels::inspector;
use crate::app::ui::stage::{
    area, checks, comparison, film_frame, map, map_toolbar, onion, presentation,
};
use crate::app::ui::timeline::{panel, plots};
use crate::app::ui::ui_state::{Intents, UiState};
use crate::app::ui::{gallery, match_editor, speaker, toolbar};
use crate::app::view::stage_area::StageArea;

/// Draws the panels with egui.
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
                    // After the events are there and before the pass that reads them.
                    .after(EguiInputSet::WriteEguiEvents)
                    .before(EguiPreUpdateSet::BeginPass),
            )
            .add_systems(PreUpdate, hush.after(EguiPreUpdateSet::InitContexts))
            // A letter that is new would be missing for a frame: the texture that it was put into
            // is sent to the renderer with the changes that are noted by then.
            .configure_sets(
                PostUpdate,
                EguiPostUpdateSet::PostProcessOutput.before(AssetEventSystems),
            )
            .add_observer(dress)
            .add_observer(speaker::join)
            .add_systems(speaker::SpeakerPass, speaker::draw)
            .add_systems(EguiPrimaryContextPass, draw)
            .init_resource::<PanelRepaint>()
            .add_systems(
                PostUpdate,
                note_repaint
                    .after(EguiPostUpdateSet::EndPass)
                    // Which takes the output away.
                    .before(EguiPostUpdateSet::ProcessOutput),
            );
    }
}

/// A window as wide as this has room for the gallery beside the match editor, and with the film in
/// it as wide as that.
const ROOMY: [f32; 2] = [1200.0, 1600.0];

/// Before the first frame that is drawn: a font is there from the next pass on only, and a family
/// that is not there makes egui panic.
fn dress(added: On<Add, EguiContext>, mut contexts: Query<&mut EguiContext>) -> Result {
    theme::install(contexts.get_mut(added.entity)?.get_mut());
    Ok(())
}

/// When the next frame comes is the pace's to say, which knows what the panels ask for by
/// [`note_repaint`]. They would also wake the window themselves, at work and at rest.
fn hush(mut contexts: Query<&mut EguiContext, Added<EguiContext>>) {
    for mut context in &mut contexts {
        context.get_mut().set_request_repaint_callback(|_| {});
    }
}

fn keep_keys_from_widgets(
    mut contexts: Query<&mut bevy_egui::EguiInput>,
    typing: Res<KeyboardFocus>,
    mut held: Local<egui::Modifiers>,
) {
    for mut input in &mut contexts {
        input.events.retain(|event| match event {
            egui::Event::Key { .. } | egui::Event::Text(_) => typing.0,
            // Told in each frame; and egui draws once more after whatever it is told of.
            egui::Event::ModifiersChanged(now) => std::mem::replace(&mut *held, *now) != *now,
            _ => true,
        });
    }
}

/// The panels say themselves when they move: a switch that slides, a tip that is about to come.
fn note_repaint(outputs: Query<&EguiFullOutput>, mut repaint: ResMut<PanelRepaint>) {
    let outputs = outputs.iter().filter_map(|output| output.0.as_ref());
    let delays = outputs.flat_map(|output| output.viewport_output.values());
    let soonest = delays.map(|viewport| viewport.repaint_delay).min();
    repaint.0 = soonest.unwrap_or(Duration::MAX);
}

fn draw(
    mut contexts: EguiContexts,
    scene: UiState,
    (mut textures, mut files): (
        ResMut<gallery::GalleryTextures>,
        ResMut<file_dialog::FileDialogState>,
    ),
    (mut typing, mut marked): (ResMut<KeyboardFocus>, ResMut<TextSelected>),
    mut area: ResMut<StageArea>,
    mut intents: MessageWriter<Intent>,
) -> Result {
    let ctx = contexts.ctx_mut()?.clone();
    theme::apply_theme(&ctx, scene.preferences.theme);
    let mut acts = Intents::new();
    let mut root = egui::Ui::new(
        ctx.clone(),
        "window".into(),
        egui::UiBuilder::new()
            .layer_id(egui::LayerId::background())
            .max_rect(ctx.viewport_rect()),
    );
    if scene.preferences.panels {
        panels(&mut root, &scene, &mut textures, &mut acts);
    }
    let stage = root.available_rect_before_wrap();
    let first = middle(&mut root, &scene, stage, &mut acts);
    overlays(&ctx, &scene, stage, &mut acts);
    file_dialog::show(&ctx, &scene, &mut files, &mut acts);
    area.set_if_neq(StageArea::from_points(first.left_top(), first.size()));
    typing.set_if_neq(KeyboardFocus(
        // A menu takes arrows and Esc for itself, and so does what asks for files.
        ctx.text_edit_focused() || egui::Popup::is_any_open(&ctx) || scene.dialog.asks().is_some(),
    ));
    let selection = ctx.plugin_or_default::<egui::text_selection::LabelSelectionState>();
    marked.set_if_neq(TextSelected(selection.lock().has_selection()));
    // Acted on in the next frame: the panels are drawn when the systems have run.
    intents.write_batch(acts);
    Ok(())
}

/// What the panels leave: the stage, a second method beside it, the map, or the match editor. Returns the
/// part that the stage takes.
fn middle(
    root: &mut egui::Ui,
    scene: &UiState,
    stage: egui::Rect,
    acts: &mut Intents,
) -> egui::Rect {
    if scene.presenting.is_on() {
        return presentation::show(root, scene, stage, acts);
    }
    if scene.editor.is_open {
        return match_editor::show(root, scene, stage, acts);
    }
    if scene.map.is_shown {
        return map::show(root, scene, stage, acts);
    }
    if scene.twin.is_shown {
        return comparison::show(root, scene, stage, acts);
    }
    area::show(root, stage, "stage", acts);
    if scene.preferences.panels {
        area::empty_hint(root, scene, stage);
        onion::show(root, scene, stage);
        checks::mark(root, scene, stage);
        film_frame::frame(root, scene, stage);
    }
    stage
}

fn panels(
    root: &mut egui::Ui,
    scene: &UiState,
    textures: &mut gallery::GalleryTextures,
    acts: &mut Intents,
) {
    toolbar::show(root, scene, acts);
    // Each takes its edge from what the ones before it have left: the timeline is as wide as the
    // window, the side panels stand between it and the toolbar.
    panel::show(root, scene, acts);
    if scene.preferences.plots {
        plots::show(root, scene, acts);
    }
    // Designs side by side need the room that the gallery takes in a small window.
    let roomy = ROOMY[usize::from(scene.editor.shows_film())];
    if !scene.editor.is_open || root.available_width() >= roomy {
        gallery::show(root, scene, textures, acts);
    }
    inspector::show(root, scene, acts);
    if scene.preferences.times {
        frame_times::strip(root, scene);
    }
    if !scene.editor.is_open {
        if scene.map.is_shown {
            map_toolbar::strip(root, scene, acts);
        } else {
            if scene.twin.is_shown {
                comparison::strip(root, scene, acts);
            }
            checks::strip(root, scene, acts);
        }
    }
}

fn overlays(ctx: &egui::Context, scene: &UiState, stage: egui::Rect, acts: &mut Intents) {
    if scene.editor.is_open {
        match_editor::overlay(ctx, scene, stage, acts);
    }
    // An audience sees the drawing: what there is to tell waits until the panels are back.
    if scene.preferences.panels {
        told(ctx, scene, stage, acts);
    }
    // These were just asked for, by a key or by closing.
    if scene.preferences.help {
        help::show(ctx, scene, acts);
    }
    if !scene.presenting.is_on() {
        questions::show(ctx, scene, acts);
    }
}

/// What the program has to tell of itself.
fn told(ctx: &egui::Context, scene: &UiState, stage: egui::Rect, acts: &mut Intents) {
    // What is left in the middle for messages: each layer takes its height from it.
    let mut below = stage;
    if scene.editor.is_open {
        below.min.y += match_editor::BAR_HEIGHT;
    }
    progress::show(ctx, scene, below, acts);
    if scene.editor.is_open {
        below.max.y -= match_editor::ADVICE_HEIGHT;
    }
    notices::show(ctx, scene, below, acts);
}

impl StageArea {
    fn from_points(corner: egui::Pos2, size: egui::Vec2) -> Self {
        Self {
            corner: Vec2::new(corner.x, corner.y),
            size: Vec2::new(size.x, size.y),
        }
    }
}
