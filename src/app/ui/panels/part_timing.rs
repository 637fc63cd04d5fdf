//! Part timing section of the inspector: a row for each part with its time window and easing, and a
//! menu that staggers the parts.

use bevy_egui::egui::{Align2, Color32, FontId, Painter, Rect, ScrollArea, Sense, Shape, Ui, vec2};

use crate::app::editing::part_times;
use crate::app::editing::part_times::StaggerOrder;
use crate::app::editing::sheet::{MatchSheet, PieceFate};
use crate::app::ui::kit::easing_editor;
use crate::app::ui::kit::theme::{CONTROL_HEIGHT, ThemePalette};
use crate::app::ui::kit::time_bar;
use crate::app::ui::kit::widgets::{hint, section, tooltip_left};
use crate::app::ui::ui_state::UiState;
use crate::geometry::{Bounds, DVec2, Side};
use crate::settings::Choice;
use crate::time::EasingFunction;
use crate::transition::PartTime;
use crate::warp::PartClock;

/// Height of the list of parts, in points: eight rows; more rows are scrolled.
const LIST_HEIGHT: f32 = 8.0 * (CONTROL_HEIGHT + 4.0);

/// Width of a part's thumbnail, in points.
const THUMBNAIL_WIDTH: f32 = 30.0;

/// Width of the drop-down list of easings in a row, in points.
const EASING_WIDTH: f32 = 84.0;

/// Maximum number of boundary loops, of all parts together, at which the thumbnail of a part also
/// shows the other parts. With more loops, a thumbnail would be a solid area.
const MAX_RINGS: usize = 60;

/// Draws the part timing section, if there is more than one part; changes `times`.
pub fn show(ui: &mut Ui, state: &UiState, times: &mut Vec<PartTime>) {
    let sheet = &state.sheet;
    if sheet.pieces.len() < 2 {
        return;
    }
    section(ui, "Part timing", |ui| {
        stagger(ui, sheet, times);
        ui.add_space(4.0);
        let entries = part_times::time_of_pieces(sheet, times);
        ScrollArea::vertical()
            .id_salt("part timing")
            .max_height(LIST_HEIGHT)
            .min_scrolled_height(LIST_HEIGHT)
            .show_rows(ui, CONTROL_HEIGHT, sheet.pieces.len(), |ui, rows| {
                for piece in rows {
                    let before = entries[piece].map_or(PartClock::WHOLE, |k| times[k].clock());
                    if let Some(clock) = row(ui, sheet, before, piece) {
                        part_times::set_part_time(sheet, times, piece, clock);
                        break; // `entries` no longer matches `times`
                    }
                }
            });
        hint(
            ui,
            "Drag an end of a bar: the part starts later or ends earlier.",
        );
    });
}

fn stagger(ui: &mut Ui, sheet: &MatchSheet, times: &mut Vec<PartTime>) {
    ui.horizontal(|ui| {
        let button = ui.menu_button("Stagger", |ui| {
            for order in StaggerOrder::ALL {
                let name = order.name();
                let item = ui.button(name.title);
                tooltip_left(&item, item.rect.left(), name.sentence);
                if item.clicked() {
                    *times = part_times::staggered_times(sheet, order);
                }
            }
        });
        let tip = "Starts the parts one after another. Each row can be adjusted afterwards.";
        tooltip_left(&button.response, button.response.rect.left(), tip);
        let tip = "Starts and ends all parts together again.";
        if !times.is_empty() && ui.button("All at once").on_hover_text(tip).clicked() {
            times.clear();
        }
    });
}

/// Draws the row of the part with the index `piece`. Returns the new clock (time window and easing)
/// of the part if the user changed it.
fn row(ui: &mut Ui, sheet: &MatchSheet, before: PartClock, piece: usize) -> Option<PartClock> {
    let mut clock = before;
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 6.0;
        picture(ui, sheet, piece);
        let bar_width = ui.available_width() - EASING_WIDTH - 22.0;
        time_bar::bar(ui, piece, bar_width, &mut clock);
        easing_editor::menu(
            ui,
            &format!("easing of part {piece}"),
            &mut clock.easing,
            EASING_WIDTH,
        );
    });
    if before == PartClock::WHOLE && (clock.from, clock.to) != (0.0, 1.0) {
        // A new time window gets the default easing, so that the part starts and stops smoothly.
        clock.easing = EasingFunction::default();
    }
    (clock != before).then_some(clock)
}

/// Draws the name of a part and, next to it, a thumbnail of a design that contains the part, with
/// the part highlighted.
fn picture(ui: &mut Ui, sheet: &MatchSheet, piece: usize) {
    let part = &sheet.pieces[piece];
    let (rect, response) =
        ui.allocate_exact_size(vec2(THUMBNAIL_WIDTH + 18.0, CONTROL_HEIGHT), Sense::hover());
    let palette = ThemePalette::of(ui);
    let (side, presence) = match part.fate {
        PieceFate::Paired => (Side::Source, "is in both designs"),
        PieceFate::Disappears => (Side::Source, "is only in the source and disappears"),
        PieceFate::Appears => (Side::Target, "is only in the target and appears"),
    };
    tooltip_left(
        &response,
        rect.left(),
        &format!("Part {} {presence}.", part.name),
    );
    let font = FontId::proportional(12.5);
    let middle = rect.left_center() + vec2(8.0, 0.0);
    ui.painter().text(
        middle,
        Align2::CENTER_CENTER,
        &part.name,
        font,
        palette.text,
    );
    let Some(sides) = &sheet.sides else { return };
    let frame = Rect::from_min_max(rect.left_top() + vec2(18.0, 1.0), rect.right_bottom());
    let view = PartThumbnail::of(sides[side].bounds, frame.shrink(1.0));
    // If there are very many boundary loops, only those of the highlighted part are drawn.
    let shows_others = sheet.rings.len() <= MAX_RINGS;
    let rings = sheet.rings.iter();
    for ring in rings.filter(|ring| shows_others || ring.piece == piece) {
        let is_own = ring.piece == piece;
        let ink = if is_own { palette.text } else { palette.line };
        let width = 1.0 + f32::from(is_own);
        view.draw(ui.painter(), &ring.sides[side], width, ink);
    }
}

/// Mapping that fits a design into the rectangle of a thumbnail.
struct PartThumbnail {
    bounds: Bounds,
    rect: Rect,
    scale: f32,
}

impl PartThumbnail {
    fn of(bounds: Bounds, rect: Rect) -> Self {
        let size = bounds.max - bounds.min;
        let scale = (rect.width() / size.x as f32).min(rect.height() / size.y as f32);
        Self {
            bounds,
            rect,
            scale,
        }
    }

    fn draw(&self, painter: &Painter, ring: &[DVec2], width: f32, ink: Color32) {
        let middle = 0.5 * (self.bounds.min + self.bounds.max);
        // About 48 vertices per boundary loop are enough for a thumbnail 30 points wide.
        let step = ring.len().div_ceil(48).max(1);
        let points = ring.iter().step_by(step).map(|p| {
            let from_middle = (*p - middle).as_vec2() * self.scale;
            self.rect.center() + vec2(from_middle.x, -from_middle.y)
        });
        painter.add(Shape::closed_line(points.collect(), (width, ink)));
    }
}
