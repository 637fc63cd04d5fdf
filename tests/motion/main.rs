//! Compares exported vector animations, played in a browser, with the frames that the program
//! renders itself. Also checks the size of exported HTML pages.
//!
//! Chromium plays the animated SVG, the HTML page and, with the script of lottie-web, the Lottie
//! file. If a player is missing, the test reports it and does not compare that format. Environment
//! variables:
//!
//! - `MORPHOSPACE_CHROMIUM`: path of Chromium; by default it is searched on `PATH`
//! - `MORPHOSPACE_LOTTIE`: path of lottie-web's script, `lottie.js`
//! - `MORPHOSPACE_MOTION`: names of the gallery projects to compare, or `all`
//! - `MORPHOSPACE_MOTION_OUT`: folder in which the exported files and the images are saved

mod browser;

use std::io::Write;
use std::path::Path;

use image::RgbaImage;
use morphospace::content::ContentKind;
use morphospace::export::{Camera, FilmSpec, PixelSize, PlaneView, VectorAnimation, framing};
use morphospace::project::{LoadedProject, gallery};
use morphospace::transition::Transition;
use morphospace::work::progress::Silent;

use browser::{AnimationFile, AnimationPlayers, VectorFormat};

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

/// Gallery projects that are compared by default: a coloured drawing, parts that appear, a truss, a
/// distance field, and a hole that closes.
const DEFAULT_PROJECTS: &str = "day-to-night words bracket-to-davit letters spectacles";

/// Minimum [`overlap`] of a frame in the browser with the program's own (tolerance: antialiasing
/// differs).
const MIN_OVERLAP: f64 = 0.995;

/// Maximum [`colour_difference`] between a frame in the browser and the program's own (tolerance:
/// rounding of colours differs).
const MAX_COLOUR_DIFFERENCE: f64 = 4.0;

/// Maximum size of the file of an HTML page whose longer side is [`DEFAULT_PX`], in kB.
const MAX_PAGE_KB: f64 = 300.0;

/// Intersection over union of the opaque areas of two images.
fn overlap(a: &RgbaImage, b: &RgbaImage) -> f64 {
    assert_eq!(a.dimensions(), b.dimensions());
    let [mut both, mut either] = [0.0; 2];
    for (a, b) in a.pixels().zip(b.pixels()) {
        let [a, b] = [a, b].map(|p| f64::from(p.0[3]));
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
        .filter(|(a, b)| a.0[3] == 255 && b.0[3] == 255)
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

/// Plays a film in one format; returns a message if a frame differs too much from the program's
/// own.
fn play_and_compare(
    shot: &ComparedFilm,
    kind: VectorFormat,
    entry: &gallery::GalleryEntry,
    players: &AnimationPlayers,
) -> Option<String> {
    let text = shot.text(kind, &entry.title);
    let folder = tempfile::tempdir().expect("a folder");
    let save_folder = std::env::var_os("MORPHOSPACE_MOTION_OUT")
        .map(|out| Path::new(&out).join(&entry.name).join(kind.name()));
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
    let label = format!(
        "{} as {}: {:.0} kB",
        entry.name,
        kind.name(),
        text.len() as f64 / 1e3
    );
    let play = |frames: &[(f64, f64)]| players.play(&file, frames, folder.path());
    let Some((overlap, t, colour)) = shot.compare(play, save_folder.as_deref()) else {
        print_uncaptured(&format!("{label}, NOT COMPARED: {}", players.missing(kind)));
        return None;
    };
    let line =
        format!("{label}, minimum IoU {overlap:.4} at t = {t:.3}, colours off by {colour:.2}");
    print_uncaptured(&line);
    (overlap < MIN_OVERLAP || colour > MAX_COLOUR_DIFFERENCE).then_some(line)
}

/// Length of the longer side of the compared frames of a transition, in pixels.
fn side_px(transition: &Transition) -> u32 {
    let figure = transition.frame(0.0);
    let has_bars = !figure.figure().bars.is_empty();
    if has_bars { BARS_PX } else { SIDE_PX }
}

#[test]
fn browsers_show_the_same_as_our_frames() {
    let players = AnimationPlayers::find();
    let names = std::env::var("MORPHOSPACE_MOTION").unwrap_or_else(|_| DEFAULT_PROJECTS.to_owned());
    let mut failed = Vec::new();
    for entry in gallery::list().expect("the list") {
        if names != "all" && !names.split_whitespace().any(|name| name == entry.name) {
            continue;
        }
        let loaded = gallery::load(&entry.name).expect("a project");
        match ComparedFilm::new(&loaded, side_px) {
            Some(shot) => {
                let at_default_size = ComparedFilm::new(&loaded, |_| DEFAULT_PX).expect("outlines");
                let page =
                    at_default_size.text(VectorFormat::Page, &entry.title).len() as f64 / 1e3;
                print_uncaptured(&format!(
                    "{}: an HTML page of {page:.0} kB at {DEFAULT_PX} px",
                    entry.name
                ));
                if page >= MAX_PAGE_KB {
                    failed.push(format!("{}: a page of {page:.0} kB", entry.name));
                }
                let kinds = VectorFormat::ALL.into_iter();
                failed.extend(
                    kinds.filter_map(|kind| play_and_compare(&shot, kind, &entry, &players)),
                );
            }
            None => print_uncaptured(&format!(
                "{}: skipped, bitmap images have no outlines",
                entry.name
            )),
        }
    }
    assert!(failed.is_empty(), "{}", failed.join("\n"));
}
