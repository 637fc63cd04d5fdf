//! Draws the invitation: a card below the film that says how to open files and offers gallery
//! projects as examples. It is shown when the program starts without files.

use bevy_egui::egui::text::{LayoutJob, TextWrapping};
use bevy_egui::egui::{
    Align, Color32, Frame, Layout, Panel, Rect, Response, RichText, Sense, Stroke, StrokeKind, Ui,
    UiBuilder, Vec2, WidgetInfo, WidgetType, pos2, vec2,
};

use crate::app::files::invitation;
use crate::app::input::intent::Intent;
use crate::app::tool_views::is_any_open;
use crate::app::ui::gallery;
use crate::app::ui::gallery::GalleryTextures;
use crate::app::ui::kit::icons;
use crate::app::ui::kit::theme::{CARD_RADIUS, GRID, SMALL, ThemePalette};
use crate::app::ui::kit::widgets::{from_right, icon_button, primary_button, secondary_text};
use crate::app::ui::ui_state::{Intents, UiState};
use crate::project::gallery::GalleryEntry;

const HEADLINE: &str = "Drop two or more files here";

/// Headline where the window system delivers no dropped files.
const HEADLINE_WITHOUT_DROPS: &str = "Open two or more files (Ctrl O)";

/// Says why files cannot be dropped.
const NO_DROPS: &str = "Wayland delivers no dropped files here; press Ctrl O. ";

const FORMATS: &str = "SVG, DXF, PNG, OBJ, letters, trusses …";

/// Maximum width of the invitation's card, in points (heuristic).
const MAX_WIDTH: f32 = 680.0;

/// Minimum width of the card, in points. The headline and the close button must fit next to each
/// other.
const MIN_WIDTH: f32 = 288.0;

/// Gap between the card and the edges of the space around it, in points.
const MARGIN: f32 = 12.0;

/// Gap between the card's edge and its content, in points.
const PADDING: f32 = 12.0;

/// Height of the card's headline, in points.
const HEADLINE_HEIGHT: f32 = 24.0;

/// Height of the line that lists file formats, in points.
const FORMATS_HEIGHT: f32 = 20.0;

/// Height of the row with the button that opens files, in points.
const BUTTON_HEIGHT: f32 = 28.0;

/// Minimum width of an example (a gallery project) on the card, in points (heuristic: most titles
/// fit).
const MIN_EXAMPLE_WIDTH: f32 = 128.0;

/// Height of the picture of an example, in points.
const PICTURE_HEIGHT: f32 = 48.0;

/// Height of an example with picture and title, in points.
const EXAMPLE_HEIGHT: f32 = PICTURE_HEIGHT + 20.0;

/// Maximum number of rows of examples on the card (heuristic: the panel on the left lists all
/// projects).
const MAX_ROWS: usize = 2;

/// Draws the invitation, if it is visible, at the lower edge of the space between the panels. The
/// film gets the rest of this space.
pub fn show(root: &mut Ui, state: &UiState, textures: &mut GalleryTextures, intents: &mut Intents) {
    if !is_visible(state) {
        return;
    }
    let examples = invitation::examples(&state.gallery.0);
    let stage = root.available_rect_before_wrap().size();
    let Some(plan) = CardPlan::fit(stage, examples.len()) else {
        return;
    };
    Panel::bottom("invitation")
        .exact_size(plan.size().y + MARGIN)
        .resizable(false)
        .show_separator_line(false)
        // The panel has no background, so that the stage is visible around the card.
        .frame(Frame::NONE)
        .show(root, |ui| {
            let room = ui.max_rect();
            let left = room.center().x - 0.5 * plan.width;
            let card = Rect::from_min_size(pos2(left, room.top()), plan.size());
            frame(ui, card);
            let inner = card.shrink(PADDING);
            let [headline, formats, button] = plan.lines(inner);
            row(ui, headline, |ui| show_headline(ui, state, intents));
            if plan.has_formats {
                let reason = match state.drop_support.0 {
                    true => "",
                    false => NO_DROPS,
                };
                row(ui, formats, |ui| {
                    ui.label(secondary_text(ui, format!("{reason}{FORMATS}")));
                });
            }
            row(ui, button, |ui| show_button(ui, plan.rows > 0, intents));
            for (index, entry) in examples.iter().take(plan.example_count()).enumerate() {
                let place = plan.example(inner, index);
                if show_example(ui, state, textures, entry, place).clicked() {
                    intents.push(Intent::PlayGallery(entry.name.clone()));
                }
            }
        });
}

/// Returns whether the card is shown. It is hidden while the match editor, the comparison or the
/// map is open.
fn is_visible(state: &UiState) -> bool {
    let is_tool_open = is_any_open(&state.editor, &state.comparison, &state.map);
    state.invitation.is_shown() && !is_tool_open
}

/// Draws the background and the outline of the card.
fn frame(ui: &Ui, card: Rect) {
    let palette = ThemePalette::of(ui);
    let line = Stroke::new(1.0, palette.line);
    ui.painter()
        .rect(card, CARD_RADIUS, palette.window, line, StrokeKind::Inside);
}

/// Draws content from left to right in `rect`, centred vertically.
fn row(ui: &mut Ui, rect: Rect, content: impl FnOnce(&mut Ui)) {
    let layout = Layout::left_to_right(Align::Center);
    ui.scope_builder(UiBuilder::new().max_rect(rect).layout(layout), content);
}

fn show_headline(ui: &mut Ui, state: &UiState, intents: &mut Intents) {
    let headline = match state.drop_support.0 {
        true => HEADLINE,
        false => HEADLINE_WITHOUT_DROPS,
    };
    ui.label(RichText::new(headline).heading());
    from_right(ui, |ui| {
        let size = vec2(HEADLINE_HEIGHT, HEADLINE_HEIGHT);
        if icon_button(ui, icons::CLOSE, "Close (Esc)", size).clicked() {
            intents.push(Intent::CloseInvitation);
        }
    });
}

fn show_button(ui: &mut Ui, has_examples: bool, intents: &mut Intents) {
    let button = primary_button(ui, "Open …");
    let tip = format!("Open a project or designs: {FORMATS} (Ctrl O)");
    if button.on_hover_text(tip).clicked() {
        intents.push(Intent::AskOpen);
    }
    if has_examples {
        ui.label(secondary_text(ui, "or try an example:"));
    }
}

/// Draws the picture and the title of a gallery project as an example.
fn show_example(
    ui: &Ui,
    state: &UiState,
    textures: &mut GalleryTextures,
    entry: &GalleryEntry,
    rect: Rect,
) -> Response {
    let palette = ThemePalette::of(ui);
    let id = ui.id().with(entry.name.as_str());
    let response = ui.interact(rect, id, Sense::click());
    response.widget_info(|| WidgetInfo::labeled(WidgetType::Button, true, &entry.title));
    let (fill, line) = match response.hovered() {
        true => (palette.hover, palette.line),
        false => (palette.raised, Color32::TRANSPARENT),
    };
    ui.painter()
        .rect(rect, CARD_RADIUS, fill, (1.0, line), StrokeKind::Inside);
    let picture = Rect::from_min_size(rect.min, vec2(rect.width(), PICTURE_HEIGHT));
    gallery::thumbnail(ui, state, textures, &entry.name, picture.shrink(4.0));
    let mut title = LayoutJob::simple_singleline(entry.title.clone(), SMALL, palette.text);
    title.wrap = TextWrapping::truncate_at_width(rect.width() - 2.0 * GRID);
    let title = ui.painter().layout_job(title);
    let corner = rect.left_top() + vec2(GRID, PICTURE_HEIGHT);
    ui.painter().galley(corner, title, palette.text);
    response.on_hover_text(&entry.description)
}

/// Layout of the card: its width, and the elements for which it has room.
#[derive(Clone, Copy, Debug, PartialEq)]
struct CardPlan {
    /// Width of the card, in points.
    width: f32,
    /// Whether the card lists file formats.
    has_formats: bool,
    /// Number of examples (gallery projects) in a row of the card.
    columns: usize,
    /// Number of rows of examples on the card.
    rows: usize,
}

impl CardPlan {
    /// Returns the layout of the largest card that leaves half the height of the stage to the film
    /// or, if no card does, of the smallest card; `None` if even that is too large for the stage.
    fn fit(stage: Vec2, example_count: usize) -> Option<Self> {
        let width = (stage.x - 2.0 * MARGIN).min(MAX_WIDTH);
        if width < MIN_WIDTH {
            return None;
        }
        let inner = width - 2.0 * PADDING;
        let columns = ((inner + GRID) / (MIN_EXAMPLE_WIDTH + GRID)) as usize;
        let columns = columns.clamp(1, example_count.max(1));
        // Incomplete rows are not shown.
        let max_rows = (example_count / columns).min(MAX_ROWS);
        let plan = |rows: usize, has_formats: bool| Self {
            width,
            has_formats,
            columns,
            rows,
        };
        let smallest = plan(0, false);
        let mut plans = (0..=max_rows).rev().map(|rows| plan(rows, true));
        let leaves_half = |plan: &Self| plan.size().y + MARGIN <= 0.5 * stage.y;
        let chosen = plans.find(leaves_half).unwrap_or(smallest);
        (chosen.size().y + MARGIN <= stage.y).then_some(chosen)
    }

    /// Returns the size of the card, in points.
    fn size(&self) -> Vec2 {
        let formats = if self.has_formats {
            FORMATS_HEIGHT
        } else {
            0.0
        };
        let examples = self.rows as f32 * (GRID + EXAMPLE_HEIGHT);
        let lines = HEADLINE_HEIGHT + formats + GRID + BUTTON_HEIGHT;
        vec2(self.width, 2.0 * PADDING + lines + examples)
    }

    /// Returns the rectangles of the headline, of the formats and of the button; `inner` is the
    /// card without its padding.
    fn lines(&self, inner: Rect) -> [Rect; 3] {
        let line = |top: f32, height: f32| {
            Rect::from_min_size(pos2(inner.left(), top), vec2(inner.width(), height))
        };
        let headline = line(inner.top(), HEADLINE_HEIGHT);
        let formats = line(headline.bottom(), FORMATS_HEIGHT);
        let above = if self.has_formats { formats } else { headline };
        [
            headline,
            formats,
            line(above.bottom() + GRID, BUTTON_HEIGHT),
        ]
    }

    /// Returns the number of examples that the card shows.
    fn example_count(&self) -> usize {
        self.rows * self.columns
    }

    /// Returns the rectangle of the example with the given index; `inner` is the card without its
    /// padding.
    fn example(&self, inner: Rect, index: usize) -> Rect {
        let [.., button] = self.lines(inner);
        let count = self.columns as f32;
        let width = (inner.width() - GRID * (count - 1.0)) / count;
        let column = (index % self.columns) as f32;
        let row = (index / self.columns) as f32;
        let offset = vec2(
            column * (width + GRID),
            row * (EXAMPLE_HEIGHT + GRID) + GRID,
        );
        Rect::from_min_size(button.left_bottom() + offset, vec2(width, EXAMPLE_HEIGHT))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_large_stage_shows_examples_and_keeps_half_its_height_for_the_film() {
        // Sizes of the stage in windows of 1920 × 1080, 1280 × 720, 1200 × 640 and 960 × 540
        // points, with the expected number of rows.
        let stages = [
            (vec2(1360.0, 832.0), 2),
            (vec2(720.0, 472.0), 1),
            (vec2(640.0, 432.0), 1),
            (vec2(400.0, 332.0), 0),
        ];
        for (stage, rows) in stages {
            let plan = CardPlan::fit(stage, 10).expect("room for a card");
            assert_eq!((plan.rows, plan.has_formats), (rows, true), "{stage:?}");
            assert!(plan.size().y + MARGIN <= 0.5 * stage.y, "{stage:?}");
            assert!(plan.width + 2.0 * MARGIN <= stage.x, "{stage:?}");
        }
    }

    #[test]
    fn a_small_stage_shows_less_and_a_tiny_one_nothing() {
        // The first size is that of the stage in a window of 640 × 360 points.
        let plan = CardPlan::fit(vec2(312.0, 152.0), 10).expect("room for a card");
        assert_eq!((plan.rows, plan.has_formats), (0, false));
        assert_eq!(CardPlan::fit(vec2(312.0, 90.0), 10), None);
        assert_eq!(CardPlan::fit(vec2(80.0, 432.0), 10), None);
    }

    #[test]
    fn everything_lies_within_the_card() {
        for stage in [vec2(1360.0, 832.0), vec2(640.0, 432.0), vec2(400.0, 800.0)] {
            for count in [0, 1, 3, 10] {
                let plan = CardPlan::fit(stage, count).expect("room for a card");
                let card = Rect::from_min_size(pos2(20.0, 10.0), plan.size());
                let inner = card.shrink(PADDING);
                let examples = (0..plan.example_count()).map(|index| plan.example(inner, index));
                let places: Vec<Rect> = plan.lines(inner).into_iter().chain(examples).collect();
                for place in &places {
                    // The margin allows for rounding errors.
                    assert!(
                        inner.expand(0.01).contains_rect(*place),
                        "{plan:?}: {place:?}"
                    );
                }
                assert!(plan.example_count() <= count);
            }
        }
    }
}
