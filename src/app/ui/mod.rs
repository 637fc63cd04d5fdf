//! What is drawn around the stage. egui is named here and in the files below, nowhere else.
//!
//! Panels read a [`Scene`] and push [`Intent`]s; they compute nothing and change nothing. While
//! no text is being written egui gets no keys at all, so Space and the arrows cannot drive a
//! widget and the playback at once.

mod appearance_panel;
mod colours_panel;
mod designs_panel;
mod field_panel;
mod gallery_panel;
mod help;
mod icons;
mod inspector;
mod lattice_panel;
mod lines_panel;
mod match_editor;
mod match_panel;
mod method_panel;
mod notices;
mod paths_panel;
mod plots;
mod questions;
mod scattered_panel;
mod stage_area;
mod theme;
mod timeline;
mod times;
mod toolbar;
mod track;
mod transport;
mod travel_panel;
mod twin_area;
mod verdict;
mod warp_panel;
mod widgets;
mod work;

use bevy::ecs::system::SystemParam;
use bevy::prelude::*;
use bevy_egui::{
    EguiContexts, EguiInputSet, EguiPlugin, EguiPreUpdateSet, EguiPrimaryContextPass, egui,
};

use crate::app::closing::Question;
use crate::app::dialogs::Drop;
use crate::app::editor::{Editor, Sheet};
use crate::app::intent::Intent;
use crate::app::keymap::{KeyMap, Typing};
use crate::app::measuring::Measured;
use crate::app::notices::Notices;
use crate::app::opening::Gallery;
use crate::app::playback::Playback;
use crate::app::preferences::Preferences;
use crate::app::record::Recorder;
use crate::app::session::Session;
use crate::app::thumbnails::Thumbnails;
use crate::app::times::WholeFrame;
use crate::app::twin::Twin;
use crate::app::view::StageArea;
use crate::stage::{FrameTimes, StageView};

/// Draws the panels with egui.
#[derive(Debug)]
pub struct UiPlugin;

impl Plugin for UiPlugin {
    fn build(&self, app: &mut App) {
        app.add_plugins(EguiPlugin::default())
            .init_resource::<gallery_panel::Textures>()
            .add_systems(
                PreUpdate,
                keep_keys_from_widgets
                    .after(EguiInputSet::WriteEguiEvents)
                    .before(EguiPreUpdateSet::BeginPass),
            )
            .add_systems(EguiPrimaryContextPass, draw);
    }
}

/// Everything that the panels show.
#[derive(SystemParam)]
struct Scene<'w> {
    session: Res<'w, Session>,
    editor: Res<'w, Editor>,
    sheet: Res<'w, Sheet>,
    measured: Res<'w, Measured>,
    twin: Res<'w, Twin>,
    view: Res<'w, StageView>,
    gallery: Res<'w, Gallery>,
    playback: Res<'w, Playback>,
    preferences: Res<'w, Preferences>,
    notices: Res<'w, Notices>,
    thumbnails: Res<'w, Thumbnails>,
    recorder: Res<'w, Recorder>,
    question: Res<'w, Question>,
    drop: Res<'w, Drop>,
    keys: Res<'w, KeyMap>,
    times: Res<'w, FrameTimes>,
    whole: Res<'w, WholeFrame>,
}

/// A window as wide as this has room for the gallery beside the match editor.
const ROOMY: f32 = 1200.0;

/// What the user does this frame.
type Intents = Vec<Intent>;

fn keep_keys_from_widgets(mut contexts: Query<&mut bevy_egui::EguiInput>, typing: Res<Typing>) {
    if typing.0 {
        return;
    }
    for mut input in &mut contexts {
        input
            .events
            .retain(|event| !matches!(event, egui::Event::Key { .. } | egui::Event::Text(_)));
    }
}

fn draw(
    mut contexts: EguiContexts,
    scene: Scene,
    mut textures: ResMut<gallery_panel::Textures>,
    mut typing: ResMut<Typing>,
    mut area: ResMut<StageArea>,
    mut intents: MessageWriter<Intent>,
    mut is_dressed: Local<bool>,
) -> Result {
    let ctx = contexts.ctx_mut()?.clone();
    if !*is_dressed {
        theme::install(&ctx);
        *is_dressed = true;
    }
    theme::choose(&ctx, scene.preferences.theme);
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
    area.set_if_neq(StageArea::from_points(first.left_top(), first.size()));
    typing.set_if_neq(Typing(
        ctx.text_edit_focused() || egui::Popup::is_any_open(&ctx),
    ));
    intents.write_batch(acts);
    Ok(())
}

/// What the panels leave: the stage, a second method beside it, or the match editor. Returns the
/// part that the stage takes.
fn middle(root: &mut egui::Ui, scene: &Scene, stage: egui::Rect, acts: &mut Intents) -> egui::Rect {
    if scene.editor.is_open {
        match_editor::show(root, scene, stage, acts);
        return stage;
    }
    if scene.twin.is_shown {
        return twin_area::show(root, scene, stage, acts);
    }
    stage_area::show(root, scene, stage, "stage", acts);
    verdict::mark(root, scene, stage);
    stage
}

fn panels(
    root: &mut egui::Ui,
    scene: &Scene,
    textures: &mut gallery_panel::Textures,
    acts: &mut Intents,
) {
    toolbar::show(root, scene, acts);
    timeline::show(root, scene, acts);
    if scene.preferences.plots {
        plots::show(root, scene, acts);
    }
    // Two designs side by side need the room that the gallery takes in a small window.
    if !scene.editor.is_open || root.available_width() >= ROOMY {
        gallery_panel::show(root, scene, textures, acts);
    }
    inspector::show(root, scene, acts);
}

fn overlays(ctx: &egui::Context, scene: &Scene, stage: egui::Rect, acts: &mut Intents) {
    let mut below = stage;
    if scene.editor.is_open {
        match_editor::overlay(ctx, scene, stage, acts);
        below.min.y += match_editor::BAR_HEIGHT;
    }
    work::show(ctx, scene, below, acts);
    if scene.editor.is_open {
        below.max.y -= match_editor::ADVICE_HEIGHT;
    } else {
        verdict::show(ctx, scene, stage, acts);
        below.max.y -= verdict::height(scene);
    }
    notices::show(ctx, scene, below, acts);
    if scene.preferences.times {
        times::show(ctx, scene, stage);
    }
    if scene.preferences.help {
        help::show(ctx, scene, acts);
    }
    questions::show(ctx, scene, acts);
}

impl StageArea {
    fn from_points(corner: egui::Pos2, size: egui::Vec2) -> Self {
        Self {
            corner: Vec2::new(corner.x, corner.y),
            size: Vec2::new(size.x, size.y),
        }
    }
}
