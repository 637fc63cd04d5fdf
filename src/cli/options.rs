//! Every option of a method as a flag, shared by `render`, `check` and `new`.
//!
//! A flag that is not given leaves the project as it is. Names of choices are
//! those of the project file, read from the same tables.

use clap::Args;

use crate::colour::Rgb;
use crate::content::{BlendSpace, ContentKind};
use crate::correspondence::{LinePair, PointPair};
use crate::field::Metric;
use crate::homotopy::Homotopy;
use crate::measure::auto;
use crate::names::named;
use crate::progress::{Progress, Several, Span};
use crate::project::{LoadedProject, Project};
use crate::transition::{
    Boundary, Cell, Ease, Easing, Fit, Guarding, Options, PaintRule, PlayMode, Quality, Sequence,
    Transition,
};
use crate::warp::{ArapPath, Course, Travel, WarpKind, Weights};

use super::error::CliError;
use super::values::{line, one_of, pin, set, weights};

/// The paper's two methods, which are cells of the table of warps and contents,
/// or the one whose film is less trouble.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Method {
    Arap,
    Field,
    Auto,
}

named! { Method {
    Arap: "arap", "Rigid parts", "Rigid parts: meshes and trusses move as rigidly as possible";
    Field: "field", "Distance fields", "Distance fields: any two outlines";
    Auto: "auto", "Auto", "Both, and fields that parts carry: the film with the least trouble";
} }

impl Method {
    /// None of what is chosen once the films are known.
    fn kinds(self) -> Option<(WarpKind, ContentKind)> {
        match self {
            Self::Arap => Some((WarpKind::Arap, ContentKind::Solid)),
            Self::Field => Some((WarpKind::None, ContentKind::Field)),
            Self::Auto => None,
        }
    }
}

/// Flags that change a project.
#[derive(Debug, Args)]
pub(super) struct MethodArgs {
    /// Begin what takes longer than ten seconds, or more than two gibibytes, too
    #[arg(long)]
    pub patient: bool,

    #[command(flatten)]
    placing: PlacingArgs,
    #[command(flatten)]
    cell: CellArgs,
    #[command(flatten)]
    arap: ArapArgs,
    #[command(flatten)]
    paths: PathArgs,
    #[command(flatten)]
    field: FieldArgs,
    #[command(flatten)]
    colours: ColourArgs,
    #[command(flatten)]
    import: ImportArgs,
    #[command(flatten)]
    timing: TimingArgs,
    #[command(flatten)]
    style: StyleArgs,
}

#[derive(Debug, Args)]
#[command(next_help_heading = "Method")]
struct PlacingArgs {
    /// How the designs are blended [default: what suits them]
    #[arg(long, value_parser = one_of::<Method>())]
    method: Option<Method>,

    /// How the target is laid over the source
    #[arg(long, value_parser = one_of::<Fit>())]
    fit: Option<Fit>,

    /// How much is tried for a film of outlines as rigid parts [default: best]
    #[arg(long, value_parser = one_of::<Quality>())]
    quality: Option<Quality>,

    /// What is done where that film folds or its outlines meet [default: guarded]
    #[arg(long, value_parser = one_of::<Guarding>())]
    guard: Option<Guarding>,

    /// Width of a truss's bars, as a fraction of the design's diameter
    #[arg(long, value_name = "FRACTION")]
    bar_width: Option<f64>,
}

#[derive(Debug, Args)]
#[command(next_help_heading = "Warp and content")]
struct CellArgs {
    /// What moves: a row of the table
    #[arg(long, conflicts_with = "method", value_parser = one_of::<WarpKind>())]
    warp: Option<WarpKind>,

    /// What is seen: a column of the table
    #[arg(long, conflicts_with = "method", value_parser = one_of::<ContentKind>())]
    content: Option<ContentKind>,

    /// A point of the source and the same point of the target, in their own
    /// units, y up; may be given many times
    #[arg(long, value_name = "X,Y:X,Y", value_parser = pin, allow_hyphen_values = true)]
    pin: Vec<PointPair>,

    /// A line of the source, from end to end, and the same line of the target;
    /// may be given many times
    #[arg(long, value_name = "X,Y,X,Y:X,Y,X,Y", value_parser = line, allow_hyphen_values = true)]
    line: Vec<LinePair>,

    /// How pins and lines travel: turning as a whole, or each straight; auto
    /// is whole for fields
    #[arg(long, value_parser = one_of::<Travel>())]
    travel: Option<Travel>,
}

#[derive(Debug, Args)]
#[command(next_help_heading = "Boundary paths (paths)")]
struct PathArgs {
    /// The paths of boundary points: straight lines, or those that lengths and
    /// directions of the edges leave
    #[arg(long, value_parser = one_of::<Course>())]
    path: Option<Course>,
}

#[derive(Debug, Args)]
#[command(next_help_heading = "Colours")]
struct ColourArgs {
    /// How the mix of two pictures runs over t
    #[arg(long, value_parser = one_of::<Easing>())]
    mix: Option<Easing>,

    /// The t at which the source begins to give way
    #[arg(long, value_name = "T")]
    mix_from: Option<f64>,

    /// The t from which on only the target is seen
    #[arg(long, value_name = "T")]
    mix_to: Option<f64>,
}

#[derive(Debug, Args)]
#[command(next_help_heading = "Rigid parts (arap)")]
struct ArapArgs {
    /// The path of each face's local map
    #[arg(long, value_parser = one_of::<Homotopy>())]
    homotopy: Option<Homotopy>,

    /// What each face weighs: area, uniform, or numbers, one a face
    #[arg(long, value_name = "area|uniform|W,W,...", value_parser = weights)]
    weights: Option<Weights>,

    /// The symmetric energy: swapped designs give the film backwards
    #[arg(long, overrides_with = "one_sided")]
    symmetric: bool,

    /// The paper's energy, on the source alone
    #[arg(long)]
    one_sided: bool,

    /// Whole extra turns of each part, in order
    #[arg(
        long,
        value_name = "N,N,...",
        value_delimiter = ',',
        allow_hyphen_values = true
    )]
    extra_turns: Option<Vec<i32>>,

    /// Let the centroid run straight from source to target
    #[arg(long, conflicts_with_all = ["anchor", "pole"])]
    centroid: bool,

    /// Let the whole turn about its pole, the point that stays where it is, on an arc
    #[arg(long, conflicts_with = "anchor")]
    pole: bool,

    /// Let this vertex (counted from 0) run straight instead of the centroid
    #[arg(long, value_name = "VERTEX")]
    anchor: Option<u32>,

    /// How often every triangle is split into four
    #[arg(long, value_name = "N")]
    subdivisions: Option<u32>,
}

#[derive(Debug, Args)]
#[command(next_help_heading = "Distance fields (field)")]
struct FieldArgs {
    /// How distance is measured
    #[arg(long, value_parser = one_of::<Metric>())]
    metric: Option<Metric>,

    /// Where the boundary runs: on the outline, or between cells as in the paper
    #[arg(long, value_parser = one_of::<Boundary>())]
    boundary: Option<Boundary>,

    /// Whether logarithms of distances are blended, or distances
    #[arg(long, value_parser = one_of::<BlendSpace>())]
    space: Option<BlendSpace>,

    /// Where the logarithm bends, in cells
    #[arg(long, value_name = "CELLS")]
    epsilon: Option<f64>,

    /// How deep inside is drawn, in cells; below 0 thickens
    #[arg(long, value_name = "CELLS", allow_negative_numbers = true)]
    threshold: Option<f64>,

    /// Cells along the longer side of the frame
    #[arg(long, value_name = "N")]
    cells: Option<u32>,

    /// Room around the designs, as a fraction of the longer side
    #[arg(long, value_name = "FRACTION")]
    margin: Option<f64>,
}

#[derive(Debug, Args)]
#[command(next_help_heading = "Reading designs")]
struct ImportArgs {
    /// The tone at which a picture's boundary runs, 1 to 255
    #[arg(long, value_name = "TONE")]
    image_threshold: Option<u8>,

    /// Take a picture's ground for the figure
    #[arg(long)]
    invert: bool,

    /// Leave out islands and holes of fewer pixels than this
    #[arg(long, value_name = "PIXELS")]
    specks: Option<u32>,

    /// How far an outline may run from the exact one, as a fraction of the longer side
    #[arg(long, value_name = "FRACTION")]
    tolerance: Option<f64>,

    /// Take each flat colour of a picture for a part of its own
    #[arg(long)]
    colours: bool,

    /// Leave a drawing's strokes out of the figure that it makes
    #[arg(long)]
    no_strokes: bool,
}

#[derive(Debug, Args)]
#[command(next_help_heading = "Timing")]
struct TimingArgs {
    /// Where the film begins; below 0 and above 1 extrapolate
    #[arg(long, value_name = "T", allow_negative_numbers = true)]
    from: Option<f64>,

    /// Where the film ends
    #[arg(long, value_name = "T", allow_negative_numbers = true)]
    to: Option<f64>,

    /// Seconds of one pass, rests not counted
    #[arg(long, value_name = "SECONDS")]
    duration: Option<f64>,

    /// Seconds of rest at each end
    #[arg(long, value_name = "SECONDS")]
    hold: Option<f64>,

    /// How t runs between stops: linear, smooth, ease-in, ease-out, or a curve with two handles
    #[arg(long, value_name = "NAME|X1,Y1,X2,Y2")]
    easing: Option<Ease>,

    /// What happens at the end of a pass
    #[arg(long, value_parser = one_of::<PlayMode>())]
    play: Option<PlayMode>,
}

#[derive(Debug, Args)]
#[command(next_help_heading = "Look")]
struct StyleArgs {
    /// Fill at t = 0
    #[arg(long, value_name = "#RRGGBB")]
    source_colour: Option<Rgb>,

    /// Fill at t = 1
    #[arg(long, value_name = "#RRGGBB")]
    target_colour: Option<Rgb>,

    /// Whose colours drawings are shown in
    #[arg(long, value_parser = one_of::<PaintRule>())]
    paint: Option<PaintRule>,

    /// Let what only one drawing has fade in or out
    #[arg(long)]
    fade: bool,

    /// The t at which parts change places that lie over each other otherwise
    #[arg(long, value_name = "T")]
    reorder_at: Option<f64>,

    /// Leave a truss's joints unmarked
    #[arg(long)]
    no_joints: bool,
}

impl MethodArgs {
    /// Builds what a project asks for; of several methods the one whose film is
    /// the least trouble, which the project then asks for.
    pub fn build(
        &self,
        loaded: &mut LoadedProject,
        progress: &dyn Progress,
    ) -> Result<Transition, CliError> {
        if !self.is_auto() {
            return loaded.build(progress).map_err(CliError::no_film);
        }
        let spec = loaded.spec().map_err(CliError::failed)?;
        let (transition, _) = auto(&spec, progress).map_err(CliError::not_built)?;
        loaded.project.warp = Some(transition.cell().warp());
        loaded.project.content = Some(transition.cell().content());
        Ok(transition)
    }

    /// As [`Self::build`], each leg of a sequence; of several methods that which most legs
    /// are the least trouble by.
    pub fn build_all(
        &self,
        loaded: &mut LoadedProject,
        progress: &dyn Progress,
    ) -> Result<Sequence, CliError> {
        if !(loaded.project.is_sequence() || loaded.project.follows_path()) {
            return Ok(self.build(loaded, progress)?.into());
        }
        if self.is_auto() {
            let best = most_often(loaded, &Span::new(progress, 0.0, 0.5))?;
            loaded.project.warp = Some(best.warp());
            loaded.project.content = Some(best.content());
        }
        let legs = loaded.legs();
        let shares = Several::new(progress, legs.len());
        let built = legs.iter().enumerate();
        let built = built.map(|(k, leg)| leg.build(&shares.part(k)).map_err(CliError::no_film));
        let built: Vec<_> = built.collect::<Result<_, CliError>>()?;
        let sequence = Sequence::new(built);
        let sequence = sequence.unwrap_or_else(|| unreachable!("a sequence has legs"));
        Ok(sequence.leading_back(loaded.project.leads_back()))
    }

    /// Whether the films decide on the method.
    pub fn is_auto(&self) -> bool {
        self.placing.method == Some(Method::Auto)
    }

    /// Changes what the flags name and leaves the rest.
    pub fn edit(&self, project: &mut Project) -> Result<(), CliError> {
        self.edit_cell(project);
        self.edit_features(project)?;
        self.edit_warps(&mut project.options);
        self.edit_contents(&mut project.options);
        self.edit_designs(project);
        self.edit_film(project);
        // A flag may be right by itself and wrong with what the project says.
        let timing = project.timing.check(&project.stops);
        timing.map_err(CliError::usage)?;
        project.options.colours.check().map_err(CliError::usage)?;
        project.options.matching.check().map_err(CliError::usage)?;
        project.options.coats.check().map_err(CliError::usage)?;
        project.options.arap.check().map_err(CliError::usage)
    }

    fn edit_cell(&self, project: &mut Project) {
        let given = &self.placing;
        let kinds = given.method.map(Method::kinds);
        set(
            &mut project.warp,
            kinds.map(|kinds| kinds.map(|(warp, _)| warp)),
        );
        set(
            &mut project.content,
            kinds.map(|kinds| kinds.map(|(_, content)| content)),
        );
        set(&mut project.fit, given.fit);
        set(&mut project.options.quality, given.quality);
        set(&mut project.options.guard, given.guard);
        set(&mut project.options.bar_width, given.bar_width);
        let given = &self.cell;
        // After the method: the parser lets nobody give both.
        set(&mut project.warp, given.warp.map(Some));
        set(&mut project.content, given.content.map(Some));
        set(&mut project.options.travel, given.travel);
    }

    /// Adds to the project's pins and lines, as a flag that is given twice adds to itself.
    fn edit_features(&self, project: &mut Project) -> Result<(), CliError> {
        let given = &self.cell;
        if project.is_sequence() && !(given.pin.is_empty() && given.line.is_empty()) {
            return Err(CliError::Usage(
                "--pin and --line are of two designs, and here are more: set them in the window, \
                 for each two of them"
                    .to_owned(),
            ));
        }
        project.options.matching.pins.extend(&given.pin);
        project.options.matching.lines.extend(&given.line);
        Ok(())
    }

    fn edit_warps(&self, options: &mut Options) {
        set(&mut options.paths.course, self.paths.path);
        let (arap, given) = (&mut options.arap, &self.arap);
        set(&mut arap.homotopy, given.homotopy);
        set(&mut arap.weights, given.weights.clone());
        set(&mut arap.symmetric, given.symmetric.then_some(true));
        set(&mut arap.symmetric, given.one_sided.then_some(false));
        set(&mut arap.extra_turns, given.extra_turns.clone());
        set(&mut arap.path, given.centroid.then_some(ArapPath::Centroid));
        set(&mut arap.path, given.pole.then_some(ArapPath::Pole));
        set(&mut arap.path, given.anchor.map(ArapPath::Anchor));
        set(&mut arap.subdivisions, given.subdivisions);
    }

    fn edit_contents(&self, options: &mut Options) {
        let (field, given) = (&mut options.field, &self.field);
        set(&mut field.metric, given.metric);
        set(&mut field.boundary, given.boundary);
        set(&mut field.blend.space, given.space);
        set(&mut field.blend.epsilon, given.epsilon);
        set(&mut field.blend.threshold, given.threshold);
        set(&mut field.cells, given.cells);
        set(&mut field.margin, given.margin);
        let (mix, given) = (&mut options.colours, &self.colours);
        set(&mut mix.curve, given.mix);
        set(&mut mix.from, given.mix_from);
        set(&mut mix.to, given.mix_to);
    }

    fn edit_designs(&self, project: &mut Project) {
        let given = &self.import;
        // A flag has no way to name one of them.
        for design in &mut project.designs {
            let import = &mut design.import;
            set(&mut import.threshold, given.image_threshold.map(Some));
            set(&mut import.invert, given.invert.then_some(true));
            set(&mut import.specks_px, given.specks);
            set(&mut import.tolerance, given.tolerance);
            set(&mut import.strokes, given.no_strokes.then_some(false));
            set(&mut import.colours, given.colours.then_some(true));
        }
    }

    fn edit_film(&self, project: &mut Project) {
        let (timing, given) = (&mut project.timing, &self.timing);
        set(&mut timing.from, given.from);
        set(&mut timing.to, given.to);
        set(&mut timing.duration_secs, given.duration);
        set(&mut timing.hold_secs, given.hold);
        set(&mut timing.easing, given.easing);
        set(&mut timing.play, given.play);
        let (style, given) = (&mut project.style, &self.style);
        set(&mut style.source, given.source_colour);
        set(&mut style.target, given.target_colour);
        set(&mut project.options.paint, given.paint);
        let coats = &mut project.options.coats;
        set(&mut coats.fade, given.fade.then_some(true));
        set(&mut coats.reorder_at, given.reorder_at);
        set(&mut style.joints, given.no_joints.then_some(false));
    }
}

/// The cell by which most legs have the film with the least trouble, each for itself; of
/// two the first that was found.
fn most_often(loaded: &LoadedProject, progress: &dyn Progress) -> Result<Cell, CliError> {
    let legs = loaded.legs();
    let shares = Several::new(progress, legs.len());
    let mut counts: Vec<(Cell, usize)> = Vec::new();
    for (k, leg) in legs.iter().enumerate() {
        let spec = leg.spec().map_err(CliError::failed)?;
        let (transition, _) = auto(&spec, &shares.part(k)).map_err(CliError::not_built)?;
        let cell = transition.cell();
        match counts.iter_mut().find(|(known, _)| *known == cell) {
            Some((_, count)) => *count += 1,
            None => counts.push((cell, 1)),
        }
    }
    let best = counts.into_iter().rev().max_by_key(|(_, count)| *count);
    Ok(best.map_or(Cell::RIGID_PARTS, |(cell, _)| cell))
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::{CommandFactory, Parser};

    #[derive(Debug, Parser)]
    struct Alone {
        #[command(flatten)]
        method: MethodArgs,
    }

    fn edited(flags: &str) -> Result<Project, CliError> {
        let words = std::iter::once("x").chain(flags.split_whitespace());
        let alone = Alone::try_parse_from(words).map_err(CliError::usage)?;
        let mut project = Project::pair("a.svg", "b.svg");
        alone.method.edit(&mut project)?;
        Ok(project)
    }

    #[test]
    fn every_listed_name_is_one_of_the_project_file() {
        for argument in Alone::command().get_arguments() {
            let flag = argument.get_long().unwrap_or_default();
            for value in argument.get_possible_values() {
                let flags = format!("--{flag} {}", value.get_name());
                let takes_value = argument.get_action().takes_values();
                assert!(!takes_value || edited(&flags).is_ok(), "{flags}");
            }
        }
    }

    #[test]
    fn no_flag_changes_nothing() {
        let project = Project::pair("a.svg", "b.svg");
        assert_eq!(edited("").expect("edited"), project);
    }

    #[test]
    fn flags_reach_their_options() {
        let project = edited(
            "--method field --fit same-area --quality draft --guard plain --bar-width 0.02 --homotopy exponential \
             --weights 1,2.5 --one-sided --extra-turns 0,-1 --anchor 3 --subdivisions 1 \
             --metric chessboard --boundary binary --space real --epsilon 2 --threshold -1.5 \
             --cells 64 --margin 0.2 --path straight",
        )
        .expect("edited");
        assert_eq!(
            (project.warp, project.content),
            (Some(WarpKind::None), Some(ContentKind::Field))
        );
        assert_eq!(
            (project.fit, project.options.bar_width),
            (Fit::SameArea, 0.02)
        );
        assert_eq!(project.options.quality, Quality::Draft);
        assert_eq!(project.options.guard, Guarding::Plain);
        assert_eq!(project.options.arap.homotopy, Homotopy::Exponential);
        assert_eq!(
            project.options.arap.weights,
            Weights::PerFace(vec![1.0, 2.5])
        );
        assert_eq!(
            (
                project.options.arap.symmetric,
                project.options.arap.subdivisions
            ),
            (false, 1)
        );
        assert_eq!(project.options.arap.extra_turns, [0, -1]);
        assert_eq!(project.options.arap.path, ArapPath::Anchor(3));
        assert_eq!(project.options.field.metric, Metric::Chessboard);
        assert_eq!(project.options.field.boundary, Boundary::Binary);
        assert_eq!(project.options.field.blend.space, BlendSpace::Real);
        assert_eq!(
            (
                project.options.field.blend.epsilon,
                project.options.field.blend.threshold
            ),
            (2.0, -1.5)
        );
        assert_eq!(
            (project.options.field.cells, project.options.field.margin),
            (64, 0.2)
        );
        assert_eq!(project.options.paths.course, Course::Straight);
    }

    #[test]
    fn flags_reach_import_timing_and_style() {
        let project = edited(
            "--image-threshold 99 --invert --specks 4 --tolerance 0.01 --no-strokes --colours \
             --from -0.5 --to 1.5 --duration 3 --hold 0 --easing ease-in --play loop \
             --source-colour #010203 --target-colour #040506 --no-joints --paint one \
             --fade --reorder-at 0.3",
        )
        .expect("edited");
        let import = project.designs[1].import;
        assert_eq!((import.threshold, import.invert), (Some(99), true));
        assert_eq!((import.specks_px, import.tolerance), (4, 0.01));
        assert!(!import.strokes && import.colours);
        assert_eq!((project.timing.from, project.timing.to), (-0.5, 1.5));
        assert_eq!(
            (project.timing.duration_secs, project.timing.hold_secs),
            (3.0, 0.0)
        );
        assert_eq!(
            (project.timing.easing, project.timing.play),
            (Easing::EaseIn.into(), PlayMode::Loop)
        );
        assert_eq!(project.style.source, Rgb([1, 2, 3]));
        assert_eq!(
            (project.style.target, project.style.joints),
            (Rgb([4, 5, 6]), false)
        );
        assert_eq!(project.options.paint, PaintRule::One);
        let coats = project.options.coats;
        assert!(coats.fade && coats.reorder_at == 0.3);
    }

    #[test]
    fn nonsense_is_wrong_use() {
        for flags in [
            "--homotopy cubic",
            "--weights 1,x",
            "--duration 0",
            "--to 0",
            "--source-colour red",
            "--anchor 1 --centroid",
        ] {
            assert!(matches!(edited(flags), Err(CliError::Usage(_))), "{flags}");
        }
    }
}
