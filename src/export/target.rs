//! What a path asks for: its name tells the kind of picture or film.

use crate::design::or_list;
use std::path::{Path, PathBuf};

use crate::settings::choice::{Choice, keys, named};

/// What the pictures in a folder are called.
const IN_FOLDER: &str = "frame-####.png";

/// A format for one picture; its key is the ending of a name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StillKind {
    /// Pixels.
    Png,
    /// Shapes.
    Svg,
    /// Outlines, for cutters and CAD.
    Dxf,
}

named! { StillKind {
    Png: "png", "PNG", "Pixels";
    Svg: "svg", "SVG", "Shapes";
    Dxf: "dxf", "DXF", "Outlines, for cutters and CAD";
} }

/// A format for one file that moves; its key is the ending of a name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FilmKind {
    /// 256 colours, plays everywhere.
    Gif,
    /// Animated PNG: all colours and soft transparency.
    Apng,
    /// H.264 through ffmpeg.
    Mp4,
    /// SVG that moves by itself.
    Svg,
    /// A page that plays it.
    Html,
    /// A Lottie animation.
    Lottie,
}

named! { FilmKind {
    Gif: "gif", "GIF", "Plays everywhere, 256 colours";
    Apng: "apng", "APNG", "Full colour, plays in browsers";
    Mp4: "mp4", "MP4", "Needs ffmpeg on this machine";
    Svg: "svg", "SVG", "Outlines that move by themselves, in browsers";
    Html: "html", "Page", "Outlines with a player to scrub and step, in one file";
    Lottie: "json", "Lottie", "Outlines with keys, for apps, sites and motion design";
} }

/// The endings of all kinds in a row, for a sentence: `.png or .svg`.
#[must_use]
pub fn extension_list<K: Choice>() -> String {
    or_list(keys::<K>().map(|key| format!(".{key}")))
}

/// Numbered pictures: `folder/prefix0007suffix`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NumberedFiles {
    /// Where they lie.
    pub folder: PathBuf,
    /// What stands before the number.
    pub prefix: String,
    /// The least number of digits.
    pub digits: usize,
    /// What stands after the number, extension included.
    pub suffix: String,
    /// Their format.
    pub kind: StillKind,
}

impl NumberedFiles {
    /// The path of one frame.
    pub fn path(&self, number: usize) -> PathBuf {
        let (prefix, digits, suffix) = (&self.prefix, self.digits, &self.suffix);
        self.folder
            .join(format!("{prefix}{number:0digits$}{suffix}"))
    }
}

/// What is written, and where.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ExportTarget {
    /// One picture.
    Still(StillKind, PathBuf),
    /// One file that moves.
    Film(FilmKind, PathBuf),
    /// A picture a frame.
    Numbered(NumberedFiles),
}

/// A path that names no kind.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ExportTargetError {
    /// An extension that is none of ours.
    #[error(
        "`{}` names no kind of picture: end it in {} for one, in {} for a film, in name-####.png for numbered pictures, or in / for a folder of them",
        .0.display(), extension_list::<StillKind>(), extension_list::<FilmKind>()
    )]
    Unknown(PathBuf),
    /// `####` in a name that is no still picture.
    #[error(
        "`{}` numbers its frames: end it in {}, or leave the # out",
        .0.display(), extension_list::<StillKind>()
    )]
    NotNumbered(PathBuf),
}

impl ExportTarget {
    /// Reads the kind from the name: the extension of a [`StillKind`] or of a
    /// [`FilmKind`]; `name-####.png` (or `.svg`) for numbered pictures; a
    /// folder (one that exists, a name that ends in `/`, or one without
    /// extension) for numbered PNGs in it.
    ///
    /// # Errors
    /// [`ExportTargetError`] where the name tells nothing.
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
        // A film's ending in a pattern was refused above: a film is one file.
        let film = FilmKind::of_key(&extension).ok();
        let still = still.map(|kind| Self::Still(kind, path.to_owned()));
        let film = film.map(|kind| Self::Film(kind, path.to_owned()));
        let unknown = || ExportTargetError::Unknown(path.to_owned());
        still.or(film).ok_or_else(unknown)
    }
}

impl ExportTarget {
    /// The same for who wants a film: a name whose ending stands for a picture and for a
    /// film means the film.
    #[must_use]
    pub fn moving(self) -> Self {
        match self {
            Self::Still(StillKind::Svg, path) => Self::Film(FilmKind::Svg, path),
            other => other,
        }
    }
}

fn is_folder(path: &Path) -> bool {
    let text = path.to_string_lossy();
    let name = path.file_name().map(|name| name.to_string_lossy());
    // `name-####` without an ending is more likely a slip than a folder.
    let is_bare = path.extension().is_none() && !name.is_some_and(|name| name.contains('#'));
    is_bare || text.ends_with(['/', std::path::MAIN_SEPARATOR]) || path.is_dir()
}

/// The last run of `#` in the name is the number.
fn by_pattern(folder: &Path, name: &str, kind: StillKind) -> NumberedFiles {
    // There is one in the name: that is what made it a pattern.
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
    fn extensions_tell_the_kind() {
        let still = |kind, path: &str| Ok(ExportTarget::Still(kind, path.into()));
        let film = |kind, path: &str| Ok(ExportTarget::Film(kind, path.into()));
        assert_eq!(target("a/b.PNG"), still(StillKind::Png, "a/b.PNG"));
        assert_eq!(target("b.svg"), still(StillKind::Svg, "b.svg"));
        assert_eq!(target("b.gif"), film(FilmKind::Gif, "b.gif"));
        assert_eq!(target("b.apng"), film(FilmKind::Apng, "b.apng"));
        assert_eq!(target("b.mp4"), film(FilmKind::Mp4, "b.mp4"));
        assert_eq!(target("b.html"), film(FilmKind::Html, "b.html"));
        assert_eq!(target("b.json"), film(FilmKind::Lottie, "b.json"));
        let moving = target("b.svg").map(ExportTarget::moving);
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
    fn patterns_and_folders_number_their_files() {
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
