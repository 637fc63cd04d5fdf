//! The stage: a Bevy plugin that builds transitions, moves them to their blend parameter and draws
//! them, and that captures pictures of them.
//!
//! The simplest transition is an entity with [`SourceMesh`], [`TargetMesh`] and [`Blend`], from
//! which the plugin builds a [`Morph`]. A [`MeshFamily`] blends several meshes, [`MorphDesigns`]
//! loads designs as assets, and a [`StageTransition`] holds a transition built elsewhere. Each
//! frame, one system moves the morphs whose `Blend` changed to the new t, and another one draws
//! them according to their content: solids as render meshes, distance fields and pictures as meshes
//! whose fragment shader samples both designs as textures.
//!
//! [`MorphPlugin`] adds no window, keys or panels. [`MorphSystems`] lists its system sets, so that
//! a program can order its own systems among them.
//!
//! The graphics card plays transitions of solids that have been recorded
//! ([`Transition::record`](crate::transition::Transition::record)): the intervals of the recording
//! are uploaded once, the vertex shader evaluates the positions of faces and wireframes, and the
//! CPU writes no vertices while t moves within [0, 1].
//!
//! Guaranteed: frames cannot fail, and they reuse their memory, except that boundaries without
//! faces are triangulated anew in each frame. Builds run on a task pool; a failed build triggers
//! [`BuildFailed`] on its entity. Without a renderer everything except drawing works. Not
//! guaranteed: the order of several cameras or entities, which is that of Bevy.
//!
//! ```
//! use bevy::prelude::*;
//! use morphospace::geometry::DVec2;
//! use morphospace::mesh::TriangleMesh;
//! use morphospace::stage::{Blend, Morph, MorphPlugin, SourceMesh, TargetMesh};
//!
//! let triangle = |x: f64| {
//!     let corners = vec![DVec2::ZERO, DVec2::new(x, 0.0), DVec2::Y];
//!     TriangleMesh::new(corners, vec![[0, 1, 2]])
//! };
//! let mut app = App::new();
//! app.add_plugins((MinimalPlugins, MorphPlugin));
//! let entity = app.world_mut().spawn((
//!     SourceMesh(triangle(1.0)?),
//!     TargetMesh(triangle(3.0)?),
//!     Blend { t: 0.5 },
//! ));
//! let entity = entity.id();
//! while app.world().get::<Morph>(entity).is_none() {
//!     app.update();
//! }
//! # Ok::<(), morphospace::mesh::MeshError>(())
//! ```

mod build;
mod camera;
mod capture;
mod carried_mesh;
mod components;
mod designs;
mod draw;
mod field_material;
mod frame_times;
mod gradients;
mod ink_material;
mod line_mesh;
mod mesh_family;
mod paint;
mod paint_layers;
mod part_assembly;
mod parts;
mod picture_material;
mod pipelines;
mod recorded_material;
mod recording_upload;
mod ring_fill;
mod solve;
mod stage_view;
mod uploaded_recording;
mod vertices;
mod warm_up;
mod warp_grid;

use bevy::asset::embedded_asset;
use bevy::prelude::*;
use bevy::sprite_render::Material2dPlugin;

pub use camera::StageCamera;
pub use capture::{CaptureStage, StageCaptured};
pub use components::{
    Blend, BuildFailed, Morph, MorphOptions, SourceMesh, StageStyle, StageTransition,
    StageVisibility, TargetMesh,
};
pub use designs::{DesignAsset, DesignLoader, LoadDesignError, MorphDesigns};
pub use frame_times::{DurationHistory, FrameTimes, HISTORY_LEN};
pub use mesh_family::{BlendWeights, MeshFamily};
pub use pipelines::PipelinesReady;
pub use stage_view::StageView;

/// Bevy plugin that morphs entities. An entity needs one of these sets of components:
/// [`SourceMesh`], [`TargetMesh`] and [`Blend`]; [`MeshFamily`] and [`BlendWeights`];
/// [`MorphDesigns`]; or [`StageTransition`].
///
/// Add it after Bevy's own plugins. Without a renderer, the plugin builds and solves transitions
/// but does not draw them.
#[derive(Clone, Copy, Debug, Default)]
pub struct MorphPlugin;

/// System sets of the plugin, run in this order in [`Update`]. Commands of one set are applied
/// before the next set runs.
///
/// ```
/// use bevy::prelude::*;
/// use morphospace::stage::{Blend, Morph, MorphPlugin, MorphSystems};
///
/// fn play(time: Res<Time>, mut blends: Query<&mut Blend>) {
///     for mut blend in &mut blends {
///         blend.t = time.elapsed_secs_f64().fract();
///     }
/// }
///
/// fn follow(morphs: Query<&Morph, Changed<Morph>>) {
///     for morph in &morphs {
///         let _places = &morph.frame().placement().in_frame;
///     }
/// }
///
/// let mut app = App::new();
/// app.add_plugins((MinimalPlugins, MorphPlugin));
/// app.add_systems(Update, play.in_set(MorphSystems::Playback));
/// app.add_systems(Update, follow.after(MorphSystems::Solve));
/// app.update();
/// ```
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum MorphSystems {
    /// Empty set for a program's own systems that read input. The plugin has no systems here.
    Input,
    /// Empty set for a program's own systems that change [`Blend`], meshes, options and styles. The
    /// plugin has no systems here.
    Playback,
    /// Starts a background build for each entity with new meshes, designs or options. Adds a
    /// [`Morph`] to an entity when its build finishes, and triggers [`BuildFailed`] if the build
    /// fails. A [`StageTransition`] holds a transition that the program has built itself. Its
    /// entity gets the [`Morph`] at once, without another build.
    Build,
    /// Moves each [`Morph`] to the t of its [`Blend`]. Systems that run later see the frame at this
    /// t. If the graphics card evaluates the morph from a recording, the CPU computes its vertices
    /// only when they are read.
    Solve,
    /// Updates render meshes, material uniforms and cameras.
    Draw,
    /// Takes the pictures requested by [`CaptureStage`].
    Capture,
}

impl Plugin for MorphPlugin {
    fn build(&self, app: &mut App) {
        use MorphSystems::{Build, Capture, Draw, Input, Playback, Solve};
        let build_systems = (
            (build::start_builds, build::start_families),
            build::finish_builds,
            build::adopt_transitions,
        );
        app.init_resource::<FrameTimes>()
            .init_resource::<StageView>()
            .configure_sets(
                Update,
                (Input, Playback, Build, Solve, Draw, Capture).chain(),
            )
            .add_systems(Update, build_systems.chain().in_set(Build))
            .add_systems(
                Update,
                (solve::solve_frames, mesh_family::solve_families).in_set(Solve),
            )
            .add_systems(Update, camera::apply_view.in_set(Draw));
        // A program without assets has no render meshes; it only builds and solves.
        if app.is_plugin_added::<AssetPlugin>() {
            add_drawing(app);
        }
        add_capture(app);
    }
}

/// Adds the materials, shaders, asset loaders and systems that drawing needs.
fn add_drawing(app: &mut App) {
    embedded_asset!(app, "stage/ink.wgsl");
    embedded_asset!(app, "stage/played.wgsl");
    embedded_asset!(app, "stage/field.wgsl");
    embedded_asset!(app, "stage/colours.wgsl");
    embedded_asset!(app, "stage/grid.wgsl");
    for init_asset_type in [init_asset::<Mesh>, init_asset::<Image>] {
        init_asset_type(app);
    }
    let reads = designs::start_designs.before(build::finish_builds);
    app.init_asset::<DesignAsset>()
        .init_asset_loader::<DesignLoader>()
        .add_systems(Update, reads.in_set(MorphSystems::Build));
    app.add_plugins((
        Material2dPlugin::<ink_material::InkMaterial>::default(),
        Material2dPlugin::<recorded_material::RecordedMaterial>::default(),
        Material2dPlugin::<field_material::FieldMaterial>::default(),
        Material2dPlugin::<picture_material::PictureMaterial>::default(),
        Material2dPlugin::<warp_grid::GridMaterial>::default(),
    ))
    .add_systems(
        Startup,
        (recording_upload::detect_gpu, warm_up::warm_up_pipelines).chain(),
    )
    // The observer despawns the render parts of a morph whenever the morph is removed.
    .add_observer(part_assembly::despawn_parts)
    .add_systems(
        Update,
        // The systems are chained, so Bevy applies the commands of one before the next runs. Render
        // parts are therefore drawn in the frame in which they are spawned.
        (
            part_assembly::spawn_parts,
            (
                recording_upload::finish_uploads,
                recording_upload::start_uploads,
            ),
            draw::draw_morphs,
            parts::place_parts,
        )
            .chain()
            .in_set(MorphSystems::Draw),
    );
}

/// Registers an asset type, unless Bevy's renderer has already registered it.
fn init_asset<A: Asset>(app: &mut App) {
    if !app.world().contains_resource::<Assets<A>>() {
        app.init_asset::<A>();
    }
}

/// Adds the messages and systems that capture pictures of the stage.
fn add_capture(app: &mut App) {
    pipelines::watch_pipelines(app);
    app.init_resource::<capture::PendingCaptures>()
        .add_message::<CaptureStage>()
        .add_message::<StageCaptured>()
        .add_systems(
            Update,
            (capture::advance_captures, capture::begin_captures)
                .chain()
                .in_set(MorphSystems::Capture),
        );
}
