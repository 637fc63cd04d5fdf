//! Overlays of the stage, bars above and below it, and views that replace it: hints, invitation,
//! checks, onion skins, film frame, comparison, map and presentation.

pub mod area;
pub mod check_row;
pub mod checks;
pub mod comparison;
pub mod film_frame;
pub mod invitation;
pub mod map;
pub mod map_toolbar;
pub mod onion;
pub mod presentation;
pub mod structure_rows;
