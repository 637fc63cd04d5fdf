//! Preferences of the user that belong to no project: theme, display toggles, export settings,
//! comparison method.

use std::path::Path;

use bevy::prelude::Resource;

use crate::content::ContentKind;
use crate::export::{FilmKind, PictureLayout, has_ffmpeg};
use crate::settings::{Choice, named};
use crate::stage::StageVisibility;
use crate::transition::{PlayMode, Timing, TransitionMethod, TransitionStop};

/// Preferences of the user; not part of any project.
#[derive(Resource, Clone, Copy, Debug, PartialEq)]
pub struct Preferences {
    /// Colour theme of the panels.
    pub theme: ThemeChoice,
    /// Elements of the transition that the stage shows, such as the fill.
    pub show: StageVisibility,
    /// Whether onion skins are shown: thin outlines of the film at its stops or at regular t.
    pub onion: bool,
    /// Whether the panels are shown.
    pub panels: bool,
    /// Whether the list of keys is shown.
    pub help: bool,
    /// Whether the strip of frame times is shown.
    pub times: bool,
    /// Whether the graphs of the measured quantities over t are shown.
    pub plots: bool,
    /// Resolution of saved images.
    pub capture_scale: ImageScale,
    /// Whether saved images have a transparent background.
    pub capture_transparent: bool,
    /// File type of exported films; `None` chooses one that suits the content.
    pub record_format: Option<FilmFileFormat>,
    /// Layout, frame rate, range of t, ending and transparency of exported films.
    pub film: FilmExportOptions,
    /// Whether the export settings are shown.
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

/// Export settings of a film, except its file type.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FilmExportOptions {
    /// Aspect ratio, resolution, margin and captions.
    pub layout: PictureLayout,
    /// Frames per second.
    pub fps: u32,
    /// First and last t of the export; `None` uses that of the film on the stage.
    pub range: [Option<f64>; 2],
    /// Behaviour at the end of the exported film.
    pub ending: FilmEnding,
    /// Whether the background is transparent, if the file type supports it.
    pub is_transparent: bool,
}

impl Default for FilmExportOptions {
    /// Returns the default layout and 25 frames per second. GIF counts time in hundredths of a
    /// second, so it represents this rate exactly.
    fn default() -> Self {
        Self {
            layout: PictureLayout::default(),
            fps: 25,
            range: [None; 2],
            ending: FilmEnding::default(),
            is_transparent: false,
        }
    }
}

impl FilmExportOptions {
    /// Returns the first and last t of the export; `None` stands for the first or last t of the
    /// whole film. A stored t that is neither an end of the film nor a stop is dropped: another
    /// project may be open by now, or a stop may have been removed.
    #[must_use]
    pub fn valid_range(&self, whole_film: &Timing, stops: &[TransitionStop]) -> [Option<f64>; 2] {
        let exists = |t: &f64| {
            let ends = [whole_film.from, whole_film.to];
            ends.contains(t) || stops.iter().any(|stop| stop.t == *t)
        };
        self.range.map(|at| at.filter(exists))
    }

    /// Returns the timing of the exported film. If only a section of the film is exported, the
    /// section runs at the same speed as in the whole film.
    #[must_use]
    pub fn timing(&self, whole_film: &Timing, stops: &[TransitionStop]) -> Timing {
        let [from, to] = self.valid_range(whole_film, stops);
        let (from, to) = (from.unwrap_or(whole_film.from), to.unwrap_or(whole_film.to));
        let fraction = (to - from).abs() / (whole_film.to - whole_film.from).abs();
        Timing {
            from,
            to,
            duration_secs: whole_film.duration_secs * fraction,
            play: match self.ending {
                FilmEnding::AsPlayed => whole_film.play,
                FilmEnding::Once => PlayMode::Once,
                FilmEnding::Loop => PlayMode::PingPong,
            },
            ..*whole_film
        }
    }
}

/// Behaviour at the end of an exported film.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FilmEnding {
    /// The play mode of the film on the stage applies.
    #[default]
    AsPlayed,
    /// The film stops.
    Once,
    /// The film then plays backwards to its start, so that it loops without a jump.
    Loop,
}

named! { FilmEnding {
    AsPlayed: "as-played", "As on the stage", "Plays as on the stage (set next to Duration)";
    Once: "once", "Play once", "Plays from the first design to the last and stops";
    Loop: "seamless", "Loop", "Plays forwards and back, so that it loops without a jump";
} }

/// Colour theme of the panels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ThemeChoice {
    /// Dark panels with light text.
    #[default]
    Dark,
    /// Light panels with dark text.
    Light,
}

/// Resolution of a saved image of the stage.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ImageScale {
    /// As many pixels as the stage has on screen.
    #[default]
    One,
    /// Twice as many pixels along each side as the stage has on screen.
    Two,
    /// 3840 pixels along the longer side.
    FourK,
}

/// File type of an exported film.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FilmFileFormat {
    /// One animated file.
    Film(FilmKind),
    /// A folder of numbered PNG images.
    Pngs,
}

impl FilmFileFormat {
    /// Kind of the animated file; `None` for PNG images.
    #[must_use]
    pub fn kind(self) -> Option<FilmKind> {
        match self {
            Self::Film(kind) => Some(kind),
            Self::Pngs => None,
        }
    }

    /// Returns the film file type that has the extension of a path, if any.
    #[must_use]
    pub fn of_path(path: &Path) -> Option<Self> {
        let extension = path.extension()?.to_str()?.to_ascii_lowercase();
        let mut kinds = FilmKind::ALL.into_iter();
        let kind = kinds.find(|kind| kind.name().key == extension)?;
        Some(Self::Film(kind))
    }

    /// Extension of the file, without a dot; `None` for the folder of PNG images.
    #[must_use]
    pub fn extension(self) -> Option<&'static str> {
        Some(self.kind()?.name().key)
    }

    /// Whether films of this type can be transparent. Others always get the background colour.
    #[must_use]
    pub fn can_be_transparent(self) -> bool {
        self.kind().is_none_or(FilmKind::can_be_transparent)
    }

    /// Whether films of this type can be exported on this machine: videos need ffmpeg.
    #[must_use]
    pub fn is_available(self) -> bool {
        !self.kind().is_some_and(FilmKind::is_video) || has_ffmpeg()
    }
}

impl Preferences {
    /// Returns the file type that the user chose or, if there is none, the default for this
    /// content.
    #[must_use]
    pub fn format(&self, content: Option<ContentKind>) -> FilmFileFormat {
        self.record_format
            .unwrap_or_else(|| FilmFileFormat::default_for_content(content))
    }
}

impl FilmFileFormat {
    /// Default file type for films with this content: GIF, which plays everywhere, or, for
    /// pictures, MP4 or APNG, because GIF has few colours and becomes large.
    fn default_for_content(content: Option<ContentKind>) -> Self {
        Self::Film(match content {
            Some(ContentKind::Colours) if has_ffmpeg() => FilmKind::Mp4,
            Some(ContentKind::Colours) => FilmKind::Apng,
            _ => FilmKind::Gif,
        })
    }
}

/// Method shown by the comparison next to the stage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ComparisonMethod {
    /// Every vertex of the compatible mesh moves on a straight line.
    Straight,
    /// A method, given by its warp and content.
    Method(TransitionMethod),
}

impl ComparisonMethod {
    /// All methods to compare with, in the order in which the window lists them.
    pub fn all() -> impl Iterator<Item = Self> {
        std::iter::once(Self::Straight).chain(TransitionMethod::all().map(Self::Method))
    }

    /// Default method to compare with: cross-dissolve for pictures, straight lines for shapes.
    #[must_use]
    pub fn default_for(content: Option<ContentKind>) -> Self {
        if content == Some(ContentKind::Colours) {
            Self::Method(TransitionMethod::CROSS_DISSOLVE)
        } else {
            Self::Straight
        }
    }

    /// Returns the method (warp and content) with which the comparison is built.
    #[must_use]
    pub fn method(self) -> TransitionMethod {
        match self {
            Self::Straight => TransitionMethod::RIGID_PARTS,
            Self::Method(method) => method,
        }
    }

    /// Short name of the method.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Straight => "straight lines",
            Self::Method(method) => method.name(),
        }
    }
}
