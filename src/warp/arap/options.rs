//! How rigid parts move: options, and what may be wrong with them.

use super::angles::AngleError;
use crate::geometry::{ApproxPoint, DVec2};
use crate::mesh::{MAX_ROUNDS, TooManyVertices};
use crate::numerics::FactorError;
use crate::warp::homotopy::Homotopy;
use crate::work::progress::Cancelled;
use serde::{Deserialize, Serialize};

/// How faces are weighted in the energy.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum FaceWeights {
    /// By area: the result does not depend on how the inside is divided.
    #[default]
    Area,
    /// All alike, as the paper does: small faces count as much as large ones.
    Uniform,
    /// One positive number for each face, before subdivision; a stiff part
    /// gets a large one.
    PerFace(Vec<f64>),
}

impl FaceWeights {
    /// The weights after every face was split into four so many times.
    ///
    /// # Errors
    /// [`ArapError`] unless they are one positive number for each face.
    pub(super) fn subdivided(&self, faces: usize, rounds: u32) -> Result<Self, ArapError> {
        let Self::PerFace(each) = self else {
            return Ok(self.clone());
        };
        let wrong = |problem: String| Err(ArapError::Weights { faces, problem });
        if each.len() != faces {
            return wrong(format!("{} were given", each.len()));
        }
        if let Some(bad) = each.iter().position(|w| !(w.is_finite() && *w > 0.0)) {
            return wrong(format!("number {} is {}", bad + 1, each[bad]));
        }
        // Saturating: rounds come from a file, and 4³² would overflow.
        let children = 4_usize.saturating_pow(rounds);
        if each.len().saturating_mul(children) > 4 * crate::mesh::MAX_VERTICES {
            return Err(TooManyVertices { rounds }.into());
        }
        // Subdivision lists the children of a face one after the other.
        let repeated = each.iter().flat_map(|&w| std::iter::repeat_n(w, children));
        Ok(Self::PerFace(repeated.collect()))
    }
}

/// Where the whole design is at t, which the energy leaves open.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum ArapPath {
    /// The centroid moves on a straight line.
    #[default]
    Centroid,
    /// The whole turns about its pole, the point that its rotation and its travel
    /// leave where it is: the planar screw motion, which dual quaternions interpolate
    /// (Kavan, Collins, Žára and O'Sullivan 2008). The centroid moves on an arc. Where the whole hardly turns the pole is far away, and the arc is
    /// straight.
    Pole,
    /// The vertex of this number, from 0, moves on a straight line.
    Anchor(u32),
}

impl ArapPath {
    /// # Errors
    /// [`ArapError::Anchor`] if the anchor is none of so many vertices.
    pub(super) fn check(self, vertices: usize) -> Result<(), ArapError> {
        match self {
            Self::Anchor(anchor) if anchor as usize >= vertices => Err(ArapError::Anchor {
                anchor,
                last: vertices - 1,
            }),
            _ => Ok(()),
        }
    }
}

/// Options of the rigidity-preserving interpolation.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub struct ArapOptions {
    /// How each local map moves.
    pub homotopy: Homotopy,
    /// How faces are weighted.
    pub weights: FaceWeights,
    /// Both directions in one energy, or the paper's one-sided one.
    pub symmetric: bool,
    /// Whole turns added: a single number for everything, or one for each
    /// part whose panels share edges, in the order of its first face.
    pub extra_turns: Vec<i32>,
    /// Where the whole design is at t.
    pub path: ArapPath,
    /// How often every face is split into four before solving.
    pub subdivisions: u32,
}

impl Default for ArapOptions {
    fn default() -> Self {
        Self {
            homotopy: Homotopy::default(),
            weights: FaceWeights::default(),
            symmetric: true,
            extra_turns: Vec::new(),
            path: ArapPath::default(),
            subdivisions: 0,
        }
    }
}

impl ArapOptions {
    /// Checks what is wrong with them for whatever mesh.
    ///
    /// # Errors
    /// [`TooManyVertices`] for more subdivisions than a single face bears.
    pub fn check(&self) -> Result<(), TooManyVertices> {
        match self.subdivisions {
            rounds if rounds > MAX_ROUNDS => Err(TooManyVertices { rounds }),
            _ => Ok(()),
        }
    }
}

/// Why a rigidity-preserving interpolation could not be built.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ArapError {
    /// The rotation angles of the faces do not fit together.
    #[error(transparent)]
    Angles(#[from] AngleError),
    /// The weights are not one positive number for each face.
    #[error("weights must be one positive number for each of the {faces} faces; {problem}")]
    Weights {
        /// How many faces there are.
        faces: usize,
        /// What is wrong.
        problem: String,
    },
    /// The anchor is no vertex.
    #[error("the anchor is vertex {anchor}, but the last one is {last}; choose another")]
    Anchor {
        /// The number given.
        anchor: u32,
        /// The largest possible one.
        last: usize,
    },
    /// The mesh would become too large.
    #[error(transparent)]
    TooManyVertices(#[from] TooManyVertices),
    /// Faces that are too thin, or too unlike their neighbours, for the
    /// equations: a place of them in the source and in the target.
    #[error(
        "the equations have no solution: what lies {} in the source and {} in the target is too thin to move; thicken it, match it otherwise, or choose another method",
        ApproxPoint(.0[0]), ApproxPoint(.0[1])
    )]
    Thin([DVec2; 2]),
    /// The matrix could not be factored.
    #[error(transparent)]
    Factor(FactorError),
    /// Nobody wants the result.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}
