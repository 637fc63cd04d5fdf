//! Bar for editing the time window of a part: the interval of the film in which the part moves from
//! source to target. The user drags the ends of the bar or the whole bar.

use bevy_egui::egui::{CursorIcon, Id, Rect, Response, Sense, Stroke, Ui, pos2, vec2};

use crate::app::ui::kit::theme::{CONTROL_HEIGHT, GRID, RADIUS, ThemePalette};
use crate::app::ui::kit::widgets::tooltip_left;
use crate::warp::PartClock;

/// Shortest time window that dragging can make, as a fraction of the film (tolerance: the two ends
/// of the bar must stay apart).
const MIN_WINDOW: f64 = 0.02;

/// The end of the bar that the user drags, or the whole bar.
#[derive(Clone, Copy, PartialEq)]
enum TimeBarGrip {
    Start,
    End,
    Whole,
}

/// Draws the bar for `clock`, the time window and easing of a part. Dragging the bar changes the
/// time window; a double-click resets `clock` to the whole film. `salt` distinguishes the bars of a
/// list.
pub fn bar(ui: &mut Ui, salt: usize, width: f32, clock: &mut PartClock) {
    let (outer, _) = ui.allocate_exact_size(vec2(width, CONTROL_HEIGHT), Sense::hover());
    // The id must not depend on the layout. Otherwise a row that appears above the bar would end a
    // drag.
    let id = Id::new(("span", salt));
    let response = ui.interact(outer, id, Sense::click_and_drag());
    let track = outer.shrink2(vec2(2.0, 6.0));
    let px = |t: f64| track.left() + track.width() * t as f32;
    let [from, to] = [px(clock.from), px(clock.to)];
    let bar = Rect::from_min_max(pos2(from, track.top()), pos2(to, track.bottom()));
    let grip = dragged_grip(ui, &response, bar);
    if let Some(grip) = grip {
        let delta = f64::from(response.drag_delta().x / track.width());
        drag_grip(clock, grip, delta);
    }
    if response.drag_stopped() {
        (clock.from, clock.to) = (rounded(clock.from), rounded(clock.to));
    }
    if response.double_clicked() {
        *clock = PartClock::WHOLE;
    }
    if let Some(at) = response.hover_pos() {
        ui.ctx().set_cursor_icon(match grip_at(bar, at.x) {
            TimeBarGrip::Whole => CursorIcon::Grab,
            TimeBarGrip::Start | TimeBarGrip::End => CursorIcon::ResizeHorizontal,
        });
    }
    let is_lit = grip.is_some() || response.hovered();
    paint(ui, track, bar, is_lit, *clock == PartClock::WHOLE);
    let tip = format!(
        "From {:.0} % to {:.0} % of the film. Drag an end or the whole bar; double-click to reset.",
        100.0 * clock.from,
        100.0 * clock.to
    );
    tooltip_left(&response, track.left(), &tip);
}

/// Returns the grip that is being dragged: the one that was under the pointer when the drag began.
fn dragged_grip(ui: &Ui, response: &Response, bar: Rect) -> Option<TimeBarGrip> {
    let id = response.id.with("grip");
    if response.drag_started() {
        let at = ui.input(|input| input.pointer.press_origin());
        let grip = at.map(|at| grip_at(bar, at.x));
        ui.data_mut(|data| data.insert_temp(id, grip));
    }
    let grip: Option<TimeBarGrip> = ui.data(|data| data.get_temp(id)).flatten();
    grip.filter(|_| response.dragged())
}

/// Returns the grip at the coordinate `x`: the whole bar if `x` lies on the bar and is farther than
/// [`GRID`] from both ends, otherwise the nearer end.
fn grip_at(bar: Rect, x: f32) -> TimeBarGrip {
    let [from, to] = [bar.left(), bar.right()].map(|end| (end - x).abs());
    match from.min(to) {
        near if near > GRID && bar.x_range().contains(x) => TimeBarGrip::Whole,
        _ if from < to => TimeBarGrip::Start,
        _ => TimeBarGrip::End,
    }
}

fn drag_grip(clock: &mut PartClock, grip: TimeBarGrip, delta: f64) {
    match grip {
        // A project file may contain a time window shorter than `MIN_WINDOW`. The limits below keep
        // `clamp` from panicking in this case.
        TimeBarGrip::Start => {
            let max_from = (clock.to - MIN_WINDOW).max(0.0).min(clock.to);
            clock.from = (clock.from + delta).clamp(0.0, max_from);
        }
        TimeBarGrip::End => {
            let min_to = (clock.from + MIN_WINDOW).min(1.0);
            clock.to = (clock.to + delta).clamp(min_to, 1.0);
        }
        TimeBarGrip::Whole => {
            let delta = delta.clamp(-clock.from, 1.0 - clock.to);
            (clock.from, clock.to) = (clock.from + delta, clock.to + delta);
        }
    }
}

/// Rounds an end of a time window to thousandths, which is finer than the pointer can aim.
fn rounded(t: f64) -> f64 {
    (t * 1000.0).round() / 1000.0
}

fn paint(ui: &Ui, track: Rect, bar: Rect, is_lit: bool, is_whole: bool) {
    let palette = ThemePalette::of(ui);
    let ink = match (is_lit, is_whole) {
        (true, _) => palette.accent,
        (false, true) => palette.weak,
        (false, false) => palette.text,
    };
    let painter = ui.painter();
    painter.rect_filled(track, RADIUS, palette.raised);
    painter.rect_filled(bar, RADIUS, ink);
    // Vertical marks show where the user can grab the ends.
    let mark = Stroke::new(2.0, palette.panel);
    for x in [bar.left() + 3.0, bar.right() - 3.0] {
        painter.vline(x, bar.y_range().shrink(3.0), mark);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ends_do_not_cross_and_moving_the_bar_keeps_its_length() {
        let mut clock = PartClock::WHOLE;
        drag_grip(&mut clock, TimeBarGrip::Start, 0.4);
        drag_grip(&mut clock, TimeBarGrip::End, -0.9);
        assert!((clock.to - clock.from - MIN_WINDOW).abs() < 1e-12);
        drag_grip(&mut clock, TimeBarGrip::End, 0.18);
        drag_grip(&mut clock, TimeBarGrip::Whole, 5.0);
        assert!((clock.from - 0.8).abs() < 1e-12 && clock.to == 1.0);
        drag_grip(&mut clock, TimeBarGrip::Whole, -5.0);
        for (from, to) in [(0.99, 1.0), (0.0, 0.01)] {
            for grip in [TimeBarGrip::Start, TimeBarGrip::End] {
                let mut short = PartClock {
                    from,
                    to,
                    ..PartClock::WHOLE
                };
                drag_grip(&mut short, grip, 0.001);
                assert!(0.0 <= short.from && short.from < short.to && short.to <= 1.0);
            }
        }
        assert!(clock.from == 0.0 && (clock.to - 0.2).abs() < 1e-12);
    }
}
