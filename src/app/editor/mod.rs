//! The match editor: which point of one design is which of the other, seen and changed by hand.
//!
//! [`Sheet`] is what there is to see, [`Editor`] how it is looked at and what the hand holds, an
//! [`EditorAct`] what the hand does. Acts come in the coordinates of the frame that both designs
//! lie in; the project keeps what comes of them in each design's own. Nothing here draws.

mod act;
mod features;
mod hand;
mod polyline;
mod sheet;

use bevy::prelude::{DetectChanges, Res, ResMut, Resource, Vec2};

pub use act::apply;
pub use polyline::spans;
pub use sheet::{Fate, Sheet, SheetCut, SheetPiece, SheetRing, SheetSide};

use crate::app::session::Session;
use crate::geometry::{DVec2, Side};

/// One act in the match editor.
#[derive(Clone, Debug, PartialEq)]
pub enum EditorAct {
    /// Show the editor in place of the stage, or the stage again.
    Toggle,
    /// What a click does.
    Tool(Tool),
    /// Pins snap to corners.
    Snap(bool),
    /// The triangles are shown.
    Triangles(bool),
    /// The pointer is here, or nowhere.
    Hover(Option<Touch>),
    /// The hand takes what is here.
    Press(Touch),
    /// The hand moves, by so many logical pixels, y down, to there.
    Drag(Touch, Vec2),
    /// The hand lets go.
    Release,
    /// A click.
    Click(Touch),
    /// Delete what is here.
    Remove(Touch),
    /// Delete what is selected.
    RemoveSelected,
    /// Delete everything that was said of the match by hand, the rules aside.
    Clear,
    /// Move the view by so many logical pixels, y down.
    Pan(Vec2),
    /// Zoom the view.
    Zoom {
        /// The point that stays where it is, in logical pixels from the middle of the half, y
        /// down.
        at: Vec2,
        /// Above 1 comes nearer.
        factor: f32,
    },
}

/// A place that the hand points to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Touch {
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
pub enum Tool {
    /// Sets a pin.
    #[default]
    Pins,
    /// Draws pairs of lines.
    Lines,
    /// Pairs parts.
    Parts,
}

/// What the hand can hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Handle {
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
pub enum Grab {
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
pub struct Editor {
    /// The editor is shown in place of the stage.
    pub is_open: bool,
    /// What a click does.
    pub tool: Tool,
    /// Pins snap to corners.
    pub snaps: bool,
    /// The triangles are shown.
    pub triangles: bool,
    /// What is under the pointer.
    pub hovered: Option<Handle>,
    /// The boundary under the pointer and what it is matched with: source and target.
    pub trace: Option<[DVec2; 2]>,
    /// The part under the pointer while parts are being paired.
    pub part: Option<(Side, usize)>,
    /// What was clicked last.
    pub selected: Option<Handle>,
    /// What the hand holds, and on which side.
    pub grabbed: Option<(Side, Grab)>,
    /// The first of two parts that are to be paired, with the point that names it.
    pub first_part: Option<(Side, usize, DVec2)>,
    /// Why the last act came to nothing.
    pub refusal: Option<&'static str>,
    /// How far the view was moved, in logical pixels, y down.
    pub pan: Vec2,
    /// How much larger than fitted.
    pub zoom: f32,
}

impl Default for Editor {
    fn default() -> Self {
        Self {
            is_open: false,
            tool: Tool::default(),
            snaps: true,
            triangles: false,
            hovered: None,
            trace: None,
            part: None,
            selected: None,
            grabbed: None,
            first_part: None,
            refusal: None,
            pan: Vec2::ZERO,
            zoom: 1.0,
        }
    }
}

impl Editor {
    /// Leaves what was entered last; `false` where there is nothing to leave.
    pub fn back(&mut self) -> bool {
        if self.first_part.take().is_some() {
            return true;
        }
        std::mem::take(&mut self.is_open)
    }
}

/// Lays the sheet out anew where the project, its transition or the editor is another.
pub fn refresh(
    session: Res<Session>,
    mut editor: ResMut<Editor>,
    mut sheet: ResMut<Sheet>,
    mut was_open: bevy::prelude::Local<bool>,
) {
    let is_opened = editor.is_open && !*was_open;
    *was_open = editor.is_open;
    if !editor.is_open || !(is_opened || session.is_changed()) {
        return;
    }
    *sheet = session.sheet();
    if sheet.sides.is_none() {
        editor.is_open = false;
    }
    let is_there = |handle: &mut Handle| match *handle {
        Handle::Pin(k) => k < sheet.pins.len(),
        Handle::Feature(k) => k < sheet.features.len(),
        Handle::Cut(k, _) => k < sheet.cuts.len(),
        Handle::Line(k, _) => k < sheet.lines.len(),
    };
    editor.selected = editor.selected.take_if(is_there);
    editor.hovered = editor.hovered.take_if(is_there);
}
