//! Export settings, which replace the inspector's sections: preset, size, range, file type and
//! background of films, and size and background of images. Below the settings, the panel shows the
//! estimated file size and export time.

use bevy_egui::egui::{Button, ComboBox, Frame, Key, Margin, Panel, Response, TextEdit, Ui, vec2};

use crate::app::input::intent::{ExportKind, Intent};
use crate::app::input::preferences::{FilmExportOptions, FilmFileFormat, ImageScale, Preferences};
use crate::app::playback::player::landmarks;
use crate::app::ui::kit::icons;
use crate::app::ui::kit::theme::{CONTROL_HEIGHT, GRID};
use crate::app::ui::kit::widgets::{
    drag_value, from_right, hint, icon_button, primary_button, row, secondary_text, section,
    segmented_control, segmented_control_where, segmented_row, setting_row, slider, toggle,
};
use crate::app::ui::ui_state::{Intents, UiState};
use crate::content::ContentKind;
use crate::export::{FilmKind, LayoutPreset, has_ffmpeg};
use crate::io::sanitize::SanitizedName;
use crate::settings::Choice;

/// Standard sizes of films: pixels along the shorter side, label, and tooltip.
const STANDARD_SIZES: [(u32, &str, &str); 4] = [
    (480, "480", "480 pixels along the shorter side"),
    (720, "720", "720 pixels along the shorter side: HD"),
    (1080, "1080", "1080 pixels along the shorter side: Full HD"),
    (2160, "4K", "2160 pixels along the shorter side: 4K"),
];

/// Maximum frame rate of a GIF, in frames per second. The delays between its frames are whole
/// hundredths of a second, and players lengthen delays below two hundredths.
const MAX_GIF_FPS: u32 = 50;

/// Draws the export settings.
pub fn show(ui: &mut Ui, state: &UiState, intents: &mut Intents) {
    let mut draft = *state.preferences;
    ui.horizontal(|ui| {
        ui.label(secondary_text(ui, "Export settings"));
        from_right(ui, |ui| {
            let tip = "Close (Esc)";
            let close = icon_button(ui, icons::CLOSE, tip, vec2(24.0, 24.0));
            if close.clicked() {
                draft.film_options = false;
            }
        });
    });
    section(ui, "Film", |ui| film(ui, state, &mut draft, intents));
    section(ui, "Image", |ui| {
        picture(ui, &mut draft, intents);
    });
    if draft != *state.preferences {
        intents.push(Intent::SetPreferences(draft));
    }
}

/// Draws the size of the film and the export button below the settings, where they do not scroll.
pub fn foot(ui: &mut Ui, state: &UiState, intents: &mut Intents) {
    let frame = Frame::NONE.inner_margin(Margin::symmetric(0, 8));
    Panel::bottom("export").frame(frame).show(ui, |ui| {
        ui.set_width(ui.available_width());
        summary(ui, state);
        ui.add_space(GRID);
        let is_free = state.exporter.work().is_none() && state.film_framing.0.is_some();
        ui.add_enabled_ui(is_free, |ui| {
            if primary_button(ui, "Export …").clicked() {
                intents.push(Intent::AskExport(ExportKind::Film));
            }
        });
    });
}

fn film(ui: &mut Ui, state: &UiState, draft: &mut Preferences, intents: &mut Intents) {
    preset(ui, draft);
    my_presets(ui, state, intents);
    let layout = &mut draft.film.layout;
    let tip = "Aspect ratio of the film. The stage shows the frame.";
    setting_row(ui, "Aspect ratio", tip, &mut layout.aspect);
    let tip = "Pixels along the shorter side. Choose a size, or type one.";
    row(ui, "Size", tip, |ui| {
        let custom = drag_value(&mut layout.lines, 16..=4320, 4.0, 0);
        let custom = ui.add_sized([48.0, CONTROL_HEIGHT], custom);
        custom | segmented_control(ui, &mut layout.lines, &STANDARD_SIZES)
    });
    let tip = "Empty space all around, as a fraction of the shorter side.";
    slider(ui, "Margin", tip, &mut layout.margin, 0.0..=0.3, false);
    let tip = "Shows the name of a stop below the film while the film is near it. Without named \
               stops, shows the names of the designs.";
    toggle(ui, "Captions", tip, &mut layout.has_captions);
    range(ui, state, &mut draft.film);
    let tip = "What happens at the end of the film.";
    setting_row(ui, "At the end", tip, &mut draft.film.ending);
    file(ui, state, draft);
    format_advice(ui, state, draft);
}

/// Returns the kind of content that the current segment shows.
fn content(state: &UiState) -> Option<ContentKind> {
    state.session.project().and_then(|project| project.content)
}

/// GIF, the file type with a limited frame rate and number of colours.
const GIF: FilmFileFormat = FilmFileFormat::Film(FilmKind::Gif);

/// Draws the choice of the file type, and the settings that depend on it: frame rate and
/// background.
fn file(ui: &mut Ui, state: &UiState, draft: &mut Preferences) {
    let format = file_type(ui, state, draft);
    let is_gif = format == GIF;
    if is_gif {
        draft.film.fps = draft.film.fps.min(MAX_GIF_FPS);
    }
    let rates = [
        (25, "25", "25 fps (PAL)"),
        (30, "30", "30 fps (NTSC, half the rate of most screens)"),
        (50, "50", "50 fps, very smooth; the maximum for GIF"),
        (
            60,
            "60",
            "60 fps, the rate of most screens; too fast for GIF",
        ),
    ];
    row(ui, "Frame rate", "Frames per second.", |ui| {
        let is_available = |fps: &u32| !is_gif || *fps <= MAX_GIF_FPS;
        segmented_control_where(ui, &mut draft.film.fps, &rates, is_available)
    });
    let is_opaque = !format.can_be_transparent();
    let mut is_transparent = draft.film.is_transparent && !is_opaque;
    row(ui, "Background", "Background of the film.", |ui| {
        segmented_control_where(ui, &mut is_transparent, &BACKGROUNDS, |transparent| {
            !transparent || !is_opaque
        })
    });
    // MP4 cannot be transparent, but the setting remains unchanged for other file types.
    if !is_opaque {
        draft.film.is_transparent = is_transparent;
    }
}

/// Draws the choice of the file type, and returns it.
fn file_type(ui: &mut Ui, state: &UiState, draft: &mut Preferences) -> FilmFileFormat {
    let before = draft.format(content(state));
    let mut format = before;
    // The file types are in three rows, because their labels would overlap in one.
    let is_of = |belongs: fn(FilmKind) -> bool| {
        let mut formats = formats();
        formats.retain(|(format, ..)| format.kind().is_some_and(belongs));
        formats
    };
    let videos = is_of(FilmKind::is_video);
    let vector = is_of(FilmKind::is_vector);
    let mut pixels = formats();
    pixels.retain(|format| !videos.contains(format) && !vector.contains(format));
    let rows = [
        ("File type", "Images, animated or numbered.", pixels),
        (
            "Video",
            "Videos, which need ffmpeg on this machine.",
            videos,
        ),
        (
            "Vector",
            "Vector animations, which stay sharp at any size.",
            vector,
        ),
    ];
    for (label, tip, formats) in &rows {
        row(ui, label, tip, |ui| {
            segmented_control_where(ui, &mut format, formats, |format| format.is_available())
        });
    }
    if format != before {
        draft.record_format = Some(format);
    }
    format
}

/// Draws the presets for common uses, which set most of the other settings.
fn preset(ui: &mut Ui, draft: &mut Preferences) {
    let layout = &mut draft.film.layout;
    let before = LayoutPreset::ALL
        .into_iter()
        .find(|p| p.layout() == *layout);
    let mut preset = before;
    let presets = LayoutPreset::ALL.map(|p| (Some(p), p.name().title, p.name().sentence));
    let tip = "Sets aspect ratio, size, captions and file type for a common use.";
    segmented_row(ui, "Preset", tip, &mut preset, &presets);
    if let Some(preset) = preset.filter(|_| preset != before) {
        *layout = preset.layout();
        // Slides and posts get MP4 if FFmpeg is installed. In all other cases, `None` chooses the
        // file type by content: usually GIF, which needs no video player.
        draft.record_format = match preset {
            LayoutPreset::WebPage => None,
            _ if has_ffmpeg() => Some(FilmFileFormat::Film(FilmKind::Mp4)),
            _ => None,
        };
    }
}

/// Draws the list of the user's own presets, with entries that save and delete a preset.
fn my_presets(ui: &mut Ui, state: &UiState, intents: &mut Intents) {
    let in_use = state.presets.in_use(
        &state.preferences,
        content(state),
        state.capture_folder.last(),
    );
    let tip = "Your saved export settings, also for --preset on the command line.";
    row(ui, "My presets", tip, |ui| {
        let list = ComboBox::from_id_salt("my presets")
            .width(ui.available_width())
            .truncate()
            .selected_text(in_use.unwrap_or("–"));
        let shown = list.show_ui(ui, |ui| {
            for name in state.presets.names() {
                let chosen = ui.selectable_label(in_use == Some(name), name);
                if chosen.clicked() {
                    intents.push(Intent::UsePreset(name.to_owned()));
                }
            }
            ui.separator();
            match in_use {
                Some(name) => {
                    if ui.button(format!("Delete “{name}”")).clicked() {
                        intents.push(Intent::RemovePreset(name.to_owned()));
                        ui.close();
                    }
                }
                None => save_preset(ui, intents),
            }
        });
        shown.response
    });
}

/// Draws a text field for a name, and a button that saves the current settings as a preset with
/// this name.
fn save_preset(ui: &mut Ui, intents: &mut Intents) {
    let id = ui.id().with("preset name");
    let mut name: String = ui.data(|data| data.get_temp(id)).unwrap_or_default();
    let field = TextEdit::singleline(&mut name)
        .hint_text("Name")
        .desired_width(120.0);
    let field = ui.add(field);
    let is_entered = field.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
    let can_save = !name.trim().is_empty();
    let button = ui.add_enabled(can_save, Button::new("Save preset"));
    if can_save && (button.clicked() || is_entered) {
        intents.push(Intent::SavePreset(name.trim().to_owned()));
        name.clear();
        ui.close();
    }
    ui.data_mut(|data| data.insert_temp(id, name));
}

/// Draws the two lists in which the user chooses the stops at which the film starts and ends.
fn range(ui: &mut Ui, state: &UiState, options: &mut FilmExportOptions) {
    let tip = "Stops at which the film starts and ends. Add stops with M.";
    row(ui, "Range", tip, |ui| {
        let mut places = options.valid_range(state.session.timing(), state.session.stops());
        let before = places;
        let [from, to] = &mut places;
        let width = (ui.available_width() - GRID) / 2.0;
        let first = end_list(ui, state, "film from", from, "Start", width);
        let last = end_list(ui, state, "film to", to, "End", width);
        if places != before {
            options.range = places;
        }
        first | last
    });
}

/// Draws a drop-down list in which the user chooses where the film starts or ends. It lists the
/// start and the end of the project's film, all stops, and `default_name`, which stands for `None`:
/// the project's own start or end.
fn end_list(
    ui: &mut Ui,
    state: &UiState,
    salt: &str,
    at: &mut Option<f64>,
    default_name: &str,
    width: f32,
) -> Response {
    let (timing, stops) = (state.session.timing(), state.session.stops());
    let name = |at: Option<f64>| match at {
        None => default_name.to_owned(),
        Some(t) => match stops.iter().find(|stop| stop.t == t) {
            Some(stop) if !stop.name.is_empty() => SanitizedName(&stop.name).to_string(),
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

/// Draws a warning if the file type is unsuitable for the content.
fn format_advice(ui: &mut Ui, state: &UiState, draft: &Preferences) {
    let content = content(state);
    if draft.format(content) == GIF && content == Some(ContentKind::Colours) {
        hint(
            ui,
            "A GIF of photographs is large and has only 256 colours. MP4 is smaller and looks \
             better.",
        );
    }
}

/// Draws the size and duration of the film, and the estimated file size and export time.
fn summary(ui: &mut Ui, state: &UiState) {
    let Some(framed) = &state.film_framing.0 else {
        let text = match state.session.transition() {
            Some(_) => "Nothing to export: the film would end where it starts.",
            None => "Nothing to export yet.",
        };
        ui.label(secondary_text(ui, text));
        return;
    };
    let size = framed.view.size();
    let (width, height) = (size.width(), size.height());
    let (frames, secs) = (framed.frames, framed.secs);
    let text = format!("{width} × {height} pixels, {frames} frames, {secs:.1} s");
    ui.label(secondary_text(ui, text));
    let cost = match state.estimate.cost() {
        Some(cost) => format!(
            "About {}, takes about {}",
            size_of(cost.bytes),
            time_of(cost.secs)
        ),
        None if state.estimate.is_busy() => "Estimating size …".to_owned(),
        None => String::new(),
    };
    ui.label(secondary_text(ui, cost))
        .on_hover_text("Estimated from a few exported frames");
}

/// Formats an estimated file size: in MB from a million bytes on, otherwise in kB. Numbers below 10
/// get one decimal, larger numbers none, because the estimate is not precise.
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

/// Choices for the background of a film or image: whether the background is transparent, label, and
/// tooltip.
const BACKGROUNDS: [(bool, &str, &str); 2] = [
    (false, "Coloured", "Background colour of the project"),
    (
        true,
        "Transparent",
        "No background, for placing on a page; not with MP4",
    ),
];

fn picture(ui: &mut Ui, draft: &mut Preferences, intents: &mut Intents) {
    let tip = "Size of the image, in pixels.";
    let scales = [
        (ImageScale::One, "1×", "As on screen"),
        (
            ImageScale::Two,
            "2×",
            "Twice as many pixels along each side",
        ),
        (ImageScale::FourK, "4K", "3840 pixels along the longer side"),
    ];
    segmented_row(ui, "Size", tip, &mut draft.capture_scale, &scales);
    let tip = "Background of the image.";
    segmented_row(
        ui,
        "Background",
        tip,
        &mut draft.capture_transparent,
        &BACKGROUNDS,
    );
    ui.add_space(GRID);
    if ui.button("Save image").clicked() {
        intents.push(Intent::Screenshot { with_panels: false });
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
        "Folder of numbered PNG images",
    );
    FilmKind::ALL.map(film).into_iter().chain([pngs]).collect()
}
