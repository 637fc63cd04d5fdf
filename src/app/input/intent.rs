//! What a user can ask for, as one message type.
//!
//! Keys, panels, dialogs and dropped files only write [`Intent`]s; the systems of the other files
//! act on them. So a key and a button that mean the same thing cannot drift apart, and a test can
//! drive the program without a window.

use std::path::PathBuf;

use bevy::prelude::{Message, Vec2};

use crate::app::input::editor_action::EditorAction;
use crate::app::input::preferences::{ComparisonMethod, Preferences};
use crate::content::ContentKind;
use crate::geometry::DVec2;
use crate::measure::MapMeasure;
use crate::project::{MapSettings, MovedDesigns, Project};
use crate::space::MapLayout;
use crate::warp::WarpKind;

/// One act of the user.
#[derive(Message, Clone, Debug, PartialEq)]
pub enum Intent {
    /// Play, or pause.
    TogglePlay,
    /// Play the other way.
    Reverse,
    /// Move t by so many hundredths.
    Step(i32),
    /// Set t; any finite number, outside 0..1 extrapolates.
    Seek(f64),
    /// Jump to where the pass starts.
    SeekStart,
    /// Jump to where the pass ends.
    SeekEnd,
    /// Jump to the next stop.
    JumpToNextStop,
    /// Jump to the stop before.
    JumpToPreviousStop,
    /// Play to the next stop and wait there.
    PlayToNextStop,
    /// Play backwards to the stop before and wait there.
    PlayToPreviousStop,
    /// The next faster speed.
    Faster,
    /// The next slower speed.
    Slower,
    /// Speed 1.
    NormalSpeed,
    /// This speed, a factor on that of the timing.
    Speed(f64),
    /// Once, loop, ping-pong, and round again.
    CyclePlayMode,
    /// Put a stop where t is.
    AddStop,
    /// Take the last change of the project back.
    Undo,
    /// Make the change again that was taken back last.
    Redo,
    /// Replace the project's settings; the designs stay those that are named in it.
    Edit(Box<Project>),
    /// Show the transition by this cell.
    UseCell(WarpKind, ContentKind),
    /// Show the transition by the next cell that can be had.
    NextMethod,
    /// Try the methods that could suit, and show the transition by the best.
    ChooseMethod,
    /// Stop trying methods.
    CancelChoice,
    /// Ask for files to open.
    AskOpen,
    /// The answer of the dialog that asked for files; none where it was left.
    Choose(Vec<PathBuf>),
    /// Show what this file holds, in the dialog that asks for files.
    LookAt(PathBuf),
    /// Open these files: one project, or designs, one after the other.
    Open(Vec<PathBuf>),
    /// Open a bundled project by its name.
    OpenGallery(String),
    /// Ask for a file that replaces the design of this number, from 0.
    AskReplace(usize),
    /// Replace the design of this number, from 0, by this file.
    ReplaceDesign(usize, PathBuf),
    /// Ask for files of designs that come before the design of this number, or after all.
    AskInsert(usize),
    /// Let designs of these files come before the design of this number, or after all.
    InsertDesigns(usize, Vec<PathBuf>),
    /// Other designs, or the same in another order, each with its number until now.
    Arrange(Vec<MovedDesigns>),
    /// Let the last design lead back to the first, or no more.
    LeadBack(bool),
    /// Write the project where it came from; asks for a place if it has none.
    Save,
    /// Ask for a place and write the project there.
    SaveAs,
    /// Write the project to this path.
    SaveTo(PathBuf),
    /// Save a picture of the stage, or of the whole window.
    Screenshot {
        /// With the panels, as the window shows it.
        with_panels: bool,
    },
    /// Put a picture of the stage on the clipboard.
    CopyPicture,
    /// Put what the stage shows on the clipboard, as an SVG document.
    CopyShapes,
    /// Record one pass as a film in the background.
    Record,
    /// Write a sheet of every method by which the pair can be seen, in the background.
    Compare,
    /// Stop the work that is going on.
    CancelWork,
    /// Build all the same what would take very long.
    Insist,
    /// Stop the recording that is going on.
    CancelRecording,
    /// Begin a talk, or end it.
    Present {
        /// The window is there for it, and closes with it.
        is_all: bool,
    },
    /// Make the screen black in a talk, or show the drawing again.
    Black,
    /// Show or hide the speaker's window in a talk.
    ToggleSpeaker,
    /// Show or hide the captions in a talk.
    ToggleCaptions,
    /// Whole screen, or window.
    ToggleFullscreen,
    /// Hide everything but the stage, or show it again.
    TogglePanels,
    /// Show or hide the list of keys.
    ToggleHelp,
    /// Show or hide the times of a frame.
    ToggleTimes,
    /// Show or hide the measures against t.
    TogglePlots,
    /// Do what the verdict advises about this finding.
    TakeAdvice(usize),
    /// Take what was tried and helps, by its number.
    TakeOffer(usize),
    /// Measure the transition, which was stopped.
    Measure,
    /// Show or hide a second method beside the stage.
    ToggleTwin,
    /// The method that is shown beside the stage.
    TwinMethod(ComparisonMethod),
    /// Show or hide the map of all designs in place of the stage.
    ToggleMap,
    /// Lay the designs out on the map.
    LayOut(MapLayout),
    /// Move the puck there on the map, y up.
    Puck(DVec2),
    /// Move the design of this number there on the map.
    MoveSite(usize, DVec2),
    /// Replace what is said of the map.
    EditMap(Box<MapSettings>),
    /// Show the contours of a measure on the map, or none.
    ShowMeasure(Option<MapMeasure>),
    /// A click on the map sets a stop of the path, or moves the puck.
    DrawPath(bool),
    /// Let the path go on through these places of the map, to a stop at the last of them.
    ExtendPath(Vec<DVec2>),
    /// Take the last stop of the path off.
    ShortenPath,
    /// Record the way of the puck as a path, or end that.
    RecordPath,
    /// Keep the blend under the puck.
    Keep,
    /// Write the places that are kept as files.
    ExportKept,
    /// Leave what was entered last: help, question, hidden panels, whole screen.
    Back,
    /// Show the whole transition.
    FitView,
    /// Move the view by so many logical pixels, y down.
    Pan(Vec2),
    /// Zoom the view.
    Zoom {
        /// The point that stays where it is, in logical pixels from the stage area's upper left
        /// corner, y down.
        at: Vec2,
        /// Above 1 comes nearer.
        factor: f32,
    },
    /// An act in the match editor.
    Editor(EditorAction),
    /// Show or hide the grid that shows the warp.
    ToggleGrid,
    /// Show or hide thin outlines of the film at other t.
    ToggleOnion,
    /// Replace what the person at the screen chose.
    Prefer(Preferences),
    /// Make films as was kept under this name.
    UsePreset(String),
    /// Keep how films are made under this name.
    KeepPreset(String),
    /// Forget what was kept under this name.
    ForgetPreset(String),
    /// A message was read.
    Dismiss(u64),
    /// Close the window; asks first where something would be lost.
    Close,
    /// The answer to the question about what would be lost.
    Answer(UnsavedAnswer),
    /// The answer to what can be taken up again.
    Rescue(RecoveryAnswer),
}

/// An answer to "this was not saved when the program ended".
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RecoveryAnswer {
    /// Open it as it was.
    Restore,
    /// It is not wanted.
    Discard,
    /// Ask again at the next start.
    Later,
}

impl Intent {
    /// It may be asked for in a talk: it shows nothing but the drawing.
    #[must_use]
    pub const fn is_of_a_talk(&self) -> bool {
        matches!(
            self,
            Self::TogglePlay
                | Self::Reverse
                | Self::Step(_)
                | Self::Seek(_)
                | Self::SeekStart
                | Self::SeekEnd
                | Self::JumpToNextStop
                | Self::JumpToPreviousStop
                | Self::PlayToNextStop
                | Self::PlayToPreviousStop
                | Self::Faster
                | Self::Slower
                | Self::NormalSpeed
                | Self::Present { .. }
                | Self::Black
                | Self::ToggleSpeaker
                | Self::ToggleCaptions
                | Self::ToggleFullscreen
                | Self::Back
        )
    }
}

/// An answer to "this would be lost".
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UnsavedAnswer {
    /// Save it, or wait for it, then go on.
    Save,
    /// Go on without it.
    Discard,
    /// Do not go on.
    Stay,
}
