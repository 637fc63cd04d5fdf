//! The stage: transitions in a Bevy world.
//!
//! An entity is a transition on the stage: [`SourceMesh`], [`TargetMesh`],
//! [`Blend`], and the [`ArapSolver`] that was prefactored from them. Each frame,
//! where `Blend` changed, one system solves and one writes the render mesh. In
//! field mode the entity carries a [`FieldSprite`]: a mesh whose fragment
//! shader samples both distance fields and draws the threshold's contour.
//! [`MorphPlugin`] brings just that, without window, keys or panels.
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
//! use morphospace::stage::{ArapSolver, Blend, MorphPlugin, SourceMesh, TargetMesh};
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
//! while app.world().get::<ArapSolver>(entity).is_none() {
//!     app.update();
//! }
//! # Ok::<(), morphospace::mesh::MeshError>(())
//! ```

mod build;
mod camera;
mod capture;
mod carried;
mod colours;
mod components;
mod draw;
mod field;
mod fill;
mod grid;
mod ink;
mod parts;
mod pipelines;
mod shapes;
mod solve;
mod times;
mod view;

use bevy::asset::embedded_asset;
use bevy::prelude::*;
use bevy::sprite_render::Material2dPlugin;

pub use camera::StageCamera;
pub use capture::{CaptureStage, StageCaptured};
pub use components::{
    ArapSolver, Blend, BuildFailed, FieldSprite, MorphOptions, PictureSprite, Show, SourceMesh,
    StageStyle, StageTransition, TargetMesh,
};
pub use times::{Durations, FrameTimes, REMEMBERED};
pub use view::StageView;

/// Morphs every entity that has a [`SourceMesh`], a [`TargetMesh`] and a
/// [`Blend`], or a [`StageTransition`].
///
/// Add it after Bevy's own plugins: it draws if their renderer is there, and
/// otherwise only builds and solves.
#[derive(Clone, Copy, Debug, Default)]
pub struct MorphPlugin;

/// What happens in a frame, in this order, in [`Update`].
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum MorphSystems {
    /// Programs turn input into intents. The plugin has nothing here.
    Input,
    /// Programs move [`Blend`]. The plugin has nothing here.
    Playback,
    /// Transitions are built, taken in and sought.
    Solve,
    /// Render meshes, uniforms and cameras are written.
    Draw,
    /// Pictures are taken.
    Capture,
}

impl Plugin for MorphPlugin {
    fn build(&self, app: &mut App) {
        use MorphSystems::{Capture, Draw, Input, Playback, Solve};
        app.init_resource::<FrameTimes>()
            .init_resource::<StageView>()
            .configure_sets(Update, (Input, Playback, Solve, Draw, Capture).chain())
            .add_systems(Update, solve_systems().in_set(Solve))
            .add_systems(Update, camera::apply_view.in_set(Draw));
        if app.is_plugin_added::<AssetPlugin>() {
            add_drawing(app);
        }
        add_capture(app);
    }
}

fn solve_systems() -> impl IntoScheduleConfigs<bevy::ecs::system::ScheduleSystem, ()> {
    (
        build::start_builds,
        build::finish_builds,
        build::adopt_transitions,
        solve::solve_frames,
    )
        .chain()
}

fn add_drawing(app: &mut App) {
    embedded_asset!(app, "ink.wgsl");
    embedded_asset!(app, "field.wgsl");
    embedded_asset!(app, "colours.wgsl");
    embedded_asset!(app, "grid.wgsl");
    for init in [init_asset::<Mesh>, init_asset::<Image>] {
        init(app);
    }
    app.add_plugins((
        Material2dPlugin::<ink::InkMaterial>::default(),
        Material2dPlugin::<field::FieldMaterial>::default(),
        Material2dPlugin::<colours::ColourMaterial>::default(),
        Material2dPlugin::<grid::GridMaterial>::default(),
    ))
    .add_observer(parts::undress::<ArapSolver>)
    .add_observer(parts::undress::<FieldSprite>)
    .add_observer(parts::undress::<PictureSprite>)
    .add_systems(
        Update,
        (
            parts::dress,
            draw::draw_solids,
            draw::draw_fields,
            draw::draw_pictures,
            draw::draw_grids,
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
    app.init_resource::<capture::Captures>()
        .add_message::<CaptureStage>()
        .add_message::<StageCaptured>()
        .add_systems(
            Update,
            (capture::advance_captures, capture::begin_captures)
                .chain()
                .in_set(MorphSystems::Capture),
        );
}
