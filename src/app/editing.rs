//! The match editor: shows which points of the two designs correspond, and lets the user change the
//! correspondence.
//!
//! A [`sheet::MatchSheet`] holds the contents of the editor, [`editor::MatchEditor`] the tool,
//! selection and views, and an [`EditorAction`](crate::app::input::editor_action::EditorAction) is
//! one action of the user. Actions use coordinates of the common frame in which both designs are
//! placed; the project stores their results in each design's own coordinates. The drawing code is
//! elsewhere.

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
