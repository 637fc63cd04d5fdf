//! The options of all methods. In a document, positions are in the coordinates of each design; in a
//! [`TransitionSpec`](super::TransitionSpec), they are in those of the common frame.

use super::paint_layer_options::PaintLayerOptions;
use super::part_time::PartTime;
use crate::compatible::PolygonOptions;
use crate::content::{ColourMix, FieldBlend};
use crate::correspondence::MatchSettings;
use crate::field::Metric;
use crate::settings::named;
use crate::warp::{
    ArapOptions, FeatureTravel, LatticeOptions, LineOptions, PathOptions, ScatteredOptions,
};
use serde::{Deserialize, Serialize};

/// The options of all methods. Missing options take their defaults; most options are written to a
/// file only if they differ from their defaults.
///
/// ```
/// use morphospace::transition::TransitionOptions;
/// let mut options = TransitionOptions::default();
/// options.field.cells = 256;
/// assert_eq!(options.bar_width, 0.012);
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
#[non_exhaustive]
pub struct TransitionOptions {
    /// Motion of the pins and lines of a plane warp from source to target: straight, or rotating
    /// together.
    #[serde(skip_serializing_if = "is_default")]
    pub travel: FeatureTravel,
    /// Width of truss bars, as a fraction of the diameter of the largest design of the sequence.
    pub bar_width: f64,
    /// Settings of the match of outlines. Positions are in each design's own coordinates in a
    /// document, and in those of the common frame in a specification.
    #[serde(rename = "match", skip_serializing_if = "is_default")]
    pub matching: MatchSettings,
    /// Parts that move in a separate time window (rigid parts only).
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub parts: Vec<PartTime>,
    /// Whether drawings keep their own colours.
    #[serde(skip_serializing_if = "is_default")]
    pub paint: PaintRule,
    /// Options of coloured drawings: whether unmatched parts fade in or out, and when parts change
    /// their stacking order.
    #[serde(skip_serializing_if = "is_default")]
    pub coats: PaintLayerOptions,
    /// Amount of work for the search of a good match of outlines.
    #[serde(skip_serializing_if = "is_default")]
    pub quality: BuildQuality,
    /// Whether shapes are moved aside where they would collide.
    #[serde(skip_serializing_if = "is_default")]
    pub guard: CollisionAvoidance,
    /// Options for the triangulation of matched outlines.
    #[serde(skip_serializing_if = "is_default")]
    pub triangulation: PolygonOptions,
    /// Options of rigid parts.
    pub arap: ArapOptions,
    /// Options of boundary paths.
    #[serde(skip_serializing_if = "is_default")]
    pub paths: PathOptions,
    /// Options of distance fields.
    pub field: FieldOptions,
    /// Options for mixing two pictures.
    #[serde(skip_serializing_if = "is_default")]
    pub colours: ColourMix,
    /// Options of the line warp.
    #[serde(skip_serializing_if = "is_default")]
    pub lines: LineOptions,
    /// Options of the scattered-point warp.
    #[serde(skip_serializing_if = "is_default")]
    pub scattered: ScatteredOptions,
    /// Options of the lattice warp.
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

/// Returns whether an option has its default value; such options are not written to files.
fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}

/// Amount of work for the search of a good match of outlines for rigid parts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum BuildQuality {
    /// The first match, without a search for better ones. For pieces that would turn far, a match
    /// that keeps them upright is tried as well.
    Draft,
    /// Several matches of each piece are tried, and the one with the fewest defects is improved
    /// further.
    #[default]
    Best,
}

named! { BuildQuality {
    Draft: "draft", "Draft", "Shows the first match immediately";
    Best: "best", "Best", "Tries several matches and improves the best one";
} }

/// Whether collisions and folds are avoided in the motion of rigid parts of outlines.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum CollisionAvoidance {
    /// Vertices are moved aside by as little as needed. Only for [`BuildQuality::Best`]: a draft
    /// must be ready at once.
    #[default]
    On,
    /// Collisions and folds are accepted.
    Off,
}

named! { CollisionAvoidance {
    On: "guarded", "On", "Moves shapes slightly aside where they would fold or cross";
    Off: "plain", "Off", "Moves as rigidly as possible, even where shapes collide";
} }

/// Colours in which drawings are shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum PaintRule {
    /// The drawings' own colours, if they have any.
    #[default]
    Own,
    /// The colours of the style: each drawing is filled with a single colour.
    One,
}

named! { PaintRule {
    Own: "own", "As drawn", "Uses the colours of the drawings, layer over layer";
    One: "one", "One colour", "Fills each drawing with one colour that changes with t";
} }

/// Position of the zero boundary of a distance field.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum FieldBoundary {
    /// On the outline; only with the Euclidean metric.
    #[default]
    Exact,
    /// Between grid cells inside and outside the outline, as in "Design-Space Representation
    /// through Blended Transitions".
    Binary,
}

named! { FieldBoundary {
    Exact: "exact", "Exact", "On the drawn outline: smooth";
    Binary: "binary", "Binary", "Between grid cells, as in the paper: stepped";
} }

/// Options of distance fields.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
#[non_exhaustive]
pub struct FieldOptions {
    /// The metric; all metrics except the Euclidean one need [`FieldBoundary::Binary`].
    pub metric: Metric,
    /// Position of the zero boundary of a field.
    pub boundary: FieldBoundary,
    /// Options for blending the two fields.
    pub blend: FieldBlend,
    /// Number of grid cells along the longer side of the grid. The distances, and the parameters
    /// ε and threshold of [`FieldBlend`], are in units of these cells.
    pub cells: u32,
    /// Margin of the grid around the designs, as a fraction of the longer side of the box around
    /// all designs.
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
    /// Returns whether the zero boundary lies exactly on the outline. This needs the Euclidean
    /// metric, because the other metrics are defined only on the pixels of a binary image.
    pub(super) fn is_exact(&self) -> bool {
        self.boundary == FieldBoundary::Exact && self.metric == Metric::Euclidean
    }

    /// Returns whether an exact boundary was requested but the metric does not allow it.
    pub(super) fn needs_binary_boundary(&self) -> bool {
        self.boundary == FieldBoundary::Exact && !self.is_exact()
    }
}
