//! What is drawn, and in which colours.

use bevy_egui::egui::{DragValue, Response, Ui};

use crate::app::asking::intent::Intent;
use crate::app::ui::kit::widgets::{choice, number, row, section, toggle};
use crate::app::ui::scene::{Intents, Scene};
use crate::content::ContentKind;
use crate::project::Project;
use crate::transition::Rgb;
use crate::warp::WarpKind;

/// Draws the options.
pub fn show(ui: &mut Ui, scene: &Scene, draft: &mut Project, acts: &mut Intents) {
    section(ui, "Appearance", |ui| {
        layers(ui, scene, draft, acts);
        colour(
            ui,
            "Source",
            "Colour of the shape at t = 0.",
            &mut draft.style.source,
        );
        colour(
            ui,
            "Target",
            "Colour of the shape at t = 1.",
            &mut draft.style.target,
        );
        colour(
            ui,
            "Ground",
            "Colour behind the shape, on screen and in pictures.",
            &mut draft.style.ground,
        );
        if scene.session.has_bars() {
            bars(ui, draft);
        }
    });
}

fn layers(ui: &mut Ui, scene: &Scene, draft: &Project, acts: &mut Intents) {
    let mut show = scene.preferences.show;
    let is_field = draft.content == Some(ContentKind::Field);
    let layer = |ui: &mut Ui, on: &mut bool, name: &str, tip: &str, applies: bool| {
        ui.add_enabled_ui(applies, |ui| {
            let size = bevy_egui::egui::vec2(ui.available_width(), 24.0);
            let response: Response = choice(ui, *on && applies, name, size);
            if response.clicked() {
                *on = !*on;
            }
            response.on_hover_text(tip).on_disabled_hover_text(tip);
        });
    };
    ui.spacing_mut().item_spacing = bevy_egui::egui::vec2(4.0, 4.0);
    ui.columns(3, |columns| {
        layer(
            &mut columns[0],
            &mut show.fill,
            "Fill",
            "The shape itself.",
            true,
        );
        layer(
            &mut columns[1],
            &mut show.ghosts,
            "Ghosts",
            "Thin outlines of source and target.",
            true,
        );
        let bars = scene.session.has_bars();
        layer(
            &mut columns[2],
            &mut show.bars,
            "Bars",
            "Bars and joints of a truss.",
            bars && !is_field,
        );
        layer(
            &mut columns[0],
            &mut show.wireframe,
            "Wireframe",
            "The edges of the triangles that carry the motion.",
            !is_field,
        );
        layer(
            &mut columns[1],
            &mut show.iso_lines,
            "Iso-lines",
            "Lines of equal blended distance.",
            is_field,
        );
        layer(
            &mut columns[2],
            &mut show.signed_colours,
            "Signed",
            "The blended field in two hues: inside and outside.",
            is_field,
        );
        layer(
            &mut columns[0],
            &mut show.grid,
            "Grid",
            "A square grid of the source, where the warp carries it (W).",
            draft.warp != Some(WarpKind::Paths),
        );
    });
    ui.spacing_mut().item_spacing = bevy_egui::egui::vec2(8.0, 8.0);
    if show != scene.preferences.show {
        acts.push(Intent::Show(show));
    }
}

fn colour(ui: &mut Ui, label: &str, tip: &str, value: &mut Rgb) {
    row(ui, label, tip, |ui| ui.color_edit_button_srgb(&mut value.0));
}

fn bars(ui: &mut Ui, draft: &mut Project) {
    let width = DragValue::new(&mut draft.options.bar_width)
        .speed(0.0002)
        .range(0.001..=0.2)
        .max_decimals(4);
    number(
        ui,
        "Bar width",
        "Thickness of the bars, as a part of the design's size; also of the shape that its field is made from.",
        width,
    );
    toggle(
        ui,
        "Joints",
        "Draws a disc where bars meet.",
        &mut draft.style.joints,
    );
}
