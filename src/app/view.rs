//! How the transition is looked at: the view, what is shown, a second method, the map of
//! all designs, measures, and which method suits.

pub mod filmstrip;
pub mod frame_intervals;
pub mod onion_skins;
pub mod preference_actions;
pub mod stage_area;

use crate::transition::Transition;

/// Whether what is known is known of what is on the stage.
pub(in crate::app) fn is_same(known: Option<&Transition>, staged: Option<&Transition>) -> bool {
    match (known, staged) {
        (Some(known), Some(staged)) => known.is(staged),
        (None, None) => true,
        _ => false,
    }
}
