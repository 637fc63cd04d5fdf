//! The measures against t, side by side, with a line where t is; a click goes to a t.

use bevy_egui::egui::{Color32, Label, Panel, PointerButton, ScrollArea, Ui, vec2};
use egui_plot::{AxisHints, GridMark, HLine, Line, LineStyle, Plot, PlotPoints, VLine};

use crate::app::input::intent::Intent;
use crate::app::ui::kit::theme::{GRID, ThemePalette};
use crate::app::ui::kit::widgets::{panel_frame, secondary_text};
use crate::app::ui::stage::checks::unmeasured_reason;
use crate::app::ui::ui_state::{Intents, UiState};
use crate::measure::{FilmReport, Quantity};
use crate::settings::choice::Choice;

const HEIGHT: f32 = 168.0;

/// The least width of one plot.
const LEAST_WIDTH: f32 = 208.0;

/// Draws the panel.
pub fn show(root: &mut Ui, scene: &UiState, acts: &mut Intents) {
    let frame = panel_frame(root, [16, 16, 8, 4]);
    Panel::bottom("plots")
        .exact_size(HEIGHT)
        .resizable(false)
        .frame(frame)
        .show(root, |ui| match scene.measured.measures() {
            Some(measures) => row(ui, scene, &measures.film, acts),
            None => waiting(ui, scene),
        });
}

fn waiting(ui: &mut Ui, scene: &UiState) {
    let words = unmeasured_reason(scene);
    ui.centered_and_justified(|ui| ui.label(secondary_text(ui, words)));
}

fn row(ui: &mut Ui, scene: &UiState, film: &FilmReport, acts: &mut Intents) {
    let shown: Vec<(Quantity, Vec<[f64; 2]>)> = Quantity::ALL
        .into_iter()
        .map(|quantity| (quantity, film.series(quantity)))
        .filter(|(_, series)| !series.is_empty())
        .collect();
    let gap = 2.0 * GRID;
    // As many as fit whole; the others are scrolled to.
    let width = ui.available_width();
    let fit = ((width + gap) / (LEAST_WIDTH + gap)).floor().max(1.0);
    let count = fit.min(shown.len().max(1) as f32);
    let each = (width + gap) / count - gap;
    ScrollArea::horizontal().auto_shrink(false).show(ui, |ui| {
        ui.horizontal_top(|ui| {
            ui.spacing_mut().item_spacing.x = gap;
            for (quantity, series) in &shown {
                ui.allocate_ui(vec2(each, HEIGHT - 24.0), |ui| {
                    ui.vertical(|ui| one(ui, scene, *quantity, series, acts));
                });
            }
        });
    });
}

const NOWHERE: &str = "Without bound at every t: some triangle has no area or is turned over, \
    and what shrinks to nothing is sheared and stretched without end.";

fn one(ui: &mut Ui, scene: &UiState, quantity: Quantity, series: &[[f64; 2]], acts: &mut Intents) {
    let palette = ThemePalette::of(ui);
    // Of the leg that is looked at, as the measures are.
    let t = scene.session.within(scene.playback.t());
    ui.spacing_mut().item_spacing.y = 2.0;
    heading(ui, quantity, series, t);
    if !series.iter().any(|[_, value]| value.is_finite()) {
        ui.add(Label::new(secondary_text(ui, NOWHERE)).wrap());
        return;
    }
    let plot = axes(quantity, palette.weak).height(ui.available_height().min(HEIGHT - 52.0));
    let on_axis = |value: f64| drawn(quantity, value);
    let response = plot.show(ui, |plot| {
        if quantity == Quantity::MinDet {
            plot.hline(level(0.0, palette.problem));
        }
        let drawn: Vec<[f64; 2]> = series.iter().map(|[t, v]| [*t, on_axis(*v)]).collect();
        for run in runs(&drawn) {
            plot.line(
                Line::new(quantity.name().title, PlotPoints::from(run))
                    .color(palette.accent)
                    .width(1.75)
                    .allow_hover(false),
            );
        }
        plot.vline(
            VLine::new("t", t)
                .color(palette.text)
                .width(1.0)
                .allow_hover(false),
        );
        plot.pointer_coordinate()
    });
    let is_held = response.response.is_pointer_button_down_on()
        || response.response.dragged_by(PointerButton::Primary);
    if let Some(pointer) = response.inner.filter(|_| is_held) {
        // The axis shows a little more than was measured.
        let t = scene.session.beyond(pointer.x.clamp(0.0, 1.0));
        acts.push(Intent::Seek(t));
    }
    response
        .response
        .on_hover_text(format!("{} Click to go to a t.", quantity.name().sentence));
}

/// The empty plot: it cannot be dragged or zoomed.
fn axes(quantity: Quantity, colour: Color32) -> Plot<'static> {
    let plot = Plot::new(("plot", quantity.name().title))
        // All plots show the same t from edge to edge, so that they can be compared.
        .allow_drag(false)
        .allow_zoom(false)
        .allow_scroll(false)
        .allow_boxed_zoom(false)
        .allow_double_click_reset(false)
        .show_x(false)
        .show_y(false)
        .show_background(false)
        .grid_color(colour)
        .include_x(0.0)
        .include_x(1.0)
        // Room for half of the last label.
        .set_margin_fraction(vec2(0.04, 0.08))
        .label_formatter(|_| None)
        .y_grid_spacer(|input| marks(input.bounds))
        .custom_x_axes(vec![t_axis(colour)])
        .custom_y_axes(vec![value_axis(quantity, colour)]);
    least(quantity)
        .into_iter()
        .map(|value| drawn(quantity, value))
        .fold(plot, Plot::include_y)
}

/// Ratios run over many powers of ten where something is born from a point.
fn is_ratio(quantity: Quantity) -> bool {
    matches!(
        quantity,
        Quantity::WorstConformal | Quantity::WorstIsometric
    )
}

/// A value on its axis, which for ratios is logarithmic.
fn drawn(quantity: Quantity, value: f64) -> f64 {
    if is_ratio(quantity) {
        value.log10()
    } else {
        value
    }
}

fn t_axis(colour: Color32) -> AxisHints<'static> {
    AxisHints::new_x()
        .tick_label_color(colour)
        .formatter(|mark, _| format!("{}", (mark.value * 100.0).round() / 100.0))
}

/// Three to six marks from the least to the greatest value, a round step apart: tenfold steps alone
/// leave an axis up to 9,000 without any that there is room for.
fn marks((least, greatest): (f64, f64)) -> Vec<GridMark> {
    let rough = (greatest - least) / 5.0;
    let ten = 10_f64.powf(rough.log10().floor());
    let round = [1.0, 2.0, 5.0, 10.0].map(|digit| digit * ten);
    let wide = |step: &f64| *step > 0.0 && *step >= rough;
    let Some(step_size) = round.into_iter().find(wide) else {
        return Vec::new(); // of an axis without a length
    };
    let first = (least / step_size).ceil() as i64;
    let last = (greatest / step_size).floor() as i64;
    let at = |k: i64| GridMark {
        value: k as f64 * step_size,
        step_size,
    };
    (first..=last).map(at).collect()
}

fn value_axis(quantity: Quantity, colour: Color32) -> AxisHints<'static> {
    AxisHints::new_y()
        .tick_label_color(colour)
        // As wide as the longest number, so that plots do not jump as their numbers change.
        .min_thickness(36.0)
        .formatter(move |mark, _| {
            let value = mark.value;
            short(if is_ratio(quantity) {
                10.0_f64.powf(value)
            } else {
                value
            })
        })
}

fn level(y: f64, colour: Color32) -> HLine {
    HLine::new("zero", y)
        .color(colour)
        .width(1.0)
        .style(LineStyle::dashed_loose())
        .allow_hover(false)
}

/// The name, and the value where t is.
fn heading(ui: &mut Ui, quantity: Quantity, series: &[[f64; 2]], t: f64) {
    let nearest = series
        .iter()
        .min_by(|a, b| (a[0] - t).abs().total_cmp(&(b[0] - t).abs()));
    ui.horizontal(|ui| {
        ui.label(secondary_text(ui, quantity.name().title));
        if let Some([_, value]) = nearest.filter(|_| (0.0..=1.0).contains(&t)) {
            ui.small(short(*value));
        }
    });
}

/// Stretches without a gap: what is infinite cannot be drawn.
fn runs(series: &[[f64; 2]]) -> Vec<Vec<[f64; 2]>> {
    series
        .split(|[_, value]| !value.is_finite())
        .filter(|run| !run.is_empty())
        .map(<[[f64; 2]]>::to_vec)
        .collect()
}

/// What the axis always shows: counts start at 0 and reach 1, distortions start at 1.
fn least(quantity: Quantity) -> Vec<f64> {
    match quantity {
        Quantity::Area | Quantity::Perimeter | Quantity::Turning => vec![0.0],
        Quantity::WorstConformal | Quantity::WorstIsometric => vec![1.0, 2.0],
        Quantity::MinDet => vec![0.0, 1.0],
        Quantity::Folds | Quantity::Crossings | Quantity::Pieces | Quantity::Holes => {
            vec![0.0, 1.0]
        }
    }
}

fn short(value: f64) -> String {
    match value.abs() {
        v if !v.is_finite() => "folded".to_owned(),
        v if v.fract() == 0.0 && v < 1e6 => format!("{value:.0}"),
        v if (0.01..1e6).contains(&v) => {
            let decimals = if v >= 100.0 { 0 } else { 2 };
            format!("{value:.decimals$}")
        }
        _ => format!("{value:.1e}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_infinite_is_a_gap() {
        let series = [[0.0, 1.0], [0.25, f64::INFINITY], [0.5, 2.0], [0.75, 3.0]];
        assert_eq!(
            runs(&series),
            [vec![[0.0, 1.0]], vec![[0.5, 2.0], [0.75, 3.0]]]
        );
    }

    #[test]
    fn every_axis_has_marks_and_room_for_them() {
        for greatest in (1..200).map(|k| 1.3_f64.powi(k - 100)) {
            let marks = marks((0.0, greatest));
            assert!((3..=6).contains(&marks.len()), "{greatest}: {marks:?}");
        }
        assert!(marks((2.0, 2.0)).is_empty() && marks((f64::NAN, 1.0)).is_empty());
    }

    #[test]
    fn numbers_are_short() {
        assert_eq!(short(3.0), "3");
        assert_eq!(short(1.2345), "1.23");
        assert_eq!(short(123.4), "123");
        assert_eq!(short(49_788.4), "49788");
        assert_eq!(short(0.000_12), "1.2e-4");
        assert_eq!(short(f64::INFINITY), "folded");
    }
}
