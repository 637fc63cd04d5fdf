//! Everything the user can do, as one message type.
//!
//! Keys, panels, dialogs and dropped files only write [`Intent`]s; systems in the other files act
//! on them. So a key and a button that write the same intent always do the same, and tests can
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

/// One action of the user.
#[derive(Message, Clone, Debug, PartialEq)]
pub enum Intent {
    /// Play or pause.
    TogglePlay,
    /// Reverse the direction of playback.
    Reverse,
    /// Move t by this many hundredths, backwards if negative.
    Step(i32),
    /// Set t to any finite number; beyond the first and the last design the blend extrapolates.
    Seek(f64),
    /// Jump to the start of the film.
    SeekStart,
    /// Jump to the end of the film.
    SeekEnd,
    /// Jump to the next stop.
    JumpToNextStop,
    /// Jump to the previous stop.
    JumpToPreviousStop,
    /// Play to the next stop and wait there.
    PlayToNextStop,
    /// Play backwards to the previous stop and wait there.
    PlayToPreviousStop,
    /// Select the next faster playback speed.
    Faster,
    /// Select the next slower playback speed.
    Slower,
    /// Reset the playback speed to 1.
    NormalSpeed,
    /// Set the playback speed; 1 plays the film with its own timing.
    SetSpeed(f64),
    /// Cycle through once, loop and ping-pong.
    CyclePlayMode,
    /// Add a stop at the current t.
    AddStop,
    /// Undo the last change of the project.
    Undo,
    /// Redo the change that was undone last.
    Redo,
    /// Replace the settings of the current segment. Its match settings and the timing of its parts
    /// change for this segment only, all other settings for the whole project.
    ReplaceSettings(Box<Project>),
    /// Use the method with this warp and content.
    SetMethod(WarpKind, ContentKind),
    /// Use the next method, in cyclic order, that the current designs support.
    NextMethod,
    /// Try all suitable methods in the background, then use the best one.
    ChooseBestMethod,
    /// Stop trying methods.
    CancelMethodSearch,
    /// Open the dialog that asks for files to open.
    AskOpen,
    /// Close the dialog with these chosen files; none if it was cancelled.
    AnswerDialog(Vec<PathBuf>),
    /// Preview this file in the dialog.
    PreviewFile(PathBuf),
    /// Open these files: one project, or designs that become a new project.
    Open(Vec<PathBuf>),
    /// Open this single design, paired with itself.
    OpenAlone(PathBuf),
    /// Open the dialog that asks for the designs that follow this one in a new film.
    AskSecond(PathBuf),
    /// Close the project and show the invitation; asks first if work would be lost.
    New,
    /// Open the gallery project with this name.
    OpenGallery(String),
    /// Open the gallery project with this name and play it.
    PlayGallery(String),
    /// Start without files: play a gallery project and show the invitation.
    Welcome,
    /// Close the invitation.
    CloseInvitation,
    /// Open the dialog that asks for a replacement of the design with this index.
    AskReplace(usize),
    /// Replace the design with this index by this file.
    ReplaceDesign(usize, PathBuf),
    /// Open the dialog that asks for designs to insert before the design with this index, or after
    /// all designs if the index equals the number of designs.
    AskInsert(usize),
    /// Insert these designs before the design with this index, or after all designs if the index
    /// equals the number of designs.
    InsertDesigns(usize, Vec<PathBuf>),
    /// Replace the list of designs. Each entry is a design with its index in the old list, or with
    /// `None` if the design is new.
    ReorderDesigns(Vec<MovedDesigns>),
    /// Set whether the film is a closed loop, in which the last design leads back to the first.
    CloseLoop(bool),
    /// Save the project to its file; asks for a file if it has none.
    Save,
    /// Ask for a file and save the project there.
    SaveAs,
    /// Save the project to this file.
    SaveTo(PathBuf),
    /// Save an image of the stage or of the whole window.
    Screenshot {
        /// Whether the image includes the panels.
        with_panels: bool,
    },
    /// Copy an image of the stage to the clipboard.
    CopyImage,
    /// Copy the stage to the clipboard as an SVG document.
    CopySvg,
    /// Ask for a folder and a file name for an export.
    AskExport(ExportKind),
    /// Export to this file in the background. An existing file is replaced.
    Export(ExportKind, PathBuf),
    /// Cancel opening or building a project.
    CancelWork,
    /// Build anyway, although the estimate exceeds the time or memory limit.
    BuildAnyway,
    /// Cancel the export in progress.
    CancelExport,
    /// Start or end a talk.
    Present {
        /// Whether the talk is all that the program was started for; the window closes when it
        /// ends.
        is_all: bool,
    },
    /// Blacken the screen during a talk, or show the drawing again.
    ToggleBlackScreen,
    /// Show or hide the speaker window during a talk.
    ToggleSpeaker,
    /// Show or hide captions during a talk.
    ToggleCaptions,
    /// Switch between full screen and window.
    ToggleFullscreen,
    /// Hide everything except the stage, or show the panels again.
    TogglePanels,
    /// Show or hide the list of keys.
    ToggleHelp,
    /// Show or hide the frame times.
    ToggleFrameTimes,
    /// Show or hide the graphs of the measured quantities over t.
    TogglePlots,
    /// Apply the remedy for the defect with this index in the list of findings.
    ApplyRemedy(usize),
    /// Apply the suggested change with this index, in the order shown.
    ApplySuggestion(usize),
    /// Check the film again after the automatic check was stopped.
    MeasureAgain,
    /// Show or hide the comparison with a second method next to the stage.
    ToggleComparison,
    /// Set the method of the comparison.
    SetComparisonMethod(ComparisonMethod),
    /// Show the map of all designs in place of the stage, or hide it.
    ToggleMap,
    /// Set how the designs are laid out on the map.
    SetMapLayout(MapLayout),
    /// Move the marker to this point of the map, y up.
    MoveMarker(DVec2),
    /// Move the design with this index to this point of the map.
    MoveMapDesign(usize, DVec2),
    /// Replace the settings of the map, including its path and saved blends.
    EditMap(Box<MapSettings>),
    /// Show contours of this measure on the map; `None` shows none.
    ShowMapMeasure(Option<MapMeasure>),
    /// Set whether a click on the map adds a stop to the path instead of moving the marker.
    SetPathDrawing(bool),
    /// Extend the path through these points of the map; the last becomes a stop.
    ExtendPath(Vec<DVec2>),
    /// Remove the last stop of the path.
    RemoveLastPathStop,
    /// Start or end recording the marker's movement as a path.
    TogglePathRecording,
    /// Add the blend under the marker to the project's saved blends.
    SaveBlend,
    /// Export the saved blends to files.
    ExportSavedBlends,
    /// Esc: close or cancel the topmost open question, overlay, background work or mode. If there
    /// is none, cancel the export.
    Escape,
    /// Fit the whole transition into the view.
    FitView,
    /// Move the view by an offset in logical pixels, y down.
    Pan(Vec2),
    /// Zoom the view about a point.
    Zoom {
        /// The point that stays fixed, in logical pixels from the top left corner of the stage
        /// area, y down.
        at: Vec2,
        /// Zoom factor; above 1 magnifies.
        factor: f32,
    },
    /// An action in the match editor.
    Editor(EditorAction),
    /// Show or hide the grid deformed by the warp.
    ToggleGrid,
    /// Show or hide onion skins: thin outlines of the film at its stops or at regular t.
    ToggleOnion,
    /// Replace the user's preferences.
    SetPreferences(Preferences),
    /// Use the export preset with this name.
    UsePreset(String),
    /// Save the export settings as a preset with this name.
    SavePreset(String),
    /// Remove the preset with this name.
    RemovePreset(String),
    /// Dismiss the notice with this id.
    DismissNotice(u64),
    /// Close the window; asks first if work would be lost.
    Close,
    /// Answer to the question about unsaved changes or a running export.
    AnswerUnsaved(UnsavedAnswer),
    /// Answer to the offer to recover unsaved work.
    AnswerRecovery(RecoveryAnswer),
    /// Answer to the question about a project file that was changed elsewhere.
    AnswerConflict(ConflictAnswer),
}

/// Kind of an export to a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ExportKind {
    /// The film.
    Film,
    /// A sheet that compares all methods for the designs of the current segment.
    MethodSheet,
}

/// Answer to the question about a project file that another program or window has changed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ConflictAnswer {
    /// Replace the file with the open project.
    Overwrite,
    /// Discard the changes of the open project and open the file again.
    Reload,
    /// Save the open project in another file.
    SaveAs,
    /// Do not save.
    Cancel,
}

/// Answer to "Recover unsaved work?".
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RecoveryAnswer {
    /// Open the recovered project.
    Restore,
    /// Delete the recovered project.
    Discard,
    /// Ask again at the next start.
    Later,
}

impl Intent {
    /// Returns whether the intent is allowed during a talk: it must show the audience nothing but
    /// the drawing.
    #[must_use]
    pub const fn is_allowed_in_talk(&self) -> bool {
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
                | Self::ToggleBlackScreen
                | Self::ToggleSpeaker
                | Self::ToggleCaptions
                | Self::ToggleFullscreen
                | Self::Escape
        )
    }
}

/// Answer to a question about unsaved changes or a running export.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UnsavedAnswer {
    /// Save the project, or wait for the export to finish; then continue.
    Save,
    /// Continue without saving, or cancel the export and continue.
    Discard,
    /// Cancel the action that raised the question.
    Cancel,
}
