//! Pictures and films: what they are made for, how they lie, and what comes of it.

use bevy_egui::egui::{Ui, vec2};

use crate::app::asking::choices::{CaptureScale, Preferences, RecordFormat};
use crate::app::asking::intent::Intent;
use crate::app::ui::kit::icons;
use crate::app::ui::kit::theme::GRID;
use crate::app::ui::kit::widgets::{
    choose, from_right, hint, icon_button, pick, primary_button, quiet, section, slider, toggle,
};
use crate::app::ui::scene::{Intents, Scene};
use crate::content::ContentKind;
use crate::export::{FilmKind, Purpose};
use crate::names::Choice;

/// Draws the options, in the place of the transition's.
pub fn show(ui: &mut Ui, scene: &Scene, acts: &mut Intents) {
    let mut draft = *scene.preferences;
    ui.horizontal(|ui| {
        ui.label(quiet(ui, "Pictures and films"));
        from_right(ui, |ui| {
            let close = icon_button(
                ui,
                icons::CLOSE,
                "Back to the options (Esc)",
                vec2(24.0, 24.0),
            );
            if close.clicked() {
                draft.film_options = false;
            }
        });
    });
    section(ui, "Film", |ui| film(ui, scene, &mut draft, acts));
    section(ui, "Both", |ui| {
        let tip = "What lies behind the shape in pictures and films.";
        let grounds = [
            (false, "Coloured", "The ground colour of the project"),
            (true, "Transparent", "Nothing; for placing on a page"),
        ];
        choose(ui, "Ground", tip, &mut draft.capture_transparent, &grounds);
        if draft.capture_transparent && draft.record_format == RecordFormat::OPAQUE {
            hint(
                ui,
                "MP4 has no transparency: films get the ground colour. GIF, APNG and PNGs have it.",
            );
        }
    });
    section(ui, "Picture", |ui| picture(ui, &mut draft, acts));
    if draft != *scene.preferences {
        acts.push(Intent::Prefer(draft));
    }
}

fn film(ui: &mut Ui, scene: &Scene, draft: &mut Preferences, acts: &mut Intents) {
    let layout = &mut draft.film.layout;
    let before = Purpose::ALL.into_iter().find(|p| p.layout() == *layout);
    let mut purpose = before;
    let purposes = Purpose::ALL.map(|p| (Some(p), p.name().title, p.name().sentence));
    let tip = "Sets shape, size, captions and file to what is usual there.";
    choose(ui, "Made for", tip, &mut purpose, &purposes);
    if let Some(purpose) = purpose.filter(|_| purpose != before) {
        *layout = purpose.layout();
        // What slides and posts take; and what a page shows without a player.
        draft.record_format = match purpose {
            Purpose::Page => RecordFormat::Film(FilmKind::Gif),
            _ => RecordFormat::Film(FilmKind::Mp4),
        };
    }
    let tip = "The shape of the film's pictures; the stage shows it.";
    pick(ui, "Shape", tip, &mut layout.aspect);
    let sizes = [
        (480, "480", "480 pixels along the shorter side"),
        (720, "720", "720 pixels along the shorter side: HD"),
        (1080, "1080", "1080 pixels along the shorter side: Full HD"),
        (2160, "4K", "2160 pixels along the shorter side: 4K"),
    ];
    choose(
        ui,
        "Size",
        "Pixels along the shorter side.",
        &mut layout.lines,
        &sizes,
    );
    let tip = "What is free all around, as a part of the shorter side.";
    slider(ui, "Margin", tip, &mut layout.margin, 0.0..=0.3, false);
    let tip = "The names of the stops below, each while the film is near it; of the designs, where there are no named stops.";
    toggle(ui, "Captions", tip, &mut layout.has_captions);
    let rates = [
        (25, "25", "As films in Europe"),
        (30, "30", "As films in America, and most screens' half"),
        (50, "50", "Very smooth; GIF's fastest"),
        (60, "60", "As fast as most screens; not for GIF"),
    ];
    choose(ui, "Rate", "Frames a second.", &mut draft.film.fps, &rates);
    let tip = "The kind of file that a recording writes.";
    choose(ui, "File", tip, &mut draft.record_format, &formats());
    advice(ui, scene, draft);
    told(ui, scene);
    ui.add_space(GRID);
    ui.add_enabled_ui(scene.recorder.work().is_none(), |ui| {
        if primary_button(ui, "Write the film").clicked() {
            acts.push(Intent::Record);
        }
    });
}

/// What does not go together, or comes out large.
fn advice(ui: &mut Ui, scene: &Scene, draft: &Preferences) {
    let is_gif = draft.record_format == RecordFormat::Film(FilmKind::Gif);
    let content = scene.session.project().and_then(|project| project.content);
    if is_gif && draft.film.fps > 50 {
        hint(
            ui,
            "A GIF has 50 frames a second at most: choose fewer, or another file.",
        );
    } else if is_gif && content == Some(ContentKind::Colours) {
        hint(
            ui,
            "A GIF of photographs is large, and has 256 colours: MP4 is smaller and truer.",
        );
    }
}

/// What would be written.
fn told(ui: &mut Ui, scene: &Scene) {
    let words = match &scene.film.0 {
        Some(framed) => {
            let size = framed.view.size();
            let (width, height) = (size.width(), size.height());
            let (frames, secs) = (framed.frames, framed.secs);
            format!("{width} × {height} pixels, {frames} frames, {secs:.1} s")
        }
        None => "Nothing to write yet.".to_owned(),
    };
    ui.label(quiet(ui, words));
}

fn picture(ui: &mut Ui, draft: &mut Preferences, acts: &mut Intents) {
    let tip = "How many pixels a picture of the stage has.";
    let scales = [
        (CaptureScale::One, "1×", "As many as on screen"),
        (CaptureScale::Two, "2×", "Twice as many along each side"),
        (CaptureScale::FourK, "4K", "3840 along the longer side"),
    ];
    choose(ui, "Size", tip, &mut draft.capture_scale, &scales);
    ui.add_space(GRID);
    if ui.button("Take a picture of the stage").clicked() {
        acts.push(Intent::Screenshot { with_panels: false });
    }
}

fn formats() -> Vec<(RecordFormat, &'static str, &'static str)> {
    let film = |kind: FilmKind| {
        let name = kind.name();
        (RecordFormat::Film(kind), name.title, name.sentence)
    };
    let pngs = (RecordFormat::Pngs, "PNGs", "A folder of numbered pictures");
    FilmKind::ALL.map(film).into_iter().chain([pngs]).collect()
}
