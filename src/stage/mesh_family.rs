//! Many meshes of the same faces on one entity, and how much of each there is.
//!
//! Guarantees: as for two; what is shown is the blend of the weights of this update. Weights
//! that are not one for each mesh, or not finite, leave the picture as it was.

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

/// Two meshes or more of the same faces in the same order. Together with [`BlendWeights`] it
/// is all that an entity needs to show every blend of them, as rigid as can be.
///
/// Changing it builds the blend anew.
#[derive(Component, Clone, Debug, Reflect)]
#[reflect(opaque)]
#[reflect(Component, Clone, Debug)]
#[require(BlendWeights, StageStyle, Transform, Visibility)]
pub struct MeshFamily(pub Vec<TriangleMesh>);

/// How much of each mesh of a [`MeshFamily`] is shown, or of each of three or more designs: a
/// weight for each, which sum to one; outside [0, 1] they extrapolate. None at all is the first.
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

/// What a family was built into.
#[derive(Component, Debug)]
pub(super) struct FamilySteering(pub(super) SteeredTransition);

/// The blend of some meshes.
pub(super) fn build(
    meshes: Vec<TriangleMesh>,
    progress: &dyn Progress,
) -> Result<SteeredTransition, BuildError> {
    // Outlines would be matched: meshes bring their match along, or are none of a family.
    let given: Vec<&TriangleMesh> = meshes.iter().collect();
    if let Err(error) = CompatibleFamily::from_meshes(&given) {
        return Err(BuildError::Unavailable(error.to_string()));
    }
    let designs = meshes.into_iter().enumerate();
    let designs = designs.map(|(k, mesh)| Arc::new(Design::new(format!("mesh {}", k + 1), mesh)));
    steered(designs.collect(), progress)
}

/// The blend of some designs, as rigid parts.
pub(super) fn steered(
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

/// Families whose weights moved, or that are new.
type WeightsMoved = Or<(
    Changed<BlendWeights>,
    Added<FamilySteering>,
    Changed<FamilySteering>,
)>;

/// Seeks every family whose weights moved.
pub(super) fn solve_families(
    mut families: Query<(&BlendWeights, &FamilySteering, &mut Morph), WeightsMoved>,
    mut times: ResMut<FrameTimes>,
) {
    let start = Instant::now();
    let mut has_sought = false;
    for (BlendWeights(weights), FamilySteering(steered), mut morph) in &mut families {
        if let Some(t) = steered.set(weights) {
            morph.0.seek(t);
            has_sought = true;
        }
    }
    if has_sought {
        times.solve.record(start.elapsed());
    }
}
