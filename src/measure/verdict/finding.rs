//! What can be found in a film: trouble, its cause and what helps.

use crate::content::BlendSpace;
use crate::geometry::DVec2;
use crate::geometry::EdgeCrossing;
use crate::transition::TransitionOptions;
use crate::warp::homotopy::Homotopy;
use serde::Serialize;

/// One kind of trouble, where it is worst.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Finding {
    /// What is seen.
    pub trouble: FindingKind,
    /// Where there is most of it: the t to go to.
    pub t: f64,
    /// The first and the last t at which it is seen.
    pub span: [f64; 2],
    /// Where in the frame at `t`.
    pub place: DVec2,
    /// What is measured there.
    pub cause: FindingCause,
    /// What to do.
    pub remedy: Remedy,
}

/// What is seen.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
#[non_exhaustive]
pub enum FindingKind {
    /// Faces are turned over or flat.
    Folds {
        /// Their numbers, from 0.
        faces: Vec<usize>,
    },
    /// The boundary crosses itself.
    Crossings {
        /// Where.
        crossings: Vec<EdgeCrossing>,
    },
    /// A contour has more pieces than at either end.
    Pieces {
        /// How many.
        count: usize,
        /// How many at the larger end.
        at_ends: usize,
    },
    /// A contour has more holes than at either end.
    Holes {
        /// How many.
        count: usize,
        /// How many at the larger end.
        at_ends: usize,
    },
    /// Nothing is left of a contour.
    Gone,
    /// The plane is turned over.
    PlaneFolds {
        /// In which share of the frame.
        share: f64,
    },
    /// Pins are not where they belong.
    Missed {
        /// How many.
        count: usize,
        /// By how much the worst one, as a share of the frame's diameter.
        by: f64,
    },
}

/// What is measured where the trouble is. Angles are radians.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
#[non_exhaustive]
pub enum FindingCause {
    /// The local maps run straight, and flatten what turns.
    StraightPaths {
        /// How they run.
        homotopy: Homotopy,
        /// By how much the worst face turns.
        turn: f64,
    },
    /// A part turns by more than half a turn against what it hangs on.
    FarTurn {
        /// Its number from 0, as [`crate::warp::ArapOptions::extra_turns`] counts, where
        /// there are several.
        part: Option<usize>,
        /// By how much.
        turn: f64,
    },
    /// The boundary is stretched or squeezed more than three times against
    /// its mean.
    UnevenMatch {
        /// Its share of the target by its share of the source.
        ratio: f64,
        /// Where in the source.
        source: DVec2,
        /// Where in the target.
        target: DVec2,
    },
    /// Neighbouring faces turn by very different angles.
    UnlikeNeighbours {
        /// The difference.
        turn: f64,
    },
    /// Two places of the boundary run into each other.
    PlacesMeet {
        /// By how much each of them turns.
        turns: [f64; 2],
        /// Where in the source.
        source: [DVec2; 2],
    },
    /// The designs hardly lie over each other.
    LittleOverlap {
        /// The share of the smaller that lies on the other.
        share: f64,
    },
    /// Fields do not know which part becomes which.
    BlindFields,
    /// Some of a design is seen more than once, in turned over faces.
    SeenTwice,
    /// No map without folds was found that reaches a pin.
    OutOfReach,
    /// Pins come so near each other on their way that one map cannot meet both.
    FeaturesMeet,
    /// Points of the boundary move on their own; nothing inside keeps them
    /// apart.
    NothingInside,
    /// None of the above.
    Unclear,
}

/// What to do.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Remedy {
    /// An option. It was tried.
    Change {
        /// Which.
        change: SettingChange,
        /// How many faces, crossings, pieces or holes too many it leaves at
        /// the worst t.
        left: usize,
        /// How many there are now.
        of: usize,
    },
    /// A pair of points to be pinned together.
    Pin {
        /// Where in the source.
        source: DVec2,
        /// Where in the target.
        target: DVec2,
    },
    /// Vertices to be moved in one of the designs.
    MoveVertices {
        /// Where in the source.
        source: DVec2,
        /// Where in the target.
        target: DVec2,
    },
    /// The target to be laid over the source.
    LayOver,
    /// Rigid parts instead of fields or of boundary paths.
    RigidParts,
    /// Lattices that never fold instead of the warp at hand, or other pins.
    Lattices,
    /// Lattices that may fold, or other pins.
    LetFold,
    /// Other pins.
    MovePins,
    /// Another way through the blends of many designs.
    AnotherWay,
}

/// A change of options.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum SettingChange {
    /// Of how the local maps move.
    Homotopy(Homotopy),
    /// To the symmetric energy.
    Symmetric,
    /// Of the whole turns of each part.
    ExtraTurns(Vec<i32>),
    /// Of the space in which distances are mixed.
    Space(BlendSpace),
}

impl SettingChange {
    /// Makes the change in the options of a transition or project.
    pub fn apply(&self, options: &mut TransitionOptions) {
        match self {
            Self::Homotopy(homotopy) => options.arap.homotopy = *homotopy,
            Self::Symmetric => options.arap.symmetric = true,
            Self::ExtraTurns(turns) => options.arap.extra_turns.clone_from(turns),
            Self::Space(space) => options.field.blend.space = *space,
        }
    }
}
