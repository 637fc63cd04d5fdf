//! Drawings as assets: three files that the asset server reads, and all that lies between them.
//! The blend goes round by itself; R reads the files again, so that a drawing that was changed
//! in another program takes the place of the old one.
//!
//! `cargo run --release --example drawings [A.svg B.svg C.svg …]`, paths from the folder of assets

use std::f64::consts::TAU;

use bevy::prelude::*;
use morphospace::stage::{
    Blend, BlendWeights, BuildFailed, Morph, MorphDesigns, MorphPlugin, MorphSystems, StageStyle,
};

const BOTTLES: [&str; 3] = [
    "gallery/bottle-claret.svg",
    "gallery/bottle-demijohn.svg",
    "gallery/bottle-milk.svg",
];

/// How long a round takes, in seconds.
const ROUND: f64 = 9.0;

fn main() -> AppExit {
    App::new()
        .add_plugins((DefaultPlugins, MorphPlugin))
        .insert_resource(ClearColor(Color::srgb_u8(0xf7, 0xf5, 0xf0)))
        .add_systems(Startup, spawn)
        .add_systems(Update, read_again.in_set(MorphSystems::Input))
        .add_systems(Update, go_round.in_set(MorphSystems::Playback))
        .add_systems(Update, fit.after(MorphSystems::Solve))
        .add_observer(report_failure)
        .run()
}

fn spawn(mut commands: Commands, server: Res<AssetServer>) {
    commands.spawn(Camera2d);
    let named: Vec<String> = std::env::args().skip(1).collect();
    let paths = match named.len() {
        0 => BOTTLES.map(str::to_owned).to_vec(),
        _ => named,
    };
    let designs = paths.into_iter().map(|path| server.load(path)).collect();
    commands.spawn((MorphDesigns(designs), StageStyle::default()));
}

fn read_again(
    keys: Res<ButtonInput<KeyCode>>,
    server: Res<AssetServer>,
    shown: Query<&MorphDesigns>,
) {
    if !keys.just_pressed(KeyCode::KeyR) {
        return;
    }
    for design in shown.iter().flat_map(|designs| &designs.0) {
        if let Some(path) = design.path() {
            server.reload(path.clone());
        }
    }
}

/// From each design to the next, and from the last back to the first.
fn go_round(time: Res<Time>, mut shown: Query<(&MorphDesigns, &mut BlendWeights, &mut Blend)>) {
    let turn = time.elapsed_secs_f64() / ROUND;
    for (MorphDesigns(designs), mut weights, mut blend) in &mut shown {
        let count = designs.len();
        let place = turn.fract() * count as f64;
        let (from, share) = (place as usize % count, place.fract());
        weights.0 = vec![0.0; count];
        weights.0[from] += 1.0 - share;
        weights.0[(from + 1) % count] += share;
        // Two are moved by this.
        blend.t = 0.5 - 0.5 * (TAU * turn).cos();
    }
}

/// Lays what is shown into the middle of the window.
fn fit(window: Single<&Window>, mut shown: Query<(&Morph, &mut Transform), Added<Morph>>) {
    for (morph, mut transform) in &mut shown {
        let bounds = morph.frame().transition().bounds();
        let [middle, size] = [bounds.centre(), bounds.size()].map(|v| v.as_vec2());
        let scale = (0.8 * window.size() / size).min_element();
        transform.scale = Vec3::splat(scale);
        transform.translation = (-scale * middle).extend(0.0);
    }
}

fn report_failure(failed: On<BuildFailed>) {
    error!("{}", failed.error);
}
