//! Draws frames of Lottie files with players other than browsers, through `scripts/play_lottie.py`.

use std::path::Path;
use std::process::{Command, Stdio};

use image::RgbaImage;

use crate::browser::AnimationFile;

/// Exit status of the script if the player is not installed.
const NOT_INSTALLED: i32 = 3;

/// Lottie player that is not a browser. All are written in C++ and parse the file in one pass, so
/// they depend on the order of its keys.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LottiePlayer {
    /// The player of Samsung, Telegram and others.
    Rlottie,
    /// The player of dotLottie, Godot and others.
    Thorvg,
}

impl LottiePlayer {
    pub const ALL: [Self; 2] = [Self::Rlottie, Self::Thorvg];

    /// Name of the player, as `scripts/play_lottie.py` expects it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Rlottie => "rlottie",
            Self::Thorvg => "thorvg",
        }
    }

    /// Name of the Python package that contains the player.
    pub fn package(self) -> &'static str {
        match self {
            Self::Rlottie => "rlottie-python",
            Self::Thorvg => "thorvg-python",
        }
    }

    /// Draws the given frames (pairs of frame number and t) on a transparent background; `folder`
    /// receives temporary files. `None` if the player is not installed.
    ///
    /// # Panics
    /// If the player is installed and fails.
    pub fn play(
        self,
        film: &AnimationFile,
        frames: &[(f64, f64)],
        folder: &Path,
    ) -> Option<Vec<RgbaImage>> {
        let python = std::env::var_os("MORPHOSPACE_PYTHON").unwrap_or_else(|| "python3".into());
        let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("scripts/play_lottie.py");
        let file = folder.join("film.json");
        std::fs::write(&file, film.text).expect("written");
        let output = Command::new(python)
            .arg(script)
            .arg(self.name())
            .arg(&file)
            .args([film.size.width(), film.size.height()].map(|side| side.to_string()))
            .arg(folder)
            .args(frames.iter().map(|frame| frame.0.to_string()))
            .stdin(Stdio::null())
            .output()
            .ok()?;
        if output.status.code() == Some(NOT_INSTALLED) {
            return None;
        }
        let message = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{}: {message}", self.name());
        let picture = |k: usize| {
            let picture = image::open(folder.join(format!("{k}.png")));
            picture.expect("a picture").to_rgba8()
        };
        Some((0..frames.len()).map(picture).collect())
    }
}
