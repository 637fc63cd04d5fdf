//! `morphospace render`: writes images, contact sheets, maps, numbered images and animations.
//!
//! The extension of the output file determines the kind of output. Numbered images show the film
//! once, forwards; an animation of a project that plays back and forth also contains the way back.

use std::collections::HashSet;
use std::ops::Range;
use std::path::{Path, PathBuf};

use clap::Args;

use crate::colour::Rgb;
use crate::design::ImportNote;
use crate::export::{
    Aspect, Camera, Captions, Drawing, ExportError, ExportTarget, FilmKind, FilmPreset,
    FilmPresets, FilmSpec, LayoutPreset, MethodRow, PictureLayout, PixelSize, PlaneView, StillKind,
    comparison_sheet, contact_sheet, even_times, extension_list, framing, map_sheet, write_film,
    write_still,
};
use crate::project::{LoadedProject, Project};
use crate::settings::{Choice, choice_keys};
use crate::space::{MapLayout, WeightMap};
use crate::transition::PlayMode;
use crate::work::progress::{OverallProgress, Progress, ProgressSpan};

use super::error::CliError;
use super::inputs::{InputArgs, InputProject, OpenedProject};
use super::options::MethodArgs;
use super::output;
use super::structure;
use super::terminal::Terminal;
use super::value_parsers::{BackgroundColour, background, grid, one_of, range};

/// Default length of an image's longer side, in pixels (heuristic).
const LONGER_SIDE_PX: u32 = 960;

/// Default number of columns of a `--compare` sheet, as many as `check --sheet` draws (heuristic).
const COMPARISON_COLUMNS: usize = 7;

/// Maximum number of frames of a contact sheet (resource limit: all are held as vector drawings).
const MAX_CELLS: u64 = 1_000;

#[derive(Debug, Args)]
pub(super) struct RenderArgs {
    #[command(flatten)]
    inputs: InputArgs,

    #[arg(long, short, value_name = "PATH", help = out_help())]
    out: PathBuf,

    /// One image, at this t; or several numbered images, at T,T,...
    #[arg(long, value_name = "T", allow_negative_numbers = true, value_delimiter = ',', conflicts_with_all = ["sheet", "frames", "frames_range", "fps"])]
    at: Vec<f64>,

    /// Contact sheet of N frames from --from to --to
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=MAX_CELLS), conflicts_with_all = ["frames", "frames_range", "fps"])]
    sheet: Option<u64>,

    /// Contact sheet of all methods available for the pair: one row for each method,
    /// with the same seven t (or --sheet N) as columns
    #[arg(long, conflicts_with_all = ["at", "frames", "frames_range", "fps", "size", "method", "warp", "content"])]
    compare: bool,

    /// Map of all designs: a grid of blends with this many columns and rows
    #[arg(long, value_name = "COLUMNSxROWS", value_parser = grid, conflicts_with_all = ["at", "sheet", "compare", "frames", "frames_range", "fps", "preset", "aspect", "lines", "frame_margin", "captions"])]
    map: Option<[usize; 2]>,

    /// Layout of the designs on the map of --map [default: that of the project, or a polygon]
    #[arg(long, requires = "map", value_parser = one_of::<MapLayout>())]
    sites: Option<MapLayout>,

    /// Number of frames from start to end, evenly spaced in t [default: by the project's timing]
    #[arg(long, value_name = "N")]
    frames: Option<usize>,

    /// Write only the frames A to B-1, with the numbers that they have in the whole film
    #[arg(long, value_name = "A..B", value_parser = range)]
    frames_range: Option<Range<usize>>,

    /// Frames per second [default: 30, or that of the preset]
    #[arg(long)]
    fps: Option<f64>,

    /// Size in pixels [default: the shape of the design, 960 along the longer side]
    #[arg(long, value_name = "WxH")]
    size: Option<PixelSize>,

    #[command(flatten)]
    layout: LayoutArgs,

    /// Background colour: #rrggbb, or transparent [default: that of the project]
    #[arg(long, value_name = "COLOUR", value_parser = background)]
    ground: Option<BackgroundColour>,

    #[command(flatten)]
    method: MethodArgs,
}

#[derive(Debug, Args)]
#[command(next_help_heading = "Layout of images and animations")]
#[group(conflicts_with_all = ["sheet", "compare"])]
struct LayoutArgs {
    /// Shape, size and captions for a purpose: deck, post, story, page, or a preset saved in the
    /// window
    #[arg(long, value_name = "NAME", conflicts_with = "size", value_parser = preset)]
    preset: Option<PresetChoice>,

    /// Aspect ratio of the image
    #[arg(long, conflicts_with = "size", value_parser = one_of::<Aspect>())]
    aspect: Option<Aspect>,

    /// Pixels along the shorter side, for example 720, 1080 or 2160
    #[arg(long, value_name = "PIXELS", conflicts_with = "size")]
    lines: Option<u32>,

    /// Margin on all sides, as a fraction of the shorter side
    #[arg(long, value_name = "FRACTION", conflicts_with = "size", value_parser = margin)]
    frame_margin: Option<f64>,

    /// Show the names of the stops below the drawing, or of the designs if no stop has a name
    #[arg(long)]
    captions: bool,
}

impl LayoutArgs {
    /// Returns the layout that the flags request; `None` if no layout flag is given.
    fn layout(&self) -> Option<PictureLayout> {
        let is_requested = self.preset.is_some()
            || self.aspect.is_some()
            || self.lines.is_some()
            || self.frame_margin.is_some()
            || self.captions;
        let default_layout = || PictureLayout {
            aspect: Aspect::Original,
            ..PictureLayout::default()
        };
        let base = match &self.preset {
            None => default_layout(),
            Some(PresetChoice::BuiltIn(preset)) => preset.layout(),
            Some(PresetChoice::Saved(preset)) => preset.layout(),
        };
        is_requested.then(|| PictureLayout {
            aspect: self.aspect.unwrap_or(base.aspect),
            lines: self.lines.unwrap_or(base.lines),
            margin: self.frame_margin.unwrap_or(base.margin),
            has_captions: self.captions || base.has_captions,
        })
    }
}

/// Preset chosen by name.
#[derive(Clone, Debug)]
enum PresetChoice {
    /// One of the built-in presets.
    BuiltIn(LayoutPreset),
    /// A preset that was saved in the window.
    Saved(FilmPreset),
}

/// Parses the name of a preset.
fn preset(name: &str) -> Result<PresetChoice, String> {
    if let Ok(built_in) = LayoutPreset::of_key(name) {
        return Ok(PresetChoice::BuiltIn(built_in));
    }
    let saved = match FilmPresets::default_path() {
        Some(path) => {
            FilmPresets::read(&path).map_err(|error| format!("{}: {error}", path.display()))?
        }
        None => FilmPresets::default(),
    };
    let built_in = choice_keys::<LayoutPreset>().map(str::to_owned);
    let names: Vec<String> = built_in.chain(saved.0.keys().cloned()).collect();
    let chosen = saved.0.get(name).cloned().map(PresetChoice::Saved);
    chosen.ok_or_else(|| format!("use one of {}", names.join(", ")))
}

/// Parses a margin, as a fraction of the shorter side.
fn margin(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(fraction) if (0.0..=0.4).contains(&fraction) => Ok(fraction),
        _ => Err("use a fraction from 0 to 0.4, for example 0.05".to_owned()),
    }
}

impl RenderArgs {
    /// Returns the frame rate, from the flag, the preset or the default.
    fn fps(&self) -> f64 {
        let default = match &self.layout.preset {
            Some(PresetChoice::Saved(preset)) => f64::from(preset.fps),
            _ => 30.0,
        };
        self.fps.unwrap_or(default)
    }
}

/// Returns the help text of `--out`, with all supported extensions.
fn out_help() -> String {
    format!(
        "Output file: NAME{} (with --at, --sheet, --map or --compare), {}, name-####.png or a \
         folder (numbered images); with --at, NAME.json is the truss at this t",
        extension_list::<StillKind>(),
        extension_list::<FilmKind>()
    )
}

pub(super) fn run(args: &RenderArgs) -> Result<(), CliError> {
    let target = ExportTarget::of_path(&args.out).map_err(CliError::usage)?;
    if let (&[t], ExportTarget::Film(FilmKind::Lottie, path)) = (args.at.as_slice(), &target) {
        return write_truss_at(args, t, path);
    }
    let still_content = still_content(args, &target)?;
    let target = if still_content.is_none() {
        target.preferring_film()
    } else {
        target
    };
    // The flags are checked before the designs are read, which may take long.
    check_output_name(args, &target, still_content)?;
    let terminal = Terminal::new();
    let overall = OverallProgress::new(&terminal);
    let input = args.inputs.read(&args.method, &overall)?;
    let outputs = output_paths(args, &input.project, &target)?;
    input.files.check_outputs(outputs)?;
    if let (Some(StillContent::Map(grid)), ExportTarget::Still(kind, path)) =
        (still_content, &target)
    {
        let (drawing, notes) = draw_map(args, input, grid, &overall)?;
        write_still(&drawing, *kind, path).map_err(CliError::failed)?;
        drop(terminal);
        report_notes(notes);
        report_written(std::slice::from_ref(path));
        return Ok(());
    }
    let opened = input.open(&ProgressSpan::new(&overall, 0.0, 0.5))?;
    let writing = ProgressSpan::new(&overall, 0.5, 1.0);
    let written = match (target, still_content) {
        (ExportTarget::Still(kind, path), Some(content)) => {
            let drawing = draw_still(args, &opened, content, &writing)?;
            write_still(&drawing, kind, &path).map_err(CliError::failed)?;
            vec![path]
        }
        // Only films and numbered images remain, because `check_output_name` has refused all other
        // combinations of target and content.
        (target, _) => write_frames(args, &opened, target, &writing)?,
    };
    // Dropping the terminal clears the progress line before the message is printed.
    drop(terminal);
    let segments = opened.sequence.segments().iter();
    let built = segments.flat_map(|segment| segment.notes().iter().map(ToString::to_string));
    report_notes(import_notes(&opened.loaded).chain(built));
    report_written(&written);
    Ok(())
}

/// Writes the truss at `t` as a design of its own.
fn write_truss_at(args: &RenderArgs, t: f64, path: &Path) -> Result<(), CliError> {
    if !t.is_finite() {
        return Err(not_finite(t));
    }
    let terminal = Terminal::new();
    let overall = OverallProgress::new(&terminal);
    let input = args.inputs.read(&args.method, &overall)?;
    input.files.check_outputs([path])?;
    let opened = input.open(&overall)?;
    structure::write_truss(&opened.sequence, t, path)?;
    drop(terminal);
    report_notes(import_notes(&opened.loaded));
    report_written(&[path.to_owned()]);
    Ok(())
}

/// Returns the error for a t that is not a number.
fn not_finite(t: f64) -> CliError {
    CliError::Usage(format!("--at {t} is invalid: t must be a finite number"))
}

/// Returns the notes on the import of all designs, each with the name of its design.
fn import_notes(loaded: &LoadedProject) -> impl Iterator<Item = String> {
    let designs = loaded.designs.iter();
    designs.flat_map(|design| {
        let named = |note: &ImportNote| format!("{}: {note}", design.name);
        design.notes.iter().map(named)
    })
}

/// Prints notes, each once: a design may take part in several transitions.
fn report_notes(notes: impl IntoIterator<Item = String>) {
    let mut printed = HashSet::new();
    for note in notes {
        if !printed.contains(&note) {
            output::message(&note);
            printed.insert(note);
        }
    }
}

/// Single image that the flags request.
#[derive(Clone, Copy)]
enum StillContent {
    /// The frame at a t.
    Frame(f64),
    /// A contact sheet with this number of frames.
    Sheet(usize),
    /// A comparison sheet: one row for each method, with this number of frames per row.
    Methods(usize),
    /// A map of all designs, with this number of columns and rows.
    Map([usize; 2]),
}

/// Returns whether a file name has a placeholder (`#`) for numbers.
fn is_numbered(path: &Path) -> bool {
    path.to_string_lossy().contains('#')
}

/// Returns the single image that the flags request; `None` for an animation or numbered images.
fn still_content(
    args: &RenderArgs,
    target: &ExportTarget,
) -> Result<Option<StillContent>, CliError> {
    let count = args.sheet.map(|count| count as usize);
    if let Some(t) = args.at.iter().find(|t| !t.is_finite()) {
        return Err(not_finite(*t));
    }
    if let Some(grid) = args.map {
        return Ok(Some(StillContent::Map(grid)));
    }
    match args.at.as_slice() {
        // With --at, images are numbered if several t are given or the name has a placeholder.
        at if matches!(target, ExportTarget::Numbered(_))
            && !args.out.is_dir()
            && (at.len() > 1 || (at.len() == 1 && is_numbered(&args.out))) =>
        {
            Ok(None)
        }
        &[t] => Ok(Some(StillContent::Frame(t))),
        [_, _, ..] => Err(CliError::Usage(format!(
            "--at has {} values: write name-####.svg for numbered images, or give one value",
            args.at.len()
        ))),
        [] if args.compare => Ok(Some(StillContent::Methods(
            count.unwrap_or(COMPARISON_COLUMNS),
        ))),
        [] => Ok(count.map(StillContent::Sheet)),
    }
}

/// Checks that the output file suits the flags.
fn check_output_name(
    args: &RenderArgs,
    target: &ExportTarget,
    content: Option<StillContent>,
) -> Result<(), CliError> {
    if content.is_some() && args.out.is_dir() {
        let (path, extensions) = (args.out.display(), extension_list::<StillKind>());
        return Err(CliError::Usage(format!(
            "`{path}` is a folder: name a file in it that ends in {extensions}"
        )));
    }
    let flags = match (target, content) {
        (ExportTarget::Still(_, path), None) => {
            return Err(CliError::Usage(format!(
                "`{0}` is a single image: add --at T for one moment or --sheet N for a contact sheet, or write name-####.{1} for numbered images",
                path.display(),
                path.extension().unwrap_or_default().to_string_lossy(),
            )));
        }
        (ExportTarget::Still(..), Some(_)) | (_, None) => return Ok(()),
        (_, Some(StillContent::Methods(_))) => "--compare makes",
        (_, Some(StillContent::Map(_))) => "--map makes",
        (_, Some(_)) => "--at and --sheet make",
    };
    let (path, extensions) = (args.out.display(), extension_list::<StillKind>());
    let message = format!("{flags} a single image: end `{path}` in {extensions}");
    Err(CliError::Usage(message))
}

/// Draws a single image.
fn draw_still(
    args: &RenderArgs,
    opened: &OpenedProject,
    content: StillContent,
    progress: &dyn Progress,
) -> Result<Drawing, CliError> {
    let project = &opened.loaded.project;
    let (sequence, style) = (&opened.sequence, &project.style);
    let background = background_of(args, project);
    let times = |count| even_times(project.timing.from, project.timing.to, count);
    Ok(match content {
        StillContent::Frame(t) => {
            // The image is framed like the whole film, so that all images of a project have the
            // same scale.
            let framing_times: Vec<f64> = times(17).into_iter().chain([t]).collect();
            camera(args, opened, &framing_times, false)?.draw(t)
        }
        StillContent::Sheet(count) => {
            let times = times(count);
            let bounds = framing(sequence, &times);
            contact_sheet(sequence, style, &times, bounds, args.size, background)
        }
        StillContent::Methods(_) if project.is_sequence() || project.follows_path() => {
            return Err(CliError::Usage(
                "--compare needs exactly two designs: name the two whose methods you want to see"
                    .to_owned(),
            ));
        }
        StillContent::Map(grid) => {
            let input = args.inputs.read(&args.method, progress)?;
            draw_map(args, input, grid, progress)?.0
        }
        StillContent::Methods(count) => {
            let spec = opened.loaded.spec().map_err(CliError::failed)?;
            let rows = MethodRow::all(&spec, progress).map_err(CliError::failed)?;
            comparison_sheet(&rows, style, &times(count), background).map_err(CliError::failed)?
        }
    })
}

/// Draws the map of all designs. Also returns the notes of the designs and of the space.
fn draw_map(
    args: &RenderArgs,
    input: InputProject<'_>,
    grid: [usize; 2],
    progress: &dyn Progress,
) -> Result<(Drawing, Vec<String>), CliError> {
    let (loaded, space, _) = input.open_space(progress)?;
    let map = match args.sites {
        Some(layout) => {
            WeightMap::new(&layout.sites(space.distances())).map_err(CliError::failed)?
        }
        None => loaded.map_of(&space).map_err(CliError::failed)?,
    };
    let background = background_of(args, &loaded.project);
    let style = &loaded.project.style;
    let drawing = map_sheet(&space, &map, style, grid, args.size, background);
    let notes = space.notes().iter().map(ToString::to_string);
    Ok((drawing, import_notes(&loaded).chain(notes).collect()))
}

/// Writes a film or numbered images; returns the paths of the written files.
fn write_frames(
    args: &RenderArgs,
    opened: &OpenedProject,
    target: ExportTarget,
    progress: &dyn Progress,
) -> Result<Vec<PathBuf>, CliError> {
    let full_film = full_film(args, &opened.loaded.project, &target)?;
    let rendered = rendered_frames(args, &full_film)?;
    let is_video = matches!(target, ExportTarget::Film(kind, _) if kind.is_video());
    // The view contains the whole film, so that ranges of frames rendered separately fit together.
    let camera = camera(args, opened, full_film.times(), is_video)?;
    if args.size.is_some_and(|size| size != camera.view.size()) {
        output::message(&format!(
            "videos need even sides: using {} pixels",
            camera.view.size()
        ));
    }
    write_film(&camera, &rendered, &target, progress).map_err(|error| match error {
        // These two errors mean that the flags do not fit the output type. All other errors mean
        // that the export failed.
        ExportError::GifRate(_) | ExportError::Mp4Transparent => CliError::usage(error),
        error => CliError::failed(error),
    })
}

/// Returns the paths of the files that are going to be written.
fn output_paths(
    args: &RenderArgs,
    project: &Project,
    target: &ExportTarget,
) -> Result<Vec<PathBuf>, CliError> {
    Ok(match target {
        ExportTarget::Still(_, path) | ExportTarget::Film(_, path) => vec![path.clone()],
        ExportTarget::Numbered(names) => {
            let film = rendered_frames(args, &full_film(args, project, target)?)?;
            let numbers = film.first_number()..film.first_number() + film.times().len();
            numbers.map(|number| names.path(number)).collect()
        }
    })
}

/// Returns the frames that `--frames-range` selects, or else the whole film.
fn rendered_frames(args: &RenderArgs, full_film: &FilmSpec) -> Result<FilmSpec, CliError> {
    match &args.frames_range {
        Some(range) => full_film
            .frame_range(range.clone())
            .map_err(CliError::usage),
        None => Ok(full_film.clone()),
    }
}

/// Returns the film with all its frames, before `--frames-range` selects some of them.
fn full_film(
    args: &RenderArgs,
    project: &Project,
    target: &ExportTarget,
) -> Result<FilmSpec, CliError> {
    let mut timing = project.timing;
    if matches!(target, ExportTarget::Numbered(_)) {
        timing.play = PlayMode::Once;
    }
    let film = match args.frames {
        _ if !args.at.is_empty() => FilmSpec::at_times(args.at.clone(), args.fps()),
        None => FilmSpec::of_timing(&timing, &project.stops, args.fps()),
        Some(count) => FilmSpec::evenly(timing.from, timing.to, count, args.fps())
            .map(|film| film.with_play_mode(timing.play)),
    };
    let film = film.map_err(CliError::usage)?;
    Ok(film.with_title(&project.title))
}

/// Returns a camera whose view contains the sequence at all of the given times.
///
/// If `is_even`, rounds the sides of the image up to even numbers of pixels, as videos require.
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
        ground: background_of(args, project),
        captions: has_captions.then(|| captions(args, opened)),
    })
}

fn captions(args: &RenderArgs, opened: &OpenedProject) -> Captions {
    let project = &opened.loaded.project;
    let names = opened.loaded.stop_names();
    let background = background_of(args, project).unwrap_or(project.style.ground);
    Captions::new(&project.stops, names, background)
}

/// Returns the background colour, from the flag or the project; `None` for transparent.
fn background_of(args: &RenderArgs, project: &Project) -> Option<Rgb> {
    let requested = args.ground.map(|BackgroundColour(colour)| colour);
    requested.unwrap_or(Some(project.style.ground))
}

/// Prints which files were written.
fn report_written(written: &[PathBuf]) {
    match written {
        [] => {}
        [one] => output::message(&format!("wrote {}", one.display())),
        [first, .., last] => output::message(&format!(
            "wrote {} files, {} to {}",
            written.len(),
            first.display(),
            last.display()
        )),
    }
}
