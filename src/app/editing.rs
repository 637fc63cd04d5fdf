//! The match editor: which point of one design is which of the other, seen and changed by hand.
//!
//! A [`sheet::MatchSheet`] is what there is to see, the [`editor::MatchEditor`] how it is looked at and what
//! the hand holds, an [`EditorAct`](crate::app::asking::acts::EditorAct) what the hand does. Acts
//! come in the coordinates of the frame that both designs lie in; the project keeps what comes of
//! them in each design's own. Nothing here draws.

pub mod actions;
pub mod editor;
pub mod labels;
pub mod panes;
pub mod part_times;
mod picking;
pub mod polyline;
pub mod refresh;
mod sample_points;
pub mod sheet;
pub mod sheet_ring;
