//! Colours of the match editor, which follow the background colour of the project.

use bevy_egui::egui::Color32;

use crate::app::ui::kit::theme::ThemePalette;
use crate::app::ui::stage::area::{ink_on, is_light};
use crate::app::ui::ui_state::UiState;
use crate::colour::Rgb;

/// Fraction of a design's colour in its fill; the rest is the background colour (heuristic: the
/// boundary stripe must stand out from the fill).
const FILL_SHARE: f32 = 0.28;

/// Colours of the elements of the match editor.
#[derive(Clone, Copy, Debug)]
pub struct EditorColours {
    /// Background of the panes.
    pub ground: Color32,
    /// Text and marks, readable on the background.
    pub ink: Color32,
    /// Secondary lines, such as hatching and separators.
    pub faint: Color32,
    /// Selected items and cuts.
    pub accent: Color32,
    /// Faulty pins, and messages of a failed match or a refused action.
    pub problem: Color32,
    /// Whether the background is light.
    pub is_light: bool,
    /// Fill colours of the source and of the target.
    pub fills: [Color32; 2],
}

impl EditorColours {
    /// Returns the colours for the open project. They depend on the background colour of the
    /// project, not on the theme of the panels.
    pub fn of(state: &UiState) -> Self {
        let style = state.session.style();
        let colour = |Rgb([r, g, b]): Rgb| Color32::from_rgb(r, g, b);
        let ground = colour(style.ground);
        let ink = ink_on(style.ground);
        let is_light = is_light(style.ground);
        let palette = ThemePalette::on(is_light);
        let fill = |rgb: Rgb| ground.lerp_to_gamma(colour(rgb), FILL_SHARE);
        Self {
            ground,
            ink,
            faint: ground.lerp_to_gamma(ink, 0.35),
            accent: palette.accent,
            problem: palette.problem,
            is_light,
            fills: [fill(style.source), fill(style.target)],
        }
    }
}
