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
//! - `options`: what may be chosen, and what may be wrong with it
//! - `angles`: one consistent rotation angle for each face
//! - `assembly`: gradients, weights and the matrix
//! - `stresses`: the right-hand side of a frame, many faces at a time
//! - `bounded`: the maps of all faces together, for bounded distortion
//! - `put_back`: what of these is sheared too much, solved once more
//! - `rim`: edges of outlines as elements of their own
//! - `lengths`: how long these are on their way
//! - `sides`: what keeps straight sides straight
//! - `player`: what a film is made of, and a frame of it
//! - `guard`: what is moved aside where the film would meet itself
//! - `ridge`: what is added to a matrix that rounding has eaten at
//! - `drift`: where parts as a whole are at t
//! - `times`: when each part is
//! - `life`: when parts grow from points and shrink to them
//! - `many`: many designs at once

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
use crate::work::progress::{Progress, checkpoint, still_wanted};
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

/// A prefactored rigidity-preserving interpolation.
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

/// What was settled about a mesh of outlines besides its options.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct OutlineParameters<'a> {
    /// Of each connected part; none beyond the list.
    pub lives: &'a [Option<TimeWindow>],
    /// Of each face; 1 beyond the list.
    pub stiffness: &'a [f64],
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
        let settled = OutlineParameters::default();
        Self::prepared(mesh, options, (settled, OutlineConstraints::No), progress)
    }

    /// As [`Self::build`], of a mesh of drawn outlines: what is straight in both
    /// designs, and divided alike, stays straight. Some of its connected parts
    /// may be points
    /// in one of the designs, and have a time in which they change their size;
    /// none for those that are not, and for parts beyond the list. Where the
    /// design is as a whole, and how it turns, is then decided by the others.
    /// By the linear homotopy, which knows of no whole, they wait where they
    /// are points.
    ///
    /// # Errors
    /// As [`Self::build`].
    pub fn of_outlines(
        mesh: &CompatibleMesh,
        options: &ArapOptions,
        lives: &[Option<TimeWindow>],
        progress: &dyn Progress,
    ) -> Result<Self, ArapError> {
        let settled = OutlineParameters {
            lives,
            ..OutlineParameters::default()
        };
        Self::settled(mesh, options, settled, progress)
    }

    /// As [`Self::of_outlines`], with all that was settled about it.
    ///
    /// # Errors
    /// As [`Self::build`].
    pub(crate) fn settled(
        mesh: &CompatibleMesh,
        options: &ArapOptions,
        settled: OutlineParameters,
        progress: &dyn Progress,
    ) -> Result<Self, ArapError> {
        Self::prepared(mesh, options, (settled, OutlineConstraints::Yes), progress)
    }

    /// The same mesh with other options, subdivided once more if they ask for it:
    /// what a face is divided into is as stiff as the face.
    ///
    /// # Errors
    /// As [`Self::build`].
    pub(crate) fn rebuilt(
        &self,
        options: &ArapOptions,
        progress: &dyn Progress,
    ) -> Result<Self, ArapError> {
        let settled = OutlineParameters {
            lives: self.lives(),
            stiffness: self.stiffness(),
        };
        let rebuilt = Self::prepared(self.mesh(), options, (settled, self.0.outlined), progress)?;
        let Some(guard) = self.guard() else {
            return Ok(rebuilt);
        };
        let vertices = self.mesh().source().len();
        let fine = Subdivision::new(self.mesh().faces(), vertices, options.subdivisions)?;
        Ok(rebuilt.guarded(Some(guard.subdivided(&fine, vertices))))
    }

    fn prepared(
        mesh: &CompatibleMesh,
        options: &ArapOptions,
        (settled, outlined): (OutlineParameters, OutlineConstraints),
        progress: &dyn Progress,
    ) -> Result<Self, ArapError> {
        let weights = options
            .weights
            .subdivided(mesh.faces().len(), options.subdivisions)?;
        checkpoint(progress, "subdividing", 0.0)?;
        let mesh = mesh.subdivided(options.subdivisions)?;
        // Subdivision lists the children of a face one after the other.
        let children = 4_usize.saturating_pow(options.subdivisions);
        let stiffness = settled.stiffness.iter();
        let stiffness: Vec<f64> = stiffness.flat_map(|&by| repeat_n(by, children)).collect();
        // After subdividing: an anchor may be one of the new vertices.
        options.path.check(mesh.source().len())?;
        checkpoint(progress, "decomposing", 0.1)?;
        let options = ArapOptions {
            weights,
            subdivisions: 0,
            ..options.clone()
        };
        let maps = LocalMaps::new(&mesh, &options, settled.lives)?
            .stiffened(&stiffness)
            .rimmed(&mesh, settled.lives, (&options, outlined));
        let drawn = (settled.lives.to_vec(), outlined);
        Self::from_maps(mesh, maps, options, drawn, progress)
    }

    /// Assembles and factors: `options` are those of the mesh as it is.
    fn from_maps(
        mesh: CompatibleMesh,
        maps: LocalMaps,
        options: ArapOptions,
        (lives, outlined): (Vec<Option<TimeWindow>>, OutlineConstraints),
        progress: &dyn Progress,
    ) -> Result<Self, ArapError> {
        checkpoint(progress, "factoring", 0.3)?;
        let thin = |vertex: usize| [mesh.source()[vertex], mesh.target()[vertex]];
        let held = outlined.of(options.homotopy);
        let done = factor_with_ridge(maps.matrix(&mesh, held), progress)?;
        let (cholesky, ridge) = done.map_err(|error| match error {
            FactorError::NotPositiveDefinite { index } => ArapError::Thin(thin(index)),
            error => ArapError::Factor(error),
        })?;
        checkpoint(progress, "preparing frames", 0.9)?;
        let place = cholesky.place_in_order();
        let mut stresses = ForceAssembly::new(&mesh, &maps, options.homotopy);
        edge_lengths::fit_halfway_lengths(
            &mut stresses,
            &mesh,
            (&cholesky, options.homotopy),
            progress,
        )?;
        still_wanted(progress)?;
        let drift = PartTranslations::new(&mesh, &maps, place, options.path, lives);
        Ok(Self(Arc::new(FactoredArap {
            mesh,
            cholesky: Arc::new(cholesky),
            ridge,
            stresses,
            drift,
            maps,
            options,
            outlined,
            guard: None,
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
        let held = self.0.outlined.of(self.0.options.homotopy);
        self.0.maps.matrix(&self.0.mesh, held)
    }

    /// The matrix of the energy with nothing added that holds a part where it is: a
    /// part that moves as a whole costs nothing.
    pub(crate) fn free_system(&self) -> SymmetricMatrix {
        let held = self.0.outlined.of(self.0.options.homotopy);
        self.0.maps.free_matrix(&self.0.mesh, held)
    }

    /// The mass of each vertex, by the area around it; that of all is 1.
    pub(crate) fn masses(&self) -> &[f64] {
        &self.0.maps.masses
    }

    /// What had to be added to the matrix to factor it; none in all but the
    /// most uneven of meshes. The film is then a little stiffer than asked
    /// for, as what is factored is than [`Self::system`].
    #[must_use]
    pub fn ridge(&self) -> Option<Ridge> {
        self.0.ridge
    }

    /// How many sheets of faces that share edges could not be flattened as bounded
    /// distortion asks: their faces go each by its own metric.
    #[must_use]
    pub fn unflattened(&self) -> usize {
        self.0.stresses.bounded().map_or(0, Bounded::unflattened)
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

    /// The rotation of the design as a whole from source to target, in
    /// radians, on the branch of the first part.
    pub(crate) fn rotation(&self) -> f64 {
        self.0.maps.whole_angle
    }

    /// The map of a face from source to target, with its consistent angle.
    pub(crate) fn local_map(&self, face: usize) -> PolarDecomposition {
        self.0.maps.faces[face].map
    }

    /// The same interpolation from target to source. It turns back the way it
    /// came: whole turns are kept, not chosen anew.
    ///
    /// # Errors
    /// [`ArapError`] on a cancel, or if the other matrix cannot be factored.
    pub fn swapped(&self, progress: &dyn Progress) -> Result<Self, ArapError> {
        let inner = &*self.0;
        let mesh = inner.mesh.swapped();
        let lives = inner.drift.lives().iter();
        let lives: Vec<_> = lives.map(|life| life.map(TimeWindow::backwards)).collect();
        let maps = LocalMaps::new(&mesh, &inner.options, &lives)?
            .stiffened(self.stiffness())
            .rimmed(&mesh, &lives, (&inner.options, inner.outlined))
            .turning_back(&inner.maps);
        let drawn = (lives, inner.outlined);
        let swapped = Self::from_maps(mesh, maps, inner.options.clone(), drawn, progress)?;
        Ok(swapped.guarded(self.guard().map(Guard::backwards)))
    }

    /// The same interpolation, in which vertices are moved beside their way as a guard
    /// says, or are not.
    pub(crate) fn guarded(&self, guard: Option<Guard>) -> Self {
        let inner = &*self.0;
        Self(Arc::new(FactoredArap {
            mesh: inner.mesh.clone(),
            cholesky: Arc::clone(&inner.cholesky),
            ridge: inner.ridge,
            stresses: inner.stresses.clone(),
            drift: inner.drift.clone(),
            maps: inner.maps.clone(),
            options: inner.options.clone(),
            outlined: inner.outlined,
            guard: guard.map(Arc::new),
        }))
    }

    /// The same interpolation with other times of the parts that come and go, and no
    /// guard.
    ///
    /// # Errors
    /// As [`Self::build`].
    pub(crate) fn with_lives(
        &self,
        lives: Vec<Option<TimeWindow>>,
        progress: &dyn Progress,
    ) -> Result<Self, ArapError> {
        let inner = &*self.0;
        let drawn = (lives, inner.outlined);
        Self::from_maps(
            inner.mesh.clone(),
            inner.maps.clone(),
            inner.options.clone(),
            drawn,
            progress,
        )
    }

    /// How far a vertex is moved aside at most where the film would meet itself, in
    /// diameters; none where none is.
    #[must_use]
    pub fn moved_aside(&self) -> Option<f64> {
        let guard = self.guard()?;
        Some(guard.farthest() / self.mesh().diameter())
    }

    /// The times between which what is moved beside its way is smooth.
    pub(super) fn guard_times(&self) -> &[f64] {
        self.guard().map(Guard::times).unwrap_or_default()
    }

    /// What is moved beside its way, if anything is.
    pub(crate) fn guard(&self) -> Option<&Guard> {
        self.0.guard.as_deref()
    }

    /// The same interpolation with the weight of each face multiplied by a positive
    /// number, 1 for those beyond the list: a stiff one moves as its local map
    /// says, whatever its neighbours want.
    ///
    /// # Errors
    /// [`ArapError`] on a cancel, or if the other matrix cannot be factored.
    pub(crate) fn stiffened(&self, by: &[f64], progress: &dyn Progress) -> Result<Self, ArapError> {
        let inner = &*self.0;
        let maps = inner.maps.clone().stiffened(by);
        let drawn = (self.lives().to_vec(), inner.outlined);
        Self::from_maps(
            inner.mesh.clone(),
            maps,
            inner.options.clone(),
            drawn,
            progress,
        )
    }

    /// What the weight of each face is multiplied with; 1 beyond the list.
    pub(crate) fn stiffness(&self) -> &[f64] {
        &self.0.maps.stiffness
    }

    /// When each connected part changes its size, if it is a point in one of
    /// the designs; none beyond the list.
    #[must_use]
    pub fn lives(&self) -> &[Option<TimeWindow>] {
        self.0.drift.lives()
    }

    /// Where at `t` a part is that moves with the whole, when `share` of its own
    /// way is done from a place in the source to one in the target.
    pub(crate) fn carried(&self, ends: [DVec2; 2], share: f64, t: f64) -> DVec2 {
        self.0.drift.carried(ends, share, t)
    }

    /// The place in the source and in the target from which the whole carries
    /// a part to a place at `t`.
    pub(crate) fn carried_back(&self, place: DVec2, t: f64) -> [DVec2; 2] {
        self.0.drift.carried_back(place, t)
    }

    /// How many parts there are whose extra turns can be chosen apart.
    #[must_use]
    pub fn part_count(&self) -> usize {
        self.0.maps.part_count
    }
}

impl Arap {
    /// A placer that shows each connected part at the time that `clock` says it is for
    /// the part at t. What an anchor holds is held in the time of its part.
    pub(in crate::warp) fn placer_by(
        &self,
        clock: impl Fn(usize, f64) -> f64 + Send + Sync + 'static,
    ) -> Placer {
        let mut player = FrameSolver::of(&self.0);
        let mut times = PartTimeBuffer::default();
        let arap = Arc::clone(&self.0);
        Placer::new(self.at_rest(), move |t, placement| {
            let (drift, time) = (&arap.drift, |part: usize| clock(part, t));
            player.place(times.set(drift.part_count(), time, drift.runs()), placement);
        })
    }

    fn at_rest(&self) -> Placement {
        let mesh = self.mesh();
        Placement::of_source(Arc::clone(mesh.faces()), mesh.source(), mesh.target())
    }
}

impl Warp for Arap {
    fn placer(&self) -> Placer {
        let mut player = FrameSolver::of(&self.0);
        Placer::new(self.at_rest(), move |t, placement| {
            player.place(EvaluationTimes::Even(t), placement);
        })
    }

    fn breaks(&self) -> Vec<f64> {
        let lives = self.lives().iter().flatten();
        let lives = lives.flat_map(|life| [life.from, life.to]);
        lives.chain(self.guard_times().iter().copied()).collect()
    }
}
