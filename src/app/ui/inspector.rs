//! The panel on the right: everything that can be set about the transition.
//!
//! Its parts change a copy of the project; where the copy came out different it is sent as one
//! intent.

use bevy_egui::egui::{self, Margin, Panel, ScrollArea, Ui};

use super::theme::{GRID, Palette};
use super::{
    Intents, Scene, appearance_panel, colours_panel, designs_panel, field_panel, lattice_panel,
    lines_panel, match_panel, method_panel, paths_panel, scattered_panel, travel_panel, warp_panel,
};
use crate::app::intent::Intent;
use crate::content::ContentKind;
use crate::warp::WarpKind;

const WIDTH: f32 = 328.0;

/// Draws the panel.
pub fn show(root: &mut Ui, scene: &Scene, acts: &mut Intents) {
    let frame = egui::Frame::new()
        .fill(Palette::of(root).panel)
        .inner_margin(Margin {
            left: 16,
            right: 8,
            top: 0,
            bottom: 0,
        });
    Panel::right("inspector")
        .exact_size(WIDTH)
        .resizable(false)
        .frame(frame)
        .show(root, |ui| {
            ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
                ui.set_width(WIDTH - 40.0);
                sections(ui, scene, acts);
                ui.add_space(2.0 * GRID);
            });
        });
}

fn sections(ui: &mut Ui, scene: &Scene, acts: &mut Intents) {
    let Some(project) = scene.session.project() else {
        return;
    };
    method_panel::show(ui, scene, project, acts);
    let mut draft = project.clone();
    if scene.session.can_match() && draft.warp != Some(WarpKind::None) {
        match_panel::show(ui, scene, &mut draft, acts);
    }
    if draft.warp == Some(WarpKind::Arap) {
        warp_panel::show(ui, scene, &mut draft.options.arap);
    }
    let carries_fields =
        draft.warp == Some(WarpKind::Arap) && draft.content == Some(ContentKind::Field);
    if carries_fields || draft.warp.is_some_and(WarpKind::is_of_the_plane) {
        travel_panel::show(ui, &mut draft.options.travel);
    }
    match draft.warp {
        Some(WarpKind::Paths) => paths_panel::show(ui, &mut draft.options.paths),
        Some(WarpKind::Lines) => lines_panel::show(ui, &mut draft.options.lines),
        Some(WarpKind::Scattered) => scattered_panel::show(ui, &mut draft.options.scattered),
        Some(WarpKind::Lattice) => lattice_panel::show(ui, &mut draft.options.lattice),
        Some(WarpKind::None | WarpKind::Arap) | None => {}
    }
    match draft.content {
        Some(ContentKind::Field) => field_panel::show(ui, &mut draft.options.field),
        Some(ContentKind::Colours) => colours_panel::show(ui, &mut draft.options.colours),
        Some(ContentKind::Solid) | None => {}
    }
    designs_panel::show(ui, &mut draft, acts);
    appearance_panel::show(ui, scene, &mut draft, acts);
    if draft != *project {
        acts.push(Intent::Edit(Box::new(draft)));
    }
}
