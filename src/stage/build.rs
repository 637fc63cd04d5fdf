//! Builds transitions from meshes in the background, on Bevy's compute pool, and adds a [`Morph`]
//! for each finished build and for each transition that was built elsewhere.
//!
//! Guaranteed: the main thread never waits. A build is cancelled when its entity is despawned or a
//! newer build replaces it; its result is then dropped. The previous transition is shown until the
//! new one is ready, and also if the build fails.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use bevy::prelude::*;
use bevy::tasks::futures::check_ready;
use bevy::tasks::{AsyncComputeTaskPool, Task};

use crate::design::{Design, DesignForm};
use crate::mesh::TriangleMesh;
use crate::space::SteeredTransition;
use crate::transition::{BuildError, Transition, TransitionSpec};
use crate::warp::ArapOptions;
use crate::work::progress::Progress;

use super::components::{
    Blend, BuildFailed, Morph, MorphOptions, SourceMesh, StageTransition, TargetMesh,
};
use super::mesh_family;
use super::mesh_family::{FamilySteering, MeshFamily};
use super::part_assembly::WithoutParts;

/// A running build of an entity's transition. Dropping the component cancels the build; this
/// happens if the entity is despawned or a newer build replaces the component.
#[derive(Component)]
pub(super) struct TransitionBuild {
    task: Task<Result<BuildOutcome, BuildError>>,
    request: Arc<BuildCancelFlag>,
}

impl TransitionBuild {
    /// Starts `work` on the compute pool.
    pub(super) fn start(
        work: impl FnOnce(&dyn Progress) -> Result<BuildOutcome, BuildError> + Send + 'static,
    ) -> Self {
        let request = Arc::new(BuildCancelFlag(AtomicBool::new(true)));
        // The flag is shared with the task, because the task may outlive the entity.
        let progress = Arc::clone(&request);
        let task = AsyncComputeTaskPool::get().spawn(async move { work(&*progress) });
        Self { task, request }
    }
}

/// Result of a finished build, from which the [`Morph`] of the entity is made.
pub(super) enum BuildOutcome {
    /// Transition between two designs.
    Pair(Transition),
    /// Mixture of two or more designs, for an entity with a [`MeshFamily`] or with three or more
    /// `MorphDesigns`. The [`SteeredTransition`] shows the mixture with the weights that were set
    /// last.
    Family(SteeredTransition),
}

impl Drop for TransitionBuild {
    fn drop(&mut self) {
        // Relaxed ordering suffices, because no other memory depends on the flag.
        self.request.0.store(false, Ordering::Relaxed);
    }
}

/// Flag shared with a running build; false once the result is no longer needed, which cancels the
/// build.
struct BuildCancelFlag(AtomicBool);

impl Progress for BuildCancelFlag {
    fn report(&self, _stage: &'static str, _fraction: f64) {}

    fn is_cancelled(&self) -> bool {
        !self.0.load(Ordering::Relaxed)
    }
}

/// Filter for entities whose transition must be built because their meshes or options changed.
type MeshesChanged = (
    Or<(
        Changed<SourceMesh>,
        Changed<TargetMesh>,
        Changed<MorphOptions>,
    )>,
    // `adopt_transitions` adds the meshes of a transition that is already built; they must not
    // trigger another build.
    Without<StageTransition>,
);

/// Starts a build for each entity with new meshes or options. The new build replaces a running one.
pub(super) fn start_builds(
    mut commands: Commands,
    changed: Query<(Entity, &SourceMesh, &TargetMesh, &MorphOptions), MeshesChanged>,
) {
    for (entity, source, target, options) in &changed {
        let (source, target) = (source.0.clone(), target.0.clone());
        let options = options.0.clone();
        let work = move |progress: &dyn Progress| build(source, target, options, progress);
        let building =
            TransitionBuild::start(move |progress| work(progress).map(BuildOutcome::Pair));
        commands.entity(entity).try_insert(building);
    }
}

/// Starts a build for each entity with a new mesh family.
pub(super) fn start_families(
    mut commands: Commands,
    changed: Query<(Entity, &MeshFamily), Changed<MeshFamily>>,
) {
    for (entity, MeshFamily(meshes)) in &changed {
        let meshes = meshes.clone();
        let building = TransitionBuild::start(move |progress| {
            mesh_family::build(meshes, progress).map(BuildOutcome::Family)
        });
        commands.entity(entity).try_insert(building);
    }
}

/// Builds the transition between two meshes with the same faces.
fn build(
    source: TriangleMesh,
    target: TriangleMesh,
    arap: ArapOptions,
    progress: &dyn Progress,
) -> Result<Transition, BuildError> {
    let [source, target] = [("source", source), ("target", target)]
        .map(|(name, mesh)| Arc::new(Design::new(name, mesh)));
    let mut spec = TransitionSpec::new(source, target);
    spec.options.arap = arap;
    Transition::build(&spec, progress)
}

/// Adds a [`Morph`] to each entity whose build has finished, and reports failed builds.
pub(super) fn finish_builds(
    mut commands: Commands,
    mut building: Query<(Entity, &mut TransitionBuild, Option<&Blend>)>,
) {
    for (entity, mut building, blend) in &mut building {
        let Some(result) = check_ready(&mut building.task) else {
            continue;
        };
        // The entity may have been despawned by the time commands are applied; `try_` ignores this.
        commands.entity(entity).try_remove::<TransitionBuild>();
        match result {
            Ok(BuildOutcome::Pair(transition)) => {
                let t = blend.map_or(0.0, |blend| blend.t);
                let morph = Morph(transition.frame(t));
                let mut entity = commands.entity(entity);
                entity.try_remove::<FamilySteering>();
                entity.try_insert((morph, WithoutParts));
            }
            Ok(BuildOutcome::Family(steered)) => {
                // `solve_families` moves the morph to its weights before it is drawn.
                let morph = Morph(steered.transition().frame(0.0));
                let steering = FamilySteering(steered);
                commands
                    .entity(entity)
                    .try_insert((morph, steering, WithoutParts));
            }
            Err(error) => commands.trigger(BuildFailed { entity, error }),
        }
    }
}

/// Adds a [`Morph`] to each entity with a new [`StageTransition`].
pub(super) fn adopt_transitions(
    mut commands: Commands,
    changed: Query<(Entity, &StageTransition, &Blend), Changed<StageTransition>>,
) {
    for (entity, StageTransition(transition), blend) in &changed {
        let morph = Morph(transition.frame(blend.t));
        let mut entity = commands.entity(entity);
        entity
            // A running build is removed, because its result would later replace this transition.
            .try_remove::<TransitionBuild>()
            .try_insert((morph, WithoutParts));
        match transition.compatible().and_then(|_| meshes(transition)) {
            Some(meshes) => entity.try_insert(meshes),
            // The entity must not keep the meshes of the previous transition.
            None => entity.try_remove::<(SourceMesh, TargetMesh)>(),
        };
    }
}

/// Returns the source and target meshes of a transition with faces: the designs themselves if they
/// are meshes, otherwise the compatible mesh in the source and in the target. Returns `None` if the
/// faces are not a valid mesh, as when three panels between the bars of a truss meet at an edge.
fn meshes(transition: &Transition) -> Option<(SourceMesh, TargetMesh)> {
    let [source, target] = transition.designs();
    if let (DesignForm::Mesh(source), DesignForm::Mesh(target)) = (&source.form, &target.form) {
        return Some((SourceMesh(source.clone()), TargetMesh(target.clone())));
    }
    let compatible = transition.compatible()?;
    let mesh = |positions: &[_]| TriangleMesh::new(positions.to_vec(), compatible.faces().to_vec());
    let ends = (
        mesh(compatible.source()).ok()?,
        mesh(compatible.target()).ok()?,
    );
    Some((SourceMesh(ends.0), TargetMesh(ends.1)))
}
