//! `morphospace render`: pictures, contact sheets, numbered pictures and films.
//!
//! The output's name tells its kind. Numbered pictures are one pass; a GIF,
//! animated PNG or MP4 of a ping-pong project runs back as well.

use std::ops::Range;
use std::path::{Path, PathBuf};

use clap::Args;

use crate::colour::Rgb;
use crate::export::{
    Aspect, Camera, Captions, Drawing, ExportError, ExportTarget, FilmKind, FilmPreset,
    FilmPresets, FilmSpec, LayoutPreset, MethodRow, PictureLayout, PixelSize, PlaneView, StillKind,
    comparison_sheet, contact_sheet, even_times, extension_list, framing, map_sheet, write_film,
    write_still,
};
use crate::project::Project;
use crate::settings::choice::{Choice, keys};
use crate::space::{MapLayout, WeightMap};
use crate::transition::PlayMode;
use crate::work::progress::{Progress, ProgressSpan, WholeProgress};

use super::error::CliError;
use super::inputs::{InputArgs, OpenedProject};
use super::options::MethodArgs;
use super::output;
use super::terminal::Terminal;
use super::value_parsers::{BackgroundColour, grid, ground, one_of, range};

/// The longer side of a picture of free size, in pixels: half a screen's width.
const LONGER_SIDE_PX: u32 = 960;

/// Columns of a comparison, as many as a strip of a table's sheet has.
const COMPARED: usize = 7;

/// The most cells of a contact sheet: more are frames, and have flags of their
/// own.
const MAX_CELLS: u64 = 1_000;

#[derive(Debug, Args)]
pub(super) struct RenderArgs {
    #[command(flatten)]
    inputs: InputArgs,

    #[arg(long, short, value_name = "PATH", help = out_help())]
    out: PathBuf,

    /// One picture, at this t; or several numbered ones, at T,T,...
    #[arg(long, value_name = "T", allow_negative_numbers = true, value_delimiter = ',', conflicts_with_all = ["sheet", "frames", "frames_range", "fps"])]
    at: Vec<f64>,

    /// A contact sheet of N frames from --from to --to
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=MAX_CELLS), conflicts_with_all = ["frames", "frames_range", "fps"])]
    sheet: Option<u64>,

    /// A contact sheet of every method that the pair can be seen by: a row for
    /// each, the same seven t (or --sheet N) in each column
    #[arg(long, conflicts_with_all = ["at", "frames", "frames_range", "fps", "size", "method", "warp", "content"])]
    compare: bool,

    /// A map of all designs: so many columns and rows of what lies between them
    #[arg(long, value_name = "COLUMNSxROWS", value_parser = grid, conflicts_with_all = ["at", "sheet", "compare", "frames", "frames_range", "fps", "preset", "aspect", "lines", "frame_margin", "captions"])]
    map: Option<[usize; 2]>,

    /// Where the designs are on that map [default: as the project has it, or at the corners of a
    /// polygon]
    #[arg(long, requires = "map", value_parser = one_of::<MapLayout>())]
    sites: Option<MapLayout>,

    /// One pass of N frames, evenly in t [default: as the project's timing has it]
    #[arg(long, value_name = "N")]
    frames: Option<usize>,

    /// Only the frames numbered A to B-1, with the numbers that they have in the whole
    #[arg(long, value_name = "A..B", value_parser = range)]
    frames_range: Option<Range<usize>>,

    /// Frames a second [default: 30, or as the preset has it]
    #[arg(long)]
    fps: Option<f64>,

    /// Size in pixels [default: the design's shape, 960 along the longer side]
    #[arg(long, value_name = "WxH")]
    size: Option<PixelSize>,

    #[command(flatten)]
    layout: LayoutArgs,

    /// The colour behind: #rrggbb, or transparent [default: the project's]
    #[arg(long, value_name = "COLOUR", value_parser = ground)]
    ground: Option<BackgroundColour>,

    #[command(flatten)]
    method: MethodArgs,
}

#[derive(Debug, Args)]
#[command(next_help_heading = "Layout of pictures and films")]
#[group(conflicts_with_all = ["sheet", "compare"])]
struct LayoutArgs {
    /// What it is made for, a shape, a size, and captions: deck, post, story, page, or a look that
    /// was kept in the window
    #[arg(long, value_name = "NAME", conflicts_with = "size", value_parser = preset)]
    preset: Option<PresetChoice>,

    /// The shape of pictures
    #[arg(long, conflicts_with = "size", value_parser = one_of::<Aspect>())]
    aspect: Option<Aspect>,

    /// Pixels along the shorter side, as in 720, 1080 or 2160
    #[arg(long, value_name = "PIXELS", conflicts_with = "size")]
    lines: Option<u32>,

    /// What is free all around, a fraction of the shorter side
    #[arg(long, value_name = "FRACTION", conflicts_with = "size", value_parser = margin)]
    frame_margin: Option<f64>,

    /// The names of the stops below, or of the designs where there are none
    #[arg(long)]
    captions: bool,
}

impl LayoutArgs {
    /// The layout that is asked for; none where nothing is said of its shape.
    fn layout(&self) -> Option<PictureLayout> {
        let is_asked = self.preset.is_some()
            || self.aspect.is_some()
            || self.lines.is_some()
            || self.frame_margin.is_some()
            || self.captions;
        let plain = || PictureLayout {
            aspect: Aspect::Own,
            ..PictureLayout::default()
        };
        let base = match &self.preset {
            None => plain(),
            Some(PresetChoice::Made(purpose)) => purpose.layout(),
            Some(PresetChoice::Kept(kept)) => kept.layout(),
        };
        is_asked.then(|| PictureLayout {
            aspect: self.aspect.unwrap_or(base.aspect),
            lines: self.lines.unwrap_or(base.lines),
            margin: self.frame_margin.unwrap_or(base.margin),
            has_captions: self.captions || base.has_captions,
        })
    }
}

/// A look by its name.
#[derive(Clone, Copy, Debug)]
enum PresetChoice {
    /// One of those that everybody has.
    Made(LayoutPreset),
    /// One that was kept.
    Kept(FilmPreset),
}

fn preset(name: &str) -> Result<PresetChoice, String> {
    if let Ok(purpose) = LayoutPreset::of_key(name) {
        return Ok(PresetChoice::Made(purpose));
    }
    let kept = match FilmPresets::usual_path() {
        Some(path) => {
            FilmPresets::read(&path).map_err(|error| format!("{}: {error}", path.display()))?
        }
        None => FilmPresets::default(),
    };
    let known = keys::<LayoutPreset>().map(str::to_owned);
    let known: Vec<String> = known.chain(kept.0.keys().cloned()).collect();
    let found = kept.0.get(name).copied().map(PresetChoice::Kept);
    found.ok_or_else(|| format!("write {}", known.join(", ")))
}

fn margin(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(share) if (0.0..=0.4).contains(&share) => Ok(share),
        _ => Err("give a fraction from 0 to 0.4, for example 0.05".to_owned()),
    }
}

impl RenderArgs {
    fn fps(&self) -> f64 {
        let of_preset = match &self.layout.preset {
            Some(PresetChoice::Kept(kept)) => f64::from(kept.fps),
            _ => 30.0,
        };
        self.fps.unwrap_or(of_preset)
    }
}

fn out_help() -> String {
    format!(
        "What to write: NAME{} (with --at or --sheet), {}, name-####.png or a folder (numbered \
         pictures)",
        extension_list::<StillKind>(),
        extension_list::<FilmKind>()
    )
}

pub(super) fn run(args: &RenderArgs) -> Result<(), CliError> {
    let target = ExportTarget::of_path(&args.out).map_err(CliError::usage)?;
    let shown = shown(args, &target)?;
    let target = if shown.is_none() {
        target.moving()
    } else {
        target
    };
    // Before the designs are read, which may take long.
    check(args, &target, shown)?;
    let terminal = Terminal::new();
    let whole = WholeProgress::new(&terminal);
    if let (Some(MapOrFilm::Map(grid)), ExportTarget::Still(kind, path)) = (shown, &target) {
        let (drawing, notes) = map(args, grid, &whole)?;
        write_still(&drawing, *kind, path).map_err(CliError::failed)?;
        drop(terminal);
        notes.iter().for_each(|note| output::words(note));
        tell(std::slice::from_ref(path));
        return Ok(());
    }
    let opened = args
        .inputs
        .open(&args.method, &ProgressSpan::new(&whole, 0.0, 0.5))?;
    let rest = ProgressSpan::new(&whole, 0.5, 1.0);
    let written = match (target, shown) {
        (ExportTarget::Still(kind, path), Some(shown)) => {
            let drawing = drawn(args, &opened, shown, &rest)?;
            write_still(&drawing, kind, &path).map_err(CliError::failed)?;
            vec![path]
        }
        // A still without anything to show was refused above.
        (target, _) => film(args, &opened, target, &rest)?,
    };
    // Its line is wiped before words take its place.
    drop(terminal);
    tell(&written);
    Ok(())
}

/// What one picture shows.
#[derive(Clone, Copy)]
enum MapOrFilm {
    /// The frame at a t.
    Frame(f64),
    /// A contact sheet of so many frames.
    Sheet(usize),
    /// Every method, with so many frames each.
    Methods(usize),
    /// So many columns and rows of a map of all designs.
    Map([usize; 2]),
}

/// Whether a name says where numbers go.
fn is_numbered(path: &Path) -> bool {
    path.to_string_lossy().contains('#')
}

/// What the flags want to see in one picture; `None` for a film.
fn shown(args: &RenderArgs, target: &ExportTarget) -> Result<Option<MapOrFilm>, CliError> {
    let count = args.sheet.map(|count| count as usize);
    if let Some(t) = args.at.iter().find(|t| !t.is_finite()) {
        return Err(CliError::Usage(format!(
            "--at {t} is nowhere: t must be a finite number"
        )));
    }
    if let Some(grid) = args.map {
        return Ok(Some(MapOrFilm::Map(grid)));
    }
    match args.at.as_slice() {
        // Frames of their own, where several are asked for or the name has a number.
        at if matches!(target, ExportTarget::Numbered(_))
            && !args.out.is_dir()
            && (at.len() > 1 || (at.len() == 1 && is_numbered(&args.out))) =>
        {
            Ok(None)
        }
        &[t] => Ok(Some(MapOrFilm::Frame(t))),
        [_, _, ..] => Err(CliError::Usage(format!(
            "--at names {} moments: write name-####.svg for numbered pictures, or give one",
            args.at.len()
        ))),
        [] if args.compare => Ok(Some(MapOrFilm::Methods(count.unwrap_or(COMPARED)))),
        [] => Ok(count.map(MapOrFilm::Sheet)),
    }
}

/// Whether the output's name fits the flags, before the work and not after it.
fn check(
    args: &RenderArgs,
    target: &ExportTarget,
    shown: Option<MapOrFilm>,
) -> Result<(), CliError> {
    if shown.is_some() && args.out.is_dir() {
        let (path, extension_list) = (args.out.display(), extension_list::<StillKind>());
        return Err(CliError::Usage(format!(
            "`{path}` is a folder: name a file in it, one that ends in {extension_list}"
        )));
    }
    let flags = match (target, shown) {
        (ExportTarget::Still(_, path), None) => {
            return Err(CliError::Usage(format!(
                "`{0}` is one picture: add --at T for one moment or --sheet N for a contact sheet, or write name-####.{1} for numbered pictures",
                path.display(),
                path.extension().unwrap_or_default().to_string_lossy(),
            )));
        }
        (ExportTarget::Still(..), Some(_)) | (_, None) => return Ok(()),
        (_, Some(MapOrFilm::Methods(_))) => "--compare makes",
        (_, Some(MapOrFilm::Map(_))) => "--map makes",
        (_, Some(_)) => "--at and --sheet make",
    };
    let (path, extension_list) = (args.out.display(), extension_list::<StillKind>());
    let words = format!("{flags} one picture: end `{path}` in {extension_list}");
    Err(CliError::Usage(words))
}

fn drawn(
    args: &RenderArgs,
    opened: &OpenedProject,
    shown: MapOrFilm,
    progress: &dyn Progress,
) -> Result<Drawing, CliError> {
    let project = &opened.loaded.project;
    let (sequence, style) = (&opened.sequence, &project.style);
    let ground = ground_of(args, project);
    let times = |count| even_times(project.timing.from, project.timing.to, count);
    Ok(match shown {
        MapOrFilm::Frame(t) => {
            // Seen as the film is, so that pictures of one project fit together.
            let seen: Vec<f64> = times(17).into_iter().chain([t]).collect();
            camera(args, opened, &seen, false)?.shoot(t)
        }
        MapOrFilm::Sheet(count) => {
            let times = times(count);
            let bounds = framing(sequence, &times);
            contact_sheet(sequence, style, &times, bounds, args.size, ground)
        }
        MapOrFilm::Methods(_) if project.is_sequence() || project.follows_path() => {
            return Err(CliError::Usage(
                "--compare is of two designs: name the two of which you want to see all methods"
                    .to_owned(),
            ));
        }
        MapOrFilm::Map(grid) => map(args, grid, progress)?.0,
        MapOrFilm::Methods(count) => {
            let spec = opened.loaded.spec().map_err(CliError::failed)?;
            let rows = MethodRow::all(&spec, progress).map_err(CliError::failed)?;
            comparison_sheet(&rows, style, &times(count), ground).map_err(CliError::failed)?
        }
    })
}

/// The map of all designs, and what is to be told about it.
fn map(
    args: &RenderArgs,
    grid: [usize; 2],
    progress: &dyn Progress,
) -> Result<(Drawing, Vec<String>), CliError> {
    let (loaded, space, _) = args.inputs.open_space(&args.method, progress)?;
    let map = match args.sites {
        Some(layout) => {
            WeightMap::new(&layout.sites(space.likeness())).map_err(CliError::failed)?
        }
        None => loaded.map_of(&space).map_err(CliError::failed)?,
    };
    let ground = ground_of(args, &loaded.project);
    let style = &loaded.project.style;
    let drawing = map_sheet((&space, &map), style, grid, args.size, ground);
    Ok((
        drawing,
        space.notes().iter().map(ToString::to_string).collect(),
    ))
}

fn film(
    args: &RenderArgs,
    opened: &OpenedProject,
    target: ExportTarget,
    progress: &dyn Progress,
) -> Result<Vec<PathBuf>, CliError> {
    let whole = whole_film(args, &opened.loaded.project, &target)?;
    let part = match &args.frames_range {
        Some(range) => whole.part(range.clone()).map_err(CliError::usage)?,
        None => whole.clone(),
    };
    let is_mp4 = matches!(target, ExportTarget::Film(FilmKind::Mp4, _));
    // Framed by the whole film, so that parts made apart fit together.
    let camera = camera(args, opened, whole.times(), is_mp4)?;
    if args.size.is_some_and(|size| size != camera.view.size()) {
        output::words(&format!(
            "an MP4 has even sides: {} pixels",
            camera.view.size()
        ));
    }
    write_film(&camera, &part, &target, progress).map_err(|error| match error {
        // Flags that do not go with the kind of file; all else is the work's failure.
        ExportError::GifRate(_) | ExportError::Mp4Transparent => CliError::usage(error),
        error => CliError::failed(error),
    })
}

fn whole_film(
    args: &RenderArgs,
    project: &Project,
    target: &ExportTarget,
) -> Result<FilmSpec, CliError> {
    let mut timing = project.timing;
    if matches!(target, ExportTarget::Numbered(_)) {
        timing.play = PlayMode::Once;
    }
    let film = match args.frames {
        _ if !args.at.is_empty() => FilmSpec::at(args.at.clone(), args.fps()),
        None => FilmSpec::of_timing(&timing, &project.stops, args.fps()),
        Some(count) => FilmSpec::evenly(timing.from, timing.to, count, args.fps())
            .map(|film| film.playing(timing.play)),
    };
    let film = film.map_err(CliError::usage)?;
    Ok(film.titled(&project.title))
}

fn camera(
    args: &RenderArgs,
    opened: &OpenedProject,
    times: &[f64],
    is_even: bool,
) -> Result<Camera, CliError> {
    let bounds = framing(&opened.sequence, times);
    let layout = args.layout.layout();
    let view = match (layout, args.size) {
        (Some(layout), None) => layout.view(bounds).map_err(CliError::usage)?,
        (Some(layout), Some(size)) => layout.view_of(bounds, size),
        (None, size) => {
            let size = size.unwrap_or_else(|| PixelSize::of_shape(bounds, LONGER_SIDE_PX));
            PlaneView::fit(bounds, if is_even { size.to_even() } else { size })
        }
    };
    let project = &opened.loaded.project;
    let has_captions = layout.is_some_and(|layout| layout.has_captions);
    Ok(Camera {
        sequence: opened.sequence.clone(),
        style: project.style,
        view,
        ground: ground_of(args, project),
        captions: has_captions.then(|| captions(args, opened)),
    })
}

fn captions(args: &RenderArgs, opened: &OpenedProject) -> Captions {
    let project = &opened.loaded.project;
    let names = opened.loaded.names_on_the_way();
    let ground = ground_of(args, project).unwrap_or(project.style.ground);
    Captions::new(&project.stops, names, ground)
}

fn ground_of(args: &RenderArgs, project: &Project) -> Option<Rgb> {
    let given = args.ground.map(|BackgroundColour(ground)| ground);
    given.unwrap_or(Some(project.style.ground))
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
