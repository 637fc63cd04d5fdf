//! Parts of one design alone, which are born later or die earlier where they would
//! meet something.
//!
//! Where and when they come and go was chosen by what is seen at steps
//! ([`crate::transition::transients::placement`]); what is between those is known to the proof.

use super::defects::FirstDefect;
use crate::geometry::Side;
use crate::warp::{Arap, TimeWindow};

/// How much later or earlier, as a share of the film.
const SHIFT: f64 = 1.0 / 64.0;

/// A part changes its size in so much of the film at least.
const SHORTEST: f64 = 1.0 / 16.0;

/// What can be done about a part that comes or goes and meets something.
pub(super) enum WindowShift {
    /// The lives of all parts, with that of one begun after the trouble, or ended before.
    To(Vec<Option<TimeWindow>>),
    /// It has no time left.
    TooShort,
    /// No part of one design alone is in it.
    NotTransient,
}

/// What can be done about a trouble by shifting lives.
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
    // Of two that which keeps more of its time.
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
