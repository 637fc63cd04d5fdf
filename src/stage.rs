//! The stage: transitions in a Bevy world.
//!
//! An entity is a transition on the stage: [`SourceMesh`], [`TargetMesh`],
//! [`Blend`], and the [`Morph`] that was prefactored from them. Each frame,
//! where `Blend` changed, one system solves and one draws by content: solids
//! as render meshes, distance fields and pictures as meshes whose fragment
//! shader samples both as textures. [`MorphPlugin`] brings just that, without
//! window, keys or panels; [`MorphSystems`] says where in a frame its systems
//! run, so that a program can order its own.
//!
//! A transition of solids whose film was recorded ([`Transition::record`](crate::transition::Transition::record)) is played
//! from the graphics card: its reels are sent there once, faces and wires are summed
//! in the vertex shader, and no vertex is written while t moves within [0, 1].
//!
//! Guarantees: frames neither fail nor allocate what the last one had, but for
//! boundaries without faces, which are triangulated as they move; builds
//! run on a task pool, and a failed one is a [`BuildFailed`] on its entity;
//! without a renderer everything but the drawing works. Does not guarantee
//! order among several cameras or entities: those are Bevy's, as usual.
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
pub use frame_times::{FrameTimes, REMEMBERED, StageTimes};
pub use mesh_family::{BlendWeights, MeshFamily};
pub use pipelines::PipelinesReady;
pub use stage_view::StageView;

/// Morphs every entity that has a [`SourceMesh`], a [`TargetMesh`] and a
/// [`Blend`], a [`MeshFamily`] and [`BlendWeights`], [`MorphDesigns`], or a
/// [`StageTransition`].
///
/// Add it after Bevy's own plugins: it draws if their renderer is there, and
/// otherwise only builds and solves.
#[derive(Clone, Copy, Debug, Default)]
pub struct MorphPlugin;

/// What happens in a frame, in this order, in [`Update`]. What one does, the
/// next one sees.
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
    /// Programs turn input into intents. The plugin has nothing here.
    Input,
    /// Programs move [`Blend`] and change meshes, options and styles; the
    /// plugin has nothing here.
    Playback,
    /// Builds are started where meshes or options are new, those that are done
    /// are taken in and [`BuildFailed`] is triggered for those that cannot be
    /// had; a [`StageTransition`] becomes a [`Morph`].
    Build,
    /// Each [`Morph`] is sought to its [`Blend`]: afterwards its frame is that
    /// of this update, placed already or, where the graphics card plays it, when
    /// it is read.
    Solve,
    /// Render meshes, uniforms and cameras are written.
    Draw,
    /// Pictures that were asked for by [`CaptureStage`] are taken.
    Capture,
}

impl Plugin for MorphPlugin {
    fn build(&self, app: &mut App) {
        use MorphSystems::{Build, Capture, Draw, Input, Playback, Solve};
        let builds = (
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
            .add_systems(Update, builds.chain().in_set(Build))
            .add_systems(
                Update,
                (solve::solve_frames, mesh_family::solve_families).in_set(Solve),
            )
            .add_systems(Update, camera::apply_view.in_set(Draw));
        // Without assets there are no meshes: such a program builds and solves
        // alone.
        if app.is_plugin_added::<AssetPlugin>() {
            add_drawing(app);
        }
        add_capture(app);
    }
}

fn add_drawing(app: &mut App) {
    embedded_asset!(app, "stage/ink.wgsl");
    embedded_asset!(app, "stage/played.wgsl");
    embedded_asset!(app, "stage/field.wgsl");
    embedded_asset!(app, "stage/colours.wgsl");
    embedded_asset!(app, "stage/grid.wgsl");
    for init in [init_asset::<Mesh>, init_asset::<Image>] {
        init(app);
    }
    let reads = designs::start_designs.before(build::finish_builds);
    app.init_asset::<DesignAsset>()
        .init_asset_loader::<DesignLoader>()
        .add_systems(Update, reads.in_set(MorphSystems::Build));
    app.add_plugins((
        Material2dPlugin::<ink_material::InkMaterial>::default(),
        Material2dPlugin::<recorded_material::PlayedMaterial>::default(),
        Material2dPlugin::<field_material::FieldMaterial>::default(),
        Material2dPlugin::<picture_material::ColourMaterial>::default(),
        Material2dPlugin::<warp_grid::GridMaterial>::default(),
    ))
    .add_systems(
        Startup,
        (recording_upload::find_card, warm_up::warm).chain(),
    )
    // An observer, so that parts go whenever their frame is taken away.
    .add_observer(part_assembly::undress)
    .add_systems(
        Update,
        // Between systems of a chain commands are applied, so that parts are
        // written and placed in the frame that spawns them.
        (
            part_assembly::dress,
            (recording_upload::take_films, recording_upload::send_films),
            draw::draw_morphs,
            parts::place_parts,
        )
            .chain()
            .in_set(MorphSystems::Draw),
    );
}

/// Bevy's renderer brings these; without it they are still wanted.
fn init_asset<A: Asset>(app: &mut App) {
    if !app.world().contains_resource::<Assets<A>>() {
        app.init_asset::<A>();
    }
}

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
