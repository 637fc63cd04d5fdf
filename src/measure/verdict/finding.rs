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
        /// All crossings at that t.
        crossings: Vec<EdgeCrossing>,
    },
    /// A contour has more pieces than at either end.
    Pieces {
        /// Number of pieces.
        count: usize,
        /// Number of pieces at the larger end.
        at_ends: usize,
    },
    /// A contour has more holes than at either end.
    Holes {
        /// Number of holes.
        count: usize,
        /// Number of holes at the larger end.
        at_ends: usize,
    },
    /// A contour disappears completely.
    Gone,
    /// A warp of the plane folds.
    PlaneFolds {
        /// Fraction of the frame covered by folds.
        share: f64,
    },
    /// Pins or lines are not at their intended positions.
    Missed {
        /// Number of missed features.
        count: usize,
        /// Distance by which the worst one is missed, as a fraction of the frame's diameter.
        by: f64,
    },
}

/// Measured cause of a defect. Angles are radians.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
#[non_exhaustive]
pub enum FindingCause {
    /// The homotopy moves points straight, which flattens rotating faces.
    StraightPaths {
        /// Homotopy of the local maps.
        homotopy: Homotopy,
        /// Rotation of the worst face.
        turn: f64,
    },
    /// A part rotates by more than half a turn relative to its neighbour or to the whole.
    FarTurn {
        /// Index of the part, from 0, as in [`crate::warp::ArapOptions::extra_turns`]; `None` if
        /// the rotation is relative to the whole shape.
        part: Option<usize>,
        /// Relative rotation.
        turn: f64,
    },
    /// The boundary is locally stretched or squeezed more than three times relative to its mean.
    UnevenMatch {
        /// Fraction of the target loop divided by fraction of the source loop.
        ratio: f64,
        /// Position in the source.
        source: DVec2,
        /// Position in the target.
        target: DVec2,
    },
    /// Neighbouring faces rotate by very different angles.
    UnlikeNeighbours {
        /// Difference of the angles.
        turn: f64,
    },
    /// Two places of the boundary collide.
    PlacesMeet {
        /// Rotation of each place.
        turns: [f64; 2],
        /// Position of each place in the source.
        source: [DVec2; 2],
    },
    /// The designs hardly overlap.
    LittleOverlap {
        /// Fraction of the smaller design that overlaps the other.
        share: f64,
    },
    /// Plain distance fields do not match parts with each other.
    BlindFields,
    /// Folded faces show parts of a design more than once.
    SeenTwice,
    /// No map without folds was found that reaches a pin.
    OutOfReach,
    /// Pins come so close to each other that one map cannot meet both.
    FeaturesMeet,
    /// Boundary points move independently; there is no mesh inside that keeps them apart.
    NothingInside,
    /// None of the above.
    Unclear,
}

/// Suggested remedy for a defect.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Remedy {
    /// Change an option; the change was tested.
    Change {
        /// Tested change.
        change: SettingChange,
        /// Number of folded faces, crossings, extra pieces or extra holes that remain at the worst
        /// t.
        left: usize,
        /// Number of them without the change.
        of: usize,
    },
    /// Pin a pair of points to each other.
    Pin {
        /// Position in the source.
        source: DVec2,
        /// Position in the target.
        target: DVec2,
    },
    /// Move vertices of one of the designs.
    MoveVertices {
        /// Position in the source.
        source: DVec2,
        /// Position in the target.
        target: DVec2,
    },
    /// Make the target overlap the source.
    LayOver,
    /// Use rigid parts instead of distance fields or boundary paths.
    RigidParts,
    /// Use fold-free lattices, or move pins or lines.
    Lattices,
    /// Allow the lattices to fold, or move pins.
    LetFold,
    /// Move pins.
    MovePins,
    /// Lead the path over the map through other blends.
    AnotherWay,
}

/// Change of one option.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum SettingChange {
    /// Sets the homotopy of the local maps.
    Homotopy(Homotopy),
    /// Turns on the symmetric energy.
    Symmetric,
    /// Sets the extra full turns of each part.
    ExtraTurns(Vec<i32>),
    /// Sets the space in which distances are blended.
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
