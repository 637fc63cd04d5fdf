//! Easing editor: a list of named easings, and below it a cubic Bézier curve with two handles that
//! the user can drag.

use bevy_egui::egui::containers::menu::{MenuConfig, SubMenuButton};
use bevy_egui::egui::{
    ComboBox, PopupCloseBehavior, Pos2, Rect, Response, Sense, Shape, Stroke, StrokeKind, Ui, pos2,
    vec2,
};

use crate::app::ui::kit::theme::{GRID, RADIUS, ThemePalette};
use crate::app::ui::kit::widgets::{secondary_text, tooltip_left};
use crate::settings::Choice;
use crate::transition::{EasingBezier, EasingFunction, NamedEasing};

/// Width and height of the canvas on which the curve is drawn, in points.
const CANVAS: (f32, f32) = (208.0, 136.0);

/// Maximum distance of the pointer from a handle that it grabs, in points: slightly more than the
/// width of a handle.
const REACH: f32 = 14.0;

/// Draws the easing editor as a drop-down list; changes `value`.
pub fn menu(ui: &mut Ui, salt: &str, value: &mut EasingFunction, width: f32) -> Response {
    let list = ComboBox::from_id_salt(salt)
        .width(width)
        .height(400.0)
        .selected_text(name(*value))
        // A drag of a handle must not close the list.
        .close_behavior(PopupCloseBehavior::CloseOnClickOutside);
    let shown = list.show_ui(ui, |ui| {
        let mut chosen = Some(*value);
        easing_list(ui, &mut chosen, None);
        *value = chosen.unwrap_or_default();
    });
    shown.response
}

/// Draws the easing editor as a submenu; changes `value`. `inherited` is the label of `None`, the
/// inherited easing.
pub fn submenu(ui: &mut Ui, value: &mut Option<EasingFunction>, inherited: &str) -> Response {
    let current = match value {
        Some(ease) => name(*ease),
        None => inherited,
    };
    let stays_open = MenuConfig::new().close_behavior(PopupCloseBehavior::CloseOnClickOutside);
    let button = SubMenuButton::new(format!("Easing: {current}")).config(stays_open);
    button
        .ui(ui, |ui| easing_list(ui, value, Some(inherited)))
        .0
}

fn name(ease: EasingFunction) -> &'static str {
    match ease {
        EasingFunction::Named(easing) => easing.name().title,
        EasingFunction::Bezier(_) => "Custom",
    }
}

fn easing_list(ui: &mut Ui, value: &mut Option<EasingFunction>, inherited: Option<&str>) {
    ui.set_width(CANVAS.0);
    if let Some(inherited) = inherited {
        ui.selectable_value(value, None, inherited);
    }
    for easing in NamedEasing::ALL {
        let name = easing.name();
        let row = ui.selectable_value(value, Some(easing.into()), name.title);
        tooltip_left(&row, row.rect.left(), name.sentence);
    }
    ui.add_space(GRID);
    let curve = value.unwrap_or_default().curve();
    if let Some(drawn) = canvas(ui, curve) {
        *value = Some(EasingFunction::Bezier(drawn));
    }
    ui.label(secondary_text(
        ui,
        "Drag a handle. Steep is fast, flat is slow.",
    ));
}

/// Draws the curve with its handles; returns the new curve if the user moved a handle.
fn canvas(ui: &mut Ui, curve: EasingBezier) -> Option<EasingBezier> {
    let (outer, response) = ui.allocate_exact_size(vec2(CANVAS.0, CANVAS.1), Sense::drag());
    let rect = outer.shrink(GRID);
    let palette = ThemePalette::of(ui);
    let line = Stroke::new(1.0, palette.line);
    ui.painter()
        .rect(outer, RADIUS, palette.raised, line, StrokeKind::Inside);
    let [x1, y1, x2, y2] = curve.handles();
    let dots = [canvas_pos(rect, x1, y1), canvas_pos(rect, x2, y2)];
    let ends = [rect.left_bottom(), rect.right_top()];
    for (dot, end) in dots.iter().zip(ends) {
        ui.painter().line_segment([*dot, end], (1.0, palette.weak));
    }
    let points = (0..=48).map(|k| {
        let x = f64::from(k) / 48.0;
        canvas_pos(rect, x, EasingFunction::Bezier(curve).apply(x))
    });
    let ink = Stroke::new(2.0, palette.text);
    ui.painter().add(Shape::line(points.collect(), ink));
    let pointer = response.interact_pointer_pos();
    let id = response.id;
    // A handle that is grabbed when a drag begins stays grabbed until the drag ends.
    if response.drag_started() {
        let handle_near = |at: Pos2| (0..2).find(|&k| dots[k].distance(at) < REACH);
        ui.data_mut(|data| data.insert_temp(id, pointer.and_then(handle_near)));
    }
    let grabbed: Option<usize> = ui.data(|data| data.get_temp(id)).flatten();
    let grabbed = grabbed.filter(|_| response.dragged());
    for (k, dot) in dots.iter().enumerate() {
        let ink = if grabbed == Some(k) {
            palette.accent
        } else {
            palette.text
        };
        ui.painter().circle(*dot, 5.0, palette.panel, (2.0, ink));
    }
    let (k, at) = grabbed.zip(pointer)?;
    let mut handles = curve.handles();
    handles[2 * k] = rounded((at.x - rect.left()) / rect.width());
    handles[2 * k + 1] = rounded((rect.bottom() - at.y) / rect.height());
    EasingBezier::new(handles)
        .ok()
        .filter(|drawn| *drawn != curve)
}

fn canvas_pos(rect: Rect, x: f64, y: f64) -> Pos2 {
    pos2(
        rect.left() + x as f32 * rect.width(),
        rect.bottom() - y as f32 * rect.height(),
    )
}

/// Clamps a coordinate of a handle to [0, 1] and rounds it to hundredths.
fn rounded(share: f32) -> f64 {
    (f64::from(share.clamp(0.0, 1.0)) * 100.0).round() / 100.0
}
