//! Theme of the user interface: colour palettes, fonts, spacing on a grid of 8 points, and egui's
//! styles.
//!
//! Amber marks warnings and extrapolation. Text has enough contrast on every background (WCAG 2.2).

use bevy_egui::egui::{
    self, Color32, CornerRadius, FontId, Margin, Shadow, Stroke, Style, TextStyle, Theme, Vec2,
    Visuals, style::HandleShape, style::ScrollStyle, style::WidgetVisuals,
};

use crate::app::input::preferences::ThemeChoice;
use crate::app::ui::kit::icons;

/// Spacing unit of the layout, in points.
pub const GRID: f32 = 8.0;

/// Corner radius of controls, in points.
pub const RADIUS: CornerRadius = CornerRadius::same(4);

/// Corner radius of cards and windows, in points.
pub const CARD_RADIUS: CornerRadius = CornerRadius::same(8);

/// Height of buttons, fields and other controls, in points.
pub const CONTROL_HEIGHT: f32 = 24.0;

/// Colours of the light or the dark theme.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThemePalette {
    /// Background of panels.
    pub panel: Color32,
    /// Background of dialogs and cards that lie above the panels.
    pub window: Color32,
    /// Background of controls and of cards in panels.
    pub raised: Color32,
    /// Background of a control under the pointer.
    pub hover: Color32,
    /// Hairlines and separators.
    pub line: Color32,
    /// Primary text.
    pub text: Color32,
    /// Secondary text: labels and explanations.
    pub weak: Color32,
    /// Outlines and marks of selected items.
    pub accent: Color32,
    /// Fill of selected items.
    pub accent_fill: Color32,
    /// Warnings, and values of t outside [0, 1].
    pub amber: Color32,
    /// Error messages.
    pub problem: Color32,
    /// Messages of success.
    pub good: Color32,
}

const DARK: ThemePalette = ThemePalette {
    panel: Color32::from_rgb(0x17, 0x1b, 0x21),
    window: Color32::from_rgb(0x1e, 0x23, 0x2b),
    raised: Color32::from_rgb(0x24, 0x2a, 0x33),
    hover: Color32::from_rgb(0x2f, 0x37, 0x42),
    line: Color32::from_rgb(0x2d, 0x34, 0x3e),
    text: Color32::from_rgb(0xe1, 0xe6, 0xec),
    weak: Color32::from_rgb(0x98, 0xa3, 0xb0),
    accent: Color32::from_rgb(0x7f, 0xb0, 0xf0),
    accent_fill: Color32::from_rgb(0x2a, 0x45, 0x66),
    amber: Color32::from_rgb(0xe2, 0xb0, 0x5a),
    problem: Color32::from_rgb(0xf0, 0x8a, 0x70),
    good: Color32::from_rgb(0x7c, 0xc4, 0x9a),
};

const LIGHT: ThemePalette = ThemePalette {
    panel: Color32::from_rgb(0xe8, 0xe9, 0xeb),
    window: Color32::from_rgb(0xf3, 0xf4, 0xf5),
    raised: Color32::from_rgb(0xfa, 0xfa, 0xfb),
    hover: Color32::from_rgb(0xd6, 0xda, 0xdf),
    line: Color32::from_rgb(0xcd, 0xd1, 0xd6),
    text: Color32::from_rgb(0x10, 0x14, 0x18),
    weak: Color32::from_rgb(0x48, 0x51, 0x5b),
    accent: Color32::from_rgb(0x1d, 0x5a, 0xa8),
    accent_fill: Color32::from_rgb(0xcf, 0xdf, 0xf3),
    amber: Color32::from_rgb(0x8f, 0x5d, 0x06),
    problem: Color32::from_rgb(0xa8, 0x3a, 0x1c),
    good: Color32::from_rgb(0x1f, 0x6b, 0x44),
};

impl ThemePalette {
    /// Returns the palette of the light or of the dark theme.
    #[must_use]
    pub const fn on(is_light: bool) -> Self {
        if is_light { LIGHT } else { DARK }
    }

    /// Returns the text colour of disabled controls.
    #[must_use]
    pub fn disabled_text(&self) -> Color32 {
        self.weak.lerp_to_gamma(self.panel, 0.45)
    }

    /// Returns the palette of the theme with which `ui` is drawn.
    #[must_use]
    pub fn of(ui: &egui::Ui) -> Self {
        if ui.visuals().dark_mode { DARK } else { LIGHT }
    }
}

/// Installs both themes and the icon fonts. It must be called before egui's first pass, because
/// fonts take effect only at the start of a pass.
pub fn install(ctx: &egui::Context) {
    ctx.set_fonts(icons::fonts());
    ctx.set_style_of(Theme::Dark, style(DARK, Visuals::dark()));
    ctx.set_style_of(Theme::Light, style(LIGHT, Visuals::light()));
    // egui's keyboard zoom is off. It would change the size of a point in egui, but the rectangle
    // of the stage is measured in points of the window.
    ctx.options_mut(|options| options.zoom_with_keyboard = false);
}

/// Switches egui to a theme.
pub fn apply_theme(ctx: &egui::Context, theme: ThemeChoice) {
    ctx.set_theme(match theme {
        ThemeChoice::Dark => Theme::Dark,
        ThemeChoice::Light => Theme::Light,
    });
}

/// Runs `draw` with the accent colour as the background of selected text.
pub fn with_bright_selection<R>(ctx: &egui::Context, draw: impl FnOnce(&egui::Context) -> R) -> R {
    let theme = ctx.theme();
    let palette = match theme {
        Theme::Dark => DARK,
        Theme::Light => LIGHT,
    };
    let before = ctx.style_of(theme);
    let mut style = Style::clone(&before);
    style.visuals.selection.bg_fill = palette.accent;
    style.visuals.selection.stroke.color = palette.panel;
    ctx.set_style_of(theme, style);
    let drawn = draw(ctx);
    ctx.set_style_of(theme, before);
    drawn
}

fn style(palette: ThemePalette, base: Visuals) -> Style {
    let mut style = Style {
        visuals: visuals(palette, base),
        ..Style::default()
    };
    style.text_styles = text_styles();
    spacing(&mut style.spacing);
    style.interaction.tooltip_delay = 0.4;
    // Labels are not selectable, because the pointer would become a text cursor over each label.
    style.interaction.selectable_labels = false;
    style.animation_time = 0.1;
    style
}

/// Font of secondary text, small buttons and text on the stage.
pub const SMALL: FontId = FontId::proportional(12.5);

fn text_styles() -> std::collections::BTreeMap<TextStyle, FontId> {
    [
        (TextStyle::Heading, FontId::proportional(17.0)),
        (TextStyle::Body, FontId::proportional(14.0)),
        (TextStyle::Button, FontId::proportional(14.0)),
        (TextStyle::Small, SMALL),
        (TextStyle::Monospace, FontId::monospace(13.0)),
    ]
    .into()
}

fn spacing(spacing: &mut egui::style::Spacing) {
    spacing.item_spacing = Vec2::splat(GRID);
    spacing.button_padding = Vec2::new(GRID, 4.0);
    spacing.interact_size = Vec2::new(40.0, CONTROL_HEIGHT);
    spacing.window_margin = Margin::same(16);
    spacing.menu_margin = Margin::same(8);
    spacing.combo_width = 120.0;
    spacing.slider_width = 96.0;
    spacing.slider_rail_height = 4.0;
    spacing.tooltip_width = 320.0;
    spacing.scroll = ScrollStyle::thin();
    // The fade at the ends of scroll areas is half-transparent, which renders wrongly (see
    // `visuals`).
    spacing.scroll.fade.strength = 0.0;
}

fn visuals(palette: ThemePalette, base: Visuals) -> Visuals {
    let mut visuals = base;
    visuals.panel_fill = palette.panel;
    visuals.window_fill = palette.window;
    visuals.window_stroke = Stroke::new(1.0, palette.line);
    visuals.window_corner_radius = CARD_RADIUS;
    visuals.menu_corner_radius = CARD_RADIUS;
    visuals.window_shadow = shadow();
    visuals.popup_shadow = shadow();
    visuals.extreme_bg_color = palette.raised;
    visuals.text_edit_bg_color = Some(palette.raised);
    visuals.faint_bg_color = palette.raised;
    visuals.weak_text_color = Some(palette.weak);
    visuals.hyperlink_color = palette.accent;
    visuals.warn_fg_color = palette.amber;
    visuals.error_fg_color = palette.problem;
    visuals.selection.bg_fill = palette.accent_fill;
    visuals.selection.stroke = Stroke::new(1.0, palette.accent);
    visuals.slider_trailing_fill = true;
    visuals.handle_shape = HandleShape::Circle;
    // Disabled controls are opaque. Half-transparent fills would be too dark in the light theme,
    // because the GPU converts egui's premultiplied colours to linear light.
    visuals.disabled_alpha = 1.0;
    visuals.widgets.noninteractive = widget(palette.panel, palette.line, palette.text);
    visuals.widgets.inactive = widget(palette.raised, Color32::TRANSPARENT, palette.text);
    visuals.widgets.hovered = widget(palette.hover, palette.line, palette.text);
    visuals.widgets.active = widget(palette.accent_fill, palette.accent, palette.text);
    visuals.widgets.open = widget(palette.hover, palette.line, palette.text);
    visuals
}

fn shadow() -> Shadow {
    Shadow {
        offset: [0, 4],
        blur: 16,
        spread: 0,
        color: Color32::from_black_alpha(60),
    }
}

fn widget(fill: Color32, line: Color32, text: Color32) -> WidgetVisuals {
    WidgetVisuals {
        bg_fill: fill,
        weak_bg_fill: fill,
        bg_stroke: Stroke::new(1.0, line),
        corner_radius: RADIUS,
        fg_stroke: Stroke::new(1.0, text),
        expansion: 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Relative luminance of a colour, 0 to 1 (WCAG 2.2).
    fn luminance(colour: Color32) -> f64 {
        let linear = |v: u8| {
            let v = f64::from(v) / 255.0;
            if v <= 0.040_45 {
                v / 12.92
            } else {
                ((v + 0.055) / 1.055).powf(2.4)
            }
        };
        0.2126 * linear(colour.r()) + 0.7152 * linear(colour.g()) + 0.0722 * linear(colour.b())
    }

    fn contrast(a: Color32, b: Color32) -> f64 {
        let (a, b) = (luminance(a) + 0.05, luminance(b) + 0.05);
        a.max(b) / a.min(b)
    }

    /// WCAG 2.2 requires a contrast of at least 4.5 between text and background.
    #[test]
    fn text_is_readable_on_every_background() {
        for palette in [DARK, LIGHT] {
            for ground in [palette.panel, palette.window, palette.raised] {
                for text in [
                    palette.text,
                    palette.weak,
                    palette.accent,
                    palette.amber,
                    palette.problem,
                    palette.good,
                ] {
                    assert!(contrast(text, ground) >= 4.5, "{text:?} on {ground:?}");
                }
            }
            assert!(contrast(palette.text, palette.accent_fill) >= 4.5);
            assert!(contrast(palette.text, palette.hover) >= 4.5);
        }
    }
}
