//! How the match editor is looked at, and what the hand holds in it.

use bevy::prelude::Resource;

use crate::app::editing::panes::EditorPanes;
use crate::app::input::editor_action::EditorTool;
use crate::geometry::{DVec2, Side};

/// What the hand can hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EditorHandle {
    /// A pin, by its number in the project.
    Pin(usize),
    /// A point that was matched without being asked for, by its number on the sheet.
    Feature(usize),
    /// An end of a cut, by its number on the sheet.
    Cut(usize, CutEnd),
    /// An end of a line, 0 or 1, by the line's number in the project.
    Line(usize, usize),
}

/// An end of a cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CutEnd {
    /// That on the boundary around the hole.
    Outer,
    /// That on the hole.
    Hole,
}

/// What the hand holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum EditorGrab {
    /// A pin, by its number in the project.
    Pin(usize),
    /// A point that becomes a pin as soon as it moves.
    Feature(usize),
    /// A cut that becomes one of the project's as soon as it moves, by its number on the sheet.
    FoundCut(usize, CutEnd),
    /// A cut, by its number in the project.
    Cut(usize, CutEnd),
    /// An end of a line, by the line's number in the project.
    Line(usize, usize),
    /// A line that is drawn as soon as the hand moves, from here.
    NewLine(DVec2),
    /// The second end, on both sides, of a line that is being drawn.
    Stretch(usize),
    /// The view.
    View,
}

/// How the sheet is looked at, and what the hand does with it.
#[derive(Resource, Clone, Debug, PartialEq)]
pub struct MatchEditor {
    /// The editor is shown in place of the stage.
    pub is_open: bool,
    /// What a click does.
    pub tool: EditorTool,
    /// Pins snap to corners.
    pub snaps: bool,
    /// The triangles are shown.
    pub triangles: bool,
    /// What is under the pointer.
    pub hovered: Option<EditorHandle>,
    /// The boundary under the pointer and what it is matched with: source and target.
    pub trace: Option<[DVec2; 2]>,
    /// The part under the pointer while parts are being paired.
    pub part: Option<(Side, usize)>,
    /// What was clicked last.
    pub selected: Option<EditorHandle>,
    /// What the hand holds, and on which side.
    pub grabbed: Option<(Side, EditorGrab)>,
    /// The first of two parts that are to be paired, with the point that names it.
    pub first_part: Option<(Side, usize, DVec2)>,
    /// Why the last act came to nothing.
    pub refusal: Option<&'static str>,
    /// How the designs and the film are looked at.
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
    /// A handle is under the pointer, or is what was clicked last.
    #[must_use]
    pub fn is_lit(&self, handle: EditorHandle) -> bool {
        [self.hovered, self.selected].contains(&Some(handle))
    }

    /// The film is shown beside the designs.
    #[must_use]
    pub fn shows_film(&self) -> bool {
        self.is_open && self.panes.film
    }

    /// Leaves what was entered last; `false` where there is nothing to leave.
    pub fn back(&mut self) -> bool {
        if self.first_part.take().is_some() {
            return true;
        }
        std::mem::take(&mut self.is_open)
    }
}
