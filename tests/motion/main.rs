//! Compares exported vector animations, shown by their players, with the frames that the program
//! renders itself. Also checks the size of exported HTML pages.
//!
//! Chromium plays the animated SVG, the HTML page and, with the script of lottie-web, the Lottie
//! file. rlottie and ThorVG play the Lottie file, too. If a player is missing, the test says so and
//! counts the comparisons that it did not make. Environment variables:
//!
//! - `MORPHOSPACE_CHROMIUM`: path of Chromium; by default it is searched on `PATH`
//! - `MORPHOSPACE_LOTTIE`: path of lottie-web's script, `lottie.js`
//! - `MORPHOSPACE_PYTHON`: Python with rlottie-python, thorvg-python and pillow; by default
//!   `python3` on `PATH`
//! - `MORPHOSPACE_MOTION`: names of the films to compare (gallery projects, or those of
//!   [`DRAWN_FILMS`]), or `all`
//! - `MORPHOSPACE_MOTION_OUT`: folder in which the exported files and the images are saved

mod browser;
mod lottie_players;

use std::io::Write;
use std::path::Path;

use image::RgbaImage;
use morphospace::content::ContentKind;
use morphospace::export::{Camera, FilmSpec, PixelSize, PlaneView, VectorAnimation, framing};
use morphospace::project::{LoadedProject, gallery};
use morphospace::transition::Transition;
use morphospace::work::progress::Silent;

use browser::{AnimationFile, AnimationPlayers, VectorFormat};
use lottie_players::LottiePlayer;

/// Number of frames of each film that are compared.
const COMPARED_FRAMES: usize = 25;

/// Length of the longer side of a compared frame, in pixels: the size of a film for slides.
const SIDE_PX: u32 = 1920;

/// Length of the longer side of a compared frame that shows the bars of a truss, in pixels.
///
/// Bars consist mostly of antialiased edge pixels, which differ between renderers. In frames of
/// [`SIDE_PX`] these pixels alone would lower the overlap below [`MIN_OVERLAP`].
const BARS_PX: u32 = 3840;

/// Default length of the longer side of an exported HTML page, in pixels. The size of the file is
/// checked for this length.
const DEFAULT_PX: u32 = 960;

/// Films that are compared by default: a coloured drawing, parts that appear, a truss, a distance
/// field, a hole that closes, holes that open, and gradients, opacity and outlines that change.
const DEFAULT_FILMS: &str =
    "day-to-night words bracket-to-davit letters spectacles ring-to-window sun-to-lamp";

/// Films between drawings of `tests/motion/drawings`: name, source and target.
const DRAWN_FILMS: [(&str, &str, &str); 2] = [
    ("ring-to-window", "ring.svg", "window.svg"),
    ("sun-to-lamp", "sun.svg", "lamp.svg"),
];

/// Minimum [`overlap`] of a frame in the browser with the program's own (tolerance: antialiasing
/// differs).
const MIN_OVERLAP: f64 = 0.995;

/// Maximum [`colour_difference`] between a frame in the browser and the program's own (tolerance:
/// rounding of colours differs).
const MAX_COLOUR_DIFFERENCE: f64 = 4.0;

/// Maximum size of the file of an HTML page whose longer side is [`DEFAULT_PX`], in kB.
const MAX_PAGE_KB: f64 = 300.0;

/// Difference of two opacities (0 to 255) that counts as rounding: rlottie multiplies opacities in
/// three steps of 8 bits each and shows 254 instead of 255.
const OPACITY_ROUNDING: f64 = 2.0;

/// Intersection over union of the opaque areas of two images.
fn overlap(a: &RgbaImage, b: &RgbaImage) -> f64 {
    assert_eq!(a.dimensions(), b.dimensions());
    let [mut both, mut either] = [0.0; 2];
    for (a, b) in a.pixels().zip(b.pixels()) {
        let [a, mut b] = [a, b].map(|p| f64::from(p.0[3]));
        if (a - b).abs() <= OPACITY_ROUNDING {
            b = a;
        }
        both += a.min(b);
        either += a.max(b);
    }
    if either > 0.0 { both / either } else { 1.0 }
}

/// Mean, over the pixels that are opaque in both images, of the largest difference of a colour
/// channel (0 to 255).
fn colour_difference(a: &RgbaImage, b: &RgbaImage) -> f64 {
    let both = a.pixels().zip(b.pixels());
    let both: Vec<_> = both
        .filter(|(a, b)| {
            [a, b]
                .iter()
                .all(|p| f64::from(p.0[3]) >= 255.0 - OPACITY_ROUNDING)
        })
        .collect();
    let differences = both.iter().map(|(a, b)| {
        let channels = (0..3).map(|k| f64::from(a.0[k].abs_diff(b.0[k])));
        channels.fold(0.0, f64::max)
    });
    differences.sum::<f64>() / both.len().max(1) as f64
}

/// A film of a project: its vector animation, and the camera that renders the program's own frames.
struct ComparedFilm {
    camera: Camera,
    film: FilmSpec,
    animation: VectorAnimation,
    /// Indices in `film` of the compared frames.
    frames: Vec<usize>,
}

impl ComparedFilm {
    /// Records the film of a project; `side_px` returns the length of the longer side of its
    /// frames. `None` for blends of bitmap images, which have no outlines.
    fn new(loaded: &LoadedProject, side_px: impl Fn(&Transition) -> u32) -> Option<Self> {
        let transition = loaded.segments()[0].build(&Silent);
        let transition = transition.expect("a transition");
        if transition.method().content() == ContentKind::Colours {
            return None;
        }
        let project = &loaded.project;
        let film = FilmSpec::of_timing(&project.timing, &project.stops, 30.0).expect("a film");
        let bounds = framing(&transition, film.times());
        let size = PixelSize::of_shape(bounds, side_px(&transition));
        let camera = Camera {
            sequence: transition.into(),
            style: project.style,
            view: PlaneView::fit(bounds, size),
            ground: None,
            captions: None,
        };
        let animation = VectorAnimation::record(&camera, &film, &Silent).expect("an animation");
        let (from, to) = (project.timing.from, project.timing.to);
        let frame = |k: usize| {
            let t = from + (to - from) * k as f64 / (COMPARED_FRAMES - 1) as f64;
            let last = film.times().iter().position(|&t| t == to).unwrap_or(0);
            let distance = |k: &usize| (film.times()[*k] - t).abs();
            (0..=last).min_by(|a, b| distance(a).total_cmp(&distance(b)))
        };
        let frames = (0..COMPARED_FRAMES).filter_map(frame).collect();
        Some(Self {
            camera,
            film,
            animation,
            frames,
        })
    }

    /// Text of the file that is exported in a format.
    fn text(&self, kind: VectorFormat, title: &str) -> String {
        match kind {
            VectorFormat::Svg => self.animation.svg(),
            VectorFormat::Page => self.animation.page(title),
            VectorFormat::Lottie => self.animation.lottie(title),
        }
    }

    /// Compares the frames that `play` returns with the program's own. Returns the minimum overlap,
    /// the t of that minimum, and the maximum colour difference.
    ///
    /// `None` if `play` returns none, because the player is missing or fails. Saves both images of
    /// each frame to `save_folder`, if given.
    fn compare(
        &self,
        play: impl Fn(&[(f64, f64)]) -> Option<Vec<RgbaImage>>,
        save_folder: Option<&Path>,
    ) -> Option<(f64, f64, f64)> {
        let frames = (self.frames.iter()).map(|&k| (k as f64, self.film.times()[k]));
        let frames: Vec<(f64, f64)> = frames.collect();
        let mut worst = (1.0, 0.0, 0.0);
        for chunk in frames.chunks(browser::frames_per_sheet(self.camera.view.size())) {
            for (theirs, &(frame, t)) in play(chunk)?.iter().zip(chunk) {
                let own = self.camera.pixels(t);
                let overlap = overlap(&own, theirs);
                if let Some(folder) = save_folder {
                    let save = |who: &str, picture: &RgbaImage| {
                        let file = folder.join(format!("{frame:03}-{who}.png"));
                        picture.save(file).expect("saved");
                    };
                    save("own", &own);
                    save("theirs", theirs);
                }
                if overlap < worst.0 {
                    (worst.0, worst.1) = (overlap, t);
                }
                worst.2 = f64::max(worst.2, colour_difference(&own, theirs));
            }
        }
        Some(worst)
    }
}

/// Prints a line to stderr directly, so that the test runner does not capture it.
fn print_uncaptured(line: &str) {
    writeln!(std::io::stderr(), "{line}").expect("standard error");
}

/// Program that shows an exported film.
#[derive(Clone, Copy, Debug)]
enum FilmPlayer {
    /// Chromium, for any format; Lottie with lottie-web.
    Browser(VectorFormat),
    /// Another player of Lottie files.
    Lottie(LottiePlayer),
}

impl FilmPlayer {
    fn all() -> impl Iterator<Item = Self> {
        let others = LottiePlayer::ALL.into_iter().map(Self::Lottie);
        VectorFormat::ALL
            .into_iter()
            .map(Self::Browser)
            .chain(others)
    }

    fn format(self) -> VectorFormat {
        match self {
            Self::Browser(format) => format,
            Self::Lottie(_) => VectorFormat::Lottie,
        }
    }

    fn name(self) -> &'static str {
        match self {
            Self::Browser(VectorFormat::Lottie) => "Lottie in lottie-web",
            Self::Browser(format) => format.name(),
            Self::Lottie(LottiePlayer::Rlottie) => "Lottie in rlottie",
            Self::Lottie(LottiePlayer::Thorvg) => "Lottie in ThorVG",
        }
    }
}

/// Result of a comparison in one player.
enum Comparison {
    Same,
    /// A frame differs too much from the program's own.
    Different(String),
    /// The player is missing.
    NotCompared,
}

/// Plays a film and compares it with the program's own frames.
fn play_and_compare(
    shot: &ComparedFilm,
    player: FilmPlayer,
    (name, title): (&str, &str),
    browsers: &AnimationPlayers,
) -> Comparison {
    let kind = player.format();
    let text = shot.text(kind, title);
    let folder = tempfile::tempdir().expect("a folder");
    let save_folder = std::env::var_os("MORPHOSPACE_MOTION_OUT")
        .map(|out| Path::new(&out).join(name).join(player.name()));
    if let Some(folder) = &save_folder {
        std::fs::create_dir_all(folder).expect("a folder");
        let file = folder.join(format!("film.{}", kind.ending()));
        std::fs::write(file, &text).expect("written");
    }
    let file = AnimationFile {
        kind,
        text: &text,
        fps: shot.film.fps(),
        size: shot.camera.view.size(),
    };
    let (player_name, size) = (player.name(), text.len() as f64 / 1e3);
    let label = format!("{name} as {player_name}: {size:.0} kB");
    let play = |frames: &[(f64, f64)]| match player {
        FilmPlayer::Browser(_) => browsers.play(&file, frames, folder.path()),
        FilmPlayer::Lottie(player) => player.play(&file, frames, folder.path()),
    };
    let Some((overlap, t, colour)) = shot.compare(play, save_folder.as_deref()) else {
        let reason = match player {
            FilmPlayer::Browser(kind) => browsers.missing(kind).to_owned(),
            FilmPlayer::Lottie(player) => {
                format!(
                    "no Python package {} (MORPHOSPACE_PYTHON)",
                    player.package()
                )
            }
        };
        print_uncaptured(&format!("{label}, NOT COMPARED: {reason}"));
        return Comparison::NotCompared;
    };
    let line =
        format!("{label}, minimum IoU {overlap:.4} at t = {t:.3}, colours off by {colour:.2}");
    print_uncaptured(&line);
    if overlap < MIN_OVERLAP || colour > MAX_COLOUR_DIFFERENCE {
        Comparison::Different(line)
    } else {
        Comparison::Same
    }
}

/// Length of the longer side of the compared frames of a transition, in pixels.
fn side_px(transition: &Transition) -> u32 {
    let figure = transition.frame(0.0);
    let has_bars = !figure.figure().bars.is_empty();
    if has_bars { BARS_PX } else { SIDE_PX }
}

/// Films to compare, each with its name and its title: those named in `MORPHOSPACE_MOTION`, or the
/// default ones.
fn compared_films() -> Vec<(String, String, LoadedProject)> {
    let names = std::env::var("MORPHOSPACE_MOTION").unwrap_or_else(|_| DEFAULT_FILMS.to_owned());
    let is_chosen = |name: &str| names == "all" || names.split_whitespace().any(|n| n == name);
    let gallery = gallery::list().expect("the list").into_iter();
    let gallery = gallery.filter(|entry| is_chosen(&entry.name)).map(|entry| {
        let loaded = gallery::load(&entry.name).expect("a project");
        (entry.name, entry.title, loaded)
    });
    let drawn = DRAWN_FILMS.into_iter().filter(|film| is_chosen(film.0));
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/motion/drawings");
    let drawn = drawn.map(|(name, source, target)| {
        let pair = LoadedProject::open_pair(&folder.join(source), &folder.join(target));
        (name.to_owned(), name.to_owned(), pair.expect("drawings"))
    });
    gallery.chain(drawn).collect()
}

/// Returns a message if the HTML page of a film is too large.
fn check_page_size(name: &str, title: &str, loaded: &LoadedProject) -> Option<String> {
    let at_default_size = ComparedFilm::new(loaded, |_| DEFAULT_PX).expect("outlines");
    let page = at_default_size.text(VectorFormat::Page, title).len() as f64 / 1e3;
    let line = format!("{name}: an HTML page of {page:.0} kB at {DEFAULT_PX} px");
    print_uncaptured(&line);
    (page >= MAX_PAGE_KB).then_some(line)
}

#[test]
fn players_show_the_same_as_our_frames() {
    let browsers = AnimationPlayers::find();
    let (mut failed, mut not_compared, mut count) = (Vec::new(), 0, 0);
    for (name, title, loaded) in compared_films() {
        let Some(shot) = ComparedFilm::new(&loaded, side_px) else {
            print_uncaptured(&format!("{name}: skipped, bitmap images have no outlines"));
            continue;
        };
        failed.extend(check_page_size(&name, &title, &loaded));
        for player in FilmPlayer::all() {
            count += 1;
            match play_and_compare(&shot, player, (&name, &title), &browsers) {
                Comparison::Same => {}
                Comparison::Different(line) => failed.push(line),
                Comparison::NotCompared => not_compared += 1,
            }
        }
    }
    assert!(count > 0, "no film was chosen");
    print_uncaptured(&format!(
        "{} of {count} comparisons made, {not_compared} NOT MADE because a player is missing",
        count - not_compared
    ));
    assert!(failed.is_empty(), "{}", failed.join("\n"));
}
