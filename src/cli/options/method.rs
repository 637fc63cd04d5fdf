//! Flags for the method, warp and content, pins and lines, and the options of rigid parts and
//! boundary paths.

use clap::Args;

use crate::content::ContentKind;
use crate::correspondence::{LinePair, PointPair};
use crate::project::Project;
use crate::settings::named;
use crate::transition::{BuildQuality, CollisionAvoidance, DesignFit};
use crate::warp::homotopy::Homotopy;
use crate::warp::{
    ArapOptions, ArapPath, FaceWeights, FeatureTravel, PathOptions, VertexPath, WarpKind,
};

use super::super::error::CliError;
use super::super::value_parsers::{line, one_of, pin, set_if_given, weights};

/// Value of `--method`: rigid parts, distance fields, or the method with the fewest defects. The
/// first two are the methods of the paper "Design-Space Representation through Blended
/// Transitions".
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum MethodFlag {
    Arap,
    Field,
    Auto,
}

named! { MethodFlag {
    Arap: "arap", "Rigid parts", "Rigid parts: meshes and trusses move as rigidly as possible";
    Field: "field", "Distance fields", "Distance fields: blends any two outlines";
    Auto: "auto", "Auto",
        "Rigid parts, fields carried by them, or plain fields: the one with the fewest defects";
} }

impl MethodFlag {
    /// Returns the warp and the content of the method; `None` for `auto`, which chooses by rating
    /// the films.
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
    /// Method of blending [default: the one that suits the designs]
    #[arg(long, value_parser = one_of::<MethodFlag>())]
    method: Option<MethodFlag>,

    /// Alignment of the other designs with the first
    #[arg(long, value_parser = one_of::<DesignFit>())]
    fit: Option<DesignFit>,

    /// Number of matches tried for rigid parts: only the first, or several [default: best]
    #[arg(long, value_parser = one_of::<BuildQuality>())]
    quality: Option<BuildQuality>,

    /// Collision avoidance where rigid parts would fold or outlines would meet [default: guarded]
    #[arg(long, value_parser = one_of::<CollisionAvoidance>())]
    guard: Option<CollisionAvoidance>,

    /// Width of truss bars, as a fraction of the larger design's diameter
    #[arg(long, value_name = "FRACTION")]
    bar_width: Option<f64>,
}

impl PlacingArgs {
    /// Returns whether `--method auto` is given, with which the method is chosen by rating the
    /// resulting films.
    pub(super) fn is_auto(&self) -> bool {
        self.method == Some(MethodFlag::Auto)
    }

    pub(super) fn edit(&self, project: &mut Project) {
        let kinds = self.method.map(MethodFlag::kinds);
        set_if_given(
            &mut project.warp,
            kinds.map(|kinds| kinds.map(|(warp, _)| warp)),
        );
        set_if_given(
            &mut project.content,
            kinds.map(|kinds| kinds.map(|(_, content)| content)),
        );
        set_if_given(&mut project.fit, self.fit);
        set_if_given(&mut project.options.quality, self.quality);
        set_if_given(&mut project.options.guard, self.guard);
        set_if_given(&mut project.options.bar_width, self.bar_width);
    }
}

#[derive(Debug, Args)]
#[command(next_help_heading = "Warp and content")]
pub(super) struct CellArgs {
    /// Warp: the way in which points move from source to target
    #[arg(long, conflicts_with = "method", value_parser = one_of::<WarpKind>())]
    warp: Option<WarpKind>,

    /// Content: the kind of shape or image that is drawn
    #[arg(long, conflicts_with = "method", value_parser = one_of::<ContentKind>())]
    content: Option<ContentKind>,

    /// Corresponding points of source and target, in their own coordinates, y up;
    /// can be repeated
    #[arg(long, value_name = "X,Y:X,Y", value_parser = pin, allow_hyphen_values = true)]
    pin: Vec<PointPair>,

    /// Corresponding lines of source and target, each given by its two ends; can be
    /// repeated
    #[arg(long, value_name = "X,Y,X,Y:X,Y,X,Y", value_parser = line, allow_hyphen_values = true)]
    line: Vec<LinePair>,

    /// Motion of pins and lines: together as a rotation, or each straight; auto
    /// rotates for fields
    #[arg(long, value_parser = one_of::<FeatureTravel>())]
    travel: Option<FeatureTravel>,
}

impl CellArgs {
    /// Applies the flags; pins and lines are added to those of the project.
    pub(super) fn edit(&self, project: &mut Project) -> Result<(), CliError> {
        if project.is_sequence() && !(self.pin.is_empty() && self.line.is_empty()) {
            return Err(CliError::Usage(
                "--pin and --line need exactly two designs: with more, set pins and lines in the \
                 window"
                    .to_owned(),
            ));
        }
        set_if_given(&mut project.warp, self.warp.map(Some));
        set_if_given(&mut project.content, self.content.map(Some));
        set_if_given(&mut project.options.travel, self.travel);
        project.options.matching.pins.extend(&self.pin);
        project.options.matching.lines.extend(&self.line);
        Ok(())
    }
}

#[derive(Debug, Args)]
#[command(next_help_heading = "Rigid parts (arap)")]
pub(super) struct ArapArgs {
    /// Interpolation of each face's map from source to target
    #[arg(long, value_parser = one_of::<Homotopy>())]
    homotopy: Option<Homotopy>,

    /// Weight of each face: area, uniform, or one number for each face
    #[arg(long, value_name = "area|uniform|W,W,...", value_parser = weights)]
    weights: Option<FaceWeights>,

    /// Use the symmetric energy: swapping the designs gives the same film backwards
    #[arg(long, overrides_with = "one_sided")]
    symmetric: bool,

    /// Use the one-sided energy, in which only the source counts
    #[arg(long)]
    one_sided: bool,

    /// Extra full turns: one number for all parts, or one for each part, in the order of the parts'
    /// first faces
    #[arg(
        long,
        value_name = "N,N,...",
        value_delimiter = ',',
        allow_hyphen_values = true
    )]
    extra_turns: Option<Vec<i32>>,

    /// Move the centroid straight from source to target
    #[arg(long, conflicts_with_all = ["anchor", "pole"])]
    centroid: bool,

    /// Rotate the whole shape about its pole, the point that stays in place
    #[arg(long, conflicts_with = "anchor")]
    pole: bool,

    /// Move this vertex (counted from 0) straight instead of the centroid
    #[arg(long, value_name = "VERTEX")]
    anchor: Option<u32>,

    /// Number of times that each triangle is split into four
    #[arg(long, value_name = "N")]
    subdivisions: Option<u32>,
}

impl ArapArgs {
    pub(super) fn edit(&self, arap: &mut ArapOptions) {
        set_if_given(&mut arap.homotopy, self.homotopy);
        set_if_given(&mut arap.weights, self.weights.clone());
        set_if_given(&mut arap.symmetric, self.symmetric.then_some(true));
        set_if_given(&mut arap.symmetric, self.one_sided.then_some(false));
        set_if_given(&mut arap.extra_turns, self.extra_turns.clone());
        set_if_given(&mut arap.path, self.centroid.then_some(ArapPath::Centroid));
        set_if_given(&mut arap.path, self.pole.then_some(ArapPath::Pole));
        set_if_given(&mut arap.path, self.anchor.map(ArapPath::Anchor));
        set_if_given(&mut arap.subdivisions, self.subdivisions);
    }
}

#[derive(Debug, Args)]
#[command(next_help_heading = "Boundary paths (paths)")]
pub(super) struct PathArgs {
    /// Paths of boundary points: straight, or by interpolating lengths and directions of the
    /// edges
    #[arg(long, value_parser = one_of::<VertexPath>())]
    path: Option<VertexPath>,
}

impl PathArgs {
    pub(super) fn edit(&self, paths: &mut PathOptions) {
        set_if_given(&mut paths.course, self.path);
    }
}
