//! What there is to choose from at the screen.

use bevy::prelude::Resource;

use crate::content::ContentKind;
use crate::export::{FilmKind, Layout};
use crate::stage::Show;
use crate::transition::Cell;

/// What the person at the screen chose; not part of any project.
#[derive(Resource, Clone, Copy, Debug, PartialEq)]
pub struct Preferences {
    /// The colours of the panels.
    pub theme: ThemeChoice,
    /// What the stage draws.
    pub show: Show,
    /// Panels are shown.
    pub panels: bool,
    /// The list of keys is shown.
    pub help: bool,
    /// The times of a frame are shown.
    pub times: bool,
    /// The measures against t are shown.
    pub plots: bool,
    /// Size of screenshots.
    pub capture_scale: CaptureScale,
    /// Screenshots and films have a transparent ground.
    pub capture_transparent: bool,
    /// Kind of file of a recording.
    pub record_format: RecordFormat,
    /// How films lie in their pictures.
    pub film: FilmLook,
    /// The options of pictures and films are shown.
    pub film_options: bool,
}

impl Default for Preferences {
    fn default() -> Self {
        Self {
            theme: ThemeChoice::default(),
            show: Show::default(),
            panels: true,
            help: false,
            times: false,
            plots: false,
            capture_scale: CaptureScale::default(),
            capture_transparent: false,
            record_format: RecordFormat::default(),
            film: FilmLook::default(),
            film_options: false,
        }
    }
}

/// How films look, besides what they show.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FilmLook {
    /// Their shape and size.
    pub layout: Layout,
    /// Frames a second.
    pub fps: u32,
}

impl Default for FilmLook {
    /// For slides, at a rate that GIF's clock of hundredths keeps exactly.
    fn default() -> Self {
        Self {
            layout: Layout::default(),
            fps: 25,
        }
    }
}

/// The colours of the panels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ThemeChoice {
    /// Light panels on a dark ground.
    #[default]
    Dark,
    /// Dark panels on a light ground.
    Light,
}

/// The size of a screenshot of the stage.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum CaptureScale {
    /// As many pixels as the window has.
    #[default]
    One,
    /// Twice as many along each side.
    Two,
    /// 3840 pixels along the longer side.
    FourK,
}

/// The kind of file that a recording writes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RecordFormat {
    /// One file that moves.
    Film(FilmKind),
    /// A folder of numbered PNGs.
    Pngs,
}

impl RecordFormat {
    /// That which has no transparency: its films get the ground colour whatever was chosen.
    pub const OPAQUE: Self = Self::Film(FilmKind::Mp4);
}

impl Default for RecordFormat {
    /// What plays everywhere.
    fn default() -> Self {
        Self::Film(FilmKind::Gif)
    }
}

/// A method that the twin view can show.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TwinMethod {
    /// Each vertex of the common triangulation goes straight to its place.
    Straight,
    /// A cell of the table.
    Cell(Cell),
}

impl TwinMethod {
    /// All of them, in the order of the list.
    pub fn all() -> impl Iterator<Item = Self> {
        std::iter::once(Self::Straight).chain(Cell::all().map(Self::Cell))
    }

    /// What a content is best held against: pictures with a dissolve, shapes
    /// with straight lines.
    #[must_use]
    pub fn plainest(content: Option<ContentKind>) -> Self {
        if content == Some(ContentKind::Colours) {
            Self::Cell(Cell::CROSS_DISSOLVE)
        } else {
            Self::Straight
        }
    }

    /// The cell of the table that it is.
    #[must_use]
    pub fn cell(self) -> Cell {
        match self {
            Self::Straight => Cell::RIGID_PARTS,
            Self::Cell(cell) => cell,
        }
    }

    /// What it is called, in a few words.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Straight => "straight lines",
            Self::Cell(cell) => cell.name(),
        }
    }
}
