//! A small Bevy program with `MeshFamily`, in which four meshes are blended by weights.
//!
//! Each of the four stars belongs to a corner of a square. The position of a marker in the square
//! determines the weights, by natural-neighbour interpolation as on the map of the Morphospace
//! window. The marker wanders by itself until the user drags it.
//!
//! `cargo run --release --example weighted_meshes`

use std::f64::consts::TAU;

use bevy::prelude::*;
use morphospace::colour::Rgb;
use morphospace::geometry::DVec2;
use morphospace::mesh::{MeshError, TriangleMesh};
use morphospace::space::WeightMap;
use morphospace::stage::{
    BlendWeights, BuildFailed, MeshFamily, MorphPlugin, MorphSystems, StageStyle, StageVisibility,
};
use morphospace::transition::TransitionStyle;

/// Half the side of the square in which the marker moves, in pixels.
const HALF_SIDE: f32 = 110.0;

/// Centre of the square in which the marker moves, in pixels from the centre of the window.
const CENTRE: Vec2 = Vec2::new(0.0, -220.0);

/// For each star: the corner of the square to which it belongs, relative to the centre of the
/// square, in units of [`HALF_SIDE`].
const SITES: [Vec2; 4] = [
    Vec2::new(-1.0, 1.0),
    Vec2::new(1.0, 1.0),
    Vec2::new(1.0, -1.0),
    Vec2::new(-1.0, -1.0),
];

/// The marker that the user drags, and the mapping from its position to the weights.
#[derive(Component)]
struct MapMarker {
    map: WeightMap,
    has_been_dragged: bool,
}

fn main() -> AppExit {
    App::new()
        .add_plugins((DefaultPlugins, MorphPlugin))
        .insert_resource(ClearColor(Color::srgb_u8(0x1b, 0x1f, 0x27)))
        .add_systems(Startup, (spawn_stars, spawn_map))
        .add_systems(Update, move_marker.in_set(MorphSystems::Input))
        .add_systems(Update, set_weights.in_set(MorphSystems::Playback))
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
    let hub = |i: u32| DVec2::from_angle(TAU * f64::from(i) / 12.0) * 40.0;
    let up = |p: DVec2| p + DVec2::new(0.0, 130.0);
    let positions = (0..24).map(corner).chain((0..12).map(hub)).map(up);
    let tips = (0..12).map(|i| [2 * i, 2 * i + 1, (2 * i + 2) % 24]);
    let belt = (0..12).flat_map(|i| {
        let (a, b, c, d) = (24 + i, 2 * i, (2 * i + 2) % 24, 24 + (i + 1) % 12);
        [[a, b, c], [a, c, d]]
    });
    TriangleMesh::new(positions.collect(), tips.chain(belt).collect())
}

/// Spawns the camera, and an entity with four meshes, their weights and their style.
fn spawn_stars(mut commands: Commands) -> Result {
    commands.spawn(Camera2d);
    commands.spawn((
        MeshFamily(vec![
            star(70.0, 120.0, 0.0)?,
            star(90.0, 200.0, 0.5)?,
            star(60.0, 190.0, -0.6)?,
            star(130.0, 150.0, 0.0)?,
        ]),
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

/// Spawns the four corners of the square, and the marker.
fn spawn_map(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut colours: ResMut<Assets<ColorMaterial>>,
) -> Result {
    let mut shape = |mesh: Mesh, grey: u8| {
        let colour = colours.add(Color::srgb_u8(grey, grey, grey));
        (Mesh2d(meshes.add(mesh)), MeshMaterial2d(colour))
    };
    for site in SITES {
        let at = CENTRE + site * HALF_SIDE;
        let dot = shape(Circle::new(5.0).into(), 0x80);
        commands.spawn((dot, Transform::from_translation(at.extend(0.0))));
    }
    let marker = MapMarker {
        map: WeightMap::new(&SITES.map(|site| site.as_dvec2()))?,
        has_been_dragged: false,
    };
    commands.spawn((marker, shape(Circle::new(12.0).into(), 0xd0)));
    Ok(())
}

/// Moves the marker to the pointer while the left button is down.
fn move_marker(
    mut markers: Query<(&mut MapMarker, &mut Transform)>,
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
    for (mut marker, mut transform) in &mut markers {
        let now = time.elapsed_secs();
        let to = match pointer {
            Some(at) => {
                marker.has_been_dragged = true;
                ((at - CENTRE) / HALF_SIDE).clamp(Vec2::NEG_ONE, Vec2::ONE)
            }
            None if marker.has_been_dragged => continue,
            None => Vec2::new((0.7 * now).sin(), (1.1 * now).sin()),
        };
        transform.translation = (CENTRE + to * HALF_SIDE).extend(1.0);
    }
}

/// Sets the weights of the blend to those at the marker.
fn set_weights(marker: Single<(&MapMarker, &Transform)>, mut blends: Query<&mut BlendWeights>) {
    let (marker, transform) = *marker;
    let at = (transform.translation.truncate() - CENTRE) / HALF_SIDE;
    let mut weights = vec![0.0; SITES.len()];
    marker.map.weights(at.as_dvec2(), &mut weights);
    for mut blend in &mut blends {
        // Writing the component triggers a solve, so unchanged weights are not written.
        blend.set_if_neq(BlendWeights(weights.clone()));
    }
}

fn report_failure(failed: On<BuildFailed>) {
    error!("{}: {}", failed.entity, failed.error);
}
