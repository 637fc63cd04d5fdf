//! Appearance section of the inspector: visible elements of the stage, colours, options of paint
//! layers, and how bars are drawn.

use bevy_egui::egui::{Ui, vec2};

use crate::app::input::intent::Intent;
use crate::app::input::preferences::Preferences;
use crate::app::ui::kit::widgets::{
    drag_value, number, row, section, segment, segmented_row, setting_row, slider, toggle,
    with_tooltip,
};
use crate::app::ui::ui_state::{Intents, UiState};
use crate::colour::Rgb;
use crate::content::ContentKind;
use crate::project::Project;
use crate::stage::StageVisibility;
use crate::transition::{PaintLayerOptions, PaintRule, TransitionStyle};
use crate::warp::WarpKind;

/// Draws the appearance section.
pub fn show(ui: &mut Ui, state: &UiState, draft: &mut Project, intents: &mut Intents) {
    section(ui, "Appearance", |ui| {
        layers(ui, state, draft, intents);
        if state.session.has_paints() {
            let tip = "Keeps the designs' own colours, or fills everything with one colour.";
            setting_row(ui, "Colours", tip, &mut draft.options.paint);
            if draft.options.paint == PaintRule::Own && draft.content != Some(ContentKind::Colours)
            {
                paint_layers(ui, &mut draft.options.coats);
            }
        }
        if let Some(drawn) = state.session.drawn_colours() {
            colour_style(ui, drawn, &mut draft.style);
        }
        let tip = "Fill colour at t = 0.";
        colour(ui, "Source", tip, &mut draft.style.source);
        let tip = "Fill colour at t = 1.";
        colour(ui, "Target", tip, &mut draft.style.target);
        let tip = "Colour behind the shape, on the stage and in exports.";
        colour(ui, "Background", tip, &mut draft.style.ground);
        if state.session.has_bars() {
            bars(ui, draft);
        }
    });
}

/// Draws the choice between the colours in which the designs are drawn, such as the black of icons,
/// and those of the window. With other colours, neither is marked.
fn colour_style(ui: &mut Ui, drawn: [Rgb; 2], style: &mut TransitionStyle) {
    let plain = TransitionStyle::default();
    let mut colours = [style.source, style.target];
    let styles = [
        (
            drawn,
            "As drawn",
            "The colours that other programs show, such as black.",
        ),
        (
            [plain.source, plain.target],
            "Blue to orange",
            "Shows how far the film is by its colour.",
        ),
    ];
    let tip = "Colours of drawings that name none.";
    segmented_row(ui, "Style", tip, &mut colours, &styles);
    [style.source, style.target] = colours;
}

/// Draws the options of paint layers: whether unmatched parts fade, and at which t the stacking
/// order changes.
fn paint_layers(ui: &mut Ui, layers: &mut PaintLayerOptions) {
    let tip = "Fades parts that exist in only one design, in addition to scaling them.";
    toggle(ui, "Fade parts", tip, &mut layers.fade);
    let tip = "Moment t at which overlapping parts take the stacking order of the target.";
    slider(
        ui,
        "Reorder at",
        tip,
        &mut layers.reorder_at,
        0.0..=1.0,
        false,
    );
}

const CONTOURS_TIP: &str = "Lines of equal distance in the blended field.";

/// Switch that shows or hides one element of the stage. The user interface calls such an element a
/// layer. Fields: whether the element is visible, its name, its tooltip, and whether the transition
/// can show it.
type LayerToggle<'a> = (&'a mut bool, &'static str, &'static str, bool);

fn layer_toggles<'a>(
    state: &UiState,
    project: &Project,
    show: &'a mut StageVisibility,
    onion: &'a mut bool,
) -> [LayerToggle<'a>; 8] {
    let is_field = project.content == Some(ContentKind::Field);
    // A distance field represents the area that the bars cover, so it has no bars to show.
    let has_bars = state.session.has_bars() && !is_field;
    // The warp by boundary paths moves only outlines, so it cannot deform a grid.
    let has_grid = project.warp != Some(WarpKind::Paths);
    [
        (&mut show.fill, "Fill", "The filled shape.", true),
        (
            &mut show.ghosts,
            "Ghosts",
            "Thin outlines of source and target.",
            true,
        ),
        (
            onion,
            "Onion skin",
            "Thin outlines of the film at its stops (O).",
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
            "Edges of the triangles that carry the motion.",
            !is_field,
        ),
        (&mut show.iso_lines, "Contours", CONTOURS_TIP, is_field),
        (
            &mut show.signed_colours,
            "Signed field",
            "The blended field in two hues, for inside and outside.",
            is_field,
        ),
        (
            &mut show.grid,
            "Grid",
            "Square grid on the source, deformed by the warp (W).",
            has_grid,
        ),
    ]
}

/// Returns whether all elements that the transition can show are hidden.
pub fn is_blank(state: &UiState) -> bool {
    let (mut show, mut onion) = (state.preferences.show, false);
    let project = state.session.project();
    project.is_some_and(|project| {
        let layers = layer_toggles(state, project, &mut show, &mut onion);
        !layers.into_iter().any(|(on, .., applies)| *on && applies)
    })
}

fn layers(ui: &mut Ui, state: &UiState, draft: &Project, intents: &mut Intents) {
    let mut preferences = *state.preferences;
    let Preferences { show, onion, .. } = &mut preferences;
    let layers = layer_toggles(state, draft, show, onion);
    ui.scope(|ui| {
        ui.spacing_mut().item_spacing = vec2(4.0, 4.0);
        ui.columns(3, |columns| {
            for (k, (on, name, tip, applies)) in layers.into_iter().enumerate() {
                layer(&mut columns[k % 3], on, name, tip, applies);
            }
        });
    });
    if preferences != *state.preferences {
        intents.push(Intent::SetPreferences(preferences));
    }
}

fn layer(ui: &mut Ui, on: &mut bool, name: &str, tip: &str, applies: bool) {
    ui.add_enabled_ui(applies, |ui| {
        let size = vec2(ui.available_width(), 24.0);
        // An element that the transition cannot show is greyed out; its setting does not change.
        let response = segment(ui, *on && applies, name, size);
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
    let width = drag_value(&mut draft.options.bar_width, 0.001..=0.2, 0.0002, 4);
    let tip = "Thickness of the bars, as a fraction of the design's size. Also used for their \
               distance field.";
    number(ui, "Bar width", tip, width);
    let tip = "Draws a disc at each joint.";
    toggle(ui, "Joints", tip, &mut draft.style.joints);
}
