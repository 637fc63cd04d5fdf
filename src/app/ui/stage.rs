//! What lies on the stage: the hand on it, the second method beside it, the map, the verdict, a talk.

pub mod area;
pub mod checks;
pub mod comparison;
pub mod film_frame;
pub mod map;
pub mod map_toolbar;
pub mod onion;
pub mod presentation;
