//! What is drawn, and in which colours.

use bevy_egui::egui::{Ui, vec2};

use crate::app::input::intent::Intent;
use crate::app::input::preferences::Preferences;
use crate::app::ui::kit::widgets::{
    choice, choice_row, drag, number, row, section, slider, toggle, with_tooltip,
};
use crate::app::ui::ui_state::{Intents, UiState};
use crate::colour::Rgb;
use crate::content::ContentKind;
use crate::project::Project;
use crate::stage::StageVisibility;
use crate::transition::{PaintLayerOptions, PaintRule};
use crate::warp::WarpKind;

/// Draws the options.
pub fn show(ui: &mut Ui, scene: &UiState, draft: &mut Project, acts: &mut Intents) {
    section(ui, "Appearance", |ui| {
        layers(ui, scene, draft, acts);
        if scene.session.has_paints() {
            let tip = "Whether drawings keep their own colours.";
            choice_row(ui, "Colours", tip, &mut draft.options.paint);
            if draft.options.paint == PaintRule::Own && draft.content != Some(ContentKind::Colours)
            {
                coats(ui, &mut draft.options.coats);
            }
        }
        let tip = "Colour of the shape at t = 0.";
        colour(ui, "Source", tip, &mut draft.style.source);
        let tip = "Colour of the shape at t = 1.";
        colour(ui, "Target", tip, &mut draft.style.target);
        let tip = "Colour behind the shape, on screen and in pictures.";
        colour(ui, "Ground", tip, &mut draft.style.ground);
        if scene.session.has_bars() {
            bars(ui, draft);
        }
    });
}

/// How painted parts come and go.
fn coats(ui: &mut Ui, coats: &mut PaintLayerOptions) {
    let tip = "What only one drawing has fades in or out, besides growing or shrinking.";
    toggle(ui, "Fade parts", tip, &mut coats.fade);
    let tip =
        "The t at which parts change places that lie over each other otherwise in the target.";
    slider(
        ui,
        "Swap order at",
        tip,
        &mut coats.reorder_at,
        0.0..=1.0,
        false,
    );
}

const EQUAL: &str = "Lines of equal blended distance.";

/// One layer: whether it is on, its name, what it shows, and whether there is any.
type LayerToggle<'a> = (&'a mut bool, &'static str, &'static str, bool);

fn table<'a>(
    scene: &UiState,
    project: &Project,
    (show, onion): (&'a mut StageVisibility, &'a mut bool),
) -> [LayerToggle<'a>; 8] {
    let is_field = project.content == Some(ContentKind::Field);
    // A field is of the area that the bars cover, and knows of no bars.
    let has_bars = scene.session.has_bars() && !is_field;
    // Boundary paths move outlines and nothing between them.
    let has_grid = project.warp != Some(WarpKind::Paths);
    [
        (&mut show.fill, "Fill", "The shape itself.", true),
        (
            &mut show.ghosts,
            "Ghosts",
            "Thin outlines of source and target.",
            true,
        ),
        (
            onion,
            "Onion",
            "Onion skins: thin outlines of the film at its stops (O).",
            true,
        ),
        (
            &mut show.bars,
            "Bars",
            "Bars and joints of a truss.",
            has_bars,
        ),
        (
            &mut show.wireframe,
            "Wireframe",
            "The edges of the triangles that carry the motion.",
            !is_field,
        ),
        (&mut show.iso_lines, "Contours", EQUAL, is_field),
        (
            &mut show.signed_colours,
            "Signed",
            "The blended field in two hues: inside and outside.",
            is_field,
        ),
        (
            &mut show.grid,
            "Grid",
            "A square grid of the source, where the warp carries it (W).",
            has_grid,
        ),
    ]
}

/// Nothing of the project is shown.
pub fn is_blank(scene: &UiState) -> bool {
    let (mut show, mut onion) = (scene.preferences.show, false);
    let project = scene.session.project();
    project.is_some_and(|project| {
        let layers = table(scene, project, (&mut show, &mut onion));
        !layers.into_iter().any(|(on, .., applies)| *on && applies)
    })
}

fn layers(ui: &mut Ui, scene: &UiState, draft: &Project, acts: &mut Intents) {
    let mut preferences = *scene.preferences;
    let Preferences { show, onion, .. } = &mut preferences;
    let layers = table(scene, draft, (show, onion));
    ui.scope(|ui| {
        ui.spacing_mut().item_spacing = vec2(4.0, 4.0);
        ui.columns(3, |columns| {
            for (k, (on, name, tip, applies)) in layers.into_iter().enumerate() {
                layer(&mut columns[k % 3], on, name, tip, applies);
            }
        });
    });
    if preferences != *scene.preferences {
        acts.push(Intent::Prefer(preferences));
    }
}

fn layer(ui: &mut Ui, on: &mut bool, name: &str, tip: &str, applies: bool) {
    ui.add_enabled_ui(applies, |ui| {
        let size = vec2(ui.available_width(), 24.0);
        // What does not apply is grey and off, and is on again where it applies again.
        let response = choice(ui, *on && applies, name, size);
        if response.clicked() {
            *on = !*on;
        }
        with_tooltip(response, tip);
    });
}

fn colour(ui: &mut Ui, label: &str, tip: &str, value: &mut Rgb) {
    row(ui, label, tip, |ui| ui.color_edit_button_srgb(&mut value.0));
}

fn bars(ui: &mut Ui, draft: &mut Project) {
    let width = drag(&mut draft.options.bar_width, 0.001..=0.2, 0.0002, 4);
    let tip = "Thickness of the bars, as a part of the design's size; also of the shape that its field is made from.";
    number(ui, "Bar width", tip, width);
    let tip = "Draws a disc where bars meet.";
    toggle(ui, "Joints", tip, &mut draft.style.joints);
}
