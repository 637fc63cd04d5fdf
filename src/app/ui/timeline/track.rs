//! The track: t from left to right, with its stops, and the land beyond 0 and 1.

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
use crate::io::sanitize::SanitizedLine;
use crate::project::Project;
use crate::transition::{TransitionStop, TransitionStyle, colour_fraction};

/// Scrubbing snaps to ends and stops within so many points: near enough to be meant. Two tenths
/// are some sixty apart in the smallest window.
const SNAP: f32 = 5.0;

/// What is offered first as the time of a way.
const USUAL_SECS: f64 = 2.0;

const BAR_HEIGHT: f32 = 6.0;

const FONT: FontId = FontId::proportional(11.5);

/// What the word beyond the ends takes.
const BEYOND_WORDS: f32 = 76.0;

/// The room that a design's name needs to be begun.
const LEAST_NAME: f32 = 48.0;

/// Draws the track, with pictures of the film below it if there is room, and takes the user's
/// hand.
pub fn show(
    ui: &mut Ui,
    scene: &UiState,
    draft: &mut Project,
    has_pictures: bool,
    acts: &mut Intents,
) {
    let size = vec2(ui.available_width(), ui.available_height());
    let (rect, response) = ui.allocate_exact_size(size, Sense::click_and_drag());
    let ruler = TimelineRuler::new(rect, scene, &draft.stops);
    let names = scene.session.names_on_the_way();
    scrub(&response, ruler, &draft.stops, acts);
    beyond(ui, ruler);
    bar(ui, ruler, &draft.style, scene.session.way());
    let is_path = scene.session.whole().is_some_and(Project::follows_path);
    ticks(ui, ruler, &names, is_path);
    if has_pictures {
        filmstrip::show(ui, scene, ruler, ruler.y + 30.0, acts);
    }
    stops(ui, ruler, &mut draft.stops, acts);
    playhead(ui, ruler, scene.playback.t());
}

fn scrub(response: &Response, ruler: TimelineRuler, stops: &[TransitionStop], acts: &mut Intents) {
    // A press moves t at once, and not only when it has become a drag.
    let is_held = response.dragged() || response.is_pointer_button_down_on();
    let Some(pointer) = response.interact_pointer_pos().filter(|_| is_held) else {
        return;
    };
    let places = stops.iter().map(|stop| stop.t);
    let designs = (0..=ruler.end as usize).map(|k| k as f64);
    let places = places.chain(designs);
    let near = places
        .map(|t| (t, (ruler.x(t) - pointer.x).abs()))
        .filter(|(_, d)| *d < SNAP);
    // On a screen a point is more than a thousandth of t: ends and stops are meant exactly.
    let snapped = near.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(t, _)| t);
    acts.push(Intent::Seek(
        snapped.unwrap_or_else(|| rounded(ruler.t(pointer.x))),
    ));
}

/// To a thousandth, the finest that is shown.
fn rounded(t: f64) -> f64 {
    (t * 1000.0).round() / 1000.0
}

fn word(ui: &Ui, at: Pos2, word: &str, colour: Color32) {
    ui.painter()
        .text(at, Align2::CENTER_CENTER, word, FONT, colour);
}

fn beyond(ui: &Ui, ruler: TimelineRuler) {
    let palette = ThemePalette::of(ui);
    for (from, to) in [(ruler.from, 0.0), (ruler.end, ruler.to)] {
        let (a, b) = (pos2(ruler.x(from), ruler.y), pos2(ruler.x(to), ruler.y));
        let stroke = (2.0, palette.amber.gamma_multiply(0.6));
        ui.painter()
            .extend(Shape::dashed_line(&[a, b], stroke, 4.0, 4.0));
        let middle = a.lerp(b, 0.5) + vec2(0.0, 18.0);
        word(ui, middle, "extrapolation", palette.amber);
    }
}

fn bar(ui: &Ui, ruler: TimelineRuler, style: &TransitionStyle, way: (usize, bool)) {
    const STEPS: u32 = 32;
    let mut mesh = Mesh::default();
    for i in 0..=STEPS {
        let share = f64::from(i) / f64::from(STEPS);
        let [r, g, b] = style.fill_at(colour_fraction(share * ruler.end, way)).0;
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

/// A number at each tenth of a pair, and a name at each design of more.
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
        word(ui, at, &label, colour);
    }
}

/// Its number and its name at each design, as far as there is room.
fn designs(ui: &Ui, ruler: TimelineRuler, names: &[String]) {
    let palette = ThemePalette::of(ui);
    let between = ruler.x(1.0) - ruler.x(0.0) - 2.0 * GRID;
    // Beside the words beyond, which are in the middle there.
    let outside = ruler.x(0.0) - ruler.x(ruler.from);
    let at_ends = outside - BEYOND_WORDS - 2.0 * GRID;
    for (k, name) in names.iter().enumerate() {
        let x = ruler.x(k as f64);
        let top = ruler.y + BAR_HEIGHT / 2.0 + 3.0;
        ui.painter().vline(x, top..=top + 6.0, (1.0, palette.weak));
        let is_end = k == 0 || k + 1 == names.len();
        let room = if is_end {
            between.min(at_ends)
        } else {
            between
        };
        let words = match room >= LEAST_NAME {
            true => format!("{k} {}", SanitizedLine(name)),
            false => k.to_string(),
        };
        let mut job = LayoutJob::simple_singleline(words, FONT, palette.text);
        job.wrap = TextWrapping::truncate_at_width(room.max(LEAST_NAME));
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

fn stops(ui: &mut Ui, ruler: TimelineRuler, stops: &mut Vec<TransitionStop>, acts: &mut Intents) {
    // Taken out after the loop, which goes through the list that it would be taken out of.
    let mut deleted = None;
    let places: Vec<f64> = stops.iter().map(|stop| stop.t).collect();
    for (index, stop) in stops.iter_mut().enumerate() {
        let at = pos2(ruler.x(stop.t), ruler.y - 14.0);
        // By number and not by name, which may be written while its menu is open.
        let id = ui.id().with(("stop", index));
        let name = label(stop, &places);
        let response = marker(ui, at, id, &name);
        if response.clicked() {
            acts.push(Intent::Seek(stop.t));
        }
        if let Some(pointer) = response
            .interact_pointer_pos()
            .filter(|_| response.dragged())
        {
            stop.t = rounded(ruler.t(pointer.x));
        }
        let tip = format!(
            "Stop {} at t = {:.3}. Click to go there, drag to move, right-click for its name, \
             notes, or to delete it.",
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

/// Its name, or its number from left to right.
fn label(stop: &TransitionStop, places: &[f64]) -> String {
    if !stop.name.is_empty() {
        return SanitizedLine(&stop.name).to_string();
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
    word(ui, at - vec2(0.0, 12.0), name, colour);
    response
}

/// Whether the stop is to be deleted.
fn stop_menu(ui: &mut Ui, stop: &mut TransitionStop) -> bool {
    ui.set_width(240.0);
    ui.add(
        egui::TextEdit::singleline(&mut stop.name)
            .hint_text("Name, shown as a caption")
            .desired_width(f32::INFINITY),
    )
    .on_hover_text("The name of the stop: captions in films and talks show it.");
    ui.add(
        egui::TextEdit::multiline(&mut stop.note)
            .hint_text("Notes for the speaker")
            .desired_rows(3)
            .desired_width(f32::INFINITY),
    )
    .on_hover_text("What to say here: only the speaker sees it, in a window of its own (N).");
    ui.horizontal(|ui| {
        ui.label("t");
        let number = DragValue::new(&mut stop.t).speed(0.002).max_decimals(6);
        ui.add(number)
            .on_hover_text("Where the stop is; outside 0 to 1 it extrapolates.");
    });
    easing_editor::submenu(ui, &mut stop.easing, "as the pass")
        .on_hover_text("How t runs from this stop up to the next one.");
    ui.horizontal(|ui| {
        ui.label("Rest");
        let number = DragValue::new(&mut stop.hold_secs).range(0.0..=600.0);
        ui.add(number.speed(0.02).max_decimals(2).suffix(" s"))
            .on_hover_text("How long a pass waits here.");
    });
    ui.horizontal(|ui| {
        let mut has_own = stop.duration_secs.is_some();
        ui.checkbox(&mut has_own, "Own time to the next")
            .on_hover_text(
                "How long it takes from here up to the next stop, whatever the pass takes.",
            );
        match &mut stop.duration_secs {
            Some(secs) if has_own => {
                let number = DragValue::new(secs).range(0.1..=600.0);
                ui.add(number.speed(0.02).max_decimals(2).suffix(" s"));
            }
            secs => *secs = has_own.then_some(USUAL_SECS),
        }
    });
    let is_deleted = ui.button("Delete stop").clicked();
    if is_deleted {
        ui.close();
    }
    is_deleted
}
