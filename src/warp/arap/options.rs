//! Options of the rigidity-preserving interpolation, their validation and its errors.

use super::angles::AngleError;
use crate::geometry::{ApproxPoint, DVec2};
use crate::mesh::{MAX_ROUNDS, TooManyVertices};
use crate::numerics::FactorError;
use crate::warp::homotopy::Homotopy;
use crate::work::progress::Cancelled;
use serde::{Deserialize, Serialize};

/// Weights of the faces in the energy.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum FaceWeights {
    /// The weight of a face is its area, so that the result hardly depends on the triangulation.
    #[default]
    Area,
    /// Equal weights, so that small faces count as much as large ones, as in "Design-Space
    /// Representation through Blended Transitions", §3.2.
    Uniform,
    /// One positive weight for each face before subdivision; larger weights make a face stiffer.
    PerFace(Vec<f64>),
}

impl FaceWeights {
    /// Returns the weights after splitting every face into four `rounds` times.
    ///
    /// # Errors
    /// [`ArapError`] unless there is one positive weight for each face.
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
        // Saturates because `rounds` may come from a file, and 4³² would overflow.
        let children = 4_usize.saturating_pow(rounds);
        if each.len().saturating_mul(children) > 4 * crate::mesh::MAX_VERTICES {
            return Err(TooManyVertices { rounds }.into());
        }
        // Subdivision lists the children of each face one after the other.
        let repeated = each.iter().flat_map(|&w| std::iter::repeat_n(w, children));
        Ok(Self::PerFace(repeated.collect()))
    }
}

/// Motion of the design as a whole, which the energy does not determine.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum ArapPath {
    /// The centroid moves on a straight line.
    #[default]
    Centroid,
    /// The design rotates about its pole, the fixed point of its rigid motion, and the centroid
    /// moves on an arc. This is the planar screw motion that dual quaternions interpolate (Kavan,
    /// Collins, Žára and O'Sullivan 2008). If the design hardly rotates, the pole is far away and
    /// the arc nearly straight.
    Pole,
    /// The vertex with this index moves on a straight line.
    Anchor(u32),
}

impl ArapPath {
    /// Checks that the index of an anchor is less than `vertices`, the number of vertices.
    ///
    /// # Errors
    /// [`ArapError::Anchor`] if the index is too large.
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
    /// Path of each face's local map, from the identity at t = 0 to its final value at t = 1.
    pub homotopy: Homotopy,
    /// Weights of the faces.
    pub weights: FaceWeights,
    /// Whether the energy includes both directions, source to target and target to source.
    /// Otherwise it is the one-sided energy of "Design-Space Representation through Blended
    /// Transitions", §3.2.
    pub symmetric: bool,
    /// Whole turns that are added to the rotation: one number for all edge-connected components of
    /// the faces, or one for each component, ordered by their first faces. Missing numbers count as
    /// 0.
    pub extra_turns: Vec<i32>,
    /// Motion of the design as a whole, which the energy does not determine.
    pub path: ArapPath,
    /// Number of times that every face is split into four before solving.
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
    /// Checks the options that can be checked without a mesh.
    ///
    /// # Errors
    /// [`TooManyVertices`] if the requested subdivision would give even a single face too many
    /// vertices.
    pub fn check(&self) -> Result<(), TooManyVertices> {
        match self.subdivisions {
            rounds if rounds > MAX_ROUNDS => Err(TooManyVertices { rounds }),
            _ => Ok(()),
        }
    }
}

/// Reason why a rigidity-preserving interpolation cannot be built.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ArapError {
    /// The rotation angles of the faces are inconsistent.
    #[error(transparent)]
    Angles(#[from] AngleError),
    /// The number of weights differs from the number of faces, or a weight is not positive and
    /// finite.
    #[error("weights must be one positive number for each of the {faces} faces; {problem}")]
    Weights {
        /// Number of faces.
        faces: usize,
        /// Description of the first wrong weight.
        problem: String,
    },
    /// The anchor has an index that no vertex has.
    #[error("anchor vertex {anchor} does not exist; choose one from 0 to {last}")]
    Anchor {
        /// Index of the requested vertex.
        anchor: u32,
        /// Largest valid index.
        last: usize,
    },
    /// The mesh would become too large.
    #[error(transparent)]
    TooManyVertices(#[from] TooManyVertices),
    /// Faces are so thin, or so different in size from their neighbours, that the equations cannot
    /// be solved. Holds the position of an affected vertex in source and target.
    #[error(
        "the shape {} in the source and {} in the target is too thin to compute its motion; thicken it, change its match, or choose another method",
        ApproxPoint(.0[0]), ApproxPoint(.0[1])
    )]
    Thin([DVec2; 2]),
    /// The matrix could not be factored.
    #[error(transparent)]
    Factor(FactorError),
    /// The job was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}
