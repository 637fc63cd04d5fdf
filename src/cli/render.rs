//! `morphospace render`: pictures, contact sheets, numbered pictures and films.
//!
//! The output's name tells its kind. Numbered pictures are one pass; a GIF,
//! animated PNG or MP4 of a ping-pong project runs back as well.

use std::ops::Range;
use std::path::PathBuf;

use clap::Args;

use crate::export::{
    Camera, Drawing, ExportError, Film, FilmKind, MethodRow, PixelSize, StillKind, Target, View,
    comparison, endings, even_times, framing, sheet, write_film, write_still,
};
use crate::progress::Progress;
use crate::project::Project;
use crate::transition::{PlayMode, Rgb};

use super::error::CliError;
use super::inputs::{Inputs, Opened};
use super::options::MethodArgs;
use super::output;
use super::terminal::Terminal;
use super::values::{Ground, ground, range};

/// The longer side of a picture of free size, in pixels.
const LONGER_SIDE_PX: u32 = 960;

/// Columns of a comparison.
const COMPARED: usize = 7;

/// The most cells of a contact sheet.
const MAX_CELLS: u64 = 1_000;

#[derive(Debug, Args)]
pub(super) struct RenderArgs {
    #[command(flatten)]
    inputs: Inputs,

    #[arg(long, short, value_name = "PATH", help = out_help())]
    out: PathBuf,

    /// One picture, at this t
    #[arg(long, value_name = "T", allow_negative_numbers = true, conflicts_with_all = ["sheet", "frames", "frames_range", "fps"])]
    at: Option<f64>,

    /// A contact sheet of N frames from --from to --to
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=MAX_CELLS), conflicts_with_all = ["frames", "frames_range", "fps"])]
    sheet: Option<u64>,

    /// A contact sheet of every method that the pair can be seen by: a row for
    /// each, the same seven t (or --sheet N) in each column
    #[arg(long, conflicts_with_all = ["at", "frames", "frames_range", "fps", "size", "method", "warp", "content"])]
    compare: bool,

    /// One pass of N frames, evenly in t [default: as the project's timing has it]
    #[arg(long, value_name = "N")]
    frames: Option<usize>,

    /// Only the frames numbered A to B-1, with the numbers that they have in the whole
    #[arg(long, value_name = "A..B", value_parser = range)]
    frames_range: Option<Range<usize>>,

    /// Frames a second
    #[arg(long, default_value_t = 30.0)]
    fps: f64,

    /// Size in pixels [default: the design's shape, 960 along the longer side]
    #[arg(long, value_name = "WxH")]
    size: Option<PixelSize>,

    /// The colour behind: #rrggbb, or transparent [default: the project's]
    #[arg(long, value_name = "COLOUR", value_parser = ground)]
    ground: Option<Ground>,

    #[command(flatten)]
    method: MethodArgs,
}

fn out_help() -> String {
    format!(
        "What to write: NAME{} (with --at or --sheet), {}, name-####.png or a folder (numbered \
         pictures)",
        endings::<StillKind>(),
        endings::<FilmKind>()
    )
}

pub(super) fn run(args: &RenderArgs) -> Result<(), CliError> {
    let target = Target::of_path(&args.out).map_err(CliError::usage)?;
    let job = job(args, target)?;
    let terminal = Terminal::new();
    let opened = args.inputs.open(&args.method, &terminal)?;
    let written = match job {
        Job::Still(kind, path, shown) => {
            let drawing = drawn(args, &opened, &shown, &terminal)?;
            write_still(&drawing, kind, &path).map_err(CliError::failed)?;
            vec![path]
        }
        Job::Film(target) => film(args, &opened, target, &terminal)?,
    };
    drop(terminal);
    tell(&written);
    Ok(())
}

/// What is to be made, once the flags are seen to fit the name.
enum Job {
    Still(StillKind, PathBuf, Shown),
    Film(Target),
}

/// What one picture shows.
enum Shown {
    /// The frame at a t.
    Frame(f64),
    /// A contact sheet of so many frames.
    Sheet(usize),
    /// Every method, with so many frames each.
    Methods(usize),
}

fn job(args: &RenderArgs, target: Target) -> Result<Job, CliError> {
    let one_picture = |flags: &str| {
        let (path, endings) = (args.out.display(), endings::<StillKind>());
        CliError::Usage(format!("{flags} one picture: end `{path}` in {endings}"))
    };
    let count = args.sheet.map(|count| count as usize);
    match (target, args.at, count) {
        (_, Some(t), _) if !t.is_finite() => Err(CliError::Usage(format!(
            "--at {t} is nowhere: t must be a finite number"
        ))),
        (Target::Still(kind, path), None, count) if args.compare => {
            let methods = Shown::Methods(count.unwrap_or(COMPARED));
            Ok(Job::Still(kind, path, methods))
        }
        _ if args.compare => Err(one_picture("--compare makes")),
        (Target::Still(kind, path), Some(t), _) => Ok(Job::Still(kind, path, Shown::Frame(t))),
        (Target::Still(kind, path), None, Some(count)) => {
            Ok(Job::Still(kind, path, Shown::Sheet(count)))
        }
        (Target::Still(_, path), None, None) => Err(CliError::Usage(format!(
            "`{0}` is one picture: add --at T for one moment or --sheet N for a contact sheet, or write name-####.{1} for numbered pictures",
            path.display(),
            path.extension().unwrap_or_default().to_string_lossy(),
        ))),
        (target, None, None) => Ok(Job::Film(target)),
        _ => Err(one_picture("--at and --sheet make")),
    }
}

fn drawn(
    args: &RenderArgs,
    opened: &Opened,
    shown: &Shown,
    progress: &dyn Progress,
) -> Result<Drawing, CliError> {
    let project = &opened.loaded.project;
    let (transition, style) = (&opened.transition, &project.style);
    let ground = ground_of(args, project);
    let times = |count| even_times(project.timing.from, project.timing.to, count);
    Ok(match *shown {
        Shown::Frame(t) => {
            // Seen as the film is, so that pictures of one project fit together.
            let seen: Vec<f64> = times(17).into_iter().chain([t]).collect();
            camera(args, opened, &seen, std::convert::identity).shoot(t)
        }
        Shown::Sheet(count) => {
            let times = times(count);
            let bounds = framing(transition, &times);
            sheet(transition, style, &times, bounds, args.size, ground)
        }
        Shown::Methods(count) => {
            let spec = opened.loaded.spec().map_err(CliError::failed)?;
            let rows = MethodRow::all(&spec, progress).map_err(CliError::failed)?;
            comparison(&rows, style, &times(count), ground).map_err(CliError::failed)?
        }
    })
}

fn film(
    args: &RenderArgs,
    opened: &Opened,
    target: Target,
    progress: &dyn Progress,
) -> Result<Vec<PathBuf>, CliError> {
    let whole = whole_film(args, &opened.loaded.project, &target)?;
    let part = match &args.frames_range {
        Some(range) => whole.part(range.clone()).map_err(CliError::usage)?,
        None => whole.clone(),
    };
    let is_mp4 = matches!(target, Target::Film(FilmKind::Mp4, _));
    let even = if is_mp4 {
        PixelSize::to_even
    } else {
        std::convert::identity
    };
    let camera = camera(args, opened, whole.times(), even);
    if args.size.is_some_and(|size| size != camera.view.size()) {
        output::words(&format!(
            "an MP4 has even sides: {} pixels",
            camera.view.size()
        ));
    }
    write_film(&camera, &part, &target, progress).map_err(|error| match error {
        ExportError::GifRate(_) | ExportError::Mp4Transparent => CliError::usage(error),
        error => CliError::failed(error),
    })
}

fn whole_film(args: &RenderArgs, project: &Project, target: &Target) -> Result<Film, CliError> {
    let mut timing = project.timing;
    if matches!(target, Target::Numbered(_)) {
        timing.play = PlayMode::Once;
    }
    let film = match args.frames {
        None => Film::of_timing(&timing, &project.stops, args.fps),
        Some(count) => Film::evenly(timing.from, timing.to, count, args.fps)
            .map(|film| film.playing(timing.play)),
    };
    film.map_err(CliError::usage)
}

fn camera(
    args: &RenderArgs,
    opened: &Opened,
    times: &[f64],
    fitted: impl Fn(PixelSize) -> PixelSize,
) -> Camera {
    let bounds = framing(&opened.transition, times);
    let size = args
        .size
        .unwrap_or_else(|| PixelSize::of_shape(bounds, LONGER_SIDE_PX));
    Camera {
        transition: opened.transition.clone(),
        style: opened.loaded.project.style,
        view: View::fit(bounds, fitted(size)),
        ground: ground_of(args, &opened.loaded.project),
    }
}

fn ground_of(args: &RenderArgs, project: &Project) -> Option<Rgb> {
    match args.ground {
        None => Some(project.style.ground),
        Some(Ground::Transparent) => None,
        Some(Ground::Coloured(colour)) => Some(colour),
    }
}

fn tell(written: &[PathBuf]) {
    match written {
        [] => {}
        [one] => output::words(&format!("wrote {}", one.display())),
        [first, .., last] => output::words(&format!(
            "wrote {} files, {} to {}",
            written.len(),
            first.display(),
            last.display()
        )),
    }
}
