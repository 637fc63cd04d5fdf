//! The map of all designs: marker, saved blends, paths, thumbnails and contours.

pub mod contours;
pub mod map_actions;
pub mod map_view;
pub mod pictures;
pub mod thumbnails;
pub mod update;
