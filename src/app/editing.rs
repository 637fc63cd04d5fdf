//! The match editor: shows which points of the two designs correspond, and lets the user change
//! that.
//!
//! A [`sheet::MatchSheet`] holds what is shown, [`editor::MatchEditor`] the tool, selection and
//! views, and an [`EditorAction`](crate::app::input::editor_action::EditorAction) is one action of
//! the user. Actions use coordinates of the frame that both designs are placed in; the project
//! stores their results in each design's own coordinates. Nothing here draws.

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
