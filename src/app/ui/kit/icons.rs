//! Icons of the user interface: outlined or solid glyphs of the
//! [Phosphor](https://phosphoricons.com) fonts.

use bevy_egui::egui::epaint::TextShape;
use bevy_egui::egui::{Align2, Color32, FontDefinitions, FontFamily, FontId, Painter, Rect};
use egui_phosphor::{Variant, fill, regular};

/// Size of every icon, in points. Phosphor designs its icons on a grid of 16 × 16 squares, so at
/// this size their lines fall on whole pixels.
const SIZE: f32 = 16.0;

const LINES: &str = "outlined icons";
const SOLID: &str = "solid icons";

/// Glyph of an icon font, with a rotation and an optional colour.
#[derive(Clone, Copy, Debug)]
pub struct Icon {
    family: &'static str,
    /// The glyph, as a text of one character.
    glyph: &'static str,
    /// Clockwise rotation, in radians.
    rotation: f32,
    /// Fixed colour of the icon; `None` if it has the colour that is passed to [`paint_icon`].
    colour: Option<Color32>,
}

impl Icon {
    /// Returns the icon with the fixed colour `ink`; `None` removes its fixed colour.
    pub const fn with_colour(self, ink: Option<Color32>) -> Self {
        Self {
            colour: ink,
            ..self
        }
    }
}

const fn lines(glyph: &'static str) -> Icon {
    Icon {
        family: LINES,
        glyph,
        rotation: 0.0,
        colour: None,
    }
}

const fn solid(glyph: &'static str) -> Icon {
    Icon {
        family: SOLID,
        ..lines(glyph)
    }
}

/// Play triangle that points to the left. Phosphor has no such icon, so [`PLAY`] is rotated.
pub const PLAY_BACKWARDS: Icon = Icon {
    rotation: std::f32::consts::PI,
    ..PLAY
};

// Icons of playback, of stops and of a filled rating star are solid, as in media players. All other
// icons are outlined.
pub const ADD_STOP: Icon = solid(fill::FLAG_PENNANT);
pub const STAR: Icon = solid(fill::STAR);
pub const PAUSE: Icon = solid(fill::PAUSE);
pub const PLAY: Icon = solid(fill::PLAY);
pub const RECORD: Icon = solid(fill::RECORD);
pub const TO_END: Icon = solid(fill::SKIP_FORWARD);
pub const TO_START: Icon = solid(fill::SKIP_BACK);

pub const CAMERA: Icon = lines(regular::CAMERA);
pub const CLOSE: Icon = lines(regular::X);
pub const COPY: Icon = lines(regular::COPY);
pub const DOWN: Icon = lines(regular::ARROW_DOWN);
pub const FIT: Icon = lines(regular::CORNERS_OUT);
pub const MATCH: Icon = lines(regular::LINE_SEGMENT);
pub const MOON: Icon = lines(regular::MOON);
pub const MORE: Icon = lines(regular::CARET_DOWN);
pub const NEXT_STOP: Icon = lines(regular::CARET_LINE_RIGHT);
pub const OPEN: Icon = lines(regular::FOLDER_OPEN);
pub const MAP: Icon = lines(regular::MAP_TRIFOLD);
pub const STAR_OUTLINE: Icon = lines(regular::STAR);
pub const PATH: Icon = lines(regular::PATH);
pub const PLOT: Icon = lines(regular::CHART_LINE);
pub const PRESENT: Icon = lines(regular::PRESENTATION);
pub const PREVIOUS_STOP: Icon = lines(regular::CARET_LINE_LEFT);
pub const REDO: Icon = lines(regular::ARROW_U_UP_RIGHT);
pub const SAVE: Icon = lines(regular::FLOPPY_DISK);
pub const SUN: Icon = lines(regular::SUN);
pub const SWAP: Icon = lines(regular::ARROWS_LEFT_RIGHT);
pub const TICK: Icon = lines(regular::CHECK);
pub const COMPARE: Icon = lines(regular::SQUARE_SPLIT_HORIZONTAL);
pub const UNDO: Icon = lines(regular::ARROW_U_UP_LEFT);
pub const UP: Icon = lines(regular::ARROW_UP);
pub const WARNING: Icon = lines(regular::WARNING);

/// Returns egui's default text fonts, and a font family for each of the two icon fonts.
pub fn fonts() -> FontDefinitions {
    let mut fonts = FontDefinitions::default();
    // Both icon fonts use the same code points, so each needs its own font family.
    for (name, variant) in [(LINES, Variant::Regular), (SOLID, Variant::Fill)] {
        let data = variant.font_data().into();
        fonts.font_data.insert(name.to_owned(), data);
        // The first font of a family determines the line height. The icon font is first, so that
        // icons are centred in their line. The text fonts follow, because egui draws a replacement
        // character for missing glyphs, looks it up in every family, and logs a warning if a family
        // lacks it.
        let mut family = vec![name.to_owned()];
        family.extend_from_slice(&fonts.families[&FontFamily::Proportional]);
        let key = FontFamily::Name(name.into());
        fonts.families.insert(key, family);
    }
    fonts
}

/// Paints an icon in the centre of `rect`. `colour` applies to icons without a fixed colour.
pub fn paint_icon(painter: &Painter, icon: Icon, rect: Rect, colour: Color32) {
    let colour = icon.colour.unwrap_or(colour);
    let font = FontId::new(SIZE, FontFamily::Name(icon.family.into()));
    let galley = painter.layout_no_wrap(icon.glyph.to_owned(), font, colour);
    let corner = rect.center() - galley.size() / 2.0;
    let shape = TextShape::new(corner, galley, colour);
    painter.add(shape.with_angle_and_anchor(icon.rotation, Align2::CENTER_CENTER));
}
