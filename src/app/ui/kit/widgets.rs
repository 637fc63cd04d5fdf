//! The few controls that the panels are made of, each with its tooltip.

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
use crate::settings::choice::Choice;

/// Width of the column of labels.
const LABEL_WIDTH: f32 = 88.0;

/// A heading and what stands under it.
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

/// A label on the left and a control on the right; both tell what the control does.
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

/// A tip to the left of a panel that begins there: below, it would cover the next control.
pub fn tooltip_left(response: &Response, left: f32, tip: &str) {
    let panel = Rect::from_x_y_ranges(left..=response.rect.right(), response.rect.y_range());
    shown(response, tip, |mut tooltip| {
        tooltip.popup = tooltip.popup.anchor(panel).align(RectAlign::LEFT_START);
        tooltip.gap(GRID)
    });
}

/// A tip towards the middle of the window, where no control lies: below what
/// is at the top, above what is at the bottom.
pub fn with_tooltip(response: Response, tip: &str) -> Response {
    let is_low = response.rect.center().y > response.ctx.content_rect().center().y;
    let align = if is_low {
        RectAlign::TOP_START
    } else {
        RectAlign::BOTTOM_START
    };
    shown(&response, tip, |mut tooltip| {
        tooltip.popup = tooltip.popup.align(align);
        tooltip
    });
    response
}

/// A tip of a control, whether it can be used or not.
fn shown(response: &Response, tip: &str, placed: impl Fn(Tooltip<'_>) -> Tooltip<'_>) {
    for tooltip in [
        Tooltip::for_enabled(response),
        Tooltip::for_disabled(response),
    ] {
        placed(tooltip).show(|ui| ui.label(tip));
    }
}

/// A row with a slider and a number.
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
        // A slider takes no width of its own accord; what is left of the row, however wide the
        // panel is.
        ui.spacing_mut().slider_width = (ui.available_width() - GRID).max(40.0);
        let slider = Slider::new(value, range)
            .logarithmic(logarithmic)
            .clamping(SliderClamping::Edits)
            .show_value(false);
        number | ui.add(slider)
    });
}

/// A number that is dragged or typed: within its range, at so much a point of the way, with so many
/// decimals.
pub fn drag<N: Numeric>(
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

/// A row with a number alone.
pub fn number(ui: &mut Ui, label: &str, tip: &str, value: DragValue<'_>) {
    row(ui, label, tip, |ui| {
        ui.add_sized([72.0, CONTROL_HEIGHT], value)
    });
}

/// A row with a switch.
pub fn toggle(ui: &mut Ui, label: &str, tip: &str, on: &mut bool) {
    row(ui, label, tip, |ui| switch(ui, label, on));
}

/// A row with a switch for whether the program finds a value itself; off, it starts from the usual
/// one.
pub fn automatic_toggle<T>(ui: &mut Ui, label: &str, tip: &str, value: &mut Option<T>, usual: T) {
    let mut is_automatic = value.is_none();
    toggle(ui, label, tip, &mut is_automatic);
    if is_automatic {
        *value = None;
    } else {
        value.get_or_insert(usual);
    }
}

/// A switch.
pub fn switch(ui: &mut Ui, label: &str, on: &mut bool) -> Response {
    let palette = ThemePalette::of(ui);
    let (rect, mut response) = ui.allocate_exact_size(vec2(32.0, CONTROL_HEIGHT), Sense::click());
    if response.clicked() {
        *on = !*on;
        response.mark_changed();
    }
    let is_on = *on;
    response.widget_info(|| WidgetInfo::selected(WidgetType::Checkbox, true, is_on, label));
    let along = ui.ctx().animate_bool_responsive(response.id, is_on);
    let track = Rect::from_center_size(rect.center(), vec2(32.0, 16.0));
    // The place of the knob says the same as the colour, for eyes that do not tell the two apart.
    let fill = if is_on { palette.accent } else { palette.hover };
    ui.painter()
        .rect(track, 8.0, fill, (1.0, palette.line), StrokeKind::Inside);
    let knob = egui::pos2(
        egui::lerp(track.left() + 8.0..=track.right() - 8.0, along),
        track.center().y,
    );
    ui.painter()
        .circle_filled(knob, 5.5, if is_on { palette.panel } else { palette.weak });
    response
}

/// A row of choices of which one holds; each tells what it does.
pub fn choices<T: PartialEq + Clone>(
    ui: &mut Ui,
    value: &mut T,
    options: &[(T, &str, &str)],
) -> Response {
    choices_where(ui, value, options, |_| true)
}

/// The same, of which only some can be chosen. Each tells what it does: the response is of none of
/// them, or what a row tells would be told beside.
pub fn choices_where<T: PartialEq + Clone>(
    ui: &mut Ui,
    value: &mut T,
    options: &[(T, &str, &str)],
    can: impl Fn(&T) -> bool,
) -> Response {
    // That of the panel: beside the row it would cover the label.
    let (left, width) = (ui.clip_rect().left(), ui.available_width());
    let gap = 2.0;
    let count = options.len().max(1) as f32;
    let each = vec2((width - gap * (count - 1.0)) / count, CONTROL_HEIGHT);
    ui.spacing_mut().item_spacing.x = gap;
    for (option, label, tip) in options {
        let chosen = *value == *option;
        let cell = ui.add_enabled_ui(can(option), |ui| choice(ui, chosen, label, each));
        let response = cell.inner;
        tooltip_left(&response, left, tip);
        if response.clicked() {
            *value = option.clone();
        }
    }
    ui.interact(Rect::NOTHING, ui.id().with("choices"), Sense::hover())
}

/// A row of which one choice holds.
pub fn choices_row<T: PartialEq + Clone>(
    ui: &mut Ui,
    label: &str,
    tip: &str,
    value: &mut T,
    options: &[(T, &str, &str)],
) {
    row(ui, label, tip, |ui| choices(ui, value, options));
}

/// One choice among several.
pub fn choice(ui: &mut Ui, chosen: bool, label: &str, size: Vec2) -> Response {
    let palette = ThemePalette::of(ui);
    let (rect, response) = ui.allocate_exact_size(size, Sense::click());
    response.widget_info(|| WidgetInfo::selected(WidgetType::SelectableLabel, true, chosen, label));
    let (fill, text) = match (ui.is_enabled(), chosen, response.hovered()) {
        (false, ..) => (palette.panel, palette.faint()),
        (true, true, _) => (palette.accent_ground, palette.text),
        (true, false, true) => (palette.hover, palette.text),
        (true, false, false) => (palette.raised, palette.weak),
    };
    ui.painter().rect_filled(rect, RADIUS, fill);
    ui.painter()
        .text(rect.center(), Align2::CENTER_CENTER, label, SMALL, text);
    response
}

/// One choice as wide as this, which tells what it does; whether it was taken.
pub fn choice_button(ui: &mut Ui, chosen: bool, label: &str, tip: &str, width: f32) -> bool {
    let response = choice(ui, chosen, label, vec2(width, CONTROL_HEIGHT));
    with_tooltip(response, tip).clicked()
}

/// A row of all values of an option.
pub fn choice_row<T: Choice>(ui: &mut Ui, label: &str, tip: &str, value: &mut T) {
    let row = |choice: &T| (*choice, choice.name().title, choice.name().sentence);
    let options: Vec<_> = T::CHOICES.iter().map(row).collect();
    choices_row(ui, label, tip, value, &options);
}

/// A drop-down list of all values of an option.
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

/// A row with such a list, and below it what the chosen value means.
pub fn choice_list<T: Choice>(ui: &mut Ui, label: &str, tip: &str, value: &mut T) {
    row(ui, label, tip, |ui| {
        menu(ui, label, value, ui.available_width())
    });
    hint(ui, value.name().sentence);
}

/// A button with an icon, of that size.
pub fn icon_button(ui: &mut Ui, icon: Icon, tip: &str, size: Vec2) -> Response {
    let palette = ThemePalette::of(ui);
    let (rect, response) = ui.allocate_exact_size(size, Sense::click());
    // A picture has no words: those who hear the window hear the tip.
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

/// A square button with an icon that asks for something.
pub fn intent_button(ui: &mut Ui, icon: Icon, tip: &str, intent: Intent, acts: &mut Vec<Intent>) {
    if icon_button(ui, icon, tip, vec2(32.0, 32.0)).clicked() {
        acts.push(intent);
    }
}

/// The ground of a panel at the window's edge, with this much room around what stands on it.
pub fn panel_frame(ui: &Ui, [left, right, top, bottom]: [i8; 4]) -> egui::Frame {
    let room = Margin {
        left,
        right,
        top,
        bottom,
    };
    egui::Frame::new()
        .fill(ThemePalette::of(ui).panel)
        .inner_margin(room)
}

/// A card above the stage: rounded, with room of so many points around what stands on it.
pub fn card<R>(ui: &mut Ui, room: impl Into<Margin>, content: impl FnOnce(&mut Ui) -> R) -> R {
    egui::Frame::window(ui.style())
        .corner_radius(CARD_RADIUS)
        .inner_margin(room)
        .show(ui, content)
        .inner
}

/// Words that stand back.
pub fn secondary_text(ui: &Ui, words: impl Into<String>) -> RichText {
    RichText::new(words)
        .small()
        .color(ThemePalette::of(ui).weak)
}

/// A layer above the panels and below what asks, held there at this corner or edge.
pub fn fixed_layer(name: &'static str, pivot: Align2, at: Pos2) -> Area {
    Area::new(name.into())
        .order(Order::Middle)
        .pivot(pivot)
        .fixed_pos(at)
}

/// Words in the middle of a card that is painted by hand.
pub fn text_card(
    painter: &Painter,
    card: Rect,
    words: Arc<Galley>,
    fill: Color32,
    line: (f32, Color32),
) {
    painter.rect(card, RADIUS, fill, line, StrokeKind::Inside);
    let corner = card.center() - words.size() / 2.0;
    // The words were laid out in their colour; this one is for words without any.
    painter.galley(corner, words, Color32::PLACEHOLDER);
}

/// A line of text that explains, wrapped.
pub fn hint(ui: &mut Ui, text: &str) {
    ui.add(egui::Label::new(secondary_text(ui, text)).wrap());
}

/// Lays its content out from the right.
pub fn from_right<R>(ui: &mut Ui, content: impl FnOnce(&mut Ui) -> R) -> R {
    ui.with_layout(Layout::right_to_left(Align::Center), content)
        .inner
}

/// The button that is most likely meant.
pub fn primary_button(ui: &mut Ui, text: &str) -> Response {
    let palette = ThemePalette::of(ui);
    let text = RichText::new(text).color(palette.text);
    ui.add(egui::Button::new(text).fill(palette.accent_ground))
}
