//! The colours of the match editor.

use bevy_egui::egui::Color32;

use crate::app::ui::kit::theme::ThemePalette;
use crate::app::ui::stage::area::{ink_on, is_light};
use crate::app::ui::ui_state::UiState;
use crate::colour::Rgb;

/// The share of a design's colour in its fill: the boundary's colours must stand out from it.
const FILL: f32 = 0.28;

/// The colours of the editor.
#[derive(Clone, Copy, Debug)]
pub struct EditorColours {
    /// Behind everything.
    pub ground: Color32,
    /// What can be read on it.
    pub ink: Color32,
    /// Lines that stand back.
    pub faint: Color32,
    /// What is chosen.
    pub accent: Color32,
    /// Something went wrong.
    pub problem: Color32,
    /// The ground is light.
    pub is_light: bool,
    /// Fill of source and target.
    pub fills: [Color32; 2],
}

impl EditorColours {
    /// The inks on the ground of the open project. The ground is the project's and not the
    /// panels', so the palette is the one that goes with it.
    pub fn of(scene: &UiState) -> Self {
        let style = scene.session.style();
        let colour = |Rgb([r, g, b]): Rgb| Color32::from_rgb(r, g, b);
        let ground = colour(style.ground);
        let ink = ink_on(style.ground);
        let is_light = is_light(style.ground);
        let on_ground = ThemePalette::on(is_light);
        let fill = |rgb: Rgb| ground.lerp_to_gamma(colour(rgb), FILL);
        Self {
            ground,
            ink,
            faint: ground.lerp_to_gamma(ink, 0.35),
            accent: on_ground.accent,
            problem: on_ground.problem,
            is_light,
            fills: [fill(style.source), fill(style.target)],
        }
    }
}
