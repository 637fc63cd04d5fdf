//! `MorphPlugin` alone, in a Bevy program of its own: two meshes are spawned
//! with a `Blend`, a system moves the blend, and they morph.
//!
//! `cargo run --release --example two_meshes`

use std::f64::consts::TAU;

use bevy::prelude::*;
use morphospace::geometry::DVec2;
use morphospace::mesh::{MeshError, TriangleMesh};
use morphospace::stage::{
    Blend, BuildFailed, MorphPlugin, Show, SourceMesh, StageStyle, TargetMesh,
};
use morphospace::transition::{Rgb, Style};

/// Seconds from one star to the other and back.
const PERIOD_SECS: f64 = 6.0;

fn main() -> AppExit {
    App::new()
        .add_plugins((DefaultPlugins, MorphPlugin))
        .insert_resource(ClearColor(Color::srgb_u8(0x1b, 0x1f, 0x27)))
        .add_systems(Startup, spawn_pair)
        .add_systems(Update, move_blend)
        .add_observer(report_failure)
        .run()
}

/// A star of twelve points around a hub, twisted by an angle in radians.
fn star(inner: f64, outer: f64, twist: f64) -> Result<TriangleMesh, MeshError> {
    let corner = |i: u32| {
        let is_tip = i % 2 == 1;
        let radius = if is_tip { outer } else { inner };
        let turn = if is_tip { twist } else { 0.0 };
        DVec2::from_angle(TAU * f64::from(i) / 24.0 + turn) * radius
    };
    let hub = |i: u32| DVec2::from_angle(TAU * f64::from(i) / 12.0) * 60.0;
    let positions = (0..24).map(corner).chain((0..12).map(hub)).collect();
    let tips = (0..12).map(|i| [2 * i, 2 * i + 1, (2 * i + 2) % 24]);
    let belt = (0..12).flat_map(|i| {
        let (a, b, c, d) = (24 + i, 2 * i, (2 * i + 2) % 24, 24 + (i + 1) % 12);
        [[a, b, c], [a, c, d]]
    });
    TriangleMesh::new(positions, tips.chain(belt).collect())
}

fn spawn_pair(mut commands: Commands) -> Result {
    commands.spawn(Camera2d);
    commands.spawn((
        SourceMesh(star(110.0, 190.0, 0.0)?),
        TargetMesh(star(150.0, 330.0, 0.5)?),
        StageStyle {
            style: Style {
                source: Rgb([0x4c, 0x8f, 0xd6]),
                target: Rgb([0xe3, 0x9a, 0x3b]),
                ground: Rgb([0x1b, 0x1f, 0x27]),
                ..default()
            },
            show: Show {
                wireframe: true,
                ..default()
            },
        },
    ));
    Ok(())
}

fn move_blend(time: Res<Time>, mut blends: Query<&mut Blend>) {
    for mut blend in &mut blends {
        blend.t = 0.5 - 0.5 * (TAU * time.elapsed_secs_f64() / PERIOD_SECS).cos();
    }
}

fn report_failure(failed: On<BuildFailed>) {
    error!("{}: {}", failed.entity, failed.error);
}
