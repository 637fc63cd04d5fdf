//! Tool and selection of the match editor, the objects under the pointer, the dragged object, and
//! the views of the editor's panes.

use bevy::prelude::Resource;

use crate::app::editing::panes::EditorPanes;
use crate::app::input::editor_action::EditorTool;
use crate::geometry::{DVec2, Side};

/// Handle in the match editor: a point that the user can select or drag.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EditorHandle {
    /// A pin, by its index in the project.
    Pin(usize),
    /// An automatically matched point, by its index on the sheet.
    Feature(usize),
    /// An end of a cut: the cut's index on the match sheet, and which of its ends it is.
    Cut(usize, CutEnd),
    /// An end of a line: the line's index in the project, and 0 or 1 for the end.
    Line(usize, usize),
}

/// One of the two ends of a cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CutEnd {
    /// The end on the part's outer boundary or on another hole.
    Outer,
    /// The end on the hole.
    Hole,
}

/// The object being dragged.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum EditorGrab {
    /// A pin, by its index in the project.
    Pin(usize),
    /// An automatically matched point, by its index on the sheet; becomes a pin when it moves.
    Feature(usize),
    /// An end of an automatic cut: the cut's index on the match sheet, and which of its ends is
    /// dragged. When the end moves, the cut becomes a cut of the project.
    AutomaticCut(usize, CutEnd),
    /// An end of a cut of the project: the cut's index in the project, and which of its ends is
    /// dragged.
    Cut(usize, CutEnd),
    /// An end of a line: the line's index in the project, and 0 or 1 for the end.
    Line(usize, usize),
    /// A new line that starts at this point; created in the project when the pointer moves.
    NewLine(DVec2),
    /// The second end of a new line, which moves in both designs at once; contains the line's index
    /// in the project.
    NewLineEnd(usize),
    /// The view of a pane.
    View,
}

/// The match editor: its tool, its selection, its dragged object and the views of its panes.
#[derive(Resource, Clone, Debug, PartialEq)]
pub struct MatchEditor {
    /// Whether the editor is shown in place of the stage.
    pub is_open: bool,
    /// The selected tool.
    pub tool: EditorTool,
    /// Whether pins snap to corners.
    pub snaps: bool,
    /// Whether the triangles of the mesh are shown.
    pub triangles: bool,
    /// The handle under the pointer.
    pub hovered: Option<EditorHandle>,
    /// The boundary point under the pointer and the point matched with it, in the order source,
    /// target.
    pub trace: Option<[DVec2; 2]>,
    /// The part under the pointer, while the tool pairs parts: design and index.
    pub part: Option<(Side, usize)>,
    /// The handle that was clicked last.
    pub selected: Option<EditorHandle>,
    /// The object being dragged, and the design in which the drag started.
    pub grabbed: Option<(Side, EditorGrab)>,
    /// The first of two parts being paired: design, index, and the point that was clicked.
    pub first_part: Option<(Side, usize, DVec2)>,
    /// Message that says why the last click had no effect; `None` if the click had an effect.
    pub refusal: Option<&'static str>,
    /// Pan and zoom of the designs and the film.
    pub panes: EditorPanes,
}

impl Default for MatchEditor {
    fn default() -> Self {
        Self {
            is_open: false,
            tool: EditorTool::default(),
            snaps: true,
            triangles: false,
            hovered: None,
            trace: None,
            part: None,
            selected: None,
            grabbed: None,
            first_part: None,
            refusal: None,
            panes: EditorPanes::default(),
        }
    }
}

impl MatchEditor {
    /// Whether a handle is hovered or selected.
    #[must_use]
    pub fn is_highlighted(&self, handle: EditorHandle) -> bool {
        [self.hovered, self.selected].contains(&Some(handle))
    }

    /// Whether the film is shown next to the designs.
    #[must_use]
    pub fn shows_film(&self) -> bool {
        self.is_open && self.panes.film
    }

    /// Handles Esc: drops an incomplete pair of parts, or closes the editor; returns `false` if
    /// neither applies.
    pub fn handle_escape(&mut self) -> bool {
        if self.first_part.take().is_some() {
            return true;
        }
        std::mem::take(&mut self.is_open)
    }
}
