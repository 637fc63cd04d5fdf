//! Track of the timeline: t from left to right, with stops and their menus, the playhead, and the
//! extrapolated ranges before the first design and after the last one.

use bevy_egui::egui::text::{LayoutJob, TextWrapping};
use bevy_egui::egui::{
    self, Align2, Color32, DragValue, FontId, Id, Mesh, Pos2, Rect, Response, Sense, Shape, Stroke,
    Ui, pos2, vec2,
};

use crate::app::input::intent::Intent;
use crate::app::ui::kit::easing_editor;
use crate::app::ui::kit::theme::{GRID, ThemePalette};
use crate::app::ui::timeline::filmstrip;
use crate::app::ui::timeline::ruler::TimelineRuler;
use crate::app::ui::ui_state::{Intents, UiState};
use crate::io::sanitize::SanitizedName;
use crate::project::Project;
use crate::transition::{SequenceLayout, TransitionStop, TransitionStyle, colour_fraction};

/// Maximum distance between the pointer and a design or stop to which t snaps, in points
/// (tolerance: tenths of t are about 60 points apart in the smallest window).
const SNAP_DISTANCE: f32 = 5.0;

/// Initial value of the custom time from a stop to the next one, in seconds.
const DEFAULT_CUSTOM_SECS: f64 = 2.0;

/// Height of the coloured bar that represents the film, in points.
const BAR_HEIGHT: f32 = 6.0;

/// Font of numbers and names on the track.
const FONT: FontId = FontId::proportional(11.5);

/// Width of the word “extrapolation”, in points.
const EXTRAPOLATION_WIDTH: f32 = 76.0;

/// Minimum width of the space for the name of a design, in points. In less space, only the number
/// of the design is drawn.
const MIN_NAME_WIDTH: f32 = 48.0;

/// Draws the track and, if `has_pictures`, the film strip below it, and handles the pointer on
/// them. Changes of stops are made in `draft`.
pub fn show(
    ui: &mut Ui,
    state: &UiState,
    draft: &mut Project,
    has_pictures: bool,
    intents: &mut Intents,
) {
    let size = vec2(ui.available_width(), ui.available_height());
    let (rect, response) = ui.allocate_exact_size(size, Sense::click_and_drag());
    let ruler = TimelineRuler::new(rect, state, &draft.stops);
    let names = state.session.names_along_path();
    scrub(&response, ruler, &draft.stops, intents);
    extrapolation_ranges(ui, ruler);
    bar(ui, ruler, &draft.style, state.session.sequence_layout());
    let is_path = state
        .session
        .whole_project()
        .is_some_and(Project::follows_path);
    ticks(ui, ruler, &names, is_path);
    if has_pictures {
        filmstrip::show(ui, state, ruler, ruler.y + 30.0, intents);
    }
    stops(ui, ruler, &mut draft.stops, intents);
    playhead(ui, ruler, state.playback.t());
}

fn scrub(
    response: &Response,
    ruler: TimelineRuler,
    stops: &[TransitionStop],
    intents: &mut Intents,
) {
    // A press of the mouse button moves t at once, even if the pointer does not move.
    let is_pressed = response.dragged() || response.is_pointer_button_down_on();
    let Some(pointer) = response.interact_pointer_pos().filter(|_| is_pressed) else {
        return;
    };
    let snap_ts = stops.iter().map(|stop| stop.t);
    let designs = (0..=ruler.end as usize).map(|k| k as f64);
    let snap_ts = snap_ts.chain(designs);
    let snap_candidates = snap_ts
        .map(|t| (t, (ruler.x(t) - pointer.x).abs()))
        .filter(|(_, d)| *d < SNAP_DISTANCE);
    // A point on the screen is wider than a thousandth of t, so designs and stops could not be
    // reached exactly without snapping.
    let snapped = snap_candidates
        .min_by(|a, b| a.1.total_cmp(&b.1))
        .map(|(t, _)| t);
    intents.push(Intent::Seek(
        snapped.unwrap_or_else(|| rounded(ruler.t(pointer.x))),
    ));
}

/// Rounds a t to thousandths, as precisely as the window shows it.
fn rounded(t: f64) -> f64 {
    (t * 1000.0).round() / 1000.0
}

fn draw_label(ui: &Ui, at: Pos2, text: &str, colour: Color32) {
    ui.painter()
        .text(at, Align2::CENTER_CENTER, text, FONT, colour);
}

fn extrapolation_ranges(ui: &Ui, ruler: TimelineRuler) {
    let palette = ThemePalette::of(ui);
    for (from, to) in [(ruler.from, 0.0), (ruler.end, ruler.to)] {
        let (a, b) = (pos2(ruler.x(from), ruler.y), pos2(ruler.x(to), ruler.y));
        let stroke = (2.0, palette.amber.gamma_multiply(0.6));
        ui.painter()
            .extend(Shape::dashed_line(&[a, b], stroke, 4.0, 4.0));
        let middle = a.lerp(b, 0.5) + vec2(0.0, 18.0);
        draw_label(ui, middle, "extrapolation", palette.amber);
    }
}

fn bar(ui: &Ui, ruler: TimelineRuler, style: &TransitionStyle, layout: SequenceLayout) {
    /// Number of colour steps along the bar (heuristic).
    const STEPS: u32 = 32;
    let mut mesh = Mesh::default();
    for i in 0..=STEPS {
        let share = f64::from(i) / f64::from(STEPS);
        let [r, g, b] = style.fill_at(colour_fraction(share * ruler.end, layout)).0;
        let colour = Color32::from_rgb(r, g, b);
        let x = ruler.x(share * ruler.end);
        mesh.colored_vertex(pos2(x, ruler.y - BAR_HEIGHT / 2.0), colour);
        mesh.colored_vertex(pos2(x, ruler.y + BAR_HEIGHT / 2.0), colour);
        if i > 0 {
            let k = 2 * i;
            mesh.add_triangle(k - 2, k - 1, k);
            mesh.add_triangle(k - 1, k, k + 1);
        }
    }
    ui.painter().add(Shape::mesh(mesh));
}

/// Draws the ticks of the track: a number at each tenth of t for a film of two designs, the name of
/// each design for longer films.
fn ticks(ui: &Ui, ruler: TimelineRuler, names: &[String], is_path: bool) {
    if ruler.end > 1.0 || is_path {
        return designs(ui, ruler, names);
    }
    let palette = ThemePalette::of(ui);
    for tenth in 0..=10u8 {
        let x = ruler.x(f64::from(tenth) / 10.0);
        let is_end = tenth % 10 == 0;
        let length = if tenth % 5 == 0 { 6.0 } else { 4.0 };
        let top = ruler.y + BAR_HEIGHT / 2.0 + 3.0;
        ui.painter()
            .vline(x, top..=top + length, (1.0, palette.weak));
        let label = match tenth {
            0 => "0 source".to_owned(),
            10 => "1 target".to_owned(),
            n => format!("0.{n}"),
        };
        let colour = if is_end { palette.text } else { palette.weak };
        let at = pos2(x, ruler.y + 20.0);
        draw_label(ui, at, &label, colour);
    }
}

/// Draws the number of each design and, if there is room, its name.
fn designs(ui: &Ui, ruler: TimelineRuler, names: &[String]) {
    let palette = ThemePalette::of(ui);
    let segment_room = ruler.x(1.0) - ruler.x(0.0) - 2.0 * GRID;
    // The first and the last name must not cover the word “extrapolation”, which is centred in the
    // range before the first design and in the range after the last one.
    let margin_room = ruler.x(0.0) - ruler.x(ruler.from);
    let end_room = margin_room - EXTRAPOLATION_WIDTH - 2.0 * GRID;
    for (k, name) in names.iter().enumerate() {
        let x = ruler.x(k as f64);
        let top = ruler.y + BAR_HEIGHT / 2.0 + 3.0;
        ui.painter().vline(x, top..=top + 6.0, (1.0, palette.weak));
        let is_end = k == 0 || k + 1 == names.len();
        let name_width = if is_end {
            segment_room.min(end_room)
        } else {
            segment_room
        };
        let text = match name_width >= MIN_NAME_WIDTH {
            true => format!("{k} {}", SanitizedName(name)),
            false => k.to_string(),
        };
        let mut job = LayoutJob::simple_singleline(text, FONT, palette.text);
        job.wrap = TextWrapping::truncate_at_width(name_width.max(MIN_NAME_WIDTH));
        let galley = ui.painter().layout_job(job);
        let corner = pos2(x, ruler.y + 20.0) - 0.5 * galley.size();
        ui.painter().galley(corner, galley, palette.text);
    }
}

fn playhead(ui: &Ui, ruler: TimelineRuler, t: f64) {
    let palette = ThemePalette::of(ui);
    let x = ruler.x(t);
    let colour = if (0.0..=ruler.end).contains(&t) {
        palette.text
    } else {
        palette.amber
    };
    ui.painter()
        .vline(x, ruler.y - 12.0..=ruler.y + 12.0, (2.0, colour));
    ui.painter()
        .circle(pos2(x, ruler.y), 6.0, palette.panel, (2.0, colour));
}

fn stops(
    ui: &mut Ui,
    ruler: TimelineRuler,
    stops: &mut Vec<TransitionStop>,
    intents: &mut Intents,
) {
    // A deleted stop is removed after the loop, because the loop borrows the list.
    let mut deleted = None;
    let places: Vec<f64> = stops.iter().map(|stop| stop.t).collect();
    for (index, stop) in stops.iter_mut().enumerate() {
        let at = pos2(ruler.x(stop.t), ruler.y - 14.0);
        // The id contains the index and not the name, because the name can be edited while the menu
        // is open.
        let id = ui.id().with(("stop", index));
        let name = label(stop, &places);
        let response = marker(ui, at, id, &name);
        if response.clicked() {
            intents.push(Intent::Seek(stop.t));
        }
        if let Some(pointer) = response
            .interact_pointer_pos()
            .filter(|_| response.dragged())
        {
            stop.t = rounded(ruler.t(pointer.x));
        }
        let tip = format!(
            "Stop {} at t = {:.3}. Click to go there, drag to move, right-click to edit or delete.",
            name, stop.t
        );
        let response = response.on_hover_text(tip);
        response.context_menu(|ui| {
            if stop_menu(ui, stop) {
                deleted = Some(index);
            }
        });
    }
    if let Some(index) = deleted {
        stops.remove(index);
    }
}

/// Returns the name of a stop or, if it has none, its number from left to right.
fn label(stop: &TransitionStop, places: &[f64]) -> String {
    if !stop.name.is_empty() {
        return SanitizedName(&stop.name).to_string();
    }
    let before = places.iter().filter(|place| **place < stop.t).count();
    (before + 1).to_string()
}

fn marker(ui: &Ui, at: Pos2, id: Id, name: &str) -> Response {
    let palette = ThemePalette::of(ui);
    let rect = Rect::from_center_size(at, vec2(16.0, 16.0));
    let response = ui.interact(rect, id, Sense::click_and_drag());
    let colour = if response.hovered() || response.dragged() {
        palette.accent
    } else {
        palette.text
    };
    let diamond = [
        vec2(0.0, -5.0),
        vec2(5.0, 0.0),
        vec2(0.0, 5.0),
        vec2(-5.0, 0.0),
    ];
    let points = diamond.iter().map(|corner| at + *corner).collect();
    ui.painter()
        .add(Shape::convex_polygon(points, colour, Stroke::NONE));
    draw_label(ui, at - vec2(0.0, 12.0), name, colour);
    response
}

/// Draws the menu of a stop, in which its properties are edited; returns whether the user deletes
/// the stop.
fn stop_menu(ui: &mut Ui, stop: &mut TransitionStop) -> bool {
    ui.set_width(240.0);
    ui.add(
        egui::TextEdit::singleline(&mut stop.name)
            .hint_text("Name, shown as a caption")
            .desired_width(f32::INFINITY),
    )
    .on_hover_text("Name of the stop, shown as a caption in films and talks");
    ui.add(
        egui::TextEdit::multiline(&mut stop.note)
            .hint_text("Speaker notes")
            .desired_rows(3)
            .desired_width(f32::INFINITY),
    )
    .on_hover_text("Shown only to the speaker, in a separate window (N)");
    ui.horizontal(|ui| {
        ui.label("t");
        let number = DragValue::new(&mut stop.t).speed(0.002).max_decimals(6);
        ui.add(number)
            .on_hover_text("Position of the stop; beyond the designs the motion is extrapolated");
    });
    easing_editor::submenu(ui, &mut stop.easing, "same as film")
        .on_hover_text("Easing from this stop to the next one");
    ui.horizontal(|ui| {
        ui.label("Pause");
        let number = DragValue::new(&mut stop.hold_secs).range(0.0..=600.0);
        ui.add(number.speed(0.02).max_decimals(2).suffix(" s"))
            .on_hover_text("How long the film pauses at this stop");
    });
    ui.horizontal(|ui| {
        let mut has_custom = stop.duration_secs.is_some();
        ui.checkbox(&mut has_custom, "Custom time to next stop")
            .on_hover_text("Time from this stop to the next one, whatever the film's duration is");
        match &mut stop.duration_secs {
            Some(secs) if has_custom => {
                let number = DragValue::new(secs).range(0.1..=600.0);
                ui.add(number.speed(0.02).max_decimals(2).suffix(" s"));
            }
            secs => *secs = has_custom.then_some(DEFAULT_CUSTOM_SECS),
        }
    });
    let is_deleted = ui.button("Delete stop").clicked();
    if is_deleted {
        ui.close();
    }
    is_deleted
}
