//! A span of the film as a bar, whose ends and middle are dragged.

use bevy_egui::egui::{CursorIcon, Id, Rect, Response, Sense, Stroke, Ui, pos2, vec2};

use crate::app::ui::kit::theme::{CONTROL_HEIGHT, GRID, RADIUS, ThemePalette};
use crate::app::ui::kit::widgets::tooltip_left;
use crate::warp::PartClock;

/// The shortest way that the hand can make.
const SHORTEST: f64 = 0.02;

/// What the hand has taken.
#[derive(Clone, Copy, PartialEq)]
enum TimeBarGrip {
    From,
    To,
    Whole,
}

/// Draws it, and lets the hand change from when to when a clock runs; a double click makes it that
/// of the whole.
pub fn bar(ui: &mut Ui, salt: usize, width: f32, clock: &mut PartClock) {
    let (outer, _) = ui.allocate_exact_size(vec2(width, CONTROL_HEIGHT), Sense::hover());
    // A name of its own: a row that comes or goes above must not let go of what is held.
    let id = Id::new(("span", salt));
    let response = ui.interact(outer, id, Sense::click_and_drag());
    let track = outer.shrink2(vec2(2.0, 6.0));
    let px = |t: f64| track.left() + track.width() * t as f32;
    let [from, to] = [px(clock.from), px(clock.to)];
    let bar = Rect::from_min_max(pos2(from, track.top()), pos2(to, track.bottom()));
    let held = held(ui, &response, bar);
    if let Some(grip) = held {
        let delta = f64::from(response.drag_delta().x / track.width());
        moved(clock, grip, delta);
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
            TimeBarGrip::From | TimeBarGrip::To => CursorIcon::ResizeHorizontal,
        });
    }
    let is_lit = held.is_some() || response.hovered();
    paint(ui, track, bar, is_lit, *clock == PartClock::WHOLE);
    let words = format!(
        "From {:.0} % to {:.0} % of the film. Drag an end, or the whole bar; double-click: all of it.",
        100.0 * clock.from,
        100.0 * clock.to
    );
    tooltip_left(&response, track.left(), &words);
}

/// What the hand holds: what was taken stays so for as long as it is held.
fn held(ui: &Ui, response: &Response, bar: Rect) -> Option<TimeBarGrip> {
    let id = response.id.with("grip");
    if response.drag_started() {
        let at = ui.input(|input| input.pointer.press_origin());
        let grip = at.map(|at| grip_at(bar, at.x));
        ui.data_mut(|data| data.insert_temp(id, grip));
    }
    let held: Option<TimeBarGrip> = ui.data(|data| data.get_temp(id)).flatten();
    held.filter(|_| response.dragged())
}

/// The nearer end wins where both are within reach.
fn grip_at(bar: Rect, x: f32) -> TimeBarGrip {
    let [from, to] = [bar.left(), bar.right()].map(|end| (end - x).abs());
    match from.min(to) {
        near if near > GRID && bar.x_range().contains(x) => TimeBarGrip::Whole,
        _ if from < to => TimeBarGrip::From,
        _ => TimeBarGrip::To,
    }
}

fn moved(clock: &mut PartClock, grip: TimeBarGrip, delta: f64) {
    match grip {
        // A file may have shorter ones.
        TimeBarGrip::From => {
            let most = (clock.to - SHORTEST).max(0.0).min(clock.to);
            clock.from = (clock.from + delta).clamp(0.0, most);
        }
        TimeBarGrip::To => {
            let least = (clock.from + SHORTEST).min(1.0);
            clock.to = (clock.to + delta).clamp(least, 1.0);
        }
        TimeBarGrip::Whole => {
            let delta = delta.clamp(-clock.from, 1.0 - clock.to);
            (clock.from, clock.to) = (clock.from + delta, clock.to + delta);
        }
    }
}

/// To a thousandth, as a hand can aim at.
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
    // Where it is taken hold of.
    let mark = Stroke::new(2.0, palette.panel);
    for x in [bar.left() + 3.0, bar.right() - 3.0] {
        painter.vline(x, bar.y_range().shrink(3.0), mark);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ends_do_not_pass_each_other_and_the_whole_keeps_its_length() {
        let mut clock = PartClock::WHOLE;
        moved(&mut clock, TimeBarGrip::From, 0.4);
        moved(&mut clock, TimeBarGrip::To, -0.9);
        assert!((clock.to - clock.from - SHORTEST).abs() < 1e-12);
        moved(&mut clock, TimeBarGrip::To, 0.18);
        moved(&mut clock, TimeBarGrip::Whole, 5.0);
        assert!((clock.from - 0.8).abs() < 1e-12 && clock.to == 1.0);
        moved(&mut clock, TimeBarGrip::Whole, -5.0);
        for (from, to) in [(0.99, 1.0), (0.0, 0.01)] {
            for grip in [TimeBarGrip::From, TimeBarGrip::To] {
                let mut short = PartClock {
                    from,
                    to,
                    ..PartClock::WHOLE
                };
                moved(&mut short, grip, 0.001);
                assert!(0.0 <= short.from && short.from < short.to && short.to <= 1.0);
            }
        }
        assert!(clock.from == 0.0 && (clock.to - 0.2).abs() < 1e-12);
    }
}
