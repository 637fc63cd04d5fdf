//! Rigidity-preserving (as-rigid-as-possible) interpolation of compatible triangulations.
//!
//! Alexa, Cohen-Or, Levin, "As-rigid-as-possible shape interpolation" (2000), in the form of
//! "Design-Space Representation through Blended Transitions", §3.2. Each face T has a local map
//! M_T(t) that follows a homotopy from the identity to the linear map from source to target. With
//! weights W_T and the Jacobian J_T(V) of the vertex positions V, the energy is
//!
//! E_t(V) = Σ_T tr((J_T(V) − M_T(t)) W_T (J_T(V) − M_T(t))ᵀ).
//!
//! The energy is minimal where K U = Σ (M(t) − M_linear(t)) W g. Here U is the deviation of the
//! vertices from the straight paths (1−t) P + t Q between their positions P and Q in the designs,
//! M_linear(t) = (1−t) M(0) + t M(1), g are the gradients of the hat functions, and K is the
//! stiffness matrix of the energy. K does not depend on t and is factored once; evaluation at one t
//! takes one pass over the faces and one back-substitution with two right-hand sides. The symmetric
//! energy ½E(A→B, t) + ½E(B→A, 1−t) also has a single matrix.
//!
//! Guaranteed: at t = 0 and t = 1 the vertices are exactly those of the designs. A rigid target
//! moves rigidly. With the symmetric energy, exchanging the designs reverses the motion. Not
//! guaranteed: that no face folds in between; see [`crate::measure`].
//!
//! - `options`: options, validation and errors
//! - `angles`: consistent rotation angles of all faces
//! - `assembly`: gradients, weights and the matrix
//! - `forces`: vectorised right-hand sides of the linear system at one t
//! - `bounded`: local maps with bounded distortion, computed for all faces together
//! - `strain_limiting`: correction of faces that are sheared beyond that bound
//! - `boundary_edges`: additional terms of the energy, one for each boundary edge
//! - `edge_lengths`: lengths of the boundary edges during the motion
//! - `straight_sides`: constraints that keep straight sides straight
//! - `frame_solver`: the factored system and its evaluation at one t
//! - `guard`: displacements that avoid collisions of the outlines
//! - `ridge`: factorisation of numerically singular matrices
//! - `part_translations`: positions of the connected parts
//! - `evaluation_times`: the time at which each part is evaluated
//! - `time_window`: when parts of a single design appear or disappear
//! - `many_designs`: interpolation of more than two designs

mod angles;
mod assembly;
mod boundary_edges;
mod bounded;
mod edge_lengths;
mod evaluation_times;
mod forces;
mod frame_solver;
mod guard;
mod many_designs;
mod options;
mod part_translations;
mod ridge;
mod straight_sides;
mod strain_limiting;
mod time_window;

#[cfg(test)]
mod tests;

pub use angles::AngleError;
pub(crate) use guard::Guard;
pub use many_designs::{AlongBlend, ArapBlend, BlendPlacer};
pub use options::{ArapError, ArapOptions, ArapPath, FaceWeights};
pub use ridge::Ridge;
pub use time_window::TimeWindow;

use super::{Placement, Placer, Warp};
use crate::compatible::CompatibleMesh;
use crate::geometry::{DVec2, PolarDecomposition};
use crate::mesh::Subdivision;
use crate::numerics::{FactorError, SymmetricMatrix};
use crate::work::progress::{Progress, check_cancelled, checkpoint};
use assembly::LocalMaps;
use bounded::Bounded;
use evaluation_times::{EvaluationTimes, PartTimeBuffer};
use forces::ForceAssembly;
use frame_solver::{FactoredArap, FrameSolver};
use part_translations::PartTranslations;
use ridge::factor_with_ridge;
use std::iter::repeat_n;
use std::sync::Arc;
use straight_sides::OutlineConstraints;

/// Rigidity-preserving interpolation with a factored matrix. Cloning is cheap.
///
/// ```
/// use morphospace::compatible::CompatibleMesh;
/// use morphospace::geometry::{DMat2, DVec2};
/// use morphospace::work::progress::Silent;
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
pub struct Arap(Arc<FactoredArap>);

/// Parameters for the interpolation of a triangulation of outlines, computed by the program rather
/// than chosen by the user.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct OutlineParameters<'a> {
    /// For each connected part that is a point in one of the designs, the time window in which it
    /// grows or shrinks; `None` for other parts. Parts beyond the end of the list have no time
    /// window.
    pub time_windows: &'a [Option<TimeWindow>],
    /// For each face, the factor by which its weight in the energy is multiplied; 1 for faces
    /// beyond the end of the list.
    pub stiffness: &'a [f64],
}

impl Arap {
    /// Builds the interpolation of a mesh: computes the local map of each face, assembles the
    /// matrix of the energy and factors it.
    ///
    /// # Errors
    /// [`ArapError`] if the options do not fit the mesh, the rotation angles of the faces wind
    /// around a hole, the matrix cannot be factored, or the job is cancelled.
    pub fn build(
        mesh: &CompatibleMesh,
        options: &ArapOptions,
        progress: &dyn Progress,
    ) -> Result<Self, ArapError> {
        let parameters = OutlineParameters::default();
        Self::prepared(mesh, options, parameters, OutlineConstraints::Off, progress)
    }

    /// Builds the interpolation of a triangulation of outlines.
    ///
    /// In contrast to [`Self::build`], the energy also has a term for each boundary edge, and sides
    /// that are straight and equally divided in both designs stay straight. A transient part is a
    /// connected part that is a point in one of the designs. `time_windows` holds, for each
    /// transient part, the time window within which the part changes its size. The entry is `None`
    /// for other parts; parts beyond the end of the list have no time window. Unless all parts are
    /// transient, transient parts do not affect the position and rotation of the whole design.
    ///
    /// Before and after its time window, a transient part moves with the whole design. With the
    /// linear homotopy, it stays at its source position before the time window and at its target
    /// position after it.
    ///
    /// # Errors
    /// As [`Self::build`].
    pub fn of_outlines(
        mesh: &CompatibleMesh,
        options: &ArapOptions,
        time_windows: &[Option<TimeWindow>],
        progress: &dyn Progress,
    ) -> Result<Self, ArapError> {
        let parameters = OutlineParameters {
            time_windows,
            ..OutlineParameters::default()
        };
        Self::with_outline_parameters(mesh, options, parameters, progress)
    }

    /// Builds the interpolation like [`Self::of_outlines`], with the time windows and the stiffness
    /// factors of `parameters`.
    ///
    /// # Errors
    /// As [`Self::build`].
    pub(crate) fn with_outline_parameters(
        mesh: &CompatibleMesh,
        options: &ArapOptions,
        parameters: OutlineParameters,
        progress: &dyn Progress,
    ) -> Result<Self, ArapError> {
        Self::prepared(mesh, options, parameters, OutlineConstraints::On, progress)
    }

    /// Builds the interpolation of the same mesh with other options.
    ///
    /// If `options` requests a subdivision, the mesh is subdivided further, and each child face
    /// inherits the stiffness of its parent.
    ///
    /// # Errors
    /// As [`Self::build`].
    pub(crate) fn rebuilt(
        &self,
        options: &ArapOptions,
        progress: &dyn Progress,
    ) -> Result<Self, ArapError> {
        let parameters = OutlineParameters {
            time_windows: self.time_windows(),
            stiffness: self.stiffness(),
        };
        let constraints = self.0.outline_constraints;
        let rebuilt = Self::prepared(self.mesh(), options, parameters, constraints, progress)?;
        let Some(guard) = self.guard() else {
            return Ok(rebuilt);
        };
        let vertices = self.mesh().source().len();
        let fine = Subdivision::new(self.mesh().faces(), vertices, options.subdivisions)?;
        Ok(rebuilt.with_guard(Some(guard.subdivided(&fine, vertices))))
    }

    /// Subdivides the mesh, computes the local maps and factors the matrix.
    fn prepared(
        mesh: &CompatibleMesh,
        options: &ArapOptions,
        parameters: OutlineParameters,
        outline_constraints: OutlineConstraints,
        progress: &dyn Progress,
    ) -> Result<Self, ArapError> {
        let weights = options
            .weights
            .subdivided(mesh.faces().len(), options.subdivisions)?;
        checkpoint(progress, "subdividing", 0.0)?;
        let mesh = mesh.subdivided(options.subdivisions)?;
        // Subdivision lists the children of each face one after the other.
        let children = 4_usize.saturating_pow(options.subdivisions);
        let coarse = parameters.stiffness.iter();
        let stiffness: Vec<f64> = coarse.flat_map(|&by| repeat_n(by, children)).collect();
        // The index of the anchor vertex is checked after subdivision, because the anchor may be a
        // vertex that the subdivision adds.
        options.path.check(mesh.source().len())?;
        checkpoint(progress, "decomposing", 0.1)?;
        let options = ArapOptions {
            weights,
            subdivisions: 0,
            ..options.clone()
        };
        let windows = parameters.time_windows;
        let maps = LocalMaps::new(&mesh, &options, windows)?
            .with_stiffness(&stiffness)
            .with_boundary_edges(&mesh, windows, &options, outline_constraints);
        let windows = windows.to_vec();
        Self::from_maps(mesh, maps, options, windows, outline_constraints, progress)
    }

    /// Builds the interpolation of an already subdivided mesh from the local maps of its faces.
    fn from_maps(
        mesh: CompatibleMesh,
        maps: LocalMaps,
        options: ArapOptions,
        time_windows: Vec<Option<TimeWindow>>,
        outline_constraints: OutlineConstraints,
        progress: &dyn Progress,
    ) -> Result<Self, ArapError> {
        checkpoint(progress, "factoring", 0.3)?;
        let ends = |vertex: usize| [mesh.source()[vertex], mesh.target()[vertex]];
        let constraints = outline_constraints.for_homotopy(options.homotopy);
        let result = factor_with_ridge(maps.matrix(&mesh, constraints), progress)?;
        let (cholesky, ridge) = result.map_err(|error| match error {
            FactorError::NotPositiveDefinite { index } => ArapError::Thin(ends(index)),
            error => ArapError::Factor(error),
        })?;
        checkpoint(progress, "preparing frames", 0.9)?;
        let place = cholesky.elimination_places();
        let mut stresses = ForceAssembly::new(&mesh, &maps, options.homotopy);
        edge_lengths::fit_halfway_lengths(
            &mut stresses,
            &mesh,
            &cholesky,
            options.homotopy,
            progress,
        )?;
        check_cancelled(progress)?;
        let drift = PartTranslations::new(&mesh, &maps, place, options.path, time_windows);
        Ok(Self(Arc::new(FactoredArap {
            mesh,
            cholesky: Arc::new(cholesky),
            ridge,
            forces: stresses,
            translations: drift,
            maps,
            options,
            outline_constraints,
            guard: None,
        })))
    }

    /// Returns the interpolated mesh, which is already subdivided.
    #[must_use]
    pub fn mesh(&self) -> &CompatibleMesh {
        &self.0.mesh
    }

    /// Returns the options of the interpolation. Their number of subdivisions is 0, because
    /// [`Self::mesh`] is already subdivided.
    #[must_use]
    pub fn options(&self) -> &ArapOptions {
        &self.0.options
    }

    /// Assembles the matrix of the energy again, for tests and measurements; the interpolation
    /// itself keeps only its factors.
    #[must_use]
    pub fn system(&self) -> SymmetricMatrix {
        let constraints = self
            .0
            .outline_constraints
            .for_homotopy(self.0.options.homotopy);
        self.0.maps.matrix(&self.0.mesh, constraints)
    }

    /// Returns the matrix of the energy before it is made regular. This matrix is singular:
    /// translating a connected part costs no energy.
    pub(crate) fn free_system(&self) -> SymmetricMatrix {
        let constraints = self
            .0
            .outline_constraints
            .for_homotopy(self.0.options.homotopy);
        self.0.maps.free_matrix(&self.0.mesh, constraints)
    }

    /// Returns the mass of each vertex, computed from the areas of its faces and bars; masses sum
    /// to 1.
    pub(crate) fn masses(&self) -> &[f64] {
        &self.0.maps.masses
    }

    /// Returns the ridge (a small increase of the diagonal) with which the matrix was factored, or
    /// `None` if none was needed.
    ///
    /// Only very uneven meshes need a ridge. The factored matrix is then slightly stiffer than the
    /// one that [`Self::system`] returns.
    #[must_use]
    pub fn ridge(&self) -> Option<Ridge> {
        self.0.ridge
    }

    /// Returns the number of edge-connected components that could not be flattened with bounded
    /// distortion. Each face of such a component follows the bounded homotopy on its own, without
    /// regard to its neighbours.
    #[must_use]
    pub fn unflattened_count(&self) -> usize {
        self.0.forces.bounded().map_or(0, Bounded::unflattened)
    }

    /// Returns the rotation angle of each face from source to target, in radians, consistent
    /// across shared edges.
    #[must_use]
    pub fn face_angles(&self) -> Vec<f64> {
        self.0
            .maps
            .faces
            .iter()
            .map(|face| face.map.angle)
            .collect()
    }

    /// Returns the rotation of the whole design from source to target, in radians.
    ///
    /// This is the best-fit rotation of the vertices, plus the whole turns that bring it nearest to
    /// the mean rotation of the faces of the first edge-connected component.
    pub(crate) fn rotation(&self) -> f64 {
        self.0.maps.whole_angle
    }

    /// Returns the linear map of a face from source to target, as a rotation and a stretch. The
    /// rotation angle is consistent across shared edges.
    pub(crate) fn local_map(&self, face: usize) -> PolarDecomposition {
        self.0.maps.faces[face].map
    }

    /// Returns the interpolation from target to source.
    ///
    /// Each face rotates by the negative of its angle in this interpolation, including whole turns.
    ///
    /// # Errors
    /// [`ArapError`] if the job is cancelled or the new matrix cannot be factored.
    pub fn swapped(&self, progress: &dyn Progress) -> Result<Self, ArapError> {
        let inner = &*self.0;
        let mesh = inner.mesh.swapped();
        let windows = inner.translations.time_windows().iter();
        let time_windows: Vec<_> = windows
            .map(|window| window.map(TimeWindow::backwards))
            .collect();
        let maps = LocalMaps::new(&mesh, &inner.options, &time_windows)?
            .with_stiffness(self.stiffness())
            .with_boundary_edges(
                &mesh,
                &time_windows,
                &inner.options,
                inner.outline_constraints,
            )
            .with_reversed_angles(&inner.maps);
        let swapped = Self::from_maps(
            mesh,
            maps,
            inner.options.clone(),
            time_windows,
            inner.outline_constraints,
            progress,
        )?;
        Ok(swapped.with_guard(self.guard().map(Guard::backwards)))
    }

    /// Returns the same interpolation with another guard (displacements that avoid collisions of
    /// the outlines), or without a guard if `guard` is `None`.
    pub(crate) fn with_guard(&self, guard: Option<Guard>) -> Self {
        let inner = &*self.0;
        Self(Arc::new(FactoredArap {
            mesh: inner.mesh.clone(),
            cholesky: Arc::clone(&inner.cholesky),
            ridge: inner.ridge,
            forces: inner.forces.clone(),
            translations: inner.translations.clone(),
            maps: inner.maps.clone(),
            options: inner.options.clone(),
            outline_constraints: inner.outline_constraints,
            guard: guard.map(Arc::new),
        }))
    }

    /// Returns the same interpolation with other time windows of transient parts, and without a
    /// guard (displacements that avoid collisions of the outlines).
    ///
    /// # Errors
    /// As [`Self::build`].
    pub(crate) fn with_time_windows(
        &self,
        time_windows: Vec<Option<TimeWindow>>,
        progress: &dyn Progress,
    ) -> Result<Self, ArapError> {
        let inner = &*self.0;
        Self::from_maps(
            inner.mesh.clone(),
            inner.maps.clone(),
            inner.options.clone(),
            time_windows,
            inner.outline_constraints,
            progress,
        )
    }

    /// Returns the largest displacement that the guard applies to avoid collisions of the outlines,
    /// in diameters of the mesh; `None` if the interpolation has no guard.
    #[must_use]
    pub fn max_guard_displacement(&self) -> Option<f64> {
        let guard = self.guard()?;
        Some(guard.farthest() / self.mesh().diameter())
    }

    /// Returns the times at which the guard specifies its displacements, which avoid collisions of
    /// the outlines. Between these times the displacements change smoothly. The list is empty
    /// without a guard.
    pub(super) fn guard_times(&self) -> &[f64] {
        self.guard().map(Guard::times).unwrap_or_default()
    }

    /// Returns the guard: the displacements that avoid collisions of the outlines. `None` if there
    /// are none.
    pub(crate) fn guard(&self) -> Option<&Guard> {
        self.0.guard.as_deref()
    }

    /// Returns the same interpolation with the stiffness factors `by` in place of the current ones,
    /// and without a guard (displacements that avoid collisions of the outlines).
    ///
    /// The weight of each face is multiplied by its factor. The factors are positive; faces beyond
    /// the end of `by` have the factor 1. A face with a large factor follows its local map more
    /// closely than its neighbours do.
    ///
    /// # Errors
    /// [`ArapError`] if the job is cancelled or the new matrix cannot be factored.
    pub(crate) fn with_stiffness(
        &self,
        by: &[f64],
        progress: &dyn Progress,
    ) -> Result<Self, ArapError> {
        let inner = &*self.0;
        let maps = inner.maps.clone().with_stiffness(by);
        Self::from_maps(
            inner.mesh.clone(),
            maps,
            inner.options.clone(),
            self.time_windows().to_vec(),
            inner.outline_constraints,
            progress,
        )
    }

    /// Returns, for each face, the factor by which its weight in the energy is multiplied. Faces
    /// beyond the end of the list have the factor 1.
    pub(crate) fn stiffness(&self) -> &[f64] {
        &self.0.maps.stiffness
    }

    /// Returns the time window of each connected part that is a point in one of the designs.
    ///
    /// The entry is `None` for other parts. Parts beyond the end of the list have no time window.
    #[must_use]
    pub fn time_windows(&self) -> &[Option<TimeWindow>] {
        self.0.translations.time_windows()
    }

    /// Returns the position at `t` of a point that moves with the whole design and, in addition,
    /// relative to it.
    ///
    /// `ends` holds the positions of the point in source and target. `share`, from 0 to 1, is the
    /// completed fraction of its motion relative to the design.
    pub(crate) fn carried_position(&self, ends: [DVec2; 2], share: f64, t: f64) -> DVec2 {
        self.0.translations.carried_position(ends, share, t)
    }

    /// Returns the positions in source and target of a point that moves rigidly with the whole
    /// design and is at `place` at `t`.
    pub(crate) fn uncarried_ends(&self, place: DVec2, t: f64) -> [DVec2; 2] {
        self.0.translations.uncarried_ends(place, t)
    }

    /// Returns the number of edge-connected components of the faces. Extra whole turns can be
    /// chosen for each of them separately.
    #[must_use]
    pub fn part_count(&self) -> usize {
        self.0.maps.part_count
    }
}

impl Arap {
    /// Returns a placer that evaluates each connected part at its own time.
    ///
    /// `clock(part, t)` returns the time at which `part` is evaluated when the placer is moved to
    /// `t`. If the options name an anchor vertex, all parts are translated by one vector, such that
    /// the anchor lies on the straight line between its positions in the designs. The time of its
    /// part determines its place on this line.
    pub(in crate::warp) fn placer_by(
        &self,
        clock: impl Fn(usize, f64) -> f64 + Send + Sync + 'static,
    ) -> Placer {
        let mut player = FrameSolver::of(&self.0);
        let mut times = PartTimeBuffer::default();
        let arap = Arc::clone(&self.0);
        Placer::new(self.at_rest(), move |t, placement| {
            let (drift, time) = (&arap.translations, |part: usize| clock(part, t));
            player.place(times.set(drift.part_count(), time, drift.runs()), placement);
        })
    }

    /// Returns the placement at t = 0.
    fn at_rest(&self) -> Placement {
        let mesh = self.mesh();
        Placement::of_source(Arc::clone(mesh.faces()), mesh.source(), mesh.target())
    }
}

impl Warp for Arap {
    fn placer(&self) -> Placer {
        let mut player = FrameSolver::of(&self.0);
        Placer::new(self.at_rest(), move |t, placement| {
            player.place(EvaluationTimes::Uniform(t), placement);
        })
    }

    fn break_times(&self) -> Vec<f64> {
        let windows = self.time_windows().iter().flatten();
        let window_ends = windows.flat_map(|window| [window.from, window.to]);
        window_ends
            .chain(self.guard_times().iter().copied())
            .collect()
    }
}
