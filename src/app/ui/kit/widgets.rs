//! Building blocks of the panels: sections, rows with a label and a control, buttons, switches,
//! lists, sliders, number fields, cards and tooltips.

use std::ops::RangeInclusive;
use std::sync::Arc;

use bevy_egui::egui::emath::Numeric;
use bevy_egui::egui::{
    self, Align, Align2, Area, Color32, ComboBox, DragValue, Galley, Layout, Margin, Order,
    Painter, Pos2, Rect, RectAlign, Response, RichText, Sense, Slider, SliderClamping, StrokeKind,
    Tooltip, Ui, Vec2, WidgetInfo, WidgetType, vec2,
};

use crate::app::input::intent::Intent;
use crate::app::ui::kit::icons;
use crate::app::ui::kit::icons::Icon;
use crate::app::ui::kit::theme::{CARD_RADIUS, CONTROL_HEIGHT, GRID, RADIUS, SMALL, ThemePalette};
use crate::settings::Choice;

/// Width of the labels on the left of rows, in points.
const LABEL_WIDTH: f32 = 98.0;

/// Draws a section of a panel: a heading, the content, and a separator line.
pub fn section<R>(ui: &mut Ui, title: &str, body: impl FnOnce(&mut Ui) -> R) -> R {
    ui.add_space(GRID);
    ui.label(secondary_text(ui, title).strong());
    let body = ui.vertical(body).inner;
    ui.add_space(GRID);
    let line = ui.available_rect_before_wrap();
    let stroke = (1.0, ThemePalette::of(ui).line);
    ui.painter().hline(line.x_range(), line.top(), stroke);
    body
}

/// Draws a row with a label on the left and a control on the right; both show the tooltip.
pub fn row(ui: &mut Ui, label: &str, tip: &str, control: impl FnOnce(&mut Ui) -> Response) {
    ui.horizontal(|ui| {
        ui.set_min_height(CONTROL_HEIGHT);
        let (rect, response) =
            ui.allocate_exact_size(vec2(LABEL_WIDTH, CONTROL_HEIGHT), Sense::hover());
        let colour = ThemePalette::of(ui).weak;
        let font = egui::TextStyle::Body.resolve(ui.style());
        ui.painter()
            .text(rect.left_center(), Align2::LEFT_CENTER, label, font, colour);
        tooltip_left(&response, rect.left(), tip);
        tooltip_left(&control(ui), rect.left(), tip);
    });
}

/// Shows the tooltip of a control to the left of the x coordinate `left`, usually the left edge of
/// the panel. Below the control it would cover the next control.
pub fn tooltip_left(response: &Response, left: f32, tip: &str) {
    let panel = Rect::from_x_y_ranges(left..=response.rect.right(), response.rect.y_range());
    show_tooltip(response, tip, |mut tooltip| {
        tooltip.popup = tooltip.popup.anchor(panel).align(RectAlign::LEFT_START);
        tooltip.gap(GRID)
    });
}

/// Shows the tooltip of a control below the control in the upper half of the window, and above it
/// in the lower half. So the tooltip of a control in a bar at the upper or lower edge does not
/// cover the other controls of the bar.
pub fn with_tooltip(response: Response, tip: &str) -> Response {
    let is_low = response.rect.center().y > response.ctx.content_rect().center().y;
    let align = if is_low {
        RectAlign::TOP_START
    } else {
        RectAlign::BOTTOM_START
    };
    show_tooltip(&response, tip, |mut tooltip| {
        tooltip.popup = tooltip.popup.align(align);
        tooltip
    });
    response
}

/// Shows the tooltip of a control, whether the control is enabled or disabled. `place` sets the
/// position of the tooltip.
fn show_tooltip(response: &Response, tip: &str, place: impl Fn(Tooltip<'_>) -> Tooltip<'_>) {
    for tooltip in [
        Tooltip::for_enabled(response),
        Tooltip::for_disabled(response),
    ] {
        place(tooltip).show(|ui| ui.label(tip));
    }
}

/// Draws a row with a number field and a slider for `value`.
pub fn slider(
    ui: &mut Ui,
    label: &str,
    tip: &str,
    value: &mut f64,
    range: RangeInclusive<f64>,
    logarithmic: bool,
) {
    row(ui, label, tip, |ui| {
        let number = DragValue::new(value)
            .speed((range.end() - range.start()) / 400.0)
            .range(range.clone())
            .clamp_existing_to_range(false)
            .max_decimals(3);
        let number = ui.add_sized([56.0, CONTROL_HEIGHT], number);
        // A slider does not fill the available width by itself, so its width is set.
        ui.spacing_mut().slider_width = (ui.available_width() - GRID).max(40.0);
        let slider = Slider::new(value, range)
            .logarithmic(logarithmic)
            .clamping(SliderClamping::Edits)
            .show_value(false);
        number | ui.add(slider)
    });
}

/// Returns a number field for `value`, which the user can drag or type. Input is limited to
/// `range`; `speed` is the change of the value per point dragged.
pub fn drag_value<N: Numeric>(
    value: &mut N,
    range: RangeInclusive<N>,
    speed: f64,
    decimals: usize,
) -> DragValue<'_> {
    DragValue::new(value)
        .range(range)
        .clamp_existing_to_range(false)
        .speed(speed)
        .fixed_decimals(decimals)
}

/// Draws a row with a number field.
pub fn number(ui: &mut Ui, label: &str, tip: &str, value: DragValue<'_>) {
    row(ui, label, tip, |ui| {
        ui.add_sized([72.0, CONTROL_HEIGHT], value)
    });
}

/// Draws a row with an on/off switch.
pub fn toggle(ui: &mut Ui, label: &str, tip: &str, on: &mut bool) {
    row(ui, label, tip, |ui| switch(ui, label, on));
}

/// Draws a row with a switch between an automatic value, stored as `None`, and a manual value. When
/// the user turns the automatic value off, the manual value is first `manual`.
pub fn automatic_toggle<T>(ui: &mut Ui, label: &str, tip: &str, value: &mut Option<T>, manual: T) {
    let mut is_automatic = value.is_none();
    toggle(ui, label, tip, &mut is_automatic);
    if is_automatic {
        *value = None;
    } else {
        value.get_or_insert(manual);
    }
}

/// Draws an on/off switch without a label; `label` is for screen readers.
pub fn switch(ui: &mut Ui, label: &str, on: &mut bool) -> Response {
    let palette = ThemePalette::of(ui);
    let (rect, mut response) = ui.allocate_exact_size(vec2(32.0, CONTROL_HEIGHT), Sense::click());
    if response.clicked() {
        *on = !*on;
        response.mark_changed();
    }
    let is_on = *on;
    response.widget_info(|| WidgetInfo::selected(WidgetType::Checkbox, true, is_on, label));
    let position = ui.ctx().animate_bool_responsive(response.id, is_on);
    let track = Rect::from_center_size(rect.center(), vec2(32.0, 16.0));
    // The knob also moves, because colour-blind users may not see the change of the colour.
    let fill = if is_on { palette.accent } else { palette.hover };
    ui.painter()
        .rect(track, 8.0, fill, (1.0, palette.line), StrokeKind::Inside);
    let knob = egui::pos2(
        egui::lerp(track.left() + 8.0..=track.right() - 8.0, position),
        track.center().y,
    );
    ui.painter()
        .circle_filled(knob, 5.5, if is_on { palette.panel } else { palette.weak });
    response
}

/// Space between two buttons of a segmented control, in points.
const SEGMENT_GAP: f32 = 2.0;

/// Draws a segmented control: a row of buttons, one of which is selected. Each option is a value
/// with a label and a tooltip.
pub fn segmented_control<T: PartialEq + Clone>(
    ui: &mut Ui,
    value: &mut T,
    options: &[(T, &str, &str)],
) -> Response {
    segmented_control_where(ui, value, options, |_| true)
}

/// Draws a segmented control in which only the options for which `is_enabled` is true can be
/// selected.
///
/// Each button shows its own tooltip. The returned response belongs to none of the buttons, so that
/// an enclosing row does not show its tooltip on top of theirs.
pub fn segmented_control_where<T: PartialEq + Clone>(
    ui: &mut Ui,
    value: &mut T,
    options: &[(T, &str, &str)],
    is_enabled: impl Fn(&T) -> bool,
) -> Response {
    // Tooltips are shown to the left of the panel; next to the buttons they would cover the row's
    // label.
    let left = ui.clip_rect().left();
    let widths = segment_widths(ui, options.iter().map(|(_, label, _)| *label));
    ui.spacing_mut().item_spacing.x = SEGMENT_GAP;
    for ((option, label, tip), width) in options.iter().zip(widths) {
        let is_selected = *value == *option;
        let cell = ui.add_enabled_ui(is_enabled(option), |ui| {
            segment(ui, is_selected, label, vec2(width, CONTROL_HEIGHT))
        });
        let response = cell.inner;
        tooltip_left(&response, left, tip);
        if response.clicked() {
            *value = option.clone();
        }
    }
    ui.interact(Rect::NOTHING, ui.id().with("choices"), Sense::hover())
}

/// Draws a row with a segmented control.
pub fn segmented_row<T: PartialEq + Clone>(
    ui: &mut Ui,
    label: &str,
    tip: &str,
    value: &mut T,
    options: &[(T, &str, &str)],
) {
    row(ui, label, tip, |ui| segmented_control(ui, value, options));
}

/// Draws one button of a segmented control.
pub fn segment(ui: &mut Ui, is_selected: bool, label: &str, size: Vec2) -> Response {
    let palette = ThemePalette::of(ui);
    let (rect, response) = ui.allocate_exact_size(size, Sense::click());
    response.widget_info(|| {
        WidgetInfo::selected(WidgetType::SelectableLabel, true, is_selected, label)
    });
    let (fill, text) = match (ui.is_enabled(), is_selected, response.hovered()) {
        (false, ..) => (palette.panel, palette.disabled_text()),
        (true, true, _) => (palette.accent_fill, palette.text),
        (true, false, true) => (palette.hover, palette.text),
        (true, false, false) => (palette.raised, palette.weak),
    };
    ui.painter().rect_filled(rect, RADIUS, fill);
    ui.painter()
        .text(rect.center(), Align2::CENTER_CENTER, label, SMALL, text);
    response
}

/// Draws a single button in the style of a segmented control, with the given width and a tooltip;
/// returns whether it was clicked.
pub fn segment_button(ui: &mut Ui, is_selected: bool, label: &str, tip: &str, width: f32) -> bool {
    let response = segment(ui, is_selected, label, vec2(width, CONTROL_HEIGHT));
    with_tooltip(response, tip).clicked()
}

/// Draws a row with all choices of a setting: a segmented control or, if the titles do not fit next
/// to each other, a drop-down list.
pub fn setting_row<T: Choice>(ui: &mut Ui, label: &str, tip: &str, value: &mut T) {
    let titles = T::CHOICES.iter().map(|choice| choice.name().title);
    row(ui, label, tip, |ui| {
        if !fits_in_segments(ui, titles) {
            return menu(ui, label, value, ui.available_width());
        }
        let option = |choice: &T| (*choice, choice.name().title, choice.name().sentence);
        let options: Vec<_> = T::CHOICES.iter().map(option).collect();
        segmented_control(ui, value, &options)
    });
}

/// Returns the widths, in points, of the buttons of a segmented control that fills the available
/// width: equal if each title fits, otherwise in proportion to the titles.
fn segment_widths<'a>(ui: &Ui, titles: impl Iterator<Item = &'a str>) -> Vec<f32> {
    let titles = title_widths(ui, titles);
    let count = titles.len().max(1) as f32;
    let available = ui.available_width() - SEGMENT_GAP * (count - 1.0);
    let equal = available / count;
    if titles.iter().all(|title| *title <= equal) {
        return vec![equal; titles.len()];
    }
    let total: f32 = titles.iter().sum();
    titles
        .iter()
        .map(|title| title * available / total)
        .collect()
}

/// Returns whether all titles fit into the buttons of a segmented control next to each other.
fn fits_in_segments<'a>(ui: &Ui, titles: impl Iterator<Item = &'a str>) -> bool {
    let titles = title_widths(ui, titles);
    let gaps = SEGMENT_GAP * titles.len().saturating_sub(1) as f32;
    titles.iter().sum::<f32>() + gaps <= ui.available_width()
}

/// Returns the widths, in points, that the titles of buttons need.
fn title_widths<'a>(ui: &Ui, titles: impl Iterator<Item = &'a str>) -> Vec<f32> {
    /// Sum of the spaces to the left and right of a title, in points. It keeps the titles of
    /// neighbouring buttons apart.
    const PADDING: f32 = 8.0;
    let width = |title: &str| {
        let galley = ui
            .painter()
            .layout_no_wrap(title.to_owned(), SMALL, Color32::PLACEHOLDER);
        galley.size().x + PADDING
    };
    titles.map(width).collect()
}

/// Draws a drop-down list of all choices of a setting.
pub fn menu<T: Choice>(ui: &mut Ui, salt: &str, value: &mut T, width: f32) -> Response {
    ComboBox::from_id_salt(salt)
        .width(width)
        .selected_text(value.name().title)
        .show_ui(ui, |ui| {
            for choice in T::CHOICES {
                let response = ui.selectable_value(value, *choice, choice.name().title);
                tooltip_left(&response, response.rect.left(), choice.name().sentence);
            }
        })
        .response
}

/// Draws a row with a drop-down list of all choices of a setting, and below it the description of
/// the selected choice.
pub fn setting_menu_row<T: Choice>(ui: &mut Ui, label: &str, tip: &str, value: &mut T) {
    row(ui, label, tip, |ui| {
        menu(ui, label, value, ui.available_width())
    });
    hint(ui, value.name().sentence);
}

/// Draws a button that shows only an icon.
pub fn icon_button(ui: &mut Ui, icon: Icon, tip: &str, size: Vec2) -> Response {
    let palette = ThemePalette::of(ui);
    let (rect, response) = ui.allocate_exact_size(size, Sense::click());
    // Screen readers read the tooltip, because an icon has no text.
    response.widget_info(|| WidgetInfo::labeled(WidgetType::Button, ui.is_enabled(), tip));
    if response.hovered() || response.is_pointer_button_down_on() {
        ui.painter().rect_filled(rect, RADIUS, palette.hover);
    }
    let colour = if ui.is_enabled() {
        palette.text
    } else {
        palette.weak
    };
    icons::paint_icon(ui.painter(), icon, rect, colour);
    with_tooltip(response, tip)
}

/// Draws a square icon button that sends an intent when it is clicked.
pub fn intent_button(
    ui: &mut Ui,
    icon: Icon,
    tip: &str,
    intent: Intent,
    intents: &mut Vec<Intent>,
) {
    if icon_button(ui, icon, tip, vec2(32.0, 32.0)).clicked() {
        intents.push(intent);
    }
}

/// Returns the [`egui::Frame`] of a panel at an edge of the window. It has the background of
/// panels, and inner margins in points.
pub fn panel_frame(ui: &Ui, [left, right, top, bottom]: [i8; 4]) -> egui::Frame {
    let margin = Margin {
        left,
        right,
        top,
        bottom,
    };
    egui::Frame::new()
        .fill(ThemePalette::of(ui).panel)
        .inner_margin(margin)
}

/// Draws content on a card with rounded corners, in the style of the cards that lie over the stage.
pub fn card<R>(ui: &mut Ui, margin: impl Into<Margin>, content: impl FnOnce(&mut Ui) -> R) -> R {
    egui::Frame::window(ui.style())
        .corner_radius(CARD_RADIUS)
        .inner_margin(margin)
        .show(ui, content)
        .inner
}

/// Returns secondary text: small and in a weak colour.
pub fn secondary_text(ui: &Ui, words: impl Into<String>) -> RichText {
    RichText::new(words)
        .small()
        .color(ThemePalette::of(ui).weak)
}

/// Returns a layer at a fixed position, above the panels and below dialogs. `pivot` is the point of
/// the layer that lies at `at`.
pub fn fixed_layer(name: &'static str, pivot: Align2, at: Pos2) -> Area {
    Area::new(name.into())
        .order(Order::Middle)
        .pivot(pivot)
        .fixed_pos(at)
}

/// Paints a rectangular card with centred text, without using egui's layout.
pub fn text_card(
    painter: &Painter,
    card: Rect,
    words: Arc<Galley>,
    fill: Color32,
    line: (f32, Color32),
) {
    painter.rect(card, RADIUS, fill, line, StrokeKind::Inside);
    let corner = card.center() - words.size() / 2.0;
    // The text already has a colour. The last argument would apply only to text without one.
    painter.galley(corner, words, Color32::PLACEHOLDER);
}

/// Draws explanatory text, wrapped at the width of the panel.
pub fn hint(ui: &mut Ui, text: &str) {
    ui.add(egui::Label::new(secondary_text(ui, text)).wrap());
}

/// Lays out the widgets of `content` from right to left, starting at the right edge.
pub fn from_right<R>(ui: &mut Ui, content: impl FnOnce(&mut Ui) -> R) -> R {
    ui.with_layout(Layout::right_to_left(Align::Center), content)
        .inner
}

/// Draws the main button of a dialog or panel, with an accented background.
pub fn primary_button(ui: &mut Ui, text: &str) -> Response {
    let palette = ThemePalette::of(ui);
    let text = RichText::new(text).color(palette.text);
    ui.add(egui::Button::new(text).fill(palette.accent_fill))
}
