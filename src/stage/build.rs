//! From two meshes to a transition, on Bevy's compute pool.
//!
//! Guarantees: the main thread never waits; a build whose entity or meshes are
//! gone is cancelled and its result dropped; the old picture stays until the
//! new transition is there, and also where it cannot be had.

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

/// A build that is running. Dropping it (with its entity, or for a newer one)
/// cancels the build.
#[derive(Component)]
pub(super) struct TransitionBuild {
    task: Task<Result<BuildOutcome, BuildError>>,
    wanted: Arc<BuildRequest>,
}

impl TransitionBuild {
    /// Starts it on the pool.
    pub(super) fn start(
        work: impl FnOnce(&dyn Progress) -> Result<BuildOutcome, BuildError> + Send + 'static,
    ) -> Self {
        let wanted = Arc::new(BuildRequest(AtomicBool::new(true)));
        // The task owns a share of the flag: it may outlive the entity.
        let progress = Arc::clone(&wanted);
        let task = AsyncComputeTaskPool::get().spawn(async move { work(&*progress) });
        Self { task, wanted }
    }
}

/// What comes of it.
pub(super) enum BuildOutcome {
    /// Of two meshes.
    Pair(Transition),
    /// Of many.
    Family(SteeredTransition),
}

impl Drop for TransitionBuild {
    fn drop(&mut self) {
        // No other memory hangs on the flag.
        self.wanted.0.store(false, Ordering::Relaxed);
    }
}

struct BuildRequest(AtomicBool);

impl Progress for BuildRequest {
    fn report(&self, _stage: &'static str, _fraction: f64) {}

    fn is_cancelled(&self) -> bool {
        !self.0.load(Ordering::Relaxed)
    }
}

type MeshesChanged = (
    Or<(
        Changed<SourceMesh>,
        Changed<TargetMesh>,
        Changed<MorphOptions>,
    )>,
    // A transition that was built elsewhere brings its meshes along: they must
    // not be built again.
    Without<StageTransition>,
);

/// Starts a build wherever meshes or options are new.
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

/// Starts a build wherever a family is new.
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

/// Takes in what has been built.
pub(super) fn finish_builds(
    mut commands: Commands,
    mut building: Query<(Entity, &mut TransitionBuild, Option<&Blend>)>,
) {
    for (entity, mut building, blend) in &mut building {
        let Some(result) = check_ready(&mut building.task) else {
            continue;
        };
        // The entity may be gone when commands are applied: all of them only
        // try.
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
                // Sought to its weights before anybody sees it.
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

/// Puts transitions on the stage that were built elsewhere.
pub(super) fn adopt_transitions(
    mut commands: Commands,
    changed: Query<(Entity, &StageTransition, &Blend), Changed<StageTransition>>,
) {
    for (entity, StageTransition(transition), blend) in &changed {
        let morph = Morph(transition.frame(blend.t));
        let mut entity = commands.entity(entity);
        entity
            // A build under way would put its own frame in place of this one
            // later.
            .try_remove::<TransitionBuild>()
            .try_insert((morph, WithoutParts));
        match transition.compatible().and_then(|_| meshes(transition)) {
            Some(meshes) => entity.try_insert(meshes),
            // Those of the transition before this one would be stale.
            None => entity.try_remove::<(SourceMesh, TargetMesh)>(),
        };
    }
}

/// Both ends of a transition that has triangles: the designs themselves, or
/// the panels between the bars of trusses. Panels that meet three at an edge
/// are no mesh; such a transition stands on the stage without.
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
