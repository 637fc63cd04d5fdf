//! Designs as assets: Bevy's asset server reads the files, and the transition of an entity is
//! rebuilt when one of its files is reloaded.
//!
//! Guaranteed: a build starts only when all designs of an entity are loaded. The previous
//! transition stays until the new one is ready. It also stays if a reloaded file cannot be read,
//! which triggers a [`BuildFailed`].

use std::sync::Arc;

use bevy::asset::io::Reader;
use bevy::asset::{AssetLoadFailedEvent, AssetLoader, LoadContext};
use bevy::platform::collections::HashSet;
use bevy::prelude::*;

use crate::design::{Design, ImportError, ImportOptions, extensions, import};
use crate::transition::{BuildError, Transition, TransitionSpec};
use crate::work::progress::Progress;

use super::build::{BuildOutcome, TransitionBuild};
use super::components::{Blend, BuildFailed, StageStyle};
use super::mesh_family::{BlendWeights, build_steered};

/// A design that `AssetServer::load` has read from a file, in any format that
/// [`import`](crate::design::import) knows. The settings of the asset are [`ImportOptions`].
#[derive(Asset, TypePath, Clone, Debug)]
pub struct DesignAsset(pub Arc<Design>);

/// Asset loader of [`DesignAsset`]. [`MorphPlugin`](super::MorphPlugin) registers it if the app has
/// an asset server.
#[derive(TypePath, Clone, Debug)]
pub struct DesignLoader {
    extensions: Vec<&'static str>,
}

impl Default for DesignLoader {
    fn default() -> Self {
        Self {
            extensions: extensions(),
        }
    }
}

/// Reasons why a [`DesignAsset`] cannot be loaded.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum LoadDesignError {
    /// The file cannot be read.
    #[error(transparent)]
    Read(#[from] std::io::Error),
    /// The file does not contain a valid design.
    #[error(transparent)]
    Import(#[from] ImportError),
}

impl AssetLoader for DesignLoader {
    type Asset = DesignAsset;
    type Settings = ImportOptions;
    type Error = LoadDesignError;

    async fn load(
        &self,
        reader: &mut dyn Reader,
        settings: &ImportOptions,
        context: &mut LoadContext<'_>,
    ) -> Result<DesignAsset, LoadDesignError> {
        let mut bytes = Vec::new();
        reader.read_to_end(&mut bytes).await?;
        let path = context.path().path();
        let name = path.file_stem().unwrap_or_default().to_string_lossy();
        Ok(DesignAsset(Arc::new(import(&name, &bytes, settings)?)))
    }

    fn extensions(&self) -> &[&str] {
        &self.extensions
    }
}

/// Two or more design assets whose transition an entity shows. The designs are matched
/// automatically, with the default options. Two designs are blended according to [`Blend`]; three
/// or more are blended as rigid parts according to [`BlendWeights`].
///
/// Replacing the component, or reloading one of the files, rebuilds the transition.
///
/// ```no_run
/// use bevy::prelude::*;
/// use morphospace::stage::{Blend, MorphDesigns, MorphPlugin};
///
/// fn spawn(mut commands: Commands, server: Res<AssetServer>) {
///     commands.spawn(Camera2d);
///     let designs = ["rest.svg", "leap.svg"].map(|path| server.load(path));
///     commands.spawn((MorphDesigns(designs.to_vec()), Blend { t: 0.5 }));
/// }
///
/// App::new()
///     .add_plugins((DefaultPlugins, MorphPlugin))
///     .add_systems(Startup, spawn)
///     .run();
/// ```
#[derive(Component, Clone, Debug, Reflect)]
#[reflect(Component, Clone, Debug)]
#[require(Blend, BlendWeights, StageStyle, Transform, Visibility)]
pub struct MorphDesigns(pub Vec<Handle<DesignAsset>>);

/// Starts a build for each entity whose designs are all loaded, if its [`MorphDesigns`] changed or
/// one of its designs was loaded or reloaded. Triggers [`BuildFailed`] for each design of an entity
/// that cannot be loaded.
pub(super) fn start_designs(
    mut commands: Commands,
    assets: Res<Assets<DesignAsset>>,
    mut read: MessageReader<AssetEvent<DesignAsset>>,
    mut failed: MessageReader<AssetLoadFailedEvent<DesignAsset>>,
    entities: Query<(Entity, Ref<MorphDesigns>)>,
) {
    let new_id = |event: &AssetEvent<DesignAsset>| match *event {
        AssetEvent::Added { id } | AssetEvent::Modified { id } => Some(id),
        _ => None,
    };
    let new: HashSet<AssetId<DesignAsset>> = read.read().filter_map(new_id).collect();
    let failed: Vec<_> = failed.read().collect();
    for (entity, designs) in &entities {
        let ids = || designs.0.iter().map(Handle::id);
        for failure in failed.iter().filter(|f| ids().any(|id| id == f.id)) {
            let error = BuildError::Unavailable(failure.error.to_string());
            commands.trigger(BuildFailed { entity, error });
        }
        if !designs.is_changed() && !ids().any(|id| new.contains(&id)) {
            continue;
        }
        let loaded = ids().map(|id| assets.get(id).map(|asset| Arc::clone(&asset.0)));
        if let Some(loaded) = loaded.collect::<Option<Vec<_>>>() {
            let building = TransitionBuild::start(move |progress| build(loaded, progress));
            commands.entity(entity).try_insert(building);
        }
    }
}

/// Builds the transition between two designs, or the blend of any other number of designs.
fn build(designs: Vec<Arc<Design>>, progress: &dyn Progress) -> Result<BuildOutcome, BuildError> {
    match <[_; 2]>::try_from(designs) {
        Ok([source, target]) => {
            let spec = TransitionSpec::new(source, target);
            Transition::build(&spec, progress).map(BuildOutcome::Pair)
        }
        Err(designs) => build_steered(designs, progress).map(BuildOutcome::Family),
    }
}
