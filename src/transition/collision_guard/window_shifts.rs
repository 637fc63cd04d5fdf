//! Shortens the time window of a part that exists in only one design and collides.
//!
//! The time windows were chosen such that nothing collides at the sample times
//! ([`crate::transition::transients::placement`]). The proof also finds collisions between those
//! times.

use super::defects::FirstDefect;
use crate::geometry::Side;
use crate::warp::{Arap, TimeWindow};

/// Length of t between a collision and the new start or end of the time window (heuristic).
const SHIFT: f64 = 1.0 / 64.0;

/// Minimum length of a time window, in units of t (heuristic).
const SHORTEST: f64 = 1.0 / 16.0;

/// Result of shortening the time window of a colliding part.
pub(super) enum WindowShift {
    /// The time windows of all parts. One of them now starts after the collision or ends before it.
    To(Vec<Option<TimeWindow>>),
    /// The time window would be shorter than the minimum.
    TooShort,
    /// The defect involves no part that exists in only one design.
    NotTransient,
}

/// Shortens the time window of a part that collides in the given defect.
pub(super) fn shifted(film: &Arap, trouble: &FirstDefect) -> WindowShift {
    let Some(meeting) = trouble.meeting else {
        return WindowShift::NotTransient;
    };
    let parts = film.mesh().components();
    let both = [meeting.vertex, meeting.edge[0]].map(|v| parts[v as usize] as usize);
    let shifted = |&piece: &usize| {
        let life = film.time_windows().get(piece).copied().flatten()?;
        let next = match life.side {
            Side::Source => TimeWindow {
                to: life.to.min(trouble.t) - SHIFT,
                ..life
            },
            Side::Target => TimeWindow {
                from: life.from.max(trouble.t) + SHIFT,
                ..life
            },
        };
        Some((piece, next))
    };
    let long = |life: &TimeWindow| life.to - life.from;
    // If the time windows of both parts can be shortened, only one is: the one that then remains
    // longer.
    let longer =
        |a: &(usize, TimeWindow), b: &(usize, TimeWindow)| long(&a.1).total_cmp(&long(&b.1));
    match both.iter().filter_map(shifted).max_by(longer) {
        None => WindowShift::NotTransient,
        Some((_, life)) if long(&life) < SHORTEST => WindowShift::TooShort,
        Some((piece, life)) => {
            let mut lives = film.time_windows().to_vec();
            lives[piece] = Some(life);
            WindowShift::To(lives)
        }
    }
}
