//! The match editor: which point of one design is which of the other, seen and changed by hand.
//!
//! A [`sheet::Sheet`] is what there is to see, the [`editor::Editor`] how it is looked at and what
//! the hand holds, an [`EditorAct`](crate::app::asking::acts::EditorAct) what the hand does. Acts
//! come in the coordinates of the frame that both designs lie in; the project keeps what comes of
//! them in each design's own. Nothing here draws.

pub mod apply;
pub mod editor;
mod features;
mod hand;
pub mod letters;
pub mod panes;
pub mod polyline;
pub mod refresh;
pub mod ring;
pub mod sheet;
pub mod times;
