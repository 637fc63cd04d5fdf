//! What a hand can ask for in the match editor, as plain data.

use bevy::prelude::Vec2;

use crate::app::editing::panes::EditorPane;
use crate::geometry::{DVec2, Side};

/// One act in the match editor.
#[derive(Clone, Debug, PartialEq)]
pub enum EditorAction {
    /// Show the editor in place of the stage, or the stage again.
    Toggle,
    /// What a click does.
    Tool(EditorTool),
    /// Pins snap to corners.
    Snap(bool),
    /// The triangles are shown.
    Triangles(bool),
    /// The pointer is here, or nowhere.
    Hover(Option<EditorPointer>),
    /// The hand takes what is here.
    Press(EditorPointer),
    /// The hand moves, by so many logical pixels, y down, to there.
    Drag(EditorPointer, Vec2),
    /// The hand lets go.
    Release,
    /// A click.
    Click(EditorPointer),
    /// Delete what is here.
    Remove(EditorPointer),
    /// Delete what is selected.
    RemoveSelected,
    /// Delete everything that was said of the match by hand, the rules aside.
    Clear,
    /// Show the film beside the designs.
    Film(bool),
    /// Move and enlarge all panes together, or each alone.
    Together(bool),
    /// Move a pane by so many logical pixels, y down.
    Pan(EditorPane, Vec2),
    /// Zoom a pane.
    Zoom {
        /// Which.
        pane: EditorPane,
        /// The point that stays where it is, in logical pixels from the middle of the pane, y
        /// down.
        at: Vec2,
        /// Above 1 comes nearer.
        factor: f32,
    },
}

/// A place that the hand points to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EditorPointer {
    /// In which design.
    pub side: Side,
    /// Where, in the frame.
    pub at: DVec2,
    /// How near counts as there, in the frame.
    pub reach: f64,
    /// Pins do not snap.
    pub is_free: bool,
}

/// What a click does.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum EditorTool {
    /// Sets a pin.
    #[default]
    Pins,
    /// Draws pairs of lines.
    Lines,
    /// Pairs parts.
    Parts,
}
