//! What there is to choose from at the screen.

use bevy::prelude::Resource;

use crate::content::ContentKind;
use crate::export::{FilmKind, PictureLayout, has_ffmpeg};
use crate::settings::choice::named;
use crate::stage::StageVisibility;
use crate::transition::{PlayMode, Timing, TransitionMethod, TransitionStop};

/// What the person at the screen chose; not part of any project.
#[derive(Resource, Clone, Copy, Debug, PartialEq)]
pub struct Preferences {
    /// The colours of the panels.
    pub theme: ThemeChoice,
    /// What the stage draws.
    pub show: StageVisibility,
    /// Onion skins are shown: thin outlines of the film at other t.
    pub onion: bool,
    /// Panels are shown.
    pub panels: bool,
    /// The list of keys is shown.
    pub help: bool,
    /// The times of a frame are shown.
    pub times: bool,
    /// The measures against t are shown.
    pub plots: bool,
    /// Size of screenshots.
    pub capture_scale: ImageScale,
    /// Screenshots have a transparent ground.
    pub capture_transparent: bool,
    /// Kind of file of a recording; none takes what suits what is seen.
    pub record_format: Option<FilmFileFormat>,
    /// How films lie in their pictures.
    pub film: FilmExportOptions,
    /// The options of pictures and films are shown.
    pub film_options: bool,
}

impl Default for Preferences {
    fn default() -> Self {
        Self {
            theme: ThemeChoice::default(),
            show: StageVisibility::default(),
            onion: false,
            panels: true,
            help: false,
            times: false,
            plots: false,
            capture_scale: ImageScale::default(),
            capture_transparent: false,
            record_format: None,
            film: FilmExportOptions::default(),
            film_options: false,
        }
    }
}

/// How films look, besides what they show.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FilmExportOptions {
    /// Their shape and size.
    pub layout: PictureLayout,
    /// Frames a second.
    pub fps: u32,
    /// The t that it begins at and that it ends at, where that is not those of the pass.
    pub span: [Option<f64>; 2],
    /// How it goes on at its end.
    pub ending: FilmEnding,
    /// Nothing lies behind it, where the file can have that.
    pub is_transparent: bool,
}

impl Default for FilmExportOptions {
    /// For slides, at a rate that GIF's clock of hundredths keeps exactly.
    fn default() -> Self {
        Self {
            layout: PictureLayout::default(),
            fps: 25,
            span: [None; 2],
            ending: FilmEnding::default(),
            is_transparent: false,
        }
    }
}

impl FilmExportOptions {
    /// The t that it begins at and that it ends at, as far as these are places of the project:
    /// another one may be open by now, or a stop may be gone.
    #[must_use]
    pub fn places(&self, pass: &Timing, stops: &[TransitionStop]) -> [Option<f64>; 2] {
        let is_there = |t: &f64| {
            let ends = [pass.from, pass.to];
            ends.contains(t) || stops.iter().any(|stop| stop.t == *t)
        };
        self.span.map(|at| at.filter(is_there))
    }

    /// The timing of the film: a part of the pass runs as fast as the pass does.
    #[must_use]
    pub fn timing(&self, pass: &Timing, stops: &[TransitionStop]) -> Timing {
        let [from, to] = self.places(pass, stops);
        let (from, to) = (from.unwrap_or(pass.from), to.unwrap_or(pass.to));
        let share = (to - from).abs() / (pass.to - pass.from).abs();
        Timing {
            from,
            to,
            duration_secs: pass.duration_secs * share,
            play: match self.ending {
                FilmEnding::AsPlayed => pass.play,
                FilmEnding::Once => PlayMode::Once,
                FilmEnding::Seamless => PlayMode::PingPong,
            },
            ..*pass
        }
    }
}

/// How a film goes on at its end.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FilmEnding {
    /// As the pass on the stage.
    #[default]
    AsPlayed,
    /// It ends.
    Once,
    /// It comes back, and begins again where it began.
    Seamless,
}

named! { FilmEnding {
    AsPlayed: "as-played", "As played", "As the stage plays: set below, beside Lasts";
    Once: "once", "One way", "From the first form to the last, and no further";
    Seamless: "seamless", "Loop", "There and back, so that it can go round without a jump";
} }

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
pub enum ImageScale {
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
pub enum FilmFileFormat {
    /// One file that moves.
    Film(FilmKind),
    /// A folder of numbered PNGs.
    Pngs,
}

impl FilmFileFormat {
    /// That which has no transparency: its films get the ground colour whatever was chosen.
    pub const OPAQUE: Self = Self::Film(FilmKind::Mp4);
}

impl Preferences {
    /// The kind of file that a recording of this content writes.
    #[must_use]
    pub fn format(&self, content: Option<ContentKind>) -> FilmFileFormat {
        self.record_format
            .unwrap_or_else(|| FilmFileFormat::suited(content))
    }
}

impl FilmFileFormat {
    /// What plays everywhere; of photographs that would be large, and lack colours.
    fn suited(content: Option<ContentKind>) -> Self {
        Self::Film(match content {
            Some(ContentKind::Colours) if has_ffmpeg() => FilmKind::Mp4,
            Some(ContentKind::Colours) => FilmKind::Apng,
            _ => FilmKind::Gif,
        })
    }
}

/// A method that the twin view can show.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ComparisonMethod {
    /// Each vertex of the common triangulation goes straight to its place.
    Straight,
    /// A cell of the table.
    Cell(TransitionMethod),
}

impl ComparisonMethod {
    /// All of them, in the order of the list.
    pub fn all() -> impl Iterator<Item = Self> {
        std::iter::once(Self::Straight).chain(TransitionMethod::all().map(Self::Cell))
    }

    /// What a content is best held against: pictures with a dissolve, shapes
    /// with straight lines.
    #[must_use]
    pub fn plainest(content: Option<ContentKind>) -> Self {
        if content == Some(ContentKind::Colours) {
            Self::Cell(TransitionMethod::CROSS_DISSOLVE)
        } else {
            Self::Straight
        }
    }

    /// The cell of the table that it is.
    #[must_use]
    pub fn cell(self) -> TransitionMethod {
        match self {
            Self::Straight => TransitionMethod::RIGID_PARTS,
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
