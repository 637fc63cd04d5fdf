//! Overlays of the stage and bars next to it: hints, invitation, comparison, map, checks and
//! presentation.

pub mod area;
pub mod checks;
pub mod comparison;
pub mod film_frame;
pub mod invitation;
pub mod map;
pub mod map_toolbar;
pub mod onion;
pub mod presentation;
