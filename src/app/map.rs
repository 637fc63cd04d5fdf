//! The map on which the designs are placed: its marker, saved blends, paths, thumbnails and
//! contours.

pub mod contours;
pub mod map_actions;
pub mod map_view;
pub mod pictures;
pub mod thumbnails;
pub mod update;
