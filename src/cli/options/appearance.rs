//! Flags of what is seen: how designs are read, contents, the film and its look.

use clap::Args;

use crate::colour::Rgb;
use crate::content::{BlendSpace, ColourMix};
use crate::field::Metric;
use crate::project::Project;
use crate::transition::{
    EasingFunction, FieldBoundary, FieldOptions, NamedEasing, PaintRule, PlayMode, Timing,
};

use super::super::value_parsers::{one_of, set};

#[derive(Debug, Args)]
#[command(next_help_heading = "Reading designs")]
pub(super) struct ImportArgs {
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

impl ImportArgs {
    /// Of all designs: a flag has no way to name one of them.
    pub(super) fn edit(&self, project: &mut Project) {
        for design in &mut project.designs {
            let import = &mut design.import;
            set(&mut import.threshold, self.image_threshold.map(Some));
            set(&mut import.invert, self.invert.then_some(true));
            set(&mut import.specks_px, self.specks);
            set(&mut import.tolerance, self.tolerance);
            set(&mut import.strokes, self.no_strokes.then_some(false));
            set(&mut import.colours, self.colours.then_some(true));
        }
    }
}

#[derive(Debug, Args)]
#[command(next_help_heading = "Distance fields (field)")]
pub(super) struct FieldArgs {
    /// How distance is measured
    #[arg(long, value_parser = one_of::<Metric>())]
    metric: Option<Metric>,

    /// Where the boundary runs: on the outline, or between cells as in the paper
    #[arg(long, value_parser = one_of::<FieldBoundary>())]
    boundary: Option<FieldBoundary>,

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

impl FieldArgs {
    pub(super) fn edit(&self, field: &mut FieldOptions) {
        set(&mut field.metric, self.metric);
        set(&mut field.boundary, self.boundary);
        set(&mut field.blend.space, self.space);
        set(&mut field.blend.epsilon, self.epsilon);
        set(&mut field.blend.threshold, self.threshold);
        set(&mut field.cells, self.cells);
        set(&mut field.margin, self.margin);
    }
}

#[derive(Debug, Args)]
#[command(next_help_heading = "Colours")]
pub(super) struct ColourArgs {
    /// How the mix of two pictures runs over t
    #[arg(long, value_parser = one_of::<NamedEasing>())]
    mix: Option<NamedEasing>,

    /// The t at which the source begins to give way
    #[arg(long, value_name = "T")]
    mix_from: Option<f64>,

    /// The t from which on only the target is seen
    #[arg(long, value_name = "T")]
    mix_to: Option<f64>,
}

impl ColourArgs {
    pub(super) fn edit(&self, mix: &mut ColourMix) {
        set(&mut mix.curve, self.mix);
        set(&mut mix.from, self.mix_from);
        set(&mut mix.to, self.mix_to);
    }
}

#[derive(Debug, Args)]
#[command(next_help_heading = "Timing")]
pub(super) struct TimingArgs {
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
    easing: Option<EasingFunction>,

    /// What happens at the end of a pass
    #[arg(long, value_parser = one_of::<PlayMode>())]
    play: Option<PlayMode>,
}

impl TimingArgs {
    pub(super) fn edit(&self, timing: &mut Timing) {
        set(&mut timing.from, self.from);
        set(&mut timing.to, self.to);
        set(&mut timing.duration_secs, self.duration);
        set(&mut timing.hold_secs, self.hold);
        set(&mut timing.easing, self.easing);
        set(&mut timing.play, self.play);
    }
}

#[derive(Debug, Args)]
#[command(next_help_heading = "Look")]
pub(super) struct StyleArgs {
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

impl StyleArgs {
    pub(super) fn edit(&self, project: &mut Project) {
        let style = &mut project.style;
        set(&mut style.source, self.source_colour);
        set(&mut style.target, self.target_colour);
        set(&mut style.joints, self.no_joints.then_some(false));
        let options = &mut project.options;
        set(&mut options.paint, self.paint);
        set(&mut options.coats.fade, self.fade.then_some(true));
        set(&mut options.coats.reorder_at, self.reorder_at);
    }
}
