//! `MorphPlugin` alone, in a Bevy program of its own: two meshes are spawned
//! with a `Blend`, and a puck that is dragged along a bar morphs them. Until it
//! is touched it swings by itself.
//!
//! `cargo run --release --example two_meshes`

use std::f64::consts::TAU;

use bevy::prelude::*;
use morphospace::colour::Rgb;
use morphospace::geometry::DVec2;
use morphospace::mesh::{MeshError, TriangleMesh};
use morphospace::stage::{
    Blend, BuildFailed, Morph, MorphPlugin, MorphSystems, SourceMesh, StageStyle, StageVisibility,
    TargetMesh,
};
use morphospace::transition::TransitionStyle;

/// Seconds from one star to the other and back.
const PERIOD_SECS: f64 = 6.0;

/// Where the bar begins and ends, below the stars.
const BAR: [Vec2; 2] = [Vec2::new(-200.0, -340.0), Vec2::new(200.0, -340.0)];

/// What is dragged, and where on the bar it is.
#[derive(Component, Default)]
struct Puck {
    t: f64,
    has_been_touched: bool,
}

fn main() -> AppExit {
    App::new()
        .add_plugins((DefaultPlugins, MorphPlugin))
        .insert_resource(ClearColor(Color::srgb_u8(0x1b, 0x1f, 0x27)))
        .add_systems(Startup, (spawn_pair, spawn_puck))
        .add_systems(Update, drag_puck.in_set(MorphSystems::Input))
        .add_systems(Update, move_blend.in_set(MorphSystems::Playback))
        .add_systems(Update, show_t.after(MorphSystems::Solve))
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
            style: TransitionStyle {
                source: Rgb([0x4c, 0x8f, 0xd6]),
                target: Rgb([0xe3, 0x9a, 0x3b]),
                ground: Rgb([0x1b, 0x1f, 0x27]),
                ..default()
            },
            show: StageVisibility {
                wireframe: true,
                ..default()
            },
        },
    ));
    Ok(())
}

fn spawn_puck(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut colours: ResMut<Assets<ColorMaterial>>,
) {
    let [from, to] = BAR;
    let mut shape = |mesh: Mesh, grey: u8| {
        let colour = colours.add(Color::srgb_u8(grey, grey, grey));
        (Mesh2d(meshes.add(mesh)), MeshMaterial2d(colour))
    };
    let bar = Rectangle::new(from.distance(to), 2.0);
    commands.spawn((
        shape(bar.into(), 0x60),
        Transform::from_translation(from.midpoint(to).extend(0.0)),
    ));
    commands.spawn((Puck::default(), shape(Circle::new(12.0).into(), 0xd0)));
}

/// The puck follows the pointer while a button is down.
fn drag_puck(
    mut pucks: Query<(&mut Puck, &mut Transform)>,
    buttons: Res<ButtonInput<MouseButton>>,
    window: Single<&Window>,
    camera: Single<(&Camera, &GlobalTransform)>,
    time: Res<Time>,
) {
    let (camera, place) = *camera;
    let pointer = window
        .cursor_position()
        .filter(|_| buttons.pressed(MouseButton::Left));
    let pointer = pointer.and_then(|px| camera.viewport_to_world_2d(place, px).ok());
    let [from, to] = BAR;
    for (mut puck, mut transform) in &mut pucks {
        if let Some(p) = pointer {
            let share = (p - from).dot(to - from) / (to - from).length_squared();
            puck.t = f64::from(share.clamp(0.0, 1.0));
            puck.has_been_touched = true;
        } else if !puck.has_been_touched {
            puck.t = 0.5 - 0.5 * (TAU * time.elapsed_secs_f64() / PERIOD_SECS).cos();
        }
        transform.translation = from.lerp(to, puck.t as f32).extend(1.0);
    }
}

fn move_blend(puck: Single<&Puck>, mut blends: Query<&mut Blend>) {
    for mut blend in &mut blends {
        blend.t = puck.t;
    }
}

/// After solving the frame is that of this update.
fn show_t(morphs: Query<&Morph, Changed<Morph>>, mut window: Single<&mut Window>) {
    for morph in &morphs {
        window.title = format!("t = {:.2}", morph.frame().t());
    }
}

fn report_failure(failed: On<BuildFailed>) {
    error!("{}: {}", failed.entity, failed.error);
}
