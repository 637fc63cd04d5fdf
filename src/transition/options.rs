//! The options of all methods, each once: a document holds them as they stand
//! in its file, a specification as a transition is built from them.

use super::paint_layer_options::PaintLayerOptions;
use super::part_time::PartTime;
use crate::compatible::PolygonOptions;
use crate::content::{ColourMix, FieldBlend};
use crate::correspondence::MatchSettings;
use crate::field::Metric;
use crate::settings::choice::named;
use crate::warp::{
    ArapOptions, FeatureTravel, LatticeOptions, LineOptions, PathOptions, ScatteredOptions,
};
use serde::{Deserialize, Serialize};

/// The options of all methods. What is not given has its default; defaults
/// are left out where most documents have no use for them.
///
/// ```
/// use morphospace::transition::Options;
/// let mut options = Options::default();
/// options.field.cells = 256;
/// assert_eq!(options.bar_width, 0.012);
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
#[non_exhaustive]
pub struct TransitionOptions {
    /// How the features of warps of the plane travel.
    #[serde(skip_serializing_if = "is_default")]
    pub travel: FeatureTravel,
    /// Width of the bars of a truss, as a fraction of the larger design's
    /// diameter.
    pub bar_width: f64,
    /// How outlines are matched: in a document in the coordinates of each
    /// design, in a specification in those of the common frame.
    #[serde(rename = "match", skip_serializing_if = "is_default")]
    pub matching: MatchSettings,
    /// Parts that make their way in their own time, as rigid parts.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub parts: Vec<PartTime>,
    /// Whether drawings are shown in their own colours.
    #[serde(skip_serializing_if = "is_default")]
    pub paint: PaintRule,
    /// How painted parts come and go.
    #[serde(skip_serializing_if = "is_default")]
    pub coats: PaintLayerOptions,
    /// How much is tried for a film of outlines.
    #[serde(skip_serializing_if = "is_default")]
    pub quality: BuildQuality,
    /// Whether that film keeps out of its own way.
    #[serde(skip_serializing_if = "is_default")]
    pub guard: CollisionAvoidance,
    /// How matched outlines are triangulated.
    #[serde(skip_serializing_if = "is_default")]
    pub triangulation: PolygonOptions,
    /// Options of rigid parts.
    pub arap: ArapOptions,
    /// Options of the boundary paths.
    #[serde(skip_serializing_if = "is_default")]
    pub paths: PathOptions,
    /// Options of distance fields.
    pub field: FieldOptions,
    /// How two pictures mix.
    #[serde(skip_serializing_if = "is_default")]
    pub colours: ColourMix,
    /// Options of the warp by lines.
    #[serde(skip_serializing_if = "is_default")]
    pub lines: LineOptions,
    /// Options of the warp by scattered points.
    #[serde(skip_serializing_if = "is_default")]
    pub scattered: ScatteredOptions,
    /// Options of the warp by lattices.
    #[serde(skip_serializing_if = "is_default")]
    pub lattice: LatticeOptions,
}

impl Default for TransitionOptions {
    fn default() -> Self {
        Self {
            travel: FeatureTravel::default(),
            bar_width: 0.012,
            matching: MatchSettings::default(),
            parts: Vec::new(),
            paint: PaintRule::default(),
            coats: PaintLayerOptions::default(),
            quality: BuildQuality::default(),
            guard: CollisionAvoidance::default(),
            triangulation: PolygonOptions::default(),
            arap: ArapOptions::default(),
            paths: PathOptions::default(),
            field: FieldOptions::default(),
            colours: ColourMix::default(),
            lines: LineOptions::default(),
            scattered: ScatteredOptions::default(),
            lattice: LatticeOptions::default(),
        }
    }
}

fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}

/// How much is tried for a film of rigid parts of outlines.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum BuildQuality {
    /// One match, and its film as it comes.
    Draft,
    /// Several matches; the one whose film has the least trouble is improved.
    #[default]
    Best,
}

named! { BuildQuality {
    Draft: "draft", "Draft", "The first film, at once";
    Best: "best", "Best", "Several matches are tried, and the best film is improved";
} }

/// What is done where a film of rigid parts of outlines folds, or its outlines meet.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum CollisionAvoidance {
    /// It is moved aside by as little as keeps it apart. Of the best film only: the first
    /// one is there at once.
    #[default]
    Guarded,
    /// Nothing.
    Plain,
}

named! { CollisionAvoidance {
    Guarded: "guarded", "Guarded", "What would fold or cross is moved aside, a little";
    Plain: "plain", "Plain", "As rigid as it can be, whatever it meets";
} }

/// What drawings are painted with.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum PaintRule {
    /// Their own colours, where they have any.
    #[default]
    Own,
    /// The style's colours: each drawing is the figure that it makes.
    One,
}

named! { PaintRule {
    Own: "own", "As drawn", "In the colours of the drawings, one part over the other";
    One: "one", "One colour", "As a figure, in a colour that goes with t";
} }

/// Where the boundary of a distance field runs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum FieldBoundary {
    /// Where the outline is; Euclidean only.
    #[default]
    Exact,
    /// Between cells, as in the paper.
    Binary,
}

named! { FieldBoundary {
    Exact: "exact", "Exact", "Where the drawing has it: smooth";
    Binary: "binary", "Binary", "Between cells, as the paper's tool: stepped";
} }

/// Options of the distance fields.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
#[non_exhaustive]
pub struct FieldOptions {
    /// How distance is measured; all but the Euclidean need
    /// [`FieldBoundary::Binary`].
    pub metric: Metric,
    /// Where the boundary runs.
    pub boundary: FieldBoundary,
    /// How the two fields are mixed.
    pub blend: FieldBlend,
    /// Cells along the longer side of the frame. Distances, ε and the
    /// threshold count in these cells.
    pub cells: u32,
    /// Room around the designs, as a fraction of the longer side.
    pub margin: f64,
}

impl Default for FieldOptions {
    fn default() -> Self {
        Self {
            metric: Metric::Euclidean,
            boundary: FieldBoundary::default(),
            blend: FieldBlend::default(),
            cells: 512,
            margin: 0.1,
        }
    }
}

impl FieldOptions {
    /// Whether the boundary runs on the outline: the metrics that are not
    /// Euclidean belong to the pixels of a binary picture.
    pub(super) fn is_exact(&self) -> bool {
        self.boundary == FieldBoundary::Exact && self.metric == Metric::Euclidean
    }

    /// Whether the boundary cannot be as exact as it is asked for.
    pub(super) fn is_switched(&self) -> bool {
        self.boundary == FieldBoundary::Exact && !self.is_exact()
    }
}
