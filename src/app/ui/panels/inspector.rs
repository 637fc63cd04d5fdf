//! Inspector: the panel on the right with all settings of the transition, or the export settings in
//! their place. Chooses the sections that apply to the project.
//!
//! The sections edit a copy of the project's settings. If the user has changed the copy, it is sent
//! as one intent.

use bevy_egui::egui::{Panel, ScrollArea, Ui};

use crate::app::input::intent::Intent;
use crate::app::ui::kit::theme::GRID;
use crate::app::ui::kit::widgets::panel_frame;
use crate::app::ui::panels::{
    appearance, content, designs, export, map, matching, method, part_timing, rigid_motion, warps,
};
use crate::app::ui::ui_state::{Intents, UiState};
use crate::content::ContentKind;
use crate::warp::WarpKind;

/// Width of the inspector, in points.
const WIDTH: f32 = 328.0;

/// Draws the inspector with the settings of the transition or of the export.
pub fn show(root: &mut Ui, state: &UiState, intents: &mut Intents) {
    let frame = panel_frame(root, [16, 8, 0, 0]);
    Panel::right("inspector")
        .exact_size(WIDTH)
        .resizable(false)
        .frame(frame)
        .show(root, |ui| {
            if state.preferences.film_options {
                export::foot(ui, state, intents);
            }
            ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
                ui.set_width(WIDTH - 40.0);
                match state.preferences.film_options {
                    true => export::show(ui, state, intents),
                    false => sections(ui, state, intents),
                }
                ui.add_space(2.0 * GRID);
            });
        });
}

fn sections(ui: &mut Ui, state: &UiState, intents: &mut Intents) {
    let Some(project) = state.session.project() else {
        return;
    };
    if state.map.is_shown {
        map::show(ui, state, intents);
    }
    // The method is not changed in `draft`. A new method is sent as a separate intent.
    method::show(ui, state, project, intents);
    let mut draft = project.clone();
    if state.session.has_match_editor() && draft.warp != Some(WarpKind::None) {
        matching::show(ui, state, &mut draft, intents);
    }
    // A film along a path blends all designs, but the options of rigid motion and part timing apply
    // only to two designs.
    let is_pair = !draft.follows_path();
    if draft.warp == Some(WarpKind::Arap) && is_pair {
        rigid_motion::show(ui, state, &mut draft.options.arap);
    }
    let is_solid = draft.content == Some(ContentKind::Solid);
    if draft.warp == Some(WarpKind::Arap) && is_solid && is_pair {
        part_timing::show(ui, state, &mut draft.options.parts);
    }
    let carries_fields =
        draft.warp == Some(WarpKind::Arap) && draft.content == Some(ContentKind::Field);
    if carries_fields || draft.warp.is_some_and(WarpKind::is_plane_warp) {
        warps::travel(ui, &mut draft.options.travel);
    }
    match draft.warp {
        Some(WarpKind::Paths) => warps::paths(ui, &mut draft.options.paths),
        Some(WarpKind::Lines) => warps::lines(ui, &mut draft.options.lines),
        Some(WarpKind::Scattered) => warps::scattered(ui, &mut draft.options.scattered),
        Some(WarpKind::Lattice) => warps::lattice(ui, &mut draft.options.lattice),
        Some(WarpKind::None | WarpKind::Arap) | None => {}
    }
    match draft.content {
        Some(ContentKind::Field) => content::field(ui, &mut draft.options.field),
        Some(ContentKind::Colours) => content::colours(ui, &mut draft.options.colours),
        Some(ContentKind::Solid) | None => {}
    }
    designs::show(ui, state, &mut draft, intents);
    appearance::show(ui, state, &mut draft, intents);
    // All sections share one intent, so that each change by the user is one undo step.
    if draft != *project {
        intents.push(Intent::ReplaceSettings(Box::new(draft)));
    }
}
