//! Flags for import, distance fields, colour mixing, timing and style.

use clap::Args;

use crate::colour::Rgb;
use crate::content::{BlendSpace, ColourMix};
use crate::design::PictureReading;
use crate::field::Metric;
use crate::project::Project;
use crate::transition::{
    EasingFunction, FieldBoundary, FieldOptions, NamedEasing, PaintRule, PlayMode, Timing,
};

use super::super::value_parsers::{one_of, set_if_given};

#[derive(Debug, Args)]
#[command(next_help_heading = "Import")]
pub(super) struct ImportArgs {
    /// Grey level (or opacity) at which a picture's outline runs, 1 to 255 [default: automatic]
    #[arg(long, value_name = "TONE")]
    image_threshold: Option<u8>,

    /// Property of the pixels that separates the figure of a picture from its background [default:
    /// auto]
    #[arg(long, value_parser = one_of::<PictureReading>())]
    reading: Option<PictureReading>,

    /// Swap figure and background of pictures
    #[arg(long)]
    invert: bool,

    /// Ignore spots and holes with fewer pixels than this
    #[arg(long, value_name = "PIXELS")]
    specks: Option<u32>,

    /// Allowed deviation of an imported outline from the exact boundary, as a fraction of the
    /// longer side of the picture or page
    #[arg(long, value_name = "FRACTION")]
    tolerance: Option<f64>,

    /// Import each flat colour of a picture as a separate part
    #[arg(long)]
    colours: bool,

    /// Ignore strokes when a drawing is imported as a silhouette
    #[arg(long)]
    no_strokes: bool,
}

impl ImportArgs {
    /// Applies the flags to all designs, because a flag cannot name a single one.
    pub(super) fn edit(&self, project: &mut Project) {
        for design in &mut project.designs {
            let import = &mut design.import;
            set_if_given(&mut import.threshold, self.image_threshold.map(Some));
            set_if_given(&mut import.reading, self.reading);
            set_if_given(&mut import.invert, self.invert.then_some(true));
            set_if_given(&mut import.specks_px, self.specks);
            set_if_given(&mut import.tolerance, self.tolerance);
            set_if_given(&mut import.strokes, self.no_strokes.then_some(false));
            set_if_given(&mut import.colours, self.colours.then_some(true));
        }
    }
}

#[derive(Debug, Args)]
#[command(next_help_heading = "Distance fields (field)")]
pub(super) struct FieldArgs {
    /// Metric in which distances are measured
    #[arg(long, value_parser = one_of::<Metric>())]
    metric: Option<Metric>,

    /// Position of the boundary: on the outline itself, or between grid cells, in steps
    #[arg(long, value_parser = one_of::<FieldBoundary>())]
    boundary: Option<FieldBoundary>,

    /// Scale on which distances are blended: logarithmic or linear
    #[arg(long, value_parser = one_of::<BlendSpace>())]
    space: Option<BlendSpace>,

    /// Distance in cells below which the logarithmic scale is nearly linear, greater than 0
    #[arg(long, value_name = "CELLS")]
    epsilon: Option<f64>,

    /// Distance that is drawn as the outline, in cells; values below 0 thicken the shape
    #[arg(long, value_name = "CELLS", allow_negative_numbers = true)]
    threshold: Option<f64>,

    /// Number of grid cells along the longer side of the frame
    #[arg(long, value_name = "N")]
    cells: Option<u32>,

    /// Margin around the designs, as a fraction of their longer side
    #[arg(long, value_name = "FRACTION")]
    margin: Option<f64>,
}

impl FieldArgs {
    pub(super) fn edit(&self, field: &mut FieldOptions) {
        set_if_given(&mut field.metric, self.metric);
        set_if_given(&mut field.boundary, self.boundary);
        set_if_given(&mut field.blend.space, self.space);
        set_if_given(&mut field.blend.epsilon, self.epsilon);
        set_if_given(&mut field.blend.threshold, self.threshold);
        set_if_given(&mut field.cells, self.cells);
        set_if_given(&mut field.margin, self.margin);
    }
}

#[derive(Debug, Args)]
#[command(next_help_heading = "Colours")]
pub(super) struct ColourArgs {
    /// Easing of the transition between the colours of two pictures
    #[arg(long, value_parser = one_of::<NamedEasing>())]
    mix: Option<NamedEasing>,

    /// Value of t at which the target picture starts to appear
    #[arg(long, value_name = "T")]
    mix_from: Option<f64>,

    /// Value of t from which only the target picture is visible
    #[arg(long, value_name = "T")]
    mix_to: Option<f64>,
}

impl ColourArgs {
    pub(super) fn edit(&self, mix: &mut ColourMix) {
        set_if_given(&mut mix.curve, self.mix);
        set_if_given(&mut mix.from, self.mix_from);
        set_if_given(&mut mix.to, self.mix_to);
    }
}

#[derive(Debug, Args)]
#[command(next_help_heading = "Timing")]
pub(super) struct TimingArgs {
    /// Value of t at which the film starts; below 0 and above 1 the motion is extrapolated
    #[arg(long, value_name = "T", allow_negative_numbers = true)]
    from: Option<f64>,

    /// Value of t at which the film ends
    #[arg(long, value_name = "T", allow_negative_numbers = true)]
    to: Option<f64>,

    /// Duration from start to end without pauses, in seconds
    #[arg(long, value_name = "SECONDS")]
    duration: Option<f64>,

    /// Pause at each end, in seconds
    #[arg(long, value_name = "SECONDS")]
    hold: Option<f64>,

    /// Easing between stops: linear, smooth, ease-in, ease-out, or the handles of a Bézier curve
    #[arg(long, value_name = "NAME|X1,Y1,X2,Y2")]
    easing: Option<EasingFunction>,

    /// Behaviour at the end of the film
    #[arg(long, value_parser = one_of::<PlayMode>())]
    play: Option<PlayMode>,
}

impl TimingArgs {
    pub(super) fn edit(&self, timing: &mut Timing) {
        set_if_given(&mut timing.from, self.from);
        set_if_given(&mut timing.to, self.to);
        set_if_given(&mut timing.duration_secs, self.duration);
        set_if_given(&mut timing.hold_secs, self.hold);
        set_if_given(&mut timing.easing, self.easing);
        set_if_given(&mut timing.play, self.play);
    }
}

#[derive(Debug, Args)]
#[command(next_help_heading = "Appearance")]
pub(super) struct StyleArgs {
    /// Fill colour at t = 0
    #[arg(long, value_name = "#RRGGBB")]
    source_colour: Option<Rgb>,

    /// Fill colour at t = 1
    #[arg(long, value_name = "#RRGGBB")]
    target_colour: Option<Rgb>,

    /// Colours of the drawings, or one colour for each design
    #[arg(long, value_parser = one_of::<PaintRule>())]
    paint: Option<PaintRule>,

    /// Fade parts in or out that exist in only one drawing
    #[arg(long)]
    fade: bool,

    /// Value of t at which overlapping parts change their stacking order
    #[arg(long, value_name = "T")]
    reorder_at: Option<f64>,

    /// Do not draw the joints of trusses
    #[arg(long)]
    no_joints: bool,
}

impl StyleArgs {
    pub(super) fn edit(&self, project: &mut Project) {
        let style = &mut project.style;
        set_if_given(&mut style.source, self.source_colour);
        set_if_given(&mut style.target, self.target_colour);
        set_if_given(&mut style.joints, self.no_joints.then_some(false));
        let options = &mut project.options;
        set_if_given(&mut options.paint, self.paint);
        set_if_given(&mut options.coats.fade, self.fade.then_some(true));
        set_if_given(&mut options.coats.reorder_at, self.reorder_at);
    }
}
