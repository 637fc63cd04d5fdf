//! Named export settings for films, stored in a TOML file of the user.

use std::collections::BTreeMap;
use std::io;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::layout::{Aspect, PictureLayout};
use super::target::FilmKind;
use crate::io::atomic_file;
use crate::io::path_text;
use crate::io::read::{self, ReadError};

/// Export settings for films: everything except duration and easing.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct FilmPreset {
    /// Aspect ratio of the images.
    pub aspect: Aspect,
    /// Length of the shorter side of the images, in pixels.
    pub lines: u32,
    /// Free margin on all sides, as a fraction of the shorter side.
    #[serde(default)]
    pub margin: f64,
    /// Whether captions are shown at the bottom.
    #[serde(default)]
    pub captions: bool,
    /// Frames per second.
    pub fps: u32,
    /// File type; `None` stands for numbered PNGs.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub file: Option<FilmKind>,
    /// Folder that the window offers first for the exported film; `None` leaves it as it is. The
    /// command line names the output file itself.
    #[serde(
        default,
        skip_serializing_if = "Option::is_none",
        with = "path_text::option"
    )]
    pub folder: Option<PathBuf>,
}

impl FilmPreset {
    /// Returns the image layout of these settings.
    #[must_use]
    pub fn layout(&self) -> PictureLayout {
        PictureLayout {
            aspect: self.aspect,
            lines: self.lines,
            margin: self.margin,
            has_captions: self.captions,
        }
    }
}

/// Presets by name.
///
/// ```
/// use morphospace::export::FilmPresets;
/// let text = "[talk]\naspect = \"4:3\"\nlines = 720\nfps = 25\n";
/// let presets = FilmPresets::parse(text)?;
/// assert_eq!(presets.0["talk"].layout().lines, 720);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct FilmPresets(pub BTreeMap<String, FilmPreset>);

impl FilmPresets {
    /// Returns the path of the file in which the window stores presets; `None` if the system has no
    /// configuration directory.
    #[cfg(feature = "cli")]
    #[must_use]
    pub fn default_path() -> Option<std::path::PathBuf> {
        Some(dirs::config_dir()?.join("morphospace").join("films.toml"))
    }

    /// Parses TOML text.
    ///
    /// # Errors
    /// If the text is not valid TOML of this form. The message names the line.
    pub fn parse(text: &str) -> Result<Self, toml::de::Error> {
        toml::from_str(text)
    }

    /// Reads a file. A missing file gives no presets.
    ///
    /// # Errors
    /// If the file cannot be read or parsed.
    pub fn read(path: &Path) -> io::Result<Self> {
        match read::read(path) {
            Ok(bytes) => {
                let text = String::from_utf8(bytes).map_err(io::Error::other)?;
                Self::parse(&text).map_err(io::Error::other)
            }
            Err(ReadError::Missing) => Ok(Self::default()),
            Err(error) => Err(io::Error::other(error)),
        }
    }

    /// Writes a file atomically; missing folders are created.
    ///
    /// # Errors
    /// If the folder cannot be created or the file cannot be written.
    pub fn write(&self, path: &Path) -> io::Result<()> {
        if let Some(folder) = path.parent() {
            std::fs::create_dir_all(folder)?;
        }
        let text = toml::to_string(self).map_err(io::Error::other)?;
        atomic_file::write(path, text.as_bytes())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn written_presets_are_read_back() -> io::Result<()> {
        let folder = tempfile::tempdir()?;
        let path = folder.path().join("new").join("films.toml");
        assert_eq!(FilmPresets::read(&path)?, FilmPresets::default());
        let preset = FilmPreset {
            aspect: Aspect::Tall,
            lines: 1080,
            margin: 0.05,
            captions: true,
            fps: 30,
            file: Some(FilmKind::Mp4),
            folder: Some("/films".into()),
        };
        let pngs = FilmPreset {
            file: None,
            folder: None,
            ..preset.clone()
        };
        let all = [("story, ours", preset), ("frames", pngs)];
        let presets = FilmPresets(all.map(|(name, preset)| (name.to_owned(), preset)).into());
        presets.write(&path)?;
        assert_eq!(FilmPresets::read(&path)?, presets);
        std::fs::write(&path, "[talk]\naspect = \"round\"\n")?;
        let error = FilmPresets::read(&path)
            .err()
            .map(|error| error.to_string());
        assert!(error.is_some_and(|error| error.contains("16:9")));
        Ok(())
    }

    #[cfg(unix)]
    #[test]
    fn a_pipe_is_refused_and_any_folder_is_stored() -> io::Result<()> {
        use std::os::unix::ffi::OsStrExt;
        let folder = tempfile::tempdir()?;
        let pipe = folder.path().join("pipe.toml");
        std::process::Command::new("mkfifo").arg(&pipe).status()?;
        // Opening the pipe would block for ever.
        assert!(FilmPresets::read(&pipe).is_err());
        let text = "[talk]\naspect = \"4:3\"\nlines = 720\nfps = 25\n";
        let mut presets = FilmPresets::parse(text).map_err(io::Error::other)?;
        let talk = presets.0.get_mut("talk").ok_or(io::ErrorKind::NotFound)?;
        talk.folder = Some(Path::new(std::ffi::OsStr::from_bytes(b"/films/\xe9")).to_owned());
        let path = folder.path().join("films.toml");
        presets.write(&path)?;
        assert_eq!(FilmPresets::read(&path)?, presets);
        Ok(())
    }
}
