//! Plays exported vector animations in Chromium and takes screenshots of single frames.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use image::{RgbaImage, imageops};
use morphospace::export::PixelSize;

/// Maximum width of a screenshot of frames in a row, in pixels (resource limit: Chromium leaves
/// parts of much wider pages blank).
const MAX_ROW_PX: u32 = 9600;

/// Maximum time that Chromium may take for one screenshot (resource limit: the largest take half a
/// minute).
const TIME_LIMIT: Duration = Duration::from_secs(180);

/// Formats in which vector animations are exported.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VectorFormat {
    Svg,
    Page,
    Lottie,
}

impl VectorFormat {
    pub const ALL: [Self; 3] = [Self::Svg, Self::Page, Self::Lottie];

    pub fn name(self) -> &'static str {
        match self {
            Self::Svg => "animated SVG",
            Self::Page => "page",
            Self::Lottie => "Lottie",
        }
    }

    /// File extension of the format, without a dot.
    pub fn ending(self) -> &'static str {
        match self {
            Self::Svg => "svg",
            Self::Page => "html",
            Self::Lottie => "json",
        }
    }
}

/// Number of frames of a given size that fit side by side into one screenshot.
pub fn frames_per_sheet(size: PixelSize) -> usize {
    (MAX_ROW_PX / size.width()).max(1) as usize
}

/// An exported animation: the text of its file, with its format, frame rate and frame size.
pub struct AnimationFile<'t> {
    pub kind: VectorFormat,
    pub text: &'t str,
    pub fps: f64,
    pub size: PixelSize,
}

/// Programs on this machine that play animations.
pub struct AnimationPlayers {
    chromium: Option<PathBuf>,
    /// JavaScript text of lottie-web; `None` if `MORPHOSPACE_LOTTIE` is not set.
    lottie: Option<String>,
}

impl AnimationPlayers {
    pub fn find() -> Self {
        let on_path = || {
            let names = ["chromium", "chromium-browser", "google-chrome"];
            let path = std::env::var_os("PATH").unwrap_or_default();
            let folders: Vec<PathBuf> = std::env::split_paths(&path).collect();
            let candidates = names
                .iter()
                .flat_map(|name| folders.iter().map(move |f| f.join(name)));
            let mut programs = candidates.filter(|path| path.is_file());
            programs.next()
        };
        let path_from_env = |name: &str| std::env::var_os(name).map(PathBuf::from);
        let lottie = path_from_env("MORPHOSPACE_LOTTIE");
        Self {
            chromium: path_from_env("MORPHOSPACE_CHROMIUM").or_else(on_path),
            lottie: lottie.map(|path| std::fs::read_to_string(path).expect("lottie-web's script")),
        }
    }

    /// Reason why [`Self::play`] returned no screenshots for a format.
    pub fn missing(&self, kind: VectorFormat) -> &'static str {
        match (&self.chromium, kind) {
            (None, _) => "no Chromium on the path, nor in MORPHOSPACE_CHROMIUM",
            (_, VectorFormat::Lottie) if self.lottie.is_none() => {
                "no script of lottie-web in MORPHOSPACE_LOTTIE"
            }
            _ => "Chromium took no picture",
        }
    }

    /// Takes screenshots of the given frames (pairs of frame number and t) on a transparent
    /// background; `folder` receives temporary files. `None` if the player is missing or fails.
    pub fn play(
        &self,
        film: &AnimationFile,
        frames: &[(f64, f64)],
        folder: &Path,
    ) -> Option<Vec<RgbaImage>> {
        let AnimationFile {
            kind,
            text,
            fps,
            size,
        } = *film;
        let chromium = self.chromium.as_ref()?;
        let body = match kind {
            VectorFormat::Svg => svg_frames(text, frames, fps),
            VectorFormat::Page => {
                std::fs::write(folder.join("film.html"), text).expect("written");
                page_frames(frames)
            }
            VectorFormat::Lottie => lottie_frames(text, frames, self.lottie.as_ref()?),
        };
        let (width, height) = (size.width(), size.height());
        let page = format!(
            "<!doctype html><meta charset=utf-8><style>
             html, body {{ margin: 0; background: transparent }}
             body {{ width: {}px; line-height: 0 }}
             body > * {{ display: inline-block; width: {width}px; height: {height}px; border: 0; overflow: hidden }}
             script {{ display: none !important }}
             </style><body>{body}",
            frames.len() as u32 * width
        );
        std::fs::write(folder.join("sheet.html"), page).expect("written");
        // The window is higher than the frames, because it also has borders.
        let window = [frames.len() as u32 * width, height + 200];
        let row = screenshot(chromium, folder, window)?;
        let left_edges = (0..frames.len() as u32).map(|k| k * width);
        let pictures = left_edges.map(|x| imageops::crop_imm(&row, x, 0, width, height).to_image());
        Some(pictures.collect())
    }
}

/// Takes a screenshot of the page `sheet.html` in `folder` with Chromium.
fn screenshot(chromium: &Path, folder: &Path, [width, height]: [u32; 2]) -> Option<RgbaImage> {
    let [sheet, picture] = ["sheet.html", "sheet.png"].map(|name| folder.join(name));
    let mut player = Command::new(chromium)
        .args([
            "--headless",
            "--no-sandbox",
            "--disable-gpu",
            "--hide-scrollbars",
        ])
        .args([
            "--force-device-scale-factor=1",
            "--force-color-profile=srgb",
        ])
        .args([
            "--default-background-color=00000000",
            "--virtual-time-budget=20000",
        ])
        .arg("--allow-file-access-from-files")
        .arg(format!(
            "--user-data-dir={}",
            folder.join("profile").display()
        ))
        .arg(format!("--window-size={width},{height}"))
        .arg(format!("--screenshot={}", picture.display()))
        .arg(format!("file://{}", sheet.display()))
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .ok()?;
    // Chromium does not end by itself if the page crashes.
    let start = Instant::now();
    let status = loop {
        match player.try_wait().ok()? {
            Some(status) => break status,
            None if start.elapsed() > TIME_LIMIT => {
                player.kill().ok()?;
                break player.wait().ok()?;
            }
            None => std::thread::sleep(Duration::from_millis(50)),
        }
    };
    if !status.success() {
        return None;
    }
    Some(image::open(picture).ok()?.to_rgba8())
}

/// JavaScript string literal of a text, escaped so that the text cannot end the script element.
fn script_string(text: &str) -> String {
    let json = serde_json::to_string(text).expect("text");
    json.replace('<', "\\u003c")
}

/// HTML of a row of copies of the animated SVG; each copy is paused at one of the frames.
fn svg_frames(text: &str, frames: &[(f64, f64)], fps: f64) -> String {
    let secs: Vec<f64> = frames.iter().map(|frame| frame.0 / fps).collect();
    format!(
        "<script>const text = {};
         for (const secs of {secs:?}) {{
           const frame = document.body.appendChild(document.createElement('iframe'));
           frame.onload = () => {{
             const svg = frame.contentDocument.querySelector('svg');
             svg.pauseAnimations();
             svg.setCurrentTime(secs);
           }};
           frame.srcdoc = '<!doctype html><style>body {{ margin: 0; line-height: 0 }}</style>' + text;
         }}</script>",
        script_string(text)
    )
}

/// HTML of a row of copies of the exported page `film.html`, one for each frame of `frames`; each
/// copy shows its film at the t of its frame.
fn page_frames(frames: &[(f64, f64)]) -> String {
    let frame = |(_, t): &(f64, f64)| format!("<iframe src=\"film.html#t={t}&bare\"></iframe>");
    frames.iter().map(frame).collect()
}

/// HTML of a row with a still image of the Lottie animation for each frame.
fn lottie_frames(text: &str, frames: &[(f64, f64)], script: &str) -> String {
    let numbers: Vec<f64> = frames.iter().map(|frame| frame.0).collect();
    let script = script.replace("</script", "<\\/script");
    format!(
        "<script>{script}</script><script>const text = {};
         // One player, and a still of each frame: Chromium has not enough memory for a player per
         // frame of a large film.
         const container = document.createElement('div');
         const film = lottie.loadAnimation({{
           container, renderer: 'svg', loop: false, autoplay: false, animationData: JSON.parse(text),
         }});
         for (const frame of {numbers:?}) {{
           film.goToAndStop(frame, true);
           const still = document.body.appendChild(document.createElement('iframe'));
           still.srcdoc = '<!doctype html><style>html, body {{ margin: 0; height: 100% }}</style>'
             + container.innerHTML;
         }}</script>",
        script_string(text)
    )
}
