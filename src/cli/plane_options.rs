//! Warps and colours as flags: which cell, its pins and lines, its paths.

use clap::Args;

use crate::content::ContentKind;
use crate::correspondence::{LinePair, PointPair};
use crate::easing::Easing;
use crate::project::Project;
use crate::warp::{Course, Travel, WarpKind};

use super::values::{line, one_of, pin, set};

#[derive(Debug, Args)]
#[command(next_help_heading = "Warp and content")]
pub(super) struct CellArgs {
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
pub(super) struct PathArgs {
    /// The paths of boundary points: straight lines, or those that lengths and
    /// directions of the edges leave
    #[arg(long, value_parser = one_of::<Course>())]
    path: Option<Course>,
}

#[derive(Debug, Args)]
#[command(next_help_heading = "Colours")]
pub(super) struct ColourArgs {
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

impl CellArgs {
    pub fn edit(&self, project: &mut Project) {
        set(&mut project.warp, self.warp.map(Some));
        set(&mut project.content, self.content.map(Some));
        set(&mut project.options.travel, self.travel);
        project.options.matching.pins.extend(&self.pin);
        project.options.matching.lines.extend(&self.line);
    }
}

impl PathArgs {
    pub fn edit(&self, project: &mut Project) {
        set(&mut project.options.paths.course, self.path);
    }
}

impl ColourArgs {
    pub fn edit(&self, project: &mut Project) {
        let mix = &mut project.options.colours;
        set(&mut mix.curve, self.mix);
        set(&mut mix.from, self.mix_from);
        set(&mut mix.to, self.mix_to);
    }
}
