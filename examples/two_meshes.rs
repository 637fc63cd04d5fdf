//! A small Bevy program with `MorphPlugin`, in which a slider blends two meshes.
//!
//! The meshes are spawned with a `Blend`, whose t is set by a knob on a bar. The knob swings by
//! itself until the user drags it.
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

/// Duration of one swing of the knob, from the first star to the second and back, in seconds.
const PERIOD_SECS: f64 = 6.0;

/// Ends of the slider's bar, in pixels from the centre of the window; y points up.
const BAR: [Vec2; 2] = [Vec2::new(-200.0, -340.0), Vec2::new(200.0, -340.0)];

/// The knob of the slider; `t` is its position on the bar, from 0 to 1.
#[derive(Component, Default)]
struct SliderKnob {
    t: f64,
    has_been_dragged: bool,
}

fn main() -> AppExit {
    App::new()
        .add_plugins((DefaultPlugins, MorphPlugin))
        .insert_resource(ClearColor(Color::srgb_u8(0x1b, 0x1f, 0x27)))
        .add_systems(Startup, (spawn_pair, spawn_slider))
        .add_systems(Update, move_knob.in_set(MorphSystems::Input))
        .add_systems(Update, set_blend.in_set(MorphSystems::Playback))
        .add_systems(Update, show_t.after(MorphSystems::Solve))
        .add_observer(report_failure)
        .run()
}

/// A star with twelve tips and a hole in the middle. The notches have the distance `inner` from the
/// centre, the tips the distance `outer`. The tips are rotated by `twist` radians.
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

/// Spawns the camera, and an entity with two meshes, their blend and their style.
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
            visibility: StageVisibility {
                wireframe: true,
                ..default()
            },
        },
    ));
    Ok(())
}

fn spawn_slider(
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
    commands.spawn((SliderKnob::default(), shape(Circle::new(12.0).into(), 0xd0)));
}

/// Moves the knob to the pointer while the left button is down.
fn move_knob(
    mut knobs: Query<(&mut SliderKnob, &mut Transform)>,
    buttons: Res<ButtonInput<MouseButton>>,
    window: Single<&Window>,
    camera: Single<(&Camera, &GlobalTransform)>,
    time: Res<Time>,
) {
    let (camera, camera_transform) = *camera;
    let pointer = window
        .cursor_position()
        .filter(|_| buttons.pressed(MouseButton::Left));
    let pointer = pointer.and_then(|px| camera.viewport_to_world_2d(camera_transform, px).ok());
    let [from, to] = BAR;
    for (mut knob, mut transform) in &mut knobs {
        if let Some(p) = pointer {
            let fraction = (p - from).dot(to - from) / (to - from).length_squared();
            knob.t = f64::from(fraction.clamp(0.0, 1.0));
            knob.has_been_dragged = true;
        } else if !knob.has_been_dragged {
            knob.t = 0.5 - 0.5 * (TAU * time.elapsed_secs_f64() / PERIOD_SECS).cos();
        }
        transform.translation = from.lerp(to, knob.t as f32).extend(1.0);
    }
}

fn set_blend(knob: Single<&SliderKnob>, mut blends: Query<&mut Blend>) {
    for mut blend in &mut blends {
        blend.t = knob.t;
    }
}

/// Shows t in the title of the window. Runs after solving, so that the title belongs to the frame
/// that is drawn.
fn show_t(morphs: Query<&Morph, Changed<Morph>>, mut window: Single<&mut Window>) {
    for morph in &morphs {
        window.title = format!("t = {:.2}", morph.frame().t());
    }
}

fn report_failure(failed: On<BuildFailed>) {
    error!("{}: {}", failed.entity, failed.error);
}
