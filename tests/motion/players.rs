//! Other programs that play what was written, and pictures of what they show.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use image::{RgbaImage, imageops};
use morphospace::export::PixelSize;

/// Of what Chromium photographs at once: of a page of sixty million pixels it leaves
/// some blank.
const ROW_PX: u32 = 9600;

/// How long a player may take for a sheet: the largest of the gallery take half a minute.
const PATIENCE: Duration = Duration::from_secs(180);

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    Svg,
    Page,
    Lottie,
}

impl Kind {
    pub const ALL: [Self; 3] = [Self::Svg, Self::Page, Self::Lottie];

    pub fn name(self) -> &'static str {
        match self {
            Self::Svg => "animated SVG",
            Self::Page => "page",
            Self::Lottie => "Lottie",
        }
    }

    pub fn ending(self) -> &'static str {
        match self {
            Self::Svg => "svg",
            Self::Page => "html",
            Self::Lottie => "json",
        }
    }
}

/// Pictures of a size that are taken at once.
pub fn at_once(size: PixelSize) -> usize {
    (ROW_PX / size.width()).max(1) as usize
}

/// A film that was written, as it is to be played.
pub struct Written<'t> {
    pub kind: Kind,
    pub text: &'t str,
    pub fps: f64,
    pub size: PixelSize,
}

pub struct Players {
    chromium: Option<PathBuf>,
    lottie: Option<String>,
}

impl Players {
    pub fn find() -> Self {
        let on_path = || {
            let names = ["chromium", "chromium-browser", "google-chrome"];
            let path = std::env::var_os("PATH").unwrap_or_default();
            let folders: Vec<PathBuf> = std::env::split_paths(&path).collect();
            let all = names
                .iter()
                .flat_map(|name| folders.iter().map(move |f| f.join(name)));
            let mut all = all.filter(|path| path.is_file());
            all.next()
        };
        let named = |name: &str| std::env::var_os(name).map(PathBuf::from);
        let lottie = named("MORPHOSPACE_LOTTIE");
        Self {
            chromium: named("MORPHOSPACE_CHROMIUM").or_else(on_path),
            lottie: lottie.map(|path| std::fs::read_to_string(path).expect("lottie-web's script")),
        }
    }

    /// What there is not.
    pub fn missing(&self, kind: Kind) -> &'static str {
        match (&self.chromium, kind) {
            (None, _) => "no Chromium on the path, nor in MORPHOSPACE_CHROMIUM",
            (_, Kind::Lottie) if self.lottie.is_none() => {
                "no script of lottie-web in MORPHOSPACE_LOTTIE"
            }
            _ => "Chromium took no picture",
        }
    }

    /// What a player shows at a few frames, each with its t; transparent where nothing
    /// is. None where there is no such player.
    pub fn play(
        &self,
        film: &Written,
        frames: &[(f64, f64)],
        folder: &Path,
    ) -> Option<Vec<RgbaImage>> {
        let Written {
            kind,
            text,
            fps,
            size,
        } = *film;
        let chromium = self.chromium.as_ref()?;
        let body = match kind {
            Kind::Svg => svgs(text, frames, fps),
            Kind::Page => {
                std::fs::write(folder.join("film.html"), text).expect("written");
                pages(frames)
            }
            Kind::Lottie => lotties(text, frames, self.lottie.as_ref()?),
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
        // A little higher: a window is not all picture.
        let window = [frames.len() as u32 * width, height + 200];
        let row = photographed(chromium, folder, window)?;
        let places = (0..frames.len() as u32).map(|k| k * width);
        let pictures = places.map(|x| imageops::crop_imm(&row, x, 0, width, height).to_image());
        Some(pictures.collect())
    }
}

/// What Chromium shows of the sheet in a folder.
fn photographed(chromium: &Path, folder: &Path, [width, height]: [u32; 2]) -> Option<RgbaImage> {
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
    // One whose page broke down waits for ever.
    let begun = Instant::now();
    let status = loop {
        match player.try_wait().ok()? {
            Some(status) => break status,
            None if begun.elapsed() > PATIENCE => {
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

/// Text as a string of a script, which cannot end it.
fn quoted(text: &str) -> String {
    let json = serde_json::to_string(text).expect("text");
    json.replace('<', "\\u003c")
}

fn svgs(text: &str, frames: &[(f64, f64)], fps: f64) -> String {
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
        quoted(text)
    )
}

fn pages(frames: &[(f64, f64)]) -> String {
    let frame = |(_, t): &(f64, f64)| format!("<iframe src=\"film.html#t={t}&bare\"></iframe>");
    frames.iter().map(frame).collect()
}

fn lotties(text: &str, frames: &[(f64, f64)], script: &str) -> String {
    let numbers: Vec<f64> = frames.iter().map(|frame| frame.0).collect();
    let script = script.replace("</script", "<\\/script");
    format!(
        "<script>{script}</script><script>const text = {};
         // Played once, and what it shows kept as a still: that many players of a large film
         // are more than Chromium has memory for.
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
        quoted(text)
    )
}
