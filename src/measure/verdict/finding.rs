//! Data of a finding of the check: the kind of defect, its place, cause and remedy.

use crate::content::BlendSpace;
use crate::geometry::DVec2;
use crate::geometry::EdgeCrossing;
use crate::transition::TransitionOptions;
use crate::warp::homotopy::Homotopy;
use serde::Serialize;

/// One kind of defect, at the t where it is worst.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Finding {
    /// Kind and extent of the defect.
    pub trouble: FindingKind,
    /// Sampled t at which the defect is worst.
    pub t: f64,
    /// First and last sampled t with this defect.
    pub span: [f64; 2],
    /// Position of the defect in the frame at `t`.
    pub place: DVec2,
    /// Measured cause.
    pub cause: FindingCause,
    /// Suggested remedy.
    pub remedy: Remedy,
}

/// Kind of defect.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
#[non_exhaustive]
pub enum FindingKind {
    /// Faces are folded or flat.
    Folds {
        /// Indices of the faces, from 0.
        faces: Vec<usize>,
    },
    /// The boundary crosses itself.
    Crossings {
        /// All crossings at the sampled t with the most crossings.
        crossings: Vec<EdgeCrossing>,
    },
    /// At some t, the contour of a distance field has more pieces than at t = 0 and at t = 1.
    Pieces {
        /// Largest number of pieces at any sampled t.
        count: usize,
        /// Number of pieces at t = 0 or t = 1, whichever is larger.
        at_ends: usize,
    },
    /// At some t, the contour of a distance field has more holes than at t = 0 and at t = 1.
    Holes {
        /// Largest number of holes at any sampled t.
        count: usize,
        /// Number of holes at t = 0 or t = 1, whichever is larger.
        at_ends: usize,
    },
    /// At some t, the contour of a distance field disappears completely.
    Gone,
    /// A warp of the plane folds.
    PlaneFolds {
        /// Fraction of the frame covered by folds at the worst t.
        share: f64,
    },
    /// The warp does not bring all pins and lines to their intended positions.
    Missed {
        /// Number of missed pins and sample points of lines.
        count: usize,
        /// Largest distance by which a pin or a sample point of a line is missed, as a fraction of
        /// the frame's diameter.
        by: f64,
    },
}

impl FindingKind {
    /// Extent of the defect, comparable between findings of the same kind: a number of faces,
    /// crossings, extra pieces or extra holes, a fraction of the frame, or a distance.
    #[must_use]
    pub fn extent(&self) -> f64 {
        match self {
            Self::Folds { faces } => faces.len() as f64,
            Self::Crossings { crossings } => crossings.len() as f64,
            Self::Pieces { count, at_ends } | Self::Holes { count, at_ends } => {
                count.saturating_sub(*at_ends) as f64
            }
            Self::Gone => 1.0,
            Self::PlaneFolds { share } => *share,
            Self::Missed { by, .. } => *by,
        }
    }

    /// Whether both are the same kind of defect, whatever their extents.
    #[must_use]
    pub fn is_same_kind(&self, other: &Self) -> bool {
        std::mem::discriminant(self) == std::mem::discriminant(other)
    }
}

/// Measured cause of a defect. Angles are radians.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
#[non_exhaustive]
pub enum FindingCause {
    /// The homotopy moves points along straight lines, which flattens rotating faces.
    StraightPaths {
        /// Homotopy that interpolates the linear map of each face between source and target.
        homotopy: Homotopy,
        /// Rotation of the worst face from source to target.
        turn: f64,
    },
    /// A part rotates by more than half a turn relative to a neighbouring part, or a face relative
    /// to the whole shape.
    FarTurn {
        /// Index of the part, from 0, as in [`crate::warp::ArapOptions::extra_turns`]; `None` if
        /// the rotation is relative to the whole shape.
        part: Option<usize>,
        /// Rotation relative to the neighbour or to the whole shape.
        turn: f64,
    },
    /// Near the defect, the boundary is stretched or squeezed more than three times as much as on
    /// average.
    UnevenMatch {
        /// Local stretch of the boundary divided by the stretch of its whole loop; below 1 where
        /// squeezed.
        ratio: f64,
        /// Position, in the source, of the boundary point at which `ratio` was measured.
        source: DVec2,
        /// Position, in the target, of the boundary point at which `ratio` was measured.
        target: DVec2,
    },
    /// Neighbouring faces rotate by very different angles.
    UnlikeNeighbours {
        /// Difference between the rotations of the two faces.
        turn: f64,
    },
    /// Two places of the boundary move into each other.
    PlacesMeet {
        /// Rotation of each place from source to target.
        turns: [f64; 2],
        /// Position of each place in the source.
        source: [DVec2; 2],
    },
    /// The designs hardly overlap.
    LittleOverlap {
        /// Area common to both designs, as a fraction of the smaller design's area.
        share: f64,
    },
    /// Distance fields do not match the parts of the designs with each other.
    BlindFields,
    /// The warp of the plane folds, so that parts of a design are drawn more than once.
    SeenTwice,
    /// The B-spline lattices of the warp must not fold, and no warp without folds was found that
    /// brings all pins to their positions.
    OutOfReach,
    /// Pins come so close to each other that the warp cannot bring both to their positions.
    FeaturesMeet,
    /// Boundary points move independently: there is no mesh inside the shape that keeps them apart.
    NothingInside,
    /// No single cause was found.
    Unclear,
}

/// Suggested remedy for a defect.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Remedy {
    /// Change an option. The change was tested and reduces the defects.
    Change {
        /// Option to change, with its new value.
        change: SettingChange,
        /// Number of defects of the finding's kind (folded faces, crossings, extra pieces or extra
        /// holes) that remain with the change, at the worst t.
        left: usize,
        /// Number of defects of the finding's kind without the change, at the worst t.
        of: usize,
    },
    /// Pin a pair of points to each other.
    Pin {
        /// Position of the point in the source.
        source: DVec2,
        /// Position of the point in the target.
        target: DVec2,
    },
    /// Move vertices near a place of one of the designs.
    MoveVertices {
        /// Position of the place in the source.
        source: DVec2,
        /// Position of the place in the target.
        target: DVec2,
    },
    /// Align the designs so that they overlap more.
    LayOver,
    /// Use rigid parts instead of distance fields or boundary paths.
    RigidParts,
    /// Use the warp of B-spline lattices without folds, or move or delete pins or lines.
    Lattices,
    /// Allow the B-spline lattices of the warp to fold, or move or delete pins.
    LetFold,
    /// Move or delete pins.
    MovePins,
    /// Change the path on the map of designs, so that it leads through other blends.
    AnotherWay,
}

/// Change of one option.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum SettingChange {
    /// Sets the homotopy that interpolates the linear map of each face between source and target.
    Homotopy(Homotopy),
    /// Turns on the symmetric energy, which treats source and target alike.
    Symmetric,
    /// Sets the number of extra full turns of each part.
    ExtraTurns(Vec<i32>),
    /// Sets whether distances or their logarithms are blended.
    Space(BlendSpace),
}

impl SettingChange {
    /// Applies the change to the options of a transition or project.
    pub fn apply(&self, options: &mut TransitionOptions) {
        match self {
            Self::Homotopy(homotopy) => options.arap.homotopy = *homotopy,
            Self::Symmetric => options.arap.symmetric = true,
            Self::ExtraTurns(turns) => options.arap.extra_turns.clone_from(turns),
            Self::Space(space) => options.field.blend.space = *space,
        }
    }
}
