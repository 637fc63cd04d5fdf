//! Side panel of the file dialog: a path field with completion, text as a design, and a preview of
//! the selected file or of the text.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use bevy_egui::egui::{
    Button, Color32, ComboBox, Id, Key, Modifiers, Rect, TextEdit, Ui, pos2, vec2,
};
use image::RgbaImage;

use crate::app::files::file_preview::PREVIEW_PX;
use crate::app::files::path_completion::{completions, text, typed_source};
use crate::app::input::intent::Intent;
use crate::app::ui::kit::texture::texture;
use crate::app::ui::kit::theme::{GRID, RADIUS, ThemePalette};
use crate::app::ui::kit::widgets::secondary_text;
use crate::app::ui::ui_state::{Intents, UiState};
use crate::design::{DesignSource, InstalledFont};

/// Width of the file dialog's side panel, in points.
pub const WIDTH: f32 = 192.0;

/// Path that the user types, with its completions. The completions are looked up only when the text
/// or the folder changes.
#[derive(Debug, Default)]
pub struct TypedPath {
    text: String,
    looked_up: Option<(String, PathBuf)>,
    completions: Vec<PathBuf>,
}

impl TypedPath {
    /// Returns whether completions are listed. The preview is then hidden.
    pub fn has_completions(&self) -> bool {
        !self.completions.is_empty()
    }

    fn update_completions(&mut self, folder: &Path, extensions: &[&str]) {
        let key = (self.text.clone(), folder.to_owned());
        if self.looked_up.as_ref() != Some(&key) {
            self.completions = if self.text.is_empty() {
                Vec::new()
            } else {
                completions(&self.text, folder, extensions)
            };
            self.looked_up = Some(key);
        }
    }
}

/// Draws the path field and the completions of its text. Returns the file that the user confirmed
/// with Enter.
pub fn field(
    ui: &mut Ui,
    typed: &mut TypedPath,
    folder: &Path,
    extensions: &[&str],
) -> Option<PathBuf> {
    typed.update_completions(folder, extensions);
    let id = ui.id().with("typed");
    let has_focus = ui.memory(|memory| memory.has_focus(id));
    // Tab is consumed before the field sees it, because it would move the focus away.
    let is_tab_pressed =
        has_focus && ui.input_mut(|input| input.consume_key(Modifiers::NONE, Key::Tab));
    let mut chosen = is_tab_pressed
        .then(|| typed.completions.first().cloned())
        .flatten();
    let hint = "Type a path …";
    let edit = TextEdit::singleline(&mut typed.text)
        .id(id)
        .hint_text(hint)
        .lock_focus(true)
        .desired_width(f32::INFINITY);
    let response = ui.add(edit);
    let is_entered = response.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
    for completion in &typed.completions {
        let name = completion.file_name().unwrap_or(completion.as_os_str());
        let slash = if completion.is_dir() { "/" } else { "" };
        let line = Button::new(format!("{}{slash}", name.to_string_lossy()))
            .frame_when_inactive(false)
            .truncate();
        if ui
            .add(line)
            .on_hover_text(completion.display().to_string())
            .clicked()
        {
            chosen = Some(completion.clone());
        }
    }
    if let Some(path) = chosen {
        typed.text = text(&path);
        ui.memory_mut(|memory| memory.request_focus(id));
        let end = typed.text.chars().count();
        set_cursor(ui, id, end);
    }
    typed_source(&typed.text, folder).filter(|_| is_entered)
}

/// Text that the user enters as a design, and the font chosen for it.
#[derive(Debug, Default)]
pub struct TextDesign {
    text: String,
    /// The font; `None` is the bundled font.
    font: Option<InstalledFont>,
}

impl TextDesign {
    /// Returns the path of the design; `None` while the text is empty.
    pub fn path(&self) -> Option<PathBuf> {
        let source = DesignSource::Text {
            text: self.text.trim().to_owned(),
            font: self.font.as_ref().map(|font| font.path.clone()),
        };
        (!self.text.trim().is_empty()).then(|| source.to_path())
    }
}

/// Draws the fields for text and its font. Returns the design that the user confirmed.
pub fn text_design(ui: &mut Ui, state: &UiState, design: &mut TextDesign) -> Option<PathBuf> {
    ui.add_space(GRID);
    ui.label(secondary_text(ui, "Or text as a design"));
    let edit = TextEdit::singleline(&mut design.text)
        .hint_text("Hello")
        .desired_width(f32::INFINITY);
    let response = ui.add(edit);
    let is_entered = response.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
    font_list(ui, state, &mut design.font);
    let path = design.path();
    let button = ui.add_enabled(path.is_some(), Button::new("Use text"));
    path.filter(|_| button.clicked() || is_entered)
}

/// Draws the list of fonts; the bundled one comes first.
fn font_list(ui: &mut Ui, state: &UiState, font: &mut Option<InstalledFont>) {
    let name = |font: &Option<InstalledFont>| match font {
        Some(font) => font.name.clone(),
        None => "Roboto Bold (built in)".to_owned(),
    };
    let list = ComboBox::from_id_salt("font")
        .width(ui.available_width())
        .truncate()
        .selected_text(name(font));
    list.show_ui(ui, |ui| {
        ui.selectable_value(font, None, name(&None));
        match state.fonts.list() {
            Some(fonts) => {
                for each in fonts {
                    ui.selectable_value(font, Some(each.clone()), &each.name);
                }
            }
            None => {
                ui.label(secondary_text(ui, "Looking for fonts …"));
            }
        }
    });
}

/// Puts the text cursor at the end of the completed text.
fn set_cursor(ui: &Ui, id: Id, char_index: usize) {
    use bevy_egui::egui::text::{CCursor, CCursorRange};
    let mut state = TextEdit::load_state(ui.ctx(), id).unwrap_or_default();
    let end = CCursorRange::one(CCursor::new(char_index));
    state.cursor.set_char_range(Some(end));
    state.store(ui.ctx(), id);
}

/// Draws the preview of the selected file or, if there is no preview, the reason. Draws nothing if
/// `file` is `None`.
pub fn preview(ui: &mut Ui, state: &UiState, file: Option<&Path>, intents: &mut Intents) {
    let Some(file) = file else {
        return;
    };
    ui.add_space(GRID);
    match state.preview.of(file) {
        Some(Ok(picture)) => draw_picture(ui, state, picture),
        Some(Err(reason)) => {
            ui.label(secondary_text(ui, reason));
        }
        None => {
            ui.label(secondary_text(ui, "Loading preview …"));
            if !state.preview.is_for(file) {
                intents.push(Intent::PreviewFile(file.to_owned()));
            }
        }
    }
}

fn draw_picture(ui: &mut Ui, state: &UiState, picture: &Arc<RgbaImage>) {
    let longest = PREVIEW_PX.0.max(PREVIEW_PX.1);
    let texture = texture(ui.ctx(), Id::new("preview"), picture, longest);
    let side = ui.available_width();
    let (frame_rect, _) = ui.allocate_exact_size(vec2(side, side), bevy_egui::egui::Sense::hover());
    let [r, g, b] = state.session.style().ground.0;
    let painter = ui.painter();
    painter.rect_filled(frame_rect, RADIUS, Color32::from_rgb(r, g, b));
    painter.rect_stroke(
        frame_rect,
        RADIUS,
        (1.0, ThemePalette::of(ui).line),
        bevy_egui::egui::StrokeKind::Inside,
    );
    let size = vec2(picture.width() as f32, picture.height() as f32);
    let inner = frame_rect.shrink(4.0);
    let fitted = size * (inner.size() / size).min_elem();
    let full_uv = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
    let image_rect = Rect::from_center_size(inner.center(), fitted);
    painter.image(texture.id(), image_rect, full_uv, Color32::WHITE);
}
