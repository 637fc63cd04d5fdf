//! Determines the kind of export (one image, one film file, numbered frames) from an output path.

use crate::design::or_list;
use std::path::{Path, PathBuf};

use crate::settings::{Choice, choice_keys, named};

/// File name pattern of the frames in an output folder.
const IN_FOLDER: &str = "frame-####.png";

/// File format of a single image. Its key is the file extension.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StillKind {
    /// Pixel image.
    Png,
    /// Vector shapes.
    Svg,
    /// Outlines only, for plotters, laser cutters and CAD.
    Dxf,
}

named! { StillKind {
    Png: "png", "PNG", "Pixel image";
    Svg: "svg", "SVG", "Vector shapes";
    Dxf: "dxf", "DXF", "Outlines, for laser cutters and CAD";
} }

/// File format of a film. Its key is the file extension.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FilmKind {
    /// 256 colours; plays everywhere.
    Gif,
    /// Animated PNG: full colour and smooth transparency.
    Apng,
    /// H.264 video, encoded by ffmpeg.
    Mp4,
    /// VP9 video, encoded by ffmpeg.
    WebM,
    /// ProRes 4444 video, encoded by ffmpeg.
    Mov,
    /// Animated SVG.
    Svg,
    /// HTML page with a player.
    Html,
    /// A Lottie animation.
    Lottie,
}

named! { FilmKind {
    Gif: "gif", "GIF", "Plays everywhere, 256 colours";
    Apng: "apng", "APNG", "Full colour, plays in browsers";
    Mp4: "mp4", "MP4", "Video that plays everywhere, without transparency; needs ffmpeg on this machine";
    WebM: "webm", "WebM", "Video for web pages, also transparent (VP9); needs ffmpeg on this machine";
    Mov: "mov", "MOV", "Video for editing, also transparent (ProRes 4444); needs ffmpeg on this machine";
    Svg: "svg", "SVG", "Animated vector outlines, plays in browsers";
    Html: "html", "HTML page", "Vector outlines with a player, in one file";
    Lottie: "json", "Lottie", "Vector outlines with keyframes, for apps, websites and motion design";
} }

impl FilmKind {
    /// Returns whether the file is a video, which ffmpeg encodes. Its sides must be even numbers of
    /// pixels.
    #[must_use]
    pub fn is_video(self) -> bool {
        matches!(self, Self::Mp4 | Self::WebM | Self::Mov)
    }

    /// Returns whether the file contains outlines instead of pixels.
    #[must_use]
    pub fn is_vector(self) -> bool {
        matches!(self, Self::Svg | Self::Html | Self::Lottie)
    }

    /// Returns whether the file can be transparent.
    #[must_use]
    pub fn can_be_transparent(self) -> bool {
        self != Self::Mp4
    }
}

/// Returns the file extensions of all kinds as part of a sentence, such as `.png or .svg`.
#[must_use]
pub fn extension_list<K: Choice>() -> String {
    or_list(choice_keys::<K>().map(|key| format!(".{key}")))
}

/// File names of numbered frames: `folder/prefix0007suffix`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NumberedFiles {
    /// Folder of the files.
    pub folder: PathBuf,
    /// Part of the name before the number.
    pub prefix: String,
    /// Minimum number of digits; shorter numbers are padded with zeros.
    pub digits: usize,
    /// Part of the name after the number, including the extension.
    pub suffix: String,
    /// File format.
    pub kind: StillKind,
}

impl NumberedFiles {
    /// Returns the path of the frame with the given number.
    pub fn path(&self, number: usize) -> PathBuf {
        let (prefix, digits, suffix) = (&self.prefix, self.digits, &self.suffix);
        self.folder
            .join(format!("{prefix}{number:0digits$}{suffix}"))
    }
}

/// Kind of output, and where to write it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ExportTarget {
    /// One image.
    Still(StillKind, PathBuf),
    /// One film file.
    Film(FilmKind, PathBuf),
    /// One image per frame.
    Numbered(NumberedFiles),
}

/// Error for a path whose file type is not supported.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ExportTargetError {
    /// The extension is unknown.
    #[error(
        "unknown output type `{}`: end it in {} for an image, in {} for a film, in name-####.png for numbered images, or in / for a folder of them",
        .0.display(), extension_list::<StillKind>(), extension_list::<FilmKind>()
    )]
    Unknown(PathBuf),
    /// The name has a number pattern (`####`), but its extension is not that of an image.
    #[error(
        "`{}` has a frame number (#), which needs an image type: end it in {}, or remove the #",
        .0.display(), extension_list::<StillKind>()
    )]
    NotNumbered(PathBuf),
}

impl ExportTarget {
    /// Determines the kind of output from the path:
    ///
    /// - the extension of a [`StillKind`] or of a [`FilmKind`]: one image or one film file
    /// - a file name with `#`, such as `name-####.png`: numbered images
    /// - a folder (one that exists, a path that ends in `/`, or a name without extension): numbered
    ///   PNGs in this folder
    ///
    /// # Errors
    /// [`ExportTargetError`] if the name does not determine a supported kind.
    pub fn of_path(path: &Path) -> Result<Self, ExportTargetError> {
        if is_folder(path) {
            let names = by_pattern(path, IN_FOLDER, StillKind::Png);
            return Ok(Self::Numbered(names));
        }
        let extension = path.extension().unwrap_or_default();
        let extension = extension.to_string_lossy().to_lowercase();
        let still = StillKind::of_key(&extension).ok();
        let name = path.file_name().and_then(|name| name.to_str());
        if let Some(name) = name.filter(|name| name.contains('#')) {
            let kind = still.ok_or_else(|| ExportTargetError::NotNumbered(path.to_owned()))?;
            let folder = path.parent().unwrap_or(Path::new(""));
            return Ok(Self::Numbered(by_pattern(folder, name, kind)));
        }
        // Names with `#` were handled above, so a film never has a number in its name.
        let film = FilmKind::of_key(&extension).ok();
        let still = still.map(|kind| Self::Still(kind, path.to_owned()));
        let film = film.map(|kind| Self::Film(kind, path.to_owned()));
        let unknown = || ExportTargetError::Unknown(path.to_owned());
        still.or(film).ok_or_else(unknown)
    }
}

impl ExportTarget {
    /// Replaces the target of a single SVG image by an animated SVG, because the extension `.svg`
    /// stands for both. Other targets stay as they are.
    #[must_use]
    pub fn preferring_film(self) -> Self {
        match self {
            Self::Still(StillKind::Svg, path) => Self::Film(FilmKind::Svg, path),
            other => other,
        }
    }
}

/// Returns whether a path denotes a folder: it exists as one, ends in a separator, or has no
/// extension.
fn is_folder(path: &Path) -> bool {
    let text = path.to_string_lossy();
    let name = path.file_name().map(|name| name.to_string_lossy());
    // `name-####` without an extension is more likely a mistake than a folder.
    let is_bare = path.extension().is_none() && !name.is_some_and(|name| name.contains('#'));
    is_bare || text.ends_with(['/', std::path::MAIN_SEPARATOR]) || path.is_dir()
}

/// Splits a file name at its last run of `#`, which stands for the number.
fn by_pattern(folder: &Path, name: &str, kind: StillKind) -> NumberedFiles {
    // Callers pass only names with a `#`, so the default 0 is never used.
    let end = name.rfind('#').map_or(0, |last| last + 1);
    let before = &name[..end];
    let prefix = before.trim_end_matches('#');
    NumberedFiles {
        folder: folder.to_owned(),
        prefix: prefix.to_owned(),
        digits: before.len() - prefix.len(),
        suffix: name[end..].to_owned(),
        kind,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn target(path: &str) -> Result<ExportTarget, ExportTargetError> {
        ExportTarget::of_path(Path::new(path))
    }

    #[test]
    fn the_extension_determines_the_kind() {
        let still = |kind, path: &str| Ok(ExportTarget::Still(kind, path.into()));
        let film = |kind, path: &str| Ok(ExportTarget::Film(kind, path.into()));
        assert_eq!(target("a/b.PNG"), still(StillKind::Png, "a/b.PNG"));
        assert_eq!(target("b.svg"), still(StillKind::Svg, "b.svg"));
        assert_eq!(target("b.gif"), film(FilmKind::Gif, "b.gif"));
        assert_eq!(target("b.apng"), film(FilmKind::Apng, "b.apng"));
        assert_eq!(target("b.mp4"), film(FilmKind::Mp4, "b.mp4"));
        assert_eq!(target("b.webm"), film(FilmKind::WebM, "b.webm"));
        assert_eq!(target("b.MOV"), film(FilmKind::Mov, "b.MOV"));
        assert_eq!(target("b.html"), film(FilmKind::Html, "b.html"));
        assert_eq!(target("b.json"), film(FilmKind::Lottie, "b.json"));
        let moving = target("b.svg").map(ExportTarget::preferring_film);
        assert_eq!(moving, film(FilmKind::Svg, "b.svg"));
        assert!(matches!(
            target("b.jpg"),
            Err(ExportTargetError::Unknown(_))
        ));
        assert!(matches!(
            target("b-##.gif"),
            Err(ExportTargetError::NotNumbered(_))
        ));
    }

    #[test]
    fn patterns_and_folders_give_numbered_files() {
        let paths = |text: &str| match target(text) {
            Ok(ExportTarget::Numbered(numbered)) => [7, 12345].map(|n| numbered.path(n)),
            other => panic!("{text}: {other:?}"),
        };
        assert_eq!(
            paths("o/x-###.png"),
            ["o/x-007.png", "o/x-12345.png"].map(PathBuf::from)
        );
        assert_eq!(paths("#.svg"), ["7.svg", "12345.svg"].map(PathBuf::from));
        assert_eq!(
            paths("a#b##c.png"),
            ["a#b07c.png", "a#b12345c.png"].map(PathBuf::from)
        );
        let in_folder = ["d/frame-0007.png", "d/frame-12345.png"].map(PathBuf::from);
        assert_eq!(paths("d"), in_folder);
        assert_eq!(paths("d/"), in_folder);
        assert_eq!(paths("v.2/")[0], PathBuf::from("v.2/frame-0007.png"));
    }
}
