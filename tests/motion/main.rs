//! What leaves as motion is what our own frames show, as other programs play it.
//!
//! Chromium (`MORPHOSPACE_CHROMIUM`, or on the path) plays the animated SVG and the
//! page, and with the script of lottie-web (`MORPHOSPACE_LOTTIE`, a `lottie.js`) the
//! Lottie. Where a player is missing the test says so aloud and compares nothing.
//! `MORPHOSPACE_MOTION` names the projects of the gallery to compare, or `all`;
//! `MORPHOSPACE_MOTION_OUT` a folder to leave the files and pictures in.

mod players;

use std::io::Write;
use std::path::Path;

use image::RgbaImage;
use morphospace::content::ContentKind;
use morphospace::export::{Camera, FilmSpec, PixelSize, PlaneView, VectorAnimation, framing};
use morphospace::project::{LoadedProject, gallery};
use morphospace::transition::Transition;
use morphospace::work::progress::Silent;

use players::{Kind, Players, Written};

/// Frames of a film that are compared.
const COMPARED: usize = 25;

/// Of the longer side: a film for slides.
const SIDE_PX: u32 = 1920;

/// Of the longer side where there are bars, which are little but edges: on slides two
/// programs' stills of the girder overlap by 0.993, for what each makes of its edges.
const BARS_PX: u32 = 3840;

/// Of the longer side, where nobody asks for another: of that size a page is to be small.
const USUAL_PX: u32 = 960;

/// Projects that are compared where none are named: a drawing in colours, parts that
/// are born, a truss, a field, and a hole that closes.
const USUAL: &str = "day-to-night words bracket-to-davit letters spectacles";

/// How much of what either hides both hide.
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

/// The largest difference in colour where both hide what is below, on average over
/// such pixels.
fn off_colour(a: &RgbaImage, b: &RgbaImage) -> f64 {
    let both = a.pixels().zip(b.pixels());
    let both: Vec<_> = both
        .filter(|(a, b)| a.0[3] == 255 && b.0[3] == 255)
        .collect();
    let off = both.iter().map(|(a, b)| {
        let channels = (0..3).map(|k| f64::from(a.0[k].abs_diff(b.0[k])));
        channels.fold(0.0, f64::max)
    });
    off.sum::<f64>() / both.len().max(1) as f64
}

struct Shot {
    camera: Camera,
    film: FilmSpec,
    motion: VectorAnimation,
    /// The frames that are compared.
    frames: Vec<usize>,
}

impl Shot {
    /// None of pictures, which have no outlines.
    fn of(loaded: &LoadedProject, side_px: impl Fn(&Transition) -> u32) -> Option<Self> {
        let transition = loaded.legs()[0].build(&Silent);
        let transition = transition.expect("a transition");
        if transition.cell().content() == ContentKind::Colours {
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
        let motion = VectorAnimation::record(&camera, &film, &Silent).expect("a motion");
        let (from, to) = (project.timing.from, project.timing.to);
        let frame = |k: usize| {
            let t = from + (to - from) * k as f64 / (COMPARED - 1) as f64;
            let pass = film.times().iter().position(|&t| t == to).unwrap_or(0);
            let off = |k: &usize| (film.times()[*k] - t).abs();
            (0..=pass).min_by(|a, b| off(a).total_cmp(&off(b)))
        };
        let frames = (0..COMPARED).filter_map(frame).collect();
        Some(Self {
            camera,
            film,
            motion,
            frames,
        })
    }

    fn text(&self, kind: Kind, title: &str) -> String {
        match kind {
            Kind::Svg => self.motion.svg(),
            Kind::Page => self.motion.page(title),
            Kind::Lottie => self.motion.lottie(title),
        }
    }

    /// The least overlap with our own frames, the t where it is, and the largest
    /// difference in colour. None where there is no player.
    fn compared(
        &self,
        play: impl Fn(&[(f64, f64)]) -> Option<Vec<RgbaImage>>,
        keep: Option<&Path>,
    ) -> Option<(f64, f64, f64)> {
        let frames = (self.frames.iter()).map(|&k| (k as f64, self.film.times()[k]));
        let frames: Vec<(f64, f64)> = frames.collect();
        let mut worst = (1.0, 0.0, 0.0);
        for some in frames.chunks(players::at_once(self.camera.view.size())) {
            for (theirs, &(frame, t)) in play(some)?.iter().zip(some) {
                let own = self.camera.pixels(t);
                let overlap = overlap(&own, theirs);
                if let Some(folder) = keep {
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
                worst.2 = f64::max(worst.2, off_colour(&own, theirs));
            }
        }
        Some(worst)
    }
}

/// Past what a test runner keeps to itself.
fn say(line: &str) {
    writeln!(std::io::stderr(), "{line}").expect("a place for words");
}

/// Plays one format of a project; a line where it is not what it has to be.
fn played(
    shot: &Shot,
    kind: Kind,
    entry: &gallery::GalleryEntry,
    players: &Players,
) -> Option<String> {
    let text = shot.text(kind, &entry.title);
    let folder = tempfile::tempdir().expect("a folder");
    let kept = std::env::var_os("MORPHOSPACE_MOTION_OUT")
        .map(|out| Path::new(&out).join(&entry.name).join(kind.name()));
    if let Some(folder) = &kept {
        std::fs::create_dir_all(folder).expect("a folder");
        let file = folder.join(format!("film.{}", kind.ending()));
        std::fs::write(file, &text).expect("written");
    }
    let film = Written {
        kind,
        text: &text,
        fps: shot.film.fps(),
        size: shot.camera.view.size(),
    };
    let what = format!(
        "{} as {}: {:.0} kB",
        entry.name,
        kind.name(),
        text.len() as f64 / 1e3
    );
    let play = |some: &[(f64, f64)]| players.play(&film, some, folder.path());
    let Some((overlap, t, colour)) = shot.compared(play, kept.as_deref()) else {
        say(&format!("{what}, NOT COMPARED: {}", players.missing(kind)));
        return None;
    };
    let line = format!("{what}, least IoU {overlap:.4} at t = {t:.3}, colours off by {colour:.2}");
    say(&line);
    (overlap < 0.995 || colour > 4.0).then_some(line)
}

fn side_px(transition: &Transition) -> u32 {
    let figure = transition.frame(0.0);
    let has_bars = !figure.figure().bars.is_empty();
    if has_bars { BARS_PX } else { SIDE_PX }
}

#[test]
fn players_show_what_our_frames_show() {
    let players = Players::find();
    let names = std::env::var("MORPHOSPACE_MOTION").unwrap_or_else(|_| USUAL.to_owned());
    let mut failed = Vec::new();
    for entry in gallery::list().expect("the list") {
        if names != "all" && !names.split_whitespace().any(|name| name == entry.name) {
            continue;
        }
        let loaded = gallery::load(&entry.name).expect("a project");
        match Shot::of(&loaded, side_px) {
            Some(shot) => {
                let usual = Shot::of(&loaded, |_| USUAL_PX).expect("outlines");
                let page = usual.text(Kind::Page, &entry.title).len() as f64 / 1e3;
                say(&format!(
                    "{}: a page of {page:.0} kB at {USUAL_PX} px",
                    entry.name
                ));
                if page >= 300.0 {
                    failed.push(format!("{}: a page of {page:.0} kB", entry.name));
                }
                let kinds = Kind::ALL.into_iter();
                failed.extend(kinds.filter_map(|kind| played(&shot, kind, &entry, &players)));
            }
            None => say(&format!("{}: pictures, which have no outlines", entry.name)),
        }
    }
    assert!(failed.is_empty(), "{}", failed.join("\n"));
}
