//! The panel on the right: everything that can be set about the transition.
//!
//! Its parts change a copy of the project; where the copy came out different it is sent as one
//! intent.

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

const WIDTH: f32 = 328.0;

/// Draws the panel.
pub fn show(root: &mut Ui, scene: &UiState, acts: &mut Intents) {
    let frame = panel_frame(root, [16, 8, 0, 0]);
    Panel::right("inspector")
        .exact_size(WIDTH)
        .resizable(false)
        .frame(frame)
        .show(root, |ui| {
            if scene.preferences.film_options {
                export::foot(ui, scene, acts);
            }
            ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
                ui.set_width(WIDTH - 40.0);
                match scene.preferences.film_options {
                    true => export::show(ui, scene, acts),
                    false => sections(ui, scene, acts),
                }
                ui.add_space(2.0 * GRID);
            });
        });
}

fn sections(ui: &mut Ui, scene: &UiState, acts: &mut Intents) {
    let Some(project) = scene.session.project() else {
        return;
    };
    if scene.map.is_shown {
        map::show(ui, scene, acts);
    }
    // Not of the copy: another method is an intent of its own, which keys send too.
    method::show(ui, scene, project, acts);
    let mut draft = project.clone();
    if scene.session.can_match() && draft.warp != Some(WarpKind::None) {
        matching::show(ui, scene, &mut draft, acts);
    }
    // Of many designs the local maps have one way.
    let is_pair = !draft.follows_path();
    if draft.warp == Some(WarpKind::Arap) && is_pair {
        rigid_motion::show(ui, scene, &mut draft.options.arap);
    }
    let is_solid = draft.content == Some(ContentKind::Solid);
    if draft.warp == Some(WarpKind::Arap) && is_solid && is_pair {
        part_timing::show(ui, scene, &mut draft.options.parts);
    }
    let carries_fields =
        draft.warp == Some(WarpKind::Arap) && draft.content == Some(ContentKind::Field);
    if carries_fields || draft.warp.is_some_and(WarpKind::is_of_the_plane) {
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
    designs::show(ui, scene, &mut draft, acts);
    appearance::show(ui, scene, &mut draft, acts);
    // One intent for all, so that one movement of the hand is one step of the history.
    if draft != *project {
        acts.push(Intent::Edit(Box::new(draft)));
    }
}
