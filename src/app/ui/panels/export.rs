//! Pictures and films: what they are made for, how they lie, and what comes of it.

use bevy_egui::egui::{Button, ComboBox, Frame, Key, Margin, Panel, Response, TextEdit, Ui, vec2};

use crate::app::input::intent::Intent;
use crate::app::input::preferences::{FilmExportOptions, FilmFileFormat, ImageScale, Preferences};
use crate::app::playback::player::landmarks;
use crate::app::ui::kit::icons;
use crate::app::ui::kit::theme::{CONTROL_HEIGHT, GRID};
use crate::app::ui::kit::widgets::{
    choice_row, choices, choices_row, choices_where, drag, from_right, hint, icon_button,
    primary_button, row, secondary_text, section, slider, toggle,
};
use crate::app::ui::ui_state::{Intents, UiState};
use crate::content::ContentKind;
use crate::export::{FilmKind, LayoutPreset, has_ffmpeg};
use crate::io::sanitize::SanitizedLine;
use crate::settings::choice::Choice;

/// The sides that are offered by name, in pixels along the shorter one.
const SIDES: [(u32, &str, &str); 4] = [
    (480, "480", "480 pixels along the shorter side"),
    (720, "720", "720 pixels along the shorter side: HD"),
    (1080, "1080", "1080 pixels along the shorter side: Full HD"),
    (2160, "4K", "2160 pixels along the shorter side: 4K"),
];

/// The fastest film that a GIF can be, in frames a second.
const GIF_FPS: u32 = 50;

/// Draws the options, in the place of the transition's.
pub fn show(ui: &mut Ui, scene: &UiState, acts: &mut Intents) {
    let mut draft = *scene.preferences;
    ui.horizontal(|ui| {
        ui.label(secondary_text(ui, "Pictures and films"));
        from_right(ui, |ui| {
            let tip = "Back to the options (Esc)";
            let close = icon_button(ui, icons::CLOSE, tip, vec2(24.0, 24.0));
            if close.clicked() {
                draft.film_options = false;
            }
        });
    });
    section(ui, "Film", |ui| film(ui, scene, &mut draft, acts));
    section(ui, "Picture of the stage", |ui| {
        picture(ui, &mut draft, acts);
    });
    if draft != *scene.preferences {
        acts.push(Intent::Prefer(draft));
    }
}

/// What comes of it, and what begins it: in sight wherever the options are scrolled to.
pub fn foot(ui: &mut Ui, scene: &UiState, acts: &mut Intents) {
    let frame = Frame::NONE.inner_margin(Margin::symmetric(0, 8));
    Panel::bottom("write the film").frame(frame).show(ui, |ui| {
        ui.set_width(ui.available_width());
        told(ui, scene);
        ui.add_space(GRID);
        let is_free = scene.recorder.work().is_none() && scene.film.0.is_some();
        ui.add_enabled_ui(is_free, |ui| {
            if primary_button(ui, "Write the film").clicked() {
                acts.push(Intent::Record);
            }
        });
    });
}

fn film(ui: &mut Ui, scene: &UiState, draft: &mut Preferences, acts: &mut Intents) {
    purpose(ui, draft);
    kept(ui, scene, acts);
    let layout = &mut draft.film.layout;
    let tip = "The shape of the film's pictures; the stage shows it.";
    choice_row(ui, "Shape", tip, &mut layout.aspect);
    let tip = "Pixels along the shorter side: one of these, or your own number.";
    row(ui, "Size", tip, |ui| {
        let own = drag(&mut layout.lines, 16..=4320, 4.0, 0);
        let own = ui.add_sized([48.0, CONTROL_HEIGHT], own);
        own | choices(ui, &mut layout.lines, &SIDES)
    });
    let tip = "What is free all around, as a part of the shorter side.";
    slider(ui, "Margin", tip, &mut layout.margin, 0.0..=0.3, false);
    let tip = "The names of the stops below, each while the film is near it; of the designs, where there are no named stops.";
    toggle(ui, "Captions", tip, &mut layout.has_captions);
    span(ui, scene, &mut draft.film);
    let tip = "How the film goes on at its end.";
    choice_row(ui, "Then", tip, &mut draft.film.ending);
    file(ui, scene, draft);
    advice(ui, scene, draft);
}

/// What is seen on the stage.
fn content(scene: &UiState) -> Option<ContentKind> {
    scene.session.project().and_then(|project| project.content)
}

const GIF: FilmFileFormat = FilmFileFormat::Film(FilmKind::Gif);

/// The kind of file, and what goes with it.
fn file(ui: &mut Ui, scene: &UiState, draft: &mut Preferences) {
    let before = draft.format(content(scene));
    let mut format = before;
    let can = |format: &FilmFileFormat| *format != FilmFileFormat::OPAQUE || has_ffmpeg();
    // Side by side they would lie over each other.
    let (moving, pixels): (Vec<_>, Vec<_>) = formats().into_iter().partition(|(format, ..)| {
        let outlines = [FilmKind::Svg, FilmKind::Html, FilmKind::Lottie];
        outlines.map(FilmFileFormat::Film).contains(format)
    });
    let tip = "The kind of file that a recording writes.";
    row(ui, "File", tip, |ui| {
        choices_where(ui, &mut format, &pixels, can)
    });
    let tip = "Files that move by themselves and keep the outlines sharp at any size.";
    row(ui, "Outlines", tip, |ui| {
        choices_where(ui, &mut format, &moving, can)
    });
    if format != before {
        draft.record_format = Some(format);
    }
    let is_gif = format == GIF;
    if is_gif {
        draft.film.fps = draft.film.fps.min(GIF_FPS);
    }
    let rates = [
        (25, "25", "As films in Europe"),
        (30, "30", "As films in America, and half of most screens"),
        (50, "50", "Very smooth; the fastest that a GIF can be"),
        (60, "60", "As fast as most screens; too fast for a GIF"),
    ];
    row(ui, "Rate", "Frames a second.", |ui| {
        let can = |fps: &u32| !is_gif || *fps <= GIF_FPS;
        choices_where(ui, &mut draft.film.fps, &rates, can)
    });
    let is_opaque = format == FilmFileFormat::OPAQUE;
    let mut is_transparent = draft.film.is_transparent && !is_opaque;
    row(ui, "Ground", "What lies behind the shapes.", |ui| {
        choices_where(ui, &mut is_transparent, &GROUNDS, |wish| {
            !wish || !is_opaque
        })
    });
    // An MP4 has none; what was wished is there again with another file.
    if !is_opaque {
        draft.film.is_transparent = is_transparent;
    }
}

/// What it is made for sets most of what follows.
fn purpose(ui: &mut Ui, draft: &mut Preferences) {
    let layout = &mut draft.film.layout;
    let before = LayoutPreset::ALL
        .into_iter()
        .find(|p| p.layout() == *layout);
    let mut purpose = before;
    let purposes = LayoutPreset::ALL.map(|p| (Some(p), p.name().title, p.name().sentence));
    let tip = "Sets shape, size, captions and file to what is usual there.";
    choices_row(ui, "Made for", tip, &mut purpose, &purposes);
    if let Some(purpose) = purpose.filter(|_| purpose != before) {
        *layout = purpose.layout();
        // What slides and posts take; and what a page shows without a player, which hangs on what
        // is seen.
        draft.record_format = match purpose {
            LayoutPreset::Page => None,
            _ if has_ffmpeg() => Some(FilmFileFormat::Film(FilmKind::Mp4)),
            _ => None,
        };
    }
}

/// Looks of films that were kept, and a way to keep this one.
fn kept(ui: &mut Ui, scene: &UiState, acts: &mut Intents) {
    let in_use = scene.presets.in_use(&scene.preferences, content(scene));
    let tip = "Looks of films that you have kept, also for --preset on the command line.";
    row(ui, "Kept", tip, |ui| {
        let list = ComboBox::from_id_salt("kept looks")
            .width(ui.available_width())
            .truncate()
            .selected_text(in_use.unwrap_or("–"));
        let shown = list.show_ui(ui, |ui| {
            for name in scene.presets.names() {
                let chosen = ui.selectable_label(in_use == Some(name), name);
                if chosen.clicked() {
                    acts.push(Intent::UsePreset(name.to_owned()));
                }
            }
            ui.separator();
            match in_use {
                Some(name) => {
                    if ui.button(format!("Forget “{name}”")).clicked() {
                        acts.push(Intent::ForgetPreset(name.to_owned()));
                        ui.close();
                    }
                }
                None => keep(ui, acts),
            }
        });
        shown.response
    });
}

/// A name for what is set now.
fn keep(ui: &mut Ui, acts: &mut Intents) {
    let id = ui.id().with("name of a look");
    let mut name: String = ui.data(|data| data.get_temp(id)).unwrap_or_default();
    let field = TextEdit::singleline(&mut name)
        .hint_text("Name")
        .desired_width(120.0);
    let field = ui.add(field);
    let is_entered = field.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
    let can = !name.trim().is_empty();
    let button = ui.add_enabled(can, Button::new("Keep this look"));
    if can && (button.clicked() || is_entered) {
        acts.push(Intent::KeepPreset(name.trim().to_owned()));
        name.clear();
        ui.close();
    }
    ui.data_mut(|data| data.insert_temp(id, name));
}

/// From where to where.
fn span(ui: &mut Ui, scene: &UiState, look: &mut FilmExportOptions) {
    let tip = "The stops at which the film begins and ends; set stops with M.";
    row(ui, "From, to", tip, |ui| {
        let mut places = look.places(scene.session.timing(), scene.session.stops());
        let before = places;
        let [from, to] = &mut places;
        let width = (ui.available_width() - GRID) / 2.0;
        let first = place(ui, scene, "film from", from, ("Start", width));
        let last = place(ui, scene, "film to", to, ("End", width));
        if places != before {
            look.span = places;
        }
        first | last
    });
}

/// A list of all places; none is the pass's own.
fn place(
    ui: &mut Ui,
    scene: &UiState,
    salt: &str,
    at: &mut Option<f64>,
    (own, width): (&str, f32),
) -> Response {
    let (timing, stops) = (scene.session.timing(), scene.session.stops());
    let name = |at: Option<f64>| match at {
        None => own.to_owned(),
        Some(t) => match stops.iter().find(|stop| stop.t == t) {
            Some(stop) if !stop.name.is_empty() => SanitizedLine(&stop.name).to_string(),
            _ => format!("t = {t:.3}"),
        },
    };
    let list = ComboBox::from_id_salt(salt)
        .width(width)
        .truncate()
        .selected_text(name(*at));
    let shown = list.show_ui(ui, |ui| {
        let places = landmarks(timing, stops);
        for place in std::iter::once(None).chain(places.into_iter().map(Some)) {
            ui.selectable_value(at, place, name(place));
        }
    });
    shown.response
}

/// What comes out large.
fn advice(ui: &mut Ui, scene: &UiState, draft: &Preferences) {
    let content = content(scene);
    if draft.format(content) == GIF && content == Some(ContentKind::Colours) {
        hint(
            ui,
            "A GIF of photographs is large, and has 256 colours: MP4 is smaller and truer.",
        );
    }
}

/// What would be written.
fn told(ui: &mut Ui, scene: &UiState) {
    let Some(framed) = &scene.film.0 else {
        let words = match scene.session.transition() {
            Some(_) => "Nothing to write: it would end where it begins.",
            None => "Nothing to write yet.",
        };
        ui.label(secondary_text(ui, words));
        return;
    };
    let size = framed.view.size();
    let (width, height) = (size.width(), size.height());
    let (frames, secs) = (framed.frames, framed.secs);
    let words = format!("{width} × {height} pixels, {frames} frames, {secs:.1} s");
    ui.label(secondary_text(ui, words));
    let cost = match scene.estimate.cost() {
        Some(cost) => format!(
            "About {}, written in {}",
            size_of(cost.bytes),
            time_of(cost.secs)
        ),
        None if scene.estimate.is_busy() => "Seeing how large it becomes …".to_owned(),
        None => String::new(),
    };
    ui.label(secondary_text(ui, cost))
        .on_hover_text("Some frames were written to see.");
}

/// Two digits, as more are not known.
fn size_of(bytes: f64) -> String {
    let (number, unit) = if bytes >= 1e6 {
        (bytes / 1e6, "MB")
    } else {
        (bytes / 1e3, "kB")
    };
    if number < 10.0 {
        format!("{number:.1} {unit}")
    } else {
        format!("{number:.0} {unit}")
    }
}

fn time_of(secs: f64) -> String {
    if secs < 90.0 {
        format!("{:.0} s", secs.max(1.0))
    } else {
        format!("{:.0} min", secs / 60.0)
    }
}

const GROUNDS: [(bool, &str, &str); 2] = [
    (false, "Coloured", "The ground colour of the project"),
    (
        true,
        "Transparent",
        "Nothing, for placing on a page; MP4 cannot",
    ),
];

fn picture(ui: &mut Ui, draft: &mut Preferences, acts: &mut Intents) {
    let tip = "How many pixels a picture of the stage has.";
    let scales = [
        (ImageScale::One, "1×", "As many as on screen"),
        (ImageScale::Two, "2×", "Twice as many along each side"),
        (ImageScale::FourK, "4K", "3840 along the longer side"),
    ];
    choices_row(ui, "Size", tip, &mut draft.capture_scale, &scales);
    let tip = "What lies behind the shapes.";
    choices_row(ui, "Ground", tip, &mut draft.capture_transparent, &GROUNDS);
    ui.add_space(GRID);
    if ui.button("Take a picture of the stage").clicked() {
        acts.push(Intent::Screenshot { with_panels: false });
    }
}

fn formats() -> Vec<(FilmFileFormat, &'static str, &'static str)> {
    let film = |kind: FilmKind| {
        let name = kind.name();
        (FilmFileFormat::Film(kind), name.title, name.sentence)
    };
    let pngs = (
        FilmFileFormat::Pngs,
        "PNGs",
        "A folder of numbered pictures",
    );
    FilmKind::ALL.map(film).into_iter().chain([pngs]).collect()
}
