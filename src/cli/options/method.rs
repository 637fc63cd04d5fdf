//! Flags of what moves: the method, its cell, the warps.

use clap::Args;

use crate::content::ContentKind;
use crate::correspondence::{LinePair, PointPair};
use crate::project::Project;
use crate::settings::choice::named;
use crate::transition::{BuildQuality, CollisionAvoidance, DesignFit};
use crate::warp::homotopy::Homotopy;
use crate::warp::{
    ArapOptions, ArapPath, FaceWeights, FeatureTravel, PathOptions, VertexPath, WarpKind,
};

use super::super::error::CliError;
use super::super::value_parsers::{line, one_of, pin, set, weights};

/// The paper's two methods, which are cells of the table of warps and contents,
/// or the one whose film is less trouble.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum MethodFlag {
    Arap,
    Field,
    Auto,
}

named! { MethodFlag {
    Arap: "arap", "Rigid parts", "Rigid parts: meshes and trusses move as rigidly as possible";
    Field: "field", "Distance fields", "Distance fields: any two outlines";
    Auto: "auto", "Auto", "Both, and fields that parts carry: the film with the least trouble";
} }

impl MethodFlag {
    /// None of what is chosen once the films are known.
    fn kinds(self) -> Option<(WarpKind, ContentKind)> {
        match self {
            Self::Arap => Some((WarpKind::Arap, ContentKind::Solid)),
            Self::Field => Some((WarpKind::None, ContentKind::Field)),
            Self::Auto => None,
        }
    }
}

#[derive(Debug, Args)]
#[command(next_help_heading = "Method")]
pub(super) struct PlacingArgs {
    /// How the designs are blended [default: what suits them]
    #[arg(long, value_parser = one_of::<MethodFlag>())]
    method: Option<MethodFlag>,

    /// How the target is laid over the source
    #[arg(long, value_parser = one_of::<DesignFit>())]
    fit: Option<DesignFit>,

    /// How much is tried for a film of outlines as rigid parts [default: best]
    #[arg(long, value_parser = one_of::<BuildQuality>())]
    quality: Option<BuildQuality>,

    /// What is done where that film folds or its outlines meet [default: guarded]
    #[arg(long, value_parser = one_of::<CollisionAvoidance>())]
    guard: Option<CollisionAvoidance>,

    /// Width of a truss's bars, as a fraction of the design's diameter
    #[arg(long, value_name = "FRACTION")]
    bar_width: Option<f64>,
}

impl PlacingArgs {
    /// Whether the films decide on the method.
    pub(super) fn is_auto(&self) -> bool {
        self.method == Some(MethodFlag::Auto)
    }

    pub(super) fn edit(&self, project: &mut Project) {
        let kinds = self.method.map(MethodFlag::kinds);
        set(
            &mut project.warp,
            kinds.map(|kinds| kinds.map(|(warp, _)| warp)),
        );
        set(
            &mut project.content,
            kinds.map(|kinds| kinds.map(|(_, content)| content)),
        );
        set(&mut project.fit, self.fit);
        set(&mut project.options.quality, self.quality);
        set(&mut project.options.guard, self.guard);
        set(&mut project.options.bar_width, self.bar_width);
    }
}

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
    #[arg(long, value_parser = one_of::<FeatureTravel>())]
    travel: Option<FeatureTravel>,
}

impl CellArgs {
    /// Adds to the project's pins and lines, as a flag that is given twice adds to itself.
    pub(super) fn edit(&self, project: &mut Project) -> Result<(), CliError> {
        if project.is_sequence() && !(self.pin.is_empty() && self.line.is_empty()) {
            return Err(CliError::Usage(
                "--pin and --line are of two designs, and here are more: set them in the window, \
                 for each two of them"
                    .to_owned(),
            ));
        }
        set(&mut project.warp, self.warp.map(Some));
        set(&mut project.content, self.content.map(Some));
        set(&mut project.options.travel, self.travel);
        project.options.matching.pins.extend(&self.pin);
        project.options.matching.lines.extend(&self.line);
        Ok(())
    }
}

#[derive(Debug, Args)]
#[command(next_help_heading = "Rigid parts (arap)")]
pub(super) struct ArapArgs {
    /// The path of each face's local map
    #[arg(long, value_parser = one_of::<Homotopy>())]
    homotopy: Option<Homotopy>,

    /// What each face weighs: area, uniform, or numbers, one a face
    #[arg(long, value_name = "area|uniform|W,W,...", value_parser = weights)]
    weights: Option<FaceWeights>,

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

impl ArapArgs {
    pub(super) fn edit(&self, arap: &mut ArapOptions) {
        set(&mut arap.homotopy, self.homotopy);
        set(&mut arap.weights, self.weights.clone());
        set(&mut arap.symmetric, self.symmetric.then_some(true));
        set(&mut arap.symmetric, self.one_sided.then_some(false));
        set(&mut arap.extra_turns, self.extra_turns.clone());
        set(&mut arap.path, self.centroid.then_some(ArapPath::Centroid));
        set(&mut arap.path, self.pole.then_some(ArapPath::Pole));
        set(&mut arap.path, self.anchor.map(ArapPath::Anchor));
        set(&mut arap.subdivisions, self.subdivisions);
    }
}

#[derive(Debug, Args)]
#[command(next_help_heading = "Boundary paths (paths)")]
pub(super) struct PathArgs {
    /// The paths of boundary points: straight lines, or those that lengths and
    /// directions of the edges leave
    #[arg(long, value_parser = one_of::<VertexPath>())]
    path: Option<VertexPath>,
}

impl PathArgs {
    pub(super) fn edit(&self, paths: &mut PathOptions) {
        set(&mut paths.course, self.path);
    }
}
