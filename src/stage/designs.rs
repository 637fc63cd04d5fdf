//! Designs that are files: Bevy's asset server reads them, and an entity that shows them is
//! built again where one of them was read again.
//!
//! Guarantees: nothing is built before all designs of an entity are there; until the new
//! transition is there the old one stays, and also where a file cannot be read any more,
//! which is told as a [`BuildFailed`].

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
use super::mesh_family::{BlendWeights, steered};

/// A design of a file, as `AssetServer::load` reads it: every format that
/// [`import`](crate::design::import) knows, with its [`ImportOptions`] as settings.
#[derive(Asset, TypePath, Clone, Debug)]
pub struct DesignAsset(pub Arc<Design>);

/// Reads [`DesignAsset`]s. [`MorphPlugin`](super::MorphPlugin) brings it where there are
/// assets.
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

/// Why a file is no design.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum LoadDesignError {
    /// It cannot be read.
    #[error(transparent)]
    Read(#[from] std::io::Error),
    /// What it holds is no design.
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

/// Two designs or more that are assets: all that an entity needs to show what lies between
/// them, matched as the program matches them. Two are moved by [`Blend`], more, as rigid
/// parts, by [`BlendWeights`].
///
/// Other designs, or one that the asset server has read again, build it anew.
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

/// Starts a build wherever all designs are there and one of them is new.
pub(super) fn start_designs(
    mut commands: Commands,
    assets: Res<Assets<DesignAsset>>,
    mut read: MessageReader<AssetEvent<DesignAsset>>,
    mut failed: MessageReader<AssetLoadFailedEvent<DesignAsset>>,
    shown: Query<(Entity, Ref<MorphDesigns>)>,
) {
    let is_new = |event: &AssetEvent<DesignAsset>| match *event {
        AssetEvent::Added { id } | AssetEvent::Modified { id } => Some(id),
        _ => None,
    };
    let new: HashSet<AssetId<DesignAsset>> = read.read().filter_map(is_new).collect();
    let failed: Vec<_> = failed.read().collect();
    for (entity, designs) in &shown {
        let ids = || designs.0.iter().map(Handle::id);
        for failure in failed.iter().filter(|f| ids().any(|id| id == f.id)) {
            let error = BuildError::Unavailable(failure.error.to_string());
            commands.trigger(BuildFailed { entity, error });
        }
        if !designs.is_changed() && !ids().any(|id| new.contains(&id)) {
            continue;
        }
        let all = ids().map(|id| assets.get(id).map(|asset| Arc::clone(&asset.0)));
        if let Some(all) = all.collect::<Option<Vec<_>>>() {
            let building = TransitionBuild::start(move |progress| build(all, progress));
            commands.entity(entity).try_insert(building);
        }
    }
}

fn build(designs: Vec<Arc<Design>>, progress: &dyn Progress) -> Result<BuildOutcome, BuildError> {
    match <[_; 2]>::try_from(designs) {
        Ok([source, target]) => {
            let spec = TransitionSpec::new(source, target);
            Transition::build(&spec, progress).map(BuildOutcome::Pair)
        }
        Err(designs) => steered(designs, progress).map(BuildOutcome::Family),
    }
}
