//! What lies on the stage: the hand on it, the second method beside it, the map, the verdict, a talk.

pub mod area;
pub mod film;
pub mod map;
pub mod map_bar;
pub mod onion;
pub mod talk;
pub mod twin;
pub mod verdict;
