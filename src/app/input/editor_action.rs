//! Actions of the match editor as plain data, so that tests can drive the editor without a window.

use bevy::prelude::Vec2;

use crate::geometry::{DVec2, Side};

/// One action of the user in the match editor.
#[derive(Clone, Debug, PartialEq)]
pub enum EditorAction {
    /// Open the editor in place of the stage, or close it.
    Toggle,
    /// Select the tool that a click applies.
    SelectTool(EditorTool),
    /// Set whether pins snap to corners.
    SetSnapping(bool),
    /// Set whether the triangles of the mesh are shown.
    ShowTriangles(bool),
    /// The pointer hovers at this position; `None` when it leaves the designs.
    Hover(Option<EditorPointer>),
    /// The mouse button is pressed at this position.
    Press(EditorPointer),
    /// The pointer is dragged to this position. The offset is the movement since the last event, in
    /// logical pixels, y down.
    Drag(EditorPointer, Vec2),
    /// The mouse button is released.
    Release,
    /// The mouse button is pressed and released at this position, without a drag.
    Click(EditorPointer),
    /// Delete the pin, line or cut under the pointer or, with the parts tool, all pairings of the
    /// part under the pointer.
    Remove(EditorPointer),
    /// Delete the selected pin, line or cut.
    RemoveSelected,
    /// Delete everything that was set by hand: pins, lines, cuts and pairings of parts. The
    /// matching rules stay.
    Clear,
    /// Set whether the film is shown next to the designs.
    ShowFilm(bool),
    /// Set whether all panes pan and zoom together.
    LinkPanes(bool),
    /// Move the content of a pane by an offset in logical pixels, y down.
    Pan(EditorPane, Vec2),
    /// Zoom a pane about a point.
    Zoom {
        /// The pane to zoom.
        pane: EditorPane,
        /// The point that stays fixed, in logical pixels from the centre of the pane, y down.
        at: Vec2,
        /// Zoom factor; above 1 magnifies.
        factor: f32,
    },
}

/// Pointer position on one of the two designs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EditorPointer {
    /// The design under the pointer.
    pub side: Side,
    /// Position in the common frame of both designs.
    pub position: DVec2,
    /// Maximum distance from the pointer, in the frame's unit of length, at which a handle,
    /// boundary point or part is picked.
    pub pick_radius: f64,
    /// Whether snapping is suspended, because a modifier key is held down.
    pub ignores_snapping: bool,
}

/// Tool of the match editor, which determines the effect of a click.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum EditorTool {
    /// Sets a pin: a pair of points that correspond.
    #[default]
    Pins,
    /// Draws pairs of lines that correspond.
    Lines,
    /// Pairs parts of the two designs.
    Parts,
}

/// One pane of the match editor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EditorPane {
    /// Pane of the source or of the target.
    Design(Side),
    /// The film between the two designs.
    Film,
}
