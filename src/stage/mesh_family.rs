//! Blends of several meshes with the same faces, or of several designs, by weights.
//!
//! Guaranteed: an entity shows the blend for the weights of the current update. If a weight is not
//! finite, or if the number of weights is not that of the meshes or designs, the weights are
//! ignored: the entity keeps its previous blend. A new entity then shows its first mesh or design.

use std::sync::Arc;

use bevy::platform::time::Instant;
use bevy::prelude::*;

use crate::compatible::CompatibleFamily;
use crate::content::ContentKind;
use crate::design::Design;
use crate::mesh::TriangleMesh;
use crate::space::{DesignSpace, SpaceError, SpaceSpec, SteeredTransition};
use crate::transition::BuildError;
use crate::work::progress::Progress;

use super::components::{Morph, StageStyle};
use super::frame_times::FrameTimes;

/// Two or more meshes with the same faces in the same order. The entity shows their
/// as-rigid-as-possible blend for the weights in [`BlendWeights`].
///
/// Changing the meshes rebuilds the blend.
#[derive(Component, Clone, Debug, Reflect)]
#[reflect(opaque)]
#[reflect(Component, Clone, Debug)]
#[require(BlendWeights, StageStyle, Transform, Visibility)]
pub struct MeshFamily(pub Vec<TriangleMesh>);

/// Weights of the meshes of a [`MeshFamily`], or of three or more
/// [`MorphDesigns`](super::MorphDesigns): one per mesh or design, with sum 1. Weights outside
/// [0, 1] extrapolate. An empty list shows the first mesh or design.
///
/// ```
/// use bevy::prelude::*;
/// use morphospace::geometry::DVec2;
/// use morphospace::mesh::TriangleMesh;
/// use morphospace::stage::{BlendWeights, MeshFamily, Morph, MorphPlugin};
///
/// let triangle = |x: f64, y: f64| {
///     let corners = vec![DVec2::ZERO, DVec2::new(x, 0.0), DVec2::new(0.0, y)];
///     TriangleMesh::new(corners, vec![[0, 1, 2]])
/// };
/// let meshes = vec![triangle(1.0, 1.0)?, triangle(3.0, 1.0)?, triangle(1.0, 3.0)?];
/// let mut app = App::new();
/// app.add_plugins((MinimalPlugins, MorphPlugin));
/// let weights = BlendWeights(vec![0.5, 0.25, 0.25]);
/// let entity = app.world_mut().spawn((MeshFamily(meshes), weights)).id();
/// while app.world().get::<Morph>(entity).is_none() {
///     app.update();
/// }
/// # Ok::<(), morphospace::mesh::MeshError>(())
/// ```
#[derive(Component, Clone, Debug, Default, PartialEq, Reflect)]
#[reflect(Component, Clone, Debug, Default, PartialEq)]
pub struct BlendWeights(pub Vec<f64>);

/// Finished blend of a mesh family or of several designs, for any weights.
#[derive(Component, Debug)]
pub(super) struct FamilySteering(pub(super) SteeredTransition);

/// Builds the blend of several meshes with the same faces.
pub(super) fn build(
    meshes: Vec<TriangleMesh>,
    progress: &dyn Progress,
) -> Result<SteeredTransition, BuildError> {
    // The faces are compared first, because meshes with different faces would otherwise be matched
    // by their outlines.
    let mesh_refs: Vec<&TriangleMesh> = meshes.iter().collect();
    if let Err(error) = CompatibleFamily::from_meshes(&mesh_refs) {
        return Err(BuildError::Unavailable(error.to_string()));
    }
    let designs = meshes.into_iter().enumerate();
    let designs = designs.map(|(k, mesh)| Arc::new(Design::new(format!("mesh {}", k + 1), mesh)));
    build_steered(designs.collect(), progress)
}

/// Builds the blend of several designs as rigid parts.
pub(super) fn build_steered(
    designs: Vec<Arc<Design>>,
    progress: &dyn Progress,
) -> Result<SteeredTransition, BuildError> {
    let mut spec = SpaceSpec::new(designs);
    spec.content = Some(ContentKind::Solid);
    let space = DesignSpace::build(&spec, progress).map_err(|error| match error {
        SpaceError::Build(error) => error,
        error => BuildError::Unavailable(error.to_string()),
    })?;
    Ok(SteeredTransition::new(&space).unwrap_or_else(|| unreachable!("solids were asked for")))
}

/// Filter for blends that are new or whose weights changed.
type WeightsMoved = Or<(
    Changed<BlendWeights>,
    Added<FamilySteering>,
    Changed<FamilySteering>,
)>;

/// Moves the morph of every family with changed weights to these weights.
pub(super) fn solve_families(
    mut families: Query<(&BlendWeights, &FamilySteering, &mut Morph), WeightsMoved>,
    mut times: ResMut<FrameTimes>,
) {
    let start = Instant::now();
    let mut has_sought = false;
    for (BlendWeights(weights), FamilySteering(steered), mut morph) in &mut families {
        if let Some(t) = steered.set_weights(weights) {
            morph.0.seek(t);
            has_sought = true;
        }
    }
    if has_sought {
        times.solve.record(start.elapsed());
    }
}
