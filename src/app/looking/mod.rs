//! How the transition is looked at: the view, what is shown, a second method, the map of
//! all designs, measures, and which method suits.

pub mod blending;
pub mod choosing;
pub mod filmstrip;
pub mod ground;
pub mod helping;
pub mod land;
pub mod made;
pub mod map;
pub mod measuring;
pub mod onion;
pub mod preferences;
pub mod recording;
pub mod remembered;
pub mod times;
pub mod twin;
pub mod view;
pub mod walking;

use crate::transition::Transition;

/// Whether what is known is known of what is on the stage.
fn is_same(known: Option<&Transition>, staged: Option<&Transition>) -> bool {
    match (known, staged) {
        (Some(known), Some(staged)) => known.is(staged),
        (None, None) => true,
        _ => false,
    }
}
