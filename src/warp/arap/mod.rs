//! Rigidity-preserving (as-rigid-as-possible) interpolation.
//!
//! Alexa, Cohen-Or, Levin, "As-rigid-as-possible shape interpolation" (2000);
//! the paper's §3.2; the symmetric energy is ½E(A→B, t) + ½E(B→A, 1−t) in one
//! matrix. With local maps M_T(t) along a homotopy and W_T the weights,
//!
//! E_t(V) = Σ_T tr((J_T(V) − M_T(t)) W_T (J_T(V) − M_T(t))ᵀ)
//!
//! is least where K U = Σ (M(t) − M_linear(t)) W g for the deviation U from
//! the straight line (1−t) P + t Q. K does not depend on t: it is factored
//! once, and a frame is one pass over the faces and one back-substitution
//! with two right-hand sides.
//!
//! Guaranteed: at t = 0 and t = 1 the designs to the last bit; a rigid target
//! moves rigidly; swapping the designs plays the film backwards (symmetric
//! energy). Not guaranteed: that no face folds in between; see
//! [`crate::measure`].
//!
//! - `angles`: one consistent rotation angle for each face
//! - `assembly`: gradients, weights and the matrix
//! - `stresses`: the right-hand side of a frame, many faces at a time
//! - `drift`: where parts as a whole are at t

mod angles;
mod assembly;
mod drift;
mod stresses;

#[cfg(test)]
mod tests;

pub use angles::AngleError;

use super::{Placement, Placer, Warp};
use crate::compatible::CompatibleMesh;
use crate::geometry::DVec2;
use crate::homotopy::Homotopy;
use crate::linalg::{Cholesky, FactorError, FactorKind, SymmetricMatrix, Workspace};
use crate::mesh::TooManyVertices;
use crate::progress::{Cancelled, Progress, checkpoint};
use assembly::LocalMaps;
use drift::Drift;
use serde::{Deserialize, Serialize};
use std::sync::Arc;
use stresses::Stresses;

/// How faces are weighted in the energy.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Weights {
    /// By area: the result does not depend on how the inside is divided.
    #[default]
    Area,
    /// All alike, as the paper does: small faces count as much as large ones.
    Uniform,
    /// One positive number for each face, before subdivision; a stiff part
    /// gets a large one.
    PerFace(Vec<f64>),
}

impl Weights {
    /// The weights after every face was split into four so many times.
    ///
    /// # Errors
    /// [`ArapError`] unless they are one positive number for each face.
    fn subdivided(&self, faces: usize, rounds: u32) -> Result<Self, ArapError> {
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
pub enum PathKind {
    /// The centroid moves on a straight line.
    #[default]
    Centroid,
    /// The vertex of this number, from 0, moves on a straight line.
    Anchor(u32),
}

/// Options of the rigidity-preserving interpolation.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub struct ArapOptions {
    /// How each local map moves.
    pub homotopy: Homotopy,
    /// How faces are weighted.
    pub weights: Weights,
    /// Both directions in one energy, or the paper's one-sided one.
    pub symmetric: bool,
    /// Whole turns added: a single number for everything, or one for each
    /// part whose panels share edges, in the order of its first face.
    pub extra_turns: Vec<i32>,
    /// Where the whole design is at t.
    pub path: PathKind,
    /// How often every face is split into four before solving.
    pub subdivisions: u32,
}

impl Default for ArapOptions {
    fn default() -> Self {
        Self {
            homotopy: Homotopy::default(),
            weights: Weights::default(),
            symmetric: true,
            extra_turns: Vec::new(),
            path: PathKind::default(),
            subdivisions: 0,
        }
    }
}

/// Why a rigidity-preserving interpolation could not be built.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
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
    /// The matrix could not be factored.
    #[error(transparent)]
    Factor(#[from] FactorError),
    /// Nobody wants the result.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// A prefactored rigidity-preserving interpolation.
///
/// ```
/// use morphospace::compatible::CompatibleMesh;
/// use morphospace::geometry::{DMat2, DVec2};
/// use morphospace::progress::Silent;
/// use morphospace::warp::{Arap, ArapOptions, Warp};
///
/// let source = vec![DVec2::ZERO, DVec2::X, DVec2::Y];
/// let turn = DMat2::from_angle(2.0);
/// let target = source.iter().map(|&p| turn * p).collect();
/// let mesh = CompatibleMesh::new(vec![[0, 1, 2]], source, target, vec![])?;
/// let arap = Arap::build(&mesh, &ArapOptions::default(), &Silent)?;
/// let mut placer = arap.placer();
/// placer.place(0.5);
/// let at = &placer.placement().in_frame;
/// assert!((at[0].distance(at[1]) - 1.0).abs() < 1e-12); // turned, not shrunk
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Arap(Arc<Inner>);

#[derive(Debug)]
struct Inner {
    mesh: CompatibleMesh,
    cholesky: Cholesky,
    stresses: Stresses,
    drift: Drift,
    maps: LocalMaps,
    /// Options of the mesh as it is: nothing left to subdivide.
    options: ArapOptions,
}

impl Arap {
    /// Decomposes the local maps, assembles the matrix and factors it.
    ///
    /// # Errors
    /// [`ArapError`] if the options do not fit the mesh, the angles wind
    /// around a hole, the matrix cannot be factored, or on a cancel.
    pub fn build(
        mesh: &CompatibleMesh,
        options: &ArapOptions,
        progress: &dyn Progress,
    ) -> Result<Self, ArapError> {
        let weights = options
            .weights
            .subdivided(mesh.faces().len(), options.subdivisions)?;
        checkpoint(progress, "subdividing", 0.0)?;
        let mesh = mesh.subdivided(options.subdivisions)?;
        check_anchor(options.path, mesh.source().len())?;
        checkpoint(progress, "decomposing", 0.1)?;
        let options = ArapOptions {
            weights,
            subdivisions: 0,
            ..options.clone()
        };
        let maps = LocalMaps::new(&mesh, &options)?;
        Self::from_maps(mesh, maps, options, progress)
    }

    /// Assembles and factors: `options` are those of the mesh as it is.
    fn from_maps(
        mesh: CompatibleMesh,
        maps: LocalMaps,
        options: ArapOptions,
        progress: &dyn Progress,
    ) -> Result<Self, ArapError> {
        checkpoint(progress, "factoring", 0.3)?;
        let cholesky = factored(maps.matrix(&mesh))?;
        checkpoint(progress, "preparing frames", 0.9)?;
        let place = cholesky.place_in_order();
        let stresses = Stresses::new(&mesh, &maps, options.homotopy);
        let drift = Drift::new(&mesh, &maps, place, options.path);
        Ok(Self(Arc::new(Inner {
            mesh,
            cholesky,
            stresses,
            drift,
            maps,
            options,
        })))
    }

    /// The mesh that is interpolated, subdivided as the options ask.
    #[must_use]
    pub fn mesh(&self) -> &CompatibleMesh {
        &self.0.mesh
    }

    /// What it was built with, as of the mesh as it is: nothing is left to
    /// subdivide.
    #[must_use]
    pub fn options(&self) -> &ArapOptions {
        &self.0.options
    }

    /// The matrix of the energy, assembled anew; for measurements.
    #[must_use]
    pub fn system(&self) -> SymmetricMatrix {
        self.0.maps.matrix(&self.0.mesh)
    }

    /// The factored matrix; for measurements.
    #[must_use]
    pub fn cholesky(&self) -> &Cholesky {
        &self.0.cholesky
    }

    /// The rotation angle of each face from source to target, in radians,
    /// consistent across shared edges.
    #[must_use]
    pub fn face_angles(&self) -> Vec<f64> {
        self.0
            .maps
            .faces
            .iter()
            .map(|face| face.map.angle)
            .collect()
    }

    /// The same interpolation from target to source. It turns back the way it
    /// came: whole turns are kept, not chosen anew.
    ///
    /// # Errors
    /// [`ArapError`] on a cancel, or if the other matrix cannot be factored.
    pub fn swapped(&self, progress: &dyn Progress) -> Result<Self, ArapError> {
        let inner = &*self.0;
        let mesh = inner.mesh.swapped();
        let maps = LocalMaps::new(&mesh, &inner.options)?.turning_back(&inner.maps);
        Self::from_maps(mesh, maps, inner.options.clone(), progress)
    }

    /// How many parts there are whose extra turns can be chosen apart.
    #[must_use]
    pub fn part_count(&self) -> usize {
        self.0.maps.part_count
    }
}

fn check_anchor(path: PathKind, vertices: usize) -> Result<(), ArapError> {
    match path {
        PathKind::Anchor(anchor) if anchor as usize >= vertices => Err(ArapError::Anchor {
            anchor,
            last: vertices - 1,
        }),
        _ => Ok(()),
    }
}

impl Warp for Arap {
    fn placer(&self) -> Box<dyn Placer> {
        Box::new(ArapPlacer::new(Arc::clone(&self.0)))
    }
}

/// The memory of one player of an [`Arap`].
#[derive(Debug)]
struct ArapPlacer {
    arap: Arc<Inner>,
    /// Right-hand sides, then the deviation U: all x, all y, in elimination
    /// order.
    deviation: Vec<f64>,
    workspace: Workspace,
    /// The shift of each connected part.
    shifts: Vec<DVec2>,
    placement: Placement,
}

impl ArapPlacer {
    fn new(arap: Arc<Inner>) -> Self {
        let mesh = &arap.mesh;
        Self {
            deviation: vec![0.0; 2 * mesh.source().len()],
            workspace: arap.cholesky.workspace(2),
            shifts: vec![DVec2::ZERO; arap.drift.part_count()],
            placement: Placement {
                faces: Arc::clone(mesh.faces()),
                in_frame: mesh.source().to_vec(),
                in_source: mesh.source().to_vec(),
                in_target: mesh.target().to_vec(),
            },
            arap,
        }
    }
}

impl Placer for ArapPlacer {
    fn place(&mut self, t: f64) {
        let arap = &*self.arap;
        let place = arap.cholesky.place_in_order();
        let Placement {
            in_frame,
            in_source,
            in_target,
            ..
        } = &mut self.placement;
        // The linear path needs no solve: its deviation is zero.
        if arap.options.homotopy != Homotopy::Linear {
            // The forces stand where the positions will stand.
            arap.stresses
                .right_hand_sides(t, place, in_frame, &mut self.deviation);
            arap.cholesky
                .solve_ordered(&mut self.deviation, &mut self.workspace);
            arap.drift.shifts(t, &self.deviation, &mut self.shifts);
        }
        let (dx, dy) = self.deviation.split_at(place.len());
        for (run, part) in arap.drift.runs() {
            let shift = self.shifts[part];
            let ends = in_source[run.clone()].iter().zip(&in_target[run.clone()]);
            let rest = in_frame[run.clone()].iter_mut().zip(&place[run]);
            for ((&p, &q), (out, &at)) in ends.zip(rest) {
                let u = DVec2::new(dx[at as usize], dy[at as usize]);
                *out = (p * (1.0 - t) + q * t) + (u + shift);
            }
        }
    }

    fn placement(&self) -> &Placement {
        &self.placement
    }
}

/// Shares of the diagonal that are added where rounding has eaten a pivot.
/// Faces a ten-thousandth as large as their neighbours, about a hole that
/// closes to a point, leave pivots of the size of the last digits.
const STIFFER: [f64; 3] = [1e-13, 1e-11, 1e-9];

fn factored(mut matrix: SymmetricMatrix) -> Result<Cholesky, FactorError> {
    let mut result = Cholesky::factor(&matrix, FactorKind::Automatic);
    for share in STIFFER {
        if !matches!(result, Err(FactorError::NotPositiveDefinite { .. })) {
            break;
        }
        matrix.stiffen(share);
        result = Cholesky::factor(&matrix, FactorKind::Automatic);
    }
    result
}
