//! Panel with graphs of the measured quantities over t, side by side. A click or drag on a graph
//! moves the film to that t.

use bevy_egui::egui::{Color32, Label, Panel, PointerButton, ScrollArea, Ui, vec2};
use egui_plot::{AxisHints, GridMark, HLine, Line, LineStyle, Plot, PlotPoints, VLine};

use crate::app::analysis::film_measures::FilmMeasures;
use crate::app::input::intent::Intent;
use crate::app::ui::kit::theme::{GRID, ThemePalette};
use crate::app::ui::kit::widgets::{panel_frame, secondary_text};
use crate::app::ui::stage::checks::unmeasured_reason;
use crate::app::ui::ui_state::{Intents, UiState};
use crate::measure::Quantity;
use crate::settings::{Choice, ChoiceName};
use crate::structure::StructureQuantity;

/// Height of the panel with the graphs, in points.
const HEIGHT: f32 = 168.0;

/// Minimum width of one graph, in points.
const MIN_WIDTH: f32 = 208.0;

/// Draws the panel with the graphs, or the reason why there are no measurements.
pub fn show(root: &mut Ui, state: &UiState, intents: &mut Intents) {
    let frame = panel_frame(root, [16, 16, 8, 4]);
    Panel::bottom("plots")
        .exact_size(HEIGHT)
        .resizable(false)
        .frame(frame)
        .show(root, |ui| match state.measures.measures() {
            Some(measures) => graphs_row(ui, state, measures, intents),
            None => pending(ui, state),
        });
}

fn pending(ui: &mut Ui, state: &UiState) {
    let text = unmeasured_reason(state);
    ui.centered_and_justified(|ui| ui.label(secondary_text(ui, text)));
}

/// Quantity of a graph.
#[derive(Clone, Copy, PartialEq)]
enum GraphQuantity {
    Shape(Quantity),
    Structure(StructureQuantity),
}

impl GraphQuantity {
    fn name(self) -> &'static ChoiceName {
        match self {
            Self::Shape(quantity) => quantity.name(),
            Self::Structure(quantity) => quantity.name(),
        }
    }
}

/// Returns the quantities that can be drawn, with their values. Structures are described by their
/// own quantities; the area and the outline of drawn bars mean nothing.
fn graphs(measures: &FilmMeasures) -> Vec<(GraphQuantity, Vec<[f64; 2]>)> {
    let structure = measures
        .structure
        .as_ref()
        .and_then(|all| all.as_ref().ok());
    let of_structure = structure.into_iter().flat_map(|structure| {
        let all = StructureQuantity::ALL.into_iter();
        all.map(|quantity| {
            (
                GraphQuantity::Structure(quantity),
                structure.series(quantity),
            )
        })
    });
    let is_outline = |quantity: &Quantity| {
        matches!(
            quantity,
            Quantity::Area | Quantity::Perimeter | Quantity::Turning
        )
    };
    let of_shape = Quantity::ALL
        .into_iter()
        .filter(|quantity| structure.is_none() || !is_outline(quantity))
        .map(|quantity| {
            (
                GraphQuantity::Shape(quantity),
                measures.film.series(quantity),
            )
        });
    of_structure
        .chain(of_shape)
        .filter(|(_, series)| !series.is_empty())
        .collect()
}

fn graphs_row(ui: &mut Ui, state: &UiState, measures: &FilmMeasures, intents: &mut Intents) {
    let graphs = graphs(measures);
    let gap = 2.0 * GRID;
    // The visible graphs fill the width of the panel, so that none is cut off. The user scrolls to
    // the other graphs.
    let width = ui.available_width();
    let max_count = ((width + gap) / (MIN_WIDTH + gap)).floor().max(1.0);
    let count = max_count.min(graphs.len().max(1) as f32);
    let graph_width = (width + gap) / count - gap;
    ScrollArea::horizontal().auto_shrink(false).show(ui, |ui| {
        ui.horizontal_top(|ui| {
            ui.spacing_mut().item_spacing.x = gap;
            for (quantity, series) in &graphs {
                ui.allocate_ui(vec2(graph_width, HEIGHT - 24.0), |ui| {
                    ui.vertical(|ui| graph(ui, state, *quantity, series, intents));
                });
            }
        });
    });
}

/// Text that replaces the graph of a quantity without finite values.
const UNBOUNDED_TEXT: &str = "Unbounded at every t: some triangle has no area or is flipped, so \
    it is stretched and sheared without limit.";

fn graph(
    ui: &mut Ui,
    state: &UiState,
    quantity: GraphQuantity,
    series: &[[f64; 2]],
    intents: &mut Intents,
) {
    let palette = ThemePalette::of(ui);
    // Like the measurements, t is relative to the current segment.
    let t = state.session.segment_t(state.playback.t());
    ui.spacing_mut().item_spacing.y = 2.0;
    heading(ui, quantity, series, t);
    if !series.iter().any(|[_, value]| value.is_finite()) {
        ui.add(Label::new(secondary_text(ui, UNBOUNDED_TEXT)).wrap());
        return;
    }
    let plot = axes(quantity, palette.weak).height(ui.available_height().min(HEIGHT - 52.0));
    let on_axis = |value: f64| axis_value(quantity, value);
    let response = plot.show(ui, |plot| {
        if quantity == GraphQuantity::Shape(Quantity::MinDet) {
            plot.hline(zero_line(0.0, palette.problem));
        }
        let axis_series: Vec<[f64; 2]> = series.iter().map(|[t, v]| [*t, on_axis(*v)]).collect();
        for run in runs(&axis_series) {
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
    let is_pressed = response.response.is_pointer_button_down_on()
        || response.response.dragged_by(PointerButton::Primary);
    if let Some(pointer) = response.inner.filter(|_| is_pressed) {
        // The axis extends slightly beyond the measured range, which is 0 to 1, so t is clamped.
        let t = state.session.whole_t(pointer.x.clamp(0.0, 1.0));
        intents.push(Intent::Seek(t));
    }
    response.response.on_hover_text(format!(
        "{} Click to go to that moment.",
        quantity.name().sentence
    ));
}

/// Returns an empty plot with the axes of a quantity, which cannot be panned or zoomed.
fn axes(quantity: GraphQuantity, colour: Color32) -> Plot<'static> {
    let plot = Plot::new(("plot", quantity.name().title))
        // Panning and zooming are off, so that all graphs show the same range of t.
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
        // The margin leaves room for half of the last label.
        .set_margin_fraction(vec2(0.04, 0.08))
        .label_formatter(|_| None)
        .y_grid_spacer(|input| marks(input.bounds.0, input.bounds.1))
        .custom_x_axes(vec![t_axis(colour)])
        .custom_y_axes(vec![value_axis(quantity, colour)]);
    included_values(quantity)
        .into_iter()
        .map(|value| axis_value(quantity, value))
        .fold(plot, Plot::include_y)
}

/// Returns whether a quantity is a ratio: the conformal or isometric distortion of the worst face.
/// Such values span many powers of ten while a part grows from its seed shape.
fn is_ratio(quantity: GraphQuantity) -> bool {
    matches!(
        quantity,
        GraphQuantity::Shape(Quantity::WorstConformal | Quantity::WorstIsometric)
    )
}

/// Converts a value of a quantity to a coordinate on the quantity's axis, which is logarithmic for
/// ratios.
fn axis_value(quantity: GraphQuantity, value: f64) -> f64 {
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

/// Returns three to six marks of an axis from `min` to `max`, at round steps. The default steps of
/// egui are not used: they are powers of ten, and none suits an axis up to 9,000.
fn marks(min: f64, max: f64) -> Vec<GridMark> {
    let min_step = (max - min) / 5.0;
    let power_of_ten = 10_f64.powf(min_step.log10().floor());
    let round_steps = [1.0, 2.0, 5.0, 10.0].map(|digit| digit * power_of_ten);
    let is_wide_enough = |step: &f64| *step > 0.0 && *step >= min_step;
    let Some(step_size) = round_steps.into_iter().find(is_wide_enough) else {
        return Vec::new(); // the axis has no length
    };
    let first = (min / step_size).ceil() as i64;
    let last = (max / step_size).floor() as i64;
    let mark = |k: i64| GridMark {
        value: k as f64 * step_size,
        step_size,
    };
    (first..=last).map(mark).collect()
}

fn value_axis(quantity: GraphQuantity, colour: Color32) -> AxisHints<'static> {
    AxisHints::new_y()
        .tick_label_color(colour)
        // The axis is as wide as the longest number, so that a graph does not move when its numbers
        // change.
        .min_thickness(36.0)
        .formatter(move |mark, _| {
            let value = mark.value;
            format_value(if is_ratio(quantity) {
                10.0_f64.powf(value)
            } else {
                value
            })
        })
}

fn zero_line(y: f64, colour: Color32) -> HLine {
    HLine::new("zero", y)
        .color(colour)
        .width(1.0)
        .style(LineStyle::dashed_loose())
        .allow_hover(false)
}

/// Draws the name of a quantity and its value at the current t.
fn heading(ui: &mut Ui, quantity: GraphQuantity, series: &[[f64; 2]], t: f64) {
    let nearest = series
        .iter()
        .min_by(|a, b| (a[0] - t).abs().total_cmp(&(b[0] - t).abs()));
    ui.horizontal(|ui| {
        ui.label(secondary_text(ui, quantity.name().title));
        if let Some([_, value]) = nearest.filter(|_| (0.0..=1.0).contains(&t)) {
            ui.small(format_value(*value));
        }
    });
}

/// Returns the runs of points (t, value) between values that are not finite and cannot be drawn.
fn runs(series: &[[f64; 2]]) -> Vec<Vec<[f64; 2]>> {
    series
        .split(|[_, value]| !value.is_finite())
        .filter(|run| !run.is_empty())
        .map(<[[f64; 2]]>::to_vec)
        .collect()
}

/// Returns the values that the axis of a quantity always includes, such as 0 for an area.
fn included_values(quantity: GraphQuantity) -> Vec<f64> {
    let GraphQuantity::Shape(quantity) = quantity else {
        return vec![0.0];
    };
    match quantity {
        Quantity::Area | Quantity::Perimeter | Quantity::Turning => vec![0.0],
        Quantity::WorstConformal | Quantity::WorstIsometric => vec![1.0, 2.0],
        Quantity::MinDet => vec![0.0, 1.0],
        Quantity::Folds | Quantity::Crossings | Quantity::Pieces | Quantity::Holes => {
            vec![0.0, 1.0]
        }
    }
}

fn format_value(value: f64) -> String {
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
    fn infinite_values_are_gaps() {
        let series = [[0.0, 1.0], [0.25, f64::INFINITY], [0.5, 2.0], [0.75, 3.0]];
        assert_eq!(
            runs(&series),
            [vec![[0.0, 1.0]], vec![[0.5, 2.0], [0.75, 3.0]]]
        );
    }

    #[test]
    fn every_axis_has_marks_and_room_for_them() {
        for max in (1..200).map(|k| 1.3_f64.powi(k - 100)) {
            let marks = marks(0.0, max);
            assert!((3..=6).contains(&marks.len()), "{max}: {marks:?}");
        }
        assert!(marks(2.0, 2.0).is_empty() && marks(f64::NAN, 1.0).is_empty());
    }

    #[test]
    fn numbers_are_short() {
        assert_eq!(format_value(3.0), "3");
        assert_eq!(format_value(1.2345), "1.23");
        assert_eq!(format_value(123.4), "123");
        assert_eq!(format_value(49_788.4), "49788");
        assert_eq!(format_value(0.000_12), "1.2e-4");
        assert_eq!(format_value(f64::INFINITY), "folded");
    }
}
