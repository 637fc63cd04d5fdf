//! Many meshes in a Bevy program of its own: four stars at the corners of a square, and a puck
//! that is dragged between them; until it is touched it wanders by itself. The weights are those
//! of natural neighbours, as on the program's map.
//!
//! `cargo run --release --example puck`

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

/// Half a side of the square that the puck walks in, and where its middle is.
const HALF: f32 = 110.0;
const MIDDLE: Vec2 = Vec2::new(0.0, -220.0);

/// Where the stars are, in units of the half side.
const SITES: [Vec2; 4] = [
    Vec2::new(-1.0, 1.0),
    Vec2::new(1.0, 1.0),
    Vec2::new(1.0, -1.0),
    Vec2::new(-1.0, -1.0),
];

/// What is dragged, and the map that it walks on.
#[derive(Component)]
struct Puck {
    map: WeightMap,
    has_been_touched: bool,
}

fn main() -> AppExit {
    App::new()
        .add_plugins((DefaultPlugins, MorphPlugin))
        .insert_resource(ClearColor(Color::srgb_u8(0x1b, 0x1f, 0x27)))
        .add_systems(Startup, (spawn_stars, spawn_puck))
        .add_systems(Update, move_puck.in_set(MorphSystems::Input))
        .add_systems(Update, weigh.in_set(MorphSystems::Playback))
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
) -> Result {
    let mut shape = |mesh: Mesh, grey: u8| {
        let colour = colours.add(Color::srgb_u8(grey, grey, grey));
        (Mesh2d(meshes.add(mesh)), MeshMaterial2d(colour))
    };
    for site in SITES {
        let at = MIDDLE + site * HALF;
        let dot = shape(Circle::new(5.0).into(), 0x80);
        commands.spawn((dot, Transform::from_translation(at.extend(0.0))));
    }
    let puck = Puck {
        map: WeightMap::new(&SITES.map(|site| site.as_dvec2()))?,
        has_been_touched: false,
    };
    commands.spawn((puck, shape(Circle::new(12.0).into(), 0xd0)));
    Ok(())
}

/// The puck follows the pointer while a button is down.
fn move_puck(
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
    for (mut puck, mut transform) in &mut pucks {
        let now = time.elapsed_secs();
        let to = match pointer {
            Some(at) => {
                puck.has_been_touched = true;
                ((at - MIDDLE) / HALF).clamp(Vec2::NEG_ONE, Vec2::ONE)
            }
            None if puck.has_been_touched => continue,
            None => Vec2::new((0.7 * now).sin(), (1.1 * now).sin()),
        };
        transform.translation = (MIDDLE + to * HALF).extend(1.0);
    }
}

/// Natural neighbours at the puck.
fn weigh(puck: Single<(&Puck, &Transform)>, mut all: Query<&mut BlendWeights>) {
    let (puck, transform) = *puck;
    let at = (transform.translation.truncate() - MIDDLE) / HALF;
    let mut weights = vec![0.0; SITES.len()];
    puck.map.weights(at.as_dvec2(), &mut weights);
    for mut blend in &mut all {
        // What is written to is solved.
        blend.set_if_neq(BlendWeights(weights.clone()));
    }
}

fn report_failure(failed: On<BuildFailed>) {
    error!("{}: {}", failed.entity, failed.error);
}
